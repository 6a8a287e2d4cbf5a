//! The force of a contact of polyhedra, term by term.
//!
//! In: a world as a solver left it and one of its contacts. Out: what each term gives, feature by
//! feature. The pair is put before the functions of the pair loop ([`super::workspace`],
//! [`super::contact_group`]) as a block of its own, with the velocities of half a step ago: so
//! nothing of a force is derived twice.
//!
//! Springs and dashpots that are taken implicitly act for the pair as one ([`super::joint`]): the
//! dashpots are what all else leaves of the force that was applied, with what springs yield within a
//! step, and each feature is told its share, in proportion to its own dashpot; of features that have
//! all let go each is told as much.

use super::super::row::{row, vector};
use super::super::terms::{AT_THE_BOUND, ForceTerms};
use super::super::walls::Walls;
use super::bodies::{Body, Geometry, Load, Placing, Shapes};
use super::contact_group::ContactGroup;
use super::extents::Extents;
use super::listed::Listed;
use super::motion::{Surroundings, motions_of};
use super::nearest::Places;
use super::pairs::{Block, ContactPoint, PackedPartner, Pair, PointRange, Terms};
use super::workspace::Workspace;
use crate::lanes::{Lanes, One, Row, WIDEST, Work};
use crate::physics::{FeatureRule, Integrator};
use crate::world::{Contact, FeatureContact, Partner, World};
use glam::DVec3;

/// The terms of `contact`, one entry for each pair of features.
pub fn force_terms(world: &World, contact: &Contact) -> Vec<ForceTerms> {
    let Some(polyhedra) = &world.polyhedra else {
        return Vec::new();
    };
    let features = of_pair(&polyhedra.features, (contact.grain, contact.partner));
    let alone = PairAlone::of(world, contact);
    match polyhedra.integrator {
        Integrator::Explicit => alone.terms::<false>(world, features),
        Integrator::Implicit => {
            let mut terms = alone.terms::<true>(world, features);
            share_dashpots(&mut terms, contact.force);
            terms
        }
    }
    .into_iter()
    .map(|(terms, _)| terms)
    .collect()
}

/// The `features` of the pair of these two sides; they are sorted by grain and partner.
fn of_pair(features: &[FeatureContact], pair: (u32, Partner)) -> &[FeatureContact] {
    let sides = |feature: &FeatureContact| (feature.grain, feature.partner);
    let start = features.partition_point(|feature| sides(feature) < pair);
    let count = features[start..].partition_point(|feature| sides(feature) == pair);
    &features[start..start + count]
}

/// Gives each feature its share of what the implicit dashpots of the pair do, which is what the
/// terms so far leave of the `applied` force; beside each feature's terms stands its own dashpot.
fn share_dashpots(terms: &mut [(ForceTerms, f64)], applied: DVec3) {
    let so_far: DVec3 = terms.iter().map(|(terms, _)| terms.force()).sum();
    let all: f64 = terms.iter().map(|(_, dashpot)| dashpot).sum();
    let count = terms.len() as f64;
    for (terms, dashpot) in terms {
        let share = if all > 0.0 {
            *dashpot / all
        } else {
            1.0 / count
        };
        if share > 0.0 {
            terms.normal_dashpot += (applied - so_far) * share;
        }
    }
}

/// Two bodies, or a body and a wall, as the pair loop saw them: bodies 0 and 1 of a small world.
struct PairAlone {
    pair: Pair,
    constants: Terms,
    bodies: Vec<Body>,
    shapes: Shapes,
    vertices: Vec<Row>,
    planes: Vec<Row>,
    walls: Walls,
    wall_motions: Vec<[Row; 3]>,
    extents: Extents,
}

impl PairAlone {
    /// The two sides of `contact`.
    fn of(world: &World, contact: &Contact) -> Self {
        let first = contact.grain as usize;
        let (second, grains) = match contact.partner {
            Partner::Grain(j) => (PackedPartner::grain(1), vec![first, j as usize]),
            Partner::Wall(w) => (PackedPartner::wall(w), vec![first]),
        };
        let bodies: Vec<Body> = (grains.iter())
            .map(|i| half_a_step_ago(world, *i))
            .collect();
        let shapes = Shapes::of(world, grains);
        let mut vertices = vec![[0.0; 4]; shapes.body_vertices.len()];
        let mut planes = vec![[0.0; 4]; shapes.body_normals.len()];
        let placing = Placing {
            shapes: &shapes,
            bodies: &bodies,
            vertices: &mut vertices,
            planes: &mut planes,
        };
        placing.run::<One>(());
        let mut walls = Walls::default();
        walls.load(&world.container);
        let extents = Extents::of(&bodies, &walls, 0.0);
        let pair = Pair {
            // Whatever the two have moved, nothing is to be listed.
            outer_slack: f64::INFINITY,
            inner_slack: f64::INFINITY,
            ..Pair::new((0, second))
        };
        let mut constants = Terms::default();
        constants.set_geometry(&pair, &bodies, &shapes, &extents);
        constants.set_law(world, first, contact.partner);
        Self {
            pair,
            constants,
            bodies,
            shapes,
            vertices,
            planes,
            wall_motions: motions_of(&walls),
            walls,
            extents,
        }
    }

