//! How long a person waits in the window until a column has fallen and lies still, and what its
//! frames take meanwhile: the panels that a window opens with, sixty frames a second, as fast as the
//! threads that a window gives the solver can.
//!
//! `cargo bench -p grainfall --bench falls` draws on the graphics device that it finds, each frame
//! until the device has drawn it; with `-- --without-device` a frame is what it costs the processor.

#[path = "common/laboratory.rs"]
mod laboratory;

use bevy::prelude::*;
use bevy::render::render_resource::PollType;
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice};
use grainfall::lab::{Options, Status};
use grainfall::run::Command;
use grainfall::scene::Scene;
use grainfall_app::simulation::Simulation;
use std::time::{Duration, Instant};

/// Time between two frames.
const FRAME: Duration = Duration::from_nanos(16_666_667);

fn main() {
    let draws = !std::env::args().any(|argument| argument == "--without-device");
    let columns = [
        ("small column", "small-column", &[][..]),
        (
            "column of 1 cm",
            "column",
            &[
                ("height", "10mm"),
                ("mix", "0.3"),
                ("integrator", "implicit"),
            ],
        ),
    ];
    for (name, scene, settings) in columns {
        let mut scene = Scene::open(scene).expect("a built-in scene");
        for (key, value) in settings {
            scene.set(key, value).expect("a setting of the scene");
        }
        println!("{name}: {}", fall(scene, draws));
    }
}

/// Lets the column of `scene` fall, and says what it took.
fn fall(scene: Scene, draws: bool) -> String {
    let options = Options {
        autoplay: false,
        speed: f64::INFINITY,
        ..Options::window()
    };
    let threads = options.threads;
    let mut app = laboratory::app(draws);
    laboratory::add(&mut app, scene, options);
    laboratory::prepare(&mut app);
    for _ in 0..10 {
        frame(&mut app);
    }
    let grains = simulation(&app)
        .world()
        .map_or(0, |world| world.grains.len());
    app.world_mut()
        .resource_mut::<Simulation>()
        .send(Command::Play);
    let began = Instant::now();
    let mut frames = Vec::new();
    let mut has_run = false;
    while !has_run || *simulation(&app).status() == Status::Running {
        let next = Instant::now() + FRAME;
        frames.push(frame(&mut app));
        has_run |= *simulation(&app).status() == Status::Running;
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
    let waited = began.elapsed().as_secs_f64();
    let reached = simulation(&app).sample().map_or(0.0, |sample| sample.time);
    frames.sort();
    let of = |share: f64| 1e3 * frames[((frames.len() - 1) as f64 * share) as usize].as_secs_f64();
    let late = frames.iter().filter(|own| **own > FRAME).count();
    let device = app.world().get_resource::<RenderAdapterInfo>();
    format!(
        "{grains} grains, {threads} solver threads, {}: {:?} after {reached:.3} s of its time, {waited:.1} s of ours; {} frames, \
         half of them within {:.1} ms, 99 % within {:.1} ms, the longest {:.1} ms, {late} above 16.7 ms",
        device.map_or("no graphics device", |own| own.name.as_str()),
        simulation(&app).status(),
        frames.len(),
        of(0.5),
        of(0.99),
        of(1.0),
    )
}

fn simulation(app: &App) -> &Simulation {
    app.world().resource::<Simulation>()
}

/// Draws a frame, and says how long it took until it was drawn.
fn frame(app: &mut App) -> Duration {
    let began = Instant::now();
    app.update();
    if let Some(device) = app.world().get_resource::<RenderDevice>() {
        let _ = device.poll(PollType::wait_indefinitely());
    }
    began.elapsed()
}
