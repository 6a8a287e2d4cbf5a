//! What a run's folder holds, and its states one by one.
//!
//! In: the folder, its `summary.json` or one of its lists. Out: a [`Recording`]. Opening it reads
//! the lists, the table of samples and one state; every other state is read when it is asked for.

use super::RecordingError;
use super::course::Course;
use super::moments::{LARGEST_LIST, ListedFile, listed_files};
use super::own_files::OwnFiles;
use super::recorded_state::{OF_CONTACTS, OF_GRAINS, recorded_state};
use super::samples::{LARGEST_TABLE, samples};
use super::shapes::{WANTED, shapes};
use super::vtk_arrays::{LARGEST_FILE, VtkArrays};
use crate::measure::Series;
use crate::output::{IMPORTED, LISTS, SERIES, SHAPES, SUMMARY};
use crate::run::{
    Branch, Command, CommandError, Moment, Parameter, ParameterInfo, RunRecord, ScriptedCommand,
    StampedCommand, accept, live_parameters,
};
use crate::scene::{Scene, built_in};
use crate::solver::advise;
use crate::world::{MOST_STEPS, Polyhedron, World};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most that the time of a record may differ from that of its steps, relative to it.
const SAME_TIME: f64 = 1e-9;

/// A run that was computed before, as its folder holds it.
pub struct Recording {
    files: OwnFiles,
    record: RunRecord,
    scene: Arc<Scene>,
    course: Course,
    shapes: Option<Arc<[Polyhedron]>>,
    frames: Vec<Frame>,
    moments: Arc<[Moment]>,
    branch: Arc<Branch>,
    parameters: Arc<[ParameterInfo]>,
    notes: Vec<String>,
}

/// What is known of a recording beside its states.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingFacts {
    /// What its run was called.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
    /// The version of the program that wrote it.
    pub version: String,
    /// Whether another program computed it.
    pub is_imported: bool,
    /// The moments of which there are states, in order.
    pub moments: Arc<[Moment]>,
}

impl RecordingFacts {
    /// Index of the last state at or before `step`; the first one where none is.
    pub fn index_at(&self, step: u64) -> usize {
        index_at(&self.moments, step)
    }

    /// The longest time between two states [s].
    pub fn largest_gap(&self) -> f64 {
        let gaps = self
            .moments
            .windows(2)
            .map(|pair| pair[1].time - pair[0].time);
        gaps.fold(0.0, f64::max)
    }
}

/// Index of the last of `moments` at or before `step`; the first one where none is.
fn index_at(moments: &[Moment], step: u64) -> usize {
    moments.partition_point(|m| m.step <= step).max(1) - 1
}

/// The files of one instant.
struct Frame {
    grains: String,
    contacts: Option<String>,
}

/// A state of a recording.
pub struct RecordedState {
    /// The state.
    pub world: World,
    /// What people should know of its files, in sentences.
    pub notes: Vec<String>,
}

impl Recording {
    /// Whether what is called `name` is to be opened as one: a folder, `summary.json` or a list of
    /// states. A built-in scene wins over a folder of its name.
    pub fn is_at(name: &str) -> bool {
        let path = Path::new(name);
        if path.is_dir() {
            return !built_in().iter().any(|scene| scene.name == name);
        }
        let is_list = path.extension().is_some_and(|ending| ending == "pvd");
        is_list || path.file_name().is_some_and(|file| file == SUMMARY)
    }

