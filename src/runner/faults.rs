//! Every call about a file fails once, in a run and in a sweep: what is said, what is left, and
//! that the same command comes to the same bits afterwards.

use super::{Job, RunnerError, run};
use crate::files::FailingCalls;
use crate::run::BedStore;
use crate::scene::Scene;
use crate::sweep::{self, Sweep, Variation};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

fn scene() -> Scene {
    let mut scene = Scene::open("bouncing-grain").unwrap();
    scene
        .set_all(&[("duration", "60ms"), ("output-interval", "20ms")])
        .unwrap();
    scene
}

fn job(out: &Path) -> Job {
    Job {
        threads: 1,
        beds: BedStore::none(),
        checkpoints: true,
        ..Job::new("grain", scene(), out)
    }
}

fn run_once(out: &Path) -> Result<String, RunnerError> {
    let (_, run) = run(&job(out), &mut (), &|| false)?;
    let run = run.into_run().map_err(|_| ()).unwrap();
    Ok(run.world().hash().to_string())
}

fn sweep_once(out: &Path) -> Result<String, RunnerError> {
    let sweep = Sweep {
        name: "grain".into(),
        scene: scene(),
        settings: Vec::new(),
        variations: vec![Variation::parse("seed=1,2").unwrap()],
        out: out.to_owned(),
        jobs: 1,
        beds: BedStore::none(),
        restart: false,
    };
    sweep::run(&sweep, &AtomicBool::new(false), &mut ())?;
    Ok(fs::read_to_string(out.join("table.csv")).unwrap())
}

/// What a stop may leave: files that are whole.
fn assert_whole(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            assert_whole(&path);
            continue;
        }
        let Ok(text) = fs::read(&path) else { continue };
        let ends = |end: &[u8]| assert!(text.ends_with(end), "{}", path.display());
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("json") => drop(serde_json::from_slice::<serde_json::Value>(&text).unwrap()),
            Some("pvd" | "vtp") => ends(b"</VTKFile>\n"),
            Some("csv") => ends(b"\n"),
            _ => {}
        }
    }
}

/// Lets the n-th call fail for every n, or all from the n-th on, and returns how many there are.
fn fail_each(lasting: bool, once: fn(&Path) -> Result<String, RunnerError>) -> u64 {
    let home = tempfile::tempdir().unwrap();
    let whole = once(&home.path().join("whole")).unwrap();
    let mut n = 0;
    loop {
        let out = home.path().join(format!("{n}"));
        let failing = FailingCalls::below(&out, move |call| call == n || (lasting && call > n));
        let outcome = once(&out);
        let calls = failing.calls();
        drop(failing);
        assert_whole(&out);
        if let Err(error) = outcome {
            let message = format!("{error}");
            assert!(
                message.contains(&format!("/{n}")),
                "call {n} names its file: {message}"
            );
            assert!(matches!(error.exit_code(), 1 | 2), "call {n}: {message}");
        } else {
            assert!(calls <= n, "call {n} of {calls} failed and nobody said so");
        }
        let again = once(&out);
        assert_eq!(
            again.map_err(|error| error.to_string()),
            Ok(whole.clone()),
            "call {n}"
        );
        if calls <= n {
            return n;
        }
        n += 1;
    }
}

#[test]
fn any_call_of_a_run_may_fail() {
    for lasting in [false, true] {
        println!("{} calls", fail_each(lasting, run_once));
    }
}

#[test]
fn any_call_of_a_sweep_may_fail() {
    for lasting in [false, true] {
        println!("{} calls", fail_each(lasting, sweep_once));
    }
}
