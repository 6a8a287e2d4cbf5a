//! What the paper's statements about drums are judged by: results of one drum, of two, of several in
//! a row.
//!
//! In: drums with the means of their seeds. Out: [`Part`]s, each with where, what was found and a
//! verdict. Not here: which statement asks for what ([`super::kasper_statements`]).

use super::drums::Drum;
use super::statements::Part;
use crate::measure::{Estimate, Quantity, ResultKey, RunQuantity, Verdict, drop_ratio_law};

/// A bed that flows for this share of the time flows always.
pub const ALWAYS: f64 = 0.98;

/// The mean drop of θ.
pub const DROP: ResultKey = ResultKey::OfRun(RunQuantity::Drop);
/// The share of the time in which a bed is not rigid.
pub const SHARE: ResultKey = ResultKey::OfRun(RunQuantity::NonRigidShare);

/// How a ratio is written.
pub const RATIO: Quantity = Quantity {
    key: "ratio",
    ..*RunQuantity::NonRigidShare.quantity()
};

/// Whether `drum` flows always.
pub fn flows_always(drum: &Drum) -> bool {
    drum.get(SHARE).is_some_and(|share| share.mean >= ALWAYS)
}

/// A result along each of several series of drums, judged as a whole.
pub fn along(
    series: &[Vec<&Drum>],
    key: ResultKey,
    rule: impl Fn(&[Estimate]) -> Verdict,
) -> Vec<Part> {
    values_along(series, key.quantity(), |drum| drum.get(key), rule)
}

/// The same of a `value` that follows from results.
pub fn values_along(
    series: &[Vec<&Drum>],
    quantity: &Quantity,
    value: impl Fn(&Drum) -> Option<Estimate>,
    rule: impl Fn(&[Estimate]) -> Verdict,
) -> Vec<Part> {
    let part = |drums: &Vec<&Drum>| {
        let found = drums.iter().filter_map(|drum| Some((*drum, value(drum)?)));
        let found: Vec<(&Drum, Estimate)> = found.collect();
        let (first, last) = (found.first()?.0, found.last()?.0);
        let means: Vec<Estimate> = found.iter().map(|(_, mean)| *mean).collect();
        let place = if first.radius == last.radius {
            format!(
                "r = {} mm, {} to {}",
                first.radius,
                first.liquid(),
                last.liquid()
            )
        } else {
            let (liquid, from, to) = (first.liquid(), first.radius, last.radius);
            format!("{liquid}, r = {from} to {to} mm")
        };
        let texts: Vec<String> = means.iter().map(|mean| quantity.text(*mean)).collect();
        let verdict = rule(&means);
        (means.len() > 1).then(|| Part {
            place,
            found: texts.join(", "),
            verdict,
        })
    };
    series.iter().filter_map(part).collect()
}

/// Whether a result of `drum` lies within `bounds`.
pub fn between(drum: &Drum, key: ResultKey, bounds: std::ops::Range<f64>) -> Option<Part> {
    let mean = drum.get(key)?;
    Some(Part {
        place: drum.place(),
        found: key.quantity().text(mean),
        verdict: Verdict::of_between(mean, bounds),
    })
}

/// Whether `drum` flows always, or does not; beside the paper's share that of the drum's frame.
pub fn share(drum: &Drum, always: bool) -> Option<Part> {
    let bounds = if always {
        ALWAYS..f64::INFINITY
    } else {
        f64::NEG_INFINITY..ALWAYS
    };
    let part = between(drum, SHARE, bounds)?;
    let corotating = drum.get(ResultKey::OfRun(RunQuantity::CorotatingShare));
    let beside = corotating.map_or_else(String::new, |share| {
        let text = RunQuantity::CorotatingShare.quantity().text(share);
        format!(" (in the drum's frame {text})")
    });
    let expected = if always { "above" } else { "below" };
    Some(Part {
        found: format!("{}{beside}, to be {expected} {ALWAYS}", part.found),
        ..part
    })
}

/// The ratio of a wet drop to the dry one beside Eq. 23.
pub fn beside_the_law((wet, dry): (&Drum, &Drum)) -> Option<Part> {
    let ratio = wet.get(DROP)?.over(dry.get(DROP)?);
    let law = drop_ratio_law(1e-3 * wet.viscosity);
    Some(Part {
        place: wet.place(),
        found: format!("{} beside {law:.2}", RATIO.text(ratio)),
        verdict: Verdict::of_between(ratio, law - 0.1..law + 0.1),
    })
}
