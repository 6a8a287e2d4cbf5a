//! Walls as triangles, for engines whose moving walls are meshes.
//!
//! In: a drum's rim, a plane, or the triangles of a mesh. Out: an STL file in text, in metres. The facets of a rim lie
//! between its circle and the chords such that their mean distance from the axis is the radius;
//! a plane is a square.

use glam::DVec3;
use std::f64::consts::PI;
use std::io::{self, Write};

/// A mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct WallMesh {
    /// What its fix and its file are called.
    pub name: String,
    triangles: Vec<[DVec3; 3]>,
}

impl WallMesh {
    /// The inside of a cylinder about the z axis of this `radius` and half width [m], of so many
    /// flat `facets`.
    pub fn rim(name: &str, radius: f64, half_width: f64, facets: usize) -> Self {
        let step = 2.0 * PI / facets as f64;
        // With half a step h, a facet stands R (1 − h²/6) from the axis: then the gap of a grain near
        // it is in the mean that to the circle. Its ends stand h²/2 farther out.
        let half = 0.5 * step;
        let ends = radius * (1.0 + half * half / 3.0);
        let corner = |index: usize, z: f64| {
            let angle = index as f64 * step;
            DVec3::new(ends * angle.cos(), ends * angle.sin(), z)
        };
        let triangles = (0..facets).flat_map(|index| {
            let next = (index + 1) % facets;
            let [a, b] = [index, next].map(|index| corner(index, -half_width));
            let [c, d] = [next, index].map(|index| corner(index, half_width));
            // Their normals point to the axis.
            [[a, d, c], [a, c, b]]
        });
        Self {
            name: name.to_owned(),
            triangles: triangles.collect(),
        }
    }

    /// These triangles [m].
    pub fn of_triangles(name: &str, triangles: Vec<[DVec3; 3]>) -> Self {
        Self {
            name: name.to_owned(),
            triangles,
        }
    }

    /// A square about `centre` with this unit `normal` and half edge [m].
    pub fn square(name: &str, centre: DVec3, normal: DVec3, half_edge: f64) -> Self {
        let (u, v) = normal.any_orthonormal_pair();
        let corner = |a: f64, b: f64| centre + half_edge * (a * u + b * v);
        let corners = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        let [a, b, c, d] = corners;
        Self {
            name: name.to_owned(),
            triangles: vec![[a, b, c], [a, c, d]],
        }
    }

    /// Its triangles.
    pub fn triangles(&self) -> &[[DVec3; 3]] {
        &self.triangles
    }

    /// Writes it to `file` as STL.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        writeln!(file, "solid {}", self.name)?;
        for [a, b, c] in &self.triangles {
            let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
            writeln!(file, "facet normal {}", words(normal))?;
            writeln!(file, " outer loop")?;
            for corner in [a, b, c] {
                writeln!(file, "  vertex {}", words(*corner))?;
            }
            writeln!(file, " endloop\nendfacet")?;
        }
        writeln!(file, "endsolid {}", self.name)
    }
}

fn words(vector: DVec3) -> String {
    format!("{:e} {:e} {:e}", vector.x, vector.y, vector.z)
}
