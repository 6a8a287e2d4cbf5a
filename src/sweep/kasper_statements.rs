//! What Kasper et al. 2021 state of dry and wet drums, as rules.
//!
//! In: the ensembles of a sweep that varies nothing but liquid, viscosity, radius, seed and the law
//! of bridges. Out: for each law the statements for which there are cases, with their comparisons.
//! Bounds that the paper gives in words (*about*, *hardly*) stand here as numbers, each in the rule
//! that a reader sees.

use super::Sweep;
use super::drums::{Drum, Drums};
use super::ensemble::Ensemble;
use super::kasper_parts::{
    DROP, RATIO, along, beside_the_law, between, flows_always, share, values_along,
};
use super::statements::{Part, Statement};
use super::variation::{READING, SEED};
use crate::measure::{Estimate, Measure, NON_RIGID_TEMPERATURE, ResultKey, RunQuantity, Verdict};

const DEGREE: f64 = std::f64::consts::PI / 180.0;
/// The law of bridges: a reading of the paper, not a case of it.
const BRIDGE_LAW: &str = "bridge-law";
/// The keys that the paper varies, and those of its readings.
const VARIED: [&str; 6] = ["liquid", "viscosity", "radius", SEED, READING, BRIDGE_LAW];
/// Viscosity up to which a liquid counts as water [mPa s].
const WATER: f64 = 2.0;

const ANGLE: ResultKey = ResultKey::OfSamples(Measure::SurfaceAngle);
const TEMPERATURE: ResultKey = ResultKey::OfSamples(Measure::GranularTemperature);
const PACKING: ResultKey = ResultKey::OfSamples(Measure::PackingFraction);
const ROUGHNESS: ResultKey = ResultKey::OfSamples(Measure::SurfaceRoughness);
const CURVATURE: ResultKey = ResultKey::OfSamples(Measure::SurfaceCurvature);
const FLOW_SPEED: ResultKey = ResultKey::OfRun(RunQuantity::FlowSpeed);
const FLOW_DEPTH: ResultKey = ResultKey::OfRun(RunQuantity::FlowDepth);

/// Statements with the reading of the paper under which cases were run, where there are several.
pub type StatementsOfReading = (Option<String>, Vec<Statement>);

/// The statements for which `ensembles` has cases, reading by reading; none where the sweep varies
/// anything else. Dry drums, which have no bridges, belong to every reading.
pub fn statements_by_reading(sweep: &Sweep, ensembles: &[Ensemble]) -> Vec<StatementsOfReading> {
    let is_known = |key: &str| VARIED.contains(&key);
    let is_of_drums = !ensembles
        .iter()
        .any(|ensemble| ensemble.first().is_column());
    if !is_of_drums || !sweep.variations.iter().all(|varied| is_known(&varied.key)) {
        return Vec::new();
    }
    let of_reading = |reading| {
        let own = |ensemble: &&Ensemble| is_of_reading(ensemble, reading, ensembles);
        let statements = drum_statements(&Drums::of(ensembles.iter().filter(own)));
        (reading.map(str::to_owned), statements)
    };
    let all = readings(ensembles).into_iter().map(of_reading);
    all.filter(|(_, statements)| !statements.is_empty())
        .collect()
}

/// The readings of wet drums, in their order; none stands for the only one.
fn readings<'a>(ensembles: &'a [Ensemble]) -> Vec<Option<&'a str>> {
    let wet = ensembles.iter().filter(|own| !is_dry(own));
    let mut readings: Vec<Option<&str>> = Vec::new();
    for reading in wet.map(reading_of) {
        if !readings.contains(&reading) {
            readings.push(reading);
        }
    }
    if readings.is_empty() {
        readings.push(None);
    }
    readings
}

