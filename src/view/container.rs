//! The container: walls that one sees, and sees through.
//!
//! In: the container of the world shown. Out: a few meshes, rebuilt when the container is another, turned and moved with
//! it. Every pane faces the grains and is drawn only from that side, so the near walls never stand in the way.

use super::colour::{Scheme, round_up};
use super::{Shown, ViewSettings, layers};
use crate::simulation::Half;
use crate::world::{Container, Shape, Surface, World};
use bevy::asset::{RenderAssetUsages, load_internal_asset, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::math::DVec3;
use bevy::mesh::{Indices, MeshVertexBufferLayoutRef, PrimitiveTopology};
use bevy::pbr::{MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::shader::ShaderRef;
use std::f32::consts::TAU;

const SHADER: Handle<Shader> = uuid_handle!("f1b2a8a4-5d51-4a1e-8a2a-0d6ad0c3d0b2");
/// Segments of a circle.
const SEGMENTS: u32 = 180;
/// Breadth of a drum's hoops in its radius.
const HOOP_BREADTH: f32 = 0.045;

/// Adds the walls' material and what keeps them up to date.
pub(super) fn plugin(app: &mut App) {
    load_internal_asset!(
        app,
        SHADER,
        "../../assets/shaders/container.wgsl",
        Shader::from_wgsl
    );
    app.add_plugins(MaterialPlugin::<WallMaterial>::default())
        .add_systems(
            Update,
            (rebuild, paint, place)
                .chain()
                .in_set(super::ViewSystems::Draw),
        );
}

/// Ways longer than this many times the size of what flies are followed no further, so that grains stay large enough to see.
const FARTHEST: f64 = 30.0;

/// How far grains may leave their straight way, over its length.
const SWERVE: f64 = 0.12;

/// Points that a picture of `world` should hold: its container's, or, where that is unbounded, those of its grains and of
/// their way in the next `watched` seconds.
pub fn outline(world: &World, watched: f64) -> Vec<Vec3> {
    match world.container.shape {
        Shape::Drum { radius, width } => {
            let radius = radius as f32 * (1.0 + HOOP_BREADTH);
            let half = width as f32 / 2.0;
            (0..64)
                .flat_map(|i| {
                    let (sin, cos) = (TAU * i as f32 / 64.0).sin_cos();
                    [-half, half].map(|z| Vec3::new(radius * cos, radius * sin, z))
                })
                .collect()
        }
        Shape::Box { min, max } => corners(min.as_vec3(), max.as_vec3()).to_vec(),
        Shape::Column { radius, height } => column_outline(radius, height),
        Shape::Planes => surroundings(world, watched).map_or_else(Vec::new, |(min, max)| {
            corners(min.as_vec3(), max.as_vec3()).to_vec()
        }),
    }
}

/// The column as it stands and the floor that it will spread over, with some room for grains that roll on alone.
fn column_outline(radius: f64, height: f64) -> Vec<Vec3> {
    let front = 1.2 * expected_front(radius, height) as f32;
    let circle = |radius: f32, y: f32| {
        (0..64).map(move |i| {
            let (sin, cos) = (TAU * i as f32 / 64.0).sin_cos();
            Vec3::new(radius * cos, y, radius * sin)
        })
    };
    circle(front, 0.0)
        .chain(circle(radius as f32, height as f32))
        .collect()
}

/// Radius to which a column on a floor spreads [m], to a fifth or so: run-out over the radius is `α^1.35` for a height of
/// α radii, and grows with the root of α above 3.5 (after Man et al. 2023).
fn expected_front(radius: f64, height: f64) -> f64 {
    let aspect = height / radius;
    let low = aspect.min(3.5);
    radius * (1.0 + low.powf(1.35) * (aspect / low).sqrt())
}

/// Distance between the rings on the floor round a column of this `radius` [m].
pub(super) fn ring_distance(radius: f64) -> f64 {
    round_up(radius / 4.0)
}

/// The box round all grains and where they fly to in the `watched` seconds [s], with some room to swerve, and what they stand
/// on.
fn surroundings(world: &World, watched: f64) -> Option<(DVec3, DVec3)> {
    let (mut min, mut max) = grain_box(world)?;
    let grains = &world.grains;
    let largest = grains.radius.iter().copied().fold(0.0, f64::max);
    let farthest = FARTHEST * (max - min).max_element();
    let mut longest: f64 = 0.0;
    for (position, velocity) in grains.position.iter().zip(&grains.velocity) {
        let way = (watched * *velocity).clamp_length_max(farthest);
        (min, max) = (min.min(position + way), max.max(position + way));
        longest = longest.max(way.length());
    }
    let room = 2.0 * largest + SWERVE * longest;
    let (mut low, mut high) = (min - room, max + room);
    let middle = (min + max) / 2.0;
    let size = (high - low).max_element();
    for wall in &world.container.walls {
        if let Surface::Plane { point, normal } = wall.surface {
            let distance = (middle - point).dot(normal);
            if distance.abs() < 4.0 * size {
                let foot = middle - distance * normal;
                (low, high) = (low.min(foot), high.max(foot));
            }
        }
    }
    Some((low, high))
}

/// The box round all grains.
fn grain_box(world: &World) -> Option<(DVec3, DVec3)> {
    let grains = &world.grains;
    let reach = |i: usize| DVec3::splat(grains.radius[i]);
    (!grains.is_empty()).then(|| {
        (0..grains.len()).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), i| {
            let x = grains.position[i];
            (min.min(x - reach(i)), max.max(x + reach(i)))
        })
    })
}

