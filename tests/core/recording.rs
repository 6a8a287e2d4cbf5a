//! Claims about recordings: a run's folder shows the states that the run came to, and nothing that
//! it does not hold.

use crate::engines::import::dump;
use crate::meshes;
use crate::runs::{friction, prepared, shared_beds};
use glam::DVec3;
use grainfall::engines::{ImportSource, import, sound_scene_from};
use grainfall::geometry::Polyhedron;
use grainfall::lab::{DriverKind, Lab, LabCommand, Options, Status};
use grainfall::measure::{FlowDepth, GrainQuantity};
use grainfall::recording::{Recording, RunProgress};
use grainfall::run::{Command, Parameter, Script, ScriptedCommand};
use grainfall::runner::{Job, run};
use grainfall::scene::{Scene, SceneContainer};
use grainfall::world::{Surface, World, build};
use std::cell::RefCell;
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use tempfile::TempDir;

/// Half of the last of the 24 bits of a number in a file, relative to it.
const PRECISION: f64 = 6e-8;

fn scene(name: &str, settings: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::open(name).unwrap();
    let steady = [("duration", "40ms"), ("output-interval", "10ms")];
    for (key, value) in steady.iter().chain(settings) {
        scene.set(key, value).unwrap();
    }
    scene
}

fn drum() -> Scene {
    scene("small-drum", &[("count", "60")])
}

fn column() -> Scene {
    scene("small-column", &[("radius", "8mm"), ("height", "8mm")])
}

/// The drum's speed is another from a step on.
fn faster() -> Vec<ScriptedCommand> {
    vec![ScriptedCommand {
        step: Some(300),
        time: None,
        command: Command::Set {
            parameter: Parameter::DrumSpeed,
            value: 0.9.into(),
        },
    }]
}

/// The folder of a run of `scene` with this `script`.
fn recorded(scene: &Scene, script: Vec<ScriptedCommand>) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let job = Job {
        threads: 1,
        beds: shared_beds(),
        script,
        ..Job::new("a-run", scene.clone(), &out)
    };
    run(&job, &mut (), &|| false).unwrap();
    (folder, out)
}

/// The lab that plays the recording in `folder`.
fn playing(folder: &Path) -> Lab {
    let options = Options {
        driver: DriverKind::Inline,
        autoplay: false,
        ..Options::window()
    };
    let mut lab = Lab::play_back(Recording::open(folder).unwrap(), options);
    lab.tick(Duration::ZERO);
    lab
}

fn send(lab: &mut Lab, command: impl Into<LabCommand>) {
    lab.send(command);
    lab.tick(Duration::ZERO);
    assert!(lab.has_answered());
}

fn time(lab: &Lab) -> f64 {
    lab.world().unwrap().time()
}

/// Whether each of the numbers is that of the run to the files' precision.
fn are_same(recorded: &[glam::DVec3], own: &[glam::DVec3]) {
    assert_eq!(recorded.len(), own.len());
    for (a, b) in recorded.iter().zip(own) {
        for (a, b) in a.to_array().into_iter().zip(b.to_array()) {
            assert!((a - b).abs() <= PRECISION * b.abs() + 1e-40, "{a:e} {b:e}");
        }
    }
}

fn are_same_states(recorded: &World, own: &World) {
    let (grains, own_grains) = (&recorded.grains, &own.grains);
    are_same(&grains.position, &own_grains.position);
    are_same(&grains.velocity, &own_grains.velocity);
    are_same(&grains.spin, &own_grains.spin);
    are_same(&grains.force, &own_grains.force);
    assert_eq!(grains.species, own_grains.species);
    for (a, b) in grains.mass.iter().zip(&own_grains.mass) {
        assert!((a / b - 1.0).abs() < 3.0 * PRECISION, "{a} {b}");
    }
    assert_eq!(recorded.clock, own.clock);
    assert_eq!(recorded.materials, own.materials);
    let turned = recorded.container.angle - own.container.angle;
    assert!(turned.abs() < 1e-12, "{turned}");
    let pairs = |world: &World| -> Vec<_> {
        let contacts = world.contacts.iter();
        contacts.map(|c| (c.grain, c.partner, c.touching)).collect()
    };
    assert_eq!(pairs(recorded), pairs(own));
    // At time zero the drum begins to turn: the files tell the terms by which it does, the bed still
    // has the forces by which it came to rest.
    let moves = own.time() > 0.0;
    for (a, b) in recorded
        .contacts
        .iter()
        .zip(&own.contacts)
        .filter(|_| moves)
    {
        // The parts of a force are rounded one by one, and so are the terms that they are sums of.
        assert!((a.force - b.force).length() <= 1e-6 * b.force.length() + 1e-12);
    }
}

