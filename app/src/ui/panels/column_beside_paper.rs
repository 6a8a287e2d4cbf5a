//! The collapsing column beside the laws of Man et al. 2023: run-out, volume of the cone and time
//! to rest over the effective aspect ratio.
//!
//! In: the samples so far. Out: one point on each plot; it moves as the front does and stays where
//! the column comes to rest.

use crate::simulation::Simulation;
use crate::ui::panel::{Panel, is_column};
use crate::ui::panels::beside_paper::{PaperPlot, PaperPoint, comparison_ui, law_over};
use crate::ui::request::Request;
use crate::ui::words::number;
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use grainfall::lab::RunView;
use grainfall::measure::{
    CRITICAL_ASPECT_RATIO, Collapse, InitialColumn, REST_TIME_LAW, TALL_ASPECT_RATIO,
    TALL_REST_TIME_LAW, cone_volume_law, run_out_law,
};
use grainfall::run::{Command, Parameter};
use std::ops::RangeInclusive;

/// Effective aspect ratios in view, as powers of ten: 0.3 … 25.
const POWERS: RangeInclusive<f64> = -0.5..=1.4;
/// Room above the highest of what is in view, as a share of it.
const ROOM: f64 = 1.15;

/// The panel.
pub struct ColumnBesidePaper;

impl Panel for ColumnBesidePaper {
    fn title(&self) -> &'static str {
        "Beside the paper"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        is_column(simulation)
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let column = run.world().and_then(|world| InitialColumn::of(world));
        let collapse = Collapse::of(run.series());
        let Some((column, collapse)) = column.zip(collapse) else {
            ui.weak("The laws appear with the first sample.");
            return;
        };
        if let Some(time) = changed_in_fall(run) {
            let moment = number::moment(time);
            ui.weak(format!(
                "It was changed at {moment}, as it fell, and is no longer one column of the paper. \
                 Reset (R) lets it fall as it is now."
            ));
            return;
        }
        for comparison in comparisons(&column, &collapse) {
            comparison_ui(ui, comparison);
        }
        let effective = number::fixed(column.effective_aspect_ratio(), 2);
        let friction = number::fixed(column.particle_friction, 3);
        let state = match collapse.rest_time {
            Some(time) => format!("At rest since {}.", number::moment(time)),
            None => "Still moving.".into(),
        };
        let text = format!("α_eff {effective}, μ_p {friction}. {state}");
        ui.label(RichText::new(text).small().weak());
    }
}

/// When what the column is made of was changed after its start [s], if it was.
fn changed_in_fall(run: &RunView) -> Option<f64> {
    let matters = |command: &Command| match command {
        Command::Set { parameter, .. } => *parameter != Parameter::TimeStep,
        _ => false,
    };
    let mut commands = run.commands().iter();
    let change = commands.find(|stamped| stamped.step > 0 && matters(&stamped.command));
    change.map(|stamped| stamped.time)
}

fn comparisons(column: &InitialColumn, collapse: &Collapse) -> [PaperPlot; 3] {
    let effective = column.effective_aspect_ratio();
    let place = effective.log10();
    let comparison = |id, title, law_name, law: fn(f64) -> f64, value: Option<f64>| PaperPlot {
        id,
        title,
        law: law_over(POWERS, law),
        law_name,
        threshold: None,
        points: (value
            .map(|value| PaperPoint::alone(place, value))
            .into_iter())
        .collect(),
        x: POWERS,
        // The law's break is always in view.
        y: 0.0..=ROOM
            * law(CRITICAL_ASPECT_RATIO)
                .max(law(effective))
                .max(value.unwrap_or(0.0)),
    };
    [
        comparison(
            "run-out",
            "Run-out (R∞ − Ri)/Ri, over α_eff",
            "α_eff^1.35, α_eff^0.5 above 3.5",
            run_out_law,
            Some(column.run_out(collapse.front)),
        ),
        comparison(
            "cone volume",
            "V_cone/V_init, over α_eff",
            "Eq. 4.4",
            cone_volume_law,
            Some(column.cone_volume_ratio(collapse.front, collapse.height)),
        ),
        comparison(
            "rest time",
            "Time to rest T_f, over α_eff",
            "4.5 √α_eff below 3.5, 3.0 √α_eff above 13",
            rest_time_law,
            collapse.rest_time.map(|time| time / column.time_unit()),
        ),
    ]
}

/// `T_f` over the effective aspect ratio; the paper gives no law between 3.5 and 13.
fn rest_time_law(effective: f64) -> f64 {
    if effective <= CRITICAL_ASPECT_RATIO {
        REST_TIME_LAW * effective.sqrt()
    } else if effective >= TALL_ASPECT_RATIO {
        TALL_REST_TIME_LAW * effective.sqrt()
    } else {
        f64::NAN
    }
}
