//! What goes on inside a bed, drawn on the side that faces the viewer: the flowing layer with its
//! mean velocities, and the granular temperature of each cell as a veil.
//!
//! In: the mean flow and the temperatures of the world shown. Out: egui shapes over the picture.

use crate::view::measured_marks::front_plane;
use crate::view::scale::length;
use crate::view::sheet::{Mark, MarkKind, Sheet, WIDTHS};
use crate::view::view_settings::{ColourMap, Legend};
use bevy::math::{DVec2, Vec3};
use bevy_egui::egui::{Align2, Mesh, Shape as Drawn};
use grainfall::measure::{MeanFlow, SurfaceLine, TemperatureMap};
use grainfall::world::{Shape, World};

/// Half the length of the line below the flowing layer, in that of the surface line.
const REACH: f64 = 0.6;
/// Length of the longest arrow, in half that line.
const LONGEST: f64 = 0.8;
/// Distance between arrows [depths of the profile].
const ARROW_STEP: usize = 4;
/// Opacity of what fills the layer, and of the veil.
const FILLED: f32 = 0.16;
const VEILED: f32 = 0.62;
/// The veil's colours: none of grains.
const MAP: ColourMap = ColourMap::Magma;

/// The flowing layer as lines in space.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowLines {
    /// Depth of the layer [m].
    pub depth: f64,
    /// Along the surface over the layer, and along its lower end [m].
    pub edges: [[Vec3; 2]; 2],
    /// From the middle of the surface to the lower end [m].
    pub bracket: [Vec3; 2],
    /// The mean velocity at some depths, from the bracket on [m].
    pub arrows: Vec<[Vec3; 2]>,
}

impl FlowLines {
    /// Those of the mean `flow` below `surface`, in the plane across the axis at `z` [m]; none where
    /// no layer flows.
    pub fn of(surface: &SurfaceLine, flow: &MeanFlow, z: f64) -> Option<Self> {
        let depth = flow.layer_depth()?;
        let at = |along: f64, below: f64| {
            let x = surface.midpoint + along * surface.direction - below * surface.normal();
            x.extend(z).as_vec3()
        };
        let half = REACH * surface.half_length;
        let known = flow.depths.iter().filter(|own| own.samples > 0);
        let fastest = (known.clone()).fold(0.0_f64, |most, own| most.max(own.velocity.abs()));
        let scale = LONGEST * half / fastest;
        // As far below the layer as it is deep: there the bed turns with the drum.
        let shown = known.step_by(ARROW_STEP);
        let shown = shown.take_while(|own| own.depth < 2.0 * depth);
        Some(Self {
            depth,
            edges: [0.0, depth].map(|below| [-half, half].map(|along| at(along, below))),
            bracket: [0.0, depth].map(|below| at(0.0, below)),
            arrows: shown
                .map(|own| [0.0, scale * own.velocity].map(|along| at(along, own.depth)))
                .collect(),
        })
    }
}

/// Draws the flowing layer of `world`.
pub(super) fn draw_flow(sheet: &mut Sheet, world: &World, surface: &SurfaceLine, flow: &MeanFlow) {
    let z = front_plane(world, sheet.camera);
    let Some(lines) = FlowLines::of(surface, flow, z) else {
        return;
    };
    let (ink, width) = (sheet.ink, WIDTHS[0]);
    let [upper, lower] = lines.edges.map(|edge| sheet.places(&edge));
    let corners = upper.iter().chain(lower.iter().rev()).copied().collect();
    let fill = ink.measured.gamma_multiply(FILLED);
    let filled = Drawn::convex_polygon(corners, fill, bevy_egui::egui::Stroke::NONE);
    ink.painter.add(filled);
    sheet.dashed(&lines.edges[1], width, ink.measured);
    let bracket = sheet.places(&lines.bracket);
    ink.bold_line(bracket.clone(), width, ink.measured);
    for arrow in &lines.arrows {
        sheet.arrow(arrow, 0.8 * width, ink.text);
    }
    for points in [lower, bracket] {
        sheet.marks.push(Mark::new(MarkKind::Layer, points));
    }
    let text = format!("flowing layer {}", length(lines.depth));
    let [left, right] = lines.edges[1];
    // At the lower end, where the bed has room below it.
    let end = if left.y < right.y { left } else { right };
    sheet.label(end, (Align2::CENTER_TOP, -6.0), &text, ink.measured);
}

/// The colours of the veil.
pub(super) fn veil_map() -> ColourMap {
    MAP
}

/// Draws the temperatures of `map` in `world` as `legend` says.
pub(super) fn draw_veil(sheet: &Sheet, world: &World, map: &TemperatureMap, legend: &Legend) {
    let z = front_plane(world, sheet.camera);
    let mut mesh = Mesh::default();
    for (corner, temperature) in map.cells() {
        let [r, g, b] = MAP.colour(legend.share(temperature));
        let colour = bevy_egui::egui::Color32::from_rgb(r, g, b).gamma_multiply(VEILED);
        let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        // Cells end where the drum does.
        let inside = |x: DVec2| match world.container.shape {
            Shape::Drum { radius, .. } => x.clamp_length_max(radius),
            _ => x,
        };
        let corners = corners.map(|own| inside(corner + map.spacing * own).extend(z).as_vec3());
        let places = sheet.places(&corners);
        if places.len() == corners.len() {
            let first = mesh.vertices.len() as u32;
            for place in places {
                mesh.colored_vertex(place, colour);
            }
            mesh.add_triangle(first, first + 1, first + 2);
            mesh.add_triangle(first, first + 2, first + 3);
        }
    }
    sheet.ink.painter.add(Drawn::mesh(mesh));
}
