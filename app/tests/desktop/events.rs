//! The list of events, its keys, the part of a run that is repeated, the ruler, the quantities of
//! grains: by their accessible labels, and by what they tell of a run that is known.

use crate::timeline::carried_out;
use crate::window_of_panels::{self, Window, after, commands, prepared, ready, standing};
use bevy_egui::egui::{self, Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use grainfall::run::{Command, EventKind};
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{Repeat, Request};
use grainfall_app::view::{Ruler, RulerEnd};
use std::f64::consts::FRAC_PI_2;
use std::time::Duration;

/// A grain that has met the floor twice, and left it.
fn bounced() -> Simulation {
    let scene = Scene::open("bouncing-grain").unwrap();
    after(ready(Simulation::open(scene, standing())), 0.3)
}

fn window() -> Harness<'static, Window> {
    let mut harness = Window::of(bounced());
    harness.state_mut().show_panel("Events");
    harness.run_steps(6);
    harness
}

/// The steps of the events of these `kinds`.
fn steps(simulation: &Simulation, kinds: &[EventKind]) -> Vec<u64> {
    let times = simulation.step_times().unwrap();
    let events = simulation.events().iter();
    let events = events.filter(|event| kinds.contains(&event.kind()));
    events.map(|event| times.step_at(event.time)).collect()
}

/// What was asked for last.
fn asked(harness: &mut Harness<'_, Window>) -> Vec<Command> {
    commands(&window_of_panels::asked(harness))
}

#[test]
fn a_click_on_an_impact_asks_for_its_moment() {
    let mut harness = window();
    let impacts = steps(&harness.state().simulation, &[EventKind::Impact]);
    assert_eq!(impacts.len(), 2);
    // 5 cm in 101 ms, then 0.8 of the speed of 0.99 m/s.
    let rows = [
        "grain 0 and floor meet at 990",
        "grain 0 and floor meet at 79",
    ];
    for (row, step) in rows.into_iter().zip(impacts) {
        harness.get_by_label_contains(row).click();
        assert_eq!(asked(&mut harness), [Command::Seek(step)], "{row}");
    }
}

#[test]
fn kinds_are_hidden_and_shown_and_words_are_searched_for() {
    let mut harness = window();
    let parts = |harness: &Harness<'_, Window>| {
        harness
            .query_all_by_label_contains("floor part, after")
            .count()
    };
    let meets = |harness: &Harness<'_, Window>| {
        harness.query_all_by_label_contains("floor meet at").count()
    };
    assert_eq!((meets(&harness), parts(&harness)), (2, 0));
    harness.get_by_label("Partings 2").click();
    harness.run_steps(3);
    assert_eq!((meets(&harness), parts(&harness)), (2, 2));
    harness.get_by_label("Search events").focus();
    harness.run_steps(2);
    harness.event(egui::Event::Text("Part µs".to_owned()));
    harness.run_steps(3);
    assert_eq!((meets(&harness), parts(&harness)), (0, 2));
    harness.event(egui::Event::Text("zzz".to_owned()));
    harness.run_steps(3);
    assert_eq!((meets(&harness), parts(&harness)), (0, 0));
    harness.get_by_label_contains("No event is of these kinds");
}

#[test]
fn keys_lead_from_event_to_event_of_the_kinds_shown() {
    let mut harness = window();
    let impacts = steps(&harness.state().simulation, &[EventKind::Impact]);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::E);
    assert_eq!(asked(&mut harness), [Command::Seek(impacts[1])]);
    // At the newest state there is none after it.
    harness.key_press(Key::E);
    assert_eq!(asked(&mut harness), []);
    harness.get_by_label("Partings 2").click();
    harness.run_steps(3);
    let all = [EventKind::Impact, EventKind::Parting];
    let all = steps(&harness.state().simulation, &all);
    harness.key_press_modifiers(Modifiers::SHIFT, Key::E);
    assert_eq!(asked(&mut harness), [Command::Seek(all[3])]);
    assert!(all[3] > impacts[1]);
}

#[test]
fn a_key_and_a_button_mark_what_is_repeated() {
    let mut harness = window();
    harness.get_by_label("Repeat a part").click();
    harness.run_steps(3);
    harness.key_press(Key::L);
    harness.run_steps(3);
    let repeats = [Request::Repeat, Request::Repeat];
    assert_eq!(harness.state().asked, repeats);
}

