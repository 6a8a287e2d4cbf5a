//! Plots: over time, any quantity over another, the energy, the velocities.

use crate::timeline::carried_out;
use crate::window_of_panels::{Window, prepared, ready, sample, standing, with_samples};
use bevy_egui::egui::accesskit::Role;
use bevy_egui::egui::{self, Shape};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::measure::{Avalanche, Series};
use grainfall::output::{FLOW, flow_table};
use grainfall::recording::Recording;
use grainfall::run::{Branch, Command};
use grainfall::runner::{self, Job};
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use grainfall_app::ui::{AvalanchePlots, Curves, Request};
use grainfall_app::view::ViewSettings;
use std::sync::Arc;

/// Ten thousand samples of a sawtooth, with its avalanches.
struct Sawtooth {
    series: Series,
    avalanches: Vec<Avalanche>,
}

impl Sawtooth {
    fn new() -> Self {
        let mut series = Series::default();
        for i in 0..10_000 {
            let time = f64::from(i) * 0.02;
            let temperature = if time % 1.0 < 0.1 { 1e-5 } else { 1e-10 };
            series.push(sample(time, 0.4 + 0.05 * (time % 1.0), temperature));
        }
        let avalanche = |i: u32| Avalanche {
            start: f64::from(i),
            end: f64::from(i) + 0.1,
            theta_m: 0.45,
            theta_r: 0.40,
        };
        Self {
            series,
            avalanches: (0..200).map(avalanche).collect(),
        }
    }

    fn curves(&self) -> Curves<'_> {
        Curves {
            series: &self.series,
            compared: None,
            avalanches: &self.avalanches,
            changes: &[3.0, 3.01, 190.0],
            kept: &[],
            shown: None,
        }
    }
}

#[test]
fn ten_thousand_samples_are_drawn_with_no_more_points_than_pixels_need() {
    let width = 400.0;
    let data = Sawtooth::new();
    let mut plots = AvalanchePlots::default();
    let mut harness = Harness::builder()
        .with_size([width, 500.0])
        .build_ui(move |ui| {
            assert_eq!(
                plots.curves_ui(ui, &data.curves(), &mut ViewSettings::default()),
                None
            );
        });
    harness.run_steps(2);
    harness.get_by_label("All").click();
    harness.run_steps(3);
    let longest = longest_line(&harness.output().shapes);
    assert!(longest > 200, "the curve is drawn: {longest} points");
    assert!(
        longest < 2 * width as usize + 10,
        "{longest} points for {width} pixels"
    );
}

#[test]
fn plots_without_samples_draw_nothing_and_do_not_fail() {
    let mut plots = AvalanchePlots::default();
    let series = Series::default();
    let mut harness = Harness::new_ui(move |ui| {
        let empty = Curves {
            series: &series,
            compared: None,
            avalanches: &[],
            changes: &[],
            kept: &[],
            shown: None,
        };
        assert_eq!(
            plots.curves_ui(ui, &empty, &mut ViewSettings::default()),
            None
        );
    });
    harness.run_steps(3);
    harness.get_by_label("Surface angle θ [°]");
}

/// The texts among `shapes`: what they say, where they stand, and what is seen of them.
fn texts(shapes: &[egui::epaint::ClippedShape]) -> Vec<(String, egui::Rect, egui::Rect)> {
    let text = |clipped: &egui::epaint::ClippedShape| match &clipped.shape {
        Shape::Text(text) => {
            let place = text.galley.rect.translate(text.pos.to_vec2());
            Some((text.galley.job.text.clone(), place, clipped.clip_rect))
        }
        _ => None,
    };
    shapes.iter().filter_map(text).collect()
}

/// A run of this `number` with samples from zero until `end` [s].
fn kept_run(name: &str, number: u32, end: f64) -> (String, Arc<Branch>) {
    let mut series = Series::default();
    for i in 0..=(end / 0.02).round() as u32 {
        series.push(sample(0.02 * f64::from(i), 0.42, 1e-6));
    }
    let branch = Branch {
        number,
        series: Arc::new(series),
        ..Branch::default()
    };
    (name.to_owned(), Arc::new(branch))
}

