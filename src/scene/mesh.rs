//! Walls from a file of triangles.
//!
//! In: an STL file, or triangles that a scene states itself. Out: a [`SceneMesh`], which holds the
//! triangles, so that a scene that was kept needs no file any more, and the smooth parts that grains
//! touch. What is no surface is refused where it is read.

use super::stored_cells::{PackingError, open_beside};
use crate::geometry::{
    LARGEST_STL, MeshFlaw, MeshPart, hit_triangle, open_edges, read_stl, smooth_parts,
};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// A surface of triangles.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Vec<[DVec3; 3]>", into = "Vec<[DVec3; 3]>")]
pub struct SceneMesh {
    triangles: Arc<[[DVec3; 3]]>,
    parts: Arc<[MeshPart]>,
}

/// How a mesh moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum MeshMotion {
    /// Not at all.
    #[default]
    Fixed,
    /// As one body about an axis.
    Turning {
        /// A point of the axis [m].
        through: DVec3,
        /// Direction of the axis (made a unit vector when read).
        axis: DVec3,
        /// Angular speed, positive anticlockwise seen against `axis` [rad/s].
        speed: f64,
    },
    /// Straight on.
    Moving {
        /// Its velocity [m/s].
        velocity: DVec3,
    },
}

/// Why a file is no mesh.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// It is not opened.
    #[error(transparent)]
    Closed(PackingError),
    /// It is no STL file.
    #[error("cannot be used: {0}")]
    NoStl(String),
    /// It holds no surface.
    #[error("holds no surface for grains: {0}")]
    Flaw(MeshFlaw),
}

impl SceneMesh {
    /// The surface of `triangles` [m].
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn new(triangles: Vec<[DVec3; 3]>) -> Result<Self, MeshFlaw> {
        Ok(Self {
            parts: smooth_parts(&triangles)?.into(),
            triangles: triangles.into(),
        })
    }

    /// The surface in the STL file that a scene in `folder` calls `name`, whose unit of length is
    /// `scale` [m].
    ///
    /// # Errors
    /// When it lies elsewhere than in that folder or below it, cannot be read, or holds no surface.
    pub fn beside(folder: &Path, name: &Path, scale: f64) -> Result<Self, MeshError> {
        let bytes = open_beside(folder, name, LARGEST_STL).map_err(MeshError::Closed)?;
        let mut triangles = read_stl(&bytes).map_err(MeshError::NoStl)?;
        for corner in triangles.iter_mut().flatten() {
            *corner *= scale;
        }
        Self::new(triangles).map_err(MeshError::Flaw)
    }

    /// Its triangles [m].
    pub fn triangles(&self) -> &[[DVec3; 3]] {
        &self.triangles
    }

    /// Its smooth parts.
    pub fn parts(&self) -> &[MeshPart] {
        &self.parts
    }

    /// Memory that it takes, once for all scenes and worlds that share it [bytes].
    pub fn memory(&self) -> usize {
        let parts = self.parts.iter().map(MeshPart::memory);
        size_of_val(&self.triangles[..]) + parts.sum::<usize>()
    }

    /// Lower and upper corner of the box round it [m].
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let corners = self.triangles.iter().flatten();
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), x| {
            (min.min(*x), max.max(*x))
        })
    }

    /// Edges at which it ends; none of a closed one.
    pub fn open_edges(&self) -> usize {
        // What was read is a surface.
        open_edges(&self.triangles).unwrap_or(usize::MAX)
    }

    /// Volume inside of it, if it is closed and all of its triangles are listed from the same side
    /// [m³].
    pub fn volume(&self) -> f64 {
        let middle = self.triangles[0][0];
        let parts = self.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|x| x - middle);
            a.dot(b.cross(c)) / 6.0
        });
        parts.sum::<f64>().abs()
    }

    /// The heights at which an upright line through `x` meets it [m].
    pub fn heights_at(&self, x: DVec3) -> Vec<f64> {
        // Below all that a scene takes.
        let below = DVec3::new(x.x, -2e4, x.z);
        let all = self.triangles.iter();
        let hits = all.filter_map(|triangle| hit_triangle(below, DVec3::Y, *triangle));
        hits.map(|way| below.y + way).collect()
    }

    /// Distance of `x` from it [m].
    pub fn distance(&self, x: DVec3) -> f64 {
        let nearest = self.parts.iter().filter_map(|part| part.nearest(x));
        let distances = nearest.map(|found| (found.point - x).length());
        distances.fold(f64::INFINITY, f64::min)
    }
}

impl PartialEq for SceneMesh {
    fn eq(&self, other: &Self) -> bool {
        self.triangles == other.triangles
    }
}

impl TryFrom<Vec<[DVec3; 3]>> for SceneMesh {
    type Error = MeshFlaw;

    fn try_from(triangles: Vec<[DVec3; 3]>) -> Result<Self, MeshFlaw> {
        Self::new(triangles)
    }
}

impl From<SceneMesh> for Vec<[DVec3; 3]> {
    fn from(mesh: SceneMesh) -> Self {
        mesh.triangles.to_vec()
    }
}