/// Whether a drum belongs to `reading`: of wet ones those under it, of dry ones likewise, where any
/// was run under it, else those of the first reading that has any.
fn is_of_reading(drum: &Ensemble, reading: Option<&str>, all: &[Ensemble]) -> bool {
    let is_under = |own: &Ensemble| reading.is_none() || reading_of(own) == reading;
    let is_dry_under = |own: &Ensemble| is_dry(own) && is_under(own);
    let first_dry = || all.iter().find(|own| is_dry(own)).map(reading_of);
    let is_first = || is_dry(drum) && Some(reading_of(drum)) == first_dry();
    is_under(drum) || (is_first() && !all.iter().any(is_dry_under))
}

/// The reading that sets `ensemble` apart from others, if one does.
fn reading_of<'a>(ensemble: &'a Ensemble) -> Option<&'a str> {
    let of = |key| ensemble.value_of(key);
    of(READING).or_else(|| of(BRIDGE_LAW))
}

fn is_dry(ensemble: &Ensemble) -> bool {
    ensemble.first().case.scene.liquid.is_none()
}

/// The statements for which there are `drums`.
pub fn drum_statements(drums: &Drums) -> Vec<Statement> {
    let all = [
        drums.angles(),
        drums.drops(),
        drums.temperatures(),
        drums.shares(),
        drums.flow(),
        drums.beds(),
    ];
    let found = all.into_iter().flatten();
    found
        .filter(|statement| !statement.parts.is_empty())
        .collect()
}

