//! Which part of the run a plot over time shows, and the moment that a click on it means.
//!
//! In: the times of the samples, what the pointer does. Out: a range of time [s].

use bevy_egui::egui;
use grainfall::measure::Avalanche;
use std::ops::RangeInclusive;

/// Length of the window that follows the run [s].
const RECENT: f64 = 20.0;
/// Shortest window that one can zoom to [s].
const SHORTEST: f64 = 0.2;
/// A click this near to the start of an avalanche selects that start, in points.
const NEAR: f64 = 7.0;

/// Which part of the run is in view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeWindow {
    /// The last [`RECENT`] seconds.
    Recent,
    /// All of it.
    All,
    /// What a person dragged and zoomed to [s].
    Chosen(f64, f64),
}

impl TimeWindow {
    /// The buttons that choose it.
    pub fn choice_ui(&mut self, ui: &mut egui::Ui) {
        ui.selectable_value(self, Self::Recent, "Last 20 s")
            .on_hover_text("Follow the run");
        ui.selectable_value(self, Self::All, "All")
            .on_hover_text("From the start on");
        if matches!(self, Self::Chosen(..)) {
            ui.weak("double click to follow");
        }
    }

    /// The part of the run in view [s]: where it follows the run, the moment `shown` is in it.
    pub fn window(self, time: &[f64], shown: Option<f64>) -> RangeInclusive<f64> {
        let start = time.first().copied().unwrap_or(0.0);
        let end = time.last().copied().unwrap_or(0.0);
        let in_view = |shown: f64| end.min(shown + 0.5 * RECENT);
        let recent = shown.map_or(end, in_view);
        match self {
            Self::Recent => (recent - RECENT).max(start)..=recent.max(start + RECENT),
            Self::All => start..=end.max(start + 1.0),
            Self::Chosen(from, to) => from..=to,
        }
    }

    /// Lets the pointer move what is in view: drag to shift, Ctrl and scroll or pinch to zoom,
    /// double click to follow the run again.
    pub fn follow_pointer(&mut self, response: &egui::Response, window: &RangeInclusive<f64>) {
        let (from, to) = (*window.start(), *window.end());
        let per_point = (to - from) / f64::from(response.rect.width().max(1.0));
        if response.double_clicked() {
            *self = Self::Recent;
        } else if response.dragged() && response.drag_delta().x != 0.0 {
            let shift = -f64::from(response.drag_delta().x) * per_point;
            *self = Self::Chosen(from + shift, to + shift);
        }
        let zoom = f64::from(response.ctx.input(egui::InputState::zoom_delta));
        if let Some(pointer) = response.hover_pos().filter(|_| zoom != 1.0) {
            let at = from + f64::from(pointer.x - response.rect.left()) * per_point;
            let zoom = zoom.min((to - from) / SHORTEST);
            *self = Self::Chosen(at - (at - from) / zoom, at + (to - at) / zoom);
        }
    }
}

/// The time that was clicked on [s].
pub fn clicked_time(response: &egui::Response, window: &RangeInclusive<f64>) -> Option<f64> {
    let pointer = response
        .interact_pointer_pos()
        .filter(|_| response.clicked())?;
    let from_left = f64::from(pointer.x - response.rect.left());
    Some(window.start() + from_left * per_point(response, window))
}

/// Time per point of a plot's width [s].
pub fn per_point(response: &egui::Response, window: &RangeInclusive<f64>) -> f64 {
    (window.end() - window.start()) / f64::from(response.rect.width().max(1.0))
}

/// The start of the nearest avalanche where that is within [`NEAR`] points of `time` [s], else
/// `time`. A point of the plot is `per_point` [s] wide.
pub fn near_start(avalanches: &[Avalanche], time: f64, per_point: f64) -> f64 {
    let reach = NEAR * per_point;
    let starts = avalanches.iter().map(|avalanche| avalanche.start);
    let near = starts.filter(|start| (start - time).abs() < reach);
    let nearest = near.min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()));
    nearest.unwrap_or(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_recent_window_follows_the_run_and_starts_with_full_length() {
        assert_eq!(TimeWindow::Recent.window(&[0.0, 3.0], None), 0.0..=20.0);
        assert_eq!(TimeWindow::Recent.window(&[0.0, 50.0], None), 30.0..=50.0);
        let around = TimeWindow::Recent.window(&[0.0, 50.0], Some(25.0));
        assert_eq!(around, 15.0..=35.0);
    }
}
