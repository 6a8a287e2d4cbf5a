//! Two runs side by side: the panel by its accessible labels, and both halves of the picture in the
//! app as a whole.

use crate::timeline::carried_out;
use crate::view::{Photograph, SIZE, laboratory, photographed, studio};
use crate::window_of_panels::{
    Window, asked, friction, prepared, put_beside, sample, set, standing, type_number,
};
use crate::windowless::{self, simulation, update_until};
use bevy::math::{Vec2, Vec3};
use bevy::prelude::*;
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::lab::{DriverKind, Half, LabCommand, Options, Status};
use grainfall::measure::{GrainQuantity, Series};
use grainfall::run::{Command, Parameter};
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{AvalanchePlots, Curves, Dock, DockPlugin, Request};
use grainfall_app::view::{ColourBy, OrbitCamera, ViewSettings};

/// Three grains that fell, twice: with a friction of 0.4 on the left and of 0.9 on the right.
fn pair() -> Simulation {
    let mut simulation = prepared();
    put_beside(&mut simulation);
    carried_out(&mut simulation, Command::Step(2000));
    simulation
}

fn open_panel(harness: &mut Harness<'_, Window>) {
    harness.get_by_label("Compare two values").click();
    harness.run_steps(6);
}

#[test]
fn two_values_are_chosen_by_name_or_number_and_started() {
    let mut harness = Window::of(prepared());
    open_panel(&mut harness);
    harness.get_by_label("Left: 0.4, the present value");
    // The farthest named value stands there already.
    harness.get_by_label("Start side by side").click();
    assert_eq!(
        asked(&mut harness),
        [Request::StartComparison(friction(), 0.8.into())]
    );
    type_number(&mut harness, "value on the right", "0.4");
    harness.get_by_label("Start side by side").click();
    assert!(asked(&mut harness).is_empty(), "both values are the same");
    type_number(&mut harness, "value on the right", "0.85");
    harness.get_by_label("Start side by side").click();
    assert_eq!(
        asked(&mut harness),
        [Request::StartComparison(friction(), 0.85.into())]
    );
    harness
        .get_by_role_and_label(Role::ComboBox, "Parameter to compare")
        .click();
    harness.run_steps(3);
    harness.get_by_label("Gravity").click();
    harness.run_steps(3);
    harness.get_by_label("Left: 9.81 m/s², the present value");
}

#[test]
fn a_key_leads_to_the_panel() {
    let mut harness = Window::of(prepared());
    harness.key_press_modifiers(Modifiers::COMMAND, Key::T);
    assert_eq!(asked(&mut harness), [Request::Compare(None)]);
    harness.state_mut().show_panel("Compare two values");
    harness.run_steps(8);
    harness.get_by_label("Start side by side");
}

#[test]
fn each_half_has_its_own_row_and_the_comparison_its_ends() {
    let mut harness = Window::of(pair());
    type_number(&mut harness, "friction glass – glass, right", "0.7");
    assert_eq!(
        asked(&mut harness),
        [Request::SetIn(Half::Right, friction(), 0.7.into())]
    );
    type_number(&mut harness, "friction glass – glass, left", "0.2");
    assert_eq!(
        asked(&mut harness),
        [Request::SetIn(Half::Left, friction(), 0.2.into())]
    );
    open_panel(&mut harness);
    // Beside the plots and in the panel.
    for name in ["Left: μ 0.4", "Right: μ 0.9"] {
        assert_eq!(harness.get_all_by_label(name).count(), 2, "{name}");
    }
    harness.get_by_label("End it, keep the left run").click();
    assert_eq!(asked(&mut harness), [Request::EndComparison(Half::Left)]);
    harness.get_by_label("End it, keep the right run").click();
    assert_eq!(asked(&mut harness), [Request::EndComparison(Half::Right)]);
}

