//! One case of a paper as a line of a file that keeps results: whose it is, how it was computed,
//! what it came to.
//!
//! In: what a case came to. Out: a line of JSON, some 3 kB; and from it results that are equal to
//! the last bit, or what is wrong with it. A case is known by a fingerprint of all that its run
//! depends on; its name is for people.

use crate::measure::{CompactSummary, Summary};
use crate::run::{VERSION, fingerprint, method};
use crate::sweep::{Case, CaseResult};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// What a scene states that no trajectory and no result depends on: what it is called, and when its
/// grains would be written, which those of a sweep are not.
const WITHOUT_EFFECT: [&str; 4] = ["title", "look_for", "source", "output_interval"];
/// How the cases that are kept have ended.
const DONE: &str = "done";

/// What a line is known by: of each scene and method there is one, whatever the case is called.
#[derive(Clone, Debug)]
pub struct Identity {
    /// Name of the case, for people.
    pub case: String,
    /// Fingerprint of its scene, script, time step and duration.
    pub scene: String,
    /// Hash of how it was computed ([`method`]).
    pub method: String,
}

/// All that a line holds.
#[derive(Serialize, Deserialize)]
struct Contents {
    case: String,
    scene: String,
    method: String,
    version: String,
    ended: String,
    state: String,
    results: CompactSummary,
}

/// The contents with what tells whether they were edited since.
#[derive(Serialize)]
struct Signed<'a> {
    #[serde(flatten)]
    contents: &'a Contents,
    fingerprint: String,
}

/// A line.
#[derive(Clone, Debug)]
pub struct KeptLine {
    /// What it is known by.
    pub identity: Identity,
    /// Hash of the last state.
    pub state: String,
    /// The line, without its end.
    pub text: String,
}

impl Identity {
    /// That of `case` as this build computes it.
    ///
    /// # Errors
    /// When its scene has no form in JSON.
    pub fn of(case: &Case) -> Result<Self, String> {
        let failed = |error: serde_json::Error| {
            format!("{}: its scene has no fingerprint: {error}", case.name)
        };
        let mut scene = serde_json::to_value(&case.scene).map_err(failed)?;
        if let Some(values) = scene.as_object_mut() {
            values.retain(|key, _| !WITHOUT_EFFECT.contains(&key.as_str()));
        }
        let script = serde_json::to_value(&case.script).map_err(failed)?;
        let mut all = json!({"scene": scene, "script": script, "time_step": case.time_step});
        drop_nothings(&mut all);
        Ok(Self {
            case: case.name.clone(),
            scene: fingerprint(&all),
            method: method(&case.scene).to_owned(),
        })
    }

    /// Whether both compute the same.
    pub fn is_same_run(&self, other: &Self) -> bool {
        self.scene == other.scene && self.method == other.method
    }
}

/// Takes out what is stated to be nothing: it is the same as what is not stated.
fn drop_nothings(value: &mut Value) {
    match value {
        Value::Object(entries) => {
            entries.retain(|_, value| !value.is_null());
            entries.values_mut().for_each(drop_nothings);
        }
        Value::Array(list) => list.iter_mut().for_each(drop_nothings),
        _ => {}
    }
}

impl KeptLine {
    /// The line of what a case came to, which `identity` names.
    ///
    /// # Errors
    /// When its results do not come back from it as they are.
    pub fn of(identity: Identity, outcome: &CaseResult) -> Result<Self, String> {
        let name = &identity.case;
        let failed = |reason: &str| format!("{name}: its results cannot be kept: {reason}");
        let contents = Contents {
            case: identity.case.clone(),
            scene: identity.scene.clone(),
            method: identity.method.clone(),
            version: VERSION.to_owned(),
            ended: DONE.to_owned(),
            state: outcome.hash.clone(),
            results: CompactSummary::from(&outcome.results),
        };
        let written = serde_json::to_value(&contents).and_then(|stated| {
            serde_json::to_string(&Signed {
                contents: &contents,
                fingerprint: fingerprint(&stated),
            })
        });
        let line = Self {
            state: outcome.hash.clone(),
            text: written.map_err(|error| failed(&error.to_string()))?,
            identity: identity.clone(),
        };
        let back = line.results().map_err(|error| failed(&error))?;
        if back != outcome.results {
            return Err(failed("a line does not hold their numbers"));
        }
        Ok(line)
    }

    /// The line that `text` is; its results are not read yet.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(text: &str) -> Result<Self, String> {
        let value: Value =
            serde_json::from_str(text).map_err(|error| format!("it is no JSON: {error}"))?;
        if value["fingerprint"] != fingerprint(&value) {
            return Err("it was edited or damaged since it was written".to_owned());
        }
        let word = |key: &str| {
            let word = value[key].as_str().map(str::to_owned);
            word.ok_or_else(|| format!("it states no {key}"))
        };
        if word("ended")? != DONE {
            return Err(format!("its case did not end as `{DONE}`"));
        }
        let is_digit = |byte: u8| byte.is_ascii_hexdigit();
        let state = word("state")?;
        if state.len() != 32 || !state.bytes().all(is_digit) {
            return Err("its state is no hash of 32 hexadecimal digits".to_owned());
        }
        Ok(Self {
            identity: Identity {
                case: word("case")?,
                scene: word("scene")?,
                method: word("method")?,
            },
            state,
            text: text.to_owned(),
        })
    }

    /// The results.
    ///
    /// # Errors
    /// What of them this program does not know.
    pub fn results(&self) -> Result<Summary, String> {
        let contents: Contents =
            serde_json::from_str(&self.text).map_err(|error| error.to_string())?;
        contents.results.summary()
    }
}
