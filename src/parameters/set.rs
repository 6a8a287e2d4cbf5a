//! Values of a scene that are replaced before anything is built.
//!
//! In: a key and the text of its value (`--set duration=10s`), or a parameter and its value. Out:
//! the scene with that value, checked again.

use super::parameter::{Parameter, entries};
use super::parameter_row::{InScene, Names};
use super::value::Value;
use crate::scene::{Problem, Scene, SceneError, one_of, suggestion};
use std::collections::BTreeSet;

impl Scene {
    /// Keys that [`Scene::set`] takes, each with what it expects.
    pub fn settings() -> impl Iterator<Item = (String, String)> {
        let mut known = BTreeSet::new();
        let of_scenes = entries()
            .iter()
            .filter(|entry| entry.row.in_scene.is_some());
        let once = of_scenes.filter(move |entry| known.insert(entry.row.key));
        once.map(|entry| (entry.key(), entry.row.expected()))
    }

    /// Replaces one value before anything is built: one of [`Scene::settings`].
    ///
    /// # Errors
    /// When there is no such key, the text is no such value, or the scene does not hold together
    /// with it; the scene is then as it was.
    pub fn set(&mut self, key: &str, text: &str) -> Result<(), SceneError> {
        let mut changed = self.clone();
        changed.put(key, text)?;
        let origin = format!("{key}={text}");
        let checked = changed.problem();
        checked.map_err(|problem| SceneError::outside_of_files(&origin, problem))?;
        *self = changed;
        Ok(())
    }

    /// Replaces several values, in order, which need to hold together only all at once.
    ///
    /// # Errors
    /// Where they do not, that of the first one with which the scene does not; the scene is then as
    /// it was.
    pub fn set_all(&mut self, values: &[(&str, &str)]) -> Result<(), SceneError> {
        let mut changed = self.clone();
        let one_by_one = values
            .iter()
            .try_for_each(|(key, text)| changed.set(key, text));
        if let Err(refusal) = one_by_one {
            changed = self.clone();
            for (key, text) in values {
                changed.put(key, text)?;
            }
            if changed.problem().is_err() {
                return Err(refusal);
            }
        }
        *self = changed;
        Ok(())
    }

    /// Replaces one value, whether the scene holds together with it or not.
    fn put(&mut self, key: &str, text: &str) -> Result<(), SceneError> {
        let origin = format!("{key}={text}");
        let refuse = |problem| SceneError::outside_of_files(&origin, problem);
        let (parameter, own) = self.of_scene(key).ok_or_else(|| refuse(unknown(key)))?;
        let row = parameter.row();
        let unfit = || {
            refuse(Problem::value(
                key,
                format!("`{}`", text.trim()),
                row.expected(),
            ))
        };
        let value = row.parse(text).ok_or_else(unfit)?;
        (own.write)(self, parameter.names(), value).ok_or_else(unfit)
    }

    /// The parameter called `key` that it has, or else one that other scenes have.
    fn of_scene(&self, key: &str) -> Option<(Parameter, &'static InScene)> {
        let known = Parameter::of_key(key).into_iter();
        let mut known: Vec<_> = known
            .filter_map(|parameter| {
                let own = parameter.row().in_scene.as_ref()?;
                Some((parameter, own))
            })
            .collect();
        let is_here = |(parameter, own): &(Parameter, &InScene)| {
            (own.read)(self, parameter.names()).is_some()
        };
        let here = known.iter().position(is_here).unwrap_or(0);
        (here < known.len()).then(|| known.swap_remove(here))
    }
}

impl Parameter {
    /// What `scene` states for it; `None` where that has no such parameter, or it does not act
    /// there.
    pub fn stated(&self, scene: &Scene) -> Option<Value> {
        let own = self.row().in_scene.as_ref()?;
        (own.read)(scene, self.names())
    }

    /// Its value in `scene`, [SI unit] where it is a number: the one that acts where the scene
    /// leaves it to the program.
    pub fn in_effect(&self, scene: &Scene) -> Option<Value> {
        let stated = self.stated(scene)?;
        let in_effect = self.row().in_effect;
        Some(in_effect.map_or(stated, |in_effect| in_effect(scene)))
    }

    /// Gives `scene` the `value` for it.
    ///
    /// # Errors
    /// When the scene has no room for it or does not hold together with it; the scene is then as it
    /// was.
    pub fn state(&self, value: Value, scene: &mut Scene) -> Result<(), SceneError> {
        let key = self.to_string();
        let origin = format!("{key}={value}");
        let refuse = |problem| SceneError::outside_of_files(&origin, problem);
        let unfit = || {
            refuse(Problem::value(
                &key,
                format!("`{value}`"),
                self.row().expected(),
            ))
        };
        let own: &InScene = self.row().in_scene.as_ref().ok_or_else(unfit)?;
        let mut changed = scene.clone();
        let names: Names = self.names();
        (own.write)(&mut changed, names, value).ok_or_else(unfit)?;
        changed.problem().map_err(refuse)?;
        *scene = changed;
        Ok(())
    }
}

fn unknown(key: &str) -> Problem {
    let known: Vec<String> = Scene::settings().map(|(known, _)| known).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let mut problem = Problem::new(key, "cannot be set before a run", one_of(&known));
    problem.advice = suggestion(key, &known);
    problem
}
