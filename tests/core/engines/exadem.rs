//! Columns of polyhedra for exaDEM: files against golden ones and read again, what is refused, and
//! its output read back.

use super::{built, export_text};
use glam::{DQuat, DVec3};
use grainfall::engines::{
    Export, ExportRecord, ImportSource, MpiEngine, export, import, named_files, read_frames,
    scene_from,
};
use grainfall::geometry::{HalfSpace, Solid};
use grainfall::measure::Measure;
use grainfall::runner::{Advance, DirectRun, Job};
use grainfall::scene::Scene;
use grainfall::world::{World, build};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Two shapes and two materials, one of them of both shapes, on a floor.
const BODIES: &str = r#"(
    title: "Three bodies",
    materials: {
        "smooth": (density: 2500, restitution: 0.5, friction: 0.1),
        "rough": (density: 2650, restitution: 0.3, friction: 0.4),
        "floor": (friction: 0.3),
    },
    pairs: [(between: ("smooth", "rough"), friction: 0.25)],
    container: Column(radius_mm: 20, height_mm: 25, material: "floor"),
    grains: List([
        (position: (0, 0.004, 0), shape: Box(size: (0.006, 0.004, 0.008)), rounding_mm: 0.4, material: "smooth"),
        (position: (0.001, 0.012, 0.002), velocity: (0.01, -0.2, 0), spin: (3, 0, 1), shape: Tetrahedron(edge: 0.007), rounding_mm: 0.3, material: "rough"),
        (position: (0.012, 0.004, 0), shape: Box(size: (0.006, 0.004, 0.008)), rounding_mm: 0.4, material: "rough"),
    ]),
    law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500),
    time_step: Given(1e-5), duration: 0.02, output_interval: 0.005,
)"#;

/// A small column of Voronoi grains.
const COLUMN: &str = r#"(
    title: "A small column",
    materials: { "smooth": (friction: 0.1), "rough": (friction: 0.4), "floor": (friction: 0.4) },
    container: Column(radius_mm: 8, height_mm: 10, material: "floor"),
    grains: Voronoi(cell_mm: 4, rounding_mm: 0.4, solid_fraction: 0.8, species: [
        (material: "smooth", share: 0.7), (material: "rough", share: 0.3)]),
    law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500, features: FEATURES),
    integrator: INTEGRATOR,
    duration: 0.012, output_interval: 0.004,
)"#;

fn column(integrator: &str) -> String {
    (COLUMN.replace("FEATURES", "Full")).replace("INTEGRATOR", integrator)
}

/// What a shape's file states of one shape, in its units.
#[derive(Debug)]
struct Shape {
    radius: f64,
    volume: f64,
    gyration: DVec3,
    vertices: Vec<DVec3>,
    edges: usize,
    faces: Vec<Vec<u16>>,
}

/// A reader of shapes that knows nothing of how they were written: words by words, as exaDEM does.
fn read_shapes(text: &str) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for block in text.split("\n<\n").skip(1) {
        let words: Vec<&str> = block.split_whitespace().collect();
        let at = |key: &str| words.iter().position(|word| *word == key).unwrap() + 1;
        let number = |at: usize| words[at].parse::<f64>().unwrap();
        let vector = |at: usize| DVec3::new(number(at), number(at + 1), number(at + 2));
        let count = |key: &str| words[at(key)].parse::<usize>().unwrap();
        let vertices = (0..count("nv"))
            .map(|k| vector(at("nv") + 1 + 3 * k))
            .collect();
        let mut place = at("nf") + 1;
        let faces = (0..count("nf")).map(|_| {
            let corners = words[place].parse::<usize>().unwrap();
            let face = &words[place + 1..=place + corners];
            place += corners + 1;
            face.iter().map(|word| word.parse().unwrap()).collect()
        });
        shapes.push(Shape {
            faces: faces.collect(),
            radius: number(at("radius")),
            volume: number(at("volume")),
            gyration: vector(at("I/m")),
            vertices,
            edges: count("ne"),
        });
        assert_eq!(words[place], ">", "{block}");
    }
    shapes
}