#[test]
fn every_state_is_that_of_the_run() {
    let wet = scene("water-drum", &[("count", "60"), ("duration", "20ms")]);
    for (scene, script) in [
        (drum(), faster()),
        (wet, Vec::new()),
        (column(), Vec::new()),
    ] {
        let (_folder, out) = recorded(&scene, script.clone());
        let recording = Recording::open(&out).unwrap();
        assert_eq!(recording.notes(), [""; 0]);
        let (mut run, _) = prepared(&scene, 1, shared_beds());
        let script = Script::new(&script, &run.world().clock).unwrap();
        run.schedule(script).unwrap();
        let moments = recording.moments();
        assert!(moments.len() >= 3, "{moments:?}");
        for (index, moment) in moments.iter().enumerate() {
            run.advance_to(moment.step).unwrap();
            let state = recording.state(index).unwrap();
            assert_eq!(state.notes, [""; 0]);
            are_same_states(&state.world, run.world());
        }
        assert_eq!(recording.branch().series.steps(), run.series().steps());
        assert_eq!(
            recording.branch().series.last().unwrap().time,
            run.series().last().unwrap().time
        );
        assert_eq!(recording.branch().end.step, run.world().clock.step);
        assert_eq!(recording.branch().history.commands(), run.commands());
    }
}

#[test]
fn polyhedra_look_as_they_did_in_the_run() {
    let scene = column();
    let (_folder, out) = recorded(&scene, Vec::new());
    let recording = Recording::open(&out.join("grains.pvd")).unwrap();
    let shown = recording.state(2).unwrap().world;
    let (run, _) = prepared(&scene, 1, shared_beds());
    let (own, shown) = (
        run.world().polyhedra.as_ref().unwrap(),
        shown.polyhedra.unwrap(),
    );
    assert_eq!(own.shapes.len(), shown.shapes.len());
    for (own, shown) in own.shapes.iter().zip(shown.shapes.iter()) {
        are_same_shapes(own, shown);
    }
}

/// The same to the precision of a file.
fn are_same_shapes(own: &Polyhedron, shown: &Polyhedron) {
    assert_eq!((&own.faces, &own.edges), (&shown.faces, &shown.edges));
    assert!((own.rounding / shown.rounding - 1.0).abs() < PRECISION);
    assert!((own.volume / shown.volume - 1.0).abs() < PRECISION);
    assert!((own.gyration / shown.gyration - 1.0).abs().max_element() < PRECISION);
    let size = own.bounding_radius();
    for (a, b) in own.vertices.iter().zip(&shown.vertices) {
        assert!(a.distance(*b) < 2.0 * PRECISION * size, "{a} {b}");
    }
}

/// A tube cuts slivers off cells, which are gone from their cores: faces of a core moved out do not
/// meet where those of its cell did, if they meet at all.
#[test]
fn bodies_cut_round_by_a_tube_begin_a_scene() {
    let text = r#"(
        title: "A cut column", materials: {"stone": ()}, duration: 1e-4, output_interval: 5e-5,
        container: Column(radius_mm: 20, height_mm: 25, material: "stone", tube: (speed: 0.1)),
        grains: Voronoi(cell_mm: 4, rounding_mm: 0.4, species: [(material: "stone", share: 1)]),
        law: Hooke(normal_stiffness: 1000, tangential_stiffness: 500, features: Shared),
    )"#;
    let scene = Scene::parse("cut", text).unwrap();
    let (_folder, out) = recorded(&scene, Vec::new());
    let state = Recording::open(&out).unwrap().state(1).unwrap().world;
    let (run, _) = prepared(&scene, 1, shared_beds());
    let (own, shown) = (run.world().polyhedra.as_ref(), state.polyhedra.as_ref());
    for (own, shown) in own.unwrap().shapes.iter().zip(&*shown.unwrap().shapes) {
        are_same_shapes(own, shown);
    }
    let started = sound_scene_from(&scene, &state).unwrap();
    let (mut run, _) = prepared(&started, 1, shared_beds());
    assert!(run.world().grains.len() > 300);
    run.advance_to(20).unwrap();
}

