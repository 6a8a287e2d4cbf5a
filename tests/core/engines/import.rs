//! What engines wrote, read back: dumps and data files, their faults, and the run that they become.

use super::{built, dry_drum, export_text};
use glam::DVec3;
use grainfall::engines::{
    AtomFrame, ImportSource, MpiEngine, import, named_files, read_frames, scene_from,
};
use grainfall::measure::Measure;
use grainfall::run::{RunRecord, SAMPLE_INTERVAL};
use grainfall::runner::{Advance, DirectRun, Job};
use grainfall::scene::Scene;
use grainfall::world::{World, build};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// A dump of `world` as LIGGGHTS writes it, at its step.
pub fn dump(world: &World) -> String {
    let grains = &world.grains;
    let mut text = format!(
        "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\n",
        world.clock.step,
        grains.len()
    );
    text += "ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius fx fy fz \n";
    for i in 0..grains.len() {
        let weight = grains.mass[i] * world.gravity;
        let vectors = [
            grains.position[i],
            grains.velocity[i],
            grains.spin[i],
            grains.force[i] + weight,
        ];
        let [x, v, w, f] = vectors.map(|v| format!("{:e} {:e} {:e}", v.x, v.y, v.z));
        let kind = grains.species[i].0 + 1;
        let radius = grains.radius[i];
        let _ = writeln!(text, "{} {kind} {x} {v} {w} {radius:e} {f} ", i + 1);
    }
    text
}

fn written(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn data_file_comes_back_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    export_text(&dry_drum(), MpiEngine::Liggghts, folder.path()).unwrap();
    let (_, world) = built(&dry_drum());
    let frames = read_frames(&folder.path().join("grains.data")).unwrap();
    let [AtomFrame { step: 0, atoms, .. }] = &frames[..] else {
        panic!("{frames:?}")
    };
    assert_eq!(atoms.len(), 3);
    for (i, atom) in atoms.iter().enumerate() {
        let grains = &world.grains;
        assert_eq!(atom.id, i as u64 + 1);
        assert_eq!(
            [atom.position, atom.velocity, atom.spin],
            [grains.position[i], grains.velocity[i], grains.spin[i]]
        );
        assert_eq!(atom.radius, grains.radius[i]);
    }
}

#[test]
fn dumps_of_both_engines_are_read_whatever_the_order_of_their_columns() {
    let lammps = "ITEM: UNITS\nsi\nITEM: TIME\n0.25\nITEM: TIMESTEP\n25\nITEM: NUMBER OF ATOMS\n2\n\
                  ITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\n\
                  ITEM: ATOMS vx vy vz diameter mass id x y z\n1 2 3 0.004 7 9 4 5 6\n0 0 0 0.002 7 3 1 1 1\n\
                  ITEM: TIMESTEP\n50\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\n\
                  ITEM: ATOMS vx vy vz diameter mass id x y z\n0 0 0 0.002 7 3 1 1 1\n";
    let folder = tempfile::tempdir().unwrap();
    let frames = read_frames(&written(folder.path(), "a.dump", lammps)).unwrap();
    assert_eq!((frames.len(), frames[0].step, frames[1].step), (2, 25, 50));
    assert_eq!(frames[0].time, Some(0.25));
    // In order of their numbers, not of their rows.
    let [first, second] = &frames[0].atoms[..] else {
        panic!()
    };
    assert_eq!((first.id, second.id, second.kind), (3, 9, 1));
    assert_eq!(
        (second.radius, second.velocity.z, second.position.y),
        (0.002, 3.0, 5.0)
    );
    assert_eq!((second.spin, second.force), (DVec3::ZERO, None));
    assert_eq!(frames[1].atoms[0], *first);
}

/// A dump of `world` with its positions in these columns, in a box from −1, −2, −4 to 1, 6, 4 m.
fn dump_in_box(world: &World, names: [&str; 3], bounds: &str) -> String {
    let place = |x: DVec3| match names[0] {
        "xs" | "xsu" => (x - DVec3::new(-1.0, -2.0, -4.0)) / DVec3::new(2.0, 8.0, 8.0),
        _ => x,
    };
    let mut text = format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {bounds}\nITEM: ATOMS id type {} vx vy vz radius\n",
        world.grains.len(),
        names.join(" ")
    );
    for (i, x) in world.grains.position.iter().enumerate() {
        let (x, r) = (place(*x), world.grains.radius[i]);
        let _ = writeln!(
            text,
            "{} 1 {:e} {:e} {:e} 0 0 0 {r:e}",
            i + 1,
            x.x,
            x.y,
            x.z
        );
    }
    text
}

