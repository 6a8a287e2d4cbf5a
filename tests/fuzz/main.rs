//! Whatever a file or the command line holds, it ends in a run or in a message: never in a panic,
//! never in a hang, never in more memory than the file is worth.
//!
//! Each target makes inputs of a seed and a number, so that every one can be made again: the
//! message of a failure says how. `FUZZ_SECONDS=60` works on each for a minute instead of a moment,
//! `FUZZ_SEED=7` on other inputs, `FUZZ_ONLY=12345` on the input of this number alone. A binary of
//! its own: it counts what is allocated.

#![allow(
    clippy::disallowed_methods,
    reason = "what inputs are made of reaches no trajectory"
)]

#[path = "../common/allocator.rs"]
mod allocator;
mod byte_mutator;
mod engines;
mod meshes;
mod mutator;
#[path = "../common/small_export.rs"]
mod small_export;
mod targets;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use targets::Target;

/// Time for each target unless told otherwise.
const MOMENT: Duration = Duration::from_millis(500);
/// Most time that an input may take, the best of some tries: machines have other work to do.
const MOST_TIME: Duration = Duration::from_secs(1);
const TRIES: u32 = 5;
/// Most memory that an input may take [bytes].
const MOST_MEMORY: usize = 256 << 20;
/// Failures after which a target gives up.
const MOST_FAILURES: usize = 20;

/// Tests take turns: every one counts what all allocate.
static TURN: Mutex<()> = Mutex::new(());

fn number_of(variable: &str) -> Option<u64> {
    std::env::var(variable).ok()?.parse().ok()
}

/// What an input came to: whether it was accepted, and what is wrong with how it was taken.
fn outcome(target: &mut dyn Target, seed: u64, number: u64) -> (bool, Option<String>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(number);
    let started = Instant::now();
    let before = allocator::in_use();
    let (done, peak) =
        allocator::with_peak(|| catch_unwind(AssertUnwindSafe(|| target.take(&mut rng))));
    let memory = peak.saturating_sub(before);
    let time = started.elapsed();
    match done {
        Err(panic) => {
            let message = panic.downcast_ref::<String>().map(String::as_str);
            let message = message.or_else(|| panic.downcast_ref::<&str>().copied());
            (false, Some(format!("panics: {}", message.unwrap_or("?"))))
        }
        Ok(accepted) if memory > MOST_MEMORY => {
            (accepted, Some(format!("takes {} MiB", memory >> 20)))
        }
        Ok(accepted) if time > MOST_TIME => (accepted, Some(format!("takes {time:?}"))),
        Ok(accepted) => (accepted, None),
    }
}

fn fuzz(name: &str, mut target: impl Target) {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let seed = number_of("FUZZ_SEED").unwrap_or(20_210_401);
    let time = number_of("FUZZ_SECONDS").map_or(MOMENT, Duration::from_secs);
    let only = number_of("FUZZ_ONLY");
    let (mut taken, mut accepted, mut failures) = (0_u64, 0_u64, Vec::new());
    let started = Instant::now();
    for number in only.unwrap_or(0).. {
        if number_of("FUZZ_TRACE").is_some() {
            eprintln!("{name} {number}");
        }
        let (was_accepted, mut failure) = outcome(&mut target, seed, number);
        // What takes long once may have waited for others.
        for _ in 1..TRIES {
            if failure
                .as_ref()
                .is_some_and(|failure| failure.starts_with("takes"))
            {
                failure = outcome(&mut target, seed, number).1;
            }
        }
        taken += 1;
        accepted += u64::from(was_accepted);
        if let Some(failure) = failure {
            eprintln!("{name}: input {number} of seed {seed} {failure}");
            failures.push(format!("FUZZ_SEED={seed} FUZZ_ONLY={number} {failure}"));
        }
        let is_over = started.elapsed() >= time || failures.len() >= MOST_FAILURES;
        if only.is_some() || is_over {
            break;
        }
    }
    println!(
        "{name}: {taken} inputs, {accepted} accepted, {} failures",
        failures.len()
    );
    assert!(failures.is_empty(), "{name}: {failures:#?}");
    // A target that accepts nothing, or all, would prove little.
    let is_mixed = (1..taken).contains(&accepted);
    assert!(
        only.is_some() || taken < 1000 || is_mixed,
        "{name}: {accepted} of {taken} accepted"
    );
}

#[test]
fn scenes() {
    fuzz("scene", targets::SceneTexts::new());
}

#[test]
fn lessons() {
    fuzz("lesson", targets::LessonTexts::new());
}

#[test]
fn settings() {
    fuzz("--set", targets::SettingsOfScenes::new());
}

#[test]
fn variations() {
    fuzz("--vary", targets::Variations::new());
}

#[test]
fn commands() {
    fuzz("commands", targets::CommandFiles::new());
}

#[test]
fn sessions() {
    fuzz("session", targets::SessionFiles::new());
}

#[test]
fn beds() {
    fuzz("bed", targets::BedFiles::new());
}

#[test]
fn packings() {
    fuzz("packing", targets::PackingFiles::new());
}

#[test]
fn meshes() {
    fuzz("mesh", meshes::MeshFiles::new());
}

#[test]
fn checkpoints() {
    fuzz("checkpoint", targets::Checkpoints::new());
}

#[test]
fn records() {
    fuzz("record", targets::RecordFiles::new());
}

#[test]
fn recordings() {
    fuzz("recording", targets::Recordings::new());
}

#[test]
fn files_of_engines() {
    fuzz("dump", engines::EngineFiles::new());
}

#[test]
fn records_of_exports() {
    fuzz("export.json", engines::ExportRecords::new());
}
