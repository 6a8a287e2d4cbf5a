//! The results that people compare, one row per case: `table.md`.
//!
//! In: what became of the cases of a sweep. Out: a table in Markdown with the columns that suit
//! drums or columns. Units and digits come from the registry of quantities.

use super::Sweep;
use super::case::CaseResult;
use crate::measure::numeral::NOTHING;
use crate::measure::{DropThreshold, Estimate, Format, Measure, ResultKey, RunQuantity, Summary};
use crate::output::{Ending, OutputError, write_file};
use crate::physics::{Unit, units};

/// A column: the result it shows under a short head, in the unit and with the digits of the
/// registry or others.
pub struct TableColumn {
    head: &'static str,
    key: ResultKey,
    unit: Unit,
    format: Format,
}

impl TableColumn {
    pub const fn new(head: &'static str, key: ResultKey) -> Self {
        let quantity = key.quantity();
        Self {
            head,
            key,
            unit: quantity.unit,
            format: quantity.format,
        }
    }

    pub const fn of_samples(head: &'static str, measure: Measure) -> Self {
        Self::new(head, ResultKey::OfSamples(measure))
    }

    pub const fn of_run(head: &'static str, quantity: RunQuantity) -> Self {
        Self::new(head, ResultKey::OfRun(quantity))
    }

    pub const fn drop_from(head: &'static str, threshold: DropThreshold) -> Self {
        Self::new(head, ResultKey::OfAvalanches(RunQuantity::Drop, threshold))
    }

    /// The same in another unit, with so many digits.
    pub const fn in_unit(self, unit: Unit, digits: usize) -> Self {
        Self {
            unit,
            format: Format::Fixed(digits),
            ..self
        }
    }

    pub const fn with_digits(self, digits: usize) -> Self {
        Self {
            format: Format::Fixed(digits),
            ..self
        }
    }

    /// The result that it shows.
    pub fn key(&self) -> ResultKey {
        self.key
    }

    /// Its head with the unit.
    pub fn head(&self) -> String {
        self.unit.beside(self.head)
    }

    fn cell(&self, results: &Summary) -> String {
        results.get(self.key).map_or_else(
            || NOTHING.to_owned(),
            |value| (self.key.quantity()).number_as(value, self.unit, self.format),
        )
    }

    /// Its cell for people, a mean with its error.
    pub fn cell_for_people(&self, results: &Summary) -> String {
        match results.estimate(self.key) {
            Some(mean) => self.cell_of(mean),
            None => self.cell(results),
        }
    }

    /// Its cell for people where the result is this `mean`.
    pub fn cell_of(&self, mean: Estimate) -> String {
        (self.key.quantity()).number_with_error_as(mean, self.unit, self.format)
    }
}

const DRUM: &[TableColumn] = &[
    TableColumn::of_samples("θ", Measure::SurfaceAngle),
    TableColumn::of_run("θ_m", RunQuantity::MaximumAngle),
    TableColumn::of_run("θ_r", RunQuantity::ReposeAngle),
    TableColumn::of_run("Δθ", RunQuantity::Drop),
    TableColumn::of_run("drops", RunQuantity::Avalanches),
    TableColumn::drop_from("Δθ ≥ 0.5°", DropThreshold::HalfDegree),
    TableColumn::drop_from("Δθ ≥ 2°", DropThreshold::TwoDegrees),
    TableColumn::drop_from("Δθ ≥ 3°", DropThreshold::ThreeDegrees),
    TableColumn::of_run("T_a", RunQuantity::Period),
    TableColumn::of_samples("Tg", Measure::GranularTemperature),
    TableColumn::of_samples("Tg′", Measure::CorotatingTemperature),
    TableColumn::of_run("ta/ts", RunQuantity::NonRigidShare),
    TableColumn::of_run("ta/ts′", RunQuantity::CorotatingShare),
    TableColumn::of_run("u_0", RunQuantity::FlowSpeed),
    TableColumn::of_run("d_f", RunQuantity::FlowDepth),
    TableColumn::of_run("√(1/Ga)", RunQuantity::InverseRootGalilei),
    TableColumn::of_run("Ca", RunQuantity::CapillaryNumber),
    TableColumn::of_samples("φ", Measure::PackingFraction),
    TableColumn::of_samples("Z", Measure::CoordinationNumber),
    TableColumn::of_samples("h", Measure::SurfaceRoughness),
    TableColumn::of_samples("κ", Measure::SurfaceCurvature),
    TableColumn::of_samples("bridges", Measure::Bridges),
    TableColumn::of_run("ruptures", RunQuantity::RupturesPerSecond),
    TableColumn::of_run("drum power", RunQuantity::DrumPower),
    TableColumn::of_samples("viscous loss", Measure::ViscousLoss),
    TableColumn::of_samples("largest overlap", Measure::LargestOverlap).with_digits(4),
    TableColumn::of_run("energy residual", RunQuantity::RelativeEnergyResidual),
];