#[test]
fn one_state_written_with_any_coordinates_reads_equal() {
    let (_, world) = built(&dry_drum());
    let folder = tempfile::tempdir().unwrap();
    let read = |text: &str| read_frames(&written(folder.path(), "a.dump", text));
    let bounds = "ff pp ss\n-1 1\n-2 6\n-4 4";
    for names in [
        ["x", "y", "z"],
        ["xu", "yu", "zu"],
        ["xs", "ys", "zs"],
        ["xsu", "ysu", "zsu"],
    ] {
        let frames = read(&dump_in_box(&world, names, bounds)).unwrap();
        for (atom, x) in frames[0].atoms.iter().zip(&world.grains.position) {
            // Places are some centimetres in a box of metres: a few roundings of the box.
            assert!(
                (atom.position - *x).length() < 4e-15,
                "{names:?}: {}",
                atom.position
            );
        }
    }
    // A box that might be tilted and is not.
    let straight = "xy xz yz ff ff ff\n-1 1 0\n-2 6 0\n-4 4 0.0";
    let scaled = ["xs", "ys", "zs"];
    assert!(read(&dump_in_box(&world, scaled, straight)).is_ok());
    let tilted = "xy xz yz ff ff ff\n-1 1 0\n-2 6 0.5\n-4 4 0";
    assert!(read(&dump_in_box(&world, ["x", "y", "z"], tilted)).is_ok());
    let cases = [
        (
            tilted,
            "the box is tilted (`xy xz yz ff ff ff`): dump `x y z`",
        ),
        (
            "abc origin\n1 0 0 0\n0 1 0 0\n0 0 1 0",
            "general parallelepiped",
        ),
        ("ff ff ff\n1 1\n-2 6\n-4 4", "from 1.0 to 1.0"),
        ("ff ff ff\n-1 inf\n-2 6\n-4 4", "to inf"),
        ("ff ff ff\n-1 x\n-2 6\n-4 4", "to NaN"),
        ("ff ff ff\n-1\n-2 6\n-4 4", "has 1 numbers"),
    ];
    for (bounds, expected) in cases {
        let error = read(&dump_in_box(&world, scaled, bounds))
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    }
    let text = dump_in_box(&world, scaled, bounds);
    let unbound = text.replace(&format!("ITEM: BOX BOUNDS {bounds}\n"), "");
    let error = read(&unbound).unwrap_err().to_string();
    assert!(error.contains("no `ITEM: BOX BOUNDS`"), "{error}");
}

