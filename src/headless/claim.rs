//! What a file claims: that this scene with these commands comes to that state. `grainfall verify FILE` computes it again.
//!
//! In: a run's `summary.json`, or a list of changes that was saved in the window. Out: whether the state is the same to
//! the bit. A fingerprint over all that makes the claim tells a file that was edited or damaged since.

use super::{HeadlessError, Progress};
use crate::files::write_whole;
use crate::scene::Scene;
use crate::simulation::{
    BedStore, Command, Preparation, Run, Script, ScriptedCommand, StampedCommand,
};
use crate::solver::{Fault, advise};
use crate::world::{StateHash, World};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::{fs, io};

/// Version of the program, as files state it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Simulated time between two looks at whether to stop [s].
const SLICE: f64 = 0.01;

/// A state and all that leads to it, as JSON files hold it; what else they hold is passed over.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Claim {
    /// Always `grainfall`.
    pub program: String,
    /// Version of the program that wrote it.
    pub version: String,
    /// What the scene was called.
    pub name: String,
    /// The scene as it was run.
    pub scene: Scene,
    /// What was changed, in order; those after the state too.
    pub commands: Vec<ScriptedCommand>,
    /// Steps taken until the state.
    pub steps: u64,
    /// Simulated time of the state [s].
    pub time: f64,
    /// Hash of the state; none where the run had not begun.
    pub state_hash: Option<String>,
    /// Hash of scene, commands, steps and state.
    pub fingerprint: Option<String>,
}

/// What became of a claim.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The state is the same to the bit.
    Same,
    /// The run came to a state with this hash.
    Other(StateHash),
    /// The run met a fault on the way.
    Faulted(Fault),
    /// Somebody stopped it.
    Interrupted,
}

impl Verdict {
    /// What the process ends with: 0, 4, 3 or 130.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Same => 0,
            Self::Other(_) => 4,
            Self::Faulted(_) => 3,
            Self::Interrupted => 130,
        }
    }
}

/// Hash of all that a claim states. Commands count by step and content.
pub fn fingerprint<'a>(
    scene: &Scene,
    commands: impl Iterator<Item = (Option<u64>, &'a Command)>,
    steps: u64,
    state_hash: Option<&str>,
) -> String {
    let commands: Vec<_> = commands.collect();
    let all = postcard::to_stdvec(&(scene, commands, steps, state_hash)).unwrap_or_default();
    blake3::hash(&all).to_hex()[..32].to_owned()
}

impl Claim {
    /// That `scene`, called `name`, with `commands` comes to `world`.
    pub fn of(name: &str, scene: &Scene, commands: &[StampedCommand], world: &World) -> Self {
        let commands: Vec<ScriptedCommand> = commands.iter().map(Into::into).collect();
        let mut claim = Self {
            program: "grainfall".into(),
            version: VERSION.into(),
            name: name.into(),
            scene: scene.clone(),
            commands,
            steps: world.clock.step,
            time: world.time(),
            state_hash: Some(world.hash().to_string()),
            fingerprint: None,
        };
        claim.fingerprint = Some(claim.own_fingerprint());
        claim
    }

    /// The claim of the JSON file at `path`.
    ///
    /// # Errors
    /// When the file cannot be read, makes no claim, or was edited since it was written.
    pub fn read(path: &Path) -> Result<Self, HeadlessError> {
        let name = path.display();
        let refuse = |reason: String| {
            HeadlessError::Input(format!(
                "{name}: {reason}; expected a run's summary.json, or a list of changes saved in the window"
            ))
        };
        let text =
            fs::read_to_string(path).map_err(|error| refuse(format!("cannot be read: {error}")))?;
        let claim: Self = serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))?;
        if claim.program != "grainfall" || claim.state_hash.is_none() {
            return Err(refuse("states no state to come to".into()));
        }
        if claim.fingerprint != Some(claim.own_fingerprint()) {
            return Err(refuse(format!(
                "its fingerprint does not fit: the file was edited or damaged, or written by another version than \
                 {VERSION} (it says {})",
                claim.version
            )));
        }
        Ok(claim)
    }

    /// Writes it to the file at `path`, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        write_whole(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            file.write_all(b"\n")
        })
    }

    /// Computes the state again on `threads` threads, from time zero, until `stop` says so.
    ///
    /// # Errors
    /// When the scene or the commands cannot be run.
    pub fn verify(
        &self,
        threads: usize,
        beds: BedStore,
        stop: &dyn Fn() -> bool,
    ) -> Result<Verdict, HeadlessError> {
        let refuse = |reason: String| HeadlessError::Input(format!("{}: {reason}", self.name));
        let time_step = advise(&self.scene).time_step;
        let scene = std::sync::Arc::new(self.scene.clone());
        let mut progress = Progress::new();
        let mut preparation = Preparation::new(scene, time_step, threads, beds);
        let mut run = match preparation.go_through(stop) {
            Ok(Some(run)) => run,
            Ok(None) => return Ok(Verdict::Interrupted),
            Err(fault) => return Ok(Verdict::Faulted(fault)),
        };
        let script =
            Script::new(&self.commands, &run.world().clock).map_err(|e| refuse(e.to_string()))?;
        run.schedule(script).map_err(|e| refuse(e.to_string()))?;
        let reached = self.advance(&mut run, &mut progress, stop);
        progress.finish();
        let hash = run.world().hash();
        Ok(match reached {
            Err(fault) => Verdict::Faulted(fault),
            Ok(false) => Verdict::Interrupted,
            Ok(true) if self.state_hash == Some(hash.to_string()) => Verdict::Same,
            Ok(true) => Verdict::Other(hash),
        })
    }

    /// Advances `run` to the claim's step; says whether it came there.
    fn advance(
        &self,
        run: &mut Run,
        progress: &mut Progress,
        stop: &dyn Fn() -> bool,
    ) -> Result<bool, Fault> {
        let slice = (SLICE / run.world().clock.time_step).ceil() as u64;
        while run.world().clock.step < self.steps {
            if stop() {
                return Ok(false);
            }
            let step = run.world().clock.step;
            run.advance_to(self.steps.min(step + slice))?;
            let share = step as f64 / self.steps as f64;
            progress.tell(share, || {
                format!("t = {:.2} s of {:.2} s", run.world().time(), self.time)
            });
        }
        Ok(true)
    }

    fn own_fingerprint(&self) -> String {
        let commands = self
            .commands
            .iter()
            .map(|entry| (entry.step, &entry.command));
        fingerprint(
            &self.scene,
            commands,
            self.steps,
            self.state_hash.as_deref(),
        )
    }
}
