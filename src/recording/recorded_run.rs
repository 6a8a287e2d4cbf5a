//! What a run's folder holds, and its states one by one.
//!
//! In: the folder, its `summary.json` or one of its lists. Out: a [`Recording`]. Opening it reads
//! the lists, the table of samples and one state; every other state is read when it is asked for.

use super::RecordingError;
use super::course::Course;
use super::moments::{LARGEST_LIST, ListedFile, listed_files};
use super::own_files::OwnFiles;
use super::recorded_state::{OF_CONTACTS, OF_GRAINS, recorded_state};
use super::shapes::{WANTED, shapes};
use super::stated::{RunProgress, first_step, notes_of, progress_of, stamped};
use super::tables::Tables;
use super::vtk_arrays::{LARGEST_FILE, VtkArrays};
use crate::measure::{MeanFlow, Series};
use crate::output::{IMPORTED, LISTS, SHAPES, SUMMARY};
use crate::run::{
    Branch, CommandError, Moment, ParameterInfo, RunRecord, StampedCommand, accept, live_parameters,
};
use crate::scene::{Scene, built_in};
use crate::world::{Polyhedron, World};
use std::path::{Path, PathBuf};
use std::sync::Arc;

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
    progress: RunProgress,
    flow: Option<Arc<MeanFlow>>,
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
    /// Whether its run goes on.
    pub progress: RunProgress,
}

impl RecordingFacts {
    /// Index of the last state at or before `step`; the first one where none is.
    pub fn index_at(&self, step: u64) -> usize {
        index_at(&self.moments, step)
    }