    /// What every force of `world` depends on, as it is for these two.
    fn surroundings(&self, world: &World) -> Surroundings<'_> {
        let springs = world.law.feature_springs();
        Surroundings {
            dt: world.clock.time_step,
            look_ahead: 0.0,
            rule: springs.map_or(FeatureRule::Full, |springs| springs.rule),
            bodies: &self.bodies,
            geometry: Geometry {
                shapes: &self.shapes,
                places: Places {
                    vertices: &self.vertices,
                    planes: &self.planes,
                    corners: &self.shapes.loops,
                },
            },
            walls: &self.walls,
            wall_motions: &self.wall_motions,
            extents: self.extents,
        }
    }

    /// The terms of each of the `features`, and its dashpot where those are `IMPLICIT` [N s/m]: by
    /// the stages of the pair loop, with these features active.
    fn terms<const IMPLICIT: bool>(
        &self,
        world: &World,
        features: &[FeatureContact],
    ) -> Vec<(ForceTerms, f64)> {
        let point = |contact: &FeatureContact| {
            ContactPoint::known(contact, Listed::of(&self.shapes, contact.feature))
        };
        let mut points: Vec<ContactPoint> = features.iter().map(point).collect();
        let mut pair = self.pair.clone();
        pair.points = PointRange::at(0, &points);
        let mut block = Block {
            pairs: std::slice::from_mut(&mut pair),
            terms: &mut [self.constants],
            points: &mut points,
        };
        let (all, mut workspace) = (self.surroundings(world), Workspace::default());
        workspace.gather::<One>((), &all, &mut block);
        workspace.measure::<One>((), &all, &block);
        workspace.evaluate_overlaps(&all, &mut block);
        let Some(active) = workspace.active.first() else {
            return Vec::new();
        };
        let dt = world.clock.time_step;
        let measured = workspace.results.iter().zip(features).zip(&*block.points);
        let terms = measured.map(|((nearest, contact), point)| {
            let law = [&self.constants.law; WIDEST];
            let group = ContactGroup::<One>::gather(
                (),
                [active; WIDEST],
                law,
                [nearest; WIDEST],
                [point; WIDEST],
            );
            terms_of::<IMPLICIT>(&group, contact, (vector(active.centre), dt))
        });
        terms.collect()
    }
}

/// The terms of one contact, the first side's centroid being at `centre` [m], steps being `dt` long
/// [s], and its dashpot where that is `IMPLICIT` [N s/m]. What the tangential spring does is read where the loop left it.
fn terms_of<const IMPLICIT: bool>(
    group: &ContactGroup<One>,
    contact: &FeatureContact,
    (centre, dt): (DVec3, f64),
) -> (ForceTerms, f64) {
    let along = |v: [One; 3]| DVec3::from_array(v.map(One::get));
    let pressed = group.normal_forces::<IMPLICIT>(One::splat((), 0.0));
    let (elastic, repulsion) = (pressed.along.elastic.get(), pressed.repulsion.get());
    let remembered = (&pressed, One::splat((), contact.normal_memory));
    let coulomb_bound = group.coulomb_bound::<IMPLICIT>((), dt, remembered).get();
    let (normal, spring) = (along(group.normal), -contact.spring * contact.stiffness);
    let terms = ForceTerms {
        feature: Some(contact.feature),
        normal,
        point: centre + along(group.arm),
        overlap: group.depth.get(),
        approach: pressed.approach.get(),
        slip: along(pressed.slip),
        slides: spring.length() >= coulomb_bound * (1.0 - AT_THE_BOUND),
        coulomb_bound,
        normal_spring: -normal * elastic,
        normal_dashpot: -normal * (repulsion - elastic),
        tangential_spring: spring,
        ..ForceTerms::default()
    };
    (terms, pressed.dashpot.get())
}

/// Grain `i` as the pair loop saw it: where it is now, with the velocities of half a step ago.
fn half_a_step_ago(world: &World, i: usize) -> Body {
    let dt = world.clock.time_step;
    let mut body = Body::of(world, i, dt);
    body.kick(&Load::of(world, i), -0.5 * dt, row(world.gravity, 0.0));
    body.update_spin();
    body
}