fn corners(min: Vec3, max: Vec3) -> [Vec3; 8] {
    std::array::from_fn(|i| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 0 {
                min[axis]
            } else {
                max[axis]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}

/// One drawn piece of the container.
#[derive(Component, Clone, Copy, PartialEq)]
enum Piece {
    /// Turns with the drum.
    Turning,
    /// Stays where it is.
    Fixed,
    /// Rises with the tube that is this wall.
    Tube {
        /// The wall's index.
        wall: usize,
    },
    /// Lies in the plane of a wall.
    Plane {
        /// The wall's index.
        wall: usize,
        /// The point whose foot on the plane is the piece's middle.
        near: DVec3,
    },
}

/// What a piece is painted as.
#[derive(Component, Clone, Copy, PartialEq)]
enum Paint {
    /// A pane with lines of this pattern.
    Pane(Pattern),
    /// A floor whose lines fade with distance.
    Floor {
        /// Its lines.
        pattern: Pattern,
        /// Cells from the middle to where it has faded away.
        fade: f32,
        /// Radius of the circle that is marked, in cells.
        circle: f32,
    },
    /// Opaque frame.
    Frame(Pattern),
}

impl Paint {
    fn pattern(self) -> Pattern {
        match self {
            Self::Pane(pattern) | Self::Floor { pattern, .. } | Self::Frame(pattern) => pattern,
        }
    }
}

/// The lines on a piece and what its `uv` means: a definition of the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
enum Pattern {
    Plain,
    Plate,
    Rim,
    Grid,
    Hoop,
    Rings,
}

impl Pattern {
    fn definition(self) -> Option<&'static str> {
        match self {
            Self::Plain => None,
            Self::Plate => Some("PLATE"),
            Self::Rim => Some("RIM"),
            Self::Grid => Some("GRID"),
            Self::Hoop => Some("HOOP"),
            Self::Rings => Some("RINGS"),
        }
    }
}

/// Cells from the middle to where a floor with a grid has faded away.
const FLOOR_CELLS: f32 = 40.0;
/// The same for what never fades.
const NEVER_FADED: f32 = 1e30;

#[derive(Asset, TypePath, AsBindGroup, Clone)]
#[bind_group_data(WallKey)]
struct WallMaterial {
    #[uniform(0)]
    look: Look,
    alpha_mode: AlphaMode,
    pattern: Pattern,
    both_sides: bool,
}

#[derive(Clone, Copy, PartialEq, ShaderType)]
struct Look {
    surface: Vec4,
    line: Vec4,
    mark: Vec4,
    fade: f32,
    circle: f32,
    unused: Vec2,
}

/// What of a piece is part of the pipeline's key: its lines, and whether it is drawn from both sides.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
struct WallKey {
    pattern: Pattern,
    both_sides: bool,
}

impl From<&WallMaterial> for WallKey {
    fn from(material: &WallMaterial) -> Self {
        Self {
            pattern: material.pattern,
            both_sides: material.both_sides,
        }
    }
}

impl Material for WallMaterial {
    fn fragment_shader() -> ShaderRef {
        SHADER.into()
    }

    fn alpha_mode(&self) -> AlphaMode {
        self.alpha_mode
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }

    fn specialize(
        _pipeline: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let WallKey {
            pattern,
            both_sides,
        } = key.bind_group_data;
        if both_sides {
            descriptor.primitive.cull_mode = None;
        }
        if let (Some(fragment), Some(pattern)) = (&mut descriptor.fragment, pattern.definition()) {
            fragment.shader_defs.push(pattern.into());
        }
        Ok(())
    }
}

/// What decides the meshes: the shape, for planes how many there are and how long grains fly over them [s], and whether they
/// are wanted twice.
type Built = (Shape, usize, f64, bool);

/// Builds the pieces anew when the container is another.
fn rebuild(
    mut commands: Commands,
    shown: Res<Shown>,
    mut built: Local<Option<Built>>,
    pieces: Query<Entity, With<Piece>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<WallMaterial>>,
) {
    let Some(world) = shown.world().filter(|_| shown.is_changed()) else {
        return;
    };
    let now = (
        world.container.shape,
        world.container.walls.len(),
        shown.watched,
        shown.is_pair(),
    );
    if *built == Some(now) {
        return;
    }
    *built = Some(now);
    for piece in &pieces {
        commands.entity(piece).despawn();
    }
    let halves = &Half::ALL[..if shown.is_pair() { 2 } else { 1 }];
    for (piece, paint, mesh) in build(world, shown.watched) {
        let mesh = meshes.add(mesh);
        for half in halves.iter().copied() {
            commands.spawn((
                half,
                layers(half),
                piece,
                paint,
                Mesh3d(mesh.clone()),
                MeshMaterial3d(materials.add(WallMaterial {
                    look: look(paint, &ViewSettings::default()),
                    alpha_mode: AlphaMode::Blend,
                    pattern: paint.pattern(),
                    both_sides: false,
                })),
                NoFrustumCulling,
            ));
        }
    }
}

/// Gives each piece the colours of the settings.
fn paint(
    settings: Res<ViewSettings>,
    mut pieces: Query<(Ref<Paint>, &MeshMaterial3d<WallMaterial>, &mut Visibility)>,
    mut materials: ResMut<Assets<WallMaterial>>,
) {
    for (paint, material, mut visibility) in &mut pieces {
        visibility.set_if_neq(if settings.show_container {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        });
        let look = look(*paint, &settings);
        let stale = materials
            .get(&material.0)
            .is_some_and(|material| material.look != look);
        if (stale || paint.is_added())
            && let Some(mut material) = materials.get_mut(&material.0)
        {
            let frame = matches!(*paint, Paint::Frame(_));
            material.look = look;
            material.both_sides = frame;
            material.alpha_mode = if frame {
                AlphaMode::Opaque
            } else {
                AlphaMode::Blend
            };
        }
    }
}

/// Turns and moves each piece with its wall.
fn place(shown: Res<Shown>, mut pieces: Query<(&Half, &Piece, &mut Transform)>) {
    for (half, piece, mut transform) in &mut pieces {
        let Some(world) = shown.half(*half) else {
            continue;
        };
        transform.set_if_neq(match *piece {
            Piece::Fixed => Transform::IDENTITY,
            Piece::Turning => {
                Transform::from_rotation(Quat::from_rotation_z(world.container.angle as f32))
            }
            Piece::Tube { wall } => tube_transform(&world.container, wall),
            Piece::Plane { wall, near } => plane_transform(&world.container, wall, near),
        });
    }
}

/// Where the piece of the plane `wall` lies: its z axis along the normal, its middle at the foot of `near`.
fn plane_transform(container: &Container, wall: usize, near: DVec3) -> Transform {
    let Some(Surface::Plane { point, normal }) = container.walls.get(wall).map(|wall| wall.surface)
    else {
        return Transform::IDENTITY;
    };
    let foot = near - normal * (near - point).dot(normal);
    Transform::from_translation(foot.as_vec3())
        .with_rotation(Quat::from_rotation_arc(Vec3::Z, normal.as_vec3()))
}

/// Where the piece of the tube `wall` is: its lower end at the rim.
fn tube_transform(container: &Container, wall: usize) -> Transform {
    match container.walls.get(wall).map(|wall| wall.surface) {
        Some(Surface::Tube { rim, .. }) => Transform::from_xyz(0.0, rim as f32, 0.0),
        _ => Transform::IDENTITY,
    }
}

fn look(paint: Paint, settings: &ViewSettings) -> Look {
    let scheme = Scheme::of(settings.background);
    let opacity = settings.container_opacity.clamp(0.0, 1.0);
    let with_alpha = |colour: Color, alpha: f32| colour.to_linear().with_alpha(alpha).to_vec4();
    let surface = match paint {
        Paint::Pane(_) => with_alpha(scheme.surface, 0.55 * opacity),
        Paint::Floor { .. } => with_alpha(scheme.surface, 0.45 * opacity),
        Paint::Frame(_) => with_alpha(scheme.frame, 1.0),
    };
    let (fade, circle) = match paint {
        Paint::Floor { fade, circle, .. } => (fade, circle),
        Paint::Pane(_) | Paint::Frame(_) => (NEVER_FADED, 0.0),
    };
    let frame = matches!(paint, Paint::Frame(_));
    Look {
        surface,
        line: with_alpha(scheme.line, if frame { 0.8 } else { 0.8 * opacity }),
        mark: with_alpha(scheme.mark, if frame { 1.0 } else { opacity.powf(0.3) }),
        fade,
        circle,
        unused: Vec2::ZERO,
    }
}

fn build(world: &World, watched: f64) -> Vec<(Piece, Paint, Mesh)> {
    let mut pieces = match world.container.shape {
        Shape::Drum { radius, width } => drum(radius as f32, width as f32),
        Shape::Box { min, max } => box_panes(min.as_vec3(), max.as_vec3()),
        Shape::Column { radius, height } => column_floors(world, radius, height),
        Shape::Planes => planes(world, watched),
    };
    pieces.extend(tubes(world));
    pieces
}

/// Both plates and the rim from inside, and a hoop at each end.
fn drum(radius: f32, width: f32) -> Vec<(Piece, Paint, Mesh)> {
    let half = width / 2.0;
    let pane = |pattern, mesh| (Piece::Turning, Paint::Pane(pattern), mesh);
    let hoop = |mesh| (Piece::Turning, Paint::Frame(Pattern::Hoop), mesh);
    vec![
        pane(Pattern::Plate, disc(radius, -half, 1.0)),
        pane(Pattern::Plate, disc(radius, half, -1.0)),
        pane(Pattern::Rim, rim(radius, half)),
        hoop(ring(radius, -half)),
        hoop(ring(radius, half)),
    ]
}

/// The six sides from inside, with a grid, and the edges.
fn box_panes(min: Vec3, max: Vec3) -> Vec<(Piece, Paint, Mesh)> {
    let cell = round_up(f64::from((max - min).max_element()) / 20.0) as f32;
    let mut pieces = Vec::new();
    for axis in 0..3 {
        for (side, inward) in [(min, 1.0), (max, -1.0)] {
            let mut normal = Vec3::ZERO;
            normal[axis] = inward;
            let (u, v) = normal.any_orthonormal_pair();
            let (size, centre) = (max - min, (min + max) / 2.0);
            let middle = centre + normal * (side - centre).dot(normal);
            let (half_u, half_v) = (0.5 * size.dot(u.abs()), 0.5 * size.dot(v.abs()));
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let mut builder = Builder::default();
            for (a, b) in corners {
                let (a, b): (f32, f32) = (a * half_u, b * half_v);
                builder.vertex(middle + a * u + b * v, normal, [a / cell, b / cell]);
            }
            builder.indices.extend([0, 1, 2, 2, 3, 0]);
            pieces.push((Piece::Fixed, Paint::Pane(Pattern::Grid), builder.mesh()));
        }
    }
    pieces.push((Piece::Fixed, Paint::Frame(Pattern::Plain), edges(min, max)));
    pieces
}

/// A fading floor for each plane.
fn planes(world: &World, watched: f64) -> Vec<(Piece, Paint, Mesh)> {
    let (min, max) = surroundings(world, watched).unwrap_or((DVec3::ZERO, DVec3::ONE));
    let cell = round_up((max - min).max_element() / 16.0);
    let paint = Paint::Floor {
        pattern: Pattern::Grid,
        fade: FLOOR_CELLS,
        circle: 0.0,
    };
    floors(world, (min + max) / 2.0, cell, FLOOR_CELLS, paint)
}

/// A floor with rings round the axis of a column, the one on which it stood marked.
fn column_floors(world: &World, radius: f64, height: f64) -> Vec<(Piece, Paint, Mesh)> {
    let cell = ring_distance(radius);
    let fade = (2.0 * expected_front(radius, height) / cell) as f32;
    let paint = Paint::Floor {
        pattern: Pattern::Rings,
        fade,
        circle: (radius / cell) as f32,
    };
    floors(world, DVec3::ZERO, cell, fade, paint)
}

/// A square of `half` cells to each side of the foot of `near` on each plane.
fn floors(
    world: &World,
    near: DVec3,
    cell: f64,
    half: f32,
    paint: Paint,
) -> Vec<(Piece, Paint, Mesh)> {
    let cell = cell as f32;
    let is_plane = |wall: &usize| {
        let surface = world.container.walls[*wall].surface;
        matches!(surface, Surface::Plane { .. })
    };
    (0..world.container.walls.len())
        .filter(is_plane)
        .map(|wall| {
            let mut builder = Builder::default();
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let (x, y) = (x * half, y * half);
                builder.vertex(Vec3::new(x * cell, y * cell, 0.0), Vec3::Z, [x, y]);
            }
            builder.indices.extend([0, 1, 2, 2, 3, 0]);
            (Piece::Plane { wall, near }, paint, builder.mesh())
        })
        .collect()
}