#[test]
fn what_belongs_to_one_run_cannot_be_pressed() {
    let mut simulation = prepared();
    carried_out(&mut simulation, Command::Step(100));
    carried_out(&mut simulation, set(friction(), 0.3));
    put_beside(&mut simulation);
    assert!(
        simulation.past().undo.is_some(),
        "what the left run alone could take back"
    );
    let mut harness = Window::of(simulation);
    assert!(harness.get_by_label("Undo").accesskit_node().is_disabled());
    let compare = harness.get_by_label("Compare drum speed…");
    assert!(compare.accesskit_node().is_disabled());
    harness.get_by_label("Play").click();
    assert_eq!(asked(&mut harness), [Request::Command(Command::Play)]);
}

#[test]
fn changes_of_either_half_are_listed_and_taken_back_in_both() {
    let mut simulation = pair();
    simulation.send(LabCommand::SetIn {
        half: Half::Right,
        parameter: friction(),
        value: 0.5.into(),
    });
    carried_out(&mut simulation, Command::Step(500));
    let mut harness = Window::of(simulation);
    harness.get_by_label_contains("right: friction glass – glass 0.9 → 0.5");
    harness.get_by_label("Undo").click();
    assert_eq!(asked(&mut harness), [Request::Command(Command::Undo)]);
    let simulation = &mut harness.state_mut().simulation;
    carried_out(simulation, Command::Undo);
    assert_eq!(
        simulation.half(Half::Right).value(&friction()),
        Some(0.9.into())
    );
    let ends = Half::ALL.map(|half| simulation.half(half).past().end.step);
    assert_eq!(ends, [2000; 2]);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("0.9 → 0.5").is_none());
    assert!(harness.get_by_label("Undo").accesskit_node().is_disabled());
    harness.get_by_label("Redo").click();
    assert_eq!(asked(&mut harness), [Request::Command(Command::Redo)]);
}

/// Plots of two runs with `samples` each, in a panel of this size.
fn plots_of_two(samples: u32, size: [f32; 2]) -> Harness<'static> {
    let [mut left, mut right] = [(); 2].map(|()| Series::default());
    for i in 0..samples {
        let time = 0.02 * f64::from(i);
        left.push(sample(time, 0.5, 1e-6));
        right.push(sample(time, 0.3, 1e-8));
    }
    let mut plots = AvalanchePlots::default();
    let mut harness = Harness::builder().with_size(size).build_ui(move |ui| {
        let curves = Curves {
            series: &left,
            compared: Some(&right),
            avalanches: &[],
            changes: &[],
            kept: &[],
            shown: None,
        };
        plots.curves_ui(ui, &curves, &mut ViewSettings::default());
    });
    harness.run_steps(3);
    harness
}

#[test]
fn both_curves_are_on_each_plot_and_the_newest_of_both_beside_its_name() {
    let harness = plots_of_two(500, [500.0, 500.0]);
    for newest in ["28.65", "17.19", "1.00·10⁻⁶", "1.00·10⁻⁸"] {
        assert!(
            harness.query_by_label_contains(newest).is_some(),
            "{newest}"
        );
    }
    // Heights of 28.65° and of 17.19° both lie in the plot: each has a line of its own in it.
    let dashes = harness.output().shapes.iter().filter(|clipped| {
        matches!(clipped.shape, egui::Shape::LineSegment { stroke, .. } if stroke.width == 2.0)
    });
    assert!(dashes.count() > 20, "the right one is dashed");
}

#[test]
fn titles_of_plots_are_whole_in_a_narrow_panel() {
    let title_width = |room: f32| {
        let harness = plots_of_two(1, [room, 700.0]);
        let title = harness.get_by_label("Granular temperature Tg [m²/s²]");
        title.rect().width()
    };
    assert_eq!(title_width(280.0), title_width(900.0));
}

