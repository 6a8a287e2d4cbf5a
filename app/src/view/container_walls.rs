//! The container: walls that one sees, and sees through.
//!
//! In: the container of the world shown. Out: a few meshes, rebuilt when the container is another,
//! turned and moved with it. Every pane faces the grains and is drawn only from that side, so the
//! near walls never stand in the way; which side of a mesh's triangle that is, is told by the middle
//! of the bed when the mesh is built.

use crate::simulation::DrawnIn;
use crate::view::colour::{Scheme, round_up};
use crate::view::framing::{HOOP_BREADTH, expected_front, grain_box, ring_distance, surroundings};
use crate::view::shown_worlds::{ShownWorlds, ViewSystems, layers};
use crate::view::view_settings::ViewSettings;
use crate::view::wall_material::{NEVER_FADED, Pattern, SHADER, WallLook, WallMaterial};
use crate::view::wall_meshes::{Builder, disc, edges, rim, ring, tube};
use bevy::asset::load_internal_asset;
use bevy::camera::visibility::NoFrustumCulling;
use bevy::math::DVec3;
use bevy::prelude::*;
use grainfall::lab::Half;
use grainfall::world::{Container, Shape, Surface, Wall, World};

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
            (rebuild, paint, place).chain().in_set(ViewSystems::Draw),
        );
}

