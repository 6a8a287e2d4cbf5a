//! The table of all results, one row per case.

use super::Sweep;
use super::case::{CaseEnding, Outcome, write};
use crate::headless::HeadlessError;
use crate::simulation::{Provenance, TABLES_METADATA};
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

const DRUM: &[Column] = &[
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

const COLLAPSE: &[Column] = &[
    column("α", "aspect ratio α", 1.0, Digits::Fixed(3)),
    column(
        "α_eff",
        "effective aspect ratio α_eff",
        1.0,
        Digits::Fixed(3),
    ),
    column("φ_i", "solid fraction φ_i", 1.0, Digits::Fixed(3)),
    column("R_∞ [mm]", "front radius R_∞", 1e3, Digits::Fixed(2)),
    column("R_99 [mm]", "99 % radius", 1e3, Digits::Fixed(2)),
    column("R_95 [mm]", "95 % radius", 1e3, Digits::Fixed(2)),
    column("R_c [mm]", "cluster radius", 1e3, Digits::Fixed(2)),
    column("ℛ", "run-out ℛ", 1.0, Digits::Fixed(3)),
    column("H_∞ [mm]", "height H_∞", 1e3, Digits::Fixed(2)),
    column("H_a [mm]", "apex height", 1e3, Digits::Fixed(2)),
    column("H_∞/R_i", "H_∞/R_i", 1.0, Digits::Fixed(3)),
    column("V_cone/V_init", "V_cone/V_init", 1.0, Digits::Fixed(3)),
    column("t_max [s]", "peak time t_max", 1.0, Digits::Fixed(2)),
    column("t_f [s]", "rest time t_f", 1.0, Digits::Fixed(2)),
    column("T_max", "T_max", 1.0, Digits::Fixed(2)),
    column("T_f", "T_f", 1.0, Digits::Fixed(2)),
    // The paper's unit: 1 g cm²/s² is 1e-7 J.
    column(
        "peak energy [g cm²/s²]",
        "peak energy",
        1e7,
        Digits::Fixed(2),
    ),
    column("P11", "pairs of first species", 1.0, Digits::Fixed(3)),
    column("P12", "mixed pairs", 1.0, Digits::Fixed(3)),
    column("P22", "pairs of second species", 1.0, Digits::Fixed(3)),
    column("frustum", "deposit shape", 1.0, Digits::Fixed(0)),
    column("Z", "coordination number", 1.0, Digits::Fixed(2)),
    column("largest overlap", "largest overlap", 1.0, Digits::Fixed(4)),
    column(
        "energy residual",
        "relative energy residual",
        1.0,
        Digits::Scientific,
    ),
];

/// The columns that suit what was run.
fn columns(outcomes: &[Outcome]) -> &'static [Column] {
    if outcomes.iter().any(Outcome::is_column) {
        COLLAPSE
    } else {
        DRUM
    }
}

/// Writes `table.csv` and `table.md`.
///
/// # Errors
/// When a file cannot be written.
pub fn write_tables(sweep: &Sweep, outcomes: &[Outcome]) -> Result<(), HeadlessError> {
    let columns = columns(outcomes);
    write(&sweep.out.join("table.csv"), |file| {
        let mut writer = csv::Writer::from_writer(file);
        writer.write_record(heads(sweep, columns))?;
        for outcome in outcomes {
            writer.write_record(cells(outcome, columns))?;
        }
        writer.flush()
    })?;
    write(&sweep.out.join(TABLES_METADATA), |file| {
        Provenance::of_scene(&sweep.scene).write_tables(&["table.csv"], file)
    })?;
    let text = markdown(sweep, outcomes);
    write(&sweep.out.join("table.md"), |file| {
        file.write_all(text.as_bytes())
    })
}

/// The table in Markdown.
pub fn markdown(sweep: &Sweep, outcomes: &[Outcome]) -> String {
    let columns = columns(outcomes);
    let heads = heads(sweep, columns);
    let mut text = String::new();
    let mut line = |cells: &[String]| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {} |", cells.join(" | "));
    };
    line(&heads);
    line(&vec!["---".to_owned(); heads.len()]);
    for outcome in outcomes {
        line(&cells(outcome, columns));
    }
    text
}

fn heads(sweep: &Sweep, columns: &[Column]) -> Vec<String> {
    let varied = sweep
        .variations
        .iter()
        .map(|variation| variation.key.clone());
    let results = columns.iter().map(|column| column.head.to_owned());
    let fixed = ["time [s]", "ended", "state"].map(str::to_owned);
    varied.chain(results).chain(fixed).collect()
}

fn cells(outcome: &Outcome, columns: &[Column]) -> Vec<String> {
    let values = outcome.case.values.iter().cloned();
    let results = columns.iter().map(|column| {
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
