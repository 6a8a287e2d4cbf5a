//! Measures, each on data of known answer, and the small worlds built by hand that they are tried
//! on.

mod collapse;
mod column;
mod contacts;
mod deposit;
mod energy;
mod errors;
mod floor;
mod flow;
mod grain;
mod histogram;
mod mixing;
mod packing;
mod registry;
mod sample;
mod series;
mod surface;
mod temperature;
mod velocity_map;

use glam::{DQuat, DVec3};
use grainfall::physics::{ContactLaw, Material, MaterialId, Materials, PairProperties};
use grainfall::world::{
    Clock, Contact, Container, Feature, FeatureContact, Grains, Ledger, Partner, Polyhedra,
    Polyhedron, Shape, Species, SpeciesId, Surface, Wall, WallMotion, World,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const GLASS: MaterialId = MaterialId(0);
const STEEL: MaterialId = MaterialId(1);

/// A world without grains: species 0 is of glass, walls are of steel.
fn empty(shape: Shape, walls: Vec<Wall>) -> World {
    let material = |name: &str, youngs_modulus, poisson_ratio| Material {
        name: name.into(),
        youngs_modulus,
        poisson_ratio,
        density: 2500.0,
    };
    let list = vec![material("glass", 63e6, 0.21), material("steel", 12e6, 0.35)];
    let pair = PairProperties {
        restitution: 0.95,
        friction: 0.4,
        wet_friction: 0.4,
        rolling_friction: 0.01,
    };
    World {
        clock: Clock::new(1e-5),
        grains: Grains::default(),
        species: vec![Species {
            name: "grain".into(),
            material: GLASS,
        }],
        materials: Materials::new(list, |_, _| pair),
        container: Container {
            shape,
            walls,
            angle: 0.0,
        },
        gravity: DVec3::new(0.0, -9.81, 0.0),
        liquid: None,
        law: ContactLaw::HertzMindlin,
        contacts: Vec::new(),
        polyhedra: None,
        ledger: Ledger::default(),
    }
}

/// A drum of the paper's size, or any other, turning at `speed`.
fn drum(radius: f64, width: f64, speed: f64) -> World {
    let rim = Wall {
        name: "rim".into(),
        surface: Surface::Cylinder { radius },
        material: STEEL,
        motion: WallMotion::default(),
    };
    let mut world = empty(Shape::Drum { radius, width }, vec![rim]);
    world.container.set_drum_speed(speed);
    world
}

/// A box with one corner at the origin. Only its shape matters to the measures, so it has no walls.
fn open_box(size: DVec3) -> World {
    let shape = Shape::Box {
        min: DVec3::ZERO,
        max: size,
    };
    empty(shape, Vec::new())
}

/// No container but a floor at y = 0.
fn on_floor() -> World {
    let floor = Wall {
        name: "floor".into(),
        surface: Surface::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        },
        material: STEEL,
        motion: WallMotion::default(),
    };
    empty(Shape::Planes, vec![floor])
}

/// A floor on which a column of this radius and height stood; the species `first` and `second` of
/// materials of those names have the frictions `mu11`, `mu22` and 0.4 on the floor, mixed pairs the
/// harmonic mean.
fn column(radius: f64, height: f64, [mu11, mu22]: [f64; 2]) -> World {
    let material = |name: &str| Material {
        name: name.into(),
        youngs_modulus: 1e8,
        poisson_ratio: 0.2,
        density: 2650.0,
    };
    let friction = |a: MaterialId, b: MaterialId| match (a.0, b.0) {
        (0, 0) => mu11,
        (1, 1) => mu22,
        (0, 1) | (1, 0) => 2.0 * mu11 * mu22 / (mu11 + mu22),
        _ => 0.4,
    };
    let list = ["first", "second", "floor"].map(material).to_vec();
    let mut world = on_floor();
    world.materials = Materials::new(list, |a, b| PairProperties {
        restitution: 0.1,
        friction: friction(a, b),
        wet_friction: friction(a, b),
        rolling_friction: 0.0,
    });
    world.container.walls[0].material = MaterialId(2);
    world.container.shape = Shape::Column { radius, height };
    world.species = [0, 1]
        .map(|index| Species {
            name: ["first", "second"][index].into(),
            material: MaterialId(index as u16),
        })
        .to_vec();
    world
}

/// Adds a sphere of the species `kind` to a column.
fn put(world: &mut World, position: DVec3, radius: f64, kind: u16) {
    world
        .grains
        .push_sphere(position, radius, 2650.0, SpeciesId(kind));
}

/// Adds a grain that touches something, as grains in a bed do.
fn push(world: &mut World, position: DVec3, radius: f64) {
    world
        .grains
        .push_sphere(position, radius, 2500.0, SpeciesId(0));
    if let Some(count) = world.grains.contact_count.last_mut() {
        *count = 3;
    }
}

/// Records that `grain` touches `partner`.
fn touch(world: &mut World, grain: u32, partner: Partner, spring: DVec3) {
    world.contacts.push(Contact {
        grain,
        partner,
        spring,
        stiffness: 0.0,
        rolling: DVec3::ZERO,
        force: DVec3::ZERO,
        touching: true,
        bridge: None,
    });
}

/// Two bodies on the floor of a column, rounded by 0.2 and by 0.1 mm, without contacts.
fn two_rounded_bodies() -> World {
    let mut world = column(0.025, 0.05, [0.1, 0.4]);
    let shapes = [2e-4, 1e-4].map(Polyhedron::sphere);
    for (i, shape) in shapes.iter().enumerate() {
        put(&mut world, DVec3::X * 0.01 * i as f64, shape.rounding, 0);
    }
    let bodies = [(0, DQuat::IDENTITY), (1, DQuat::IDENTITY)];
    let polyhedra = Polyhedra::of_grains(&world.grains, shapes, &bodies);
    world.polyhedra = Some(Box::new(polyhedra));
    world
}

/// The contact of corner `corner` of `grain` with face 0 of `partner`.
fn feature(grain: u32, partner: Partner, corner: u16, overlap: f64) -> FeatureContact {
    FeatureContact {
        grain,
        partner,
        feature: Feature::VertexFace(corner, 0),
        overlap,
        normal_memory: 0.0,
        spring: DVec3::ZERO,
        stiffness: 2000.0,
    }
}

/// The points of a cubic lattice in a frame turned by `angle` about z, filling a drum of `radius`
/// and `width` up to `top` above its middle.
fn lattice_in_drum(
    radius: f64,
    width: f64,
    spacing: f64,
    angle: f64,
    top: f64,
) -> impl Iterator<Item = DVec3> {
    let turn = DQuat::from_rotation_z(angle);
    let across = (radius / spacing).ceil() as i32;
    let layers = (width / spacing).floor() as i32;
    (-across..=across)
        .flat_map(move |i| (0..2 * across).flat_map(move |j| (0..layers).map(move |k| (i, j, k))))
        .map(move |(i, j, k)| {
            let z = (f64::from(k) + 0.5) * width / f64::from(layers) - 0.5 * width;
            let (x, y) = (f64::from(i) * spacing, top - f64::from(j) * spacing);
            turn * DVec3::new(x, y, z)
        })
        .filter(move |x| x.truncate().length() < radius)
}

/// Numbers that look random but are always the same.
struct Noise(ChaCha8Rng);

impl Noise {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Evenly spread over 0 … 1.
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly spread over −1 … 1.
    fn centred(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.centred(), self.centred(), self.centred())
    }

    /// Normally spread with variance 1 (Box and Muller).
    fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.unit(), self.unit());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}

fn assert_close(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{value} is not {expected} ± {tolerance}"
    );
}
