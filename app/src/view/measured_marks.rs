//! What is measured, drawn where it is measured: the surface line with the protractor of its angle,
//! the front of a heap with its height and the circle on which the column stood, how far a drum has
//! turned.
//!
//! In: what is measured of the world shown. Out: egui shapes over the picture, on a [`Sheet`].

use crate::view::camera::OrbitCamera;
use crate::view::measured::{Measured, in_words};
use crate::view::scale::length;
use crate::view::sheet::{Mark, MarkKind, Sheet, WIDTHS};
use bevy::math::{DVec2, Vec3};
use bevy_egui::egui::{Align2, Shape as Drawn, Stroke};
use grainfall::measure::{DepositOutline, Measure, SurfaceLine};
use grainfall::world::{Shape, World};
use std::f64::consts::TAU;

/// Distance of the protractor's arc from its corner, in lengths of the line.
const ARC: f64 = 0.6;
/// Marks on the arc: one for so many degrees, a longer one for twice as many.
const TICK_DEGREES: usize = 5;
/// Where the drum's mark begins and ends, in its radii, and above where of it its label stands.
const MARK: [f64; 2] = [0.2, 1.045];
const BESIDE_MARK: f64 = 0.7;
/// Corners of a circle.
const CORNERS: usize = 144;
/// Fronts closer than this to the column's radius at the start, over it, are not told from it.
const SPREAD: f64 = 1.08;
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

/// Draws what is `measured` of `world`.
pub(super) fn draw(sheet: &mut Sheet, world: &World, measured: &Measured) {
    if let Some(surface) = &measured.surface {
        let z = front_plane(world, sheet.camera);
        sheet.surface(surface, &Protractor::of(surface, z));
    }
    if let Some(deposit) = &measured.deposit {
        sheet.deposit(deposit);
    }
    if let Shape::Drum { radius, .. } = world.container.shape {
        sheet.turn(world, radius);
    }
}

/// Where the side of the container that faces the viewer cuts the z axis [m].
pub(super) fn front_plane(world: &World, camera: &OrbitCamera) -> f64 {
    let (low, high) = match world.container.shape {
        Shape::Drum { width, .. } => (-0.5 * width, 0.5 * width),
        Shape::Box { min, max } | Shape::Mesh { min, max } => (min.z, max.z),
        Shape::Column { .. } | Shape::Planes => (0.0, 0.0),
    };
    let is_before = f64::from(camera.eye().z) >= 0.5 * (low + high);
    if is_before { high } else { low }
}

impl Sheet<'_> {
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
            &in_words(measure, surface.angle),
            colour,
        );
    }

    /// How far the drum has turned, beside the mark that turns with it.
    fn turn(&mut self, world: &World, radius: f64) {
        let angle = world.container.angle;
        let z = front_plane(world, self.camera);
        let way = DVec2::from_angle(angle);
        let at = |share: f64| (share * radius * way).extend(z).as_vec3();
        let points = self.places(&MARK.map(at));
        self.marks.push(Mark::new(MarkKind::DrumMark, points));
        let turns = angle.abs() / TAU;
        let text = if turns < 1.0 {
            format!("turned {:.0}°", angle.abs().to_degrees())
        } else {
            format!("turned {turns:.2} times")
        };
        let over = (Align2::CENTER_BOTTOM, 8.0);
        self.label(at(BESIDE_MARK), over, &text, self.ink.mark);
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
        let text = in_words(front, deposit.front);
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
        let text = in_words(height, deposit.height);
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
