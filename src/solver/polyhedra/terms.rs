//! The force of a contact of polyhedra, term by term: see [`super::super::terms`].

use super::super::row::vector;
use super::super::terms::{ForceTerms, velocity_half_a_step_ago};
use super::bodies::{Body, Shapes};
use super::listing::Listed;
use super::nearest::{Jobs, Nearest, Places};
use crate::lanes::{Lanes, One, Row};
use crate::physics::law::{Hooke, Law};
use crate::world::{Contact, Feature, FeatureContact, Partner, World};
use glam::DVec3;

/// The terms of `contact`, one entry for each pair of features.
pub fn force_terms(world: &World, contact: &Contact) -> Vec<ForceTerms> {
    let Some(polyhedra) = &world.polyhedra else {
        return Vec::new();
    };
    let of_pair = |feature: &&FeatureContact| {
        (feature.grain, feature.partner) == (contact.grain, contact.partner)
    };
    let features: Vec<&FeatureContact> = polyhedra.features.iter().filter(of_pair).collect();
    let meeting = Meeting::of(world, contact);
    let sum: f64 = features.iter().map(|feature| feature.overlap).sum();
    let squares: f64 = features.iter().map(|f| f.overlap * f.overlap).sum();
    let springs = world.law.feature_springs();
    let part = springs.map_or(1.0, |springs| springs.rule.part(sum, squares));
    let term = |feature: &FeatureContact| meeting.terms(feature, part);
    features.into_iter().map(term).collect()
}

/// Two bodies near each other.
struct Meeting<'a> {
    world: &'a World,
    partner: Partner,
    shapes: Shapes,
    vertices: Vec<Row>,
    planes: Vec<Row>,
    /// Centroid of the first [m].
    centre: DVec3,
    /// Velocity of the first relative to the second at the first's centroid [m/s].
    velocity: DVec3,
    /// Relative spin [rad/s].
    spin: DVec3,
    /// Rounding radii of both [m].
    rounding: [f64; 2],
    /// `K_n`, the normal dashpot, `K_t`, μ.
    law: Row,
}

impl<'a> Meeting<'a> {
    fn of(world: &'a World, contact: &Contact) -> Self {
        let first = contact.grain as usize;
        let (centre, velocity, spin) = motion(world, first);
        let (second, rounding) = match contact.partner {
            Partner::Grain(j) => (motion(world, j as usize), rounding(world, j as usize)),
            Partner::Wall(w) => {
                let motion = &world.container.walls[w as usize].motion;
                ((DVec3::ZERO, motion.velocity, motion.spin), 0.0)
            }
        };
        let pairing = world.pairing(first, contact.partner);
        let constants = pairing.constants(world.law, &world.materials, false);
        let [normal, damping, tangential, _] = constants.coefficients;
        let mut meeting = Self {
            world,
            partner: contact.partner,
            shapes: Shapes::default(),
            vertices: Vec::new(),
            planes: Vec::new(),
            centre,
            velocity: velocity - second.1 - second.2.cross(centre - second.0),
            spin: spin - second.2,
            rounding: [self::rounding(world, first), rounding],
            law: [normal, damping, tangential, constants.contact[0]],
        };
        meeting.place(first);
        if let Partner::Grain(j) = contact.partner {
            meeting.place(j as usize);
        }
        meeting
    }

    /// Puts the features of grain `i` after those that are there.
    fn place(&mut self, i: usize) {
        let Some(polyhedra) = &self.world.polyhedra else {
            return;
        };
        let body = self.shapes.add(polyhedra.shape_of(i));
        let (from, to) = (self.shapes.places[body], self.shapes.places[body + 1]);
        self.vertices.resize(to.vertex as usize, [0.0; 4]);
        self.planes.resize(to.face as usize, [0.0; 4]);
        self.shapes.place::<<One as Lanes>::Quad>(
            (),
            body,
            &Body::of(self.world, i, self.world.clock.time_step),
            &mut self.vertices[from.vertex as usize..],
            &mut self.planes[from.face as usize..],
        );
    }

    /// Nearest points of two features.
    fn nearest(&self, feature: Feature) -> Nearest {
        if let (Partner::Wall(w), Feature::VertexFace(vertex, _)) = (self.partner, feature) {
            let surface = &self.world.container.walls[w as usize].surface;
            return super::pairs::to_wall(surface, self.vertices[usize::from(vertex)]);
        }
        let starts = [0, 1].map(|body| self.shapes.places[body]);
        let listed = Listed::of(&self.shapes, [0, 1], feature);
        let mut jobs = Jobs::default();
        jobs.extend_sorted(&self.shapes, &starts, &[listed], 0);
        let places = Places {
            vertices: &self.vertices,
            planes: &self.planes,
            corners: &self.shapes.loops,
        };
        let mut results = [Nearest::default()];
        jobs.run::<One, false>((), &places, &mut results);
        results[0]
    }

    fn terms(&self, contact: &FeatureContact, part: f64) -> ForceTerms {
        let one = |x: f64| One::splat((), x);
        let nearest = self.nearest(contact.feature);
        let (normal, middle) = (vector(nearest.normal), vector(nearest.middle));
        let point = middle + normal * (0.5 * (self.rounding[0] - self.rounding[1]));
        let velocity = self.velocity + self.spin.cross(point - self.centre);
        let approach = velocity.dot(normal);
        let [stiffness, damping, _, friction] = self.law;
        let elastic = stiffness * part * contact.overlap;
        let damping = damping * part * approach;
        let repulsion = (Hooke::default().normal_force(one(elastic), one(damping), one(0.0))).get();
        let bounding =
            (Hooke::default().coulomb_force(one(elastic), one(repulsion), one(0.0))).get();
        let spring = -contact.spring * contact.stiffness;
        let coulomb_bound = friction * bounding;
        ForceTerms {
            feature: Some(contact.feature),
            normal,
            point,
            overlap: contact.overlap,
            approach,
            slip: velocity - normal * approach,
            slides: spring.length() >= coulomb_bound * (1.0 - super::super::terms::AT_THE_BOUND),
            coulomb_bound,
            normal_spring: -normal * elastic,
            normal_dashpot: -normal * (repulsion - elastic),
            tangential_spring: spring,
            ..ForceTerms::default()
        }
    }
}

/// Centroid [m], velocity [m/s] and spin [rad/s] of grain `i` as the pair loop saw them.
fn motion(world: &World, i: usize) -> (DVec3, DVec3, DVec3) {
    let grains = &world.grains;
    let spin = world.polyhedra.as_ref().map_or(DVec3::ZERO, |polyhedra| {
        let half = grains.torque[i] * (0.5 * world.clock.time_step);
        let turn = polyhedra.orientation[i];
        let momentum = polyhedra.angular_momentum[i] - half;
        turn * ((turn.conjugate() * momentum) / polyhedra.inertia[i])
    });
    let velocity = velocity_half_a_step_ago(world, i);
    (grains.position[i], velocity, spin)
}

fn rounding(world: &World, i: usize) -> f64 {
    (world.polyhedra.as_ref()).map_or(0.0, |polyhedra| polyhedra.shape_of(i).rounding)
}
