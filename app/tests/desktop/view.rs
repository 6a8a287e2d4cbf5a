//! Claims about pictures: each grain is where and as large as the camera says, coloured as the map
//! says, cut as asked.
//!
//! They need a Vulkan driver, a software one will do. Where there is none they say that they did
//! not run, or fail if `GRAINFALL_REQUIRE_VULKAN` is set.

use crate::window_of_panels::standing;
use bevy::app::Plugins;
use bevy::camera::visibility::RenderLayers;
use bevy::ecs::message::Messages;
use bevy::light::cluster::GlobalClusterSettings;
use bevy::math::{UVec2, Vec2, Vec3};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::view::screenshot::ScreenshotCaptured;
use bevy_egui::{
    EguiContexts, EguiGlobalSettings, EguiPlugin, EguiPrimaryContextPass, PrimaryEguiContext, egui,
};
use glam::DVec3;
use grainfall::lab::{Options, Status};
use grainfall::measure::GrainQuantity;
use grainfall::physics::{ContactLaw, Material, MaterialId, Materials, PairProperties};
use grainfall::scene::Scene;
use grainfall::world::{
    Bridge, Clock, Contact, Container, Grains, Ledger, Partner, Shape, Species, SpeciesId, Surface,
    Wall, WallMotion, World,
};
use grainfall_app::simulation::{Simulation, SimulationPlugin};
use grainfall_app::ui::UiPlugin;
use grainfall_app::view::{
    Background, ColourBy, ColourMap, ColourRange, CoordinateAxis, Cut, OrbitCamera, ProjectionKind,
    ShownWorlds, StandardView, ViewPlugin, ViewSettings, save_png, species_colour,
};
use grainfall_app::window::canvas::{
    Canvas, CanvasPlugin, WARM_UP, make_ready, offscreen_plugins, screenshot,
};
use grainfall_app::window::environment::adapters;
use grainfall_app::window::pipelines::Pipelines;
use std::io::Write;
use std::panic::Location;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

pub const SIZE: UVec2 = UVec2::new(640, 360);

/// One picture at a time: a software driver takes every core.
static STUDIO: Mutex<()> = Mutex::new(());

/// Leave to draw, or a word that the test that asks did not run.
#[track_caller]
pub fn studio() -> Option<MutexGuard<'static, ()>> {
    let guard = STUDIO.lock().unwrap_or_else(PoisonError::into_inner);
    keep_drivers();
    if !adapters().is_empty() {
        return Some(guard);
    }
    assert!(
        std::env::var_os("GRAINFALL_REQUIRE_VULKAN").is_none(),
        "no Vulkan driver, though GRAINFALL_REQUIRE_VULKAN is set"
    );
    let test = Location::caller();
    // Straight to the stream: the test runner swallows what `eprintln!` says in a test that passes.
    let _ = writeln!(
        std::io::stderr(),
        "the test at {test} did not run: no Vulkan driver"
    );
    None
}

/// Keeps the drivers loaded from test to test: some cannot be loaded any number of times by one
/// process.
fn keep_drivers() {
    static KEPT: OnceLock<wgpu::Instance> = OnceLock::new();
    KEPT.get_or_init(
        || wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle()),
    );
}

/// A picture and the camera it was taken with.
pub struct Photograph {
    pixels: Vec<u8>,
    pub camera: OrbitCamera,
}

impl Photograph {
    pub fn at(&self, place: Vec2) -> [u8; 3] {
        let (x, y) = (place.x.floor() as usize, place.y.floor() as usize);
        let start = 4 * (y * SIZE.x as usize + x);
        [0, 1, 2].map(|channel| self.pixels[start + channel])
    }

    /// How far the pixel is from the background.
    pub fn contrast(&self, place: Vec2) -> u8 {
        let background = self.at(Vec2::new(2.0, 2.0));
        let seen = self.at(place);
        (0..3)
            .map(|i| seen[i].abs_diff(background[i]))
            .max()
            .unwrap()
    }

    /// Whether a grain covers the pixel.
    pub fn covered(&self, place: Vec2) -> bool {
        self.contrast(place) > 30
    }