#[test]
fn faults_of_files_are_told_with_their_place() {
    let (_, world) = built(&dry_drum());
    let good = dump(&world);
    let last_row = good.lines().count();
    let cut = good[..good.len() / 2]
        .rsplit_once(' ')
        .unwrap()
        .0
        .to_owned();
    let cases = [
        (String::new(), "is empty".to_owned()),
        (
            "hello\n\nworld\n".to_owned(),
            "neither a dump nor a data file".to_owned(),
        ),
        (
            good.replace("ITEM: TIMESTEP\n0", "ITEM: TIMESTEP\nzero"),
            ":2: `zero`".to_owned(),
        ),
        (
            good.replace("ITEM: TIMESTEP\n0", "ITEM: TIMESTEP\n18446744073709551615"),
            ":2: step 18446744073709551615; expected at most".to_owned(),
        ),
        (
            good.replace("ATOMS\n3", "ATOMS\n4"),
            format!(":{last_row}: the file ends"),
        ),
        (
            good.replace("ATOMS\n3", "ATOMS\n99999999999"),
            ":4: 99999999999 grains".to_owned(),
        ),
        (
            good.replace("ATOMS\n3", "ATOMS\n2"),
            "expected `ITEM: …`".to_owned(),
        ),
        (good.replace("omegax", "vx"), String::new()),
        (good.replace(" vz ", " "), "expected vx, vy, vz".to_owned()),
        (
            good.replace(" radius ", " r "),
            "neither a column `radius`".to_owned(),
        ),
        (
            good.replace("\n2 2 ", "\n1 2 "),
            "grain 1 occurs twice".to_owned(),
        ),
        (
            good.replace("\n2 2 1.2e-2", "\n2 2 NaN"),
            "position of grain 2".to_owned(),
        ),
        (
            good.replace("\n2 2 1.2e-2", "\n2 2 1.2e-2x"),
            ":11: `1.2e-2x` is no number".to_owned(),
        ),
        (cut, ":".to_owned()),
        (
            format!("ITEM: UNITS\nlj\n{good}"),
            ":2: units `lj`; expected `si`".to_owned(),
        ),
        (
            "ITEM: ".to_owned() + &"x".repeat(40_000),
            "more than 16384 bytes".to_owned(),
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (text, expected) in cases {
        let path = written(folder.path(), "a.dump", &text);
        match read_frames(&path) {
            Ok(_) => assert_eq!(expected, "", "read: {text}"),
            Err(error) => {
                let error = error.to_string();
                assert!(error.contains(&expected) && !expected.is_empty(), "{error}");
            }
        }
    }
    let binary = folder.path().join("b.dump");
    fs::write(&binary, b"ITEM: \xff\xfe").unwrap();
    let error = read_frames(&binary).unwrap_err().to_string();
    assert!(error.contains("is no text"), "{error}");
    let error = read_frames(folder.path()).unwrap_err().to_string();
    assert!(error.contains("this is a folder"), "{error}");
}

#[test]
fn mutated_files_are_read_or_refused() {
    let (_, world) = built(&dry_drum());
    let folder = tempfile::tempdir().unwrap();
    export_text(&dry_drum(), MpiEngine::Lammps, folder.path()).unwrap();
    let data = fs::read_to_string(folder.path().join("grains.data")).unwrap();
    let scraps: [&[u8]; 8] = [
        b"ITEM: ",
        b"\n",
        b"-1",
        b"1e999",
        b"99999999999999999999",
        b" ",
        b"\xff",
        b"Atoms\n",
    ];
    let mut state = 7_u64;
    let mut random = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % below
    };
    let (mut read, mut refused) = (0, 0);
    for text in [dump(&world), data] {
        for _ in 0..1500 {
            let mut bytes = text.clone().into_bytes();
            for _ in 0..=random(2) {
                let (at, length) = (random(bytes.len()), random(12));
                let end = (at + length).min(bytes.len());
                bytes.splice(at..end, scraps[random(scraps.len())].iter().copied());
            }
            let path = folder.path().join("mutated");
            fs::write(&path, &bytes).unwrap();
            match read_frames(&path) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    println!("{read} read, {refused} refused");
    assert!(read > 100 && refused > 100);
}

/// A small drum's run for 0.2 s, sampled as ours are: dumps in a folder, the scene, the last state.
fn dumped(folder: &Path) -> (Job, DirectRun) {
    let mut scene = Scene::open("small-drum").unwrap();
    scene.set("duration", "200ms").unwrap();
    let job = Job::new("small-drum", scene, folder.join("unused"));
    let mut run = DirectRun::of(&job);
    while run.run().is_none() {
        run.advance(0).unwrap();
    }
    fs::create_dir(folder.join("dumps")).unwrap();
    for k in 0..=10 {
        let goal = run
            .run()
            .unwrap()
            .world()
            .clock
            .step_at(f64::from(k) * SAMPLE_INTERVAL);
        while run.run().unwrap().world().clock.step < goal {
            run.advance(goal).unwrap();
        }
        // Names whose order is not that of their times.
        let name = format!("dumps/grains_{}.dump", 30 - k);
        written(folder, &name, &dump(run.run().unwrap().world()));
    }
    (job, run)
}

#[test]
fn imported_run_is_measured_as_ours() {
    let folder = tempfile::tempdir().unwrap();
    let (job, run) = dumped(folder.path());
    let source = ImportSource::of_scene("small-drum", job.scene, Vec::new());
    let files = named_files(&[folder.path().to_owned()]).unwrap();
    assert_eq!(files.len(), 11);
    let out = folder.path().join("out");
    let imported = import(&files, &source, &out, false, &mut ()).unwrap();
    assert_eq!(imported.frames, 11);

    // Column by column, against the samples of the run itself.
    let ours = run.run().unwrap().series();
    let mut table = csv::Reader::from_path(out.join("series.csv")).unwrap();
    let heads = table.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), ours.len());
    let known = [
        Measure::SurfaceAngle,
        Measure::GranularTemperature,
        Measure::CorotatingTemperature,
        Measure::PackingFraction,
        Measure::CoordinationNumber,
        Measure::KineticEnergy,
        Measure::LargestOverlap,
        Measure::MeanSpeed,
    ];
    for measure in known {
        let key = measure.quantity().key;
        let place = heads
            .iter()
            .position(|head| head.split(" [").next() == Some(key))
            .unwrap();
        for (row, own) in rows.iter().zip(ours.column(measure)) {
            let value: f64 = row[place].parse().unwrap();
            let is_same = (value - own).abs() <= 1e-9 * own.abs() || value.is_nan() && own.is_nan();
            assert!(is_same, "{key}: {value} imported, {own} ours");
        }
    }
    let place = heads
        .iter()
        .position(|head| head.starts_with("sliding loss"))
        .unwrap();
    assert!(rows.iter().all(|row| &row[place] == "NaN"));
    assert!(out.join("grains/grains_000010.vtp").is_file() && out.join("grains.pvd").is_file());

    let ours = run.run().unwrap().world();
    for (own, theirs) in ours
        .grains
        .force
        .iter()
        .zip(imported.last.grains.force.iter())
    {
        assert!(
            (*own - *theirs).length() < 1e-12,
            "weight is no contact force"
        );
    }
}

#[test]
fn import_says_that_it_is_one_and_takes_no_others_folder() {
    let folder = tempfile::tempdir().unwrap();
    let (job, _) = dumped(folder.path());
    let source = ImportSource::of_scene("small-drum", job.scene, Vec::new());
    let files = named_files(&[folder.path().to_owned()]).unwrap();
    let out = folder.path().join("out");
    import(&files, &source, &out, false, &mut ()).unwrap();
    let summary = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(summary.contains("\"status\": \"imported\""));
    let refused = RunRecord::read(&out.join("summary.json"))
        .unwrap_err()
        .to_string();
    assert!(refused.contains("cannot be computed again"), "{refused}");
    let refused = import(&files, &source, &out, false, &mut ())
        .unwrap_err()
        .to_string();
    assert!(refused.contains("--restart"), "{refused}");
    assert_eq!(
        fs::read_to_string(out.join("summary.json")).unwrap(),
        summary
    );
    import(&files[..3], &source, &out, true, &mut ()).unwrap();
    assert!(!out.join("grains/grains_000003.vtp").exists());
}

#[test]
fn files_that_do_not_fit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (job, _) = dumped(folder.path());
    let files = named_files(&[folder.path().to_owned()]).unwrap();
    let source = ImportSource::of_scene("small-drum", job.scene.clone(), Vec::new());
    let text = fs::read_to_string(&files[0]).unwrap();
    let mut tried = 0;
    let mut refuse = |files: &[PathBuf], source: &ImportSource, expected: &str| {
        tried += 1;
        let out = folder.path().join(format!("out-{tried}"));
        let error = import(files, source, &out, false, &mut ())
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    };
    refuse(
        &[files[0].clone(), files[0].clone()],
        &source,
        "each instant once",
    );
    let row = text.lines().find(|line| line.starts_with("1 1 ")).unwrap();
    let rest = row.splitn(4, ' ').last().unwrap();
    let far = text.replace(row, &format!("1 1 9 {rest}"));
    refuse(&[written(folder.path(), "far", &far)], &source, "far: step");
    let typed = text.replacen("\n1 1 ", "\n1 7 ", 1);
    refuse(
        &[written(folder.path(), "typed", &typed)],
        &source,
        "of type 7; the scene's",
    );
    let timed = format!("ITEM: TIME\n77\n{text}");
    refuse(
        &[written(folder.path(), "timed", &timed)],
        &source,
        "`--time-step`",
    );
    let column = Scene::open("small-column").unwrap();
    let of_column = ImportSource::of_scene("column", column, Vec::new());
    refuse(&files[..1], &of_column, "the scene has");
    let none = named_files(&[folder.path().join("out-1")])
        .unwrap_err()
        .to_string();
    assert!(none.contains("has the engine run?"), "{none}");
}

