//! What Man et al. 2023 state of columns of two frictions, as rules.
//!
//! In: columns of polyhedra. Out: each statement for which there are
//! cases, with its comparisons. Bounds that the paper gives in words or only in its plots (*about*)
//! stand here as numbers, each in the rule that a reader sees.

use super::columns::{Column, Columns, rounded};
use super::statements::{Part, Statement};
use crate::measure::{
    CRITICAL_ASPECT_RATIO, DepositShape, Estimate, Measure, PEAK_TIME_LAW, Quantity, REST_TIME_LAW,
    RunQuantity, TALL_ASPECT_RATIO, TALL_REST_TIME_LAW, Verdict, cone_volume_law,
    contact_shares_law, run_out_law,
};
use std::ops::Range;

/// By how much a result may lie beside a law that is read from a plot.
pub(super) const ABOUT: f64 = 0.2;
/// Half the time between two samples over `√(R_i/g)` at the paper's radius: by so much `T_max` may
/// be too small, 0.01 s over 0.0505 s.
const HALF_A_SAMPLE: f64 = 0.2;
/// Effective aspect ratio at which a frustum turns into a cone, and by how much a case lies beside.
const CONE_FROM: f64 = 1.7;
const BESIDE: f64 = 0.4;
/// Grains from which contact shares are known to half as much.
const MANY: usize = 10_000;

/// How a ratio is written.
pub(super) const RATIO: Quantity = Quantity {
    key: "ratio",
    ..*RunQuantity::NonRigidShare.quantity()
};

/// The statements for which there are columns.
pub fn column_statements(columns: &Columns) -> Vec<Statement> {
    let all = columns.0.iter().cloned();
    let (loose, dense): (Vec<_>, Vec<_>) = all.partition(Column::is_loose);
    let (loose, dense) = (Columns(loose), Columns(dense));
    let all = [
        dense.run_outs(),
        dense.deposits(),
        dense.contacts(),
        dense.times(),
        dense.energies(),
        loose.loose_times(),
        loose.beside_dense(&dense),
    ];
    let found = all.into_iter().flatten();
    found
        .filter(|statement| !statement.parts.is_empty())
        .collect()
}

impl Column<'_> {
    /// A result over a `law`, which is to lie within `bounds`.
    fn over(&self, quantity: RunQuantity, law: f64, bounds: Range<f64>) -> Option<Part> {
        let (own, ratio) = (self.get(quantity)?, self.get(quantity)?.times(1.0 / law));
        Some(Part {
            place: self.place(),
            found: format!(
                "{} at α_eff {:.2}, {} of the law",
                quantity.quantity().text(own),
                self.effective,
                RATIO.text(ratio)
            ),
            verdict: Verdict::of_between(ratio, bounds),
        })
    }

    /// The shape of each of its deposits, which is to be that of its aspect ratio; none near where
    /// one turns into the other.
    fn shape(&self) -> Option<Part> {
        let expected = match self.effective {
            x if x < CONE_FROM - BESIDE => DepositShape::Frustum,
            x if x > CONE_FROM + BESIDE => DepositShape::Cone,
            _ => return None,
        };
        let members = self.ensemble.members.iter();
        let words = members.filter_map(|own| own.results.get(RunQuantity::Shape));
        let words: Vec<String> = words
            .map(|word| RunQuantity::Shape.quantity().text(word))
            .collect();
        let verdicts: Vec<Verdict> = (words.iter())
            .map(|word| {
                if word == expected.word() {
                    Verdict::Holds
                } else {
                    Verdict::DoesNot
                }
            })
            .collect();
        Some(Part {
            place: self.place(),
            found: format!(
                "{} at α_eff {:.2}, to be {}",
                words.join(", "),
                self.effective,
                expected.word()
            ),
            verdict: Verdict::of_all(&verdicts),
        })
    }

    /// Its contact shares, which are to be those by chance.
    fn shares(&self) -> Vec<Part> {
        let grains = self.ensemble.first().case.scene.grain_count();
        let tolerance = if grains < MANY { 0.04 } else { 0.02 };
        let [first, mixed, second] = contact_shares_law(self.share);
        let all = [
            (Measure::FirstPairs, first),
            (Measure::MixedPairs, mixed),
            (Measure::SecondPairs, second),
        ];
        let part = |(measure, law): (Measure, f64)| {
            let own = self.get(measure)?;
            let bounds = law - tolerance..law + tolerance;
            Some(Part {
                place: self.place(),
                found: format!(
                    "{} {} beside {law:.2} ± {tolerance}",
                    measure.quantity().symbol,
                    measure.quantity().text(own)
                ),
                verdict: Verdict::of_between(own, bounds),
            })
        };
        all.into_iter().filter_map(part).collect()
    }
}

