//! A smooth part of a surface of triangles, which a grain touches at one place.
//!
//! In: its triangles, and where its edges and corners are contacts of its own (`smooth_parts` tells).
//! Out: the point of it that is nearest to a point, and whether that is a contact.
//!
//! The nearest point of a part is its contact: whatever number of triangles meet there, it is one,
//! and it goes from triangle to triangle as the grain slides or rolls over them. Triangles are found
//! by a tree in the part's own frame, which never changes: a wall that moves costs a rotation of the
//! point. Both sides of a triangle are alike.

use super::triangle::{Region, hit_triangle, nearest_on_triangle};
use glam::DVec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

/// Least height of a triangle over its longest edge.
const THINNEST: f64 = 1e-6;
/// Most triangles of a leaf of a tree.
const LEAF: usize = 4;
/// Most triangles of a mesh.
pub const MOST_TRIANGLES: usize = 20_000;

/// Marks an edge or a corner that is a contact wherever it is nearest.
pub(super) const OPEN: u32 = u32::MAX;
/// Marks one that belongs to another part.
pub(super) const SHUT: u32 = u32::MAX - 1;

/// A smooth part of a mesh; its clones share what it holds.
#[derive(Clone, Debug)]
pub struct MeshPart(Arc<Searched>);

/// A part and the tree by which it is searched.
#[derive(Debug)]
struct Searched {
    stored: Stored,
    tree: Vec<Node>,
}

/// What a part is made of; the tree follows from it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Stored {
    /// Its triangles [m].
    pub triangles: Vec<[DVec3; 3]>,
    /// When the edges of each are contacts of this part: always, never, or through a gate.
    pub edges: Vec<[u32; 3]>,
    /// The same of the corners.
    pub corners: Vec<[u32; 3]>,
    /// Directions in which triangles of other parts lie from an edge or a corner: it is a contact
    /// where none of them leads towards the grain.
    pub gates: Vec<Vec<DVec3>>,
}

/// A box round triangles, or round two boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// The first triangle and their number, or the second child and none: the first one follows.
    first: u32,
    count: u32,
}

/// The point of a part nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestOnPart {
    /// Where it is [m].
    pub point: DVec3,
    /// A unit vector across the triangle.
    pub normal: DVec3,
    /// Whether it is a contact of this part.
    pub is_own: bool,
}

/// Whether a triangle has no area, or next to none.
pub(super) fn is_thin([a, b, c]: &[DVec3; 3]) -> bool {
    let longest = (*b - *a)
        .length()
        .max((*c - *b).length())
        .max((*a - *c).length());
    let doubled = (*b - *a).cross(*c - *a).length();
    doubled.is_nan() || doubled <= THINNEST * longest * longest
}

impl PartialEq for MeshPart {
    fn eq(&self, other: &Self) -> bool {
        self.is_same(other) || self.0.stored == other.0.stored
    }
}

impl Serialize for MeshPart {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.stored.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for MeshPart {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Stored::deserialize(deserializer).map(Self::from)
    }
}

impl From<Stored> for MeshPart {
    fn from(mut stored: Stored) -> Self {
        // As many of each as there are triangles, whoever wrote them.
        let count = stored
            .triangles
            .len()
            .min(stored.edges.len())
            .min(stored.corners.len());
        let mut order: Vec<usize> = (0..count).collect();
        let mut tree = Vec::new();
        grow(&stored.triangles, &mut order, 0, &mut tree);
        stored = Stored {
            triangles: order.iter().map(|t| stored.triangles[*t]).collect(),
            edges: order.iter().map(|t| stored.edges[*t]).collect(),
            corners: order.iter().map(|t| stored.corners[*t]).collect(),
            gates: stored.gates,
        };
        Self(Arc::new(Searched { stored, tree }))
    }
}

/// Adds the tree of the triangles `order`, of which the first stands at `start`, and sorts them.
fn grow(triangles: &[[DVec3; 3]], order: &mut [usize], start: usize, tree: &mut Vec<Node>) {
    let corners = order.iter().flat_map(|t| triangles[*t]);
    let (low, high) = corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    if order.is_empty() {
        return;
    }
    let place = tree.len();
    let (first, count) = (start as u32, order.len() as u32);
    tree.push(Node {
        low,
        high,
        first,
        count,
    });
    if order.len() <= LEAF {
        return;
    }
    let size = (high - low).to_array();
    let axis = (0..3).fold(
        0,
        |best, axis| if size[axis] > size[best] { axis } else { best },
    );
    let middle = |t: &usize| {
        let [a, b, c] = triangles[*t];
        (a + b + c).to_array()[axis]
    };
    order.sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
    let half = order.len() / 2;
    let (left, right) = order.split_at_mut(half);
    grow(triangles, left, start, tree);
    let second = tree.len() as u32;
    grow(triangles, right, start + half, tree);
    tree[place].first = second;
    tree[place].count = 0;
}

