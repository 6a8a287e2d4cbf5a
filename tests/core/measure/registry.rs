//! The registry of measured quantities: every row is complete, every key is its own, every result
//! is found by its key and its name.

use super::*;
use grainfall::measure::{
    DepositShape, DropThreshold, FlowHistory, Format, GrainQuantity, Measure, MeasuredValue,
    Quantity, Regime, ResultKey, RunQuantity, Series, results, sample,
};
use grainfall::run::Column;
use std::collections::HashSet;

fn rows() -> impl Iterator<Item = &'static Quantity> {
    let measures = Measure::ALL.into_iter().map(Measure::quantity);
    let of_runs = RunQuantity::ALL.into_iter().map(RunQuantity::quantity);
    let of_grains = GrainQuantity::ALL.into_iter().map(GrainQuantity::quantity);
    measures.chain(of_runs).chain(of_grains)
}

#[test]
fn every_row_is_complete() {
    for row in rows() {
        assert!(
            !row.key.is_empty() && !row.description.is_empty(),
            "{row:?}"
        );
        assert!(
            !row.label().is_empty() && !row.unit.si.is_empty(),
            "{row:?}"
        );
        assert!(row.unit.shown.factor > 0.0, "{row:?}");
        // A pure number has no unit for people, and nothing else has none.
        assert_eq!(
            row.unit.si == "1",
            row.unit.shown.name.is_empty(),
            "{row:?}"
        );
        if let Format::Choice(words) = row.format {
            assert!(words.len() > 1, "{row:?}");
        }
    }
}

#[test]
fn every_result_has_a_name_of_its_own_by_which_it_is_found() {
    let names: HashSet<String> = ResultKey::all().map(ResultKey::name).collect();
    assert_eq!(names.len(), ResultKey::all().count());
    for key in ResultKey::all() {
        assert_eq!(ResultKey::named(&key.name()), Some(key));
        assert!(!key.label().is_empty());
    }
    assert_eq!(ResultKey::named("drop"), None);
    let drops = ResultKey::OfAvalanches(RunQuantity::Drop, DropThreshold::HalfDegree);
    assert_eq!(ResultKey::named("drop Δθ (≥ 0.5°)"), Some(drops));
}

#[test]
fn measures_and_grain_quantities_have_their_own_keys_and_columns() {
    for (column, measure) in Measure::ALL.into_iter().enumerate() {
        assert_eq!(measure as usize, column);
    }
    let keys: HashSet<_> = GrainQuantity::ALL.map(|q| q.quantity().key).into();
    assert_eq!(keys.len(), GrainQuantity::COUNT);
    assert_eq!(GrainQuantity::Liquid.unit(), "L");
    assert_eq!(Measure::SurfaceAngle.quantity().label(), "Surface angle θ");
    let column = Column::of(Measure::SurfaceAngle.quantity());
    assert_eq!(column.head(), "surface angle [rad]");
}

#[test]
fn every_choice_is_a_word_of_its_row() {
    let words = |quantity: RunQuantity| match quantity.quantity().format {
        Format::Choice(words) => words,
        format => panic!("{format:?}"),
    };
    let regimes = [
        Regime::Avalanching,
        Regime::Transitional,
        Regime::Continuous,
    ];
    assert_eq!(regimes.map(Regime::word)[..], *words(RunQuantity::Regime));
    let shapes = [DepositShape::Cone, DepositShape::Frustum];
    assert_eq!(
        shapes.map(DepositShape::word)[..],
        *words(RunQuantity::Shape)
    );
}

/// The results of a bed and of a column, of a few samples each.
fn summaries() -> [grainfall::measure::Summary; 2] {
    let mut bed = drum(0.05, 0.02, 0.1);
    push(&mut bed, DVec3::new(0.0, -0.049, 0.0), 1e-3);
    let mut heap = column(0.025, 0.05, [0.1, 0.4]);
    put(&mut heap, DVec3::Y * 1e-3, 1e-3, 0);
    [bed, heap].map(|world| {
        let mut series = Series::default();
        for step in 0..4 {
            let mut state = sample(&world);
            state.time = 0.02 * f64::from(step);
            series.push(state);
        }
        results(&series, &FlowHistory::default(), &world, 0.0, 0.01)
    })
}

#[test]
fn results_hold_what_their_rows_say() {
    for summary in summaries() {
        assert!(!summary.entries.is_empty());
        for entry in &summary.entries {
            let format = entry.key.quantity().format;
            let fits = match entry.value {
                None => true,
                Some(MeasuredValue::Number(_) | MeasuredValue::Mean(_)) => {
                    !matches!(format, Format::Choice(_))
                }
                Some(MeasuredValue::Count(_)) => format == Format::Count,
                Some(MeasuredValue::Choice(word)) => {
                    matches!(format, Format::Choice(words) if words.contains(&word))
                }
            };
            assert!(fits, "{entry:?}");
            assert_eq!(summary.entry(entry.key), Some(entry));
            assert_eq!(summary.get(entry.key), entry.value);
            assert!(!entry.note.is_empty(), "{entry:?}");
        }
    }
}

#[test]
fn what_no_run_has_is_a_dash() {
    let [bed, heap] = summaries();
    assert_eq!(bed.value(RunQuantity::RunOut), None);
    assert_eq!(bed.text(RunQuantity::RunOut), "–");
    assert_eq!(heap.text(RunQuantity::Regime), "–");
    assert_eq!(bed.text(RunQuantity::InverseRootGalilei), "–");
    assert_eq!(bed.text(RunQuantity::Avalanches), "0");
}
