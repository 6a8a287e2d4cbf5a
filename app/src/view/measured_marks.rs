//! What is measured, drawn where it is measured: the surface line with the protractor of its angle,
//! the front of a heap with its height and the circle on which the column stood.
//!
//! In: what is measured of the world shown, the camera. Out: egui shapes over the picture, and
//! which of them a point lies on.

use crate::view::camera::OrbitCamera;
use crate::view::ink::Ink;
use crate::view::measured::Measured;
use crate::view::scale::length;
use bevy::math::{DVec2, Vec3};
use bevy_egui::egui::{Align2, Color32, FontId, Pos2, Rect, Shape as Drawn, Stroke, vec2};
use grainfall::measure::{DepositOutline, Measure, SurfaceLine};
use grainfall::world::{Shape, World};
use std::f64::consts::TAU;

/// Distance of the protractor's arc from its corner, in lengths of the line.
const ARC: f64 = 0.6;
/// Marks on the arc: one for so many degrees, a longer one for twice as many.
const TICK_DEGREES: usize = 5;
/// Corners of a circle.
const CORNERS: usize = 144;
/// How near to a mark the pointer lies on it, in points.
const NEAR: f32 = 9.0;
/// Fronts closer than this to the column's radius at the start, over it, are not told from it.
const SPREAD: f64 = 1.08;
/// Widths of lines, in points: usually, and while their curve is under the pointer.
const WIDTHS: [f32; 2] = [2.2, 4.5];
/// Length of dashes and of the gaps between them, in points.
const DASHES: [f32; 2] = [6.0, 5.0];

/// A surface line and its angle as lines in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Protractor {
    /// The fitted line from its lower end to its upper one [m].
    pub line: [Vec3; 2],
    /// From the upper end, as long and level, over the bed [m].
    pub level: [Vec3; 2],
    /// Part of a circle about the upper end from the one to the other [m].
    pub arc: Vec<Vec3>,
    /// Marks on it, five degrees apart [m].
    pub ticks: Vec<[Vec3; 2]>,
}

impl Protractor {
    /// That of `surface` in the plane across the axis at `z` [m].
    pub fn of(surface: &SurfaceLine, z: f64) -> Self {
        let along = surface.half_length * surface.direction;
        let along = if along.y < 0.0 { -along } else { along };
        let corner = surface.midpoint + along;
        let whole = 2.0 * surface.half_length;
        // The line falls to the left of its corner, or to the right.
        let side = if along.x < 0.0 { -1.0 } else { 1.0 };
        let slope = (along.y / along.x).atan().abs();
        let at = |angle: f64, distance: f64| {
            let way = DVec2::new(-side * angle.cos(), -angle.sin());
            (corner + distance * way).extend(z).as_vec3()
        };
        let steps = (slope.to_degrees().ceil() as usize).max(1);
        let arc = (0..=steps).map(|k| at(slope * k as f64 / steps as f64, ARC * whole));
        let marks =
            (0..=slope.to_degrees() as usize).filter(|degree| degree.is_multiple_of(TICK_DEGREES));
        let tick = |degree: usize| {
            let is_long = degree.is_multiple_of(2 * TICK_DEGREES);
            let end = ARC + if is_long { 0.05 } else { 0.03 };
            [ARC, end].map(|share| at((degree as f64).to_radians(), share * whole))
        };
        Self {
            line: [surface.midpoint - along, corner].map(|x| x.extend(z).as_vec3()),
            level: [at(0.0, 0.0), at(0.0, whole)],
            arc: arc.collect(),
            ticks: marks.map(tick).collect(),
        }
    }
}

/// A mark in the picture: what it shows, and where it is.
pub(super) struct Mark {
    measure: Measure,
    points: Vec<Pos2>,
}

/// Draws what is `measured` of `world` into `rect`; what shows the measure that is `lit` stands out.
pub(super) fn draw(
    ink: &Ink,
    rect: Rect,
    camera: &OrbitCamera,
    (world, measured): (&World, &Measured),
    lit: Option<Measure>,
) -> Vec<Mark> {
    let mut sheet = Sheet {
        ink,
        rect,
        camera,
        lit,
        marks: Vec::new(),
    };
    if let Some(surface) = &measured.surface {
        let z = front_plane(world, camera);
        sheet.surface(surface, &Protractor::of(surface, z));
    }
    if let Some(deposit) = &measured.deposit {
        sheet.deposit(deposit);
    }
    sheet.marks
}

