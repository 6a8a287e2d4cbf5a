//! What is there of a sweep's cases: in their folders, and what is kept of them elsewhere.
//!
//! In: cases, and for each what is kept of it beside its folder. Out: the finished ones of one
//! method, those in folders first, and the others by name. Nothing is computed.

use super::case::{self, CaseResult};
use super::{Case, Sweep};
use crate::output::OutputError;
use crate::runner::{self, RunnerError, Standing};

/// What is kept of a case elsewhere than in its folder.
pub enum Kept {
    /// Nothing.
    Nothing,
    /// Its results, by this build's method.
    Results(Box<CaseResult>),
    /// Something that is not used, for this reason.
    Unused(String),
}

/// The finished ones of `cases`, all computed by one method, this build's where there are such; of
/// the others number, name and how they stand. What stands in `kept` in the place of a case counts
/// where its folder does not hold it.
///
/// # Errors
/// When a case has other values, or a file cannot be read.
pub fn gather(
    sweep: &Sweep,
    cases: &[Case],
    kept: &[Kept],
) -> Result<(Vec<CaseResult>, Vec<String>), RunnerError> {
    let (mut outcomes, mut missing) = (Vec::new(), Vec::new());
    for (index, case) in cases.iter().enumerate() {
        let (own, standing) = in_folder(sweep, case)?;
        let kept = kept.get(index).unwrap_or(&Kept::Nothing);
        match (own, kept) {
            (Some(own), Kept::Results(kept)) if own.method != kept.method => {
                outcomes.push((**kept).clone());
            }
            (Some(own), _) => outcomes.push(own),
            (None, Kept::Results(kept)) => outcomes.push((**kept).clone()),
            (None, Kept::Unused(reason)) => missing.push(format!(
                "{}, {}: {standing}; {reason}",
                index + 1,
                case.name
            )),
            (None, Kept::Nothing) => {
                missing.push(format!("{}, {}: {standing}", index + 1, case.name));
            }
        }
    }
    let (chosen, others) = of_one_method(outcomes);
    missing.extend(others.iter().map(|other| {
        let stated = other
            .method
            .as_deref()
            .unwrap_or("that its folder does not state");
        format!("{}: computed by another method, {stated}", other.case.name)
    }));
    Ok((chosen, missing))
}

/// What the folder of `case` holds of it where it is done; and how it stands there.
fn in_folder(sweep: &Sweep, case: &Case) -> Result<(Option<CaseResult>, Standing), RunnerError> {
    let standing = runner::standing(&case::job(sweep, case));
    let standing = standing.map_err(|error| error.within(&case.name))?;
    if standing != Standing::Done {
        return Ok((None, standing));
    }
    match case::run(sweep, case, 1, &mut (), &|| true) {
        // Somebody has begun to read or to run it since.
        Err(RunnerError::Output(OutputError::Taken { holder, .. })) => {
            Ok((None, Standing::Taken(holder)))
        }
        own => Ok((own?, standing)),
    }
}

/// Those of this build's methods, where there are none those of the first one's; and the others.
fn of_one_method(outcomes: Vec<CaseResult>) -> (Vec<CaseResult>, Vec<CaseResult>) {
    if outcomes.iter().any(CaseResult::is_of_this_method) {
        return outcomes
            .into_iter()
            .partition(CaseResult::is_of_this_method);
    }
    let first = outcomes.first().and_then(|own| own.method.clone());
    (outcomes.into_iter()).partition(|outcome| outcome.method == first)
}