/// Rows of the bodies' file: name, then numbers.
fn read_bodies(text: &str) -> (Vec<f64>, Vec<(usize, Vec<f64>)>) {
    let words = text
        .lines()
        .filter_map(|line| line.strip_prefix("density "));
    let densities = words.map(|line| line.split_once(' ').unwrap().1.parse().unwrap());
    let rows = text.lines().filter_map(|line| line.strip_prefix("shape"));
    let rows = rows
        .filter_map(|line| line.split_once(' '))
        .filter_map(|(shape, rest)| {
            let numbers = rest.split(' ').map(|word| word.parse().unwrap());
            Some((shape.parse::<usize>().ok()? - 1, numbers.collect()))
        });
    (densities.collect(), rows.collect())
}

fn exported(text: &str, folder: &Path) -> [String; 2] {
    export_text(text, MpiEngine::Exadem, folder).unwrap();
    ["grains.shp", "grains.conf"].map(|name| fs::read_to_string(folder.join(name)).unwrap())
}

#[test]
fn files_are_the_golden_ones() {
    let folder = tempfile::tempdir().unwrap();
    exported(BODIES, folder.path());
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/core/engines");
    let found = Path::new(env!("CARGO_TARGET_TMPDIR")).join("engines");
    fs::create_dir_all(&found).unwrap();
    let mut different = Vec::new();
    for name in ["grains.msp", "grains.shp", "grains.conf"] {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        // Without the line that states version and hash.
        let lines = text.split_inclusive('\n');
        let text: String = lines
            .filter(|line| !line.contains("Three bodies"))
            .collect();
        let name = name.replace("grains", "bodies");
        fs::write(found.join(&name), &text).unwrap();
        if text != fs::read_to_string(golden.join(&name)).unwrap_or_default() {
            different.push(name);
        }
    }
    let found = found.display();
    assert!(different.is_empty(), "{different:?}: see {found}");
    let run = fs::read_to_string(folder.path().join("run.sh")).unwrap();
    assert!(run.ends_with("${EXADEM:-exaDEM} grains.msp\n"), "{run}");
}