#[test]
fn a_recording_plays_holds_and_pauses_at_its_end() {
    let (_folder, out) = recorded(&drum(), Vec::new());
    let mut lab = playing(&out.join("summary.json"));
    assert_eq!((lab.status(), time(&lab)), (&Status::Paused, 0.0));
    // Until a state is due, the one before it stays.
    send(&mut lab, Command::Play);
    lab.tick(Duration::from_millis(9));
    assert_eq!(time(&lab), 0.0);
    lab.tick(Duration::from_millis(2));
    assert!((time(&lab) - 0.01).abs() < 1e-4, "{}", time(&lab));
    assert_eq!(lab.status(), &Status::Running);
    for _ in 0..10 {
        lab.tick(Duration::from_millis(10));
    }
    assert_eq!(lab.status(), &Status::Paused);
    assert_eq!(lab.step(), lab.past().end.step);
    assert!(!lab.looks_back() && !lab.is_unsaved());
    // Again from the start, and one by one.
    send(&mut lab, Command::Play);
    assert_eq!(time(&lab), 0.0);
    send(&mut lab, Command::Step(1));
    let moments = lab.recording().unwrap().moments.clone();
    assert_eq!(
        (lab.step(), lab.status()),
        (moments[1].step, &Status::Paused)
    );
    let nearly_third = moments[2].step - 1;
    send(&mut lab, Command::Seek(nearly_third));
    assert_eq!(lab.step(), moments[2].step);
    // As fast as it can, state by state.
    send(&mut lab, Command::Reset);
    send(&mut lab, Command::Speed(f64::INFINITY));
    send(&mut lab, Command::Play);
    lab.tick(Duration::from_millis(1));
    assert_eq!(lab.step(), lab.past().end.step);
    assert_eq!(lab.warnings(), [""; 0]);
}

#[test]
fn what_takes_a_run_is_refused_with_the_way_out() {
    let (_folder, out) = recorded(&drum(), Vec::new());
    let mut lab = playing(&out);
    let before = lab.world().unwrap().clone();
    send(&mut lab, friction_command());
    send(&mut lab, Command::Undo);
    let path = out.join("session.grainfall");
    let look = String::new();
    send(
        &mut lab,
        LabCommand::Save {
            path: path.clone(),
            look,
        },
    );
    assert_eq!(lab.warnings().len(), 3, "{:?}", lab.warnings());
    assert!(lab.warnings().iter().all(|text| text.contains("Run anew")));
    assert!(!path.exists() && !lab.is_saving() && !lab.can_compare());
    assert!(Arc::ptr_eq(lab.world().unwrap(), &before));
    let from = lab.provenance().unwrap().to_string();
    assert!(from.contains("out of the files of a run"), "{from}");
}

fn friction_command() -> Command {
    friction(0.1)
}

