//! What playing a scene in the window comes to: how long a person waits until a column has fallen and
//! its front is known to have come to rest, how fast a drum turns, and what frames take meanwhile. The
//! panels that a window opens with, sixty frames a second, as fast as the solver's threads can.
//!
//! `cargo bench -p grainfall --bench played` draws on the graphics device that it finds; with
//! `-- --without-device` on none. A frame is what it costs the processor; with `-- --drawn` it lasts
//! until the device has drawn it. `-- --threads=2` gives the solver as many, `-- --only=dry-r3` plays
//! that scene alone.

#[path = "common/laboratory.rs"]
mod laboratory;

use bevy::prelude::*;
use bevy::render::render_resource::PollType;
use bevy::render::renderer::{RenderAdapterInfo, RenderDevice};
use grainfall::lab::{Options, Status};
use grainfall::run::{Command, Event, Happening};
use grainfall::scene::{Scene, SceneContainer};
use grainfall_app::simulation::Simulation;
use std::time::{Duration, Instant};

/// Time between two frames.
const FRAME: Duration = Duration::from_nanos(16_666_667);
/// How long a drum is watched.
const WATCHED: Duration = Duration::from_secs(10);

/// What is played.
const SCENES: [(&str, &[(&str, &str)]); 4] = [
    ("dry-r3", &[]),
    ("dry-r1.25", &[]),
    ("small-column", &[]),
    (
        "column",
        &[
            ("height", "10mm"),
            ("mix", "0.3"),
            ("integrator", "implicit"),
        ],
    ),
];

/// How it is played.
struct Playing {
    /// Threads of the solver.
    threads: usize,
    /// Whether a graphics device draws.
    draws: bool,
    /// Whether a frame lasts until it has drawn.
    until_drawn: bool,
}

fn main() {
    let has = |name: &str| std::env::args().any(|own| own == name);
    let value =
        |name: &str| std::env::args().find_map(|own| Some(own.strip_prefix(name)?.to_owned()));
    let threads = value("--threads=").and_then(|text| text.parse().ok());
    let only = value("--only=");
    let playing = Playing {
        threads: threads.unwrap_or(Options::window().threads),
        draws: !has("--without-device"),
        until_drawn: has("--drawn"),
    };
    let wanted = |name: &str| only.as_ref().is_none_or(|only| only == name);
    for (name, settings) in SCENES.into_iter().filter(|(name, _)| wanted(name)) {
        let mut scene = Scene::open(name).expect("a built-in scene");
        for (key, value) in settings {
            scene.set(key, value).expect("a setting of the scene");
        }
        println!("{name}: {}", play(scene, &playing));
    }
}

/// Plays `scene`, and says what it came to.
fn play(scene: Scene, playing: &Playing) -> String {
    let threads = playing.threads;
    let options = Options {
        autoplay: false,
        speed: f64::INFINITY,
        threads,
        ..Options::window()
    };
    let mut app = laboratory::app(playing.draws);
    laboratory::add(&mut app, scene, options);
    laboratory::prepare(&mut app);
    for _ in 0..10 {
        frame(&mut app, false);
    }
    let grains = simulation(&app)
        .world()
        .map_or(0, |world| world.grains.len());
    app.world_mut()
        .resource_mut::<Simulation>()
        .send(Command::Play);
    let began = Instant::now();
    let mut frames = Vec::new();
    while !is_over(&app, began.elapsed()) {
        let next = Instant::now() + FRAME;
        frames.push(frame(&mut app, playing.until_drawn));
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
    }
    let passed = began.elapsed().as_secs_f64();
    let world = simulation(&app).world();
    let reached = world.map_or(0.0, |world| world.time());
    let device = app.world().get_resource::<RenderAdapterInfo>();
    format!(
        "{grains} grains, {threads} solver threads, {}: {reached:.3} s in {passed:.1} s by the clock; {}",
        device.map_or("no graphics device", |own| own.name.as_str()),
        in_words(&mut frames),
    )
}

/// What these `frames` took.
fn in_words(frames: &mut [Duration]) -> String {
    frames.sort();
    let of = |share: f64| 1e3 * frames[((frames.len() - 1) as f64 * share) as usize].as_secs_f64();
    let late = frames.iter().filter(|own| **own > FRAME).count();
    format!(
        "{} frames, half of them within {:.1} ms, 99 % within {:.1} ms, the longest {:.1} ms, {late} above 16.7 ms",
        frames.len(),
        of(0.5),
        of(0.99),
        of(1.0),
    )
}

/// Whether the front of a column is known to have come to rest, or a drum has been watched for long
/// enough.
fn is_over(app: &App, passed: Duration) -> bool {
    let simulation = simulation(app);
    let status = simulation.status();
    let is_lost = matches!(status, Status::Faulted(_) | Status::Failed(_));
    assert!(!is_lost, "{status:?}");
    if matches!(simulation.scene().container, SceneContainer::Column { .. }) {
        let stops = |event: &Event| matches!(event.what, Happening::FrontStops { .. });
        return simulation.events().iter().any(stops);
    }
    passed >= WATCHED
}

fn simulation(app: &App) -> &Simulation {
    app.world().resource::<Simulation>()
}

/// Has a frame drawn, and says how long that took: the processor, or `until_drawn`.
fn frame(app: &mut App, until_drawn: bool) -> Duration {
    let began = Instant::now();
    app.update();
    let device = app.world().get_resource::<RenderDevice>();
    if let Some(device) = device.filter(|_| until_drawn) {
        let _ = device.poll(PollType::wait_indefinitely());
    }
    began.elapsed()
}
