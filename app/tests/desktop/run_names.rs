//! Claims about what runs are called: by what differs in them, or as a person named them.

use crate::timeline::carried_out;
use crate::window_of_panels::{
    Window, friction, prepared, press, put_beside, ready, set, standing, wet,
};
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
fn runs_that_differ_in_nothing_are_told_by_their_numbers() {
    let mut simulation = prepared();
    let again = [Command::Step(300), Command::Reset, Command::Step(100)];
    done(&mut simulation, again);
    assert_eq!(called(&simulation), ["run 2", "run 1"]);
    // Where others differ, the one that is shown is called by its value.
    put_beside(&mut simulation);
    let names = called(&simulation);
    assert_eq!(names[..2], ["μ 0.4", "μ 0.9"]);
    let numbered = |name: &String| name.starts_with("run ");
    assert!(
        !names[2..].is_empty() && names[2..].iter().all(numbered),
        "{names:?}"
    );
}

#[test]
fn a_run_in_which_nothing_was_changed_is_the_scene_unchanged_among_many_changes() {
    let mut simulation = prepared();
    let commands = [
        Command::Step(400),
        Command::Seek(100),
        set(friction(), 0.9),
        set(other_friction(), 0.7),
        set(Parameter::Gravity, 1.62),
        Command::Step(100),
    ];
    done(&mut simulation, commands);
    let names = called(&simulation);
    assert!(
        names[0].contains("0.9") && names[0].contains("1.62"),
        "{names:?}"
    );
    assert_eq!(names[1], "the scene unchanged");
}

