//! Runs.

use crate::scene::Scene;
use crate::{columns, refused};
use grainfall::measure::{Measure, MeasuredValue};
use grainfall::output::RunSoFar;
use grainfall::run::{BedStore, Preparation, Prepared, Script, available_threads};
use grainfall::runner::live_command;
use grainfall::solver::advise;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;

/// Simulated time between two looks at whether somebody pressed Ctrl-C, in steps.
const STEPS_BETWEEN_SIGNALS: u64 = 500;

/// A scene under way: at time zero when it is made, its bed settled, and further with each call of `advance`.
#[pyclass]
pub struct Run {
    run: grainfall::run::Run,
    /// Until when it was to go on [s]: many short calls of `advance` lead where one long one does, though each ends on a step.
    until: f64,
}

#[pymethods]
impl Run {
    /// Begins `scene` on so many threads, as many as there are cores unless told otherwise. A bed that was settled before is taken from
    /// where Grainfall keeps them.
    #[new]
    #[pyo3(signature = (scene, threads=None))]
    fn begin(py: Python<'_>, scene: &Scene, threads: Option<usize>) -> PyResult<Self> {
        let script = scene.script.clone();
        let scene = Arc::new(scene.scene.clone());
        let time_step = advise(&scene).time_step;
        let threads = threads.unwrap_or_else(available_threads).max(1);
        let mut preparation = Preparation::new(scene, time_step, threads, BedStore::user());
        loop {
            let piece = py.detach(|| preparation.advance());
            py.check_signals()?;
            if let Prepared::Ready(mut run) = piece.map_err(refused)? {
                let script = Script::new(&script, &run.world().clock).map_err(refused)?;
                run.schedule(script).map_err(refused)?;
                let until = run.world().time();
                return Ok(Self { run: *run, until });
            }
        }
    }

    /// Goes on for `duration` seconds of simulated time, and to the end of a step. Ctrl-C stops it where it stands.
    fn advance(&mut self, py: Python<'_>, duration: f64) -> PyResult<()> {
        if !(duration >= 0.0 && duration.is_finite()) {
            let reason = format!("expected a duration of at least 0 s, found {duration}");
            return Err(pyo3::exceptions::PyValueError::new_err(reason));
        }
        self.until += duration;
        let last = self.run.world().clock.step_at(self.until);
        while self.run.world().clock.step < last {
            let next = last.min(self.run.world().clock.step + STEPS_BETWEEN_SIGNALS);
            py.detach(|| self.run.advance_to(next)).map_err(refused)?;
            py.check_signals()?;
        }
        Ok(())
    }

    /// Changes a live parameter now, as a recorded command: `set("friction.glass.glass", 0.2)`.
    fn set(&mut self, key: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let value = value.str()?;
        let command = live_command(key, value.to_str()?).map_err(refused)?;
        self.run.apply(command).map_err(refused)
    }

    /// Simulated time [s].
    #[getter]
    fn time(&self) -> f64 {
        self.run.world().time()
    }

    /// Steps taken.
    #[getter]
    fn step(&self) -> u64 {
        self.run.world().clock.step
    }

    /// Length of a step [s].
    #[getter]
    fn time_step(&self) -> f64 {
        self.run.world().clock.time_step
    }

    /// Hash of the state: equal states have equal ones, on every machine.
    #[getter]
    fn hash(&self) -> String {
        self.run.world().hash().to_string()
    }

    /// The grains now, in SI units, by column: `position`, `velocity`, `spin`, `force` and `torque` of three components each, `radius`,
    /// `mass`, `film` (volume of liquid on it), `contact_count`, `species` (an index into `species_names`).
    fn grains<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        columns::grains(py, self.run.world())
    }

    /// What touches or is held by a bridge now, by column: `grain`, `partner` (below zero a wall, −1 the first), `force` on the grain,
    /// `spring`, `touching`, `bridge`.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        columns::contacts(py, self.run.world())
    }

    /// What was sampled so far, by column, in SI units: `time`, `step` and every quantity that this scene has.
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let series = self.run.series();
        let columns = PyDict::new(py);
        columns.set_item("time", PyArray1::from_slice(py, series.time()))?;
        columns.set_item("step", PyArray1::from_slice(py, series.steps()))?;
        for measure in Measure::of(self.run.world()) {
            let values = PyArray1::from_slice(py, series.column(measure));
            columns.set_item(measure.quantity().key, values)?;
        }
        Ok(columns)
    }

    /// The SI unit of each column of `series`.
    fn units(&self) -> Vec<(&'static str, &'static str)> {
        let unit = |measure: Measure| (measure.quantity().key, measure.quantity().unit.si);
        Measure::of(self.run.world())
            .into_iter()
            .map(unit)
            .collect()
    }

    /// The results so far, each a dictionary of `value`, `error` (the standard error of a mean, `None` where the run is too short for
    /// one), `unit` and `note`.
    fn results<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let results = PyDict::new(py);
        for entry in RunSoFar::of(&self.run).results().entries {
            let found = PyDict::new(py);
            match entry.value {
                None => found.set_item("value", py.None())?,
                Some(MeasuredValue::Number(value)) => found.set_item("value", value)?,
                Some(MeasuredValue::Mean(estimate)) => found.set_item("value", estimate.mean)?,
                Some(MeasuredValue::Count(count)) => found.set_item("value", count)?,
                Some(MeasuredValue::Choice(word)) => found.set_item("value", word)?,
            }
            found.set_item(
                "error",
                entry.estimate().and_then(|estimate| estimate.error),
            )?;
            found.set_item("unit", entry.key.quantity().unit.si)?;
            found.set_item("note", &entry.note)?;
            results.set_item(entry.key.name(), found)?;
        }
        Ok(results)
    }

    fn __repr__(&self) -> String {
        let world = self.run.world();
        format!(
            "<Run of {:?} at {} s: {} grains>",
            self.run.scene().title,
            world.time(),
            world.grains.len()
        )
    }
}