#[test]
fn damaged_and_changed_files_are_named() {
    let (_folder, out) = recorded(&drum(), Vec::new());
    let frame = |index: usize| out.join(format!("grains/grains_{index:06}.vtp"));
    let good = fs::read(frame(1)).unwrap();
    fs::write(frame(1), &good[..good.len() / 2]).unwrap();
    let text = fs::read_to_string(frame(2)).unwrap();
    fs::write(frame(2), text.replace("Grainfall", "grainfall")).unwrap();
    fs::remove_file(frame(3)).unwrap();
    let mut lab = playing(&out);
    let moments = lab.recording().unwrap().moments.clone();
    send(&mut lab, Command::Step(1));
    assert_eq!(lab.step(), 0, "the state before it stays");
    send(&mut lab, Command::Step(1));
    assert_eq!(lab.step(), moments[2].step);
    send(&mut lab, Command::Seek(moments[3].step));
    let said = lab.warnings().to_vec();
    let [damaged, changed, missing] = &said[..] else {
        panic!("{said:?}")
    };
    assert!(
        damaged.contains("grains_000001.vtp: is no XML"),
        "{damaged}"
    );
    assert!(
        changed.contains("grains_000002.vtp is not as it was written"),
        "{changed}"
    );
    assert!(
        missing.contains("grains_000003.vtp: cannot be read"),
        "{missing}"
    );
    // Each is told once.
    for moment in moments.iter().rev() {
        send(&mut lab, Command::Seek(moment.step));
    }
    assert_eq!(lab.warnings().len(), 3, "{:?}", lab.warnings());
}

#[test]
fn folders_that_hold_no_states_are_refused_with_the_reason() {
    let (folder, out) = recorded(&drum(), Vec::new());
    let refused = |path: &Path| match Recording::open(path) {
        Ok(_) => panic!("it opens"),
        Err(error) => error.to_string(),
    };
    assert!(refused(folder.path()).contains("holds no summary.json"));
    let list = fs::read_to_string(out.join("grains.pvd")).unwrap();
    let with_list = |text: &str| {
        fs::write(out.join("grains.pvd"), text).unwrap();
        refused(&out)
    };
    let elsewhere = with_list(&list.replace("grains/grains_000000.vtp", "../../etc/passwd"));
    assert!(
        elsewhere.contains("is no name of a run's file"),
        "{elsewhere}"
    );
    let twice = with_list(&list.replace("timestep=\"0.0\"", "timestep=\"9.0\""));
    assert!(twice.contains("entry 2 is not later"), "{twice}");
    assert!(with_list("<VTKFile/>").contains("lists no states"));
    fs::remove_file(out.join("grains.pvd")).unwrap();
    assert!(refused(&out).contains("wrote no states"));
    fs::write(out.join("summary.json"), "{}").unwrap();
    assert!(refused(&out).contains("cannot be played"));
    assert!(Recording::is_at(out.to_str().unwrap()) && !Recording::is_at("small-drum"));
}

#[cfg(unix)]
#[test]
fn links_out_of_the_folder_are_not_followed() {
    let (folder, out) = recorded(&drum(), Vec::new());
    let frame = out.join("grains/grains_000001.vtp");
    let elsewhere = folder.path().join("elsewhere.vtp");
    fs::rename(&frame, &elsewhere).unwrap();
    std::os::unix::fs::symlink(&elsewhere, &frame).unwrap();
    let error = Recording::open(&out).unwrap().state(1).err().unwrap();
    assert!(error.to_string().contains("is a link"), "{error}");
}

#[test]
fn an_import_plays_without_forces() {
    let folder = tempfile::tempdir().unwrap();
    let scene = drum();
    let dump = folder.path().join("a.dump");
    fs::write(&dump, dump_of(&scene)).unwrap();
    let out = folder.path().join("imported");
    let source = ImportSource::of_scene("drum", scene, Vec::new());
    import(&[dump], &source, &out, false, &mut ()).unwrap();
    let mut lab = playing(&out);
    assert!(lab.recording().unwrap().is_imported);
    assert_eq!(lab.world().unwrap().grains.len(), 60);
    let world = lab.world().unwrap().clone();
    assert!(!world.contacts.is_empty() && world.contacts[0].force.is_nan());
    assert!(GrainQuantity::Speed.applies_to(&world));
    assert!(!GrainQuantity::Pressure.applies_to(&world));
    send(&mut lab, Command::Step(1));
    assert_eq!(lab.step(), 200);
    assert!(lab.sample().is_some());
}

/// A dump of two instants of a run of `scene`.
fn dump_of(scene: &Scene) -> String {
    let (mut run, _) = prepared(scene, 1, shared_beds());
    let first = dump(run.world());
    run.advance_to(200).unwrap();
    first + &dump(run.world())
}

