//! `--set KEY=VALUE`: what is changed about a scene, before a run or at its first step.

use super::HeadlessError;
use crate::scene::Scene;
use crate::simulation::{Command, Parameter, ScriptedCommand};

/// Carries out one `--set`: at once where it is the scene's, as a command at step zero where it is a live parameter's.
///
/// # Errors
/// When the setting has no such form, there is no such key, or the value does not suit it.
pub fn apply_setting(
    scene: &mut Scene,
    setting: &str,
) -> Result<Option<ScriptedCommand>, HeadlessError> {
    let refuse = |reason: String| HeadlessError::Input(format!("--set {setting}: {reason}"));
    let Some((key, text)) = setting.split_once('=') else {
        return Err(refuse("expected KEY=VALUE, such as drum-speed=1rpm".into()));
    };
    if Scene::settings().any(|(known, _)| known == key) {
        scene.set(key, text)?;
        return Ok(None);
    }
    let parameter = Parameter::try_from(key.to_owned()).map_err(|reason| {
        let known: Vec<&str> = Scene::settings().map(|(known, _)| known).collect();
        refuse(format!("{reason}; or before a run: {}", known.join(", ")))
    })?;
    let value = parameter.parse_value(text).ok_or_else(|| {
        let (unit, shown) = (parameter.unit(), parameter.display().name);
        refuse(format!("`{text}` is no value; expected a number in SI units ({unit}), or one with its unit {shown}"))
    })?;
    Ok(Some(ScriptedCommand {
        step: Some(0),
        time: None,
        command: Command::Set { parameter, value },
    }))
}
