//! One grain under the microscope.

use crate::window_of_panels::{Window, after, prepared, type_number, wet};
use egui_kittest::kittest::Queryable;

#[test]
fn microscope_shows_a_grain_its_contacts_and_every_term_of_their_forces() {
    let mut harness = Window::of(after(prepared(), 0.2));
    harness.get_by_label("Microscope").click();
    harness.run_steps(3);
    harness.get_by_label("choose by number").click();
    harness.run_steps(3);
    assert_eq!(harness.state().view.selected, Some(0));
    for label in [
        "Position",
        "Velocity",
        "Spin",
        "Mass",
        "Coordination number",
        "Walls touched",
        "Kinetic energy",
    ] {
        harness.get_by_label(label);
    }
    harness.get_by_label("Choose a contact to see its forces.");
    harness.get_by_label_contains("Rim · touches").click();
    harness.run_steps(3);
    for label in [
        "Normal spring",
        "Normal dashpot",
        "Tangential spring",
        "Coulomb bound",
        "Rolling torque",
    ] {
        harness.get_by_label(label);
    }
    harness.get_by_label_contains("Force over gap: ");
    type_number(&mut harness, "Grain", "2");
    assert_eq!(harness.state().view.selected, Some(2));
    harness.get_by_label("Look at no grain").click();
    harness.run_steps(2);
    assert_eq!(harness.state().view.selected, None);
}

#[test]
fn a_grain_that_is_clicked_opens_the_microscope() {
    let mut harness = Window::of(after(wet(), 0.2));
    assert!(harness.query_by_label("Coordination number").is_none());
    harness.state_mut().view.selected = Some(1);
    harness.run_steps(4);
    harness.get_by_label("Coordination number");
    // A grain that the next scene does not have is no grain.
    harness.state_mut().view.selected = Some(1000);
    harness.run_steps(3);
    assert!(harness.query_by_label("Coordination number").is_none());
}

#[test]
fn a_wet_contact_shows_what_its_bridge_does() {
    let mut harness = Window::of(after(wet(), 0.2));
    harness.state_mut().view.selected = Some(1);
    harness.run_steps(4);
    harness.get_by_label_contains("touches, wet").click();
    harness.run_steps(3);
    harness.get_by_label("Capillary");
    harness.get_by_label("Viscous, normal");
}
