//! Two features that may touch, as lists hold them, and what there is to compute for them.
//!
//! In: features with what was found out when they were listed. Out: jobs that name vertices, faces
//! and edges by their numbers in the world's tables.
//!
//! Not here: which features are listed ([`super::listing`]).

use super::bodies::{Place, Shapes};
use super::nearest::{EdgeJob, FaceJob, Jobs, OutlineJob};
use crate::world::Feature;

/// Two features that may touch before long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Which.
    pub feature: Feature,
    /// Of two edges their ends, by their numbers in the bodies; of a vertex and a face the edges of
    /// its outline that matter, bit by bit in two halves: none where the vertex is over the inside.
    marks: [u16; 4],
}

impl Listed {
    /// A vertex and a face, with those edges of its outline that matter.
    pub fn face(feature: Feature, sides: u32) -> Self {
        let marks = [sides as u16, (sides >> 16) as u16, 0, 0];
        Self { feature, marks }
    }

    /// Two features of bodies 0 and 1 wherever they are: of a face the whole outline matters.
    pub fn of(shapes: &Shapes, feature: Feature) -> Self {
        match feature {
            Feature::VertexFace(..) | Feature::FaceVertex(..) => Self::face(feature, u32::MAX),
            Feature::VertexVertex => Self::edges(feature, [0; 2], [0; 2]),
            Feature::EdgeEdge(first, second) => {
                let [along, across] = [0, 1].map(|body| shapes.edges_of(body));
                let (along, across) = (along[usize::from(first)], across[usize::from(second)]);
                Self::edges(feature, along, across)
            }
        }
    }

    /// Two edges and their ends.
    pub fn edges(feature: Feature, [p, q]: [u16; 2], [r, s]: [u16; 2]) -> Self {
        let marks = [p, q, r, s];
        Self { feature, marks }
    }

    /// Whether it is a vertex and a face: these come before edges.
    #[inline(always)]
    pub fn is_face(&self) -> bool {
        matches!(
            self.feature,
            Feature::VertexFace(..) | Feature::FaceVertex(..)
        )
    }

    /// Edges of the outline that matter, bit by bit.
    #[inline(always)]
    fn sides(&self) -> u32 {
        u32::from(self.marks[0]) | u32::from(self.marks[1]) << 16
    }
}

impl Jobs {
    /// Adds what there is to compute for features of the bodies whose features begin at `starts`:
    /// vertices with faces, then edges with edges. The results begin at `out` and stand in the
    /// order of the features, whichever kind of job each becomes.
    #[inline(always)]
    pub fn extend(
        &mut self,
        shapes: &Shapes,
        starts: &[Place; 2],
        [faces, edges]: [impl ExactSizeIterator<Item = Listed>; 2],
        out: u32,
    ) {
        let edge_out = out + faces.len() as u32;
        // Either kind is written to the end of both queues and stays in its own: a branch would be
        // foretold wrongly half of the time.
        let (mut above, mut outlines) = (self.above.len(), self.outlines.len());
        self.above.resize(above + faces.len(), FaceJob::default());
        self.outlines
            .resize(outlines + faces.len(), OutlineJob::default());
        for (listed, out) in faces.zip(out..) {
            let (side, vertex, face) = match listed.feature {
                Feature::VertexFace(vertex, face) => (0, vertex, face),
                Feature::FaceVertex(face, vertex) => (1, vertex, face),
                Feature::EdgeEdge(..) | Feature::VertexVertex => (0, 0, 0),
            };
            let (of_vertex, of_face) = (&starts[side as usize], &starts[1 - side as usize]);
            let job = FaceJob {
                vertex: of_vertex.vertex + u32::from(vertex),
                face: of_face.face + u32::from(face),
                side,
                out,
            };
            let [corner, end] = [0, 1].map(|k| shapes.loop_starts[job.face as usize + k]);
            let bits = (end - corner).min(u32::BITS);
            let sides = listed.sides() & (u32::MAX >> (u32::BITS - bits));
            self.above[above] = job;
            self.outlines[outlines] = OutlineJob {
                face: job,
                sides,
                corner,
                count: end - corner,
                start: of_face.vertex,
            };
            above += usize::from(sides == 0);
            outlines += usize::from(sides != 0);
        }
        self.above.truncate(above);
        self.outlines.truncate(outlines);
        let starts = starts.map(|start| start.vertex);
        self.edges
            .extend(edges.zip(edge_out..).map(|(listed, out)| {
                let [p, q, r, s] = listed.marks.map(u32::from);
                let ends = [starts[0] + p, starts[0] + q, starts[1] + r, starts[1] + s];
                EdgeJob { ends, out }
            }));
    }

    /// Likewise, for features in their order.
    pub fn extend_sorted(
        &mut self,
        shapes: &Shapes,
        starts: &[Place; 2],
        listed: &[Listed],
        out: u32,
    ) {
        let (faces, edges) = listed.split_at(listed.partition_point(Listed::is_face));
        let kinds = [faces, edges].map(|kind| kind.iter().copied());
        self.extend(shapes, starts, kinds, out);
    }
}
