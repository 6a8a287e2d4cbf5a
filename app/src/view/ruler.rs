//! A ruler between two points of the picture: on grains, with which its ends move, or elsewhere.
//!
//! In: the points that were clicked on, a world. Out: where the ends are, how far apart and how
//! steep the way between them is. Drawing it is the business of `ruler_marks`.

use glam::DVec3;
use grainfall::world::World;

/// One end of a ruler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RulerEnd {
    /// The centre of the grain of this number.
    Grain(usize),
    /// A place [m].
    Place(DVec3),
}

impl RulerEnd {
    /// Where it is [m]; nowhere where `world` has no such grain.
    fn place(self, world: &World) -> Option<DVec3> {
        match self {
            Self::Grain(grain) => world.grains.position.get(grain).copied(),
            Self::Place(place) => Some(place),
        }
    }
}

/// A ruler, laid on or put away.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ruler {
    /// Whether clicks in the picture lay its ends.
    pub is_out: bool,
    /// One after the other, at most two.
    ends: Vec<RulerEnd>,
}

/// What a ruler shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// From end to end [m].
    pub distance: f64,
    /// Angle of the way between them to the horizontal, 0 … π/2 [rad].
    pub inclination: f64,
}

impl Reading {
    /// That between two points [m].
    pub fn between([from, to]: [DVec3; 2]) -> Self {
        let way = to - from;
        let across = way.x.hypot(way.z);
        Self {
            distance: way.length(),
            inclination: way.y.abs().atan2(across),
        }
    }
}

impl Ruler {
    /// Takes it out, with no end laid, or puts it away.
    pub fn toggle(&mut self) {
        *self = Self {
            is_out: !self.is_out,
            ends: Vec::new(),
        };
    }

    /// Lays its next end there; after the second it is laid anew.
    pub fn lay(&mut self, end: RulerEnd) {
        if self.ends.len() == 2 {
            self.ends.clear();
        }
        self.ends.push(end);
    }

    /// Where its ends are in `world`, as many as are laid [m].
    pub fn places(&self, world: &World) -> Vec<DVec3> {
        let places = self.ends.iter().filter_map(|end| end.place(world));
        places.collect()
    }

    /// What it shows in `world`, once both ends are laid.
    pub fn reading(&self, world: &World) -> Option<Reading> {
        let places = self.places(world);
        <[DVec3; 2]>::try_from(places).ok().map(Reading::between)
    }
}
