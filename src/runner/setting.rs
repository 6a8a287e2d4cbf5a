//! `--set KEY=VALUE`: what is changed about a scene, before a run or at its first step.

use super::RunnerError;
use crate::parameters::{Parameter, Value};
use crate::run::{Command, ScriptedCommand};
use crate::scene::Scene;

/// Carries out every `--set`: at once and together where they are the scene's, as commands at step
/// zero where they are of live parameters.
///
/// # Errors
/// When a setting has no such form, there is no such key, or the scene does not hold together with
/// its value.
pub fn apply_settings<S: AsRef<str>>(
    scene: &mut Scene,
    settings: &[S],
) -> Result<Vec<ScriptedCommand>, RunnerError> {
    let mut script = Vec::new();
    let mut of_scene = Vec::new();
    for setting in settings.iter().map(AsRef::as_ref) {
        match read_setting(setting)? {
            SettingTarget::Scene(key, text) => of_scene.push((key, text)),
            SettingTarget::Live(command) => script.push(command),
        }
    }
    scene.set_all(&of_scene)?;
    Ok(script)
}

/// What one `--set` changes.
enum SettingTarget<'a> {
    /// A key of the scene, to which the text is given.
    Scene(&'a str, &'a str),
    /// A live parameter.
    Live(ScriptedCommand),
}

fn read_setting(setting: &str) -> Result<SettingTarget<'_>, RunnerError> {
    let refuse = |reason: String| RunnerError::Input(format!("--set {setting}: {reason}"));
    let Some((key, text)) = setting.split_once('=') else {
        return Err(refuse("expected KEY=VALUE, such as drum-speed=1rpm".into()));
    };
    let mut known = Parameter::of_key(key).into_iter();
    if known.any(|parameter| parameter.row().in_scene.is_some()) {
        return Ok(SettingTarget::Scene(key, text));
    }
    let (parameter, value) = parameter_value(key, text).map_err(|reason| match reason {
        SettingMistake::Key(reason) => {
            let known: Vec<String> = Scene::settings().map(|(known, _)| known).collect();
            refuse(format!("{reason}; or before a run: {}", known.join(", ")))
        }
        SettingMistake::Value(reason) => refuse(reason),
    })?;
    Ok(SettingTarget::Live(ScriptedCommand {
        step: Some(0),
        time: None,
        command: Command::Set { parameter, value },
    }))
}

/// The live parameter and the value of one `--compare`.
///
/// # Errors
/// When the setting has no such form, there is no such key, or its value is none.
pub fn compared_value(setting: &str) -> Result<(Parameter, Value), RunnerError> {
    let refuse = |reason: String| RunnerError::Input(format!("--compare {setting}: {reason}"));
    let Some((key, text)) = setting.split_once('=') else {
        return Err(refuse("expected KEY=VALUE, such as viscosity=1.41".into()));
    };
    parameter_value(key, text).map_err(|unfit| match unfit {
        SettingMistake::Key(reason) | SettingMistake::Value(reason) => refuse(reason),
    })
}

/// The command that gives the live parameter called `key` the value that `text` states.
///
/// # Errors
/// When there is no such key, or its value is none.
pub fn live_command(key: &str, text: &str) -> Result<Command, RunnerError> {
    match parameter_value(key, text) {
        Ok((parameter, value)) => Ok(Command::Set { parameter, value }),
        Err(SettingMistake::Key(reason) | SettingMistake::Value(reason)) => {
            Err(RunnerError::Input(format!("{key}: {reason}")))
        }
    }
}

/// What is wrong with a setting.
enum SettingMistake {
    Key(String),
    Value(String),
}

fn parameter_value(key: &str, text: &str) -> Result<(Parameter, Value), SettingMistake> {
    let parameter = Parameter::try_from(key.to_owned()).map_err(SettingMistake::Key)?;
    let row = parameter.row();
    let value = row.parse(text).ok_or_else(|| {
        let expected = row.kind.expected();
        SettingMistake::Value(format!("`{text}` is no value; expected {expected}"))
    })?;
    Ok((parameter, value))
}