#[test]
fn what_lies_between_two_marks_is_played_again_and_again() {
    let scene = Scene::open("bouncing-grain").unwrap();
    let mut simulation = ready(Simulation::open(scene, standing()));
    carried_out(&mut simulation, Command::Step(4000));
    let hash = simulation.world().unwrap().hash();
    let mut repeat = Repeat::default();
    carried_out(&mut simulation, Command::Seek(3000));
    repeat.mark(&simulation);
    assert_eq!((repeat.ends().count(), repeat.duration()), (1, None));
    // The mark that is earlier is the start, whichever was made first.
    carried_out(&mut simulation, Command::Seek(2000));
    repeat.mark(&simulation);
    let step = simulation.world().unwrap().clock.time_step;
    let lasts = repeat.duration().unwrap();
    assert!((lasts - 1000.0 * step).abs() < 1e-12, "{lasts}");

    simulation.send(Command::Speed(0.2));
    simulation.send(Command::Play);
    let (mut turns, mut last, mut latest) = (0, 2000, 0);
    for _ in 0..4000 {
        simulation.tick(Duration::from_millis(16));
        let mut asked = Vec::new();
        repeat.follow(&simulation, &mut asked);
        for command in commands(&asked) {
            simulation.send(command);
        }
        let now = simulation.world().unwrap().clock.step;
        turns += u32::from(now < last);
        (last, latest) = (now, latest.max(now));
        if turns == 3 {
            break;
        }
    }
    assert_eq!(turns, 3, "at step {last}");
    // A picture may come a sixtieth of a second late.
    assert!((3000..4000).contains(&latest), "{latest}");
    assert_eq!(simulation.past().end.step, 4000, "nothing new is computed");

    repeat.mark(&simulation);
    assert_eq!(repeat.ends().count(), 0);
    carried_out(&mut simulation, Command::Pause);
    carried_out(&mut simulation, Command::Seek(4000));
    assert_eq!(simulation.world().unwrap().hash(), hash);
}

#[test]
fn a_ruler_between_grains_goes_with_them() {
    let simulation = prepared();
    let mut world = (**simulation.world().unwrap()).clone();
    let mut ruler = Ruler::default();
    ruler.toggle();
    ruler.lay(RulerEnd::Grain(0));
    assert_eq!(ruler.reading(&world), None);
    ruler.lay(RulerEnd::Grain(2));
    for (way, inclination) in [
        (DVec3::new(3.0, 4.0, 0.0), (4.0_f64 / 3.0).atan()),
        (DVec3::new(0.0, -5.0, 0.0), FRAC_PI_2),
        (DVec3::new(-4.0, 0.0, 3.0), 0.0),
        (DVec3::new(-3.0, 4.0, 0.0), (4.0_f64 / 3.0).atan()),
    ] {
        let from = DVec3::new(0.1, -0.2, 0.3);
        world.grains.position[0] = from;
        world.grains.position[2] = from + 1e-3 * way;
        let reading = ruler.reading(&world).unwrap();
        assert!((reading.distance - 5e-3).abs() < 1e-15, "{reading:?}");
        assert!(
            (reading.inclination - inclination).abs() < 1e-12,
            "{reading:?}"
        );
    }
    ruler.lay(RulerEnd::Place(DVec3::ZERO));
    assert_eq!(ruler.places(&world), [DVec3::ZERO], "it is laid anew");
    ruler.toggle();
    assert_eq!(ruler, Ruler::default());
    ruler.lay(RulerEnd::Grain(7));
    assert!(ruler.places(&world).is_empty(), "there is no such grain");
}

/// Three grains that fall freely for 10 ms are equally fast: g t = 98.1 mm/s.
#[test]
fn the_histogram_and_the_curve_of_a_grain_show_its_speed() {
    let simulation = after(prepared(), 0.01);
    let world = simulation.world().unwrap();
    let speed = world.grains.velocity[1].length();
    assert!(
        (speed / (9.81 * world.time()) - 1.0).abs() < 1e-9,
        "{speed}"
    );
    let shown = format!("{:.2}", 1e3 * speed);
    let mut harness = Window::of(simulation);
    harness.state_mut().show_panel("Grains");
    harness.state_mut().view.selected = Some(1);
    harness.run_steps(6);
    let histogram = format!("Grains over Speed [mm/s]: 3 grains, mean {shown}");
    harness.get_by_label_contains(&histogram);
    let curve = format!("Grain 1 over time [s], Speed [mm/s], now {shown}");
    harness.get_by_label_contains(&curve);
}

/// Not a single number stands on the axis of the histogram but zero: the plot has a width all the
/// same.
#[test]
fn grains_at_rest_are_one_bar_at_zero() {
    let simulation = prepared();
    assert_eq!(simulation.world().map(|world| world.clock.step), Some(0));
    let mut harness = Window::of(simulation);
    harness.state_mut().show_panel("Grains");
    harness.run_steps(6);
    harness.get_by_label_contains("Grains over Speed [m/s]: 3 grains, mean 0 m/s, spread 0 m/s");
}