#[test]
fn names_of_runs_are_whole_and_apart_and_a_run_of_no_length_has_none() {
    let long = "a name of a run that nobody could read on a plot this wide";
    let data = Sawtooth::new();
    let mut series = Series::default();
    for i in 0..=750 {
        series.push(sample(f64::from(i) * 0.02, 0.45, 1e-6));
    }
    let kept = [
        kept_run("not gone on", 1, 0.0),
        kept_run("η 1.01 mPa s", 2, 12.0),
        kept_run("μ 0.8", 3, 12.0),
        kept_run("glycerol", 4, 0.6),
        kept_run(long, 5, 15.0),
        kept_run("μ 0.9 from 3.20 s", 6, 15.0),
    ];
    let named = [1, 2, 3, 4, 5].map(|index: usize| kept[index].0.clone());
    for (width, scale) in [(240.0, 1.0), (400.0, 1.0), (700.0, 2.0)] {
        let (own, kept) = (series.clone(), kept.clone());
        let avalanches = data.avalanches.clone();
        let mut plots = AvalanchePlots::default();
        let mut harness = Harness::builder()
            .with_size([width, 600.0])
            .with_pixels_per_point(scale)
            .build_ui(move |ui| {
                let curves = Curves {
                    series: &own,
                    compared: None,
                    avalanches: &avalanches,
                    changes: &[],
                    kept: &kept,
                    shown: None,
                };
                plots.curves_ui(ui, &curves, &mut ViewSettings::default());
            });
        harness.run_steps(4);
        let drawn = texts(&harness.output().shapes);
        let is_name = |text: &String| named.contains(text);
        let is_drop = |text: &String| text == "2.9°";
        let labels: Vec<_> = (drawn.into_iter())
            .filter(|(text, ..)| is_name(text) || is_drop(text) || text == "not gone on")
            .collect();
        let count = |wanted: &dyn Fn(&String) -> bool| {
            labels.iter().filter(|(text, ..)| wanted(text)).count()
        };
        // On both plots.
        assert_eq!(count(&is_name), 2 * named.len(), "{width}: {labels:?}");
        assert_eq!(count(&|text| text == "not gone on"), 0);
        assert!(count(&is_drop) > 2, "{width}");
        for (index, (text, place, seen)) in labels.iter().enumerate() {
            assert!(
                seen.contains_rect(*place),
                "{text} is cut: {place:?} of {seen:?}"
            );
            for (other, its, _) in &labels[..index] {
                let apart = !its.shrink(0.6).intersects(place.shrink(0.6));
                assert!(apart, "{width}: {text} {place:?} over {other} {its:?}");
            }
        }
    }
}

/// Points of the longest line among `shapes`.
fn longest_line(shapes: &[egui::epaint::ClippedShape]) -> usize {
    fn points(shape: &Shape) -> usize {
        match shape {
            Shape::Path(path) => path.points.len(),
            Shape::Vec(shapes) => shapes.iter().map(points).max().unwrap_or(0),
            _ => 0,
        }
    }
    shapes
        .iter()
        .map(|clipped| points(&clipped.shape))
        .max()
        .unwrap_or(0)
}

#[test]
fn velocities_are_seen_from_the_laboratory_and_from_the_drum() {
    let mut harness = Window::of(prepared());
    harness.get_by_label("Velocity map").click();
    harness.run_steps(12);
    // At time zero the grains rest while the drum turns at 0.209 rad/s, 20 to 21.5 mm from its
    // axis.
    harness.get_by_label("Velocity map, up to 0 m/s");
    harness.get_by_label("Relative to the drum").click();
    harness.run_steps(4);
    let map = harness.get_by_label_contains("Velocity map, up to 4.");
    let label = map.accesskit_node().label().unwrap_or_default();
    let number = label.trim_start_matches("Velocity map, up to ");
    let speed: f64 = number.trim_end_matches(" mm/s").parse().unwrap();
    assert!((4.18..4.51).contains(&speed), "{label}");
}