#[test]
fn two_runs_side_by_side_are_called_by_what_they_differ_in() {
    let mut simulation = prepared();
    put_beside(&mut simulation);
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

/// Calls the run shown and the one that was left by `name`.
fn call_both(harness: &mut Harness<'_, Window>, [shown, left]: [&str; 2]) {
    let simulation = &mut harness.state_mut().simulation;
    let past = simulation.past();
    let runs = [(past.number, shown), (past.kept[0].number, left)];
    for (number, name) in runs {
        let (half, name) = (Half::Left, name.to_owned());
        simulation.send(LabCommand::NameBranch { half, number, name });
    }
    simulation.tick(Duration::from_millis(16));
    harness.run_steps(4);
}

#[test]
fn the_run_that_is_shown_is_named_above_the_timeline_and_is_read_in_every_window() {
    let alone = Window::of(prepared());
    assert!(
        alone
            .query_by_label_contains("Run on the timeline")
            .is_none()
    );
    let mut harness = with_a_run_left();
    let sizes = [
        [1440.0, 900.0],
        [1280.0, 800.0],
        [1024.0, 640.0],
        [700.0, 600.0],
    ];
    for size in sizes {
        harness.set_size(egui::Vec2::from(size));
        for given in [["μ 0.9 and steep", "short"], [LONG, "short"]] {
            call_both(&mut harness, given);
            harness.run_steps(8);
            let line = harness.get_by_role_and_label(Role::Slider, "Moment shown");
            let line = line.rect();
            assert!(
                line.width() > 150.0 && line.right() < size[0],
                "{size:?}: {line:?}"
            );
            let label = format!("Run on the timeline: {}", given[0]);
            let name = harness.get_by_label(&label).rect();
            assert!(name.bottom() < line.top(), "{size:?}: {name:?} {line:?}");
            let bar = harness.state().free;
            let is_within = name.left() >= bar.left() - 1.0 && name.right() <= bar.right() + 1.0;
            assert!(is_within, "{size:?}: {name:?} {bar:?}");
            let drawn = written(&harness, given[0]);
            if given[0] == LONG {
                let (head, tail) = drawn.split_once('…').unwrap_or((LONG, ""));
                assert!(LONG.starts_with(head) && LONG.ends_with(tail));
                // A dozen letters at either end tell names apart.
                assert!(head.chars().count() >= 12, "{size:?}: {drawn}");
            } else {
                assert_eq!(drawn, given[0], "{size:?}");
            }
        }
    }
}

/// What is written of the run called `name` above the timeline.
fn written(harness: &Harness<'_, Window>, name: &str) -> String {
    let label = format!("Run on the timeline: {name}");
    let place = harness.get_by_label(&label).rect();
    let mut shapes = harness.output().shapes.iter();
    let written = shapes.find_map(|clipped| match &clipped.shape {
        egui::Shape::Text(text) if place.expand(1.0).contains(text.pos) => {
            Some(text.galley.text().to_owned())
        }
        _ => None,
    });
    written.unwrap()
}

/// A name of as many letters as one may have.
const LONG: &str = "WWWWWWWWWW MMMMMMMMMM WWWWWWWWWW MMMMMMMMMM WWWWWWWWWW MMMMM";

#[test]
fn no_name_pushes_what_stands_beside_it_out_of_its_panel() {
    let mut harness = with_a_run_left();
    let names = [
        [LONG, "\u{1f468}\u{200d}\u{1f52c}\u{1f30a} wet sand"],
        ["שלום עולם", "\u{202e}turned\u{7}\nround"],
        ["Z\u{0301}\u{0317}\u{0310}\u{035c}algo", "表面の角度"],
    ];
    for size in [[1440.0, 900.0], [1024.0, 640.0]] {
        harness.set_size(egui::Vec2::from(size));
        for given in names {
            call_both(&mut harness, given);
            harness.state_mut().show_panel("Changes and runs");
            harness.run_steps(30);
            let of = |harness: &Harness<'_, Window>| called(&harness.state().simulation);
            let free = harness.state().free;
            for name in of(&harness) {
                let kept = ["Rename", "Show", "Forget"].map(|verb| format!("{verb} {name}"));
                let found = kept
                    .iter()
                    .filter_map(|label| harness.query_by_label(label));
                let rects: Vec<egui::Rect> = found.map(|node| node.rect()).collect();
                assert!(!rects.is_empty(), "{name:?}");
                let text = harness.get_all_by_label(&name).map(|node| node.rect());
                let text = text.min_by(|a, b| a.left().total_cmp(&b.left())).unwrap();
                let beside = rects[0].y_range().contains(text.center().y);
                assert!(
                    beside && text.right() < rects[0].left(),
                    "{name:?} {text:?} {rects:?}"
                );
                for rect in rects {
                    assert!(rect.right() < free.left(), "{name:?} {rect:?} {free:?}");
                }
            }
        }
    }
    assert_eq!(called(&harness.state().simulation)[1], "表面の角度");
}

#[test]
fn a_name_is_changed_by_keys_alone_and_an_automatic_one_stays_automatic() {
    let mut harness = with_a_run_left();
    press(&mut harness, "Rename μ 0.4");
    let field = harness.get_by_role_and_label(Role::TextInput, "Name of the run");
    assert!(field.is_focused());
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert!(harness.state().asked.is_empty(), "it was not changed");
    let pencil = harness.get_by_label("Rename μ 0.4");
    assert!(pencil.is_focused(), "from where it goes on");
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    // All of it is selected: what is typed takes its place.
    harness.event(egui::Event::Text("steep".into()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    let asked = &harness.state().asked;
    assert!(
        matches!(&asked[..], [Request::NameRun { name, .. }] if name == "steep"),
        "{asked:?}"
    );
    harness.state_mut().asked.clear();
    press(&mut harness, "Rename μ 0.4");
    harness.event(egui::Event::Text("x".repeat(200)));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    let asked = &harness.state().asked;
    assert!(
        matches!(&asked[..], [Request::NameRun { name, .. }] if name.len() <= 60),
        "{asked:?}"
    );
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
    put_beside(&mut again);
    let (half, number) = (Half::Right, again.half(Half::Right).past().number);
    let name = "the right one".to_owned();
    again.send(LabCommand::NameBranch { half, number, name });
    done(&mut again, [Command::Step(200)]);
    again.send(LabCommand::EndComparison { keep: Half::Left });
    done(&mut again, [Command::Step(10)]);
    let names = called(&again);
    assert!(names.contains(&"the right one".to_owned()), "{names:?}");
}
