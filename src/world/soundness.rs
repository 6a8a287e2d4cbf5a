//! Whether a world from a file is one that a run can come to.
//!
//! In: a [`World`] that a checkpoint, a session or a bed held. Out: nothing, or an [`Unsound`] that
//! says what is wrong and where. A checksum shows that a file is as it was written, not who wrote
//! it: whatever indexes, divides or counts on order is looked at here, once, before the solver,
//! measures and views take it for granted. Whether the world belongs to a scene is not asked.

use super::{Contact, Container, Feature, Grains, Partner, Polyhedra, Polyhedron, Shape};
use super::{Surface, Wall, World};
use crate::geometry::MOST_PARTS;
use crate::physics::limits::{self, Limits};
use crate::physics::{Liquid, Materials};
use glam::DVec3;

/// Largest coordinate, speed, force or energy that a state may hold, in SI units.
const LARGEST: f64 = 1e30;
/// Farthest place of a grain [m]: what moves at the greatest speed for the longest time.
const FARTHEST: f64 = 1e12;
/// Most steps that a clock may show: beyond, steps are no numbers of their own as floats.
pub const MOST_STEPS: u64 = 1 << 53;
/// Features of one kind that a shape may have.
const MOST_FEATURES: usize = 1 << 12;

/// Why a state cannot be gone on from: what is wrong, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the state in it is none that a run comes to: {0}")]
pub struct Unsound(String);

/// Refuses where something is not as it has to be; `what` says it of the state.
fn require(is_so: bool, what: impl FnOnce() -> String) -> Result<(), Unsound> {
    if is_so { Ok(()) } else { Err(Unsound(what())) }
}

fn number(value: f64, name: impl FnOnce() -> String) -> Result<(), Unsound> {
    require(value.abs() <= LARGEST, || {
        format!("{} is {value:?}", name())
    })
}

fn vector(value: DVec3, most: f64, name: impl FnOnce() -> String) -> Result<(), Unsound> {
    let [x, y, z] = value.to_array();
    let is_so = [x, y, z].iter().all(|x| x.abs() <= most);
    require(is_so, || format!("{} is ({x:?}, {y:?}, {z:?})", name()))
}

fn within(limits: &Limits, value: f64, name: impl FnOnce() -> String) -> Result<(), Unsound> {
    require(limits.accept(value), || {
        format!("{} is {value:?}; expected {}", name(), limits.expected)
    })
}

/// A size that is divided by.
fn positive(value: f64, name: impl FnOnce() -> String) -> Result<(), Unsound> {
    require(value > 0.0 && value <= LARGEST, || {
        format!("{} is {value:?}; expected a number above 0", name())
    })
}

impl World {
    /// Whether it is whole: columns of one length, numbers that are finite, sizes above zero,
    /// indices of what exists, contacts in order.
    ///
    /// # Errors
    /// The first thing that is wrong, and where.
    pub fn check(&self) -> Result<(), Unsound> {
        self.clock.check()?;
        check_materials(&self.materials)?;
        self.check_species()?;
        self.container.check(self.materials.list().len())?;
        vector(self.gravity, 2.0 * limits::GRAVITY.most, || {
            "gravity".to_owned()
        })?;
        if let Some(liquid) = &self.liquid {
            check_liquid(liquid)?;
        }
        if let Some(mistake) = self.law.told(|law| law.mistake()) {
            return Err(Unsound(format!(
                "`{}` of the contact law is {:?}; expected {}",
                mistake.key, mistake.value, mistake.expected
            )));
        }
        self.grains.check(self.species.len())?;
        self.check_contacts()?;
        if let Some(polyhedra) = &self.polyhedra {
            require(self.law.feature_springs().is_some(), || {
                "its law is one of spheres, and it holds polyhedra".to_owned()
            })?;
            polyhedra.check(self.grains.len(), self.container.walls.len())?;
        }
        self.ledger.check()
    }

    fn check_species(&self) -> Result<(), Unsound> {
        let materials = self.materials.list().len();
        require(!self.species.is_empty(), || "it has no species".to_owned())?;
        self.species.iter().try_for_each(|species| {
            require(usize::from(species.material.0) < materials, || {
                format!("species `{}` has no material", species.name)
            })
        })
    }