impl Drums<'_> {
    /// Compares a result of each wet drum with that of the dry one.
    fn wet_above_dry(&self, key: ResultKey) -> Vec<Part> {
        self.beside_dry(key, Verdict::of_larger)
    }

    fn wet_below_dry(&self, key: ResultKey) -> Vec<Part> {
        self.beside_dry(key, |wet, dry| Verdict::of_larger(dry, wet))
    }

    fn beside_dry(&self, key: ResultKey, rule: fn(Estimate, Estimate) -> Verdict) -> Vec<Part> {
        let part = |(wet, dry): (&Drum, &Drum)| {
            let (own, other) = (wet.get(key)?, dry.get(key)?);
            let text = |mean| key.quantity().text(mean);
            Some(Part {
                place: wet.place(),
                found: format!("{} against {} dry", text(own), text(other)),
                verdict: rule(own, other),
            })
        };
        self.pairs().filter_map(part).collect()
    }

    fn angles(&self) -> Vec<Statement> {
        let level = |means: &[Estimate]| Verdict::of_level(means, 1.5 * DEGREE);
        let (dry, wet): (Vec<_>, Vec<_>) =
            (self.by_radius().into_iter()).partition(|drums| drums[0].is_dry());
        vec![
            Statement {
                text: "The wet bed stands higher than the dry one",
                rule: "θ wet is larger than θ dry at the same r",
                parts: self.wet_above_dry(ANGLE),
            },
            Statement {
                text: "The angle of the wet bed has no clear trend with viscosity",
                rule: "θ stays level to within 1.5° over the liquids of one r",
                parts: along(&self.by_viscosity(), ANGLE, level),
            },
            Statement {
                text: "The dry angle rises with r",
                rule: "θ dry rises along the radii",
                parts: along(&dry, ANGLE, Verdict::of_rising),
            },
            Statement {
                text: "The wet angle falls slightly with r",
                rule: "θ of each liquid falls along the radii",
                parts: along(&wet, ANGLE, Verdict::of_falling),
            },
        ]
    }

    fn drops(&self) -> Vec<Statement> {
        vec![
            Statement {
                text: "Drops fall with viscosity",
                rule: "Δθ falls along the liquids of one r",
                parts: along(&self.by_viscosity(), DROP, Verdict::of_falling),
            },
            Statement {
                text: "Drops grow with r",
                rule: "Δθ of each liquid rises along the radii",
                parts: along(&self.by_radius(), DROP, Verdict::of_rising),
            },
            Statement {
                text: "The ratio of wet to dry drops follows Eq. 23",
                rule: "the ratio lies within 0.1 of the law",
                parts: self.pairs().filter_map(beside_the_law).collect(),
            },
            Statement {
                text: "Drops are below 2.5° where the flow is continuous",
                rule: "Δθ lies below 2.5° where ta/ts is at least 0.98",
                parts: (self.0.iter().filter(|drum| flows_always(drum)))
                    .filter_map(|drum| between(drum, DROP, f64::NEG_INFINITY..2.5 * DEGREE))
                    .collect(),
            },
        ]
    }

    fn temperatures(&self) -> Vec<Statement> {
        let ratio = |(wet, dry): (&Drum, &Drum)| {
            let ratio = dry.get(TEMPERATURE)?.over(wet.get(TEMPERATURE)?);
            Some(Part {
                place: wet.place(),
                found: format!("dry over wet {}", RATIO.text(ratio)),
                verdict: Verdict::of_between(ratio, 5.0..20.0),
            })
        };
        vec![
            Statement {
                text: "The granular temperature falls with viscosity",
                rule: "Tg falls along the liquids of one r",
                parts: along(&self.by_viscosity(), TEMPERATURE, Verdict::of_falling),
            },
            Statement {
                text: "The granular temperature rises with r",
                rule: "Tg of each liquid rises along the radii",
                parts: along(&self.by_radius(), TEMPERATURE, Verdict::of_rising),
            },
            Statement {
                text: "Dry beds are about ten times as agitated as wet ones",
                rule: "Tg dry over Tg wet at the same r lies between 5 and 20",
                parts: self.pairs().filter_map(ratio).collect(),
            },
        ]
    }

    fn shares(&self) -> Vec<Statement> {
        let of_radius = |drum: &Drum| {
            // The viscosity from which on the paper's beds of this radius flow always.
            let from = match drum.radius {
                1.25 => 500.0,
                2.0 => 900.0,
                3.0 => f64::INFINITY,
                _ => return None,
            };
            share(drum, drum.viscosity >= from)
        };
        let over_galilei =
            |drum: &Drum| match drum.ensemble.mean(RunQuantity::InverseRootGalilei)? {
                x if x <= 0.3 => share(drum, false),
                x if x >= 2.0 => share(drum, true),
                _ => None,
            };
        let of_turning = |quantity: RunQuantity, bounds: std::ops::Range<f64>| {
            let turning = self.0.iter().filter(|drum| drum.viscosity <= WATER);
            let part = |drum| between(drum, ResultKey::OfRun(quantity), bounds.clone());
            turning.filter_map(part).collect()
        };
        vec![
            Statement {
                text: "Dry and with water the bed turns with the drum between avalanches",
                rule: "the rise rate lies within 5 % of the drum's 3 °/s",
                parts: of_turning(RunQuantity::RiseRate, 2.85 * DEGREE..3.15 * DEGREE),
            },
            Statement {
                text: "Dry and with water Tg drops to nearly zero between avalanches",
                rule: "its median between avalanches lies below 2·10⁻⁹ m²/s²",
                parts: of_turning(
                    RunQuantity::TemperatureBetweenAvalanches,
                    f64::NEG_INFINITY..NON_RIGID_TEMPERATURE,
                ),
            },
            Statement {
                text: "Flow is continuous from 520 mPa s (r = 1.25 mm), from 940 mPa s (2 mm), never \
                       at 3 mm",
                rule: "ta/ts lies above 0.98 there, below elsewhere",
                parts: self.wet().filter_map(of_radius).collect(),
            },
            Statement {
                text: "Over √(1/Ga) flow becomes continuous near 1",
                rule: "ta/ts lies below 0.98 up to √(1/Ga) = 0.3, above from 2 on",
                parts: self.wet().filter_map(over_galilei).collect(),
            },
        ]
    }

    fn flow(&self) -> Vec<Statement> {
        let level = |means: &[Estimate]| Verdict::of_level(means, 2e-3);
        vec![
            Statement {
                text: "Dry beds flow faster than wet ones",
                rule: "u_0, the speed at the surface, is smaller wet than dry at the same r",
                parts: self.wet_below_dry(FLOW_SPEED),
            },
            Statement {
                text: "The flow slows with viscosity",
                rule: "u_0 falls along the liquids of one r",
                parts: along(&self.by_viscosity(), FLOW_SPEED, Verdict::of_falling),
            },
            Statement {
                text: "The flow is the faster the larger the grains",
                rule: "u_0 of each liquid rises along the radii",
                parts: along(&self.by_radius(), FLOW_SPEED, Verdict::of_rising),
            },
            Statement {
                text: "The flowing layer is as thick at every viscosity",
                rule: "its depth stays level to within 2 mm over the liquids of one r",
                parts: along(&self.by_viscosity(), FLOW_DEPTH, level),
            },
            Statement {
                text: "The flowing layer is about as thick with grains of every r",
                rule: "its depth stays level to within 2 mm along the radii of one liquid",
                parts: along(&self.by_radius(), FLOW_DEPTH, level),
            },
        ]
    }

    /// The roughness of a wet drum over that of the dry one of its radius.
    fn roughness_over_dry(&self, wet: &Drum) -> Option<Estimate> {
        let (_, dry) = self.pairs().find(|(own, _)| std::ptr::eq(*own, wet))?;
        Some(wet.get(ROUGHNESS)?.over(dry.get(ROUGHNESS)?))
    }

    fn beds(&self) -> Vec<Statement> {
        let level = |means: &[Estimate]| Verdict::of_level(means, 0.005);
        let roughness = |drum: &Drum| self.roughness_over_dry(drum);
        let convex = |drum: &Drum| between(drum, CURVATURE, 0.0..f64::INFINITY);
        vec![
            Statement {
                text: "Wet beds are denser than dry ones",
                rule: "φ wet is larger than φ dry at the same r",
                parts: self.wet_above_dry(PACKING),
            },
            Statement {
                text: "The packing fraction falls with r",
                rule: "φ of each liquid falls along the radii",
                parts: along(&self.by_radius(), PACKING, Verdict::of_falling),
            },
            Statement {
                text: "The packing fraction hardly moves with viscosity",
                rule: "φ stays level to within 0.005 over the liquids of one r",
                parts: along(&self.by_viscosity(), PACKING, level),
            },
            Statement {
                text: "The surface grows rougher with viscosity",
                rule: "h rises along the liquids of one r",
                parts: along(&self.by_viscosity(), ROUGHNESS, Verdict::of_rising),
            },
            Statement {
                text: "Over that of the dry bed the roughness falls with r",
                rule: "h wet over h dry of each liquid falls along the radii",
                parts: values_along(&self.by_radius(), &RATIO, roughness, Verdict::of_falling),
            },
            Statement {
                text: "The surface turns convex in wet beds",
                rule: "κ of wet beds is positive",
                parts: self.wet().filter_map(convex).collect(),
            },
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::CaseResult;
    use super::super::ensemble::ensembles;
    use super::super::kasper_parts::SHARE;
    use super::super::{Case, Variation};
    use super::*;
    use crate::measure::Summary;
    use crate::run::BedStore;
    use crate::scene::Scene;

    fn scene(radius: f64, liquid: &str) -> Scene {
        let text = format!(
            r#"(title: "Any", materials: {{"a": ()}}, {liquid}
            container: Drum(radius_mm: 60, width_mm: 22, speed_rpm: 0.5, material: "a"),
            grains: Fill(count: 5, species: [(radius_mm: {radius}, material: "a")]))"#
        );
        Scene::parse("any", &text).unwrap()
    }

    fn sweep(variations: &[&str]) -> Sweep {
        let parsed = variations
            .iter()
            .map(|text| Variation::parse(text).unwrap());
        Sweep {
            name: "any".into(),
            scene: scene(3.0, ""),
            settings: Vec::new(),
            variations: parsed.collect(),
            out: "nowhere".into(),
            jobs: 1,
            beds: BedStore::none(),
            restart: false,
        }
    }

    /// A run with these values varied, whose bed stands at `angle` [°] and flows for this `share`.
    fn outcome(values: &[&str], scene: Scene, angle: f64, share: f64) -> CaseResult {
        of_numbers(values, scene, &[(ANGLE, angle * DEGREE), (SHARE, share)])
    }

    /// A run with these values varied that came to these numbers.
    fn of_numbers(values: &[&str], scene: Scene, numbers: &[(ResultKey, f64)]) -> CaseResult {
        let case = Case {
            name: values.join("_"),
            values: values.iter().map(|&value| value.to_owned()).collect(),
            scene,
            script: Vec::new(),
            time_step: 1e-5,
        };
        let results = Summary::of_numbers(numbers);
        CaseResult::kept(&case, results, String::new(), String::new())
    }

    const WATER: &str = "liquid: (case: 1, volume_ml: 4),";
    const GLYCEROL: &str = "liquid: (case: 7, volume_ml: 4),";

    #[test]
    fn statements_are_judged_by_their_rules_over_the_seeds() {
        let mut outcomes = Vec::new();
        for (seed, by) in [("1", -0.1), ("2", 0.0), ("3", 0.1)] {
            for (radius, name, dry, wet) in [(3.0, "3mm", 33.9, 26.2), (2.0, "2mm", 30.0, 31.8)] {
                outcomes.push(outcome(
                    &[name, "0", seed],
                    scene(radius, ""),
                    dry + by,
                    0.67,
                ));
                outcomes.push(outcome(
                    &[name, "1", seed],
                    scene(radius, WATER),
                    wet - by,
                    0.65,
                ));
                let thick = scene(radius, GLYCEROL);
                outcomes.push(outcome(&[name, "7", seed], thick, wet + 0.2 + by, 1.0));
            }
        }
        let sweep = sweep(&["radius=3mm,2mm", "liquid=0,1,7", "seed=1..3"]);
        let ensembles = ensembles(&sweep, &outcomes);
        assert_eq!(ensembles.len(), 6);
        let [(None, statements)] = &statements_by_reading(&sweep, &ensembles)[..] else {
            panic!("one reading")
        };
        let verdict = |text: &str| {
            let found = statements.iter().find(|own| own.text.starts_with(text));
            found.unwrap_or_else(|| panic!("{text}")).verdict()
        };
        assert_eq!(verdict("The wet bed stands higher"), Verdict::InPart);
        assert_eq!(verdict("The angle of the wet bed has no"), Verdict::Holds);
        assert_eq!(verdict("The dry angle rises with r"), Verdict::Holds);
        assert_eq!(verdict("The wet angle falls slightly"), Verdict::Holds);
        // Right at 2 mm; at 3 mm glycerol lets the bed flow always.
        assert_eq!(verdict("Flow is continuous from"), Verdict::InPart);
        let shares = statements
            .iter()
            .find(|own| own.text.starts_with("Flow is"));
        let places: Vec<&str> = shares
            .unwrap()
            .parts
            .iter()
            .map(|p| p.place.as_str())
            .collect();
        assert_eq!(
            places[..2],
            ["r = 2 mm, 1.01 mPa s", "r = 2 mm, 1410 mPa s"]
        );
        // Nothing was measured that others need.
        assert!(!statements.iter().any(|own| own.text.starts_with("Drops")));
    }

    #[test]
    fn flow_and_roughness_are_judged_by_their_rules() {
        // Speeds at the surface [mm/s], depths of the layer and roughness [mm], Tg between drops.
        let of = |name: &str, radius: f64, own: [[f64; 4]; 3]| {
            let liquids = [("0", ""), ("1", WATER), ("7", GLYCEROL)];
            let all = liquids.into_iter().zip(own);
            let outcomes = all.flat_map(|((number, liquid), [speed, depth, rough, quiet])| {
                ["1", "2", "3"].map(|seed| {
                    let by = 0.01 * seed.parse::<f64>().unwrap();
                    let quiet_key = ResultKey::OfRun(RunQuantity::TemperatureBetweenAvalanches);
                    let numbers = [
                        (FLOW_SPEED, 1e-3 * (speed + by)),
                        (FLOW_DEPTH, 1e-3 * (depth - by)),
                        (ROUGHNESS, 1e-3 * (rough + by)),
                        (quiet_key, 1e-9 * (quiet + by)),
                    ];
                    of_numbers(&[name, number, seed], scene(radius, liquid), &numbers)
                })
            });
            outcomes.collect::<Vec<_>>()
        };
        let fine = of(
            "2mm",
            2.0,
            [
                [12.0, 9.0, 0.70, 1.0],
                [8.0, 12.0, 0.84, 3.0],
                [3.0, 9.5, 1.05, 9.0],
            ],
        );
        let coarse = of(
            "3mm",
            3.0,
            [
                [14.0, 9.5, 1.1, 1.0],
                [9.0, 10.0, 1.2, 1.0],
                [4.0, 9.8, 1.3, 9.0],
            ],
        );
        let outcomes: Vec<_> = fine.into_iter().chain(coarse).collect();
        let sweep = sweep(&["radius=2mm,3mm", "liquid=0,1,7", "seed=1..3"]);
        let ensembles = ensembles(&sweep, &outcomes);
        let statements = &statements_by_reading(&sweep, &ensembles)[0].1;
        let verdict = |text: &str| {
            let found = statements.iter().find(|own| own.text.starts_with(text));
            found.unwrap_or_else(|| panic!("{text}")).verdict()
        };
        assert_eq!(verdict("Dry beds flow faster"), Verdict::Holds);
        assert_eq!(verdict("The flow slows"), Verdict::Holds);
        assert_eq!(verdict("The flow is the faster"), Verdict::Holds);
        // Of 12.0 and 9.5 mm at 2 mm the mean is 10.75: within 2 mm; so are all others.
        let as_thick = "The flowing layer is as thick at every viscosity";
        assert_eq!(verdict(as_thick), Verdict::Holds);
        let about = "The flowing layer is about as thick";
        assert_eq!(verdict(about), Verdict::Holds);
        // Over the dry one 1.2 and 1.5 at 2 mm, 1.09 and 1.18 at 3 mm.
        assert_eq!(verdict("Over that of the dry bed"), Verdict::Holds);
        // With water at 2 mm Tg stays above the threshold.
        let drops = "Dry and with water Tg drops";
        assert_eq!(verdict(drops), Verdict::InPart);
    }

    #[test]
    fn one_run_of_each_decides_nothing_and_other_variations_are_no_paper() {
        let dry = outcome(&["0"], scene(3.0, ""), 33.9, 0.67);
        let wet = outcome(&["1"], scene(3.0, WATER), 26.2, 0.65);
        let outcomes = [dry, wet];
        let own = sweep(&["liquid=0,1"]);
        let statements = statements_by_reading(&own, &ensembles(&own, &outcomes));
        assert!(!statements[0].1.is_empty());
        assert!(
            statements[0]
                .1
                .iter()
                .all(|own| own.verdict() == Verdict::NotDecided)
        );
        let other = sweep(&["drum-speed=1rpm,2rpm"]);
        assert!(statements_by_reading(&other, &ensembles(&other, &outcomes)).is_empty());
    }
    #[test]
    fn each_reading_has_its_own_verdicts_and_the_dry_drum_with_it() {
        let mut outcomes = Vec::new();
        for (seed, by) in [("1", -0.1), ("2", 0.0), ("3", 0.1)] {
            let dry = scene(3.0, "");
            outcomes.push(outcome(&["as-printed", "0", seed], dry, 30.0 + by, 0.6));
            for (reading, angle) in [("as-printed", 28.0), ("as-coded", 32.0)] {
                let wet = scene(3.0, WATER);
                outcomes.push(outcome(&[reading, "1", seed], wet, angle - by, 0.6));
            }
        }
        let sweep = sweep(&["bridge-law=as-printed,as-coded", "liquid=0,1", "seed=1..3"]);
        let ensembles = ensembles(&sweep, &outcomes);
        let found = statements_by_reading(&sweep, &ensembles);
        let verdicts: Vec<_> = (found.iter())
            .map(|(reading, statements)| (reading.as_deref(), statements[0].verdict()))
            .collect();
        let expected = [
            (Some("as-printed"), Verdict::DoesNot),
            (Some("as-coded"), Verdict::Holds),
        ];
        assert_eq!(verdicts, expected);
    }
}