/// Each tube from inside, a little taller than what it holds, and a hoop at each end.
fn tubes(world: &World) -> Vec<(Piece, Paint, Mesh)> {
    let height = match world.container.shape {
        Shape::Column { height, .. } => height,
        _ => grain_box(world).map_or(1.0, |(min, max)| max.y - min.y),
    };
    let height = 1.08 * height as f32;
    let mut pieces = Vec::new();
    for (wall, radius) in
        world
            .container
            .walls
            .iter()
            .enumerate()
            .filter_map(|(i, wall)| match wall.surface {
                Surface::Tube { radius, .. } => Some((i, radius as f32)),
                _ => None,
            })
    {
        let piece = Piece::Tube { wall };
        let breadth = 0.5 * HOOP_BREADTH * radius;
        let hoop = Paint::Frame(Pattern::Plain);
        pieces.extend([
            (
                piece,
                Paint::Pane(Pattern::Plain),
                tube(radius, 0.0, height),
            ),
            (piece, hoop, tube(radius, 0.0, breadth)),
            (piece, hoop, tube(radius, height - breadth, height)),
        ]);
    }
    pieces
}

/// The inside of an upright cylinder between two heights.
fn tube(radius: f32, low: f32, high: f32) -> Mesh {
    band(|sin, cos, end| {
        let y = if end == 0 { low } else { high };
        (
            Vec3::new(radius * cos, y, -radius * sin),
            Vec3::new(-cos, 0.0, sin),
        )
    })
}

