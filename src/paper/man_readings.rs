//! The readings of Man et al. 2023: what its text leaves open of grains and measures, one departure
//! at a time, and what becomes of its statements under each.
//!
//! In: what a reading sets, or by what it measures. Out: the cases, and tables of what they came to.
//! How round the grains' edges are stands in the first author's program, not in the paper; what is the
//! front of a deposit that ends in single grains, and when it is at rest, stands nowhere. Order of the
//! cases: low columns, which cost least, and one seed of all before more.

use super::man2023::MAN2023;
use super::markdown::{head, line};
use super::plan::{Batch, Paper, PaperTable, Reading};
use super::readings::{AS_PRINTED, Judged, compared, tables_of};
use crate::measure::{Measure, ResultKey, RunQuantity, numeral::NOTHING};
use crate::sweep::{
    CaseResult, Column, ColumnMeasure, Columns, Ensemble, READING, Sweep, column_statements,
    ensembles, rounded,
};

/// The readings, as a paper of their own.
pub static MAN2023_READINGS: Paper = Paper {
    name: "man2023-readings",
    source: "Readings of Man et al. 2023, the collapse of columns of grains of two frictions",
    keys: &[READING, "height", "mix"],
    readings: READINGS,
    batches: &[
        Batch::new("h1", &[AS_PRINTED, H1], MIXES, (1, 3)),
        Batch::new("h1", &[SHARP, H1], MIXES, (1, 1)),
        Batch::new("h1", &[ROUND, H1], MIXES, (1, 1)),
        Batch::new("h5", &[AS_PRINTED, H5], MIXES, (1, 3)),
        Batch::new("h5", &[SHARP, H5], MIXES, (1, 1)),
        Batch::new("h5", &[ROUND, H5], MIXES, (1, 1)),
        Batch::new("h1", &[SHARP, H1], MIXES, (2, 3)),
        Batch::new("h1", &[ROUND, H1], MIXES, (2, 3)),
    ],
    // Those of the paper, less the rounding.
    small_settings: &[
        "duration=60ms",
        "until=duration",
        "radius=10mm",
        "cell=4mm",
        "normal-stiffness=100",
        "time-step=automatic",
    ],
    small_batches: &[
        Batch::new("h1", &[AS_PRINTED, H1], &["0.3"], (1, 2)),
        Batch::new("round", &[ROUND, H1], &["0.3"], (1, 2)),
    ],
    tables,
    ..MAN2023
};

const SHARP: &str = "sharper-edges";
const ROUND: &str = "rounder-edges";
const H1: &str = "10mm";
const H5: &str = "50mm";
const MIXES: &[&str] = &["0.1", "0.3", "0.5"];
/// Where among the values of a case its height and its mixture stand, at which readings are compared.
const COLUMN: std::ops::Range<usize> = 1..3;

static READINGS: &[Reading] = &[
    Reading {
        name: AS_PRINTED,
        text: "with the choices of all other tables: edges rounded by 0.1 mm",
        settings: &[],
    },
    Reading {
        name: SHARP,
        // As sharp as steps of 20 µs bear at H 5: in one of them nothing may go farther than half of it.
        text: "edges rounded by 0.07 mm",
        settings: &["rounding=0.07mm"],
    },
    Reading {
        name: ROUND,
        text: "edges rounded by 0.2 mm",
        settings: &["rounding=0.2mm"],
    },
];

/// Other measures of the same runs.
const OTHER_MEASURES: [(&str, &str, ColumnMeasure); 5] = [
    (
        "front-of-99-%",
        "as printed; R_∞ is the radius that holds 99 % of the grains' centres",
        ColumnMeasure::Front(Measure::FrontRadius99),
    ),
    (
        "front-of-95-%",
        "as printed; R_∞ is the radius that holds 95 % of them",
        ColumnMeasure::Front(Measure::FrontRadius95),
    ),
    (
        "front-of-cluster",
        "as printed; R_∞ is that of the largest cluster of grains that touch",
        ColumnMeasure::Front(Measure::ClusterRadius),
    ),
    (
        "rest-of-energy",
        "as printed; at rest when the kinetic energy is below 1 % of its peak, wherever the front is",
        ColumnMeasure::Rest(RunQuantity::EnergyRestTime),
    ),
    (
        "rest-of-front",
        "as printed; at rest when the front is within 1 % of R_∞, however fast grains are",
        ColumnMeasure::Rest(RunQuantity::FrontRestTime),
    ),
];

