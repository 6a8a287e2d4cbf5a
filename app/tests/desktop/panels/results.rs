//! The panel of results: what stands there, and over which part of the run it is averaged.

use crate::window_of_panels::{Window, type_number, with_samples};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use grainfall::lab::SMALLEST_DROP;
use grainfall::measure::{Measure, ResultKey, Series, summarise};

/// The text of the value that the panel shows of `key`, averaged over these samples.
fn text(series: &Series, from: f64, until: f64, key: ResultKey) -> String {
    let mut part = Series::default();
    let count = series.time().partition_point(|time| *time <= until);
    part.copy_first(series, count);
    summarise(&part, from, SMALLEST_DROP).text(key)
}

fn is_told(harness: &Harness<'_, Window>, words: &str) -> bool {
    harness.query_all_by_label(words).next().is_some()
}

#[test]
fn the_share_of_flow_is_told_as_the_paper_takes_it_and_in_the_drum() {
    let harness = Window::of(with_samples());
    for frame in ["the paper's", "in the drum"] {
        let shares = harness.query_all_by_label_contains("Flowing share");
        let text = |node: egui_kittest::Node<'_>| node.accesskit_node().value();
        let texts: Vec<String> = shares.filter_map(text).collect();
        assert!(texts.iter().any(|text| text.contains(frame)), "{texts:?}");
    }
}

#[test]
fn averages_are_taken_over_the_span_that_is_chosen() {
    let mut harness = Window::of(with_samples());
    let series = harness.state().simulation.series().clone();
    let key = ResultKey::from(Measure::SurfaceAngle);
    let [whole, part] = [f64::INFINITY, 0.2].map(|until| text(&series, 0.1, until, key));
    assert_ne!(whole, part);
    type_number(&mut harness, "Averages from", "0.1");
    harness.run_steps(4);
    assert!(is_told(&harness, &whole) && !is_told(&harness, &part));
    type_number(&mut harness, "until", "0.2");
    harness.run_steps(4);
    assert!(is_told(&harness, &part) && !is_told(&harness, &whole));
    // A time that has not come: with the run again.
    type_number(&mut harness, "until", "99");
    harness.run_steps(4);
    assert!(is_told(&harness, &whole));
}