#[test]
fn last_state_begins_a_new_scene() {
    let folder = tempfile::tempdir().unwrap();
    let (job, _) = dumped(folder.path());
    let source = ImportSource::of_scene("small-drum", job.scene, Vec::new());
    let files = named_files(&[folder.path().to_owned()]).unwrap();
    let imported = import(&files, &source, &folder.path().join("out"), false, &mut ()).unwrap();
    let scene = scene_from(&imported.scene, &imported.last);
    let text = scene.to_text().unwrap();
    let read = Scene::parse("start.ron", &text).unwrap();
    assert_eq!(read, scene);
    let world = build(&read, 1e-5);
    assert_eq!(world.grains.position, imported.last.grains.position);
    assert_eq!(world.grains.spin, imported.last.grains.spin);
}

#[test]
fn export_knows_its_own_dumps() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("export");
    export_text(&dry_drum(), MpiEngine::Lammps, &out).unwrap();
    let (scene, world) = built(&dry_drum());
    fs::create_dir(out.join("dumps")).unwrap();
    // LAMMPS has a type for each radius: glass of 3 mm, steel, glass of 2.5 mm.
    let text = dump(&world).replace("\n3 1 ", "\n3 3 ");
    written(&out, "dumps/grains_0.dump", &text);
    let dumps = named_files(std::slice::from_ref(&out)).unwrap();
    for path in [&out, &dumps[0]] {
        let source = ImportSource::beside(path).unwrap().unwrap();
        assert_eq!(
            (&source.scene, source.name.as_str()),
            (&scene, "test-lammps")
        );
        let to = folder.path().join("imported");
        let imported = import(&dumps, &source, &to, true, &mut ()).unwrap();
        assert_eq!(imported.last.grains.species, world.grains.species);
    }
    assert!(ImportSource::beside(folder.path()).unwrap().is_none());
}
