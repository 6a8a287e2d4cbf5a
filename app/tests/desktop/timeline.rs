//! The timeline, undo and the list of changes by their accessible labels, without Bevy's app and
//! without a GPU.

use crate::window_of_panels::{
    self, Window, commands, friction, prepared, ready, sample, set, standing,
};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::lab::Status;
use grainfall::measure::{Avalanche, Measure, Sample, Series};
use grainfall::physics::LIQUID_CASES;
use grainfall::run::{Branch, Command, Parameter, SAMPLE_INTERVAL};
use grainfall::scene::{SceneGrains, TimeStep};
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{AvalanchePlots, Curves, Level, Request, checks, stable_step};
use grainfall_app::view::ViewSettings;
use std::sync::Arc;
use std::time::Duration;

/// Carries `command` out, and what it takes.
pub fn carried_out(simulation: &mut Simulation, command: Command) {
    simulation.send(command);
    for _ in 0..10_000 {
        simulation.tick(Duration::from_millis(16));
        if simulation.has_answered() && *simulation.status() == Status::Paused {
            return;
        }
    }
    panic!("still {:?}", simulation.status());
}

/// Three grains that fell 2000 steps, with the friction changed halfway.
fn changed() -> Simulation {
    let mut simulation = prepared();
    for command in [
        Command::Step(1000),
        set(friction(), 0.25),
        Command::Step(1000),
    ] {
        carried_out(&mut simulation, command);
    }
    assert_eq!(simulation.past().end.step, 2000);
    simulation
}

#[test]
fn the_way_back_to_the_newest_state_stays_in_its_bar_however_large_the_text() {
    let mut simulation = changed();
    carried_out(&mut simulation, Command::Seek(500));
    let mut harness = Window::of(simulation);
    harness.ctx.all_styles_mut(|style| {
        for size in [egui::TextStyle::Body, egui::TextStyle::Button] {
            style
                .text_styles
                .insert(size, egui::FontId::proportional(24.0));
        }
    });
    harness.run_steps(6);
    let button = harness.get_by_label("To the newest").rect();
    let beyond = harness.get_by_label("Last 20 s").rect();
    assert!(button.right() < beyond.left(), "{button:?} {beyond:?}");
}

#[test]
fn the_numbers_beside_a_plot_are_those_of_the_moment_shown() {
    let mut series = Series::default();
    series.push(sample(0.0, 0.5, 1e-6));
    series.push(sample(0.02, 0.3, 1e-8));
    let mut plots = AvalanchePlots::default();
    let mut harness = Harness::new_ui(move |ui| {
        let curves = Curves {
            series: &series,
            compared: None,
            avalanches: &[],
            changes: &[],
            kept: &[],
            shown: Some(0.01),
        };
        plots.curves_ui(ui, &curves, &mut ViewSettings::default());
    });
    harness.run_steps(3);
    harness.get_by_label("28.65");
    assert!(harness.query_by_label("17.19").is_none());
}

/// What was asked for last.
fn asked(harness: &mut Harness<'_, Window>) -> Vec<Command> {
    commands(&window_of_panels::asked(harness))
}

#[test]
fn the_timeline_asks_for_the_moment_it_is_dragged_to() {
    let mut harness = Window::of(changed());
    let line = harness
        .get_by_role_and_label(Role::Slider, "Moment shown")
        .rect();
    let at = |share: f32| egui::pos2(egui::lerp(line.x_range(), share), line.center().y);
    harness.drag_at(at(0.5));
    let moments = asked(&mut harness);
    let Some(Command::Seek(step)) = moments.last().cloned() else {
        panic!("{moments:?}");
    };
    // Half of 2000 steps, as exactly as a pixel of the line allows.
    assert!(step.abs_diff(1000) < 20, "{step}");
    carried_out(&mut harness.state_mut().simulation, Command::Seek(step));
    assert!(
        asked(&mut harness).is_empty(),
        "a resting pointer asks for nothing"
    );
}

#[test]
fn an_earlier_moment_is_said_to_be_one_and_the_newest_is_one_click_away() {
    let mut simulation = changed();
    carried_out(&mut simulation, Command::Seek(500));
    let mut harness = Window::of(simulation);
    harness.get_by_label("To the newest").click();
    assert_eq!(asked(&mut harness), [Command::Seek(2000)]);
    harness.key_press(Key::End);
    assert_eq!(asked(&mut harness), [Command::Seek(2000)]);
    harness.get_by_label("Step back").click();
    assert_eq!(asked(&mut harness), [Command::Seek(499)]);
    harness.key_press(Key::ArrowLeft);
    assert_eq!(asked(&mut harness), [Command::Seek(499)]);
    carried_out(&mut harness.state_mut().simulation, Command::Seek(2000));
    harness.run_steps(2);
    assert!(harness.query_by_label("To the newest").is_none());
}

