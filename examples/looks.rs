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
        ("plain", ViewSettings { smooth_edges: false, ..base() }, None),
        ("plainbare", ViewSettings { smooth_edges: false, show_container: false, ..base() }, None),
        ("empty", ViewSettings { smooth_edges: false, show_container: false, cut: Some(Cut { axis: grainfall::view::Axis::Z, position: -10.0 }), ..base() }, None),
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
        let t0 = Instant::now(); let c0 = cpu();
        for _ in 0..10 { app.world_mut().resource_mut::<Shown>().show(Some(world.clone())); app.update(); }
        app.world().resource::<bevy::render::renderer::RenderDevice>().wgpu_device().poll(wgpu::PollType::wait_indefinitely()).unwrap();
        println!("{label}: {:.1} ms a frame wall, {:.1} ms CPU", t0.elapsed().as_secs_f64() * 100.0, (cpu() - c0) * 100.0);
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

fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.rsplit_once(')').unwrap().1.split_whitespace().collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
}
