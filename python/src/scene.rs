//! Scenes.

use crate::refused;
use grainfall::parameters::Settings;
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
#[pyclass(skip_from_py_object)]
#[derive(Clone)]
pub struct Scene(pub grainfall::scene::Scene);

#[pymethods]
impl Scene {
    /// The scene of this name (see `scenes()`) or in this file.
    #[new]
    fn open(name: PathBuf) -> PyResult<Self> {
        grainfall::scene::Scene::open(name)
            .map(Self)
            .map_err(refused)
    }

    /// The scene that `text` describes, as a scene file would.
    #[staticmethod]
    fn parse(text: &str) -> PyResult<Self> {
        grainfall::scene::Scene::parse("the text", text)
            .map(Self)
            .map_err(refused)
    }

    /// Gives the setting called `key` the value that `text` states, with its unit where it has one, as `--set KEY=VALUE` does.
    fn set(&mut self, key: &str, text: &Bound<'_, PyAny>) -> PyResult<()> {
        let text = text.str()?;
        self.0.set(key, text.to_str()?).map_err(refused)
    }

    /// Its title.
    #[getter]
    fn title(&self) -> &str {
        &self.0.title
    }

    /// How many grains it has.
    #[getter]
    fn grain_count(&self) -> usize {
        self.0.grain_count()
    }

    /// How long it runs [s].
    #[getter]
    fn duration(&self) -> f64 {
        self.0.duration
    }

    /// All settings with their values, as text that `set` takes.
    #[getter]
    fn settings(&self) -> BTreeMap<String, String> {
        let settings = Settings::of(&self.0);
        let list = settings.list().iter();
        list.map(|setting| (setting.key.clone(), setting.shown.clone()))
            .collect()
    }

    fn __repr__(&self) -> String {
        format!(
            "<Scene {:?}: {} grains, {} s>",
            self.0.title,
            self.0.grain_count(),
            self.0.duration
        )
    }
}
