use bevy::math::UVec2;
use bevy::prelude::*;
use bevy::render::view::screenshot::ScreenshotCaptured;
use grainfall::scene::Scene;
use grainfall::simulation::*;
use grainfall::view::*;
use grainfall::window::picture::*;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};
fn main() {
    let name = std::env::args().nth(1).unwrap();
    let at: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let which = std::env::args().nth(3).unwrap_or_default();
    let size = UVec2::new(960, 640);
    let mut sim = Simulation::open(Scene::open(&name).unwrap(), Options::headless());
    for _ in 0..2000 {
        sim.tick(Duration::from_millis(20));
        if sim.world().is_some_and(|w| w.time() >= at) { break; }
    }
    let world = sim.world().unwrap().clone();
    println!("t {} n {}", world.time(), world.grains.len());
    let base = ViewSettings::default;
    let variants: Vec<(&str, ViewSettings, Option<Side>)> = vec![
        ("home", base(), None),
        ("light", ViewSettings { background: Background::Light, ..base() }, None),
        ("speed", ViewSettings { colour_by: ColourBy::Speed, ..base() }, Some(Side::Front)),
        ("spinlight", ViewSettings { colour_by: ColourBy::Spin, background: Background::Light, colour_map: ColourMap::Plasma, ..base() }, None),
        ("coord", ViewSettings { colour_by: ColourBy::Coordination, projection: ProjectionKind::Orthographic, ..base() }, Some(Side::Right)),
        ("cut", ViewSettings { cut: Some(Cut { axis: grainfall::view::Axis::Z, position: 0.0 }), ..base() }, None),
        ("cutx", ViewSettings { cut: Some(Cut { axis: grainfall::view::Axis::X, position: 0.005 }), ..base() }, None),
        ("above", ViewSettings::default(), Some(Side::Above)),
    ];
    for (label, settings, side) in variants {
        if !which.is_empty() && !which.split(',').any(|w| w == label) { continue; }
        let mut app = App::new();
        app.add_plugins(offscreen_plugins().disable::<bevy::log::LogPlugin>())
            .add_plugins((CanvasPlugin(size), ViewPlugin));
        let mut camera = OrbitCamera::default();
        if label.starts_with("cutx") { camera.yaw = 0.7; }
        if let Some(side) = side { camera.look_from(side); }
        app.insert_resource(settings).insert_resource(camera);
        app.world_mut().resource_mut::<Shown>().show(Some(world.clone()));
        make_ready(&mut app);
        for _ in 0..WARM_UP { app.update(); }
        let t0 = Instant::now();
        for _ in 0..5 { app.world_mut().resource_mut::<Shown>().show(Some(world.clone())); app.update(); }
        println!("{label}: {:.1} ms a frame (submitted)", t0.elapsed().as_secs_f64() * 200.0);
        let taken: Arc<Mutex<Option<Image>>> = Arc::default();
        let slot = taken.clone();
        let canvas = app.world().resource::<Canvas>().clone();
        app.world_mut().spawn(screenshot(Some(&canvas))).observe(move |c: On<ScreenshotCaptured>| { *slot.lock().unwrap() = Some(c.image.clone()); });
        for _ in 0..100 {
            app.update();
            if let Some(i) = taken.lock().unwrap().take() { save(&i, std::path::Path::new(&format!("/tmp/shots/{name}-{label}.png"))).unwrap(); break; }
        }
    }
}
