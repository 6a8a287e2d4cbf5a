//! The readings of Kasper et al. 2021: what its text leaves open or states twice, one departure at a
//! time, and what becomes of its statements under each.
//!
//! In: what a reading sets, and the drums that it changes. Out: the cases, and tables of what they
//! came to: the readings and numbers; verdicts on every statement and a score for each that tells.
//! Drums that a reading does not change are those of the paper as printed. Order of the cases: one seed
//! of all readings first, which screens them; then more seeds, then finer grains, of those that tell.
//! Nothing is chosen by how many statements it reaches.

use super::markdown::{head, line};
use super::plan::{Batch, Paper, PaperTable, Reading};
use super::readings::{AS_PRINTED, Judged, compared, tables_of};
use crate::measure::{DropThreshold, Measure, ResultKey, RunQuantity, numeral::NOTHING};
use crate::sweep::{
    CaseResult, Drum, Drums, Ensemble, MeasuredBy, READING, Sweep, drum_statements, ensembles,
};

/// The readings, as a paper of their own.
pub static KASPER2021_READINGS: Paper = Paper {
    name: "kasper2021-readings",
    source: "Readings of Kasper, Magnanimo, de Jong, Beek, Jarray, Particuology (2021), doi 10.1016/j.partic.2020.12.001",
    scene: "wet",
    settings: &["duration=50s"],
    keys: &[READING, "radius", "liquid"],
    readings: READINGS,
    beside: &[],
    batches: &BATCHES,
    small_settings: &[
        "duration=1s",
        "count=36",
        "drum-radius=20mm",
        "drum-width=16mm",
        "drum-speed=10rpm",
        "liquid-volume=0.3ml",
    ],
    small_batches: &[
        Batch::new("r3", &[AS_PRINTED, "3mm"], &["0", "1", "7"], (1, 1)),
        Batch::new("walls", &["walls-as-grains", "3mm"], &["0", "7"], (1, 1)),
        Batch::new("r3", &[AS_PRINTED, "3mm"], &["0", "1", "7"], (2, 2)),
        Batch::new("walls", &["walls-as-grains", "3mm"], &["0", "7"], (2, 2)),
    ],
    tables,
};

/// Where among the values of a case its radius stands, at which readings are compared.
const RADIUS: std::ops::Range<usize> = 1..2;
/// The liquids of the first rounds, and of the later ones: of readings that change all drums, the
/// wet ones, the dry one.
const ALL: Liquids = [&["0", "1", "3", "7"], &["5"]];
const WET: Liquids = [&["1", "3", "7"], &["5"]];
const DRY: Liquids = [&["0"], &[]];

type Liquids = [&'static [&'static str]; 2];

/// How much a reading is worth running: its drums of one seed lie within the scatter of those as
/// printed and screen it out, they lie beyond, or it is what all others are set beside.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Weight {
    ScreenedOut,
    Tells,
    Printed,
}
use Weight::{Printed, ScreenedOut, Tells};

/// What is run of a reading.
struct Planned {
    name: &'static str,
    weight: Weight,
    /// The liquids whose drums it changes, of the first rounds and of the later ones.
    liquids: Liquids,
    /// The values of `reading` and `radius`, coarse grains first.
    values: [&'static [&'static str]; PARTS.len()],
}

/// The parts, by the radii of their grains, coarse ones first.
const PARTS: [&str; 2] = ["r3", "r2"];

/// Makes the list of readings, and what is run of each.
macro_rules! readings {
    ($(($name:expr, $liquids:ident, $weight:ident, $text:literal, [$($setting:literal),*]),)+) => {
        static READINGS: &[Reading] = &[$(Reading {
            name: $name,
            text: $text,
            settings: &[$($setting),*],
        }),+];
        static PLANS: [Planned; READINGS_COUNT] = [$(Planned {
            name: $name,
            weight: $weight,
            liquids: $liquids,
            values: [&[$name, "3mm"], &[$name, "2mm"]],
        }),+];
        const READINGS_COUNT: usize = [$($name),+].len();
    };
}

