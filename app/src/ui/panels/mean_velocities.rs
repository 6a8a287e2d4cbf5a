//! The mean velocities in the cross-section: colours for the speed, arrows for the direction.
//!
//! In: the newest state. Out: its map ([`velocity_map`]) inside the outline of the container, seen
//! from the laboratory or from the turning drum.

use crate::simulation::Simulation;
use crate::ui::panel::Panel;
use crate::ui::request::Request;
use crate::ui::theme::Palette;
use crate::ui::words::number;
use crate::view::{ColourMap, ViewSettings, round_up};
use bevy_egui::egui::{self, Color32, Mesh, Pos2, Rect, RichText, Sense, Stroke, pos2, vec2};
use glam::DVec2;
use grainfall::measure::{VelocityMap, kernel_reach, velocity_map};
use grainfall::scene::SceneContainer;
use grainfall::world::{Shape, World};

/// The map is drawn no higher than this, in points.
const HIGHEST: f32 = 330.0;
/// Points of the map between two arrows.
const BETWEEN_ARROWS: usize = 3;
/// Smallest end of the colour scale [m/s], so that noise at rest stays dark.
const SMALLEST_RANGE: f64 = 1e-4;
/// The colour scale is kept while the largest speed is at least this share of its end.
const LEAST_FILLED: f64 = 0.4;

/// The panel of the velocity map.
#[derive(Default)]
pub struct MeanVelocities {
    /// Whether the drum's own turning is taken out.
    relative: bool,
    /// What the brightest colour means [m/s].
    range: f64,
    latest: Option<Drawn>,
}

/// A map with what it was made of.
struct Drawn {
    generation: u64,
    relative: bool,
    map: VelocityMap,
}

impl Panel for MeanVelocities {
    fn title(&self) -> &'static str {
        "Velocity map"
    }

    fn describes_one_run(&self) -> bool {
        true
    }

    fn applies_to(&self, simulation: &Simulation) -> bool {
        matches!(
            simulation.scene().container,
            SceneContainer::Drum { .. } | SceneContainer::Box { .. }
        )
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        _out: &mut Vec<Request>,
    ) {
        let run = simulation.half(view.focus);
        let Some(world) = run.world() else {
            ui.weak("The map appears when the bed stands.");
            return;
        };
        if matches!(world.container.shape, Shape::Drum { .. }) {
            ui.checkbox(&mut self.relative, "Relative to the drum")
                .on_hover_text("Takes out the drum's own turning: what rests in the drum is dark");
        }
        let room = Rect::from_min_size(ui.cursor().min, vec2(ui.available_width(), HIGHEST));
        // Out of sight it may be an old one.
        if self.latest.is_none() || ui.is_rect_visible(room) {
            self.renew(world, run.generation());
        }
        let Some(drawn) = &self.latest else {
            ui.weak("There are no grains.");
            return;
        };
        let fastest = drawn.map.largest_speed();
        if !(LEAST_FILLED * self.range..=self.range).contains(&fastest) {
            self.range = round_up(fastest.max(SMALLEST_RANGE));
        }
        map_ui(ui, world, &drawn.map, self.range, view.colour_map);
        scale_ui(ui, self.range, view.colour_map);
        let kernel = format!(
            "Means over grains within {} mm, near ones weighed more.",
            number::fixed(1e3 * kernel_reach(world), 0)
        );
        ui.label(RichText::new(kernel).small().weak());
    }
}

impl MeanVelocities {
    /// Makes the map of `world`, the state of this `generation`, unless it is the one that is kept.
    fn renew(&mut self, world: &World, generation: u64) {
        let suits =
            |drawn: &Drawn| drawn.generation == generation && drawn.relative == self.relative;
        if self.latest.as_ref().is_some_and(suits) {
            return;
        }
        let turning = if self.relative {
            world.container.drum_speed()
        } else {
            0.0
        };
        self.latest = velocity_map(world, turning).map(|map| Drawn {
            generation,
            relative: self.relative,
            map,
        });
    }
}

/// Lower left and upper right corner of the cross-section of a container [m].
fn bounds(shape: Shape) -> Option<(DVec2, DVec2)> {
    match shape {
        Shape::Drum { radius, .. } => Some((DVec2::splat(-radius), DVec2::splat(radius))),
        Shape::Box { min, max } => Some((min.truncate(), max.truncate())),
        _ => None,
    }
}