/// Bodies in a tube that rises.
fn tube() -> Scene {
    let text = r#"(
        title: "A tube", materials: {"stone": ()}, duration: 0.04, output_interval: 0.01,
        container: Column(radius_mm: 25, height_mm: 50, material: "stone", tube: (speed: 0.3)),
        grains: List([
            (position: (0, 0.005, 0), shape: Box(size: (0.01, 0.01, 0.02)), material: "stone"),
            (
                position: (0.01, 0.02, 0), shape: Tetrahedron(edge: 0.01), rounding_mm: 0.2, material: "stone",
                orientation: Turned(axis: (1, 1, 0), angle_deg: 30), velocity: (0.1, 0, 0), spin: (0, 2, 0),
            ),
            (
                position: (-0.01, 0.03, 0), material: "stone",
                shape: Hull(points: [(0, 0, 0), (0.01, 0, 0), (0, 0.012, 0), (0, 0, 0.013), (0.01, 0.012, 0.013)]),
            ),
        ]),
        law: Hooke(normal_stiffness: 4000, tangential_stiffness: 2000, features: Shared),
    )"#;
    Scene::parse("tube", text).unwrap()
}

/// A grain on a floor that moves along.
fn belt() -> Scene {
    let text = r#"(
        title: "A belt", materials: {"glass": ()}, duration: 0.04, output_interval: 0.01,
        container: Planes([(name: "belt", point: (0, 0, 0), normal: (0, 1, 0), velocity: (0.1, 0, 0), material: "glass")]),
        grains: List([(position: (0, 0.003, 0), radius_mm: 3, material: "glass")]),
    )"#;
    Scene::parse("belt", text).unwrap()
}

/// A grain in a small drum of triangles that turns.
fn meshed_drum() -> Scene {
    let triangles = meshes::key(&meshes::drum(0.02, 0.01, 12));
    let text = format!(
        r#"(
            title: "A drum of triangles", materials: {{"glass": ()}}, duration: 0.04, output_interval: 0.01,
            container: Mesh({triangles}, material: "glass",
                motion: Turning(through: (0, 0, 0), axis: (0, 0, 1), speed_rpm: 60)),
            grains: List([(position: (0, -0.01, 0), radius_mm: 3, material: "glass")]),
        )"#
    );
    Scene::parse("meshed drum", &text).unwrap()
}

/// A mesh that turned is that of the triangles where they are.
#[test]
fn a_scene_goes_on_between_triangles_where_they_have_turned_to() {
    let scene = meshed_drum();
    let (_folder, out) = recorded(&scene, Vec::new());
    let state = Recording::open(&out).unwrap().state(2).unwrap().world;
    let started = sound_scene_from(&scene, &state).unwrap();
    let world = build(&started, state.clock.time_step);
    let corners = |world: &World| -> Vec<DVec3> {
        let walls = world.container.walls.iter();
        let meshes = walls.filter_map(|wall| match &wall.surface {
            Surface::Mesh(mesh) => Some(mesh.triangles().flatten()),
            _ => None,
        });
        meshes.flatten().collect()
    };
    let at_start = corners(&build(&scene, state.clock.time_step));
    let (now, expected) = (corners(&world), corners(&state));
    assert_eq!(now, expected);
    // A corner of the rim has come by this arc's chord, 60 rpm for 20 ms.
    let chord = 2.0 * at_start[0].truncate().length() * (0.5 * TAU * 0.02_f64).sin();
    let way = now[0].distance(at_start[0]);
    assert!((way / chord - 1.0).abs() < 1e-3, "{way} {chord}");
    let motions =
        |world: &World| -> Vec<_> { world.container.walls.iter().map(|w| w.motion).collect() };
    assert_eq!(motions(&world), motions(&state));
}

