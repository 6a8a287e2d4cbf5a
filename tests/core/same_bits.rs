//! One state, by every way to it: threads, lanes, pieces, files, branches, windows' engines. Each
//! way is a row of a table, and every row of a scene states the same hash.
//!
//! Rows are told as `tests/common/hash_table.rs` says.

use crate::hash_table::note;
use crate::runs::{prepared, set};
use crate::timeline::{Explored, arrive, change, column_lab, go_on, hash, wet_lab};
use grainfall::lab::{DriverKind, Half, Lab, LabCommand, Options, Status};
use grainfall::run::{
    Checkpoint, Command, Parameter, Run, RunRecord, Script, ScriptedCommand, Session, Timeline,
};
use grainfall::runner::{self, Job, Verdict};
use grainfall::solver::{Processor, Solver};
use std::cell::Cell;
use std::time::Duration;

/// Memory for all states that could be wanted [bytes].
const PLENTY: usize = 1 << 28;
/// The place whose state every way comes to, and the last one at which something is changed.
const END: u64 = 8;
const LAST_CHANGE: u64 = 7;

/// What is to be come to, and how.
struct Goal {
    name: &'static str,
    lab: Explored,
    /// A run that was changed on the way there.
    timeline: Timeline,
    hash: String,
    step: u64,
}

impl Goal {
    fn of(name: &'static str, lab: Explored) -> Self {
        let (timeline, _) = lab.recorded_to(END, PLENTY);
        let (hash, step) = (hash(&timeline).to_string(), lab.unit * END);
        Self {
            name,
            lab,
            timeline,
            hash,
            step,
        }
    }

    /// A row of the table, whose hash is that of all others.
    #[track_caller]
    fn row(&self, way: &str, found: impl ToString) {
        note(self.name, way, found.to_string());
        assert_eq!(found.to_string(), self.hash, "{}, {way}", self.name);
    }

    /// What was changed on the way.
    fn script(&self) -> Vec<ScriptedCommand> {
        let commands = self.timeline.run().commands().iter();
        let scripted = commands.map(|stamped| ScriptedCommand {
            step: Some(stamped.step),
            time: None,
            command: stamped.command.clone(),
        });
        scripted.collect()
    }

    /// A run with these changes before it, at time zero.
    fn run(&self, threads: usize) -> Run {
        let mut run = prepared(&self.lab.scene, threads, self.lab.beds.clone()).0;
        let script = Script::new(&self.script(), &run.world().clock).unwrap();
        run.replay(script).unwrap();
        run
    }

    fn by_threads_and_pieces(&self) {
        for threads in [1, 3, 8] {
            let mut run = self.run(threads);
            run.advance_to(self.step).unwrap();
            self.row(&format!("threads: {threads}"), run.world().hash());
        }
        let mut run = self.run(2);
        while run.world().clock.step < self.step {
            let next = run.world().clock.step + 7;
            run.advance_to(next.min(self.step)).unwrap();
        }
        self.row("in pieces of 7 steps", run.world().hash());
    }

    fn by_lanes(&self) {
        let mut run = self.run(1);
        run.advance_to(self.lab.unit * LAST_CHANGE).unwrap();
        for processor in Processor::all() {
            let mut world = run.world().clone();
            let steps = self.step - world.clock.step;
            Solver::on(processor, 1).advance(&mut world, steps).unwrap();
            self.row(&format!("lanes: {processor}"), world.hash());
        }
    }

    fn by_checkpoint(&self) {
        let mut run = self.run(1);
        run.advance_to(self.step / 2).unwrap();
        let bytes = postcard::to_stdvec(&run.checkpoint()).unwrap();
        let checkpoint: Checkpoint = postcard::from_bytes(&bytes).unwrap();
        let mut run = self.run(3);
        run.resume(checkpoint);
        run.advance_to(self.step).unwrap();
        self.row("from a checkpoint half-way", run.world().hash());
    }

    fn by_files(&self) {
        let folder = tempfile::tempdir().unwrap();
        let mut scene = self.lab.scene.clone();
        scene.duration = self.timeline.run().world().time();
        let job = |name: &str| Job {
            script: self.script(),
            beds: self.lab.beds.clone(),
            checkpoints: true,
            ..Job::new("run", scene.clone(), folder.path().join(name))
        };
        let (_, whole) = runner::run(&job("whole"), &mut (), &|| false).unwrap();
        let state = |run: &runner::DirectRun| run.run().unwrap().world().hash();
        self.row("to files, without a window", state(&whole));
        let looks = Cell::new(0);
        let soon = || looks.replace(looks.get() + 1) > 3;
        let (stopped, _) = runner::run(&job("parts"), &mut (), &soon).unwrap();
        assert_eq!(stopped.ending.status(), "interrupted");
        let (_, parts) = runner::run(&job("parts"), &mut (), &|| false).unwrap();
        self.row("to files, stopped and gone on with", state(&parts));
        let record = RunRecord::read(&folder.path().join("whole/summary.json")).unwrap();
        let verdict = record.verify(2, self.lab.beds.clone(), &mut (), &|| false);
        assert_eq!(verdict.unwrap(), Verdict::Same);
        self.row("verified", record.state_hash.unwrap());
    }

