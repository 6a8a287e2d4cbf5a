//! A wall of triangles, at rest, turning about an axis or moving straight on.
//!
//! In: a smooth part of a mesh in its own frame, and how far it has turned and moved. Out: where of
//! it is nearest to a point. The triangles stay as they are: it is the point that is brought into
//! their frame. What holds a wall's velocity is [`super::WallMotion`], as for all walls; here an axis
//! says that its spin turns the mesh, and no axis that its velocity shifts it.

use super::motion::WallMotion;
use crate::geometry::{MeshPart, NearestOnPart};
use crate::lanes::WIDEST;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What stands for the distance of a wall that a grain touches elsewhere [m]: no number is
/// infinite, so that no force becomes none.
const ELSEWHERE: f64 = 1e9;

/// A smooth part of a mesh, in place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "(MeshPart, StoredPose)", into = "(MeshPart, StoredPose)")]
pub struct MeshWall {
    part: MeshPart,
    pose: MeshPose,
    /// Distance of its farthest corner from the axis that it turns about [m].
    reach: f64,
}

/// How far a mesh has turned and moved since the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPose {
    stored: StoredPose,
    /// Cosine and sine of the angle.
    turn: [f64; 2],
}

/// What a pose is made of; cosine and sine follow from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct StoredPose {
    /// A point of the axis [m].
    through: DVec3,
    /// Unit vector along the axis; zero of a mesh that does not turn.
    axis: DVec3,
    /// Angle through which it has turned [rad].
    angle: f64,
    /// How far it has moved [m].
    shift: DVec3,
}

impl From<StoredPose> for MeshPose {
    fn from(stored: StoredPose) -> Self {
        let (sin, cos) = libm::sincos(stored.angle);
        Self {
            stored,
            turn: [cos, sin],
        }
    }
}

impl MeshPose {
    /// As its file has it, and free to move straight on.
    pub fn resting() -> Self {
        Self::about(DVec3::ZERO, DVec3::ZERO)
    }

    /// As its file has it, and free to turn about the axis along the unit vector `axis` through the
    /// point `through` [m].
    pub fn about(through: DVec3, axis: DVec3) -> Self {
        Self::from(StoredPose {
            through,
            axis,
            angle: 0.0,
            shift: DVec3::ZERO,
        })
    }

    /// A point of the axis [m] and the unit vector along it; none of a mesh that does not turn.
    pub fn axis(&self) -> Option<(DVec3, DVec3)> {
        let StoredPose { through, axis, .. } = self.stored;
        (axis != DVec3::ZERO).then_some((through, axis))
    }

    /// Angle through which it has turned [rad].
    pub fn angle(&self) -> f64 {
        self.stored.angle
    }

    /// How far it has moved [m].
    pub fn shift(&self) -> DVec3 {
        self.stored.shift
    }

    /// `v` turned by the angle whose cosine and sine these are (Rodrigues 1840): the same to the bit
    /// where it is zero.
    fn turned(&self, v: DVec3, [cos, sin]: [f64; 2]) -> DVec3 {
        let axis = self.stored.axis;
        v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
    }

    /// Where the point `x` of its own frame is [m].
    pub fn place(&self, x: DVec3) -> DVec3 {
        let StoredPose { through, shift, .. } = self.stored;
        self.turned(x - through, self.turn) + through + shift
    }

    /// Where in its own frame the point `x` is [m].
    fn own(&self, x: DVec3) -> DVec3 {
        let StoredPose { through, shift, .. } = self.stored;
        let [cos, sin] = self.turn;
        self.turned(x - shift - through, [cos, -sin]) + through
    }

    /// The direction `v` of its own frame.
    fn direction(&self, v: DVec3) -> DVec3 {
        self.turned(v, self.turn)
    }

    fn own_direction(&self, v: DVec3) -> DVec3 {
        let [cos, sin] = self.turn;
        self.turned(v, [cos, -sin])
    }

    /// Moves on by `time` [s] with this motion.
    fn advance(&mut self, motion: &WallMotion, time: f64) {
        if self.stored.axis == DVec3::ZERO {
            self.stored.shift += motion.velocity * time;
        } else if motion.spin != DVec3::ZERO {
            self.stored.angle += motion.spin.dot(self.stored.axis) * time;
            *self = Self::from(self.stored);
        }
    }
}