#[test]
fn a_scene_goes_on_from_a_state_as_it_was_recorded() {
    for scene in [drum(), column(), tube(), belt()] {
        let (_folder, out) = recorded(&scene, Vec::new());
        let state = Recording::open(&out).unwrap().state(2).unwrap().world;
        let started = sound_scene_from(&scene, &state).unwrap();
        let text = started.to_text().unwrap();
        let read = Scene::parse("started.ron", &text).unwrap_or_else(|error| panic!("{error}"));
        let world = build(&read, state.clock.time_step);
        let (own, expected) = (&world.grains, &state.grains);
        assert_eq!(own.position, expected.position);
        assert_eq!(own.velocity, expected.velocity);
        assert_eq!(own.spin, expected.spin);
        assert_eq!(own.mass, expected.mass);
        assert_eq!(own.radius, expected.radius);
        for (own, expected) in world.container.walls.iter().zip(&state.container.walls) {
            assert_eq!(
                (&own.surface, own.motion),
                (&expected.surface, expected.motion)
            );
        }
        let bodies = world.polyhedra.as_ref().zip(state.polyhedra.as_ref());
        assert_eq!(bodies.is_some(), scene.is_polyhedral());
        if let Some((own, expected)) = bodies {
            for grain in 0..world.grains.len() {
                assert_eq!(own.shape_of(grain), expected.shape_of(grain));
                // It is made a unit quaternion anew.
                let turned = own.orientation[grain] - expected.orientation[grain];
                assert!(turned.length() < 1e-15, "{turned}");
            }
        }
        let (mut run, _) = prepared(&read, 1, shared_beds());
        run.advance_to(20).unwrap();
    }
}

#[test]
fn a_tube_that_has_risen_stands_where_it_was() {
    let (_folder, out) = recorded(&tube(), Vec::new());
    let state = Recording::open(&out).unwrap().state(2).unwrap().world;
    let started = sound_scene_from(&tube(), &state).unwrap();
    let SceneContainer::Column {
        tube: Some(tube), ..
    } = started.container
    else {
        panic!("a tube");
    };
    // 20 ms at 0.3 m/s.
    assert!((tube.rim - 6e-3).abs() < 1e-5, "{}", tube.rim);
}

#[test]
fn a_run_under_way_is_followed_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let job = Job {
        threads: 1,
        beds: shared_beds(),
        ..Job::new("a-run", drum(), &out)
    };
    // More than is waited from one look to the next.
    let look = Duration::from_secs(1000);
    let followed: RefCell<Option<Lab>> = RefCell::new(None);
    let lengths = RefCell::new(Vec::new());
    // Between two pieces of the run somebody looks.
    let between = || {
        let mut followed = followed.borrow_mut();
        let Some(lab) = followed.as_mut() else {
            let is_there = Recording::open(&out).is_ok();
            *followed = is_there.then(|| playing(&out));
            return false;
        };
        lab.tick(look);
        let facts = lab.recording().unwrap();
        assert_eq!(facts.progress, RunProgress::UnderWay);
        let (states, newest) = (facts.moments.len(), *facts.moments.last().unwrap());
        assert_eq!(lab.past().end, newest);
        // A sample each 20 ms, a state each 10 ms.
        assert_eq!(lab.series().len(), states.div_ceil(2));
        lengths.borrow_mut().push(states);
        // Who looks at the last state follows; who looks at another one stays there.
        if states < 4 {
            assert_eq!(lab.world().unwrap().clock.step, newest.step);
        } else {
            send(lab, Command::Seek(0));
            assert_eq!(time(lab), 0.0);
        }
        false
    };
    run(&job, &mut (), &between).unwrap();
    let mut lab = followed.into_inner().unwrap();
    lab.tick(look);
    let facts = lab.recording().unwrap();
    assert_eq!(
        (facts.progress, facts.moments.len()),
        (RunProgress::Over, 5)
    );
    let said = lab.warnings().join("; ");
    assert!(said.contains("The run ended at t = 0.040 s"), "{said}");
    let lengths = lengths.into_inner();
    assert!(lengths.is_sorted() && lengths.contains(&2) && lengths.contains(&3));
    assert_eq!(time(&lab), 0.0);
    let end = lab.past().end.step;
    send(&mut lab, Command::Seek(end));
    let mut read = playing(&out);
    send(&mut read, Command::Seek(end));
    are_same_states(lab.world().unwrap(), read.world().unwrap());
    assert_eq!(lab.series().time(), read.series().time());
    // A run that nobody computes is not under way.
    let summary = out.join("summary.json");
    let text = fs::read_to_string(&summary).unwrap();
    fs::write(&summary, text.replace("\"done\"", "\"running\"")).unwrap();
    assert_eq!(
        Recording::open(&out).unwrap().progress(),
        RunProgress::Stopped
    );
}

