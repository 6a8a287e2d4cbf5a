//! Bevy's camera entities, which follow [`OrbitCamera`] and fill the free part of the window: one,
//! or one for each half.

use crate::simulation::DrawnIn;
use crate::view::camera::{HOME, OrbitCamera};
use crate::view::colour::Scheme;
use crate::view::cut_out::Ground;
use crate::view::framing::{grain_box, group_on_its_way, outline};
use crate::view::halves::{beside, parts, seen_part};
use crate::view::shown_worlds::{ShownWorlds, layers};
use crate::view::view_settings::{ProjectionKind, ViewSettings};
use bevy::camera::{ClearColorConfig, ScalingMode, SubCameraView, Viewport};
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::light::cluster::{ClusterConfig, GlobalClusterSettings};
use bevy::math::UVec2;
use bevy::prelude::*;
use bevy_egui::egui;
use grainfall::lab::Half;
use grainfall::world::{Shape, World};

/// Marks the cameras that show the worlds.
#[derive(Component)]
pub struct WorldCamera;

pub(super) fn spawn(mut commands: Commands, settings: Res<ViewSettings>) {
    let samples = if settings.smooth_edges {
        Msaa::Sample4
    } else {
        Msaa::Off
    };
    for half in Half::ALL {
        commands.spawn((WorldCamera, world_camera(half, half == Half::Left), samples));
    }
}

/// No lamp stands in a scene that would have to be looked for: the sun shines on all of it. Bevy 0.19
/// would look on the graphics device, with five pipelines to translate, and keep 40 bytes of each frame
/// for ever (`metadata_staging_pending_buffers`).
pub(super) fn look_for_no_lamps(clusters: Option<ResMut<GlobalClusterSettings>>) {
    if let Some(mut clusters) = clusters {
        clusters.gpu_clustering = None;
    }
}

/// A camera that shows the world in `half`.
pub(super) fn world_camera(half: Half, is_active: bool) -> impl Bundle {
    (
        DrawnIn(half),
        layers(half),
        Camera3d::default(),
        Camera {
            // The left one clears the picture for both.
            order: half.index().cast_signed(),
            is_active,
            ..default()
        },
        Tonemapping::None,
        DebandDither::Disabled,
        ClusterConfig::Single,
    )
}

/// What the picture was last fitted to.
#[derive(Resource, Default)]
pub(super) struct Framed {
    /// The scene, as far as its framing goes, and how often a person had asked then.
    of: Option<(Shape, usize, usize, u32)>,
    /// The points that must be seen.
    outline: Vec<Vec3>,
    /// The state that grains were last looked for in.
    looked_at: u64,
    /// The camera after fitting.
    camera: Option<OrbitCamera>,
    /// The middle of the group that the picture goes with, where it was last.
    group: Option<Vec3>,
}

impl Framed {
    /// The points that must be seen.
    pub(super) fn outline(&self) -> &[Vec3] {
        &self.outline
    }

    /// Goes with the grains of `world`, the middle of which was at `before`.
    fn ride(&mut self, before: Vec3, world: &World, camera: &mut OrbitCamera) {
        let Some((min, max)) = grain_box(world) else {
            return;
        };
        let way = (0.5 * (min + max)).as_vec3() - before;
        if way == Vec3::ZERO {
            return;
        }
        self.group = Some(before + way);
        for corner in &mut self.outline {
            *corner += way;
        }
        let is_fitted = self.camera.as_ref() == Some(camera);
        camera.focus += way;
        if is_fitted {
            self.camera = Some(camera.clone());
        }
    }
}