/// What the mark at `pointer` shows, where there is one.
pub(super) fn under(marks: &[Mark], pointer: Pos2) -> Option<Measure> {
    let distance = |mark: &Mark| {
        let pieces = mark.points.windows(2);
        let away = pieces.map(|ends| distance_to_piece(pointer, [ends[0], ends[1]]));
        away.fold(f32::INFINITY, f32::min)
    };
    let near = marks.iter().map(|mark| (mark.measure, distance(mark)));
    let near = near.filter(|(_, distance)| *distance < NEAR);
    near.min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(measure, _)| measure)
}

fn distance_to_piece(point: Pos2, [from, to]: [Pos2; 2]) -> f32 {
    let (way, away) = (to - from, point - from);
    let share = (away.dot(way) / way.length_sq().max(1e-9)).clamp(0.0, 1.0);
    (away - share * way).length()
}

/// Where the side of the container that faces the viewer cuts the z axis [m].
fn front_plane(world: &World, camera: &OrbitCamera) -> f64 {
    let (low, high) = match world.container.shape {
        Shape::Drum { width, .. } => (-0.5 * width, 0.5 * width),
        Shape::Box { min, max } | Shape::Mesh { min, max } => (min.z, max.z),
        Shape::Column { .. } | Shape::Planes => (0.0, 0.0),
    };
    let is_before = f64::from(camera.eye().z) >= 0.5 * (low + high);
    if is_before { high } else { low }
}

/// The picture while it is drawn on.
struct Sheet<'a> {
    ink: &'a Ink<'a>,
    rect: Rect,
    camera: &'a OrbitCamera,
    lit: Option<Measure>,
    marks: Vec<Mark>,
}