/// A drum whose bed flows from the start. Results count from the first whole second in the last three
/// fifths of a run on.
fn flowing() -> Scene {
    let values = [
        ("count", "40"),
        ("duration", "1.1s"),
        ("output-interval", "0.5s"),
    ];
    let mut scene = scene("small-drum", &values);
    if let SceneContainer::Drum { speed, .. } = &mut scene.container {
        *speed = 5.0;
    }
    scene
}

/// A row as `flow.csv` has it.
fn row(d: &FlowDepth) -> String {
    let error = d.error.unwrap_or(f64::NAN);
    format!("{:?},{:?},{},{error:?}\n", d.depth, d.velocity, d.samples)
}

#[test]
fn the_mean_flow_of_a_recording_is_that_of_its_run_or_none() {
    let (_folder, out) = recorded(&flowing(), Vec::new());
    let path = out.join("flow.csv");
    let written = fs::read_to_string(&path).unwrap();
    let (heads, body) = written.split_once('\n').unwrap();
    let lab = playing(&out);
    let flow = lab.mean_flow();
    assert!(flow.depths.iter().any(|depth| depth.samples > 0));
    // Every digit of the file.
    assert_eq!(flow.depths.iter().map(row).collect::<String>(), body);
    assert_eq!(lab.recorded_flow().unwrap().read, None);
    for rows in [
        "0.0,1e9,3,NaN",
        "0.0,NaN,3,NaN",
        "-1.0,0.1,3,NaN",
        "0.0,0.1,3,-1.0",
        "0.1,0.1,3,NaN\n0.1,0.1,3,NaN",
        "0.0,0.1",
    ] {
        fs::write(&path, format!("{heads}\n{rows}\n")).unwrap();
        let recording = Recording::open(&out).unwrap();
        assert!(recording.flow().is_none(), "{rows}");
        let said = recording.notes().join("; ");
        assert!(said.contains("flow.csv"), "{said}");
    }
}

#[test]
fn the_mean_flow_of_an_import_is_measured_on_its_states() {
    let folder = tempfile::tempdir().unwrap();
    let scene = flowing();
    let dump = folder.path().join("a.dump");
    // As if its second instant came after more than a second.
    let later = dump_of(&scene).replace("TIMESTEP\n200\n", "TIMESTEP\n80000\n");
    fs::write(&dump, later).unwrap();
    let out = folder.path().join("imported");
    let source = ImportSource::of_scene("drum", scene, Vec::new());
    import(&[dump], &source, &out, false, &mut ()).unwrap();
    let written = playing(&out).mean_flow();
    assert!(!written.depths.is_empty());
    fs::remove_file(out.join("flow.csv")).unwrap();
    let mut lab = playing(&out);
    assert!(lab.recorded_flow().is_none() && lab.mean_flow().depths.is_empty());
    send(&mut lab, LabCommand::MeasureFlow);
    for _ in 0..3 {
        lab.tick(Duration::ZERO);
    }
    assert_eq!(lab.recorded_flow().unwrap().read, Some(2));
    let measured = lab.mean_flow();
    assert_eq!(measured.depths.len(), written.depths.len());
    let speeds = written.depths.iter().map(|d| d.velocity.abs());
    let fastest = speeds.fold(0.0, f64::max);
    for (own, expected) in measured.depths.iter().zip(&written.depths) {
        assert_eq!(own.samples, expected.samples);
        // Places and velocities have the 24 bits of the states' files.
        let apart = (own.velocity - expected.velocity).abs();
        assert!(own.samples == 0 || apart < 1e-5 * fastest, "{apart:e}");
    }
}