fn map_ui(ui: &mut egui::Ui, world: &World, map: &VelocityMap, range: f64, colours: ColourMap) {
    let Some((low, high)) = bounds(world.container.shape) else {
        return;
    };
    let size = (high - low).as_vec2();
    let per_metre = ((ui.available_width() - 14.0) / size.x).min(HIGHEST / size.y);
    let drawn = per_metre * vec2(size.x, size.y);
    let (room, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), drawn.y), Sense::hover());
    response.widget_info(|| {
        let text = format!("Velocity map, up to {}", speed(map.largest_speed()));
        egui::WidgetInfo::labeled(egui::WidgetType::Image, true, text)
    });
    let rect = Rect::from_center_size(room.center(), drawn);
    let place = |point: DVec2| {
        let own = (point - low).as_vec2() * per_metre;
        pos2(rect.left() + own.x, rect.bottom() - own.y)
    };
    let palette = Palette::of(ui.visuals());
    let painter = ui.painter_at(room);
    painter.add(coloured(map, range, colours, place));
    let outline = Stroke::new(1.5, palette.threshold);
    match world.container.shape {
        Shape::Drum { .. } => {
            painter.circle_stroke(rect.center(), 0.5 * rect.width() - 1.0, outline)
        }
        _ => painter.rect_stroke(rect, 0.0, outline, egui::StrokeKind::Inside),
    };
    let longest = map.spacing * BETWEEN_ARROWS as f64;
    for row in (0..map.rows()).step_by(BETWEEN_ARROWS) {
        for column in (0..map.columns).step_by(BETWEEN_ARROWS) {
            let Some(velocity) = map.at(column, row) else {
                continue;
            };
            let shaft = longest / range * velocity;
            let tail = map.point(column, row) - 0.5 * shaft;
            let (from, to) = (place(tail), place(tail + shaft));
            painter.arrow(from, to - from, Stroke::new(1.2, Color32::WHITE));
        }
    }
    if let Some(pointer) = response.hover_pos() {
        let own = (pointer - rect.left_bottom()) / per_metre;
        let point = low + DVec2::new(f64::from(own.x), -f64::from(own.y));
        if let Some(velocity) = nearest(map, point) {
            response.on_hover_text(speed(velocity.length()));
        }
    }
}

/// The velocity at the point of `map` that is nearest to `point`.
fn nearest(map: &VelocityMap, point: DVec2) -> Option<DVec2> {
    let own = ((point - map.corner) / map.spacing).round();
    (own.cmpge(DVec2::ZERO).all()).then(|| map.at(own.x as usize, own.y as usize))?
}

/// A mesh of the cells of `map`. A cell with a velocity at three of its corners is drawn as half.
fn coloured(
    map: &VelocityMap,
    range: f64,
    colours: ColourMap,
    place: impl Fn(DVec2) -> Pos2,
) -> Mesh {
    let mut mesh = Mesh::default();
    let mut vertex = Vec::with_capacity(map.velocity.len());
    for (index, velocity) in map.velocity.iter().enumerate() {
        vertex.push(velocity.map(|velocity| {
            let [r, g, b] = colours.colour(velocity.length() / range);
            let point = map.point(index % map.columns, index / map.columns);
            mesh.colored_vertex(place(point), Color32::from_rgb(r, g, b));
            mesh.vertices.len() as u32 - 1
        }));
    }
    for row in 1..map.rows() {
        for column in 1..map.columns {
            let at =
                |left: usize, below: usize| vertex[(row - below) * map.columns + column - left];
            let corners = [at(1, 1), at(0, 1), at(0, 0), at(1, 0)];
            let known: Vec<u32> = corners.into_iter().flatten().collect();
            for k in 2..known.len() {
                mesh.add_triangle(known[0], known[k - 1], known[k]);
            }
        }
    }
    mesh
}

/// What the colours mean.
fn scale_ui(ui: &mut egui::Ui, range: f64, colours: ColourMap) {
    const STEPS: u32 = 48;
    ui.horizontal(|ui| {
        ui.label("0");
        let end = speed(range);
        let width = (ui.available_width() - 9.0 * end.chars().count() as f32 - 20.0).max(40.0);
        let (rect, _) = ui.allocate_exact_size(vec2(width, 10.0), Sense::hover());
        let mut strip = Mesh::default();
        for k in 0..=STEPS {
            let share = k as f32 / STEPS as f32;
            let [r, g, b] = colours.colour(f64::from(share));
            let x = rect.left() + share * rect.width();
            for y in [rect.top(), rect.bottom()] {
                strip.colored_vertex(pos2(x, y), Color32::from_rgb(r, g, b));
            }
        }
        for k in 0..STEPS {
            strip.add_triangle(2 * k, 2 * k + 1, 2 * k + 2);
            strip.add_triangle(2 * k + 1, 2 * k + 3, 2 * k + 2);
        }
        ui.painter().add(strip);
        ui.label(end);
    });
}

/// A speed [m/s] with its unit.
fn speed(metres_per_second: f64) -> String {
    number::with_prefix(metres_per_second, "m/s")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two by two points a millimetre apart, one of them without a grain.
    fn corner_missing() -> VelocityMap {
        let moving = Some(DVec2::X);
        VelocityMap {
            time: 0.0,
            corner: DVec2::ZERO,
            spacing: 1e-3,
            columns: 2,
            velocity: vec![moving, moving, None, moving],
        }
    }

    #[test]
    fn cells_are_filled_as_far_as_their_corners_are_known() {
        let place = |point: DVec2| pos2(point.x as f32, point.y as f32);
        let mut map = corner_missing();
        let half = coloured(&map, 1.0, ColourMap::Viridis, place);
        assert_eq!((half.vertices.len(), half.indices.len()), (3, 3));
        map.velocity[2] = Some(DVec2::Y);
        let whole = coloured(&map, 1.0, ColourMap::Viridis, place);
        assert_eq!((whole.vertices.len(), whole.indices.len()), (4, 6));
        map.velocity[0] = None;
        map.velocity[1] = None;
        assert!(
            coloured(&map, 1.0, ColourMap::Viridis, place)
                .indices
                .is_empty()
        );
    }

    #[test]
    fn pointer_reads_the_nearest_point() {
        let map = corner_missing();
        assert_eq!(nearest(&map, DVec2::new(0.6e-3, 0.2e-3)), Some(DVec2::X));
        assert_eq!(nearest(&map, DVec2::new(0.1e-3, 0.9e-3)), None);
        assert_eq!(nearest(&map, DVec2::new(-0.8e-3, 0.0)), None);
    }
}