impl Columns<'_> {
    /// A result over a `law` of the effective aspect ratio, in the columns `from` … `to`.
    pub(super) fn beside(
        &self,
        quantity: RunQuantity,
        within: Range<f64>,
        law: impl Fn(f64) -> f64,
        bounds: &Range<f64>,
    ) -> Vec<Part> {
        let own = self
            .0
            .iter()
            .filter(|column| within.contains(&column.effective));
        own.filter_map(|column| column.over(quantity, law(column.effective), bounds.clone()))
            .collect()
    }

    /// The exponents between neighbours of one mixture whose aspect ratios lie `within`.
    fn exponents(&self, within: &Range<f64>, bounds: &Range<f64>) -> Vec<Part> {
        let groups = self.alike(|own| format!("{} {} {}", own.share, own.solid, own.friction()));
        let pairs = groups.iter().flat_map(|group| group.windows(2));
        let part = |pair: &[&Column]| {
            let [low, high] = pair else { return None };
            let is_inside = |own: &Column| within.contains(&own.effective);
            if !is_inside(low) || !is_inside(high) {
                return None;
            }
            let exponent = exponent(low, high)?;
            Some(Part {
                place: format!("{}, from H = {} mm on", high.place(), rounded(low.height)),
                found: format!("exponent {}", RATIO.text(exponent)),
                verdict: Verdict::of_between(exponent, bounds.clone()),
            })
        };
        pairs.filter_map(part).collect()
    }

    /// A result along columns that are alike in `key`.
    fn along(
        &self,
        quantity: RunQuantity,
        key: impl Fn(&Column) -> String,
        order: impl Fn(&Column) -> f64,
        rule: impl Fn(&[Estimate]) -> Verdict,
    ) -> Vec<Part> {
        let part = |mut group: Vec<&Column>| {
            group.sort_by(|a, b| order(a).total_cmp(&order(b)));
            let found = group
                .iter()
                .filter_map(|own| Some((own, own.get(quantity)?)));
            let (places, means): (Vec<_>, Vec<_>) =
                found.map(|(own, mean)| (own.place(), mean)).unzip();
            let texts: Vec<String> = means
                .iter()
                .map(|mean| quantity.quantity().text(*mean))
                .collect();
            let place = format!("{} to {}", places.first()?, places.last()?);
            (means.len() > 1).then(|| Part {
                place,
                found: texts.join(", "),
                verdict: rule(&means),
            })
        };
        self.alike(key).into_iter().filter_map(part).collect()
    }

    fn run_outs(&self) -> Vec<Statement> {
        let about = 1.0 - ABOUT..1.0 + ABOUT;
        let (low, high) = (
            0.0..CRITICAL_ASPECT_RATIO,
            CRITICAL_ASPECT_RATIO..f64::INFINITY,
        );
        let run_out = RunQuantity::RunOut;
        vec![
            Statement {
                text: "The run-out is about α_eff^1.35 below 3.5",
                rule: "ℛ lies within 20 % of the law",
                parts: self.beside(run_out, low.clone(), run_out_law, &about),
            },
            Statement {
                text: "Below 3.5 the run-out grows with the power 1.35",
                rule: "the exponent between neighbours of one mixture lies between 1.2 and 1.5",
                parts: self.exponents(&low, &(1.2..1.5)),
            },
            Statement {
                text: "The run-out goes on from 3.5 as the root of α_eff",
                rule: "ℛ lies within 20 % of 3.5^1.35 √(α_eff/3.5)",
                parts: self.beside(run_out, high.clone(), run_out_law, &about),
            },
            Statement {
                text: "Above 3.5 the run-out grows with about the power 0.5",
                rule: "the exponent between neighbours of one mixture lies between 0.35 and 0.65",
                parts: self.exponents(&high, &(0.35..0.65)),
            },
            Statement {
                text: "The run-out rises as any friction falls",
                rule: "ℛ rises along α_eff at one height",
                parts: self.along(
                    run_out,
                    |own| format!("{} {}", rounded(own.height), own.solid),
                    |own| own.effective,
                    Verdict::of_rising,
                ),
            },
        ]
    }

    fn deposits(&self) -> Vec<Statement> {
        let about = 1.0 - ABOUT..1.0 + ABOUT;
        let cone = RunQuantity::RelativeConeVolume;
        vec![
            Statement {
                text: "A frustum turns into a cone at α_eff about 1.7",
                rule: "deposits are frusta up to α_eff 1.3, cones from 2.1 on",
                parts: self.0.iter().filter_map(Column::shape).collect(),
            },
            Statement {
                text: "The height comes to a plateau of 0.7 to 0.85 (10 % of rough grains), to 1.0 \
                       (30 %), to 1.3 (50 %)",
                rule: "H_∞/R_i lies between 0.63 and the tenth above that where α_eff is 2.1 to 5",
                parts: self.0.iter().filter_map(plateau).collect(),
            },
            Statement {
                text: "V_cone/V_init follows Eq. 4.4",
                rule: "it lies within 20 % of the law",
                parts: self.beside(cone, 0.0..f64::INFINITY, cone_volume_law, &about),
            },
        ]
    }

    fn contacts(&self) -> Vec<Statement> {
        vec![Statement {
            text: "Contacts between the kinds stay as many as by chance",
            rule: "P11, P12 and P22 lie within 0.04 of Eq. 4.1, within 0.02 from 10 000 grains on",
            parts: self.0.iter().flat_map(Column::shares).collect(),
        }]
    }

    fn times(&self) -> Vec<Statement> {
        let root = |factor: f64| move |effective: f64| factor * effective.sqrt();
        let about = 1.0 - ABOUT..1.0 + ABOUT;
        let (peak, rest) = (
            RunQuantity::DimensionlessPeakTime,
            RunQuantity::DimensionlessRestTime,
        );
        let late = |column: &Column| {
            let own = column.get(peak)?;
            let law = PEAK_TIME_LAW * column.effective.sqrt();
            Some(Part {
                place: column.place(),
                found: format!("{} beside {law:.2}", peak.quantity().text(own)),
                verdict: Verdict::of_between(own, law - HALF_A_SAMPLE..f64::INFINITY),
            })
        };
        let fast = |column: &Column| {
            let own = column.get(RunQuantity::PeakTime)?;
            (rounded(column.height) == "10").then(|| Part {
                place: column.place(),
                found: RunQuantity::PeakTime.quantity().text(own),
                verdict: Verdict::of_between(own, 0.05..0.07),
            })
        };
        vec![
            Statement {
                text: "A column of 1 cm is fastest at about 0.06 s",
                rule: "t_max lies between 0.05 and 0.07 s",
                parts: self.0.iter().filter_map(fast).collect(),
            },
            Statement {
                text: "T_max is at least 0.92 √α_eff",
                rule: "T_max lies above the law less half of the time between two samples",
                parts: self.0.iter().filter_map(late).collect(),
            },
            Statement {
                text: "T_f is 4.5 √α_eff below 3.5",
                rule: "T_f lies within 20 % of the law",
                parts: self.beside(
                    rest,
                    0.0..CRITICAL_ASPECT_RATIO,
                    root(REST_TIME_LAW),
                    &about,
                ),
            },
            Statement {
                text: "T_f is 3.0 √α_eff above 13",
                rule: "T_f lies within 20 % of the law",
                parts: self.beside(
                    rest,
                    TALL_ASPECT_RATIO..f64::INFINITY,
                    root(TALL_REST_TIME_LAW),
                    &about,
                ),
            },
        ]
    }

    fn energies(&self) -> Vec<Statement> {
        let mixes = |quantity, rule: fn(&[Estimate]) -> Verdict| {
            let alike =
                |own: &Column| format!("{} {} {}", rounded(own.height), own.solid, own.friction());
            self.along(quantity, alike, |own| own.share, rule)
        };
        vec![
            Statement {
                text: "More rough grains: a smaller peak energy",
                rule: "the largest kinetic energy per grain falls along the mixtures of one height",
                parts: mixes(RunQuantity::PeakEnergy, Verdict::of_falling),
            },
            Statement {
                text: "More rough grains: sooner at rest",
                rule: "t_f falls along the mixtures of one height",
                parts: mixes(RunQuantity::RestTime, Verdict::of_falling),
            },
        ]
    }
}

/// The relative height of a deposit where the paper has its plateau; none elsewhere, and in other
/// mixtures than the paper's.
fn plateau(column: &Column) -> Option<Part> {
    let highest = match rounded(100.0 * column.share).as_str() {
        "10" => 0.85,
        "30" => 1.0,
        "50" => 1.3,
        _ => return None,
    };
    if !(CONE_FROM + BESIDE..5.0).contains(&column.effective) {
        return None;
    }
    let own = column.get(RunQuantity::RelativeHeight)?;
    Some(Part {
        place: column.place(),
        found: RunQuantity::RelativeHeight.quantity().text(own),
        verdict: Verdict::of_between(own, 0.9 * 0.7..1.1 * highest),
    })
}

/// The exponent of the run-out between two columns, with the error that follows from theirs.
fn exponent(low: &Column, high: &Column) -> Option<Estimate> {
    let ratio = high
        .get(RunQuantity::RunOut)?
        .over(low.get(RunQuantity::RunOut)?);
    let span = (high.effective / low.effective).ln();
    if span <= 0.0 {
        return None;
    }
    Some(Estimate {
        mean: ratio.mean.ln() / span,
        error: ratio.error.map(|error| error / (ratio.mean * span)),
        ..ratio
    })
}
