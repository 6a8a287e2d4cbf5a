//! One run of a lab as panels and views see it: the newest state, what was changed and measured,
//! what is asked for.
//!
//! In: the engine's news. Out: borrowed states, samples and commands; they are shared with the
//! engine, so they may only be read. Changing a run goes by way of [`super::Lab::send`].

use super::update::{RecordedFlow, RunNews};
use crate::measure::{
    Avalanche, FlowHistory, LEFT_OUT, MeanFlow, Measure, Sample, Series, avalanches,
};
use crate::run::{
    Branch, Command, Event, KeptMemory, Meeting, Parameter, ParameterInfo, Past, Sampling,
    StampedCommand, StepTimes, Turned, Value, events, time_step,
};
use crate::scene::Scene;
use crate::solver::{Extremes, Fault, Profile, TimeStepAdvice, advise};
use crate::world::World;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub use crate::measure::SMALLEST_DROP;

/// One run of a lab as the outside sees it.
pub struct RunView {
    id: u64,
    scene: Arc<Scene>,
    extremes: Extremes,
    /// The step with which the run begins [s].
    first_step: f64,
    advice: TimeStepAdvice,
    /// What the engine has told last; nothing while the run is prepared.
    news: Option<RunNews>,
    /// What was changed and measured; empty while the run is prepared.
    branch: Arc<Branch>,
    past: Past,
    profile: Profile,
    findings: Findings,
    warnings: Vec<String>,
    /// Values asked for and not yet carried out.
    asked: BTreeMap<Parameter, Value>,
    /// The step asked for and not yet reached.
    sought: Option<u64>,
    generation: u64,
    revision: u64,
}

impl RunView {
    /// A run of `scene` of which nothing is known yet.
    pub(super) fn new(scene: Arc<Scene>, advice: TimeStepAdvice) -> Self {
        Self {
            id: next_number(),
            extremes: Extremes::of(&scene),
            scene,
            first_step: advice.time_step,
            warnings: advice.warning.iter().cloned().collect(),
            advice,
            news: None,
            branch: Arc::default(),
            past: Past::default(),
            profile: Profile::default(),
            findings: Findings::default(),
            asked: BTreeMap::new(),
            sought: None,
            generation: 0,
            revision: 0,
        }
    }

    /// Another run of the same scene of which nothing is known yet.
    pub(super) fn sibling(&self) -> Self {
        Self::new(self.scene.clone(), advise(&self.scene))
    }

    /// What was asked for.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The newest state; none while the run is prepared.
    pub fn world(&self) -> Option<&Arc<World>> {
        self.news.as_ref().map(|news| &news.world)
    }

    /// The state with which it began; of a recording, the first that can be read.
    pub fn start(&self) -> Option<&Arc<World>> {
        self.news.as_ref().map(|news| &news.start)
    }

    /// How far each sphere of that state has turned since time zero; none of polyhedra.
    pub fn orientations(&self) -> Option<&Turned> {
        self.news.as_ref()?.turned.as_ref()
    }

    /// What tells it from every other run that was ever shown.
    pub fn id(&self) -> u64 {
        self.id
    }

    /// Changes whenever [`RunView::world`] is another state, and is that of no other run.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// Which samples were taken until the state shown, and what the next one depends on.
    pub fn sampling(&self) -> Sampling {
        (self.news.as_ref()).map_or_else(Sampling::default, |news| news.sampling)
    }

    /// The samples of the present branch so far; those after the state shown too.
    pub fn series(&self) -> &Series {
        &self.branch.series
    }

    /// The last sample at or before the state shown.
    pub fn sample(&self) -> Option<Sample> {
        let step = self.world()?.clock.step;
        let steps = self.series().steps();
        let samples = steps.partition_point(|&sampled| sampled <= step);
        let known = (samples.checked_sub(1)).and_then(|index| self.series().get(index));
        let latest = self.news.as_ref()?.latest;
        let latest = latest.filter(|sample| sample.step <= step);
        known.into_iter().chain(latest).max_by_key(|s| s.step)
    }

