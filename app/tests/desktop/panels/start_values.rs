//! What acts from the next start on, and the way back to the scene as it was opened.

use crate::window_of_panels::{
    Window, commands, friction, in_the_lab, prepared, press, ready, set, standing, type_number,
};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::parameters::Parameter;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::Request;

#[test]
fn reset_all_sets_what_was_changed_and_nothing_else() {
    let mut simulation = prepared();
    let speed = simulation.value(&Parameter::DrumSpeed).unwrap();
    simulation.send(set(friction(), 0.8));
    simulation.send(set(Parameter::DrumSpeed, 1.0));
    let mut harness = Window::of(simulation);
    harness.get_by_label("Reset all").click();
    harness.run_steps(2);
    let mut asked = commands(&harness.state().asked);
    asked.sort_by_key(|command| format!("{command:?}"));
    assert_eq!(
        asked,
        [set(Parameter::DrumSpeed, speed), set(friction(), 0.4)]
    );
}

#[test]
fn reset_all_brings_back_what_acts_at_the_next_start_too() {
    let original = prepared().scene().clone();
    let mut denser = original.clone();
    denser.materials[0].density = 5000.0;
    let opened = Simulation::open(denser, standing()).made_of(original.clone().into());
    let mut harness = Window::of(ready(opened));
    // Basics do not show the density: they say that something is another than in the scene.
    harness.get_by_label_contains("1 more changed");
    harness.get_by_label("Reset all").click();
    harness.run_steps(4);
    harness.get_by_label_contains("not yet in the run");
    press(&mut harness, "Start with these");
    assert_eq!(harness.state().asked, [Request::Start(Box::new(original))]);
}

#[test]
fn reset_all_forgets_what_is_not_yet_in_the_run() {
    let mut harness = in_the_lab(prepared());
    let reset = |harness: &Harness<'_, Window>| {
        let button = harness.get_by_label("Reset all");
        !button.accesskit_node().is_disabled()
    };
    assert!(!reset(&harness));
    type_number(&mut harness, "density glass", "5000");
    assert!(reset(&harness));
    press(&mut harness, "Reset all");
    assert_eq!(harness.state().asked, []);
    assert!(harness.query_by_label("Start with these").is_none());
}

#[test]
fn what_acts_later_waits_for_the_next_start() {
    let mut harness = in_the_lab(prepared());
    type_number(&mut harness, "density glass", "5000");
    type_number(&mut harness, "Poisson's ratio drum", "0.3");
    assert_eq!(harness.state().asked, [], "the run goes on as it is");
    harness.get_by_label_contains("not yet in the run");
    press(&mut harness, "Reset Poisson's ratio drum");
    press(&mut harness, "Start with these");
    let mut expected = harness.state().simulation.scene().clone();
    expected.materials[0].density = 5000.0;
    assert_eq!(harness.state().asked, [Request::Start(Box::new(expected))]);
    press(&mut harness, "Forget these");
    assert!(harness.query_by_label("Start with these").is_none());
}