#[test]
fn bodies_are_where_they_were_and_as_heavy() {
    for text in [BODIES, &column("Explicit")] {
        let folder = tempfile::tempdir().unwrap();
        let [shapes, bodies] = exported(text, folder.path());
        let (_, world) = built(text);
        let record = ExportRecord::read(folder.path()).unwrap();
        let (densities, rows) = read_bodies(&bodies);
        let shapes = read_shapes(&shapes);
        assert_eq!(rows.len(), world.grains.len());
        assert_eq!(shapes.len(), densities.len(), "a density for each shape");
        for shape in &shapes {
            assert_eq!(shape.vertices.len() + shape.faces.len(), shape.edges + 2);
            // Faces that are lost when a Voronoi cell's core is made were cut off the solid.
            let solid = Solid::new(shape.vertices.clone(), shape.faces.clone());
            assert!(solid.moments().volume < shape.volume);
            assert!(unrounded(shape).moments().volume > (1.0 - 1e-9) * shape.volume);
        }
        let polyhedra = world.polyhedra.as_ref().unwrap();
        for (i, (shape, row)) in rows.iter().enumerate() {
            let vector = |at: usize| DVec3::new(row[at], row[at + 1], row[at + 2]);
            assert_eq!(vector(3), 1e3 * world.grains.position[i]);
            assert_eq!(vector(6), 1e3 * world.grains.velocity[i]);
            assert_eq!(vector(16), world.grains.spin[i]);
            let turn = DQuat::from_xyzw(row[13], row[14], row[15], row[12]);
            assert_eq!(turn, polyhedra.orientation[i]);
            assert_eq!(
                record.types[row[0] as usize].species,
                world.grains.species[i]
            );
            let mass = densities[*shape] * shapes[*shape].volume;
            assert!((mass / world.grains.mass[i] - 1.0).abs() < 1e-14);
            let farthest = shapes[*shape].vertices.iter().map(|x| x.length());
            let farthest = farthest.fold(0.0, f64::max) + shapes[*shape].radius;
            assert!((1e-3 * farthest / world.grains.radius[i] - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn volumes_and_moments_are_those_of_the_shapes() {
    let folder = tempfile::tempdir().unwrap();
    let [shapes, _] = exported(BODIES, folder.path());
    let shapes = read_shapes(&shapes);
    // A box of 6 × 4 × 8 mm, a tetrahedron of 7 mm.
    assert!((shapes[0].volume - 192.0).abs() < 1e-9);
    assert!((shapes[1].volume - 343.0 / (6.0 * 2.0_f64.sqrt())).abs() < 1e-9);
    assert!((shapes[1].gyration - DVec3::splat(49.0 / 20.0)).length() < 1e-9);
    for shape in &shapes {
        let moments = unrounded(shape).moments();
        assert!((moments.volume / shape.volume - 1.0).abs() < 1e-9);
        let second = moments.second;
        let diagonal = DVec3::new(second.x_axis.x, second.y_axis.y, second.z_axis.z);
        let trace = diagonal.element_sum();
        let gyration = (DVec3::splat(trace) - diagonal) / moments.volume;
        assert!((gyration - shape.gyration).length() < 1e-8 * trace / moments.volume);
        // Its axes are principal, its origin the centroid.
        let products = [second.x_axis.y, second.y_axis.z, second.z_axis.x];
        assert!(products.iter().all(|xy| xy.abs() < 1e-8 * trace));
        assert!(moments.centroid.length() < 1e-9 * moments.volume.cbrt());
    }
}

/// The solid of a `shape` before its edges were rounded: its faces moved outwards by its radius.
fn unrounded(shape: &Shape) -> Solid {
    let half_spaces: Vec<HalfSpace> = (shape.faces.iter())
        .map(|face| {
            let [a, b, c] = [face[0], face[1], face[2]].map(|v| shape.vertices[usize::from(v)]);
            let normal = (b - a).cross(c - a).normalize();
            let offset = normal.dot(a) + shape.radius;
            HalfSpace { normal, offset }
        })
        .collect();
    let far = DVec3::splat(10.0 * shape.volume.cbrt());
    Solid::intersection(-far, far, &half_spaces)
}

#[test]
fn what_it_does_not_have_is_refused_by_name() {
    let shared = column("Explicit").replace("features: Full", "features: Shared");
    let sphere = BODIES.replace(
        "shape: Tetrahedron(edge: 0.007), rounding_mm: 0.3,",
        "radius_mm: 3,",
    );
    let tube = BODIES.replace(
        r#"material: "floor"),
    grains"#,
        r#"material: "floor", tube: (speed: 0.1)),
    grains"#,
    );
    let drum = BODIES.replace(
        r#"Column(radius_mm: 20, height_mm: 25, material: "floor")"#,
        r#"Drum(radius_mm: 30, width_mm: 40, speed_rpm: 10, material: "floor")"#,
    );
    let belt = BODIES.replace(
        r#"Column(radius_mm: 20, height_mm: 25, material: "floor")"#,
        r#"Planes([(name: "belt", point: (0, 0, 0), normal: (0, 1, 0), velocity: (0.1, 0, 0), material: "floor")])"#,
    );
    let spheres = super::dry_drum();
    let cases = [
        (shared, "`features: Full`"),
        (sphere, "spheres are among its grains"),
        (spheres.clone(), "spheres are among its grains"),
        (spheres, "its law is not `Hooke`"),
        (super::wet_drum(), "it has liquid"),
        (tube, "`tube` is a rising tube"),
        (drum, "`rim` is no plane at rest"),
        (belt, "`belt` is no plane at rest"),
    ];
    for (scene, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        match export_text(&scene, MpiEngine::Exadem, &out) {
            Ok(_) => panic!("{expected}"),
            Err(error) => assert!(error.to_string().contains(expected), "{error}"),
        }
        assert!(!out.exists(), "{expected}: nothing is written");
    }
    let (scene, mut world) = built(BODIES);
    world.clock.step = 1;
    let handed = Export {
        name: "test",
        scene: &scene,
        commands: &[],
        world: &world,
        is_settled: true,
    };
    let folder = tempfile::tempdir().unwrap();
    let error = export(handed, MpiEngine::Exadem, folder.path()).unwrap_err();
    assert!(error.to_string().contains("time zero"), "{error}");
}

#[test]
fn implicit_springs_get_a_step_that_explicit_ones_bear() {
    let step = |integrator: &str| {
        let folder = tempfile::tempdir().unwrap();
        let exported = export_text(&column(integrator), MpiEngine::Exadem, folder.path()).unwrap();
        let said = format!("`integrator: {integrator}`");
        let is_said = exported.deviations.iter().any(|text| text.contains(&said));
        let bodies = fs::read_to_string(folder.path().join("grains.conf")).unwrap();
        let stated = bodies.lines().find_map(|line| line.strip_prefix("dt "));
        assert_eq!(stated.unwrap().parse::<f64>().unwrap(), exported.time_step);
        (exported.time_step, is_said)
    };
    let ((explicit, unsaid), (implicit, said)) = (step("Explicit"), step("Implicit"));
    assert_eq!(explicit, implicit);
    assert!(said && !unsaid);
    assert!(built(&column("Implicit")).1.clock.time_step > implicit);
}

/// More shapes than eight bits number are taken for others by exaDEM as it is built by default.
#[test]
fn more_shapes_than_exadem_tells_apart_by_itself_are_told() {
    let is_told = |radius: &str| {
        let text = column("Explicit").replace("radius_mm: 8", radius);
        let folder = tempfile::tempdir().unwrap();
        let exported = export_text(&text, MpiEngine::Exadem, folder.path()).unwrap();
        let shapes = fs::read_to_string(folder.path().join("grains.shp")).unwrap();
        let told = exported
            .deviations
            .iter()
            .any(|text| text.contains("XNB_PARTICLE_TYPE_INT"));
        (read_shapes(&shapes).len() > 256, told)
    };
    assert_eq!(is_told("radius_mm: 8"), (false, false));
    assert_eq!(is_told("radius_mm: 27"), (true, true));
}

/// The file that exaDEM writes of `world` by its script.
fn xyz(world: &World) -> String {
    let (grains, bodies) = (&world.grains, world.polyhedra.as_ref().unwrap());
    let mut text = format!(
        "{}\nLattice=\"1 0 0 0 1 0 0 0 1\" Properties=species:S:1:pos:R:3:vel:R:3:radius:R:1:orient:R:4:vrot:R:3:id:I:1 Time={:.5e}\n",
        grains.len(),
        world.time(), // exaDEM states six digits.
    );
    // Cells come in another order than bodies.
    for i in (0..grains.len()).rev() {
        let (x, v, w) = (
            1e3 * grains.position[i],
            1e3 * grains.velocity[i],
            grains.spin[i],
        );
        let turn = bodies.orientation[i];
        let all = [
            x.x,
            x.y,
            x.z,
            v.x,
            v.y,
            v.z,
            1e3 * grains.radius[i],
            turn.w,
            turn.x,
            turn.y,
            turn.z,
            w.x,
            w.y,
            w.z,
        ];
        let words: Vec<String> = all.iter().map(|value| format!("{value:.10e}")).collect();
        let _ = writeln!(text, "XX       {} {i:>10}", words.join(" "));
    }
    text
}

/// A column's run beside the files that exaDEM would write of it.
fn falling(folder: &Path) -> (Job, DirectRun, Vec<[f64; 3]>) {
    let scene = Scene::parse("column", &column("Explicit")).unwrap();
    let job = Job::new("column", scene, folder.join("unused"));
    let mut run = DirectRun::of(&job);
    while run.run().is_none() {
        run.advance(0).unwrap();
    }
    fs::create_dir(folder.join("dumps")).unwrap();
    let mut measured = Vec::new();
    for k in 1..=3 {
        let goal = run
            .run()
            .unwrap()
            .world()
            .clock
            .step_at(0.004 * f64::from(k));
        while run.run().unwrap().world().clock.step < goal {
            run.advance(goal).unwrap();
        }
        let world = run.run().unwrap().world();
        let name = format!("dumps/grains_{:012}.xyz", world.clock.step);
        fs::write(folder.join(name), xyz(world)).unwrap();
        let sample = grainfall::measure::sample(world);
        let of = [
            Measure::FrontRadius,
            Measure::DepositHeight,
            Measure::KineticEnergy,
        ];
        measured.push(of.map(|measure| sample.values[measure as usize]));
    }
    (job, run, measured)
}

#[test]
fn front_height_and_energy_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let (job, run, measured) = falling(folder.path());
    let mut source = ImportSource::of_scene("column", job.scene, Vec::new());
    source.time_step = run.run().unwrap().world().clock.time_step;
    let files = named_files(&[folder.path().to_owned()]).unwrap();
    let out = folder.path().join("out");
    let imported = import(&files, &source, &out, false, &mut ()).unwrap();
    assert_eq!(imported.frames, 3);
    let mut table = csv::Reader::from_path(out.join("series.csv")).unwrap();
    let heads = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let of = [
        Measure::FrontRadius,
        Measure::DepositHeight,
        Measure::KineticEnergy,
    ];
    for (k, measure) in of.into_iter().enumerate() {
        let key = measure.quantity().key;
        let place = heads
            .iter()
            .position(|head| head.split(" [").next() == Some(key));
        for (row, own) in rows.iter().zip(&measured) {
            let value: f64 = row[place.unwrap()].parse().unwrap();
            // Eleven digits were written.
            assert!(
                (value / own[k] - 1.0).abs() < 1e-9,
                "{key}: {value}, ours {}",
                own[k]
            );
        }
    }
    // The last state begins a scene of its own.
    let text = scene_from(&imported.scene, &imported.last)
        .to_text()
        .unwrap();
    let begun = build(&Scene::parse("start.ron", &text).unwrap(), 1e-6);
    assert_eq!(begun.grains.position, imported.last.grains.position);
    assert_eq!(begun.grains.velocity, imported.last.grains.velocity);
    let shapes = |world: &World| -> Vec<_> {
        let bodies = world.polyhedra.as_ref().unwrap();
        let cores = (0..world.grains.len()).map(|i| bodies.shape_of(i).vertices.clone());
        cores.collect()
    };
    assert_eq!(shapes(&begun), shapes(&imported.last));
    let own = &run.run().unwrap().world().grains;
    let largest = (own.position.iter().zip(&imported.last.grains.position))
        .map(|(a, b)| (*a - *b).length())
        .fold(0.0, f64::max);
    assert!(largest < 1e-11, "{largest:e} m");
    assert!(out.join("shapes.vtu").is_file() && out.join("grains.pvd").is_file());
}

#[test]
fn faults_of_its_files_are_told_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let (job, _, _) = falling(folder.path());
    let files = named_files(&[folder.path().to_owned()]).unwrap();
    let good = fs::read_to_string(&files[0]).unwrap();
    let count = good.lines().next().unwrap().to_owned();
    let last = good.lines().count();
    let write = |name: &str, text: &str| -> PathBuf {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    };
    let cases = [
        (good.replacen(&count, "many", 1), ":1: `many`"),
        (
            good.replacen(&count, "99999999999", 1),
            ":1: 99999999999 bodies",
        ),
        (
            good.replacen("vrot:R:3", "spin:R:3", 1),
            ":2: the properties are",
        ),
        (
            good.replacen("vrot:R:3", "vrot:R:x", 1),
            ":2: `vrot:R:x` among",
        ),
        (good.replacen("Time=", "Time=x", 1), "`Time=` is no number"),
        (
            good.replacen("Properties=", "", 1),
            ":2: there are no `Properties=`",
        ),
        (
            good.replacen("XX  ", "XX 1 ", 1),
            ":3: 17 values; expected 16",
        ),
        (
            good.split_inclusive('\n').take(last - 1).collect(),
            "the file ends",
        ),
        (good.clone() + "XX\n", "expected the end"),
    ];
    for (text, expected) in cases {
        let error = read_frames(&write("a_000000000007.xyz", &text))
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    }
    let error = read_frames(&write("nameless.xyz", &good))
        .unwrap_err()
        .to_string();
    assert!(error.contains("expected that of the step"), "{error}");
    let mut tried = 0;
    let mut refuse = |text: &str, source: &ImportSource, expected: &str| {
        tried += 1;
        let file = write("b_000000000007.xyz", text);
        let out = folder.path().join(format!("refused-{tried}"));
        let error = import(&[file], source, &out, false, &mut ())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    };
    let mut source = ImportSource::of_scene("column", job.scene, Vec::new());
    refuse(&good, &source, "--time-step");
    // The time of the seventh step.
    let timed = |text: &str, source: &ImportSource| {
        let (before, after) = text.split_once("Time=").unwrap();
        let rest = after.split_once('\n').unwrap().1;
        format!("{before}Time={:e}\n{rest}", 7.0 * source.time_step)
    };
    source.scene.seed += 1;
    refuse(
        &timed(&good, &source),
        &source,
        "is it the scene, and its seed",
    );
    let spheres = Scene::open("small-drum").unwrap();
    let source = ImportSource::of_scene("drum", spheres, Vec::new());
    refuse(&timed(&good, &source), &source, "the scene's are spheres");
}