    /// From `place` outwards, where the contrast falls below half of that just inside the edge
    /// expected [pixels].
    fn reach(&self, place: Vec2, direction: Vec2, expected: f32) -> f32 {
        let inside = self.contrast(place + (expected - 2.0) * direction);
        (0..800)
            .map(|i| 0.25 * i as f32)
            .find(|distance| self.contrast(place + *distance * direction) < inside / 2)
            .unwrap()
    }
}

pub fn photograph(
    name: &str,
    world: World,
    set: impl FnOnce(&mut ViewSettings, &mut OrbitCamera),
) -> Photograph {
    photograph_of(name, |shown| shown.show(Some(Arc::new(world))), set)
}

/// A picture of what `show` shows.
pub fn photograph_of(
    name: &str,
    show: impl FnOnce(&mut ShownWorlds),
    set: impl FnOnce(&mut ViewSettings, &mut OrbitCamera),
) -> Photograph {
    let mut app = App::new();
    app.add_plugins(offscreen_plugins().disable::<bevy::log::LogPlugin>())
        .add_plugins((CanvasPlugin(SIZE), ViewPlugin));
    let mut settings = ViewSettings::default();
    let mut camera = OrbitCamera::default();
    set(&mut settings, &mut camera);
    app.insert_resource(settings).insert_resource(camera);
    show(&mut app.world_mut().resource_mut::<ShownWorlds>());
    make_ready(&mut app);
    photographed(&mut app, name)
}

/// A laboratory without panels that draws a grain that falls, on a canvas of this `size`, with
/// these `plugins` more.
pub fn laboratory<M>(size: UVec2, options: Options, plugins: impl Plugins<M>) -> App {
    let mut app = App::new();
    app.add_plugins(offscreen_plugins().disable::<bevy::log::LogPlugin>())
        .add_plugins((CanvasPlugin(size), SimulationPlugin, ViewPlugin))
        .add_plugins(plugins);
    let scene = Scene::open("bouncing-grain").unwrap();
    app.insert_resource(Simulation::open(scene, options));
    make_ready(&mut app);
    while *app.world().resource::<Simulation>().status() != Status::Paused {
        app.update();
    }
    app
}

/// A camera that draws panels over the picture.
pub fn panel_camera(app: &mut App) {
    app.insert_resource(EguiGlobalSettings {
        auto_create_primary_context: false,
        ..default()
    });
    let camera = Camera {
        order: 2,
        clear_color: ClearColorConfig::None,
        ..default()
    };
    app.world_mut()
        .spawn((PrimaryEguiContext, Camera2d, RenderLayers::none(), camera));
}

/// Words over the picture.
#[derive(Resource)]
struct Words(&'static str);

fn write_words(words: Res<Words>, mut contexts: EguiContexts) -> Result {
    let area = egui::Area::new(egui::Id::new("words"));
    area.show(contexts.ctx_mut()?, |ui| ui.label(words.0));
    Ok(())
}

/// Once a letter's picture reached the renderer a frame after the letter: numbers on the plots had
/// holes.
#[test]
fn a_letter_is_there_in_the_frame_that_first_shows_it() {
    let Some(_studio) = studio() else {
        return;
    };
    let options = standing();
    let mut app = laboratory(
        SIZE,
        options.clone(),
        (EguiPlugin::default(), UiPlugin { options }),
    );
    app.insert_resource(Words("known"))
        .add_systems(EguiPrimaryContextPass, write_words);
    let mut changed_images = |words: &'static str| {
        app.insert_resource(Words(words)).update();
        let messages = app.world().resource::<Messages<AssetEvent<Image>>>();
        messages.iter_current_update_messages().count()
    };
    for _ in 0..2 * WARM_UP {
        changed_images("known");
    }
    assert_eq!(changed_images("known"), 0);
    assert!(changed_images("ßþĦ") > 0);
}

/// The picture that `app` shows now.
pub fn photographed(app: &mut App, name: &str) -> Photograph {
    for _ in 0..WARM_UP {
        app.update();
    }
    let has_pipelines = (0..2000).any(|_| {
        app.update();
        app.world().resource::<Pipelines>().are_made()
    });
    assert!(has_pipelines, "the renderer still makes pipelines");
    let taken: Arc<Mutex<Option<Image>>> = Arc::default();
    let slot = taken.clone();
    let canvas = app.world().resource::<Canvas>().clone();
    app.world_mut().spawn(screenshot(Some(&canvas))).observe(
        move |captured: On<ScreenshotCaptured>| {
            *slot.lock().unwrap() = Some(captured.image.clone());
        },
    );
    let image = (0..100)
        .find_map(|_| {
            app.update();
            taken.lock().unwrap().take()
        })
        .expect("a picture within a hundred frames");
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    save_png(&image, None, &folder.join(format!("{name}.png"))).unwrap();
    Photograph {
        pixels: image.data.unwrap(),
        camera: app.world().resource::<OrbitCamera>().clone(),
    }
}