#[test]
fn keys_scrub_and_at_the_newest_moment_go_on() {
    let mut simulation = changed();
    let clock = simulation.world().unwrap().clock;
    let sample = (SAMPLE_INTERVAL / clock.time_step).ceil() as u64;
    assert!(sample < 2000, "{sample}");
    carried_out(&mut simulation, Command::Seek(1));
    let mut harness = Window::of(simulation);
    let mut press = |key| {
        harness.key_press_modifiers(Modifiers::SHIFT, key);
        asked(&mut harness)
    };
    assert_eq!(press(Key::ArrowRight), [Command::Seek(1 + sample)]);
    assert_eq!(press(Key::ArrowLeft), [Command::Seek(0)]);
    carried_out(&mut harness.state_mut().simulation, Command::Seek(2000));
    harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    assert_eq!(asked(&mut harness), [Command::Step(sample)]);

    // The line itself, once it has the focus, a pixel of it at a time.
    let line = harness.get_by_role_and_label(Role::Slider, "Moment shown");
    let width = line.rect().width();
    line.focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowLeft);
    let moments = asked(&mut harness);
    let [Command::Seek(step)] = moments[..] else {
        panic!("{moments:?}");
    };
    let pixel = (2000.0 / width).ceil() as u64;
    assert!((1..=2 * pixel).contains(&(2000 - step)), "{step}");
}

#[test]
fn undo_and_redo_are_there_when_they_mean_something() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Undo").click();
    assert!(asked(&mut harness).is_empty(), "nothing was changed");

    harness.state_mut().simulation = changed();
    harness.run_steps(2);
    harness.get_by_label("Undo").click();
    assert_eq!(asked(&mut harness), [Command::Undo]);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    assert_eq!(asked(&mut harness), [Command::Undo]);
    let simulation = &mut harness.state_mut().simulation;
    carried_out(simulation, Command::Undo);
    assert_eq!(simulation.value(&friction()), Some(0.40.into()));
    assert_eq!(simulation.past().end.step, 1000);
    harness.run_steps(2);
    harness.get_by_label("Redo").click();
    assert_eq!(asked(&mut harness), [Command::Redo]);
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(asked(&mut harness), [Command::Redo]);
}

#[test]
fn changes_are_listed_with_time_and_values_and_lead_to_their_moments() {
    let mut harness = Window::of(changed());
    harness
        .get_by_label_contains("friction glass – glass 0.4 → 0.25")
        .click();
    assert_eq!(asked(&mut harness), [Command::Seek(1000)]);
    harness.get_by_label("Save the list…").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked, [Request::ChooseChanges]);
}

#[test]
fn runs_that_were_left_can_be_taken_up_and_forgotten() {
    let mut simulation = changed();
    for command in [Command::Seek(500), set(friction(), 0.9), Command::Step(10)] {
        carried_out(&mut simulation, command);
    }
    assert_eq!(simulation.past().kept.len(), 1);
    let mut harness = Window::of(simulation);
    harness.get_by_label_contains("Show μ 0.25 from ").click();
    assert_eq!(asked(&mut harness), [Command::Return(0)]);
    harness.get_by_label_contains("Forget μ 0.25 from ").click();
    assert_eq!(asked(&mut harness), [Command::Forget(0)]);
}

/// Plots of a run of 20 s with an avalanche at 10 s and of one kept beside it, in a window 600
/// points wide that notes the moments that are clicked on [s].
fn clickable_plots() -> Harness<'static, Vec<f64>> {
    let mut series = Series::default();
    for i in 0..=1000 {
        series.push(sample(f64::from(i) * 0.02, 0.4, 0.4));
    }
    let avalanche = Avalanche {
        start: 10.0,
        end: 10.5,
        theta_m: 0.45,
        theta_r: 0.40,
    };
    let mut measured = Series::default();
    for sample in 0..100 {
        measured.push(Sample {
            step: sample,
            time: 0.1 * sample as f64,
            values: [0.3; Measure::COUNT],
        });
    }
    let left = Branch {
        number: 1,
        series: Arc::new(measured),
        ..Branch::default()
    };
    let kept = [("μ 0.4".to_owned(), Arc::new(left))];
    let mut plots = AvalanchePlots::default();
    Harness::builder().with_size([600.0, 500.0]).build_ui_state(
        move |ui, clicked: &mut Vec<f64>| {
            let curves = Curves {
                series: &series,
                compared: None,
                avalanches: std::slice::from_ref(&avalanche),
                changes: &[],
                kept: &kept,
                shown: Some(4.0),
            };
            clicked.extend(plots.curves_ui(ui, &curves, &mut ViewSettings::default()));
        },
        Vec::new(),
    )
}