    fn check_contacts(&self) -> Result<(), Unsound> {
        let (grains, walls) = (self.grains.len(), self.container.walls.len());
        let order = |contact: &Contact| (contact.grain, contact.partner);
        for (index, contact) in self.contacts.iter().enumerate() {
            let name = |what: &str| format!("{what} of contact {index}");
            is_between(contact.grain, contact.partner, grains, walls, || {
                format!("contact {index}")
            })?;
            let before = index.checked_sub(1).map(|before| &self.contacts[before]);
            require(
                before.is_none_or(|before| order(before) < order(contact)),
                || format!("contact {index} is out of order or there twice"),
            )?;
            vector(contact.spring, LARGEST, || name("the spring"))?;
            vector(contact.force, LARGEST, || name("the force"))?;
            vector(contact.rolling, LARGEST, || name("the rolling torque"))?;
            number(contact.stiffness, || name("the stiffness"))?;
            if let Some(bridge) = &contact.bridge {
                require(self.liquid.is_some(), || name("without a liquid, a bridge"))?;
                let of_bridge = [bridge.transfer, bridge.capillary, bridge.viscous];
                of_bridge
                    .into_iter()
                    .try_for_each(|value| number(value, || name("the bridge")))?;
                vector(bridge.drag, LARGEST, || name("the bridge"))?;
                number(bridge.volume, || name("the bridge's volume"))?;
            }
        }
        Ok(())
    }
}

/// A contact is one of a grain with a later grain or with a wall that exists.
fn is_between(
    grain: u32,
    partner: Partner,
    grains: usize,
    walls: usize,
    name: impl FnOnce() -> String,
) -> Result<(), Unsound> {
    let exists = match partner {
        Partner::Grain(other) => grain < other && (other as usize) < grains,
        Partner::Wall(wall) => (grain as usize) < grains && (wall as usize) < walls,
    };
    require(exists, || {
        format!(
            "{} is one of grain {grain} with {partner:?}, of {grains} grains and {walls} walls",
            name()
        )
    })
}

impl super::Clock {
    fn check(&self) -> Result<(), Unsound> {
        within(&limits::TIME_STEP, self.time_step, || {
            "the time step".to_owned()
        })?;
        require(
            self.origin_step <= self.step && self.step <= MOST_STEPS,
            || {
                format!(
                    "the clock shows step {} after step {}",
                    self.step, self.origin_step
                )
            },
        )?;
        let is_time = |time: f64| (0.0..=2.0 * limits::DURATION.most).contains(&time);
        require(is_time(self.origin_time) && is_time(self.time()), || {
            format!("its time is {:?} s", self.time())
        })
    }
}

impl super::Ledger {
    fn check(&self) -> Result<(), Unsound> {
        let energies = [
            self.initial_energy,
            self.gravity_work,
            self.potential_reference,
            self.command_work,
        ];
        energies
            .into_iter()
            .try_for_each(|energy| number(energy, || "an energy of the ledger".to_owned()))
    }
}

fn check_materials(materials: &Materials) -> Result<(), Unsound> {
    require(materials.is_whole(), || {
        "its materials and their pairs do not fit together".to_owned()
    })?;
    for material in materials.list() {
        let name = |what: &str| format!("the {what} of material `{}`", material.name);
        within(&limits::YOUNGS_MODULUS, material.youngs_modulus, || {
            name("modulus")
        })?;
        within(&limits::POISSON_RATIO, material.poisson_ratio, || {
            name("Poisson's ratio")
        })?;
        within(&limits::DENSITY, material.density, || name("density"))?;
    }
    materials.pairs().try_for_each(|pair| {
        let name = |what: &str| format!("the {what} of two materials");
        within(&limits::RESTITUTION, pair.restitution, || {
            name("restitution")
        })?;
        within(&limits::FRICTION, pair.friction, || name("friction"))?;
        within(&limits::FRICTION, pair.wet_friction, || {
            name("wet friction")
        })?;
        within(&limits::FRICTION, pair.rolling_friction, || {
            name("rolling friction")
        })
    })
}