#[test]
fn mean_flow_of_a_recording_is_shown_or_offered_to_be_measured() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut scene = Scene::open("small-drum").unwrap();
    let values = [
        ("count", "60"),
        ("duration", "20ms"),
        ("output-interval", "10ms"),
    ];
    scene.set_all(&values).unwrap();
    runner::run(&Job::new("drum", scene, &out), &mut (), &|| false).unwrap();
    let open = || {
        let recording = Recording::open(&out).unwrap();
        let mut harness = Window::of(ready(Simulation::play_back(recording, standing())));
        harness.get_by_label("Flow over depth").click();
        harness.run_steps(12);
        harness
    };
    // So short a run writes none.
    let mut harness = open();
    harness.get_by_label("Measure it on the 3 states").click();
    harness.run_steps(2);
    assert_eq!(harness.state().asked[..], [Request::MeasureFlow]);
    let heads = flow_table().heads().join(",");
    let flow = format!("{heads}\n0.0,0.25,40,0.01\n0.001,0.2,39,NaN\n");
    std::fs::write(out.join(FLOW), flow).unwrap();
    open().get_by_label("Velocity along the surface [mm/s], over depth [mm]");
}

#[test]
fn a_panel_that_opens_scrolls_into_view_and_asks_to_export_its_plot() {
    let mut simulation = prepared();
    simulation.send(Command::Step(2000));
    let mut harness = Window::of(ready(simulation));
    harness.set_size(egui::vec2(1280.0, 640.0));
    harness.run_steps(4);
    harness.get_by_label("Any quantity").click();
    harness.run_steps(60);
    let export = harness.get_by_label("Export…");
    assert!(export.rect().bottom() < 640.0, "{:?}", export.rect());
    export.click();
    harness.run_steps(2);
    assert!(matches!(
        harness.state().asked[..],
        [Request::ExportPlot(_)]
    ));
}

#[test]
fn any_quantity_is_plotted_over_any_other_and_can_be_taken_home() {
    let mut harness = Window::of(with_samples());
    harness.get_by_label("Any quantity").click();
    harness.run_steps(10);
    harness.get_by_label_contains("Kinetic energy E_kin [µJ] over Time t [s], now ");
    harness
        .get_by_role_and_label(Role::ComboBox, "Over")
        .click();
    harness.run_steps(3);
    harness
        .get_by_role_and_label(Role::Button, "Coordination number Z")
        .click();
    harness.run_steps(5);
    harness.get_by_label_contains("Kinetic energy E_kin [µJ] over Coordination number Z, now ");
    harness.get_by_label("Export…").click();
    harness.run_steps(2);
    let asked = std::mem::take(&mut harness.state_mut().asked);
    let [Request::ExportPlot(export)] = &asked[..] else {
        panic!("{asked:?}");
    };
    let folder = tempfile::tempdir().unwrap();
    let samples = harness.state().simulation.series().len();
    let path = folder.path().join("plot.csv");
    export.write(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text.lines().count(), samples + 1);
    assert!(text.starts_with("run,time [s],coordination number [1],kinetic energy [J]\n"));
    let path = folder.path().join("plot.svg");
    export.write(&path).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("Coordination number Z") && text.contains("</svg>"));
}

#[test]
fn grains_without_a_bed_are_seen_by_their_energy() {
    let scene = Scene::open("two-grains").unwrap();
    let mut simulation = ready(Simulation::open(scene, standing()));
    carried_out(&mut simulation, Command::Step(2000));
    let harness = Window::of(simulation);
    harness.get_by_label("Kinetic energy E_kin [µJ] over Time t [s]");
    harness.get_by_label_contains("Where the energy is and went");
    assert!(harness.query_by_label("Surface angle θ [°]").is_none());
    let bed = Window::of(prepared());
    bed.get_by_label("Surface angle θ [°]");
    assert!(
        bed.query_by_label_contains("Where the energy is and went")
            .is_none()
    );
}

#[test]
fn energy_stands_as_a_stack_with_its_residual() {
    let mut harness = Window::of(with_samples());
    harness.get_by_label("Energy").click();
    harness.run_steps(10);
    harness.get_by_label("Energy over time");
    harness.get_by_label_contains("Dashpot loss D_d: ");
    // Here, and among the results.
    let residuals = harness.get_all_by_label("Energy residual ΔE").count();
    assert_eq!(residuals, 2);
}
