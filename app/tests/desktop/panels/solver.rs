//! The panel of the solver: what it says of the time step.

use crate::window_of_panels::{Window, prepared};
use egui_kittest::kittest::Queryable;
use grainfall::measure::numeral;
use grainfall::run::MeasuredBed;

#[test]
fn what_other_steps_change_in_a_bed_like_it_is_told() {
    let mut harness = Window::of(prepared());
    harness.state_mut().show_panel("Solver");
    harness.run_steps(6);
    let scene = harness.state().simulation.scene().clone();
    let bed = MeasuredBed::like(&scene);
    harness.get_by_label("Other steps change");
    for step in bed.steps.iter().filter(|step| !bed.is_standard(step)) {
        let name = numeral::with_prefix(step.time_step, "s");
        let told = harness.query_all_by_label_contains(&name).count();
        assert!(told > 0, "{name}");
    }
    harness.get_by_label_contains(bed.bed);
}