/// A disc at `z` whose normal along z is `facing`.
fn disc(radius: f32, z: f32, facing: f32) -> Mesh {
    let mut builder = Builder::default();
    let normal = Vec3::Z * facing;
    builder.vertex(Vec3::Z * z, normal, [0.0, 0.0]);
    for i in 0..=SEGMENTS {
        let (sin, cos) = (TAU * i as f32 / SEGMENTS as f32).sin_cos();
        builder.vertex(Vec3::new(radius * cos, radius * sin, z), normal, [cos, sin]);
    }
    for i in 1..=SEGMENTS {
        let outer = if facing > 0.0 { [i, i + 1] } else { [i + 1, i] };
        builder.indices.extend([0, outer[0], outer[1]]);
    }
    builder.mesh()
}

/// The inside of a cylinder from −`half` to `half`.
fn rim(radius: f32, half: f32) -> Mesh {
    band(|sin, cos, end| {
        let z = if end == 0 { -half } else { half };
        (
            Vec3::new(radius * cos, radius * sin, z),
            -Vec3::new(cos, sin, 0.0),
        )
    })
}

/// A flat hoop round a circle at `z`.
fn ring(radius: f32, z: f32) -> Mesh {
    band(|sin, cos, end| {
        let radius = radius * (1.0 + HOOP_BREADTH * end as f32);
        (
            Vec3::new(radius * cos, radius * sin, z),
            Vec3::Z * z.signum(),
        )
    })
}