fn check_liquid(liquid: &Liquid) -> Result<(), Unsound> {
    let values = [
        (
            &limits::SURFACE_TENSION,
            liquid.surface_tension,
            "surface tension",
        ),
        (
            &limits::CONTACT_ANGLE,
            liquid.contact_angle,
            "contact angle",
        ),
        (&limits::VISCOSITY, liquid.viscosity, "viscosity"),
        (&limits::LIQUID_VOLUME, liquid.volume, "volume"),
        (
            &limits::SMALLEST_GAP,
            liquid.law.viscous_gap.share(),
            "smallest gap",
        ),
    ];
    values.into_iter().try_for_each(|(limits, value, what)| {
        within(limits, value, || format!("the {what} of the liquid"))
    })
}

impl Container {
    fn check(&self, materials: usize) -> Result<(), Unsound> {
        let walls = self.walls.len();
        let fits = match self.shape {
            Shape::Planes => walls <= 1000,
            Shape::Box { min, max } => {
                let extent = (max - min).to_array();
                walls == 6 && extent.iter().all(|length| limits::LENGTH.accept(*length))
            }
            Shape::Drum { radius, width } => {
                walls == 3 && limits::LENGTH.accept(radius) && limits::LENGTH.accept(width)
            }
            Shape::Column { radius, height } => {
                (1..=2).contains(&walls)
                    && limits::LENGTH.accept(radius)
                    && limits::LENGTH.accept(height)
            }
            Shape::Mesh { min, max } => {
                let are_parts = |wall: &Wall| matches!(wall.surface, Surface::Mesh(_));
                (1..=MOST_PARTS).contains(&walls)
                    && self.walls.iter().all(are_parts)
                    && limits::LENGTH.accept((max - min).max_element())
            }
        };
        require(fits, || {
            format!("the container is {:?} of {walls} walls", self.shape)
        })?;
        number(self.angle, || "the container's angle".to_owned())?;
        self.walls.iter().try_for_each(|wall| wall.check(materials))
    }
}

impl Wall {
    fn check(&self, materials: usize) -> Result<(), Unsound> {
        let name = || format!("the wall `{}`", self.name);
        require(usize::from(self.material.0) < materials, || {
            format!("{} has no material", name())
        })?;
        vector(self.motion.velocity, LARGEST, name)?;
        vector(self.motion.spin, LARGEST, name)?;
        match &self.surface {
            Surface::Mesh(mesh) => {
                let flaw = mesh.flaw();
                require(flaw.is_none(), || {
                    format!("{} is {}", name(), flaw.unwrap_or_default())
                })
            }
            &Surface::Plane { point, normal } => {
                vector(point, FARTHEST, name)?;
                require(normal.is_normalized(), || {
                    format!("the normal of {} is {normal}", name())
                })
            }
            &Surface::Cylinder { radius } => within(&limits::LENGTH, radius, name),
            &Surface::Tube { radius, rim } => {
                within(&limits::LENGTH, radius, name)?;
                require(rim.abs() <= FARTHEST, || {
                    format!("the rim of {} is {rim:?}", name())
                })
            }
        }
    }
}

impl Grains {
    fn check(&self, species: usize) -> Result<(), Unsound> {
        let count = self.len();
        require(limits::GRAINS.accept(count as f64), || {
            format!(
                "it has {count} grains; expected {}",
                limits::GRAINS.expected
            )
        })?;
        self.check_lengths()?;
        for i in 0..count {
            let name = |what: &str| format!("the {what} of grain {i}");
            vector(self.position[i], FARTHEST, || name("position"))?;
            let vectors = [
                (self.velocity[i], "velocity"),
                (self.spin[i], "spin"),
                (self.force[i], "force"),
                (self.torque[i], "torque"),
                (self.rolling_torque[i], "rolling torque"),
            ];
            vectors
                .into_iter()
                .try_for_each(|(value, what)| vector(value, LARGEST, || name(what)))?;
            positive(self.radius[i], || name("radius"))?;
            positive(self.mass[i], || name("mass"))?;
            positive(self.inertia[i], || name("moment of inertia"))?;
            require(usize::from(self.species[i].0) < species, || {
                format!("grain {i} is of no species")
            })?;
            number(self.film[i], || name("film"))?;
            let energies = self.exchanged[i].into_iter().chain(self.liquid_loss[i]);
            energies
                .into_iter()
                .try_for_each(|value| number(value, || name("energy")))?;
        }
        Ok(())
    }