impl From<(MeshPart, StoredPose)> for MeshWall {
    fn from((part, pose): (MeshPart, StoredPose)) -> Self {
        Self::new(part, MeshPose::from(pose))
    }
}

impl From<MeshWall> for (MeshPart, StoredPose) {
    fn from(wall: MeshWall) -> Self {
        (wall.part, wall.pose.stored)
    }
}

impl MeshWall {
    /// `part` in this place.
    pub fn new(part: MeshPart, pose: MeshPose) -> Self {
        let StoredPose { through, axis, .. } = pose.stored;
        let corners = part.triangles().iter().flatten();
        let from_axis = corners.map(|x| axis.cross(*x - through).length());
        Self {
            reach: from_axis.fold(0.0, f64::max),
            part,
            pose,
        }
    }

    /// Its triangles in their own frame.
    pub fn part(&self) -> &MeshPart {
        &self.part
    }

    /// How far it has turned and moved.
    pub fn pose(&self) -> &MeshPose {
        &self.pose
    }

    /// Its triangles where they are now [m].
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        let triangles = self.part.triangles().iter();
        triangles.map(|triangle| triangle.map(|x| self.pose.place(x)))
    }

    /// The motion of a mesh that turns about its axis at `speed` [rad/s]; none of one without.
    pub fn turning(&self, speed: f64) -> WallMotion {
        let (through, axis) = self.pose.axis().unwrap_or_default();
        let spin = speed * axis;
        WallMotion {
            velocity: -spin.cross(through),
            spin,
        }
    }

    /// Moves on by `time` [s] with this motion.
    pub fn advance(&mut self, motion: &WallMotion, time: f64) {
        self.pose.advance(motion, time);
    }

    /// The speed that no point of it exceeds with this motion [m/s].
    pub fn speed(&self, motion: &WallMotion) -> f64 {
        match self.pose.axis() {
            Some(_) => motion.spin.length() * self.reach,
            None => motion.velocity.length(),
        }
    }

    /// How far no point of it is from where it was in `old` [m]; without bound where it is another.
    pub fn moved_from(&self, old: &Self) -> f64 {
        let (own, other) = (&self.pose.stored, &old.pose.stored);
        if self.part != old.part || (own.axis, own.through) != (other.axis, other.through) {
            return f64::INFINITY;
        }
        (own.angle - other.angle).abs() * self.reach + (own.shift - other.shift).length()
    }

    /// Distance of `x` from it [m], on whichever side, and the unit vector from `x` towards it. Not
    /// a number where `x` is none.
    pub fn distance(&self, x: DVec3) -> (f64, DVec3) {
        let own = self.pose.own(x);
        let found = self.part.nearest(own);
        found.map_or((f64::NAN, DVec3::X), |found| self.seen_from(own, &found))
    }

    /// The same where `x` is the centre of a grain that touches this part rather than another at the
    /// same edge; else it is far away.
    fn contact(&self, x: DVec3) -> (f64, DVec3) {
        let own = self.pose.own(x);
        match self.part.nearest(own) {
            Some(found) if found.is_own => self.seen_from(own, &found),
            Some(_) => (ELSEWHERE, DVec3::X),
            None => (f64::NAN, DVec3::X),
        }
    }

    /// Distance and direction of what was found from the point `own` of the mesh's frame. On the
    /// surface itself the direction is one across it.
    fn seen_from(&self, own: DVec3, found: &NearestOnPart) -> (f64, DVec3) {
        let off = found.point - own;
        let distance = off.length();
        let direction = if distance > 0.0 {
            off / distance
        } else {
            found.normal
        };
        (distance, self.pose.direction(direction))
    }

    /// Distances, and the components of the directions, of the first `count` of the points whose
    /// coordinates these are; `contacts` alone or all. Cold, so that the pair loop keeps its registers
    /// for walls that are none.
    #[cold]
    #[inline(never)]
    pub(super) fn side_by_side(
        &self,
        [x, y, z]: [[f64; WIDEST]; 3],
        count: usize,
        contacts: bool,
    ) -> [[f64; WIDEST]; 4] {
        let mut found = [[0.0; WIDEST]; 4];
        for k in 0..count.min(WIDEST) {
            let at = DVec3::new(x[k], y[k], z[k]);
            let (distance, direction) = if contacts {
                self.contact(at)
            } else {
                self.distance(at)
            };
            found[0][k] = distance;
            [found[1][k], found[2][k], found[3][k]] = direction.to_array();
        }
        found
    }

    /// How far from `origin` a ray along the unit vector `direction` first hits it [m]; none where it
    /// passes it.
    pub fn first_hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let (origin, direction) = (self.pose.own(origin), self.pose.own_direction(direction));
        self.part.first_hit(origin, direction)
    }

    /// Why a world cannot hold it, if it cannot.
    pub(super) fn flaw(&self) -> Option<&'static str> {
        let StoredPose {
            through,
            axis,
            angle,
            shift,
        } = self.pose.stored;
        let is_place = |x: DVec3| x.abs().max_element() <= 1e12;
        if !self.part.is_sound() {
            Some("no surface of triangles")
        } else if !(axis == DVec3::ZERO || axis.is_normalized()) {
            Some("turned about no axis")
        } else if !(is_place(through) && is_place(shift) && angle.abs() <= 1e12) {
            Some("nowhere")
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::smooth_parts;
    use std::f64::consts::FRAC_PI_2;

    /// A square of edge 2 in the plane x = 1.
    fn wall(pose: MeshPose) -> MeshWall {
        let corner = |y: f64, z: f64| DVec3::new(1.0, y, z);
        let [a, b, c, d] = [
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ];
        let parts = smooth_parts(&[[a, b, c], [a, c, d]]).unwrap();
        MeshWall::new(parts[0].clone(), pose)
    }

    #[test]
    fn wall_at_rest_is_where_its_file_has_it_to_the_bit() {
        let wall = wall(MeshPose::resting());
        let x = DVec3::new(0.3, 0.1, 0.7);
        assert_eq!(wall.distance(x), (1.0 - 0.3, DVec3::X));
        assert_eq!(wall.distance(DVec3::X), (0.0, DVec3::X));
    }

    #[test]
    fn wall_turns_about_its_axis_as_its_velocity_field_says() {
        let through = DVec3::new(0.0, 3.0, 0.0);
        let mut wall = wall(MeshPose::about(through, DVec3::Z));
        let motion = wall.turning(0.5);
        // The axis rests, and a corner moves at the speed that bounds all.
        assert_eq!(motion.velocity_at(through), DVec3::ZERO);
        let corner = DVec3::new(1.0, -1.0, 1.0);
        let fastest = motion.velocity_at(corner).length();
        assert!((wall.speed(&motion) / fastest - 1.0).abs() < 1e-15);
        // A quarter of a turn, in steps: x = 1 becomes y = 4 above the axis.
        let before = wall.clone();
        for _ in 0..1000 {
            wall.advance(&motion, FRAC_PI_2 / 0.5 / 1000.0);
        }
        let (distance, direction) = wall.distance(DVec3::new(3.0, 3.0, 0.0));
        assert!((distance - 1.0).abs() < 1e-12);
        assert!((direction - DVec3::Y).length() < 1e-12);
        assert!((wall.moved_from(&before) / (FRAC_PI_2 * wall.reach) - 1.0).abs() < 1e-12);
        let hit = wall.first_hit(DVec3::new(3.0, 0.0, 0.0), DVec3::Y);
        assert!((hit.unwrap() - 4.0).abs() < 1e-12);
        let corners: Vec<DVec3> = wall.triangles().flatten().collect();
        assert!(corners.iter().all(|x| (x.y - 4.0).abs() < 1e-12));
    }

    #[test]
    fn wall_moves_straight_on() {
        let mut wall = wall(MeshPose::resting());
        let motion = WallMotion {
            velocity: DVec3::new(0.5, 0.0, 0.0),
            spin: DVec3::ZERO,
        };
        let before = wall.clone();
        (0..4).for_each(|_| wall.advance(&motion, 0.25));
        assert_eq!(wall.distance(DVec3::ZERO), (1.5, DVec3::X));
        assert_eq!(wall.moved_from(&before), 0.5);
        assert_eq!(wall.speed(&motion), 0.5);
        let stored = postcard::to_stdvec(&wall).unwrap();
        let again: MeshWall = postcard::from_bytes(&stored).unwrap();
        assert_eq!(again, wall);
    }
}
