//! Claims about what runs are called: by what differs in them, or as a person named them.

use crate::timeline::carried_out;
use crate::window_of_panels::{Window, friction, prepared, press, ready, set, standing, wet};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::lab::{Half, LabCommand};
use grainfall::measure::numeral::moment;
use grainfall::physics::LIQUID_CASES;
use grainfall::run::{Command, Parameter, Session};
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Request, RunNames};
use std::time::Duration;

fn other_friction() -> Parameter {
    Parameter::Friction("glass".into(), "drum".into())
}

fn done(simulation: &mut Simulation, commands: impl IntoIterator<Item = Command>) {
    commands
        .into_iter()
        .for_each(|command| carried_out(simulation, command));
}

/// What the runs are called: those shown, then those that were left.
fn called(simulation: &Simulation) -> Vec<String> {
    let names = RunNames::of(simulation);
    let is_pair = simulation.comparison().is_some();
    let shown = Half::ALL.into_iter().take(1 + usize::from(is_pair));
    let shown = shown.map(|half| names.present(half).to_owned());
    let kept = names.kept.iter().map(|(name, _)| name.clone());
    shown.chain(kept).collect()
}

/// A moment in words, `steps` from the start.
fn at(simulation: &Simulation, steps: f64) -> String {
    moment(steps * simulation.world().unwrap().clock.time_step)
}

#[test]
fn runs_are_called_by_the_value_that_differs_and_from_when_on() {
    let mut simulation = prepared();
    assert_eq!(called(&simulation), ["this run"]);
    let first = [
        Command::Step(1000),
        set(friction(), 0.25),
        Command::Step(1000),
    ];
    done(&mut simulation, first);
    done(
        &mut simulation,
        [Command::Seek(500), set(friction(), 0.9), Command::Step(100)],
    );
    let (early, late) = (at(&simulation, 500.0), at(&simulation, 1000.0));
    let expected = [format!("μ 0.9 from {early}"), format!("μ 0.25 from {late}")];
    assert_eq!(called(&simulation), expected);
    // A start with the present values: from the start on.
    done(&mut simulation, [Command::Reset, Command::Step(300)]);
    assert_eq!(called(&simulation)[0], "μ 0.9");
    // Two frictions differ: each is told by its materials.
    done(
        &mut simulation,
        [
            Command::Seek(0),
            set(other_friction(), 0.7),
            Command::Step(300),
        ],
    );
    assert_eq!(
        called(&simulation)[0],
        "μ glass – drum 0.7, μ glass – glass 0.9"
    );
    let names = called(&simulation);
    for (index, name) in names.iter().enumerate() {
        assert_eq!(names.iter().position(|other| other == name), Some(index));
        assert!(!name.contains("run "), "{names:?}");
    }
}

#[test]
fn a_value_that_came_back_tells_its_way() {
    let mut simulation = prepared();
    done(
        &mut simulation,
        [
            Command::Step(1000),
            set(friction(), 0.9),
            Command::Step(100),
            set(friction(), 0.4),
            Command::Step(100),
            Command::Seek(500),
            set(friction(), 0.8),
            Command::Step(600),
            set(friction(), 0.4),
            Command::Step(100),
        ],
    );
    // Both came to 0.4 at the same moment.
    let [half, whole, end] = [500.0, 1000.0, 1100.0].map(|steps| at(&simulation, steps));
    assert_eq!(
        called(&simulation),
        [
            format!("μ 0.4, 0.8 from {half}, 0.4 from {end}"),
            format!("μ 0.4, 0.9 from {whole}, 0.4 from {end}"),
        ]
    );
}

#[test]
fn liquids_of_the_paper_are_called_by_their_names() {
    let mut simulation = wet();
    done(&mut simulation, [Command::Step(200)]);
    let glycerol = LIQUID_CASES[6].liquid();
    let values = [
        (Parameter::Viscosity, glycerol.viscosity),
        (Parameter::SurfaceTension, glycerol.surface_tension),
        (Parameter::ContactAngle, glycerol.contact_angle),
    ];
    done(&mut simulation, [Command::Seek(100)]);
    for (parameter, value) in values {
        done(&mut simulation, [set(parameter, value)]);
    }
    done(&mut simulation, [Command::Step(200)]);
    let from = at(&simulation, 100.0);
    let expected = [format!("glycerol from {from}"), "93 % glycerol".to_owned()];
    assert_eq!(called(&simulation), expected);
}