    fn check_lengths(&self) -> Result<(), Unsound> {
        let lengths = [
            (self.velocity.len(), "velocity"),
            (self.spin.len(), "spin"),
            (self.radius.len(), "radius"),
            (self.mass.len(), "mass"),
            (self.inertia.len(), "inertia"),
            (self.species.len(), "species"),
            (self.force.len(), "force"),
            (self.torque.len(), "torque"),
            (self.rolling_torque.len(), "rolling torque"),
            (self.contact_count.len(), "contact count"),
            (self.exchanged.len(), "exchanged energy"),
            (self.film.len(), "film"),
            (self.open_bridges.len(), "open bridge"),
            (self.liquid_loss.len(), "liquid loss"),
        ];
        lengths.into_iter().try_for_each(|(length, what)| {
            require(length == self.len(), || {
                format!(
                    "it has {length} entries of {what} for {} grains",
                    self.len()
                )
            })
        })
    }
}

impl Polyhedra {
    fn check(&self, grains: usize, walls: usize) -> Result<(), Unsound> {
        let lengths = [
            self.shape.len(),
            self.orientation.len(),
            self.angular_momentum.len(),
            self.inertia.len(),
        ];
        require(lengths == [grains; 4], || {
            format!("it has {lengths:?} entries of polyhedra for {grains} grains")
        })?;
        for (index, shape) in self.shapes.iter().enumerate() {
            require(shape.is_sound(), || {
                format!("shape {index} is no convex body")
            })?;
        }
        for i in 0..grains {
            let name = |what: &str| format!("the {what} of grain {i}");
            require((self.shape[i] as usize) < self.shapes.len(), || {
                format!("grain {i} has no shape")
            })?;
            require(self.orientation[i].is_normalized(), || {
                format!("{} is no unit quaternion", name("orientation"))
            })?;
            vector(self.angular_momentum[i], LARGEST, || {
                name("angular momentum")
            })?;
            self.inertia[i]
                .to_array()
                .into_iter()
                .try_for_each(|moment| positive(moment, || name("moment of inertia")))?;
        }
        self.check_features(grains, walls)
    }

    fn check_features(&self, grains: usize, walls: usize) -> Result<(), Unsound> {
        let order = |index: usize| {
            let contact = &self.features[index];
            (contact.grain, contact.partner, contact.feature)
        };
        for (index, contact) in self.features.iter().enumerate() {
            let name = |what: &str| format!("the {what} of feature contact {index}");
            is_between(contact.grain, contact.partner, grains, walls, || {
                format!("feature contact {index}")
            })?;
            require(index == 0 || order(index - 1) < order(index), || {
                format!("feature contact {index} is out of order or there twice")
            })?;
            require(
                self.has_feature(contact.grain, contact.partner, contact.feature),
                || format!("{} does not exist", name("feature")),
            )?;
            vector(contact.spring, LARGEST, || name("spring"))?;
            let numbers = [contact.overlap, contact.normal_memory, contact.stiffness];
            numbers
                .into_iter()
                .try_for_each(|value| number(value, || name("force")))?;
        }
        Ok(())
    }

    /// Whether the two sides of a contact have this feature. A wall has one face.
    fn has_feature(&self, grain: u32, partner: Partner, feature: Feature) -> bool {
        let counts = |shape: &Polyhedron| {
            let counts = [shape.vertices.len(), shape.edges.len(), shape.faces.len()];
            counts.map(|count| count as u16)
        };
        let [vertices, edges, faces] = counts(self.shape_of(grain as usize));
        let [other_vertices, other_edges, other_faces] = match partner {
            Partner::Grain(other) => counts(self.shape_of(other as usize)),
            Partner::Wall(_) => [0, 0, 1],
        };
        match feature {
            Feature::VertexFace(vertex, face) => vertex < vertices && face < other_faces,
            Feature::FaceVertex(face, vertex) => face < faces && vertex < other_vertices,
            Feature::EdgeEdge(edge, other) => edge < edges && other < other_edges,
            Feature::VertexVertex => vertices == 1 && other_vertices == 1,
        }
    }
}

impl Polyhedron {
    /// Whether it is a body that a world can hold: a sphere, or a convex core whose edges and
    /// faces lie between corners that exist.
    fn is_sound(&self) -> bool {
        let counts = [self.vertices.len(), self.edges.len(), self.faces.len()];
        counts.into_iter().all(|count| count <= MOST_FEATURES)
            && (self.is_sound_sphere() || self.is_sound_core())
    }
}