    /// The flowing layer so far.
    pub fn flow(&self) -> &FlowHistory {
        &self.branch.flow
    }

    /// The mean flow over depth of the part of the run that results count, empty where the bed did
    /// not flow; of a recording what its run wrote, or what was measured on its states when that was
    /// asked for.
    pub fn mean_flow(&self) -> Arc<MeanFlow> {
        self.recorded_flow().map_or_else(
            || Arc::new(self.branch.flow.mean_since(LEFT_OUT * self.past.end.time)),
            |recorded| recorded.mean.clone(),
        )
    }

    /// The mean flow of a recording, where there is one.
    pub fn recorded_flow(&self) -> Option<&RecordedFlow> {
        self.news.as_ref()?.flow.as_ref()
    }

    /// The avalanches so far, of [`SMALLEST_DROP`] at least.
    pub fn avalanches(&self) -> &[Avalanche] {
        &self.findings.avalanches
    }

    /// What happened in the present branch so far, in order of time; what comes after the state
    /// shown too.
    pub fn events(&self) -> &[Event] {
        &self.findings.events
    }

    /// Changes whenever [`RunView::events`] is another list.
    pub fn events_revision(&self) -> u64 {
        self.findings.revision
    }

    /// Contacts and bridges of few grains that began and ended in the present branch.
    pub fn meetings(&self) -> &[Meeting] {
        &self.branch.meetings
    }

    /// The commands carried out in the present branch since time zero; those after the state shown
    /// too.
    pub fn commands(&self) -> &[StampedCommand] {
        self.branch.history.commands()
    }

    /// Index of the first command of each change: a drag or a button may take several.
    pub fn changes(&self) -> &[usize] {
        self.branch.history.changes()
    }

    /// The commands of each change, in order.
    pub fn each_change(&self) -> impl Iterator<Item = &[StampedCommand]> {
        self.branch.history.each_change()
    }

    /// Changes whenever [`RunView::commands`] is another list.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// What lies behind and ahead of the state shown.
    pub fn past(&self) -> &Past {
        &self.past
    }

    /// What the run keeps in memory by design, as of the last second: samples, states …
    pub fn kept_memory(&self) -> KeptMemory {
        (self.news.as_ref()).map_or_else(KeptMemory::default, |news| news.memory)
    }

    /// The step that is shown, or the one that was asked for and is still on its way.
    pub fn step(&self) -> u64 {
        let shown = || self.world().map_or(0, |world| world.clock.step);
        self.sought.unwrap_or_else(shown)
    }

    /// The step that was come to: of a recording it may lie between that of the state shown and the
    /// next one.
    pub fn reached(&self) -> u64 {
        self.news.as_ref().map_or(0, |news| news.reached)
    }

    /// Whether the state shown is not the newest of the present branch.
    pub fn looks_back(&self) -> bool {
        self.step() < self.past.end.step
    }

    /// The parameters that can change while it goes on; none while the run is prepared.
    pub fn parameters(&self) -> &[ParameterInfo] {
        self.news.as_ref().map_or(&[], |news| &news.parameters)
    }

    /// Present value of `parameter`, or the value asked for where that is still to be carried out;
    /// none while the run is prepared, and where the scene has no such parameter.
    pub fn value(&self, parameter: &Parameter) -> Option<Value> {
        let asked = self.asked.get(parameter).copied();
        asked.or_else(|| parameter.read(self.world()?))
    }

    /// Its live parameters whose present values are others than the scene's, with these.
    pub fn changed_values(&self) -> Vec<(Parameter, Value)> {
        let away = self.parameters().iter().filter_map(|info| {
            let value = self.value(&info.parameter)?;
            (value != info.default).then(|| (info.parameter.clone(), value))
        });
        away.collect()
    }

    /// What stopped it, if something did.
    pub fn fault(&self) -> Option<&Fault> {
        self.news.as_ref()?.fault.as_ref()
    }

    /// Where the solver's time went lately.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The time step of the state shown and the limits that this state sets; before there is one,
    /// what the scene says.
    pub fn advice(&self) -> &TimeStepAdvice {
        &self.advice
    }

