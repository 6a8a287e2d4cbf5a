//! The meshes that walls are drawn with: discs, rims, hoops, tubes, the edges of a box.
//!
//! In: lengths [m]. Out: meshes whose panes face inwards.

use crate::view::framing::{HOOP_BREADTH, corners};
use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use std::f32::consts::TAU;

/// Segments of a circle.
const SEGMENTS: u32 = 180;

/// The inside of an upright cylinder between two heights.
pub(super) fn tube(radius: f32, low: f32, high: f32) -> Mesh {
    band(|sin, cos, end| {
        let y = if end == 0 { low } else { high };
        (
            Vec3::new(radius * cos, y, -radius * sin),
            Vec3::new(-cos, 0.0, sin),
        )
    })
}

/// A disc at `z` whose normal along z is `facing`.
pub(super) fn disc(radius: f32, z: f32, facing: f32) -> Mesh {
    let mut builder = Builder::default();
    let normal = Vec3::Z * facing;
    builder.vertex(Vec3::Z * z, normal, [0.0, 0.0]);
    for i in 0..=SEGMENTS {
        let (sin, cos) = (TAU * i as f32 / SEGMENTS as f32).sin_cos();
        builder.vertex(Vec3::new(radius * cos, radius * sin, z), normal, [cos, sin]);
    }
    for i in 1..=SEGMENTS {
        let outer = if facing > 0.0 { [i, i + 1] } else { [i + 1, i] };
        builder.indices.extend([0, outer[0], outer[1]]);
    }
    builder.mesh()
}

/// The inside of a cylinder from −`half` to `half`.
pub(super) fn rim(radius: f32, half: f32) -> Mesh {
    band(|sin, cos, end| {
        let z = if end == 0 { -half } else { half };
        (
            Vec3::new(radius * cos, radius * sin, z),
            -Vec3::new(cos, sin, 0.0),
        )
    })
}

/// A flat hoop round a circle at `z`.
pub(super) fn ring(radius: f32, z: f32) -> Mesh {
    band(|sin, cos, end| {
        let radius = radius * (1.0 + HOOP_BREADTH * end as f32);
        (
            Vec3::new(radius * cos, radius * sin, z),
            Vec3::Z * z.signum(),
        )
    })
}

/// A closed band; `vertex` gives place and normal of each of its two ends at an azimuth.
fn band(vertex: impl Fn(f32, f32, u32) -> (Vec3, Vec3)) -> Mesh {
    let mut builder = Builder::default();
    for i in 0..=SEGMENTS {
        let turn = i as f32 / SEGMENTS as f32;
        let (sin, cos) = (TAU * turn).sin_cos();
        for end in 0..2 {
            let (place, normal) = vertex(sin, cos, end);
            builder.vertex(place, normal, [turn, end as f32]);
        }
    }
    for i in 0..SEGMENTS {
        let first = 2 * i;
        builder
            .indices
            .extend([first, first + 1, first + 2, first + 2, first + 1, first + 3]);
    }
    builder.mesh()
}

/// The twelve edges of a box as lines.
pub(super) fn edges(min: Vec3, max: Vec3) -> Mesh {
    let corners = corners(min, max);
    let mut builder = Builder::default();
    for corner in corners {
        builder.vertex(corner, Vec3::Y, [0.0, 0.0]);
    }
    for a in 0..8_u32 {
        let higher = (0..3).map(|axis| a | 1 << axis).filter(|b| *b != a);
        builder.indices.extend(higher.flat_map(|b| [a, b]));
    }
    builder.mesh_of(PrimitiveTopology::LineList)
}

/// Collects a mesh.
#[derive(Default)]
pub(super) struct Builder {
    places: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<[f32; 2]>,
    pub(super) indices: Vec<u32>,
}

impl Builder {
    pub(super) fn vertex(&mut self, place: Vec3, normal: Vec3, uv: [f32; 2]) {
        self.places.push(place);
        self.normals.push(normal);
        self.uvs.push(uv);
    }

    pub(super) fn mesh(self) -> Mesh {
        self.mesh_of(PrimitiveTopology::TriangleList)
    }

    pub(super) fn mesh_of(self, topology: PrimitiveTopology) -> Mesh {
        Mesh::new(topology, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.places)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, self.uvs)
            .with_inserted_indices(Indices::U32(self.indices))
    }
}
