//! What Man et al. 2023 state of columns that are packed loosely, as rules (Figs. 15 and 16).
//!
//! In: columns of the solid fraction 0.55, and those of 0.8 like them. Out: each statement for which
//! there are cases, with its comparisons.

use super::columns::{Column, Columns};
use super::man_statements::{ABOUT, RATIO};
use super::statements::{Part, Statement};
use crate::measure::{PEAK_TIME_LAW, RunQuantity, TALL_REST_TIME_LAW, Verdict, run_out_law};

impl Columns<'_> {
    /// What the paper states of these columns by themselves (Fig. 15).
    pub fn loose_times(&self) -> Vec<Statement> {
        let about = 1.0 - ABOUT..1.0 + ABOUT;
        let root = |factor: f64| move |effective: f64| factor * effective.sqrt();
        let law =
            |quantity, factor| self.beside(quantity, 0.0..f64::INFINITY, root(factor), &about);
        vec![
            Statement {
                text: "At φ_i 0.55 T_max is 0.92 √α_eff",
                rule: "T_max of loose columns lies within 20 % of the law",
                parts: law(RunQuantity::DimensionlessPeakTime, PEAK_TIME_LAW),
            },
            Statement {
                text: "At φ_i 0.55 T_f is 3.0 √α_eff",
                rule: "T_f of loose columns lies within 20 % of the law",
                parts: law(RunQuantity::DimensionlessRestTime, TALL_REST_TIME_LAW),
            },
        ]
    }

    /// What it states of them beside the `dense` ones like them (Figs. 15 and 16).
    pub fn beside_dense(&self, dense: &Self) -> Vec<Statement> {
        let pairs = self.0.iter().filter_map(|loose| {
            let dense = dense.0.iter().find(|dense| dense.is_like(loose))?;
            Some([loose, dense])
        });
        let pairs: Vec<[&Column; 2]> = pairs.collect();
        let less = |quantity: RunQuantity| -> Vec<Part> {
            let part = |[loose, dense]: &[&Column; 2]| {
                let own = [loose.get(quantity)?, dense.get(quantity)?];
                let [low, high] = own.map(|own| quantity.quantity().text(own));
                Some(Part {
                    place: loose.place(),
                    found: format!("{low} beside {high}"),
                    verdict: Verdict::of_rising(&own),
                })
            };
            pairs.iter().filter_map(part).collect()
        };
        vec![
            Statement {
                text: "A loose column is fastest sooner than a dense one",
                rule: "t_max is less at φ_i 0.55 than at 0.8",
                parts: less(RunQuantity::PeakTime),
            },
            Statement {
                text: "A loose column is at rest sooner",
                rule: "t_f is less at φ_i 0.55 than at 0.8",
                parts: less(RunQuantity::RestTime),
            },
            Statement {
                text: "A loose column runs out less far",
                rule: "ℛ is less at φ_i 0.55 than at 0.8",
                parts: less(RunQuantity::RunOut),
            },
            Statement {
                text: "Over φ_i^0.5 α_eff loose and dense columns run out alike",
                rule: "ℛ at φ_i 0.55 over that at 0.8 lies within 20 % of what the law of the \
                       run-out makes of φ_i^0.5 α_eff",
                parts: pairs.iter().filter_map(packed).collect(),
            },
        ]
    }
}

/// The run-out of a loose column over that of a dense one, beside what `φ_i^0.5 α_eff` says of it.
fn packed([loose, dense]: &[&Column; 2]) -> Option<Part> {
    let run_out = RunQuantity::RunOut;
    let law = |own: &Column| run_out_law(own.solid.sqrt() * own.effective);
    let expected = law(loose) / law(dense);
    let ratio = loose.get(run_out)?.over(dense.get(run_out)?);
    Some(Part {
        place: loose.place(),
        found: format!("{} beside {expected:.3}", RATIO.text(ratio)),
        verdict: Verdict::of_between(ratio.times(1.0 / expected), 1.0 - ABOUT..1.0 + ABOUT),
    })
}