/// Carries out what was asked of the camera, and keeps the scene fitted until a person moves away.
/// An unbounded scene is measured anew when a grain leaves the picture: then it fits where the grains
/// are and are going. Where grains are on a long way, the picture goes with them.
pub(super) fn steer(
    mut settings: ResMut<ViewSettings>,
    mut camera: ResMut<OrbitCamera>,
    shown: Res<ShownWorlds>,
    mut framed: ResMut<Framed>,
) {
    if let Some(request) = settings.bypass_change_detection().camera_request.take() {
        camera.follow(request);
    }
    if camera.projection != settings.projection {
        camera.projection = settings.projection;
    }
    if let Some(world) = shown.world() {
        let (shape, walls) = (world.container.shape, world.container.walls.len());
        let of = Some((shape, walls, world.grains.len(), camera.requests()));
        if framed.of != of {
            camera.set_home(home(shape));
            let group = group_on_its_way(world, shown.watched);
            *framed = Framed {
                of,
                outline: outline(world, shown.watched),
                group: group
                    .filter(|_| !shown.is_pair())
                    .map(|(middle, _)| middle.as_vec3()),
                ..Framed::default()
            };
        }
        if camera.fits
            && let Some(group) = framed.group
        {
            framed.ride(group, world, &mut camera);
        }
        if camera.fits && framed.looked_at != world.clock.step && framed.camera.is_some() {
            framed.looked_at = world.clock.step;
            if shown.worlds().any(|world| leaves_picture(world, &camera)) {
                let outlines = shown.worlds().map(|world| outline(world, shown.watched));
                framed.outline = outlines.flatten().collect();
                framed.camera = None;
            }
        }
    }
    if settings.follows_selected
        && let Some(world) = shown.world()
        && let Some(place) = settings
            .selected
            .and_then(|grain| world.grains.position.get(grain))
    {
        let place = place.as_vec3();
        if camera.focus != place {
            (camera.focus, camera.fits) = (place, false);
        }
    }
    if camera.fits && framed.camera.as_ref() != Some(&*camera) && !framed.outline.is_empty() {
        camera.fit(&framed.outline);
        framed.camera = Some(camera.clone());
    }
}

/// Whether a grain of an unbounded `world` is outside the picture.
fn leaves_picture(world: &World, camera: &OrbitCamera) -> bool {
    let is_open = matches!(world.container.shape, Shape::Planes);
    is_open && !(world.grains.position.iter()).all(|x| camera.sees(x.as_vec3()))
}

/// Yaw and pitch of the view that a scene opens with [rad]: for a column from higher up, so that
/// its front is seen.
fn home(shape: Shape) -> (f32, f32) {
    match shape {
        Shape::Column { .. } => (0.55, 0.3),
        Shape::Planes | Shape::Box { .. } | Shape::Drum { .. } | Shape::Mesh { .. } => HOME,
    }
}

/// A camera of Bevy's, and where it stands.
pub(super) type Placed = (
    &'static DrawnIn,
    &'static mut Camera,
    &'static mut Transform,
    &'static mut Projection,
);

/// Moves Bevy's cameras to where [`OrbitCamera`] is, each with its part of the picture.
pub(super) fn follow(
    settings: Res<ViewSettings>,
    shown: Res<ShownWorlds>,
    mut orbit: ResMut<OrbitCamera>,
    mut cameras: Query<Placed, With<WorldCamera>>,
) {
    let draws =
        (cameras.iter()).any(|(&DrawnIn(half), camera, ..)| half == Half::Left && camera.is_active);
    let count = if shown.is_pair() { 2 } else { 1 };
    for (&DrawnIn(half), camera, transform, projection) in &mut cameras {
        let placed = (half, camera, transform, projection);
        place(
            placed,
            count,
            (&*settings, Ground::Chosen),
            &mut orbit,
            draws,
        );
    }
}