/// One drawn piece of the container.
#[derive(Component, Clone, Copy, PartialEq)]
enum WallPiece {
    /// Turns with the drum.
    Turning,
    /// Stays where it is.
    Fixed,
    /// Rises with the tube that is this wall.
    Tube {
        /// The wall's index.
        wall: usize,
    },
    /// Turns and moves with the part of a mesh that is this wall.
    Mesh {
        /// The wall's index.
        wall: usize,
    },
    /// Lies in the plane of a wall.
    Plane {
        /// The wall's index.
        wall: usize,
        /// The point whose foot on the plane is the piece's middle at first.
        near: DVec3,
        /// Distance after which its lines repeat; it moves by whole ones with grains in the open
        /// [m]. None where it stays.
        period: Option<f64>,
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

/// Cells from the middle to where a floor with a grid has faded away.
const FLOOR_CELLS: f32 = 40.0;

/// Every so many lines of a grid one is bold.
const BOLD_CELLS: f64 = 5.0;

/// What decides the meshes: the shape, of how many walls and triangles it is made, for planes how
/// long grains fly over them [s], and whether they are wanted twice.
type Built = (Shape, usize, f64, bool);

/// Of how many walls and triangles `wall` is made.
fn pieces_of(wall: &Wall) -> usize {
    match &wall.surface {
        Surface::Mesh(mesh) => 1 + mesh.part().triangles().len(),
        _ => 1,
    }
}

/// Builds the pieces anew when the container is another.
fn rebuild(
    mut commands: Commands,
    shown: Res<ShownWorlds>,
    mut built: Local<Option<Built>>,
    pieces: Query<Entity, With<WallPiece>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<WallMaterial>>,
) {
    let Some(world) = shown.world().filter(|_| shown.is_changed()) else {
        return;
    };
    let now = (
        world.container.shape,
        world.container.walls.iter().map(pieces_of).sum(),
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
                DrawnIn(half),
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
fn place(shown: Res<ShownWorlds>, mut pieces: Query<(&DrawnIn, &WallPiece, &mut Transform)>) {
    for (&DrawnIn(half), piece, mut transform) in &mut pieces {
        let Some(world) = shown.half(half) else {
            continue;
        };
        transform.set_if_neq(match *piece {
            WallPiece::Fixed => Transform::IDENTITY,
            WallPiece::Turning => {
                Transform::from_rotation(Quat::from_rotation_z(world.container.angle as f32))
            }
            WallPiece::Tube { wall } => tube_transform(&world.container, wall),
            WallPiece::Mesh { wall } => mesh_transform(&world.container, wall),
            WallPiece::Plane { wall, near, period } => {
                let near = under_grains(world, wall, near, period);
                plane_transform(&world.container, wall, near)
            }
        });
    }
}

/// The point whose foot on the plane `wall` is the middle of its piece now: below the grains of
/// `world`, but for less than one `period`.
fn under_grains(world: &World, wall: usize, near: DVec3, period: Option<f64>) -> DVec3 {
    let (Some(period), Some((min, max))) = (period, grain_box(world)) else {
        return near;
    };
    let turn = plane_transform(&world.container, wall, near)
        .rotation
        .as_dquat();
    let way = turn.inverse() * (0.5 * (min + max) - near);
    near + turn * ((way / period).round() * period)
}

/// Where the piece of the plane `wall` lies: its z axis along the normal, its middle at the foot of
/// `near`.
fn plane_transform(container: &Container, wall: usize, near: DVec3) -> Transform {
    let Some(&Surface::Plane { point, normal }) =
        container.walls.get(wall).map(|wall| &wall.surface)
    else {
        return Transform::IDENTITY;
    };
    let foot = near - normal * (near - point).dot(normal);
    Transform::from_translation(foot.as_vec3())
        .with_rotation(Quat::from_rotation_arc(Vec3::Z, normal.as_vec3()))
}

/// Where the piece of the tube `wall` is: its lower end at the rim.
fn tube_transform(container: &Container, wall: usize) -> Transform {
    match container.walls.get(wall).map(|wall| &wall.surface) {
        Some(Surface::Tube { rim, .. }) => Transform::from_xyz(0.0, *rim as f32, 0.0),
        _ => Transform::IDENTITY,
    }
}

/// Where the part of a mesh that is `wall` has come to: turned about its axis, or shifted.
fn mesh_transform(container: &Container, wall: usize) -> Transform {
    let Some(Surface::Mesh(mesh)) = container.walls.get(wall).map(|wall| &wall.surface) else {
        return Transform::IDENTITY;
    };
    let pose = mesh.pose();
    let turn = pose.axis().map_or(Quat::IDENTITY, |(_, axis)| {
        Quat::from_axis_angle(axis.as_vec3().normalize(), pose.angle() as f32)
    });
    Transform::from_translation(pose.place(DVec3::ZERO).as_vec3()).with_rotation(turn)
}

fn look(paint: Paint, settings: &ViewSettings) -> WallLook {
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
    WallLook {
        surface,
        line: with_alpha(scheme.line, if frame { 0.8 } else { 0.8 * opacity }),
        mark: with_alpha(scheme.mark, if frame { 1.0 } else { opacity.powf(0.3) }),
        fade,
        circle,
        unused: Vec2::ZERO,
    }
}

fn build(world: &World, watched: f64) -> Vec<(WallPiece, Paint, Mesh)> {
    let mut pieces = match world.container.shape {
        Shape::Drum { radius, width } => drum(radius as f32, width as f32),
        Shape::Box { min, max } => box_panes(min.as_vec3(), max.as_vec3()),
        Shape::Column { radius, height } => column_floors(world, radius, height),
        Shape::Planes => planes(world, watched),
        Shape::Mesh { min, max } => mesh_panes(world, (max - min).max_element()),
    };
    pieces.extend(tubes(world));
    pieces
}

/// Both plates and the rim from inside, and a hoop at each end.
fn drum(radius: f32, width: f32) -> Vec<(WallPiece, Paint, Mesh)> {
    let half = width / 2.0;
    let pane = |pattern, mesh| (WallPiece::Turning, Paint::Pane(pattern), mesh);
    let hoop = |mesh| (WallPiece::Turning, Paint::Frame(Pattern::Hoop), mesh);
    vec![
        pane(Pattern::Plate, disc(radius, -half, 1.0)),
        pane(Pattern::Plate, disc(radius, half, -1.0)),
        pane(Pattern::Rim, rim(radius, half)),
        hoop(ring(radius, -half)),
        hoop(ring(radius, half)),
    ]
}

/// The six sides from inside, with a grid, and the edges.
fn box_panes(min: Vec3, max: Vec3) -> Vec<(WallPiece, Paint, Mesh)> {
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
            pieces.push((WallPiece::Fixed, Paint::Pane(Pattern::Grid), builder.mesh()));
        }
    }
    pieces.push((
        WallPiece::Fixed,
        Paint::Frame(Pattern::Plain),
        edges(min, max),
    ));
    pieces
}

/// The parts of a mesh of this `size` [m], each a pane with a grid.
fn mesh_panes(world: &World, size: f64) -> Vec<(WallPiece, Paint, Mesh)> {
    let cell = round_up(size / 20.0) as f32;
    let bed = grain_box(world).map_or(DVec3::ZERO, |(min, max)| (min + max) / 2.0);
    let parts = world.container.walls.iter().enumerate();
    let parts = parts.filter_map(|(wall, own)| match &own.surface {
        Surface::Mesh(mesh) => Some((wall, mesh)),
        _ => None,
    });
    parts
        .map(|(wall, mesh)| {
            let mut builder = Builder::default();
            for (own, now) in mesh.part().triangles().iter().zip(mesh.triangles()) {
                let [a, b, c] = now;
                let faces_bed = (b - a).cross(c - a).dot(bed - a) > 0.0;
                let [a, b, c] = own.map(DVec3::as_vec3);
                mesh_triangle(
                    &mut builder,
                    if faces_bed { [a, b, c] } else { [a, c, b] },
                    cell,
                );
            }
            let pane = Paint::Pane(Pattern::Grid);
            (WallPiece::Mesh { wall }, pane, builder.mesh())
        })
        .collect()
}

/// Adds a triangle with a grid of this `cell` along the two axes that it leans towards least.
fn mesh_triangle(builder: &mut Builder, corners: [Vec3; 3], cell: f32) {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
    let steepest = normal.abs();
    let across = |x: Vec3| match steepest.max_element() {
        most if most == steepest.x => [x.y, x.z],
        most if most == steepest.y => [x.x, x.z],
        _ => [x.x, x.y],
    };
    let first = builder.indices.len() as u32;
    for corner in corners {
        builder.vertex(corner, normal, across(corner).map(|x| x / cell));
    }
    builder.indices.extend([first, first + 1, first + 2]);
}

/// A fading floor for each plane.
fn planes(world: &World, watched: f64) -> Vec<(WallPiece, Paint, Mesh)> {
    let (min, max) = surroundings(world, watched).unwrap_or((DVec3::ZERO, DVec3::ONE));
    let cell = round_up((max - min).max_element() / 16.0);
    let paint = Paint::Floor {
        pattern: Pattern::Grid,
        fade: FLOOR_CELLS,
        circle: 0.0,
    };
    let period = BOLD_CELLS * cell;
    floors(
        world,
        ((min + max) / 2.0, Some(period)),
        cell,
        FLOOR_CELLS,
        paint,
    )
}

/// A floor with rings round the axis of a column, the one on which it stood marked.
fn column_floors(world: &World, radius: f64, height: f64) -> Vec<(WallPiece, Paint, Mesh)> {
    let cell = ring_distance(radius);
    let fade = (2.0 * expected_front(radius, height) / cell) as f32;
    let paint = Paint::Floor {
        pattern: Pattern::Rings,
        fade,
        circle: (radius / cell) as f32,
    };
    floors(world, (DVec3::ZERO, None), cell, fade, paint)
}

/// A square of `half` cells to each side of the foot of `near` on each plane, which goes with the
/// grains by whole periods where it has one.
fn floors(
    world: &World,
    (near, period): (DVec3, Option<f64>),
    cell: f64,
    half: f32,
    paint: Paint,
) -> Vec<(WallPiece, Paint, Mesh)> {
    let cell = cell as f32;
    let is_plane = |wall: &usize| {
        let surface = &world.container.walls[*wall].surface;
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
            (
                WallPiece::Plane { wall, near, period },
                paint,
                builder.mesh(),
            )
        })
        .collect()
}

/// Each tube from inside, a little taller than what it holds, and a hoop at each end.
fn tubes(world: &World) -> Vec<(WallPiece, Paint, Mesh)> {
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
        let piece = WallPiece::Tube { wall };
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