/// A laboratory that looks at its grain from the front; requests go in as panels make them.
pub fn falling_from_the_front() -> App {
    let options = Options {
        driver: DriverKind::Thread,
        threads: 2,
        ..standing()
    };
    let dock = DockPlugin {
        options: options.clone(),
    };
    let mut app = laboratory(SIZE, options, dock);
    let mut camera = OrbitCamera::default();
    (camera.yaw, camera.pitch, camera.height) = (0.0, 0.0, 0.1);
    (camera.focus, camera.fits) = (Vec3::new(0.0, 0.04, 0.0), false);
    app.insert_resource(camera);
    app.world_mut()
        .resource_mut::<ViewSettings>()
        .show_container = false;
    app
}

/// Asks for `request` and waits until it is done and the run stands.
pub fn ask(app: &mut App, request: Request, done: impl Fn(&Simulation) -> bool) {
    windowless::ask(app, request);
    update_until(app, |simulation| {
        done(simulation) && simulation.has_answered() && *simulation.status() == Status::Paused
    });
}

/// Where the grain of this half lands in the whole picture.
pub fn place(app: &App, photograph: &Photograph, half: Half) -> Vec2 {
    let world = simulation(app).half(half).world().unwrap();
    let centre = world.grains.position[0].as_vec3();
    let (place, _) = photograph.camera.project(centre).unwrap();
    // The halves are two pixels apart.
    let offset = 0.5 * (SIZE.x as f32 + 2.0) * half.index() as f32;
    place + Vec2::new(offset, 0.0)
}

#[test]
fn each_half_shows_its_own_run_with_the_same_colours_until_the_comparison_ends() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut app = falling_from_the_front();
    let mut settings = app.world_mut().resource_mut::<ViewSettings>();
    settings.colour_by = ColourBy::Quantity(GrainQuantity::Speed);
    settings.show_turning = Some(false);
    let has_two = |s: &Simulation| s.comparison().is_some();
    ask(
        &mut app,
        Request::StartComparison(Parameter::Gravity, 0.0.into()),
        has_two,
    );
    let start = photographed(&mut app, "twin-start");
    let [left, right] = Half::ALL.map(|half| place(&app, &start, half));
    assert_eq!(left.y, right.y, "they start at the same place");
    assert!(start.covered(left) && start.covered(right));

    // It falls by g t²/2 = 12 mm, four radii; the other one has no weight.
    let fall = simulation(&app).world().unwrap().clock.step_at(0.05);
    ask(&mut app, Request::Command(Command::Step(fall)), |s| {
        s.step() == fall
    });
    let fallen = photographed(&mut app, "twin-fallen");
    let [left, right] = Half::ALL.map(|half| place(&app, &fallen, half));
    assert!(left.y > right.y + 40.0, "{left} {right}");
    let across = |at: Vec2, of: Vec2| Vec2::new(at.x, of.y);
    assert!(fallen.covered(left) && !fallen.covered(across(left, right)));
    assert!(fallen.covered(right) && !fallen.covered(across(right, left)));
    // One range for both: the fast one is yellow at its upper end, the other one violet at its
    // lower.
    let legend = app
        .world()
        .resource::<ViewSettings>()
        .legend
        .clone()
        .unwrap();
    assert!((0.49..=1.0).contains(&legend.max), "{legend:?}");
    let [fast, still] = [fallen.at(left), fallen.at(right)];
    assert!(fast[1] > still[1] + 60, "{fast:?} {still:?}");

    let state = simulation(&app).half(Half::Right).world().unwrap().hash();
    ask(&mut app, Request::EndComparison(Half::Right), |s| {
        s.comparison().is_none() && s.world().is_some_and(|world| world.hash() == state)
    });
    assert_eq!(
        simulation(&app).value(&Parameter::Gravity),
        Some(0.0.into())
    );
    let alone = photographed(&mut app, "twin-ended");
    let centre = simulation(&app).world().unwrap().grains.position[0].as_vec3();
    let (middle, _) = alone.camera.project(centre).unwrap();
    assert!(alone.covered(middle) && (middle.x - 0.5 * SIZE.x as f32).abs() < 1.0);
    assert!(!alone.covered(left) && !alone.covered(right));
    assert!(app.world().resource::<Dock>().open_error().is_none());
}
