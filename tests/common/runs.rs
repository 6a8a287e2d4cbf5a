//! Runs that tests make, and how they are compared.

use grainfall::measure::Series;
use grainfall::parameters::{Parameter, Value};
use grainfall::run::{BedStore, Command, Preparation, Prepared, Run};
use grainfall::scene::Scene;
use grainfall::solver::advise;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

pub fn prepared(scene: &Scene, threads: usize, beds: BedStore) -> (Run, Vec<String>) {
    let time_step = advise(scene).time_step;
    let mut preparation = Preparation::new(Arc::new(scene.clone()), time_step, threads, beds);
    loop {
        if let Prepared::Ready(run) = preparation.advance().unwrap() {
            return (*run, preparation.warnings().to_vec());
        }
    }
}

/// Beds shared by the tests that are not about settling.
pub fn shared_beds() -> BedStore {
    BedStore::at(concat!(env!("CARGO_TARGET_TMPDIR"), "/beds"))
}

/// Carries out `work`, which is stopped a moment after it began, again and again, each time a
/// little later, until it says that it was not `interrupted`.
pub fn until_done<E: PartialEq + std::fmt::Debug>(
    interrupted: &E,
    work: impl Fn(&AtomicBool) -> E,
) -> E {
    for call in 0..200 {
        let stop = AtomicBool::new(false);
        let ending = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(60 + 40 * call));
                stop.store(true, Ordering::Relaxed);
            });
            work(&stop)
        });
        if ending != *interrupted {
            println!("{} calls", call + 1);
            return ending;
        }
    }
    panic!("it never comes to an end");
}

pub fn set(parameter: Parameter, value: impl Into<Value>) -> Command {
    let value = value.into();
    Command::Set { parameter, value }
}

pub fn friction(value: f64) -> Command {
    set(Parameter::Friction("glass".into(), "glass".into()), value)
}

pub fn bits(series: &Series) -> Vec<(u64, Vec<u64>)> {
    (0..series.len())
        .map(|index| series.get(index).unwrap())
        .map(|sample| (sample.step, sample.values.map(f64::to_bits).to_vec()))
        .collect()
}