    /// Index of the state that is shown when `step` is asked for: the nearest.
    pub fn nearest(&self, step: u64) -> usize {
        nearest(&self.moments, step)
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

/// Index of that of `moments` which is nearest to `step`.
fn nearest(moments: &[Moment], step: u64) -> usize {
    let before = index_at(moments, step);
    let away = |index: usize| moments.get(index).map(|moment| moment.step.abs_diff(step));
    let is_nearer = away(before + 1).is_some_and(|after| Some(after) < away(before));
    before + usize::from(is_nearer)
}

/// Index of the last of `moments` at or before `step`; the first one where none is.
fn index_at(moments: &[Moment], step: u64) -> usize {
    moments.partition_point(|m| m.step <= step).max(1) - 1
}

/// The files of one instant.
#[derive(PartialEq)]
struct Frame {
    grains: String,
    contacts: Option<String>,
}

/// What the lists of a folder say.
struct ListedStates {
    frames: Vec<Frame>,
    /// When each of them was [s].
    times: Vec<f64>,
    /// What is to be said of the lists, in sentences.
    notes: Vec<String>,
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
        let first = recording.first_world()?;
        recording.take_commands(&first)?;
        recording.take_tables(&first);
        Ok(recording)
    }

    /// That of `record` in `folder`, of which nothing else was read yet.
    fn of_record(folder: &Path, record: RunRecord) -> Result<Self, RecordingError> {
        let scene = Arc::new(record.scene.clone());
        let files = OwnFiles::new(folder.to_owned(), record.files.clone());
        let progress = progress_of(&record, folder);
        let mut notes = notes_of(&record, progress);
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
            progress,
            flow: None,
            notes,
        })
    }

    /// Takes up the states and samples that were written since it was read; says whether there are
    /// more of them. Nothing is told of files that are being written this moment.
    ///
    /// # Errors
    /// When they are not those of the run that was read: what was read stays.
    pub(super) fn grow(&mut self) -> Result<bool, RecordingError> {
        let ListedStates { frames, times, .. } = self.read_states()?;
        let known = self.frames.len();
        let known_times = self.moments.iter().map(|moment| moment.time);
        let is_same = frames.iter().zip(&self.frames).all(|(a, b)| a == b)
            && times.iter().zip(known_times).all(|(a, b)| *a == b);
        let moments = self.moments_at(&times);
        if !is_same || !follow_each_other(&moments) {
            let reason = "lists other states than before: another run is in the folder now";
            return Err(RecordingError::of(self.files.folder(), reason));
        }
        if frames.len() > known {
            (self.frames, self.moments) = (frames, moments);
            let branch = Arc::make_mut(&mut self.branch);
            branch.end = self.moments.last().copied().unwrap_or_default();
        }
        let samples = self.branch.series.len();
        if let Ok((series, _)) = self.tables().samples() {
            self.set_series(series);
        }
        Ok(self.frames.len() > known || self.branch.series.len() > samples)
    }

    /// The same read anew.
    ///
    /// # Errors
    /// When it cannot be read, or another run is in the folder.
    pub(super) fn again(&self) -> Result<Self, RecordingError> {
        let again = Self::open(self.files.folder())?;
        let is_same = again.scene == self.scene && again.moments[0].time == self.moments[0].time;
        is_same.then_some(again).ok_or_else(|| {
            let reason = "holds another run now";
            RecordingError::of(self.files.folder(), reason)
        })
    }

    /// Its folder.
    pub(super) fn folder(&self) -> &Path {
        self.files.folder()
    }

    /// Whether its run goes on, as far as is known.
    pub fn progress(&self) -> RunProgress {
        self.progress
    }

    /// Takes note that its run goes on, or does not.
    pub(super) fn set_progress(&mut self, progress: RunProgress) {
        self.progress = progress;
    }

    /// Reads which states there are.
    fn list_states(&mut self) -> Result<(), RecordingError> {
        let [grains, _] = LISTS;
        if !self.files.has(grains) {
            return Err(RecordingError::of(
                self.files.folder(),
                format!("holds no {grains}: its run wrote no states, and there is nothing to show"),
            ));
        }
        let ListedStates {
            frames,
            times,
            notes,
        } = self.read_states()?;
        if frames.is_empty() {
            return Err(RecordingError::of(
                &self.files.folder().join(grains),
                "lists no states: the run has not come to its first one",
            ));
        }
        self.notes.extend(notes);
        self.frames = frames;
        // Which steps they were taken after is known with the commands.
        let moment = |time: &f64| Moment {
            step: 0,
            time: *time,
        };
        self.moments = times.iter().map(moment).collect();
        Ok(())
    }

    /// What the lists say.
    fn read_states(&self) -> Result<ListedStates, RecordingError> {
        let [grains, contacts] = LISTS;
        let mut notes = Vec::new();
        let mut states = self.listed(grains, &mut notes)?;
        let contacts = if self.files.has(contacts) {
            self.listed(contacts, &mut notes)?
        } else {
            Vec::new()
        };
        let of_contacts = |time: f64| {
            let index = contacts.binary_search_by(|file| file.time.total_cmp(&time));
            index.ok().map(|index| contacts[index].name.clone())
        };
        let is_half = |last: &ListedFile| of_contacts(last.time).is_none() && !contacts.is_empty();
        // The contacts of the last state are being written.
        if self.progress != RunProgress::Over && states.last().is_some_and(is_half) {
            states.pop();
        }
        let frame = |state: &ListedFile| Frame {
            grains: state.name.clone(),
            contacts: of_contacts(state.time),
        };
        let frames = states.iter().map(frame).collect();
        let times = states.iter().map(|state| state.time).collect();
        Ok(ListedStates {
            frames,
            times,
            notes,
        })
    }

    fn listed(
        &self,
        name: &str,
        notes: &mut Vec<String>,
    ) -> Result<Vec<ListedFile>, RecordingError> {
        let list = self.files.read(name, LARGEST_LIST)?;
        notes.extend(list.note());
        listed_files(&list)
    }

    fn tables(&self) -> Tables<'_> {
        Tables {
            files: &self.files,
            is_over: self.progress == RunProgress::Over,
        }
    }

    /// Reads the samples; without them there are no plots.
    fn take_samples(&mut self) {
        match self.tables().samples() {
            Ok((series, notes)) => {
                self.notes.extend(notes);
                self.set_series(series);
            }
            Err(error) => self.notes.push(format!("There are no plots: {error}")),
        }
    }

    /// Reads what its run wrote at its end beside its samples; `first` is its first state.
    fn take_tables(&mut self, first: &World) {
        let mut notes = Vec::new();
        let flow = self.tables().flow(&mut notes);
        let steps = self.course.step_times();
        let meetings = self.tables().meetings(first, &steps, &mut notes);
        self.flow = flow.map(Arc::new);
        Arc::make_mut(&mut self.branch).meetings = Arc::new(meetings);
        self.notes.extend(notes);
    }

    /// The mean flow that its run wrote at its end; none where it wrote none.
    pub fn flow(&self) -> Option<&Arc<MeanFlow>> {
        self.flow.as_ref()
    }

    fn set_series(&mut self, series: Series) {
        Arc::make_mut(&mut self.branch).series = Arc::new(series);
    }

    /// Takes in what was changed on the way, and which step each state was taken after.
    /// `first` is its first state.
    fn take_commands(&mut self, first: &World) -> Result<(), RecordingError> {
        let summary = self.files.folder().join(SUMMARY);
        let refuse = |reason: String| RecordingError::of(&summary, reason);
        let commands = stamped(&self.record.commands).map_err(refuse)?;
        let parameters = live_parameters(&self.scene, first);
        let accepted = commands.into_iter().map(|stamped| {
            let command = accept(&parameters, first, &stamped.command)?;
            Ok(StampedCommand { command, ..stamped })
        });
        let accepted: Result<Vec<StampedCommand>, CommandError> = accepted.collect();
        let accepted = accepted.map_err(|error| refuse(format!("a change in it: {error}")))?;
        self.course.follow(accepted);
        self.parameters = parameters.into();
        let times: Vec<f64> = self.moments.iter().map(|moment| moment.time).collect();
        self.moments = self.moments_at(&times);
        if !follow_each_other(&self.moments) {
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

    /// The moments of states at these `times` [s].
    fn moments_at(&self, times: &[f64]) -> Arc<[Moment]> {
        let steps = self.course.step_times();
        let moment = |time: &f64| Moment {
            step: steps.step_at(*time),
            time: *time,
        };
        times.iter().map(moment).collect()
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
            progress: self.progress,
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

    /// Index of the state that is nearest to `step`.
    pub fn nearest(&self, step: u64) -> usize {
        nearest(&self.moments, step)
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

/// Whether each of `moments` is steps later than the one before it.
fn follow_each_other(moments: &[Moment]) -> bool {
    let mut pairs = moments.windows(2);
    pairs.all(|pair| pair[0].step < pair[1].step)
}