/// Puts the camera of a `half` of so many where `orbit` is, with its part of the picture.
pub(super) fn place(
    (half, mut camera, mut transform, mut projection): (
        Half,
        Mut<Camera>,
        Mut<Transform>,
        Mut<Projection>,
    ),
    count: usize,
    (settings, ground): (&ViewSettings, Ground),
    orbit: &mut OrbitCamera,
    draws: bool,
) {
    if half == Half::Left {
        let chosen = Scheme::of(settings.background).background;
        camera.clear_color = ClearColorConfig::Custom(ground.colour(chosen));
    } else {
        camera.clear_color = ClearColorConfig::None;
        camera.is_active = draws && count > 1;
    }
    if let Some(target) = camera.physical_target_size() {
        let whole = egui::Rect::from_min_size(egui::Pos2::ZERO, points(target, settings));
        let free = settings.free_rect.or((count > 1).then_some(whole));
        let free = free.map(|free| beside(free, settings.margin));
        let part = free.and_then(|free| parts(free, count).nth(half.index()));
        let is_last = half.index() + 1 == count;
        let seen = part.map(|part| seen_part(part, is_last, settings.free_margin()));
        let [framed, seen] =
            [part, seen].map(|part| viewport(part, settings.pixels_per_point, target));
        let shape = framed.as_ref().map_or(target, |v| v.physical_size);
        if settings.free_rect.is_none() && half == Half::Left {
            orbit.viewport = shape.as_vec2();
        }
        camera.sub_camera_view = wider_view(framed.as_ref(), seen.as_ref());
        camera.viewport = seen;
    }
    *transform = Transform::from_translation(orbit.eye()).with_rotation(orbit.rotation());
    *projection = seen_by(orbit);
}

/// What is `seen` of a scene that is `framed` in the left part of that, where it is more.
fn wider_view(framed: Option<&Viewport>, seen: Option<&Viewport>) -> Option<SubCameraView> {
    let (full_size, size) = (framed?.physical_size, seen?.physical_size);
    (size != full_size).then_some(SubCameraView {
        full_size,
        offset: Vec2::ZERO,
        size,
    })
}

/// The size of a target in egui points.
fn points(target: UVec2, settings: &ViewSettings) -> egui::Vec2 {
    let size = target.as_vec2() / settings.pixels_per_point;
    egui::vec2(size.x, size.y)
}

fn seen_by(orbit: &OrbitCamera) -> Projection {
    match orbit.projection {
        ProjectionKind::Perspective => Projection::Perspective(PerspectiveProjection {
            fov: orbit.field_of_view(),
            near: 0.02 * orbit.distance(),
            far: 100.0 * orbit.distance(),
            ..default()
        }),
        ProjectionKind::Orthographic => Projection::Orthographic(OrthographicProjection {
            near: 0.0,
            far: 2.0 * orbit.distance(),
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: orbit.height,
            },
            ..OrthographicProjection::default_3d()
        }),
    }
}

