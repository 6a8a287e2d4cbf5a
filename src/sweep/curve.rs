//! A result over the one number that a sweep varies, with its errors and the paper's law where one
//! speaks of it; and those of the sweep's figures in which laws are drawn.
//!
//! In: what became of the cases. Out: plots, to draw on a screen or in a file. Points are means over
//! the seeds, or single runs, with one standard error.

use super::case::CaseResult;
use super::chart::{ChartAxis, Line, Plot};
use super::ensemble::{Ensemble, ensembles};
use super::plot_files::plots;
use super::results_table::columns;
use super::varied::{axis, only_number, shown};
use super::{Case, Sweep};
use crate::measure::{
    CRITICAL_ASPECT_RATIO, PEAK_TIME_LAW, REST_TIME_LAW, ResultKey, RunQuantity, TALL_ASPECT_RATIO,
    TALL_REST_TIME_LAW, beyond_kasper, cone_volume_law, drop_ratio_law, dry_drum, run_out_law,
};
use crate::run::Command;
use crate::scene::{SceneContainer, SceneGrains};
use crate::world::{World, build};

/// What the laws of columns are called, which go by the effective aspect ratio of each case.
const COLUMN_LAW: &str = "Man et al. 2023, at the case's α_eff";
/// What the law of the drops is called.
const DROP_LAW: &str = "Kasper et al. 2021: Δθ of the dry drum times Eq. 23";

/// The results that are a number in one of the `outcomes`, in the order of the registry.
pub fn numbers(outcomes: &[CaseResult]) -> Vec<ResultKey> {
    let is_number = |key: &ResultKey| {
        let has = |own: &CaseResult| own.result(*key).is_some_and(f64::is_finite);
        outcomes.iter().any(|own| own.is_sound() && has(own))
    };
    ResultKey::all().filter(is_number).collect()
}

/// The number that `case` has of what `sweep` varies, in the unit that people read it in; none where
/// that is not one number.
pub fn varied_number(sweep: &Sweep, case: &Case) -> Option<f64> {
    let varied = only_number(&sweep.variations)?;
    let mut own = sweep.variations.iter().zip(&case.values);
    let (_, text) = own.find(|(variation, _)| variation.key == varied.key)?;
    shown(&varied.key, text)
}

/// The result `key` over the number that `sweep` varies; none where it varies something else.
pub fn curve(sweep: &Sweep, outcomes: &[CaseResult], key: ResultKey) -> Option<Plot> {
    let varied = only_number(&sweep.variations)?;
    let sound = outcomes.iter().filter(|own| own.is_sound());
    let ensembles = ensembles(sweep, sound);
    let across = |ensemble: &Ensemble| varied_number(sweep, &ensemble.first().case);
    let factor = key.quantity().unit.shown.factor;
    let point = |own: &Ensemble| Some((across(own)?, own.estimate(key)?.times(factor)));
    let mut lines = vec![Line::means(
        name_of(&ensembles),
        ensembles.iter().filter_map(point),
    )];
    let by_law = |own: &Ensemble| Some((across(own)?, law(own, key)? * factor));
    let by_law: Vec<(f64, f64)> = ensembles.iter().filter_map(by_law).collect();
    if !by_law.is_empty() {
        lines.push(Line {
            is_law: true,
            ..Line::results(law_name(key), by_law)
        });
    }
    let label = key.quantity().axis();
    Some(Plot {
        file: format!("curves/{}.svg", slug(&key.name())),
        title: format!("{} over {}", key.label(), varied.key),
        x: axis(varied),
        y: ChartAxis::linear(&label),
        lines,
    })
}