readings! {
    (AS_PRINTED, ALL, Printed, "as printed, with the choices of all other tables", []),
    ("as-coded", WET, Tells, "bridges as LIGGGHTS 3.8 computes them: all four of the next", ["bridge-law=as-coded"]),
    ("shaded-caps", WET, ScreenedOut, "bridges hold 6.7 % of both films instead of 5 %", ["bridge-volume=shaded-cap"]),
    ("half-product-angle", WET, ScreenedOut, "two grains' contact angle is half the product: 40° act as 14°", ["pair-angle=half-product"]),
    ("weak-viscosity", WET, Tells, "viscous forces grow down to 1.01 r* only, not to 0.01 (r_i + r_j)", ["viscous-gap=coded"]),
    ("open-capillary-gap", WET, ScreenedOut, "the capillary force of grains in contact is that at no gap", ["capillary-gap=open"]),
    ("rupture-at-d0", WET, ScreenedOut, "bridges break at d0, forces beyond 0.1 (r_i + r_j) being those there", ["rupture=at-d0"]),
    ("coulomb-total", WET, ScreenedOut, "friction is bounded by the normal force of contact and bridge together", ["coulomb=total"]),
    (
        "wet-friction-as-dry", WET, Tells, "wet grains have the dry ones' friction, 0.40 (0.30 at walls)",
        ["wet-friction.glass.glass=0.4", "wet-friction.glass.drum=0.3"]
    ),
    (
        "dry-friction-as-wet", DRY, Tells, "dry grains have the wet ones' friction, 0.10 (0.15 at walls)",
        ["friction.glass.glass=0.1", "friction.glass.drum=0.15"]
    ),
    (
        "walls-as-grains", ALL, Tells, "walls have the grains' friction, 0.10 wet and 0.40 dry",
        ["wet-friction.glass.drum=0.1", "friction.glass.drum=0.4"]
    ),
    ("solid-fill", ALL, Tells, "grains, not their bed, fill 35 % of the drum", ["count=783"]),
    (
        "no-rolling-friction", ALL, Tells, "no rolling friction",
        ["rolling-friction.glass.glass=0", "rolling-friction.glass.drum=0"]
    ),
    ("no-rolling-friction-at-walls", ALL, ScreenedOut, "no rolling friction at walls", ["rolling-friction.glass.drum=0"]),
    ("quarter-step", ALL, ScreenedOut, "a quarter of the time step", ["time-step=reference"]),
}

/// A round: which of the parts, of readings of which weight, which of their liquids, the first and the
/// last seed. Of the drums as printed there are as many seeds as the other tables have.
type Round = (usize, Weight, usize, (u64, u64));
const ROUNDS: [Round; 14] = [
    (0, Printed, 0, (1, 1)),
    (0, Tells, 0, (1, 1)),
    (0, ScreenedOut, 0, (1, 1)),
    (0, Printed, 0, (2, 8)),
    (0, Printed, 1, (1, 8)),
    (0, Tells, 0, (2, 2)),
    (0, Tells, 0, (3, 4)),
    (0, Tells, 1, (1, 4)),
    (1, Printed, 0, (1, 4)),
    (1, Printed, 1, (1, 4)),
    (1, Tells, 0, (1, 2)),
    (1, Tells, 1, (1, 2)),
    (1, Tells, 0, (3, 4)),
    (1, Tells, 1, (3, 4)),
];

static BATCHES: [Batch; ROUNDS.len() * READINGS_COUNT] = {
    let mut all = [const { Batch::new("", &[], &[], (1, 1)) }; ROUNDS.len() * READINGS_COUNT];
    let mut k = 0;
    while k < all.len() {
        let (part, weight, which, seeds) = ROUNDS[k / READINGS_COUNT];
        let plan = &PLANS[k % READINGS_COUNT];
        let liquids: &[&str] = if plan.weight as u8 == weight as u8 {
            plan.liquids[which]
        } else {
            &[]
        };
        all[k] = Batch::new(PARTS[part], plan.values[part], liquids, seeds);
        k += 1;
    }
    all
};

/// What is planned of the reading called `name`.
fn plan_of(name: &str) -> Option<&'static Planned> {
    PLANS.iter().find(|plan| plan.name == name)
}

/// The tables, from the cases that are there.
fn tables(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<PaperTable> {
    let ensembles = ensembles(sweep, outcomes);
    let all: Vec<&Ensemble> = ensembles.iter().collect();
    let measured = Measured::all(&all);
    let judged = Measured::all(&compared(&that_tell(&all), RADIUS));
    tables_of(
        &readings_of(&measured),
        &readings_of(&judged),
        numbers_table(&measured),
    )
}

fn readings_of<'a>(measured: &'a [Measured]) -> Vec<&'a Judged> {
    measured.iter().map(|own| &own.judged).collect()
}

/// Of these ensembles those of readings that are not screened out.
fn that_tell<'a>(ensembles: &[&'a Ensemble<'a>]) -> Vec<&'a Ensemble<'a>> {
    let is_screened_out =
        |own: &Ensemble| plan_of(&own.values[0]).is_some_and(|plan| plan.weight == ScreenedOut);
    let all = ensembles.iter().copied();
    all.filter(|own| !is_screened_out(own)).collect()
}

