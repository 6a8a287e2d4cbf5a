//! A whole lesson in the app as a whole: played, changed, scrubbed, branched, taken back, compared,
//! saved and verified, and at each moment the grain is drawn where the solver says.

use crate::comparison::{ask, falling_from_the_front, place};
use crate::view::{photographed, studio};
use crate::windowless::simulation;
use bevy::prelude::*;
use grainfall::lab::Half;
use grainfall::run::{BedStore, Command, Parameter, RunRecord};
use grainfall::runner::Verdict;
use grainfall::world::StateHash;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Request, Requests};
use std::time::Duration;

fn command(app: &mut App, command: Command, done: impl Fn(&Simulation) -> bool) {
    ask(app, Request::Command(command), done);
}

fn at_gravity(value: f64) -> Command {
    let parameter = Parameter::Gravity;
    let value = value.into();
    Command::Set { parameter, value }
}

fn hash(app: &App) -> StateHash {
    simulation(app).world().unwrap().hash()
}

/// Takes a picture and checks where the grain is drawn in each half.
fn look(app: &mut App, moment: &str) {
    let picture = photographed(app, &format!("lesson-{moment}"));
    let is_pair = simulation(app).comparison().is_some();
    for half in Half::ALL.into_iter().take(if is_pair { 2 } else { 1 }) {
        let at = if is_pair {
            place(app, &picture, half)
        } else {
            let centre = simulation(app).world().unwrap().grains.position[0].as_vec3();
            picture.camera.project(centre).unwrap().0
        };
        assert!(picture.covered(at), "{moment}, {half:?}: {at}");
    }
}

#[test]
fn a_lesson_from_play_to_verify() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut app = falling_from_the_front();
    let steps = |time: f64| simulation(&app).world().unwrap().clock.step_at(time);
    let [early, late, later] = [0.02, 0.04, 0.06].map(steps);
    look(&mut app, "start");

    // Played, until somebody presses pause.
    let play = Request::Command(Command::Play);
    app.world_mut().resource_mut::<Requests>().ask(play);
    while simulation(&app).step() < early {
        app.update();
        std::thread::sleep(Duration::from_millis(1));
    }
    command(&mut app, Command::Pause, |_| true);
    command(&mut app, Command::Seek(early), |s| s.step() == early);
    let seen = hash(&app);
    look(&mut app, "played");

    // Changed at the newest moment, then looked at again from before.
    let newest = simulation(&app).past().end.step;
    command(&mut app, Command::Seek(newest), |s| s.step() == newest);
    command(&mut app, at_gravity(4.0), |s| s.commands().len() == 1);
    let rest = later.max(newest + 1) - newest;
    command(&mut app, Command::Step(rest), |s| s.step() == newest + rest);
    let changed = hash(&app);
    look(&mut app, "changed");
    command(&mut app, Command::Seek(early), |s| s.step() == early);
    assert_eq!(hash(&app), seen);

    // Another run from there, beside the one that is left.
    command(&mut app, at_gravity(15.0), |s| s.commands().len() == 1);
    command(&mut app, Command::Step(late - early), |s| s.step() == late);
    assert_eq!(simulation(&app).past().kept.len(), 1);
    let branched = hash(&app);
    look(&mut app, "branched");
    command(&mut app, Command::Undo, |s| s.step() == early);
    assert_eq!(hash(&app), seen);
    command(&mut app, Command::Redo, |s| s.step() == late);
    assert_eq!(hash(&app), branched);
    command(&mut app, Command::Return(0), |s| s.step() == newest + rest);
    assert_eq!(hash(&app), changed);

    side_by_side(&mut app, early);
    saved_and_verified(&mut app);
}

/// Two side by side; a change of both is taken back in both.
fn side_by_side(app: &mut App, early: u64) {
    let stands = |s: &Simulation| s.comparison().is_some();
    let compare = Request::StartComparison(Parameter::Gravity, 0.0.into());
    ask(app, compare, stands);
    command(app, Command::Step(early), |s| s.step() == early);
    look(app, "side by side");
    let both = |app: &App| Half::ALL.map(|half| simulation(app).half(half).world().unwrap().hash());
    let before = both(app);
    command(app, at_gravity(20.0), |s| s.undo_and_redo()[0].is_some());
    command(app, Command::Step(early), |s| s.step() == 2 * early);
    look(app, "changed side by side");
    command(app, Command::Undo, |s| s.step() == early);
    assert_eq!(both(app), before);
    ask(app, Request::EndComparison(Half::Left), |s| {
        s.comparison().is_none()
    });
    look(app, "alone again");
}

/// In a file, which is then computed from the beginning.
fn saved_and_verified(app: &mut App) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lesson.grainfall");
    ask(app, Request::SaveSession(path.clone()), |s| !s.is_saving());
    let record = RunRecord::read(&path).unwrap();
    assert_eq!(record.state_hash, Some(hash(app).to_string()));
    let verdict = record
        .verify(1, BedStore::none(), &mut (), &|| false)
        .unwrap();
    assert_eq!(verdict, Verdict::Same);
}
