//! What a sweep found: a result over the parameter with its errors, the paper's laws beside it, and
//! the way to each run.
//!
//! In: the sweep as it stands. Out: a plot that grows as runs are done, and requests to open one.

use crate::simulation::Simulation;
use crate::ui::panels::averages::Averages;
use crate::ui::plots::chart_plot::{PresentRun, chart_ui};
use crate::ui::request::{Request, SweepAct};
use crate::ui::sweep_desk::SweepSeen;
use crate::ui::widgets::combo::combo_ui;
use bevy_egui::egui::{self, RichText};
use grainfall::lab::RunView;
use grainfall::measure::{LEFT_OUT, Measure, ResultKey, RunQuantity};
use grainfall::sweep::chart::Plot;
use grainfall::sweep::{CaseResult, curve, figures, numbers, varied_number};
use std::sync::Arc;

/// What is shown first, where there is such a result.
const FIRST: [ResultKey; 4] = [
    ResultKey::OfRun(RunQuantity::RunOut),
    ResultKey::OfSamples(Measure::SurfaceAngle),
    ResultKey::OfSamples(Measure::MeanSpeed),
    ResultKey::OfSamples(Measure::CoordinationNumber),
];

/// What of the answer is shown.
#[derive(Default)]
pub struct Answer {
    chosen: Option<Shown>,
    made: Option<Made>,
    /// The value that was clicked on, in the unit that people read.
    clicked: Option<f64>,
    averages: Averages,
}

/// What a plot shows.
#[derive(Clone, Debug, PartialEq)]
enum Shown {
    /// A result over the parameter.
    Result(ResultKey),
    /// The figure of this name, in which a paper's laws are drawn.
    Figure(String),
}

/// The plot, what there is to choose, and the outcomes that they were made of.
struct Made {
    of: Arc<Vec<CaseResult>>,
    shown: Option<Shown>,
    keys: Vec<ResultKey>,
    figures: Vec<Plot>,
    plot: Option<Plot>,
}

impl Answer {
    /// Draws it.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        seen: &SweepSeen,
        simulation: &Simulation,
        out: &mut Vec<Request>,
    ) {
        if seen.standing.outcomes.is_empty() {
            return;
        }
        self.make(seen);
        let Some(made) = &self.made else {
            return;
        };
        let mut chosen = made.shown.clone();
        choice_ui(ui, made, &mut chosen);
        let clicked = made.plot.as_ref().and_then(|plot| {
            let present = match &made.shown {
                Some(Shown::Result(key)) => present(&mut self.averages, seen, simulation, *key),
                _ => None,
            };
            chart_ui(ui, plot, present)
        });
        let is_curve = matches!(made.shown, Some(Shown::Result(_)));
        if is_curve {
            self.clicked = clicked.and_then(|x| nearest(seen, x)).or(self.clicked);
        }
        self.chosen = chosen;
        self.runs_ui(ui, seen, out);
    }

    /// Makes the plot anew where runs were done since, or something else was chosen.
    fn make(&mut self, seen: &SweepSeen) {
        let (sweep, outcomes) = (&seen.sweep, &seen.standing.outcomes);
        let is_known = |made: &Made| Arc::ptr_eq(&made.of, outcomes) && made.shown == self.chosen;
        if self.made.as_ref().is_some_and(is_known) {
            return;
        }
        let keys = numbers(outcomes);
        let figures = figures(sweep, outcomes);
        let first = || FIRST.into_iter().find(|key| keys.contains(key));
        let first = || first().or(keys.first().copied()).map(Shown::Result);
        let is_there = |shown: &Shown| match shown {
            Shown::Result(key) => keys.contains(key),
            Shown::Figure(file) => figures.iter().any(|plot| plot.file == *file),
        };
        let shown = self.chosen.clone().filter(is_there).or_else(first);
        let plot = match &shown {
            Some(Shown::Result(key)) => curve(sweep, outcomes, *key),
            Some(Shown::Figure(file)) => figures.iter().find(|plot| plot.file == *file).cloned(),
            None => None,
        };
        self.chosen.clone_from(&shown);
        self.made = Some(Made {
            of: outcomes.clone(),
            shown,
            keys,
            figures,
            plot,
        });
    }

    /// The runs of the value that was clicked on.
    fn runs_ui(&self, ui: &mut egui::Ui, seen: &SweepSeen, out: &mut Vec<Request>) {
        let outcomes = seen.standing.outcomes.iter();
        let of_value = |own: &&CaseResult| {
            self.clicked.is_some() && varied_number(&seen.sweep, &own.case) == self.clicked
        };
        let chosen: Vec<&CaseResult> = outcomes.filter(of_value).collect();
        if chosen.is_empty() {
            ui.label(
                RichText::new("A click on a point leads to its run.")
                    .small()
                    .weak(),
            );
        }
        for outcome in chosen {
            let name = outcome.case.name.replace('_', ", ");
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new(&name).small());
                let button = ui.small_button("Open this run");
                let hint = "From time zero in this window, as it was run in the sweep";
                if button.on_hover_text(hint).clicked() {
                    out.push(Request::Sweep(SweepAct::Open(Box::new(
                        outcome.case.clone(),
                    ))));
                }
            });
        }
    }
}

fn choice_ui(ui: &mut egui::Ui, made: &Made, chosen: &mut Option<Shown>) {
    let name = match (chosen.as_ref(), &made.plot) {
        (Some(Shown::Result(key)), _) => key.label(),
        (Some(Shown::Figure(_)), Some(plot)) => plot.title.clone(),
        _ => String::new(),
    };
    combo_ui(ui, "Result", &name, |ui| {
        for key in &made.keys {
            let own = Some(Shown::Result(*key));
            ui.selectable_value(chosen, own, key.label())
                .on_hover_text(key.quantity().explanation());
        }
        if !made.figures.is_empty() {
            ui.separator();
            ui.weak("Beside the paper's laws");
        }
        for plot in &made.figures {
            let own = Some(Shown::Figure(plot.file.clone()));
            ui.selectable_value(chosen, own, &plot.title);
        }
    });
}

/// The value of a run that is nearest to `x` on the axis.
fn nearest(seen: &SweepSeen, x: f64) -> Option<f64> {
    let cases = seen.standing.outcomes.iter();
    let values = cases.filter_map(|own| varied_number(&seen.sweep, &own.case));
    let far = |value: f64| {
        if seen.question.values.by_powers && x > 0.0 && value > 0.0 {
            (value / x).ln().abs()
        } else {
            (value - x).abs()
        }
    };
    values.min_by(|a, b| far(*a).total_cmp(&far(*b)))
}

/// Where the run in the window stands, in the units of the plot of `key`.
fn present(
    averages: &mut Averages,
    seen: &SweepSeen,
    simulation: &RunView,
    key: ResultKey,
) -> Option<PresentRun> {
    if *simulation.scene() != seen.question.scene {
        return None;
    }
    let parameter = &seen.question.parameter;
    let value = simulation.value(parameter);
    let value = value.or_else(|| parameter.in_effect(simulation.scene()))?;
    let time = simulation.series().time().last().copied().unwrap_or(0.0);
    let own = averages.over(simulation, LEFT_OUT * time.floor());
    // A mean of a few samples is no result yet.
    let is_settled = own.estimate(key).is_none_or(|mean| mean.error.is_some());
    let factor = key.quantity().unit.shown.factor;
    Some(PresentRun {
        x: value.number() * parameter.row().kind.unit().shown.factor,
        y: own
            .value(key)
            .filter(|_| is_settled)
            .map(|own| own * factor),
    })
}