/// A reading with its drums.
struct Measured<'a> {
    judged: Judged,
    drums: Drums<'a>,
}

impl<'a> Measured<'a> {
    /// The readings of which there are drums of their own, and other measures of the drums as
    /// printed.
    fn all(ensembles: &[&'a Ensemble<'a>]) -> Vec<Self> {
        let runs = READINGS.iter();
        let runs = runs.map(|own| (own.name, own.text, drums_of(own.name, ensembles)));
        let measures = OTHER_MEASURES.iter().map(|(name, text, measure)| {
            let mut drums = drums_of(AS_PRINTED, ensembles);
            let all = drums.iter_mut().flat_map(|drums| &mut drums.0);
            all.for_each(|drum| drum.measured_by = *measure);
            (*name, *text, drums)
        });
        let numbered = (0..).zip(runs.chain(measures));
        let of = |(number, (name, text, drums)): (usize, (&str, &str, Option<Drums<'a>>))| {
            let drums = drums?;
            let judged = Judged {
                number,
                name: name.to_owned(),
                text: text.to_owned(),
                runs: drums.0.iter().map(|own| own.ensemble.members.len()).sum(),
                statements: drum_statements(&drums),
            };
            Some(Self { judged, drums })
        };
        numbered.filter_map(of).collect()
    }
}

/// Other measures of the same runs.
const OTHER_MEASURES: [(&str, &str, MeasuredBy); 4] = [
    (
        "drops-from-0.5°",
        "as printed; drops of θ count from 0.5° on, not from 1°",
        MeasuredBy::Drops(DropThreshold::HalfDegree),
    ),
    (
        "drops-from-2°",
        "as printed; drops of θ count from 2° on",
        MeasuredBy::Drops(DropThreshold::TwoDegrees),
    ),
    (
        "drops-from-3°",
        "as printed; drops of θ count from 3° on",
        MeasuredBy::Drops(DropThreshold::ThreeDegrees),
    ),
    (
        "co-rotating-Tg",
        "as printed; velocities are those in the drum's frame",
        MeasuredBy::CorotatingFrame,
    ),
];

/// The drums of the reading called `name`, at the radii at which there are some of its own: those run
/// under it, and of the liquids with which it changes nothing those as printed. None where there are
/// none of its own.
fn drums_of<'a>(name: &str, ensembles: &[&'a Ensemble<'a>]) -> Option<Drums<'a>> {
    let is_of = |own: &Ensemble, reading: &str| own.values[0] == reading;
    let radii: Vec<&str> = ensembles
        .iter()
        .filter(|own| is_of(own, name))
        .map(|own| own.values[RADIUS.start].as_str())
        .collect();
    let changed = plan_of(name).map_or(Vec::new(), |plan| plan.liquids.concat());
    let is_unchanged = |own: &Ensemble| {
        let [reading, radius, liquid] = &own.values[..] else {
            return false;
        };
        reading == AS_PRINTED
            && radii.contains(&radius.as_str())
            && !changed.contains(&liquid.as_str())
    };
    let all = ensembles.iter().copied();
    let drums = all.filter(|own| is_of(own, name) || is_unchanged(own));
    (!radii.is_empty()).then(|| Drums::of(drums))
}

/// A result of the drum of one liquid, by its number in Table 1, and what its column is called.
type Column = (&'static str, &'static str, ResultKey);

/// The columns of the table of numbers.
const NUMBERS: [Column; 9] = [
    ("θ, dry", "0", ResultKey::OfSamples(Measure::SurfaceAngle)),
    ("θ, n = 1", "1", ResultKey::OfSamples(Measure::SurfaceAngle)),
    ("θ, n = 7", "7", ResultKey::OfSamples(Measure::SurfaceAngle)),
    ("Δθ, dry", "0", ResultKey::OfRun(RunQuantity::Drop)),
    ("Δθ, n = 1", "1", ResultKey::OfRun(RunQuantity::Drop)),
    ("Δθ, n = 7", "7", ResultKey::OfRun(RunQuantity::Drop)),
    (
        "Tg, n = 1",
        "1",
        ResultKey::OfSamples(Measure::GranularTemperature),
    ),
    (
        "ta/ts, n = 1",
        "1",
        ResultKey::OfRun(RunQuantity::NonRigidShare),
    ),
    (
        "ta/ts, n = 3",
        "3",
        ResultKey::OfRun(RunQuantity::NonRigidShare),
    ),
];

/// A row for each reading and radius.
fn numbers_table(measured: &[Measured]) -> String {
    let heads = ["", "r [mm]"]
        .into_iter()
        .chain(NUMBERS.map(|(name, ..)| name));
    let mut text = head(&heads.map(str::to_owned).collect::<Vec<_>>());
    for own in measured {
        for radius in own.radii() {
            let first = [own.judged.number.to_string(), radius.to_string()];
            let of = |(_, liquid, key): &Column| own.number_text(radius, liquid, *key);
            let cells: Vec<String> = first.into_iter().chain(NUMBERS.iter().map(of)).collect();
            text += &line(&cells);
        }
    }
    text
}

impl Measured<'_> {
    /// The radii of its drums [mm], coarse grains first.
    fn radii(&self) -> Vec<f64> {
        let mut radii: Vec<f64> = self.drums.0.iter().map(|drum| drum.radius).collect();
        radii.dedup();
        radii.reverse();
        radii
    }