pub fn world(shape: Shape, walls: Vec<Surface>) -> World {
    let glass = Material {
        name: "glass".to_owned(),
        youngs_modulus: 63e6,
        poisson_ratio: 0.21,
        density: 2500.0,
    };
    let pair = PairProperties {
        restitution: 0.9,
        friction: 0.4,
        wet_friction: 0.4,
        rolling_friction: 0.01,
    };
    let species = |name: &str| Species {
        name: name.to_owned(),
        material: MaterialId(0),
    };
    World {
        clock: Clock::new(1e-5),
        grains: Grains::default(),
        species: vec![species("small"), species("large")],
        materials: Materials::new(vec![glass], |_, _| pair),
        container: Container {
            shape,
            walls: walls
                .into_iter()
                .map(|surface| Wall {
                    name: "wall".to_owned(),
                    surface,
                    material: MaterialId(0),
                    motion: WallMotion::default(),
                })
                .collect(),
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

/// Five grains of several sizes, apart from each other in every view used here, without walls.
fn five_grains() -> World {
    let mut world = world(Shape::Planes, Vec::new());
    for (x, y, z, radius) in [
        (0.0, 0.0, 0.0, 6e-3),
        (-0.05, 0.02, 0.01, 3e-3),
        (0.05, -0.02, -0.02, 4e-3),
        (0.03, 0.025, 0.015, 2e-3),
        (-0.03, -0.025, 0.0, 5e-3),
    ] {
        let species = SpeciesId(u16::from(x > 0.0));
        world
            .grains
            .push_sphere(DVec3::new(x, y, z), radius, 2500.0, species);
    }
    world
}

/// The ends of a sphere's outline, an ellipse in perspective, along the line from the picture's
/// middle through its own: found from the angles at the eye.
fn outline(camera: &OrbitCamera, centre: Vec3, radius: f32) -> (Vec2, Vec2) {
    let (place, per_metre) = camera.project(centre).unwrap();
    let middle = camera.viewport / 2.0;
    let outward = (place - middle).try_normalize().unwrap_or(Vec2::X);
    if camera.projection == ProjectionKind::Orthographic {
        let half = outward * radius * per_metre;
        return (place - half, place + half);
    }
    let eye = camera.eye();
    let forward = camera.rotation() * Vec3::NEG_Z;
    let (to_centre, distance) = (centre - eye, (centre - eye).length());
    let away = to_centre.angle_between(forward);
    let half_angle = (radius / distance).asin();
    let focal = camera.distance() / camera.metres_per_point();
    let place_at = |angle: f32| middle + outward * focal * angle.tan();
    (place_at(away - half_angle), place_at(away + half_angle))
}

/// That took five pipelines, and 40 bytes of each frame for good.
#[test]
fn no_lamps_are_looked_for_on_the_graphics_device() {
    let Some(_guard) = studio() else { return };
    let mut app = laboratory(SIZE, standing(), ());
    app.update();
    let pictures = app.sub_app(RenderApp).world();
    for world in [app.world(), pictures] {
        let clusters = world.resource::<GlobalClusterSettings>();
        assert!(clusters.gpu_clustering.is_none());
    }
}

#[test]
fn grains_are_where_and_as_large_as_the_camera_says() {
    let Some(_studio) = studio() else {
        return;
    };
    for projection in [ProjectionKind::Perspective, ProjectionKind::Orthographic] {
        let grains = five_grains().grains;
        let name = format!("five-{projection:?}");
        let photograph = photograph(&name, five_grains(), |settings, _| {
            settings.projection = projection;
        });
        for i in 0..grains.len() {
            let (near, far) = outline(
                &photograph.camera,
                grains.position[i].as_vec3(),
                grains.radius[i] as f32,
            );
            let (place, radius) = ((near + far) / 2.0, (far - near).length() / 2.0);
            let outward = (far - near).normalize();
            for direction in [outward, -outward] {
                let reach = photograph.reach(place, direction, radius);
                // Half a pixel for the raster, half for where a smoothed edge counts as covered.
                assert!(
                    (reach - radius).abs() <= 1.0,
                    "{projection:?} grain {i}: {reach} pixels towards {direction}, not {radius}"
                );
            }
        }
    }
}

#[test]
fn colours_are_those_of_the_map() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut world = five_grains();
    let speeds = [0.0, 0.25, 0.5, 0.75, 1.0];
    for (velocity, speed) in world.grains.velocity.iter_mut().zip(speeds) {
        *velocity = DVec3::new(0.0, speed, 0.0);
    }
    let positions = world.grains.position.to_vec();
    let photograph = photograph("speed", world, |settings, _| {
        settings.colour_by = ColourBy::Quantity(GrainQuantity::Speed);
        settings.range = ColourRange::Fixed(0.0, 1.0);
    });
    for (position, speed) in positions.iter().zip(speeds) {
        let place = photograph.camera.project(position.as_vec3()).unwrap().0;
        let seen = photograph.at(place).map(f32::from);
        let nearest = (0..=20).min_by_key(|t| {
            let colour = ColourMap::Viridis
                .colour(f64::from(*t) / 20.0)
                .map(f32::from);
            (1e6 * (1.0 - cosine(seen, colour))) as i64
        });
        // Light changes the lightness and adds some gloss, so the hue is compared: within a tenth
        // of the map.
        let t = f64::from(nearest.unwrap()) / 20.0;
        assert!(
            (t - speed).abs() <= 0.1,
            "{speed} m/s looks like {t}: {seen:?}"
        );
    }
}

pub fn cosine(a: [f32; 3], b: [f32; 3]) -> f32 {
    Vec3::from(a).normalize().dot(Vec3::from(b).normalize())
}

#[test]
fn cut_takes_the_right_half_away() {
    let Some(_studio) = studio() else {
        return;
    };
    let positions = five_grains().grains.position.to_vec();
    let photograph = photograph("cut", five_grains(), |settings, camera| {
        camera.look_from(StandardView::Front);
        settings.cut = Some(Cut::Beyond {
            axis: CoordinateAxis::X,
            position: 0.0,
        });
    });
    let place = |x: DVec3| photograph.camera.project(x.as_vec3()).unwrap().0;
    for x in positions {
        if x.x != 0.0 {
            assert_eq!(photograph.covered(place(x)), x.x < 0.0, "grain at {x}");
        }
    }
    let centre = place(DVec3::ZERO);
    assert!(photograph.covered(centre - Vec2::new(4.0, 0.0)));
    assert!(!photograph.covered(centre + Vec2::new(4.0, 0.0)));
}

#[test]
fn section_of_a_cut_grain_is_a_flat_disc() {
    let Some(_studio) = studio() else {
        return;
    };
    let photograph = photograph("section", five_grains(), |settings, camera| {
        camera.look_from(StandardView::Front);
        settings.projection = ProjectionKind::Orthographic;
        settings.cut = Some(Cut::Beyond {
            axis: CoordinateAxis::Z,
            position: 0.0,
        });
    });
    // The middle of the first grain is cut through its centre: one colour over the disc but for its
    // rim.
    let (centre, per_metre) = photograph.camera.project(Vec3::ZERO).unwrap();
    let inside = 0.7 * 6e-3 * per_metre;
    let colour = photograph.at(centre);
    for turn in 0..12 {
        let direction = Vec2::from_angle(turn as f32 * std::f32::consts::TAU / 12.0);
        assert_eq!(photograph.at(centre + inside * direction), colour);
    }
    let hue = cosine(colour.map(f32::from), species_colour(0).map(f32::from));
    // The section is the species' colour as the legend has it.
    assert!(hue > 0.9999, "{colour:?}");
}

#[test]
fn nearer_grains_hide_farther_ones_where_they_intersect() {
    let Some(_studio) = studio() else {
        return;
    };
    // Two equal spheres one in front of the other, seen along z: the nearer one hides the other
    // entirely, whichever comes first in the list; seen from the back it is the other way round.
    for flip in [false, true] {
        let mut world = world(Shape::Planes, Vec::new());
        let mut place = [(4e-3, 0), (-4e-3, 1)];
        if flip {
            place.reverse();
        }
        for (z, species) in place {
            world
                .grains
                .push_sphere(DVec3::new(0.0, 0.0, z), 5e-3, 2500.0, SpeciesId(species));
        }
        for (side, front) in [(StandardView::Front, 0), (StandardView::Back, 1)] {
            let photograph = photograph("depth", world.clone(), |settings, camera| {
                camera.look_from(side);
                settings.projection = ProjectionKind::Orthographic;
                settings.background = Background::Light;
            });
            let seen = photograph.at(SIZE.as_vec2() / 2.0).map(f32::from);
            let hues = [0, 1].map(|i| cosine(seen, species_colour(i).map(f32::from)));
            assert!(hues[front] > hues[1 - front], "{side:?} {flip}: {seen:?}");
        }
    }
}

/// A drum part filled with a lattice of grains.
pub fn drum_of_grains() -> World {
    let mut world = world(
        Shape::Drum {
            radius: 0.0605,
            width: 0.022,
        },
        vec![Surface::Cylinder { radius: 0.0605 }],
    );
    world.container.angle = 0.4;
    let radius: f64 = 3e-3;
    for k in 0..3 {
        for j in 0..12 {
            for i in -11..=11 {
                let shift = if j % 2 == 0 { 0.0 } else { radius };
                let x = DVec3::new(
                    f64::from(i) * 2.0 * radius + shift,
                    -0.055 + f64::from(j) * 1.75 * radius,
                    (f64::from(k) - 1.0) * 2.2 * radius,
                );
                let level = x.y + 0.015 - 0.45 * x.x;
                if x.truncate().length() < 0.0605 - radius && level < 0.0 {
                    let species = SpeciesId(u16::from((i + j + k) % 4 == 0));
                    world.grains.push_sphere(x, radius, 2500.0, species);
                    let last = world.grains.len() - 1;
                    let speed = 0.12 * ((level + 0.02) / 0.02).max(0.0);
                    world.grains.velocity[last] = DVec3::new(-speed, -speed / 2.0, 0.0);
                }
            }
        }
    }
    world
}

#[test]
fn drum_fills_the_picture_and_one_sees_in() {
    let Some(_studio) = studio() else {
        return;
    };
    let world = drum_of_grains();
    let grain = world.grains.position[0];
    let photograph = photograph("drum", world, |_, _| {});
    let rim = |angle: f32| {
        let (sin, cos) = angle.sin_cos();
        let x = Vec3::new(0.0605 * cos, 0.0605 * sin, 0.0);
        photograph.camera.project(x).unwrap().0
    };
    let heights = rim(-std::f32::consts::FRAC_PI_2).y - rim(std::f32::consts::FRAC_PI_2).y;
    // Hoops and depth need the rest.
    assert!(heights > 0.75 * SIZE.y as f32, "{heights}");
    let place = photograph.camera.project(grain.as_vec3()).unwrap().0;
    assert!(photograph.covered(place));
}

#[test]
fn mark_turns_with_the_drum() {
    let Some(_studio) = studio() else {
        return;
    };
    for angle in [0.4_f32, 2.0] {
        let mut world = drum_of_grains();
        world.grains = Grains::default();
        world.container.angle = f64::from(angle);
        let photograph = photograph("mark", world, |_, camera| {
            camera.look_from(StandardView::Front);
        });
        // Across the bold spoke on the back plate, halfway out: red exceeds blue only at the mark.
        let warmth = |azimuth: f32| {
            let (sin, cos) = azimuth.sin_cos();
            let x = Vec3::new(0.03 * cos, 0.03 * sin, -0.011);
            let [red, _, blue] = photograph.at(photograph.camera.project(x).unwrap().0);
            i16::from(red) - i16::from(blue)
        };
        assert!(warmth(angle) > 20, "{}", warmth(angle));
        for away in [0.3, 1.0, 3.0] {
            assert!(warmth(angle + away) < 0, "{away}");
        }
    }
}

/// Two grains side by side that touch, pushed apart by `force`, with a bridge between them.
pub fn pair(force: f64) -> World {
    let mut world = world(Shape::Planes, Vec::new());
    for x in [-5e-3, 5e-3] {
        (world.grains).push_sphere(DVec3::new(x, 0.0, 0.0), 5e-3, 2500.0, SpeciesId(0));
    }
    world.contacts.push(Contact {
        grain: 0,
        partner: Partner::Grain(1),
        spring: DVec3::ZERO,
        stiffness: 0.0,
        rolling: DVec3::ZERO,
        force: DVec3::new(-force, 0.0, 0.0),
        touching: true,
        bridge: Some(Box::new(Bridge {
            volume: 4e-9,
            transfer: 0.0,
            capillary: 0.0,
            viscous: 0.0,
            drag: DVec3::ZERO,
        })),
    });
    world
}

/// How far up from `place` the picture is covered [pixels].
fn half_thickness(photograph: &Photograph, place: Vec2) -> f32 {
    let steps = (0..400).map(|i| 0.25 * i as f32);
    let mut up = steps.take_while(|up| photograph.covered(place - Vec2::Y * *up));
    up.by_ref().last().unwrap_or(0.0)
}

#[test]
fn force_is_a_bar_as_thick_as_it_is_large() {
    let Some(_studio) = studio() else {
        return;
    };
    // The reference is the next round number: of 1 mN itself, of 0.6 mN again 1 mN.
    let thickness = |force: f64| {
        let photograph = photograph("force", pair(force), |settings, camera| {
            settings.show_forces = true;
            settings.grain_size = 0.2;
            settings.show_overlay = false;
            settings.projection = ProjectionKind::Orthographic;
            camera.look_from(StandardView::Front);
        });
        let (middle, per_metre) = photograph.camera.project(Vec3::ZERO).unwrap();
        half_thickness(&photograph, middle) / per_metre
    };
    let (full, part) = (thickness(1e-3), thickness(0.6e-3));
    // Three tenths of a radius; two pixels.
    assert!((full - 1.5e-3).abs() < 1.0e-4, "{full}");
    assert!((part / full - 0.6).abs() < 0.08, "{part} {full}");
}

#[test]
fn bridge_is_as_thick_as_its_volume_makes_it() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut wet = pair(0.0);
    wet.grains.film.set(vec![1e-8; 2]);
    wet.liquid = Some(grainfall::physics::LIQUID_CASES[1].liquid());
    let seen = |bridges: bool| {
        let photograph = photograph("bridge", wet.clone(), |settings, camera| {
            settings.show_bridges = bridges;
            settings.show_overlay = false;
            settings.projection = ProjectionKind::Orthographic;
            camera.look_from(StandardView::Front);
        });
        let (middle, per_metre) = photograph.camera.project(Vec3::ZERO).unwrap();
        half_thickness(&photograph, middle) / per_metre
    };
    // V = π q² (B/2 − 1/4)/r* with r* = 2.5 mm and B = 0.7547 of a waist of 0.8.
    let ring = (2.5e-3 * 4e-9 / std::f64::consts::PI / (0.5 * 0.754_67 - 0.25)).sqrt();
    let expected = (0.8 * ring.sqrt()) as f32;
    // Two pixels, and a soft edge.
    assert!(
        (seen(true) - expected).abs() < 1.2e-4,
        "{} {expected}",
        seen(true)
    );
    // A pixel is as wide as the gap there.
    assert!(seen(false) < 0.6 * expected);
}

#[test]
fn arrows_point_where_grains_go() {
    let Some(_studio) = studio() else {
        return;
    };
    let mut moving = pair(0.0);
    moving.grains.velocity[1] = DVec3::new(0.0, 0.05, 0.0);
    let photograph = photograph("arrows", moving, |settings, camera| {
        settings.show_velocities = true;
        settings.show_overlay = false;
        settings.projection = ProjectionKind::Orthographic;
        camera.look_from(StandardView::Front);
        (camera.fits, camera.height) = (false, 0.06);
    });
    // 0.05 m/s is the reference: four radii long.
    let at = |x: f32, y: f32| photograph.camera.project(Vec3::new(x, y, 0.0)).unwrap().0;
    assert!(photograph.covered(at(5e-3, 0.012)));
    assert!(!photograph.covered(at(5e-3, 0.022)));
    assert!(!photograph.covered(at(-5e-3, 0.012)));
}