impl Node {
    /// Square of the distance of `x` from the box [m²].
    fn distance_squared(&self, x: DVec3) -> f64 {
        (x - x.clamp(self.low, self.high)).length_squared()
    }
}

impl MeshPart {
    /// Its triangles [m].
    pub fn triangles(&self) -> &[[DVec3; 3]] {
        &self.0.stored.triangles
    }

    /// Whether the two share what they hold.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Memory that it takes, once for all clones [bytes].
    pub fn memory(&self) -> usize {
        let Searched { stored, tree } = &*self.0;
        let gates = stored.gates.iter().map(|gate| size_of_val(&gate[..]));
        size_of_val(&stored.triangles[..])
            + size_of_val(&stored.edges[..])
            + size_of_val(&stored.corners[..])
            + gates.sum::<usize>()
            + size_of_val(&tree[..])
    }

    /// Whether a world can hold it.
    pub fn is_sound(&self) -> bool {
        let stored = &self.0.stored;
        let exists = |&gate: &u32| gate >= SHUT || (gate as usize) < stored.gates.len();
        !stored.triangles.is_empty()
            && stored.triangles.len() <= MOST_TRIANGLES
            && stored.triangles.iter().flatten().all(|x| x.is_finite())
            && !stored.triangles.iter().any(is_thin)
            && stored
                .edges
                .iter()
                .chain(&stored.corners)
                .flatten()
                .all(exists)
            && stored.gates.iter().flatten().all(|x| x.is_finite())
    }

    /// How far from `origin` a ray along the unit vector `direction` first hits it [m]; none where it
    /// passes it.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let all = self.0.stored.triangles.iter();
        let hits = all.filter_map(|triangle| hit_triangle(origin, direction, *triangle));
        hits.min_by(f64::total_cmp)
    }

    /// The point of it nearest to `x`; of several the one on the first triangle. None of a part
    /// without triangles.
    pub fn nearest(&self, x: DVec3) -> Option<NearestOnPart> {
        let mut best = (f64::INFINITY, u32::MAX, DVec3::ZERO, Region::Face);
        let mut waiting = [0_u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let place = waiting[depth];
            let node = self.0.tree.get(place as usize)?;
            if node.distance_squared(x) > best.0 {
                continue;
            }
            if node.count > 0 {
                for t in node.first..node.first + node.count {
                    let (point, region) =
                        nearest_on_triangle(x, self.0.stored.triangles[t as usize]);
                    let squared = (x - point).length_squared();
                    if squared < best.0 || squared == best.0 && t < best.1 {
                        best = (squared, t, point, region);
                    }
                }
                continue;
            }
            // The nearer child is looked at first.
            let children = [place + 1, node.first];
            let far = children.map(|child| self.0.tree[child as usize].distance_squared(x));
            let order = if far[0] <= far[1] { [1, 0] } else { [0, 1] };
            for k in order {
                waiting[depth] = children[k];
                depth += 1;
            }
        }
        let (_, t, point, region) = best;
        let [a, b, c] = *self.0.stored.triangles.get(t as usize)?;
        let gate = match region {
            Region::Face => OPEN,
            Region::Edge(k) => self.0.stored.edges[t as usize][k],
            Region::Corner(k) => self.0.stored.corners[t as usize][k],
        };
        Some(NearestOnPart {
            point,
            normal: (b - a).cross(c - a).normalize_or(DVec3::X),
            is_own: self.passes(gate, x - point),
        })
    }

    /// Whether a grain that stands `off` a gate touches it there.
    fn passes(&self, gate: u32, off: DVec3) -> bool {
        match gate {
            OPEN => true,
            SHUT => false,
            gate => {
                let others = self.0.stored.gates.get(gate as usize).into_iter().flatten();
                others
                    .into_iter()
                    .all(|direction| off.dot(*direction) <= 0.0)
            }
        }
    }
}