/// The pixels of the free rectangle, kept inside a target of `size` pixels; `None` for all of it.
fn viewport(free: Option<egui::Rect>, pixels_per_point: f32, size: UVec2) -> Option<Viewport> {
    let free = free?;
    let limit = size.as_vec2();
    let corner = |at: egui::Pos2| {
        (Vec2::new(at.x, at.y) * pixels_per_point)
            .round()
            .clamp(Vec2::ZERO, limit)
    };
    let (min, max) = (corner(free.min), corner(free.max));
    let room = (max - min).as_uvec2();
    (room.min_element() > 0).then(|| Viewport {
        physical_position: min.as_uvec2(),
        physical_size: room,
        ..default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainfall::scene::Scene;
    use grainfall::solver::advise;
    use grainfall::world;
    use std::sync::Arc;

    #[test]
    fn picture_fills_the_free_rectangle_in_pixels() {
        let free = egui::Rect::from_min_max(egui::pos2(300.0, 30.0), egui::pos2(1000.0, 700.0));
        let viewport = viewport(Some(free), 1.5, UVec2::new(1920, 1080)).unwrap();
        assert_eq!(viewport.physical_position, UVec2::new(450, 45));
        // The lower edge, at 1050, lies inside; the right one, at 1500, too.
        assert_eq!(viewport.physical_size, UVec2::new(1050, 1005));
    }

    #[test]
    fn picture_never_leaves_the_window() {
        let free = egui::Rect::from_min_max(egui::pos2(300.0, 30.0), egui::pos2(5000.0, 700.0));
        let viewport = viewport(Some(free), 1.0, UVec2::new(800, 600)).unwrap();
        let end = viewport.physical_position + viewport.physical_size;
        assert!(end.cmple(UVec2::new(800, 600)).all());
        let none = egui::Rect::from_min_max(egui::pos2(900.0, 0.0), egui::pos2(950.0, 100.0));
        assert!(super::viewport(Some(none), 1.0, UVec2::new(800, 600)).is_none());
    }

    #[test]
    fn a_grain_that_leaves_the_picture_is_followed_until_somebody_moves_away() {
        let scene = Scene::open("slide-to-roll").unwrap();
        let mut world = world::build(&scene, advise(&scene).time_step);
        let mut app = App::new();
        app.init_resource::<ViewSettings>()
            .init_resource::<OrbitCamera>()
            .init_resource::<ShownWorlds>()
            .init_resource::<Framed>()
            .add_systems(Update, steer);
        let show = |app: &mut App, world: &World| {
            let mut shown = app.world_mut().resource_mut::<ShownWorlds>();
            shown.watched = 0.3;
            shown.show(Some(Arc::new(world.clone())));
            app.update();
            app.update();
            let grain = world.grains.position[0].as_vec3();
            app.world().resource::<OrbitCamera>().sees(grain)
        };
        assert!(show(&mut app, &world));
        for _ in 0..3 {
            world.clock.step += 1000;
            world.grains.position[0].x += 0.7;
            assert!(show(&mut app, &world), "{}", world.grains.position[0]);
        }
        let mut settings = app.world_mut().resource_mut::<ViewSettings>();
        (settings.selected, settings.follows_selected) = (Some(0), true);
        world.grains.position[0].y += 3.0;
        world.clock.step += 1000;
        assert!(show(&mut app, &world));
        let focus = app.world().resource::<OrbitCamera>().focus;
        assert_eq!(focus, world.grains.position[0].as_vec3());
        (app.world_mut().resource_mut::<ViewSettings>()).follows_selected = false;
        let mut camera = app.world_mut().resource_mut::<OrbitCamera>();
        camera.pan(Vec2::new(5.0, 0.0));
        world.clock.step += 1000;
        world.grains.position[0].x += 0.7;
        assert!(!show(&mut app, &world));
    }

    #[test]
    fn a_grain_that_slides_far_is_seen_large_all_the_way() {
        let scene = Scene::open("slide-to-roll").unwrap();
        let mut world = world::build(&scene, advise(&scene).time_step);
        let mut app = App::new();
        app.init_resource::<ViewSettings>()
            .init_resource::<OrbitCamera>()
            .init_resource::<ShownWorlds>()
            .init_resource::<Framed>()
            .add_systems(Update, steer);
        let mut places = Vec::new();
        for _ in 0..30 {
            let mut shown = app.world_mut().resource_mut::<ShownWorlds>();
            shown.watched = 0.5 * scene.duration;
            shown.show(Some(Arc::new(world.clone())));
            app.update();
            let camera = app.world().resource::<OrbitCamera>();
            let grain = world.grains.position[0].as_vec3();
            let (place, points_per_metre) = camera.project(grain).unwrap();
            let across = 2.0 * world.grains.radius[0] as f32 * points_per_metre;
            assert!(across > 60.0, "{across}");
            places.push(place);
            world.clock.step += 100;
            world.grains.position[0].x += 0.01;
        }
        // A tenth of a point: single precision.
        let moved = places.iter().map(|place| (*place - places[0]).length());
        assert!(moved.fold(0.0, f32::max) < 0.1, "{places:?}");
    }
}
