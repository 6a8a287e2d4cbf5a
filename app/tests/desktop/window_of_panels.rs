//! A window with all panels and no picture, and the small scenes that tests of panels are about.

use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use grainfall::lab::{DriverKind, LabCommand, Options, Status};
use grainfall::measure::{Measure, Sample};
use grainfall::parameters::{Parameter, Value};
use grainfall::physics::LIQUID_CASES;
use grainfall::run::{BedStore, Command};
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Dock, Request, theme};
use grainfall_app::view::ViewSettings;
use std::time::Duration;

/// A simulation of three grains, which needs no settling, at time zero.
pub fn three_grains() -> Simulation {
    let text = r#"(
        title: "Three grains",
        materials: {
            "glass": (youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500, restitution: 0.95, friction: 0.40, rolling_friction: 0.01),
            "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
        },
        pairs: [(between: ("glass", "drum"), restitution: 0.72, friction: 0.30, rolling_friction: 0.01)],
        container: Drum(radius_mm: 30, width_mm: 18, speed_rpm: 2, material: "drum"),
        grains: List([
            (position: (0, -0.02, 0), radius_mm: 3, material: "glass"),
            (position: (0.008, -0.02, 0), radius_mm: 3, material: "glass"),
            (position: (-0.008, -0.02, 0), radius_mm: 3, material: "glass"),
        ]),
    )"#;
    let scene = Scene::parse("three grains", text).expect("the scene is valid");
    Simulation::open(scene, standing())
}

/// How a scene is opened that stands still and is moved by the test.
pub fn standing() -> Options {
    Options {
        driver: DriverKind::Inline,
        threads: 1,
        autoplay: false,
        beds: BedStore::none(),
        ..Options::window()
    }
}

/// Three grains with a liquid between them, prepared.
pub fn wet() -> Simulation {
    let mut scene = three_grains().scene().clone();
    scene.liquid = Some(LIQUID_CASES[3].liquid());
    ready(Simulation::open(scene, standing()))
}

/// The three grains, prepared.
pub fn prepared() -> Simulation {
    ready(three_grains())
}

/// `simulation` once its bed is prepared.
pub fn ready(mut simulation: Simulation) -> Simulation {
    for _ in 0..1000 {
        simulation.tick(Duration::from_millis(16));
        if !matches!(simulation.status(), Status::Preparing { .. }) {
            return simulation;
        }
    }
    panic!("still {:?}", simulation.status());
}

/// `simulation` after `time` of its run.
pub fn after(mut simulation: Simulation, time: f64) -> Simulation {
    let step = simulation.world().unwrap().clock.step_at(time);
    simulation.send(LabCommand::Hold(Some(step)));
    simulation.send(Command::Speed(f64::INFINITY));
    simulation.send(Command::Play);
    for _ in 0..100_000 {
        simulation.tick(Duration::from_millis(16));
        if simulation.world().unwrap().clock.step >= step {
            return simulation;
        }
    }
    panic!("it does not get there");
}

/// A drum whose surface has slid twice, as its samples tell.
pub fn with_samples() -> Simulation {
    after(prepared(), 0.4)
}

/// Puts a run with a friction of 0.9 beside that of `simulation`.
pub fn put_beside(simulation: &mut Simulation) {
    simulation.send(LabCommand::Compare {
        parameter: friction(),
        value: 0.9.into(),
    });
    while simulation.comparison().is_none() {
        simulation.tick(Duration::from_millis(16));
    }
}

/// A window with all panels, without a picture.
pub struct Window {
    pub dock: Dock,
    pub simulation: Simulation,
    pub view: ViewSettings,
    pub asked: Vec<Request>,
    /// What was left for the picture in the last frame.
    pub free: egui::Rect,
}

impl Window {
    pub fn of(simulation: Simulation) -> Harness<'static, Self> {
        let window = Self {
            dock: Dock::default(),
            simulation,
            view: ViewSettings::default(),
            asked: Vec::new(),
            free: egui::Rect::NOTHING,
        };
        let mut installed = false;
        let mut harness = Harness::builder()
            .with_size([1600.0, 1400.0])
            .build_ui_state(
                move |ui, window: &mut Window| {
                    if !std::mem::replace(&mut installed, true) {
                        theme::install(ui.ctx());
                    }
                    let simulation = Some(&window.simulation);
                    window
                        .dock
                        .ui(ui, simulation, &mut window.view, &mut window.asked);
                    window.free = ui.available_rect_before_wrap();
                },
                window,
            );
        harness.run_steps(4);
        harness
    }

    pub fn show_panel(&mut self, title: &str) {
        self.dock.show_panel(title);
    }
}

/// The commands among what was `asked` for.
pub fn commands(asked: &[Request]) -> Vec<Command> {
    let command = |request: &Request| match request {
        Request::Command(command) => Some(command.clone()),
        _ => None,
    };
    asked.iter().filter_map(command).collect()
}

/// What the window asked for since the last time.
pub fn asked(harness: &mut Harness<'_, Window>) -> Vec<Request> {
    harness.run_steps(3);
    std::mem::take(&mut harness.state_mut().asked)
}

/// The friction of the grains among each other.
pub fn friction() -> Parameter {
    Parameter::Friction("glass".into(), "glass".into())
}

/// The command that sets `parameter` to `value` [SI unit].
pub fn set(parameter: Parameter, value: impl Into<Value>) -> Command {
    let value = value.into();
    Command::Set { parameter, value }
}

/// A window that shows every parameter.
pub fn in_the_lab(simulation: Simulation) -> Harness<'static, Window> {
    let mut harness = Window::of(simulation);
    harness.get_by_label("Lab").click();
    harness.run_steps(4);
    harness
}

/// Types `text` into a field of a number: a click begins the edit, Return ends it.
pub fn type_number<S>(harness: &mut Harness<'_, S>, label: &str, text: &str) {
    let spin = Role::SpinButton;
    harness.get_by_role_and_label(spin, label).scroll_to_me();
    harness.run_steps(30);
    harness.get_by_role_and_label(spin, label).click();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(3);
}

/// Scrolls to a button and presses it.
pub fn press(harness: &mut Harness<'_, Window>, label: &str) {
    harness.get_by_label(label).scroll_to_me();
    harness.run_steps(30);
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// A sample at `time` [s] of a surface of this `angle` [rad].
pub fn sample(time: f64, angle: f64, temperature: f64) -> Sample {
    let mut values = [f64::NAN; Measure::COUNT];
    values[Measure::SurfaceAngle as usize] = angle;
    values[Measure::GranularTemperature as usize] = temperature;
    Sample {
        step: (time * 1e5).round() as u64,
        time,
        values,
    }
}