    /// Seeks, undoes, branches, saves and opens; last, as that changes the timeline.
    fn by_history(mut self) {
        let end = self.step;
        let to = |timeline: &mut Timeline, step: u64| {
            timeline.seek(step);
            arrive(timeline);
        };
        let timeline = &mut self.timeline;
        to(timeline, end / 3);
        to(timeline, end);
        let scrubbed = hash(timeline);
        timeline.undo();
        arrive(timeline);
        timeline.redo();
        arrive(timeline);
        to(timeline, end);
        let redone = hash(timeline);
        to(timeline, end / 4);
        change(timeline, set(Parameter::Gravity, 4.0));
        go_on(timeline, end / 2);
        assert_ne!(hash(timeline).to_string(), self.hash);
        timeline.take_up(0);
        arrive(timeline);
        to(timeline, end);
        let taken_up = hash(timeline);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.grainfall");
        to(timeline, end / 2);
        Session::of(self.name, timeline).write(&path).unwrap();
        let mut opened = Session::read(&path).unwrap().into_timeline(2, 0);
        to(&mut opened, end);
        self.row("scrubbed back and forth", scrubbed);
        self.row("undone and redone", redone);
        self.row("a branch left and taken up again", taken_up);
        self.row("from a session saved half-way", hash(&opened));
    }

    /// As the window has it: a lab whose solver is on a thread of its own, or the caller's.
    fn by_lab(&self, driver: DriverKind, way: &str) {
        let options = Options {
            driver,
            threads: 2,
            autoplay: false,
            speed: f64::INFINITY,
            beds: self.lab.beds.clone(),
            shows_settling: false,
            script: self.script(),
            memory: PLENTY,
        };
        let mut lab = Lab::open(self.lab.scene.clone(), options);
        let rests = |lab: &Lab| lab.has_answered() && *lab.status() == Status::Paused;
        until(&mut lab, rests);
        lab.send(Command::Step(self.step));
        until(&mut lab, rests);
        self.row(way, lab.world().unwrap().hash());
        self.side_by_side(lab);
    }

    /// Two runs side by side from the beginning on, each as it would be alone.
    fn side_by_side(&self, mut lab: Lab) {
        let steps = 3 * self.lab.unit;
        let (parameter, value) = (Parameter::Gravity, 9.0.into());
        let kept: Vec<Command> = (lab.commands().iter())
            .map(|own| own.command.clone())
            .collect();
        lab.send(LabCommand::Compare { parameter, value });
        until(&mut lab, |lab| {
            lab.comparison().is_some() && *lab.status() == Status::Paused
        });
        lab.send(Command::Step(steps));
        until(&mut lab, |lab| {
            lab.world().is_some_and(|world| world.clock.step == steps)
        });
        for (half, way) in [(Half::Left, "left of two"), (Half::Right, "right of two")] {
            let mut alone = prepared(&self.lab.scene, 1, self.lab.beds.clone()).0;
            let gravity = (half == Half::Right).then(|| set(Parameter::Gravity, 9.0));
            for command in kept.iter().cloned().chain(gravity) {
                alone.apply(command).unwrap();
            }
            alone.advance_to(steps).unwrap();
            let shown = lab.half(half).world().unwrap().hash();
            note(self.name, way, shown);
            assert_eq!(shown, alone.world().hash(), "{}, {way}", self.name);
        }
    }
}

/// Ticks until it is `done`.
fn until(lab: &mut Lab, done: impl Fn(&Lab) -> bool) {
    for _ in 0..60_000 {
        lab.tick(Duration::from_millis(16));
        if done(lab) {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("still {:?} after a minute", lab.status());
}

fn every_way(name: &'static str, lab: Explored) {
    let goal = Goal::of(name, lab);
    goal.row("changed by hand", goal.hash.clone());
    goal.by_threads_and_pieces();
    goal.by_lanes();
    goal.by_checkpoint();
    goal.by_files();
    goal.by_lab(DriverKind::Inline, "in a lab on the caller's thread");
    goal.by_lab(
        DriverKind::Thread,
        "in a lab on a thread of its own, as shown",
    );
    goal.by_history();
}

#[test]
fn wet_drum_that_is_changed_comes_to_the_same_bits_by_every_way() {
    every_way("small drum, wet, changed thrice", wet_lab());
}

#[test]
fn column_that_is_changed_comes_to_the_same_bits_by_every_way() {
    every_way("small column, polyhedra, changed thrice", column_lab());
}