    /// The recording in the folder at `path`, or in that of the file at `path`.
    ///
    /// # Errors
    /// When the folder is not one that a run wrote, or holds no state that can be shown.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let folder = if path.is_dir() {
            path
        } else {
            path.parent().unwrap_or(Path::new(""))
        };
        let summary = folder.join(SUMMARY);
        if !summary.exists() {
            return Err(RecordingError::of(
                folder,
                format!(
                    "holds no {SUMMARY}; expected the folder that a run without a window or an import wrote"
                ),
            ));
        }
        let stated = RunRecord::stated_by(&summary);
        let (record, is_as_written) = stated
            .map_err(|error| RecordingError::of(folder, format!("cannot be played: {error}")))?;
        let mut recording = Self::of_record(folder, record)?;
        if !is_as_written {
            let note = format!("{} is not as it was written", summary.display());
            recording.notes.push(note);
        }
        recording.list_states()?;
        recording.take_samples();
        recording.take_commands()?;
        Ok(recording)
    }

    /// That of `record` in `folder`, of which nothing else was read yet.
    fn of_record(folder: &Path, record: RunRecord) -> Result<Self, RecordingError> {
        let scene = Arc::new(record.scene.clone());
        let files = OwnFiles::new(folder.to_owned(), record.files.clone());
        let mut notes = notes_of(&record);
        let shapes = if scene.is_polyhedral() {
            let file = files.read(SHAPES, LARGEST_FILE)?;
            notes.extend(file.note());
            Some(shapes(&VtkArrays::of(&file, "UnstructuredGrid", &WANTED)?)?)
        } else {
            None
        };
        Ok(Self {
            course: Course::new(scene.clone(), first_step(&record)),
            files,
            record,
            scene,
            shapes,
            frames: Vec::new(),
            moments: Arc::new([]),
            branch: Arc::default(),
            parameters: Arc::new([]),
            notes,
        })
    }

    /// Reads which states there are.
    fn list_states(&mut self) -> Result<(), RecordingError> {
        let [grains, contacts] = LISTS;
        if !self.files.has(grains) {
            return Err(RecordingError::of(
                self.files.folder(),
                format!("holds no {grains}: its run wrote no states, and there is nothing to show"),
            ));
        }
        let states = self.listed(grains)?;
        let contacts = if self.files.has(contacts) {
            self.listed(contacts)?
        } else {
            Vec::new()
        };
        if states.is_empty() {
            return Err(RecordingError::of(
                &self.files.folder().join(grains),
                "lists no states: the run has not come to its first one",
            ));
        }
        let of_contacts = |time: f64| {
            let index = contacts.binary_search_by(|file| file.time.total_cmp(&time));
            index.ok().map(|index| contacts[index].name.clone())
        };
        self.frames = (states.iter())
            .map(|state| Frame {
                grains: state.name.clone(),
                contacts: of_contacts(state.time),
            })
            .collect();
        self.moments = states
            .iter()
            .map(|state| Moment {
                step: 0,
                time: state.time,
            })
            .collect();
        Ok(())
    }

    fn listed(&mut self, name: &str) -> Result<Vec<ListedFile>, RecordingError> {
        let list = self.files.read(name, LARGEST_LIST)?;
        self.notes.extend(list.note());
        listed_files(&list)
    }

    /// Reads the samples; without them there are no plots.
    fn take_samples(&mut self) {
        let read = self.files.read(SERIES, LARGEST_TABLE);
        let read = read.and_then(|file| Ok((file.note(), samples(&file)?)));
        match read {
            Ok((note, (series, fault))) => {
                self.notes.extend(note.into_iter().chain(fault));
                self.set_series(series);
            }
            Err(error) => self.notes.push(format!("There are no plots: {error}")),
        }
    }

    fn set_series(&mut self, series: Series) {
        Arc::make_mut(&mut self.branch).series = Arc::new(series);
    }

    /// Takes in what was changed on the way, and which step each state was taken after.
    fn take_commands(&mut self) -> Result<(), RecordingError> {
        let summary = self.files.folder().join(SUMMARY);
        let refuse = |reason: String| RecordingError::of(&summary, reason);
        let commands = stamped(&self.record.commands).map_err(refuse)?;
        let first = self.first_world()?;
        let parameters = live_parameters(&self.scene, &first);
        let accepted = commands.into_iter().map(|stamped| {
            let command = accept(&parameters, &first, &stamped.command)?;
            Ok(StampedCommand { command, ..stamped })
        });
        let accepted: Result<Vec<StampedCommand>, CommandError> = accepted.collect();
        let accepted = accepted.map_err(|error| refuse(format!("a change in it: {error}")))?;
        self.course.follow(accepted);
        self.parameters = parameters.into();
        let times = self.course.step_times();
        self.moments = (self.moments.iter())
            .map(|moment| Moment {
                step: times.step_at(moment.time),
                ..*moment
            })
            .collect();
        let follow = |pair: &[Moment]| pair[0].step < pair[1].step;
        if !self.moments.windows(2).all(follow) {
            return Err(RecordingError::of(
                self.files.folder(),
                "holds states that lie closer together than the run's time steps",
            ));
        }
        let branch = Arc::make_mut(&mut self.branch);
        branch.number = 1;
        branch.history = Arc::new(self.course.commands().iter().cloned().collect());
        branch.end = self.moments.last().copied().unwrap_or_default();
        Ok(())
    }

    /// The first state that can be read, as it was before any command.
    fn first_world(&self) -> Result<World, RecordingError> {
        let mut states = (0..self.frames.len()).map(|index| self.state(index));
        let first = states.next().transpose()?;
        let first = first.or_else(|| states.find_map(Result::ok));
        let none = || RecordingError::of(self.files.folder(), "holds no states");
        first.map(|state| state.world).ok_or_else(none)
    }

    /// What was asked for.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What is known of it beside its states.
    pub fn facts(&self) -> RecordingFacts {
        RecordingFacts {
            name: self.record.name.clone(),
            folder: self.files.folder().to_owned(),
            version: self.record.version.clone(),
            is_imported: self.record.status.as_deref() == Some(IMPORTED),
            moments: self.moments.clone(),
        }
    }

    /// How long its first step was [s].
    pub fn first_step(&self) -> f64 {
        first_step(&self.record)
    }

    /// The moments of which there are states, in order; at least one.
    pub fn moments(&self) -> &Arc<[Moment]> {
        &self.moments
    }

    /// Index of the last state at or before `step`; the first one where none is.
    pub fn index_at(&self, step: u64) -> usize {
        index_at(&self.moments, step)
    }

    /// What was changed and measured.
    pub fn branch(&self) -> &Arc<Branch> {
        &self.branch
    }

    /// The parameters of its scene.
    pub fn parameters(&self) -> &Arc<[ParameterInfo]> {
        &self.parameters
    }

    /// What people should know of it, in sentences.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The state at the moment of this `index`.
    ///
    /// # Errors
    /// When its files cannot be read, or hold a state to which no run comes.
    pub fn state(&self, index: usize) -> Result<RecordedState, RecordingError> {
        let (Some(frame), Some(moment)) = (self.frames.get(index), self.moments.get(index)) else {
            let reason = format!("holds no state number {index}");
            return Err(RecordingError::of(self.files.folder(), reason));
        };
        let mut notes = Vec::new();
        let mut read = |name: &str, wanted: &[&str]| {
            let file = self.files.read(name, LARGEST_FILE)?;
            notes.extend(file.note());
            VtkArrays::of(&file, "PolyData", wanted)
        };
        let grains = read(&frame.grains, &OF_GRAINS)?;
        let contacts = (frame.contacts.as_ref())
            .map(|name| read(name, &OF_CONTACTS))
            .transpose()?;
        let course = self.course.at(moment.step);
        let world = recorded_state(course, &grains, contacts.as_ref(), self.shapes.as_ref())?;
        Ok(RecordedState { world, notes })
    }
}

