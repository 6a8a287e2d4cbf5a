//! The papers by name.

use super::kasper_readings::KASPER2021_READINGS;
use super::kasper2021::KASPER2021;
use super::man_readings::MAN2023_READINGS;
use super::man2023::MAN2023;
use super::plan::Paper;

use crate::runner::RunnerError;

/// Every paper that the program can run.
pub static PAPERS: [&Paper; 4] = [
    &KASPER2021,
    &KASPER2021_READINGS,
    &MAN2023,
    &MAN2023_READINGS,
];

/// The paper called `name`.
///
/// # Errors
/// When there is none, with the names of those that there are.
pub fn paper(name: &str) -> Result<&'static Paper, RunnerError> {
    let found = PAPERS.iter().find(|paper| paper.name == name);
    found.copied().ok_or_else(|| {
        let known: Vec<&str> = PAPERS.iter().map(|paper| paper.name).collect();
        RunnerError::Input(format!(
            "there is no paper {name}; expected {}",
            known.join(" or ")
        ))
    })
}