#[test]
fn two_runs_side_by_side_are_called_by_what_they_differ_in() {
    let mut simulation = prepared();
    simulation.send(LabCommand::Compare {
        parameter: friction(),
        value: 0.9.into(),
    });
    while simulation.comparison().is_none() {
        simulation.tick(Duration::from_millis(16));
    }
    done(&mut simulation, [Command::Step(200)]);
    assert_eq!(called(&simulation), ["μ 0.4", "μ 0.9"]);
}

/// A window with a run that was left at 2000 steps.
fn with_a_run_left() -> Harness<'static, Window> {
    let mut simulation = prepared();
    let commands = [
        Command::Step(2000),
        Command::Seek(500),
        set(friction(), 0.9),
        Command::Step(10),
    ];
    done(&mut simulation, commands);
    Window::of(simulation)
}

/// Types `text` in the place of the name of the run that is called `name`.
fn rename(harness: &mut Harness<'_, Window>, name: &str, text: &str) -> Vec<Request> {
    harness.state_mut().asked.clear();
    press(harness, &format!("Rename {name}"));
    harness.get_by_role_and_label(Role::TextInput, "Name of the run");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    if text.is_empty() {
        harness.key_press(Key::Backspace);
    } else {
        harness.event(egui::Event::Text(text.to_owned()));
    }
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
    std::mem::take(&mut harness.state_mut().asked)
}

#[test]
fn a_person_calls_a_run_something_else_and_back() {
    let mut harness = with_a_run_left();
    let kept = harness.state().simulation.past().kept[0].number;
    let asked = rename(&mut harness, "μ 0.4", "the slippery one");
    let expected = Request::NameRun {
        half: Half::Left,
        number: kept,
        name: "the slippery one".into(),
    };
    assert_eq!(asked, [expected]);
    let give = |harness: &mut Harness<'_, Window>, name: &str| {
        let simulation = &mut harness.state_mut().simulation;
        simulation.send(LabCommand::NameBranch {
            half: Half::Left,
            number: kept,
            name: name.into(),
        });
        simulation.tick(Duration::from_millis(16));
        harness.run_steps(3);
    };
    give(&mut harness, "the slippery one");
    harness.get_by_label("Show the slippery one");
    // Esc leaves it as it is.
    press(&mut harness, "Rename the slippery one");
    harness.event(egui::Event::Text("nothing".into()));
    harness.run_steps(2);
    harness.key_press(Key::Escape);
    harness.run_steps(3);
    assert!(harness.state().asked.is_empty());
    let asked = rename(&mut harness, "the slippery one", "");
    assert!(matches!(&asked[..], [Request::NameRun { name, .. }] if name.is_empty()));
    give(&mut harness, "");
    harness.get_by_label("Show μ 0.4");
}

#[test]
fn names_are_kept_in_a_session_and_with_the_runs_of_a_comparison() {
    let mut harness = with_a_run_left();
    let simulation = &mut harness.state_mut().simulation;
    let present = simulation.past().number;
    let kept = simulation.past().kept[0].number;
    for (number, name) in [(present, "steep"), (kept, "flat")] {
        let (half, name) = (Half::Left, name.to_owned());
        simulation.send(LabCommand::NameBranch { half, number, name });
    }
    carried_out(simulation, Command::Step(10));
    assert_eq!(called(simulation), ["steep", "flat"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("named.grainfall");
    simulation.send(LabCommand::Save {
        path: path.clone(),
        look: String::new(),
    });
    while simulation.is_saving() {
        simulation.tick(Duration::from_millis(16));
    }
    let session = Session::read(&path).unwrap();
    let mut again = ready(Simulation::resume(session, standing()));
    assert_eq!(called(&again), ["steep", "flat"]);
    // What begins from a named run is another.
    let commands = [Command::Seek(100), set(friction(), 0.2), Command::Step(10)];
    done(&mut again, commands);
    let names = called(&again);
    assert!(names[0].starts_with("μ 0.2 from "), "{names:?}");
    assert!(names.contains(&"steep".to_owned()) && names.contains(&"flat".to_owned()));
    again.send(LabCommand::Compare {
        parameter: friction(),
        value: 0.9.into(),
    });
    while again.comparison().is_none() {
        again.tick(Duration::from_millis(16));
    }
    let (half, number) = (Half::Right, again.half(Half::Right).past().number);
    let name = "the right one".to_owned();
    again.send(LabCommand::NameBranch { half, number, name });
    done(&mut again, [Command::Step(200)]);
    again.send(LabCommand::EndComparison { keep: Half::Left });
    done(&mut again, [Command::Step(10)]);
    let names = called(&again);
    assert!(names.contains(&"the right one".to_owned()), "{names:?}");
}