/// The tables, from the cases that are there.
fn tables(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<PaperTable> {
    let ensembles = ensembles(sweep, outcomes);
    let all: Vec<&Ensemble> = ensembles.iter().collect();
    let measured = Measured::all(&compared(&all, COLUMN), &all);
    let judged: Vec<&Judged> = measured.iter().map(|own| &own.judged).collect();
    tables_of(&judged, &judged, numbers_table(&measured))
}

/// A reading with its columns.
struct Measured<'a> {
    judged: Judged,
    columns: Columns<'a>,
}

impl<'a> Measured<'a> {
    /// The readings of which there are columns among `ensembles`, and other measures of those as
    /// printed. What a single column scatters by is looked for in `all`.
    fn all(ensembles: &[&'a Ensemble<'a>], all: &'a [&'a Ensemble<'a>]) -> Vec<Self> {
        let runs = READINGS.iter();
        let runs = runs.map(|own| (own.name, own.text, own.name, ColumnMeasure::Usual));
        let measures = OTHER_MEASURES.iter();
        let measures = measures.map(|own| (own.0, own.1, AS_PRINTED, own.2));
        let mut found = Vec::new();
        for (name, text, run, measured_by) in runs.chain(measures) {
            let own = ensembles.iter().copied().filter(|own| own.values[0] == run);
            let columns = Columns::of(own, all, measured_by);
            if columns.0.is_empty() {
                continue;
            }
            let runs = columns.0.iter().map(|own| own.ensemble.members.len());
            found.push(Self {
                judged: Judged {
                    number: found.len(),
                    name: name.to_owned(),
                    text: text.to_owned(),
                    runs: runs.sum(),
                    statements: column_statements(&columns),
                },
                columns,
            });
        }
        found
    }

    /// A result of the column of this height [mm] and share of rough grains.
    fn number_text(&self, height: f64, share: f64, key: ResultKey) -> String {
        let is_it = |own: &&Column| own.height == height && own.share == share;
        let found = self.columns.0.iter().find(is_it);
        let estimate = found.and_then(|own| own.get(key));
        estimate.map_or_else(|| NOTHING.to_owned(), |own| key.quantity().text(own))
    }
}

