//! The velocities in the cross-section of each case at its fastest moment, as in Fig. 4a–d of
//! Kasper et al. 2021: colours for the speed, arrows for the direction, the drum's rim.

use super::Sweep;
use super::case::CaseResult;
use crate::measure::VelocityMap;
use crate::output::write_file;
use crate::run::Provenance;
use crate::runner::RunnerError;
use crate::scene::SceneContainer;
use glam::DVec2;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

/// Size of a plot in pixels: what stands round the map leaves it as wide as it is high.
const SIZE: (u32, u32) = (704, 640);
const MARGIN: u32 = 14;
const CAPTION: u32 = 32;
const LABELS: u32 = 44;
/// Room for the colour bar on the right.
const BAR: u32 = 92;
/// Points of the map between two arrows.
const BETWEEN_ARROWS: usize = 3;

type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type DrawingResult = Result<(), Box<dyn std::error::Error>>;

/// Writes the plot of every case that ever flowed; returns the files' names.
///
/// # Errors
/// When a file cannot be written.
pub fn write_velocity_plots(
    sweep: &Sweep,
    outcomes: &[CaseResult],
) -> Result<Vec<String>, RunnerError> {
    let mut files = Vec::new();
    for outcome in outcomes {
        let Some(map) = &outcome.fastest else {
            continue;
        };
        let name = &outcome.case.name;
        let mut text = String::new();
        draw(&mut text, outcome, map).map_err(|reason| {
            RunnerError::Input(format!(
                "the velocities of {name} cannot be drawn: {reason}"
            ))
        })?;
        let file = format!("plots/velocity/{name}.svg");
        let path = sweep.out.join(&file);
        let text = Provenance::of_scene(&outcome.case.scene).in_svg(&text);
        write_file(&path, |file| file.write_all(text.as_bytes()))?;
        files.push(file);
    }
    Ok(files)
}

fn draw(text: &mut String, outcome: &CaseResult, map: &VelocityMap) -> DrawingResult {
    let area = SVGBackend::with_string(text, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let (maps, bar) = area.split_horizontally(SIZE.0 - BAR);
    let half = 1e3 * half_width(outcome, map);
    let title = format!("{}, t = {:.2} s", outcome.case.name, map.time);
    let mut chart = ChartBuilder::on(&maps)
        .caption(title, ("sans-serif", 18))
        .margin(MARGIN)
        .x_label_area_size(LABELS)
        .y_label_area_size(LABELS)
        .build_cartesian_2d(-half..half, -half..half)?;
    chart
        .configure_mesh()
        .disable_mesh()
        .x_desc("x [mm]")
        .y_desc("y [mm]")
        .label_style(("sans-serif", 14))
        .draw()?;
    let fastest = map.largest_speed().max(f64::MIN_POSITIVE);
    draw_speeds(&mut chart, map, fastest)?;
    draw_arrows(&mut chart, map, fastest)?;
    draw_rim(&mut chart, outcome)?;
    draw_bar(&bar, 1e3 * fastest)?;
    area.present()?;
    Ok(())
}

/// Half the width of what is shown [m]: the drum, or all points.
fn half_width(outcome: &CaseResult, map: &VelocityMap) -> f64 {
    let furthest = map.points().map(|(place, _)| place.abs().max_element());
    let rim = match outcome.case.scene.container {
        SceneContainer::Drum { radius, .. } => radius,
        _ => 0.0,
    };
    1.03 * furthest.fold(rim, f64::max)
}

fn draw_speeds(chart: &mut Chart, map: &VelocityMap, fastest: f64) -> DrawingResult {
    let half = DVec2::splat(0.5 * map.spacing);
    chart.draw_series(map.points().map(|(place, velocity)| {
        let fill = colour(velocity.length() / fastest).filled();
        Rectangle::new([pixel(place - half), pixel(place + half)], fill)
    }))?;
    Ok(())
}

/// Arrows whose lengths go with the speed, the longest as long as they stand apart.
fn draw_arrows(chart: &mut Chart, map: &VelocityMap, fastest: f64) -> DrawingResult {
    let length = map.spacing * BETWEEN_ARROWS as f64 / fastest;
    for row in (0..map.rows()).step_by(BETWEEN_ARROWS) {
        for column in (0..map.columns).step_by(BETWEEN_ARROWS) {
            let Some(velocity) = map.at(column, row) else {
                continue;
            };
            let shaft = length * velocity;
            let tip = map.point(column, row) + 0.5 * shaft;
            let barb = |side: f64| tip - 0.3 * shaft + side * 0.15 * shaft.perp();
            let ink = BLACK.stroke_width(1);
            let lines = [vec![tip - shaft, tip], vec![barb(1.0), tip, barb(-1.0)]];
            chart.draw_series(lines.into_iter().map(|line| {
                PathElement::new(line.into_iter().map(pixel).collect::<Vec<_>>(), ink)
            }))?;
        }
    }
    Ok(())
}

fn draw_rim(chart: &mut Chart, outcome: &CaseResult) -> DrawingResult {
    if let SceneContainer::Drum { radius, .. } = outcome.case.scene.container {
        let place = |k: i32| pixel(radius * DVec2::from_angle(f64::from(k).to_radians()));
        let rim: Vec<_> = (0..=360).map(place).collect();
        chart.draw_series([PathElement::new(rim, BLACK.stroke_width(2))])?;
    }
    Ok(())
}

/// What the colours mean, up to `fastest` [mm/s].
fn draw_bar(area: &DrawingArea<SVGBackend, plotters::coord::Shift>, fastest: f64) -> DrawingResult {
    let mut bar = ChartBuilder::on(area)
        .margin(MARGIN)
        .margin_top(MARGIN + CAPTION)
        .margin_bottom(MARGIN + LABELS)
        .right_y_label_area_size(LABELS + 8)
        .build_cartesian_2d(0.0..1.0, 0.0..fastest)?;
    let step = fastest / 64.0;
    bar.draw_series((0..64).map(|k| {
        let low = f64::from(k) * step;
        let fill = colour(low / fastest).filled();
        Rectangle::new([(0.0, low), (1.0, low + step)], fill)
    }))?;
    bar.configure_mesh()
        .disable_mesh()
        .disable_x_axis()
        .y_desc("speed [mm/s]")
        .label_style(("sans-serif", 14))
        .draw()?;
    Ok(())
}

/// Where a point stands on axes in millimetres.
fn pixel(place: DVec2) -> (f64, f64) {
    (1e3 * place.x, 1e3 * place.y)
}

/// The colour of a share of the largest speed.
fn colour(share: f64) -> RGBColor {
    let colorous::Color { r, g, b } = colorous::VIRIDIS.eval_continuous(share.clamp(0.0, 1.0));
    RGBColor(r, g, b)
}