/// A closed band; `vertex` gives place and normal of each of its two ends at an azimuth.
fn band(vertex: impl Fn(f32, f32, u32) -> (Vec3, Vec3)) -> Mesh {
    let mut builder = Builder::default();
    for i in 0..=SEGMENTS {
        let turn = i as f32 / SEGMENTS as f32;
        let (sin, cos) = (TAU * turn).sin_cos();
        for end in 0..2 {
            let (place, normal) = vertex(sin, cos, end);
            builder.vertex(place, normal, [turn, end as f32]);
        }
    }
    for i in 0..SEGMENTS {
        let first = 2 * i;
        builder
            .indices
            .extend([first, first + 1, first + 2, first + 2, first + 1, first + 3]);
    }
    builder.mesh()
}

/// The twelve edges of a box as lines.
fn edges(min: Vec3, max: Vec3) -> Mesh {
    let corners = corners(min, max);
    let mut builder = Builder::default();
    for corner in corners {
        builder.vertex(corner, Vec3::Y, [0.0, 0.0]);
    }
    for a in 0..8_u32 {
        let higher = (0..3).map(|axis| a | 1 << axis).filter(|b| *b != a);
        builder.indices.extend(higher.flat_map(|b| [a, b]));
    }
    builder.mesh_of(PrimitiveTopology::LineList)
}

/// Collects a mesh.
#[derive(Default)]
struct Builder {
    places: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl Builder {
    fn vertex(&mut self, place: Vec3, normal: Vec3, uv: [f32; 2]) {
        self.places.push(place);
        self.normals.push(normal);
        self.uvs.push(uv);
    }

    fn mesh(self) -> Mesh {
        self.mesh_of(PrimitiveTopology::TriangleList)
    }

    fn mesh_of(self, topology: PrimitiveTopology) -> Mesh {
        Mesh::new(topology, RenderAssetUsages::RENDER_WORLD)
            .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.places)
            .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, self.normals)
            .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, self.uvs)
            .with_inserted_indices(Indices::U32(self.indices))
    }
}