const COLLAPSE: &[TableColumn] = &[
    TableColumn::of_run("α", RunQuantity::AspectRatio),
    TableColumn::of_run("α_eff", RunQuantity::EffectiveAspectRatio),
    TableColumn::of_run("φ_i", RunQuantity::SolidFraction),
    TableColumn::of_run("R_∞", RunQuantity::FinalFront),
    TableColumn::of_samples("R_99", Measure::FrontRadius99),
    TableColumn::of_samples("R_95", Measure::FrontRadius95),
    TableColumn::of_samples("R_c", Measure::ClusterRadius),
    TableColumn::of_run("ℛ", RunQuantity::RunOut),
    TableColumn::of_run("H_∞", RunQuantity::FinalHeight),
    TableColumn::of_samples("H_a", Measure::ApexHeight),
    TableColumn::of_run("H_∞/R_i", RunQuantity::RelativeHeight),
    TableColumn::of_run("V_cone/V_init", RunQuantity::RelativeConeVolume),
    TableColumn::of_run("t_max", RunQuantity::PeakTime),
    TableColumn::of_run("t_f", RunQuantity::RestTime),
    TableColumn::of_run("T_max", RunQuantity::DimensionlessPeakTime),
    TableColumn::of_run("T_f", RunQuantity::DimensionlessRestTime),
    TableColumn::of_run("peak energy", RunQuantity::PeakEnergy).in_unit(units::ERG, 2),
    TableColumn::of_samples("P11", Measure::FirstPairs),
    TableColumn::of_samples("P12", Measure::MixedPairs),
    TableColumn::of_samples("P22", Measure::SecondPairs),
    TableColumn::of_run("deposit shape", RunQuantity::Shape),
    TableColumn::of_samples("Z", Measure::CoordinationNumber),
    TableColumn::of_samples("largest overlap", Measure::LargestOverlap).with_digits(4),
    TableColumn::of_run("energy residual", RunQuantity::RelativeEnergyResidual),
];

/// The columns of the table: those of collapsing columns, or those of drums.
pub(super) fn columns(is_of_columns: bool) -> &'static [TableColumn] {
    if is_of_columns { COLLAPSE } else { DRUM }
}

/// The name of the table in Markdown.
const TABLE: &str = "table.md";

/// Writes the table in Markdown; returns its name.
///
/// # Errors
/// When the file cannot be written.
pub fn write_markdown(sweep: &Sweep, outcomes: &[CaseResult]) -> Result<String, OutputError> {
    let text = markdown(sweep, outcomes);
    write_file(&sweep.out.join(TABLE), |file| {
        file.write_all(text.as_bytes())
    })?;
    Ok(TABLE.to_owned())
}

/// The table in Markdown.
pub fn markdown(sweep: &Sweep, outcomes: &[CaseResult]) -> String {
    let columns = columns(outcomes.iter().any(CaseResult::is_column));
    let heads = heads(sweep, columns.iter().map(TableColumn::head));
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rows = outcomes.iter().map(|outcome| {
        let of_results = columns
            .iter()
            .map(|column| column.cell_for_people(&outcome.results));
        line(&cells(outcome, of_results))
    });
    let rule = line(&vec!["---".to_owned(); heads.len()]);
    [line(&heads), rule].into_iter().chain(rows).collect()
}

