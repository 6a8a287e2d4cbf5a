//! Scenes.

use crate::refused;
use grainfall::parameters::Settings;
use grainfall::run::ScriptedCommand;
use grainfall::runner::apply_settings;
use grainfall::scene::built_in;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The scenes that come with Grainfall, by name, each with its title.
#[pyfunction]
pub fn scenes() -> BTreeMap<&'static str, String> {
    let titled = |scene: &grainfall::scene::BuiltIn| {
        let read = grainfall::scene::Scene::open(scene.name);
        (
            scene.name,
            read.map_or_else(|_| String::new(), |scene| scene.title),
        )
    };
    built_in().iter().map(titled).collect()
}

/// What is to be run: container, grains, materials, liquid, gravity, how long.
#[pyclass]
pub struct Scene {
    pub scene: grainfall::scene::Scene,
    /// Live parameters that were set: commands at the first step.
    pub script: Vec<ScriptedCommand>,
}

impl From<grainfall::scene::Scene> for Scene {
    fn from(scene: grainfall::scene::Scene) -> Self {
        Self {
            scene,
            script: Vec::new(),
        }
    }
}

#[pymethods]
impl Scene {
    /// The scene of this name (see `scenes()`) or in this file.
    #[new]
    fn open(name: PathBuf) -> PyResult<Self> {
        grainfall::scene::Scene::open(name)
            .map(Self::from)
            .map_err(refused)
    }

    /// The scene that `text` describes, as a scene file would.
    #[staticmethod]
    fn parse(text: &str) -> PyResult<Self> {
        grainfall::scene::Scene::parse("the text", text)
            .map(Self::from)
            .map_err(refused)
    }

    /// Gives the setting called `key` the value that `text` states, with its unit where it has one, as `--set KEY=VALUE` does.
    fn set(&mut self, key: &str, text: &Bound<'_, PyAny>) -> PyResult<()> {
        let setting = format!("{key}={}", text.str()?.to_str()?);
        let live = apply_settings(&mut self.scene, &[setting]).map_err(refused)?;
        self.script.extend(live);
        Ok(())
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// How many grains it has.
    #[getter]
    fn grain_count(&self) -> usize {
        self.scene.grain_count()
    }

    /// How long it runs [s].
    #[getter]
    fn duration(&self) -> f64 {
        self.scene.duration
    }

    /// All settings with their values, as text that `set` takes.
    #[getter]
    fn settings(&self) -> BTreeMap<String, String> {
        let settings = Settings::of(&self.scene);
        let list = settings.list().iter();
        list.map(|setting| (setting.key.clone(), setting.shown.clone()))
            .collect()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Scene {:?}: {} grains, {} s>",
            self.scene.title,
            self.scene.grain_count(),
            self.scene.duration
        )
    }
}