/// A result of the columns of one share of rough grains, and what its column is called.
type Number = (&'static str, f64, RunQuantity);

/// The columns of the table of numbers.
const NUMBERS: [Number; 7] = [
    ("ℛ, 10 %", 0.1, RunQuantity::RunOut),
    ("ℛ, 30 %", 0.3, RunQuantity::RunOut),
    ("ℛ, 50 %", 0.5, RunQuantity::RunOut),
    ("V_cone/V_init, 30 %", 0.3, RunQuantity::RelativeConeVolume),
    ("H_∞/R_i, 30 %", 0.3, RunQuantity::RelativeHeight),
    ("T_max, 30 %", 0.3, RunQuantity::DimensionlessPeakTime),
    ("T_f, 30 %", 0.3, RunQuantity::DimensionlessRestTime),
];

/// A row for each reading and height.
fn numbers_table(measured: &[Measured]) -> String {
    let heads = ["", "H [mm]"].into_iter();
    let heads = heads.chain(NUMBERS.map(|(name, ..)| name));
    let mut text = head(&heads.map(str::to_owned).collect::<Vec<_>>());
    for own in measured {
        let mut heights: Vec<f64> = own.columns.0.iter().map(|own| own.height).collect();
        heights.dedup();
        for height in heights {
            let first = [own.judged.number.to_string(), rounded(height)];
            let of = |(_, share, key): &Number| own.number_text(height, *share, (*key).into());
            let cells: Vec<String> = first.into_iter().chain(NUMBERS.iter().map(of)).collect();
            text += &line(&cells);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::Summary;
    use crate::paper::{PaperJob, Selection};
    use crate::sweep::Case;

    /// A column whose front ends at 60 mm, from 25 mm on.
    fn outcome(case: &Case) -> CaseResult {
        let by = case.values.last().unwrap().parse::<f64>().unwrap();
        let front = 0.06 + 0.001 * (by - 2.0);
        let results = Summary::of_numbers(&[
            (RunQuantity::EffectiveAspectRatio.into(), 0.5),
            (RunQuantity::FinalFront.into(), front),
            (RunQuantity::RunOut.into(), front / 0.025 - 1.0),
            (Measure::FrontRadius99.into(), 0.05),
            (RunQuantity::RelativeConeVolume.into(), front * front),
            (RunQuantity::PeakTime.into(), 0.05),
            (RunQuantity::DimensionlessPeakTime.into(), 1.0),
            (RunQuantity::RestTime.into(), 0.3),
            (RunQuantity::FrontRestTime.into(), 0.2),
            (RunQuantity::DimensionlessRestTime.into(), 6.0),
        ]);
        CaseResult::kept(case, results, String::new(), String::new())
    }

    /// The tables of the cases that are `there`.
    fn tables_of(there: impl Fn(&Case) -> bool) -> Vec<PaperTable> {
        let paper = &MAN2023_READINGS;
        let job = PaperJob::new(paper, &Selection::default(), "nowhere".into(), 1).unwrap();
        let cases = crate::sweep::cases(job.sweep()).unwrap();
        let there = cases.iter().filter(|case| there(case));
        let outcomes: Vec<CaseResult> = there.map(outcome).collect();
        tables(job.sweep(), &outcomes)
    }

    fn text<'a>(tables: &'a [PaperTable], name: &str) -> &'a str {
        &tables.iter().find(|own| own.name == name).unwrap().text
    }

    #[test]
    fn other_measures_are_taken_of_the_columns_as_printed() {
        let tables = tables_of(|case| case.values[0] == AS_PRINTED && case.values[1] == H1);
        let numbers = text(&tables, "numbers");
        let row = |number: usize| {
            let start = format!("| {number} | 10 | ");
            let row = numbers.lines().find(|row| row.starts_with(&start));
            let row = row.unwrap_or_else(|| panic!("no {start} in {numbers}"));
            row.split(" | ").map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(
            row(0)[2..6],
            [
                "1.40 ± 0.02",
                "1.40 ± 0.02",
                "1.40 ± 0.02",
                "0.00360 ± 0.00007"
            ]
        );
        assert_eq!(row(0)[8], "6 ± 0 |");
        // ℛ of 50 mm is 1; (50/60)² of V_cone.
        assert_eq!(row(1)[2..6], ["1 ± 0", "1 ± 0", "1 ± 0", "0.0025 ± 0"]);
        // No energy says when it was at rest; by the front at 4 times the unit of 0.05 s.
        assert_eq!(row(4)[8], "– |");
        assert_eq!(row(5)[8], "4 ± 0 |");
        let runs = "| 5 | rest-of-front | as printed; at rest when the front is within 1 % of R_∞, \
                    however fast grains are | 9 |";
        assert!(text(&tables, "readings").contains(runs));
    }

    #[test]
    fn readings_are_compared_where_all_were_run() {
        let tables = tables_of(|case| match &case.values[..3] {
            [reading, height, mix] if reading == ROUND => height == H1 && mix == "0.3",
            [reading, ..] => reading == AS_PRINTED,
            _ => false,
        });
        let numbers = text(&tables, "numbers");
        assert!(
            numbers.contains("| 1 | 10 | – | 1.40 ± 0.02 | – |"),
            "{numbers}"
        );
        assert!(!numbers.contains("| 50 |"), "{numbers}");
        assert!(text(&tables, "readings").contains("| 1 | rounder-edges |"));
    }
}