/// The heads of a row: what is varied, the `results`, how a case ended.
fn heads(sweep: &Sweep, results: impl Iterator<Item = String>) -> Vec<String> {
    let varied = sweep
        .variations
        .iter()
        .map(|variation| variation.key.clone());
    let fixed = ["time [s]", "ended", "state"].map(str::to_owned);
    varied.chain(results).chain(fixed).collect()
}

fn cells(outcome: &CaseResult, results: impl Iterator<Item = String>) -> Vec<String> {
    let values = outcome.case.values.iter().cloned();
    let ended = match &outcome.ending {
        Ending::Done => "done",
        Ending::Interrupted => "stopped",
        Ending::Faulted(_) => "fault",
    };
    let fixed = [
        format!("{:.2}", outcome.results.to),
        ended.to_owned(),
        outcome.hash[..8].to_owned(),
    ];
    values.chain(results).chain(fixed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{MeasuredValue, SummaryEntry};

    #[test]
    fn heads_name_the_papers_symbols_and_units() {
        let heads = |columns: &[TableColumn]| {
            let heads: Vec<String> = columns.iter().map(TableColumn::head).collect();
            heads.join(",")
        };
        assert_eq!(
            heads(DRUM),
            "θ [°],θ_m [°],θ_r [°],Δθ [°],drops,Δθ ≥ 0.5° [°],Δθ ≥ 2° [°],Δθ ≥ 3° [°],T_a [s],\
             Tg [m²/s²],Tg′ [m²/s²],ta/ts,ta/ts′,u_0 [mm/s],d_f [mm],√(1/Ga),Ca,φ,Z,h [mm],κ [1/m],bridges,ruptures [1/s],\
             drum power [mW],viscous loss [J],largest overlap,energy residual"
        );
        assert_eq!(
            heads(COLLAPSE),
            "α,α_eff,φ_i,R_∞ [mm],R_99 [mm],R_95 [mm],R_c [mm],ℛ,H_∞ [mm],H_a [mm],H_∞/R_i,\
             V_cone/V_init,t_max [s],t_f [s],T_max,T_f,peak energy [g cm²/s²],P11,P12,P22,\
             deposit shape,Z,largest overlap,energy residual"
        );
    }

    #[test]
    fn beside_a_mean_stands_its_error() {
        let cell = |error| {
            let mean = crate::measure::Estimate {
                mean: 24.31_f64.to_radians(),
                error,
                samples: 45,
                freedom: 9,
            };
            let results = Summary {
                from: 0.0,
                to: 1.0,
                samples: 50,
                entries: vec![SummaryEntry {
                    key: Measure::SurfaceAngle.into(),
                    value: Some(mean.into()),
                    note: String::new(),
                }],
            };
            let angle = &DRUM[0];
            angle.cell_for_people(&results)
        };
        assert_eq!(cell(Some(0.4_f64.to_radians())), "24.3 ± 0.4");
        assert_eq!(cell(None), "24.31 ± ?");
    }

    #[test]
    fn cells_hold_results_by_their_keys() {
        let entry = |key: ResultKey, value| SummaryEntry {
            key,
            value: Some(value),
            note: String::new(),
        };
        let results = Summary {
            from: 0.0,
            to: 1.0,
            samples: 50,
            entries: vec![
                entry(
                    RunQuantity::PeakEnergy.into(),
                    MeasuredValue::Number(2.966e-7),
                ),
                entry(
                    Measure::LargestOverlap.into(),
                    MeasuredValue::Number(3.04e-4),
                ),
                entry(RunQuantity::Shape.into(), MeasuredValue::Choice("cone")),
                entry(
                    RunQuantity::GalileiNumber.into(),
                    MeasuredValue::Number(4.0),
                ),
            ],
        };
        let cell = |columns: &[TableColumn], head: &str| {
            let column = columns.iter().find(|column| column.head == head);
            column.expect(head).cell(&results)
        };
        assert_eq!(cell(COLLAPSE, "peak energy"), "2.97");
        assert_eq!(cell(COLLAPSE, "largest overlap"), "0.0003");
        assert_eq!(cell(COLLAPSE, "deposit shape"), "cone");
        assert_eq!(cell(COLLAPSE, "ℛ"), "–");
        assert_eq!(cell(DRUM, "√(1/Ga)"), "0.5000");
    }
}