/// The curves of the results that people compare.
pub(super) fn curves(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<Plot> {
    let columns = columns(outcomes.iter().any(CaseResult::is_column)).iter();
    let plots = columns.filter_map(|column| curve(sweep, outcomes, column.key()));
    plots.collect()
}

/// The figures of `sweep` in which a paper's laws are drawn, over what the paper draws them over.
pub fn figures(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<Plot> {
    let has_law = |plot: &Plot| plot.lines.iter().any(|line| line.is_law);
    let is_course = |plot: &Plot| plot.file.starts_with("courses/");
    let figures = plots(sweep, outcomes);
    figures
        .filter(|plot| has_law(plot) && !is_course(plot) && plot.has_points())
        .collect()
}

/// What the points are.
fn name_of(ensembles: &[Ensemble]) -> String {
    let seeds = ensembles.iter().map(|own| own.members.len()).max();
    match seeds.unwrap_or(1) {
        0 | 1 => "runs".to_owned(),
        seeds => format!("means over {seeds} seeds"),
    }
}

/// `name` in letters, digits and strokes.
fn slug(name: &str) -> String {
    let plain = |letter: char| {
        if letter.is_alphanumeric() {
            letter
        } else {
            '-'
        }
    };
    let plain: String = name.chars().map(plain).collect();
    let parts: Vec<&str> = plain.split('-').filter(|part| !part.is_empty()).collect();
    parts.join("-")
}

fn law_name(key: ResultKey) -> &'static str {
    match key {
        ResultKey::OfRun(RunQuantity::Drop) => DROP_LAW,
        _ => COLUMN_LAW,
    }
}

/// What the laws of the papers say of the result `key` of an ensemble, in the SI unit; none where
/// they say nothing.
fn law(ensemble: &Ensemble, key: ResultKey) -> Option<f64> {
    let ResultKey::OfRun(quantity) = key else {
        return None;
    };
    let effective = || ensemble.mean(RunQuantity::EffectiveAspectRatio);
    match quantity {
        RunQuantity::RunOut => effective().map(run_out_law),
        RunQuantity::RelativeConeVolume => effective().map(cone_volume_law),
        RunQuantity::DimensionlessPeakTime => effective().map(|own| PEAK_TIME_LAW * own.sqrt()),
        RunQuantity::DimensionlessRestTime => effective().and_then(rest_time),
        RunQuantity::Drop => drop_by_law(&ensemble.first().case),
        _ => None,
    }
}

/// The time of rest over the effective aspect ratio, of which the paper says nothing between 3.5 and
/// 13.
fn rest_time(effective: f64) -> Option<f64> {
    match effective {
        low if low <= CRITICAL_ASPECT_RATIO => Some(REST_TIME_LAW * low.sqrt()),
        tall if tall >= TALL_ASPECT_RATIO => Some(TALL_REST_TIME_LAW * tall.sqrt()),
        _ => None,
    }
}

/// The drop of a wet drum of the paper [rad]: that of the dry one times Eq. 23.
fn drop_by_law(case: &Case) -> Option<f64> {
    let is_drum = matches!(case.scene.container, SceneContainer::Drum { .. });
    let is_filled = matches!(case.scene.grains, SceneGrains::Fill { .. });
    if !is_drum || !is_filled {
        return None;
    }
    let world = at_start(case);
    let liquid = world.wetting().filter(|liquid| liquid.volume > 0.0)?;
    if beyond_kasper(&world).is_some() {
        return None;
    }
    let dry = dry_drum(*world.grains.radius.first()?)?;
    Some(dry.drop.mean * drop_ratio_law(liquid.viscosity))
}

/// The world of `case` before anything settled, with what is set at its first step.
fn at_start(case: &Case) -> World {
    let mut world = build(&case.scene, case.time_step);
    for scripted in &case.script {
        if let Command::Set { parameter, value } = &scripted.command {
            parameter.write(*value, &case.scene, &mut world);
        }
    }
    world
}

#[cfg(test)]
mod tests {
    use super::super::{Variation, cases};
    use super::*;
    use crate::measure::{Estimate, MeasuredValue, Summary, SummaryEntry};
    use crate::run::BedStore;
    use crate::scene::Scene;

    fn sweep(scene: &str, variations: &[&str]) -> Sweep {
        let variations = variations.iter();
        Sweep {
            name: scene.into(),
            scene: Scene::open(scene).unwrap(),
            settings: Vec::new(),
            variations: variations
                .map(|text| Variation::parse(text).unwrap())
                .collect(),
            out: "nowhere".into(),
            jobs: 1,
            beds: BedStore::none(),
            restart: false,
        }
    }

    /// The cases of `sweep`, each with these results [SI unit].
    fn outcomes(
        sweep: &Sweep,
        results: &dyn Fn(usize) -> Vec<(ResultKey, MeasuredValue)>,
    ) -> Vec<CaseResult> {
        let cases = cases(sweep).unwrap().into_iter().enumerate();
        let outcome = |(index, case): (usize, Case)| {
            let entry = |(key, value): (ResultKey, MeasuredValue)| SummaryEntry {
                key,
                value: Some(value),
                note: String::new(),
            };
            let summary = Summary {
                from: 0.0,
                to: 1.0,
                samples: 50,
                entries: results(index).into_iter().map(entry).collect(),
            };
            CaseResult::kept(&case, summary, "0".repeat(32), "method".into())
        };
        cases.map(outcome).collect()
    }

    #[test]
    fn a_curve_has_a_point_for_each_value_with_the_error_over_its_seeds() {
        let sweep = sweep("small-drum", &["drum-speed=3rpm,6rpm", "seed=1,2"]);
        let drop = ResultKey::OfRun(RunQuantity::Drop);
        let degrees: [f64; 4] = [4.0, 6.0, 1.0, 2.0];
        let all = outcomes(&sweep, &|index| {
            vec![(drop, MeasuredValue::Number(degrees[index].to_radians()))]
        });
        assert_eq!(numbers(&all), [drop]);
        let plot = curve(&sweep, &all, drop).unwrap();
        let line = &plot.lines[0];
        assert_eq!(
            (plot.lines.len(), line.name.as_str()),
            (1, "means over 2 seeds")
        );
        assert_eq!(plot.x.label(), "drum-speed [rpm]");
        for ((x, y), expected) in line.points.iter().zip([(3.0, 5.0), (6.0, 1.5)]) {
            assert!((x - expected.0).abs() < 1e-12 && (y - expected.1).abs() < 1e-12);
        }
        // s/√n of two values that are d apart is d/2.
        let errors = line.bars.iter().map(|(_, low, high)| 0.5 * (high - low));
        for (error, expected) in errors.zip([1.0, 0.5]) {
            assert!((error - expected).abs() < 1e-12, "{error}");
        }
        let numbers: Vec<Option<f64>> = all
            .iter()
            .map(|own| varied_number(&sweep, &own.case))
            .collect();
        assert_eq!(numbers[0], numbers[1]);
        assert!((numbers[2].unwrap() - 6.0).abs() < 1e-12);
    }

    #[test]
    fn a_single_run_has_its_own_error_and_a_fault_is_no_point() {
        let sweep = sweep("small-drum", &["drum-speed=3rpm,6rpm"]);
        let share = ResultKey::OfRun(RunQuantity::NonRigidShare);
        let mean = Estimate {
            mean: 0.25,
            error: Some(0.05),
            samples: 20,
            freedom: 19,
        };
        let mut all = outcomes(&sweep, &|_| vec![(share, MeasuredValue::Mean(mean))]);
        all[1].ending = crate::output::Ending::Faulted(crate::solver::Fault {
            grain: 0,
            time: 0.5,
            good_time: 0.4,
            kind: crate::solver::FaultKind::TooFast(1e3),
        });
        let plot = curve(&sweep, &all, share).unwrap();
        let line = &plot.lines[0];
        assert_eq!((line.points.len(), line.name.as_str()), (1, "runs"));
        let (_, low, high) = line.bars[0];
        let factor = share.quantity().unit.shown.factor;
        assert!((low - 0.2 * factor).abs() < 1e-12 && (high - 0.3 * factor).abs() < 1e-12);
    }

    #[test]
    fn the_law_of_the_drops_is_drawn_for_the_papers_drum_alone() {
        let drop = ResultKey::OfRun(RunQuantity::Drop);
        let lines = |scene: &str| {
            let sweep = sweep(scene, &["viscosity=0.00101,0.295"]);
            let all = outcomes(&sweep, &|_| vec![(drop, MeasuredValue::Number(0.1))]);
            curve(&sweep, &all, drop).unwrap().lines
        };
        let [_, law] = &lines("water-drum")[..] else {
            panic!("a law is drawn");
        };
        let radius = at_start(&cases(&sweep("water-drum", &["seed=1"])).unwrap()[0])
            .grains
            .radius[0];
        let dry = dry_drum(radius).unwrap().drop.mean.to_degrees();
        // At 295 mPa s Eq. 23 is 0.4 + 0.47/e.
        let expected = dry * (0.4 + 0.47 / std::f64::consts::E);
        assert!(
            (law.points[1].1 / expected - 1.0).abs() < 1e-9,
            "{:?}",
            law.points
        );
        assert_eq!(lines("small-drum").len(), 1, "its drum is another one");
    }

    #[test]
    fn the_laws_of_columns_stand_at_each_cases_aspect_ratio() {
        let sweep = sweep("column", &["mu11=0.1,0.4"]);
        let alpha = [2.0, 5.0];
        let all = outcomes(&sweep, &|index| {
            let number = MeasuredValue::Number;
            let effective = RunQuantity::EffectiveAspectRatio;
            vec![
                (effective.into(), number(alpha[index])),
                (RunQuantity::RunOut.into(), number(1.0)),
                (RunQuantity::DimensionlessRestTime.into(), number(1.0)),
            ]
        });
        let law = |quantity: RunQuantity| {
            let plot = curve(&sweep, &all, quantity.into()).unwrap();
            plot.lines[1].points.clone()
        };
        let run_out: Vec<f64> = law(RunQuantity::RunOut)
            .iter()
            .map(|point| point.1)
            .collect();
        assert_eq!(run_out, alpha.map(run_out_law));
        let rest = law(RunQuantity::DimensionlessRestTime);
        assert_eq!(rest.len(), 1, "between 3.5 and 13 the paper says nothing");
        assert!((rest[0].1 - 4.5 * 2.0_f64.sqrt()).abs() < 1e-12);
    }
}
