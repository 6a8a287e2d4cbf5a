//! Claims about runs that end when their column is at rest.

use crate::runs::shared_beds;
use grainfall::files::read_whole;
use grainfall::measure::Collapse;
use grainfall::run::RunRecord;
use grainfall::runner::{Finished, Job, Standing, Verdict, run, standing};
use grainfall::scene::Scene;
use std::cell::Cell;
use std::path::Path;

/// A small column that ends at rest, at 2 s at the latest, with states 5 ms apart.
fn column(settings: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::open("small-column").unwrap();
    let small = [
        ("radius", "10mm"),
        ("height", "10mm"),
        ("duration", "2s"),
        ("output-interval", "5ms"),
        ("until", "rest"),
    ];
    for (key, value) in small.iter().chain(settings) {
        scene.set(key, value).unwrap();
    }
    scene
}

fn job(scene: Scene, out: &Path) -> Job {
    Job {
        threads: 1,
        beds: shared_beds(),
        checkpoints: true,
        ..Job::new("a-column", scene, out)
    }
}

/// Runs `job` to its end: how it ended, at which step, and at which time [s].
fn end(job: &Job) -> (Finished, u64, f64) {
    let (finished, run) = run(job, &mut (), &|| false).unwrap();
    let world = run.run().unwrap().world();
    (finished, world.clock.step, world.time())
}

fn summary(out: &Path) -> serde_json::Value {
    let bytes = read_whole(&out.join("summary.json"), 1 << 20).unwrap();
    serde_json::from_slice(&bytes).unwrap()
}

#[test]
fn column_at_rest_ends_its_run_and_nothing_more_comes_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let (ended, whole) = (folder.path().join("ended"), folder.path().join("whole"));
    let (finished, step, time) = end(&job(column(&[]), &ended));
    assert_eq!(
        (finished.ending.status(), &finished.warnings[..]),
        ("done", &[][..])
    );
    // At a look, long before its duration.
    assert!(
        time < 1.0 && (time / 5e-3 - (time / 5e-3).round()).abs() < 0.01,
        "{time}"
    );
    let stated = summary(&ended);
    assert_eq!(stated["status"], "done");

    // The same run for as long again: nothing has moved that is measured.
    let twice = format!("{}s", 2.0 * time);
    let longer = column(&[("until", "duration"), ("duration", &twice)]);
    let (_, run) = run(&job(longer, &whole), &mut (), &|| false).unwrap();
    let series = run.run().unwrap().series();
    let collapse = Collapse::of(series).unwrap();
    let index = (0..series.len())
        .find(|&k| series.get(k).unwrap().step >= step)
        .unwrap();
    let then = series.get(index).unwrap();
    let front = then.value(grainfall::measure::Measure::FrontRadius);
    assert!(
        (front / collapse.front - 1.0).abs() < 0.01,
        "{front} {}",
        collapse.front
    );
    let rest = collapse.rest_time.unwrap();
    assert!(
        time >= 1.25 * rest - 0.02 && time <= 1.25 * rest + 0.03,
        "{time} {rest}"
    );
}

#[test]
fn run_that_ends_at_rest_is_done_goes_on_and_is_verified() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, stopped) = (folder.path().join("whole"), folder.path().join("stopped"));
    let (_, step, time) = end(&job(column(&[]), &whole));

    // Stopped again and again, it ends at the same step.
    let asked = job(column(&[]), &stopped);
    let mut stops = 0;
    loop {
        let looks = Cell::new(0);
        let stop = || {
            looks.set(looks.get() + 1);
            looks.get() > 20
        };
        let (finished, _) = run(&asked, &mut (), &stop).unwrap();
        if finished.ending.status() == "done" {
            break;
        }
        stops += 1;
        assert!(stops < 10_000);
    }
    assert!(stops > 1);
    let (a, b) = (summary(&whole), summary(&stopped));
    for key in ["state_hash", "steps", "results", "status"] {
        assert_eq!(a[key], b[key], "{key}");
    }

    // Once more: it is done, whatever its duration, and nothing is computed.
    for scene in [column(&[]), column(&[("duration", "3s")])] {
        assert_eq!(
            standing(&job(scene.clone(), &whole)).unwrap(),
            Standing::Done
        );
        let (again, same, _) = end(&job(scene, &whole));
        assert!(again.was_done && same == step);
    }
    let record = RunRecord::read(&whole.join("summary.json")).unwrap();
    let verdict = record.verify(1, shared_beds(), &mut (), &|| false).unwrap();
    assert_eq!(verdict, Verdict::Same);

    // By its duration it goes on from there.
    let longer = format!("{}s", time + 0.01);
    let on = job(
        column(&[("until", "duration"), ("duration", &longer)]),
        &whole,
    );
    assert_eq!(standing(&on).unwrap(), Standing::Until(time));
    let (on, later, _) = end(&on);
    assert!(!on.was_done && later > step);
}

#[test]
fn column_that_still_moves_at_its_duration_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let short = column(&[("duration", "30ms")]);
    let (finished, _, time) = end(&job(short, folder.path()));
    assert!((time - 0.03).abs() < 1e-4);
    assert!(
        finished.warnings[0].contains("still moves"),
        "{:?}",
        finished.warnings
    );
    let refused = Scene::open("small-drum").unwrap().set("until", "rest");
    assert!(refused.is_err());
}

#[test]
fn column_in_its_tube_is_not_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let text = r#"(
        title: "A tube", materials: {"stone": ()}, duration: 0.08, until: Rest, output_interval: 0.005,
        container: Column(radius_mm: 10, height_mm: 10, material: "stone", tube: (speed: 0.1)),
        grains: Voronoi(cell_mm: 4, rounding_mm: 0.4, species: [(material: "stone", share: 1)]),
        law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500, features: Shared),
    )"#;
    let scene = Scene::parse("tube", text).unwrap();
    let (_, _, time) = end(&job(scene, folder.path()));
    // The tube's rim is 8 mm high by then.
    assert!((time - 0.08).abs() < 1e-4, "{time}");
}