    /// Which step of the present branch is when; nothing before there is a run.
    pub fn step_times(&self) -> Option<StepTimes> {
        self.world()?;
        Some(StepTimes::new(self.first_step, self.commands()))
    }

    /// What there is to know of `parameter`, be it a live parameter or the time step.
    pub fn info_of(&self, parameter: &Parameter) -> Option<ParameterInfo> {
        if *parameter == Parameter::TimeStep {
            return Some(time_step(self.first_step));
        }
        let mut live = self.parameters().iter();
        live.find(|info| info.parameter == *parameter).cloned()
    }

    /// What people should know, in sentences: refused commands, a bed that could not be kept …
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    pub(super) fn warn(&mut self, warnings: Vec<String>) {
        self.warnings.extend(warnings);
    }

    /// Shows what `command` asks for until it is carried out.
    pub(super) fn expect(&mut self, command: &Command) {
        match command {
            Command::Set { parameter, value } => {
                self.asked.insert(parameter.clone(), *value);
            }
            Command::Seek(step) => self.sought = Some(*step),
            _ => {}
        }
    }

    /// Shows the values that there are: what was asked for is carried out or refused.
    pub(super) fn forget_asked(&mut self) {
        self.asked.clear();
    }

    /// Shows the step there is: the one that was asked for is reached, or given up.
    pub(super) fn forget_sought(&mut self) {
        self.sought = None;
    }

    /// Takes in the `advice` of another state; a step that has come to exceed its limit is told.
    fn heed(&mut self, advice: TimeStepAdvice) {
        if self.advice.warning.is_none() {
            self.warnings.extend(advice.warning.clone());
        }
        self.advice = advice;
    }

    /// Looks through what was measured, where that was put off: the run may hold by now.
    pub(super) fn catch_up(&mut self) {
        self.findings.follow(&self.branch);
    }

    /// Takes in what is new of it.
    pub(super) fn take(&mut self, mut news: RunNews) {
        let is_other = |known: &RunNews| !Arc::ptr_eq(&known.world, &news.world);
        if self.news.as_ref().is_none_or(is_other) {
            self.generation = next_number();
            self.heed(self.extremes.advise(&news.world));
        }
        let count = |branch: &Branch| (branch.number, branch.history.commands().len());
        if count(&self.branch) != count(&news.branch) || self.past.names != news.past.names {
            self.revision = next_number();
        }
        if self.branch.number != news.branch.number {
            self.findings = Findings::default();
        }
        self.branch = news.branch.clone();
        self.findings.follow(&self.branch);
        self.past = std::mem::take(&mut news.past);
        self.profile = std::mem::take(&mut news.profile);
        self.news = Some(news);
    }
}

/// A number that nobody else has, never zero.
fn next_number() -> u64 {
    static NUMBERS: AtomicU64 = AtomicU64::new(1);
    NUMBERS.fetch_add(1, Ordering::Relaxed)
}

/// What was found in a branch that grows.
#[derive(Default)]
struct Findings {
    avalanches: Vec<Avalanche>,
    events: Vec<Event>,
    revision: u64,
    /// Samples, meetings and commands that were looked through.
    seen: [usize; 3],
    due: Option<Instant>,
}

impl Findings {
    /// Looks through `branch` again where it has grown, spending a twentieth of the time at most.
    fn follow(&mut self, branch: &Branch) {
        let (started, series) = (Instant::now(), &branch.series);
        let commands = branch.history.commands().len();
        let seen = [series.len(), branch.meetings.len(), commands];
        if seen == self.seen || self.due.is_some_and(|due| due > started) {
            return;
        }
        let angle = series.column(Measure::SurfaceAngle);
        self.avalanches = avalanches(series.time(), angle, SMALLEST_DROP);
        let changes = branch.history.each_change();
        let found = events(series, &self.avalanches, &branch.meetings, changes);
        if found != self.events {
            self.events = found;
            self.revision = next_number();
        }
        self.seen = seen;
        self.due = Some(started + 20 * started.elapsed());
    }
}