#[test]
fn a_click_on_a_plot_means_a_moment_and_near_an_avalanche_its_start() {
    let mut harness = clickable_plots();
    harness.run_steps(3);
    let title = harness.get_by_label("Surface angle θ [°]").rect();
    let click = |harness: &mut Harness<'_, Vec<f64>>, x: f32| {
        let place = egui::pos2(x, title.bottom() + 50.0);
        harness.hover_at(place);
        harness.run_steps(1);
        harness.drag_at(place);
        harness.run_steps(1);
        harness.drop_at(place);
        harness.run_steps(2);
        harness.state_mut().pop().expect("a moment was clicked on")
    };
    // Two clicks far apart tell the scale of the axis.
    let (left, right) = (200.0_f32, 520.0);
    let (early, late) = (click(&mut harness, left), click(&mut harness, right));
    let per_point = (late - early) / f64::from(right - left);
    let at = |time: f64| right - ((late - time) / per_point) as f32;
    assert_eq!(click(&mut harness, at(10.0) + 3.0), 10.0);
    let off = click(&mut harness, at(10.0) + 12.0);
    assert!((off - 10.0 - 12.0 * per_point).abs() < 1e-3, "{off}");
}

#[test]
fn the_badge_says_by_word_and_mark_that_a_run_is_sound_and_shows_its_numbers() {
    let mut harness = Window::of(changed());
    harness.get_by_label_contains("Trust: Sound").click();
    harness.run_steps(3);
    for label in [
        "Time step",
        "Largest overlap",
        "Energy residual",
        "Grains lost",
    ] {
        harness.get_by_label(label);
    }
    let hash = harness
        .state()
        .simulation
        .world()
        .map(|world| world.hash().to_string());
    harness.get_by_label(&hash.expect("there is a state"));
}

#[test]
fn the_badge_names_a_time_step_beyond_its_limit_and_a_remedy() {
    let mut scene = prepared().scene().clone();
    let limit = prepared().advice().limits[0].time_step;
    for (factor, level) in [
        (0.5, Level::Good),
        (1.5, Level::Doubtful),
        (2.5, Level::Bad),
    ] {
        scene.time_step = TimeStep::Given(factor * limit);
        let simulation = ready(Simulation::open(scene.clone(), standing()));
        let step = checks(&simulation)
            .into_iter()
            .find(|check| check.name == "time step");
        assert_eq!(step.map(|check| check.level), Some(level), "{factor}");
        let harness = Window::of(simulation);
        let word = match level {
            Level::Good => "Trust: Sound",
            Level::Doubtful => "Trust: Doubtful. Time step",
            Level::Bad => "Trust: Not to be trusted. Time step",
        };
        harness.get_by_label_contains(word);
    }
}

#[test]
fn the_badge_offers_the_step_that_a_change_asks_for() {
    let mut simulation = fine_and_wet();
    let glycerol = LIQUID_CASES[6];
    carried_out(&mut simulation, Command::Step(10));
    carried_out(
        &mut simulation,
        set(Parameter::Viscosity, glycerol.viscosity),
    );
    let limit = simulation.advice().largest();
    let mut harness = Window::of(simulation);
    harness.get_by_label_contains("29 % over").click();
    harness.run_steps(4);
    harness
        .get_by_label_contains("Go on with steps of 6.567")
        .click();
    harness.run_steps(2);
    let asked = commands(&harness.state().asked);
    assert_eq!(asked, [set(Parameter::TimeStep, limit)]);
    let simulation = &mut harness.state_mut().simulation;
    carried_out(simulation, asked[0].clone());
    assert_eq!(simulation.advice().time_step, limit);
    harness.run_steps(4);
    harness.get_by_label_contains("Trust: Sound");
    assert!(stable_step(&harness.state().simulation).is_none());
    harness.state_mut().show_panel("Changes and runs");
    harness.run_steps(4);
    harness.get_by_label_contains("time step 8.45 → 6.567 µs");
}

/// Three of the paper's finest grains in water, which allows them a step of 8.45 µs.
fn fine_and_wet() -> Simulation {
    let mut scene = prepared().scene().clone();
    scene.liquid = Some(LIQUID_CASES[0].liquid());
    if let SceneGrains::List(grains) = &mut scene.grains {
        for grain in grains {
            grain.radius = 1.25e-3;
        }
    }
    ready(Simulation::open(scene, standing()))
}