    fn number_text(&self, radius: f64, liquid: &str, key: ResultKey) -> String {
        let is_it = |drum: &&Drum| {
            let own = drum.ensemble.values.last();
            drum.radius == radius && own.is_some_and(|own| own == liquid)
        };
        let found = self.drums.0.iter().find(is_it);
        let estimate = found.and_then(|drum| drum.get(key));
        estimate.map_or_else(|| NOTHING.to_owned(), |own| key.quantity().text(own))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{Summary, Verdict};
    use crate::paper::{PaperJob, Selection};
    use crate::sweep::Case;

    const DEGREE: f64 = std::f64::consts::PI / 180.0;

    /// The paper's sweep, with what its cases came to: beds that stand at `angle` [°] by their
    /// reading and liquid, of two seeds 0.2° apart, and flow for 0.5 of the time, in the drum's
    /// frame for 0.3.
    fn outcomes(angle: impl Fn(&str, &str) -> Option<f64>) -> (Sweep, Vec<CaseResult>) {
        let selection = Selection {
            parts: vec!["r3".to_owned()],
            seeds: Some(2),
            ..Selection::default()
        };
        let paper = &KASPER2021_READINGS;
        let job = PaperJob::new(paper, &selection, "nowhere".into(), 1).unwrap();
        let cases = crate::sweep::cases(job.sweep()).unwrap();
        let outcomes = cases.into_iter().filter_map(|case| {
            let [reading, _, liquid, seed] = &case.values[..] else {
                return None;
            };
            let by = if seed == "1" { -0.1 } else { 0.1 };
            let angle = angle(reading, liquid)? + by;
            Some(outcome(&case, angle))
        });
        (job.sweep().clone(), outcomes.collect())
    }

    fn outcome(case: &Case, angle: f64) -> CaseResult {
        let results = Summary::of_numbers(&[
            (Measure::SurfaceAngle.into(), angle * DEGREE),
            (RunQuantity::NonRigidShare.into(), 0.5),
            (RunQuantity::CorotatingShare.into(), 0.3),
        ]);
        CaseResult::kept(case, results, String::new(), String::new())
    }

    #[test]
    fn drums_that_a_reading_does_not_change_are_those_as_printed() {
        let (sweep, outcomes) = outcomes(|reading, liquid| match (reading, liquid) {
            (AS_PRINTED, "0") => Some(33.0),
            (AS_PRINTED, "1") => Some(27.0),
            // Changes wet drums alone, and the dry one alone.
            ("wet-friction-as-dry", "1") => Some(39.0),
            ("dry-friction-as-wet", "0") => Some(25.0),
            _ => None,
        });
        let ensembles = ensembles(&sweep, &outcomes);
        let measured = Measured::all(&ensembles.iter().collect::<Vec<_>>());
        let verdict = |name: &str| {
            let own = measured.iter().find(|own| own.judged.name == name).unwrap();
            own.judged
                .verdict("The wet bed stands higher than the dry one")
        };
        assert_eq!(verdict(AS_PRINTED), Some(Verdict::DoesNot));
        assert_eq!(verdict("wet-friction-as-dry"), Some(Verdict::Holds));
        assert_eq!(verdict("dry-friction-as-wet"), Some(Verdict::Holds));
        // What was not run yet stands in no table.
        assert!(!measured.iter().any(|own| own.judged.name == "solid-fill"));
        let tables = tables(&sweep, &outcomes);
        let text = |name: &str| &tables.iter().find(|own| own.name == name).unwrap().text;
        let row = "| 8 | 3 | 33.00° ± 0.10° | 39.00° ± 0.10° | – |";
        assert!(text("numbers").contains(row), "{}", text("numbers"));
        let row = "| The wet bed stands higher than the dry one | ✗ | ✓ | ✓ |";
        assert!(text("verdicts").contains(row), "{}", text("verdicts"));
    }

    #[test]
    fn readings_that_tell_are_compared_at_the_radii_at_which_all_of_them_were_run() {
        let both = Selection {
            parts: vec!["r3".to_owned(), "r2".to_owned()],
            seeds: Some(1),
            ..Selection::default()
        };
        let job = PaperJob::new(&KASPER2021_READINGS, &both, "nowhere".into(), 1).unwrap();
        let cases = crate::sweep::cases(job.sweep()).unwrap();
        let radii = |fine: &[(&str, &[&str])]| {
            let is_there = |case: &&Case| {
                let [reading, radius, liquid, _] = &case.values[..] else {
                    return false;
                };
                let is_fine = |(own, missing): &(&str, &[&str])| {
                    own == reading && !missing.contains(&liquid.as_str())
                };
                let is_read = [AS_PRINTED, "as-coded", "shaded-caps"].contains(&reading.as_str());
                is_read && (radius == "3mm" || fine.iter().any(is_fine))
            };
            let there = cases.iter().filter(is_there);
            let outcomes: Vec<CaseResult> = there.map(|case| outcome(case, 30.0)).collect();
            let ensembles = ensembles(job.sweep(), &outcomes);
            let all: Vec<&Ensemble> = ensembles.iter().collect();
            let of = |measured: &[Measured]| {
                let radii = |own: &Measured| (own.judged.number, own.radii());
                measured.iter().map(radii).collect::<Vec<_>>()
            };
            let judged = Measured::all(&compared(&that_tell(&all), RADIUS));
            (of(&Measured::all(&all)), of(&judged))
        };
        let rows = |readings: &[(usize, &[f64])], measures: &[f64]| {
            let own = readings.iter().map(|(k, radii)| (*k, radii.to_vec()));
            let more = (0..OTHER_MEASURES.len()).map(|k| (READINGS.len() + k, measures.to_vec()));
            own.chain(more).collect::<Vec<_>>()
        };
        let (run, judged) = radii(&[(AS_PRINTED, &[])]);
        assert_eq!(
            run,
            rows(&[(0, &[3.0, 2.0]), (1, &[3.0]), (2, &[3.0])], &[3.0, 2.0])
        );
        assert_eq!(judged, rows(&[(0, &[3.0]), (1, &[3.0])], &[3.0]));
        // Finer grains of which a liquid is missing do not count yet.
        let (_, judged) = radii(&[(AS_PRINTED, &[]), ("as-coded", &["5"])]);
        assert_eq!(judged, rows(&[(0, &[3.0]), (1, &[3.0])], &[3.0]));
        // What is screened out needs no finer grains.
        let (_, judged) = radii(&[(AS_PRINTED, &[]), ("as-coded", &[])]);
        assert_eq!(
            judged,
            rows(&[(0, &[3.0, 2.0]), (1, &[3.0, 2.0])], &[3.0, 2.0])
        );
    }

    #[test]
    fn a_score_leaves_open_what_is_not_decided_and_names_what_none_reaches() {
        let (sweep, outcomes) = outcomes(|reading, liquid| match (reading, liquid) {
            (AS_PRINTED, "0") => Some(33.0),
            (AS_PRINTED, "1") => Some(27.0),
            _ => None,
        });
        let ensembles = ensembles(&sweep, &outcomes);
        let measured = Measured::all(&ensembles.iter().collect::<Vec<_>>());
        let own = &measured[0].judged;
        let [least, most] = own.score();
        assert_eq!(most - least, own.count(Verdict::NotDecided) as f64);
        assert_eq!(least, own.count(Verdict::Holds) as f64);
        let tables = tables(&sweep, &outcomes);
        let scores = &tables.iter().find(|own| own.name == "scores").unwrap().text;
        let missed = "No reading reaches: The wet bed stands higher than the dry one";
        assert!(scores.contains(missed), "{scores}");
    }

    #[test]
    fn other_measures_take_other_results_of_the_same_runs() {
        let (sweep, outcomes) = outcomes(|reading, _| (reading == AS_PRINTED).then_some(30.0));
        let ensembles = ensembles(&sweep, &outcomes);
        let measured = Measured::all(&ensembles.iter().collect::<Vec<_>>());
        let share = |name: &str| {
            let own = measured.iter().find(|own| own.judged.name == name).unwrap();
            own.number_text(3.0, "1", ResultKey::OfRun(RunQuantity::NonRigidShare))
        };
        assert_eq!(share(AS_PRINTED), "0.5 ± 0");
        assert_eq!(share("drops-from-2°"), "0.5 ± 0");
        assert_eq!(share("co-rotating-Tg"), "0.3 ± 0");
    }
}