/// What is to be said of a run with this `record`.
fn notes_of(record: &RunRecord) -> Vec<String> {
    let text = match record.status.as_deref() {
        Some("running") => {
            "The run was on its way, or was killed, when this was opened: changes that were made on its way are not known, \
             and files are not compared with their digests"
        }
        Some("interrupted") => "The run was stopped before its end",
        Some("fault") => {
            "A physical fault stopped the run at its end: its summary.json says which, and the last states need not mean \
             anything"
        }
        _ => return Vec::new(),
    };
    vec![text.to_owned()]
}

/// How long the first step of the run with this `record` was [s]: as its scene says, unless the
/// time that it came to says otherwise, as that of an import may.
fn first_step(record: &RunRecord) -> f64 {
    let advised = advise(&record.scene).time_step;
    let found = record.time / record.steps as f64;
    let differs = (found - advised).abs() > SAME_TIME * advised;
    if found > 0.0 && found.is_finite() && differs && !changes_step(&record.commands) {
        found
    } else {
        advised
    }
}

fn changes_step(commands: &[ScriptedCommand]) -> bool {
    (commands.iter()).any(|scripted| {
        matches!(&scripted.command, Command::Set { parameter, .. } if *parameter == Parameter::TimeStep)
    })
}

/// `commands` as a run carried them out.
fn stamped(commands: &[ScriptedCommand]) -> Result<Vec<StampedCommand>, String> {
    let mut last = (0, 0.0);
    let mut stamped = Vec::with_capacity(commands.len());
    for (index, scripted) in commands.iter().enumerate() {
        let when = scripted.step.zip(scripted.time);
        let follows = |(step, time): &(u64, f64)| {
            last.0 <= *step && last.1 <= *time && time.is_finite() && *step <= MOST_STEPS
        };
        let Some((step, time)) = when.filter(follows) else {
            return Err(format!("change {} in it is not in order", index + 1));
        };
        last = (step, time);
        let command = scripted.command.clone();
        stamped.push(StampedCommand {
            step,
            time,
            command,
        });
    }
    Ok(stamped)
}
