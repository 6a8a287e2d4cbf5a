//! The table of all results, one row per case.

use super::Sweep;
use super::case::{CaseEnding, Outcome, write};
use crate::headless::HeadlessError;
use std::fmt::Write as _;

/// A column: its head with the unit it is shown in, the result it shows, how much of the SI unit that is, its digits.
struct Column {
    head: &'static str,
    result: &'static str,
    factor: f64,
    digits: Digits,
}

enum Digits {
    Fixed(usize),
    Scientific,
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

const fn column(head: &'static str, result: &'static str, factor: f64, digits: Digits) -> Column {
    Column {
        head,
        result,
        factor,
        digits,
    }
}

const COLUMNS: &[Column] = &[
    column("θ [°]", "surface angle", DEGREES, Digits::Fixed(2)),
    column("θ_m [°]", "maximum angle θ_m", DEGREES, Digits::Fixed(2)),
    column("θ_r [°]", "repose angle θ_r", DEGREES, Digits::Fixed(2)),
    column("Δθ [°]", "drop Δθ", DEGREES, Digits::Fixed(2)),
    column("drops", "avalanches", 1.0, Digits::Fixed(0)),
    column(
        "Δθ ≥ 0.5° [°]",
        "drop Δθ (≥ 0.5°)",
        DEGREES,
        Digits::Fixed(2),
    ),
    column("Δθ ≥ 2° [°]", "drop Δθ (≥ 2°)", DEGREES, Digits::Fixed(2)),
    column("Δθ ≥ 3° [°]", "drop Δθ (≥ 3°)", DEGREES, Digits::Fixed(2)),
    column(
        "Tg [m²/s²]",
        "granular temperature",
        1.0,
        Digits::Scientific,
    ),
    column(
        "Tg′ [m²/s²]",
        "co-rotating temperature",
        1.0,
        Digits::Scientific,
    ),
    column("ta/ts", "non-rigid share ta/ts", 1.0, Digits::Fixed(3)),
    column("√(1/Ga)", "√(1/Ga)", 1.0, Digits::Fixed(4)),
    column("Ca", "capillary number Ca", 1.0, Digits::Fixed(3)),
    column("φ", "packing fraction", 1.0, Digits::Fixed(3)),
    column("Z", "coordination number", 1.0, Digits::Fixed(2)),
    column("h [mm]", "surface roughness", 1e3, Digits::Fixed(3)),
    column("κ [1/m]", "surface curvature", 1.0, Digits::Fixed(2)),
    column("bridges", "bridges", 1.0, Digits::Fixed(0)),
    column(
        "ruptures [1/s]",
        "ruptures per second",
        1.0,
        Digits::Fixed(1),
    ),
    column("drum power [mW]", "drum power", 1e3, Digits::Fixed(3)),
    column("viscous loss [J]", "viscous loss", 1.0, Digits::Scientific),
    column("largest overlap", "largest overlap", 1.0, Digits::Fixed(4)),
    column(
        "energy residual",
        "relative energy residual",
        1.0,
        Digits::Scientific,
    ),
];

/// Writes `table.csv` and `table.md`.
///
/// # Errors
/// When a file cannot be written.
pub fn write_tables(sweep: &Sweep, outcomes: &[Outcome]) -> Result<(), HeadlessError> {
    write(&sweep.out.join("table.csv"), |file| {
        let mut writer = csv::Writer::from_writer(file);
        writer.write_record(heads(sweep))?;
        for outcome in outcomes {
            writer.write_record(cells(outcome))?;
        }
        writer.flush()
    })?;
    let text = markdown(sweep, outcomes);
    write(&sweep.out.join("table.md"), |file| {
        file.write_all(text.as_bytes())
    })
}

/// The table in Markdown.
pub fn markdown(sweep: &Sweep, outcomes: &[Outcome]) -> String {
    let heads = heads(sweep);
    let mut text = String::new();
    let mut line = |cells: &[String]| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    };
    line(&heads);
    line(&vec!["---".to_owned(); heads.len()]);
    for outcome in outcomes {
        line(&cells(outcome));
    }
    text
}

fn heads(sweep: &Sweep) -> Vec<String> {
    let varied = sweep
        .variations
        .iter()
        .map(|variation| variation.key.clone());
    let results = COLUMNS.iter().map(|column| column.head.to_owned());
    let fixed = ["time [s]", "ended", "state"].map(str::to_owned);
    varied.chain(results).chain(fixed).collect()
}

fn cells(outcome: &Outcome) -> Vec<String> {
    let values = outcome.case.values.iter().cloned();
    let results = COLUMNS.iter().map(|column| {
        outcome.result(column.result).map_or_else(
            || "–".to_owned(),
            |value| match column.digits {
                Digits::Fixed(digits) => format!("{:.digits$}", column.factor * value),
                Digits::Scientific => format!("{:.2e}", column.factor * value),
            },
        )
    });
    let ended = match outcome.ending {
        CaseEnding::Done => "done",
        CaseEnding::Interrupted => "stopped",
        CaseEnding::Faulted => "fault",
    };
    let fixed = [
        format!("{:.2}", outcome.results.to),
        ended.to_owned(),
        outcome.hash[..8].to_owned(),
    ];
    values.chain(results).chain(fixed).collect()
}