impl Sheet<'_> {
    fn place(&self, x: Vec3) -> Option<Pos2> {
        let (place, _) = self.camera.project(x)?;
        Some(self.rect.min + vec2(place.x, place.y))
    }

    fn places(&self, points: &[Vec3]) -> Vec<Pos2> {
        points.iter().filter_map(|x| self.place(*x)).collect()
    }

    fn width(&self, measure: Measure) -> f32 {
        WIDTHS[usize::from(self.lit == Some(measure))]
    }

    /// A line that shows `measure`.
    fn line(&mut self, measure: Measure, points: &[Vec3], width: f32) {
        let points = self.places(points);
        (self.ink).bold_line(points.clone(), width, self.ink.measured);
        self.marks.push(Mark { measure, points });
    }

    fn dashed(&self, points: &[Vec3], width: f32, colour: Color32) {
        let stroke = Stroke::new(width, colour);
        let points = self.places(points);
        let dashes = Drawn::dashed_line(&points, stroke, DASHES[0], DASHES[1]);
        self.ink.painter.extend(dashes);
    }

    fn label(&self, at: Vec3, (anchor, lift): (Align2, f32), text: &str, colour: Color32) {
        let Some(place) = self.place(at) else { return };
        let (font, lift) = (FontId::proportional(16.0), vec2(0.0, -lift));
        (self.ink).grounded(place + lift, anchor, text, font, colour, self.ink.veil);
    }

    fn surface(&mut self, surface: &SurfaceLine, protractor: &Protractor) {
        let (measure, colour) = (Measure::SurfaceAngle, self.ink.measured);
        let width = self.width(measure);
        self.dashed(&protractor.level, 0.6 * width, colour);
        self.line(measure, &protractor.line, width);
        self.line(measure, &protractor.arc, 0.7 * width);
        for tick in &protractor.ticks {
            let ends = self.places(tick);
            (self.ink).bold_line(ends, 0.5 * width, colour);
        }
        let over = protractor.arc[0];
        self.label(
            over,
            (Align2::CENTER_BOTTOM, 8.0),
            &value(measure, surface.angle),
            colour,
        );
    }

    fn deposit(&mut self, deposit: &DepositOutline) {
        let colour = self.ink.measured;
        let (front, height) = (Measure::FrontRadius, Measure::DepositHeight);
        let slope = deposit.height / deposit.front;
        self.sectors(deposit);
        self.circle(front, deposit.front, slope);
        // To the left before the heap: the distances of the rings stand to the right.
        let aside = self.azimuth(-0.5);
        let at = |radius: f64, azimuth: f64| on_floor(radius, azimuth);
        if deposit.front > SPREAD * deposit.initial_radius {
            let stood = circle(deposit.initial_radius, 0.0);
            self.dashed(&stood, WIDTHS[0], self.ink.mark);
            let text = format!(
                "here the column stood, R₀ = {}",
                length(deposit.initial_radius)
            );
            // Before the heap, beside the number of its front.
            let before = at(deposit.front, self.azimuth(0.0));
            self.label(before, (Align2::CENTER_TOP, -30.0), &text, self.ink.mark);
        }
        let text = value(front, deposit.front);
        self.label(
            at(deposit.front, aside),
            (Align2::RIGHT_TOP, -8.0),
            &text,
            colour,
        );
        let top = (deposit.height * glam::DVec3::Y).as_vec3();
        self.dashed(&[Vec3::ZERO, top], self.width(height), colour);
        self.line(
            height,
            &circle(deposit.middle, deposit.height),
            0.7 * self.width(height),
        );
        let text = value(height, deposit.height);
        self.label(top, (Align2::CENTER_BOTTOM, 18.0), &text, colour);
    }

    /// The farthest point in each sector, thin.
    fn sectors(&self, deposit: &DepositOutline) {
        let stroke = Stroke::new(0.5 * self.width(Measure::FrontRadius), self.ink.measured);
        let count = deposit.sectors.len() as f64;
        for (k, reach) in deposit
            .sectors
            .iter()
            .enumerate()
            .filter(|(_, r)| r.is_finite())
        {
            let ends = [0.0, 0.5, 1.0].map(|part| {
                let turn = (k as f64 + part) / count - 0.5;
                on_floor(*reach, TAU * turn)
            });
            let points = self.places(&ends);
            self.ink.painter.add(Drawn::line(points, stroke));
        }
    }

    /// A circle on the floor, dashed where a heap of this `slope` hides it.
    fn circle(&mut self, measure: Measure, radius: f64, slope: f64) {
        let width = self.width(measure);
        let eye = self.camera.eye();
        let is_seen = |x: &Vec3| {
            let outwards = Vec3::new(x.x, 0.0, x.z).normalize_or_zero();
            (slope as f32 * outwards + Vec3::Y).dot(eye - *x) > 0.0
        };
        let points = circle(radius, 0.0);
        for part in points.chunk_by(|a, b| is_seen(a) == is_seen(b)) {
            if is_seen(&part[0]) {
                self.line(measure, part, width);
            } else {
                self.dashed(part, 0.6 * width, self.ink.measured);
            }
        }
    }

    /// Azimuth of a point of the floor that lies before the axis, turned by `aside` to the right
    /// [rad].
    fn azimuth(&self, aside: f32) -> f64 {
        let (sin, cos) = (self.camera.yaw + aside).sin_cos();
        f64::from(cos).atan2(f64::from(sin))
    }
}

/// `θ = 24.31°`.
fn value(measure: Measure, value: f64) -> String {
    let quantity = measure.quantity();
    format!("{} = {}", quantity.symbol, quantity.text(value))
}

/// The point of the floor at this distance from the axis [m] and azimuth [rad].
fn on_floor(radius: f64, azimuth: f64) -> Vec3 {
    let (sin, cos) = azimuth.sin_cos();
    glam::DVec3::new(radius * cos, 0.0, radius * sin).as_vec3()
}

/// A closed circle about the axis at this height [m].
fn circle(radius: f64, height: f64) -> Vec<Vec3> {
    let turn = |k: usize| TAU * k as f64 / CORNERS as f64;
    let lifted = |k| on_floor(radius, turn(k)) + Vec3::Y * height as f32;
    (0..=CORNERS).map(lifted).collect()
}
