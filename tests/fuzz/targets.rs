//! What is fed with mutated input, each made from a corpus of good ones: the shipped scenes, those
//! of the tests, and files that runs of small scenes leave.

use super::{byte_mutator, mutator};
use grainfall::engines::sound_scene_from;
use grainfall::lesson::{Lesson, LessonUnderWay, built_in_lessons};
use grainfall::measure::sample;
use grainfall::output::{EVENTS, FLOW, events_table, flow_table};
use grainfall::parameters::Settings;
use grainfall::recording::Recording;
use grainfall::run::{
    BedStore, Checkpoint, Command, Estimate, Parameter, Preparation, Prepared, Run, RunRecord,
    Session, Timeline,
};
use grainfall::runner::{Job, compared_value, read_commands, run};
use grainfall::scene::{Scene, SceneGrains, StoredCells, built_in};
use grainfall::solver::{Solver, advise};
use grainfall::sweep::Variation;
use grainfall::world::{self, Packing};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use tempfile::TempDir;

/// Grains with which a scene is also built and stepped.
const FEW_GRAINS: usize = 300;

/// Something that takes any input.
pub trait Target {
    /// Makes an input of random numbers and takes it; says whether it was accepted.
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool;
}

/// A folder in memory where the system has such a place.
pub struct Place {
    folder: TempDir,
}

impl Place {
    pub fn new() -> Self {
        let in_memory = Path::new("/dev/shm");
        let folder = if in_memory.is_dir() {
            tempfile::tempdir_in(in_memory)
        } else {
            tempfile::tempdir()
        };
        Self {
            folder: folder.expect("a folder can be made"),
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).expect("a file can be written");
        path
    }
}

pub fn one_of<'a, T>(list: &'a [T], rng: &mut ChaCha8Rng) -> &'a T {
    &list[rng.random_range(0..list.len())]
}

/// Every scene there is, sound and unsound.
fn corpus() -> Vec<String> {
    let mut texts: Vec<String> = built_in()
        .iter()
        .map(|scene| scene.text.to_owned())
        .collect();
    for folder in ["tests/core/scene/good", "tests/core/scene/bad"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let files = fs::read_dir(folder).expect("the tests' scenes are there");
        let mut files: Vec<PathBuf> = files.map(|file| file.expect("a file").path()).collect();
        files.sort();
        // Some are no text at all.
        texts.extend(
            files
                .iter()
                .filter_map(|file| fs::read_to_string(file).ok()),
        );
    }
    texts.retain(|text| text.len() < 20_000);
    texts
}

fn scene(name: &str, settings: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::open(name).expect("it is built in");
    for (key, value) in settings {
        scene.set(key, value).expect("it can be set");
    }
    scene
}

/// Scenes whose runs leave small files: a wet drum, a column of polyhedra, two listed grains.
fn small_scenes() -> Vec<Scene> {
    let mut drum = scene("small-drum", &[("count", "40"), ("radius", "4mm")]);
    drum.liquid = Scene::open("water-drum").expect("it is built in").liquid;
    vec![
        drum,
        scene("small-column", &[("radius", "8mm"), ("height", "8mm")]),
        scene("two-grains", &[]),
    ]
}

/// A run of `scene` after a few steps and a change.
fn short_run(scene: &Scene, beds: &BedStore) -> Run {
    let scene = Arc::new(scene.clone());
    let step = advise(&scene).time_step;
    let mut preparation = Preparation::new(scene, step, 1, beds.clone());
    let mut run = loop {
        if let Prepared::Ready(run) = preparation.advance().expect("it settles") {
            break *run;
        }
    };
    run.advance_to(400).expect("it runs");
    let command = Command::Set {
        parameter: Parameter::Gravity,
        value: 5.0.into(),
    };
    run.apply(command).expect("every scene has gravity");
    run.advance_to(1000).expect("it runs");
    run
}

/// A fault is a fair end of an odd run.
fn step_on(run: &mut Run) {
    let step = run.world().clock.step;
    let _ = run.advance_to(step.saturating_add(3));
    let _ = run.advice();
}

/// Texts of scenes, and now and then one that is none at all.
pub struct SceneTexts(Vec<String>);

impl SceneTexts {
    pub fn new() -> Self {
        Self(corpus())
    }
}

impl Target for SceneTexts {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let is_noise = rng.random_range(0..20) == 0;
        let text = if is_noise {
            mutator::noise(rng)
        } else {
            mutator::text(one_of::<String>(&self.0, rng), rng)
        };
        match Scene::parse("mutated.ron", &text) {
            Ok(scene) => {
                assert!(!is_noise, "{text}");
                let estimate = Estimate::of(&scene);
                assert!(!estimate.to_string().is_empty());
                if rng.random_range(0..20) == 0 {
                    built(&scene);
                }
                true
            }
            Err(error) => {
                let message = error.to_string();
                assert!(message.contains("mutated.ron"), "{message}");
                assert!(message.len() < 12_000, "{} bytes", message.len());
                false
            }
        }
    }
}

/// Texts of lessons, each checked with a scene where it can be read.
pub struct LessonTexts(Scene);

impl LessonTexts {
    pub fn new() -> Self {
        Self(scene("small-drum", &[]))
    }
}

impl Target for LessonTexts {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let text = mutator::text(one_of(built_in_lessons(), rng).text, rng);
        let lesson = Lesson::parse("mutated.ron", &text);
        let checked = lesson.and_then(|lesson| {
            let words = LessonUnderWay::new(lesson.clone()).in_words();
            let _ = LessonUnderWay::read(&mutator::text(&words, rng), &self.0);
            lesson.check_in(&self.0)
        });
        let Err(error) = checked else {
            return true;
        };
        let message = error.to_string();
        assert!(message.contains("mutated.ron"), "{message}");
        assert!(message.len() < 12_000, "{} bytes", message.len());
        false
    }
}

/// Whether it is little work to build `scene`.
fn is_small(scene: &Scene) -> bool {
    let points = match &scene.grains {
        SceneGrains::Voronoi(cells) => cells.lattice_size(&scene.container) as usize,
        _ => 0,
    };
    scene.grain_count() <= FEW_GRAINS && points <= 2 * FEW_GRAINS
}

/// Builds `scene` and takes two steps, where that is little work.
fn built(scene: &Scene) {
    if !is_small(scene) {
        return;
    }
    let mut world = world::build(scene, advise(scene).time_step);
    if let Err(error) = world.check() {
        panic!("a scene that was accepted makes a world that is not: {error}");
    }
    // How many cells lie in a drum or in a column is known when they are made.
    if !matches!(scene.grains, SceneGrains::Voronoi(_)) {
        assert_eq!(world.grains.len(), scene.grain_count());
    }
    let _ = Solver::new(1).advance(&mut world, 2);
}

/// `--set` and `--compare`.
pub struct SettingsOfScenes {
    scenes: Vec<Scene>,
    settings: Vec<String>,
}

impl SettingsOfScenes {
    pub fn new() -> Self {
        let scenes: Vec<Scene> = built_in()
            .iter()
            .map(|scene| Scene::parse(scene.path, scene.text).expect("it is shipped"))
            .collect();
        Self {
            settings: some_settings(&scenes),
            scenes,
        }
    }
}

/// Every setting of these scenes with the value that it has.
fn some_settings(scenes: &[Scene]) -> Vec<String> {
    let mut all = vec!["liquid=4".to_owned(), "drum-speed=1rpm".to_owned()];
    for scene in scenes {
        let list = serde_json::to_value(Settings::of(scene).list()).unwrap_or_default();
        for setting in list.as_array().into_iter().flatten() {
            let key = setting["key"].as_str().unwrap_or("seed");
            all.push(format!("{key}={}", setting["value"]));
        }
    }
    all.sort();
    all.dedup();
    all
}

impl Target for SettingsOfScenes {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let mut scene = one_of(&self.scenes, rng).clone();
        let mut setting = one_of(&self.settings, rng).clone();
        if rng.random_range(0..4) > 0 {
            setting = mutator::text(&setting, rng);
        }
        let _ = compared_value(&setting);
        let (key, value) = setting.split_once('=').unwrap_or((&setting, ""));
        let accepted = match scene.set(key, value) {
            Ok(()) => true,
            Err(error) => {
                assert!(error.to_string().len() < 12_000 + 4 * setting.len());
                false
            }
        };
        assert!(scene.check().is_ok(), "{setting}");
        accepted
    }
}

/// `--vary`.
pub struct Variations(Vec<String>);

impl Variations {
    pub fn new() -> Self {
        let texts = [
            "liquid=0..7",
            "radius=3mm,2mm,1.25mm",
            "seed=1..100",
            "seed=5",
        ];
        Self(texts.map(str::to_owned).to_vec())
    }
}

impl Target for Variations {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        Variation::parse(&mutator::text(one_of::<String>(&self.0, rng), rng)).is_ok()
    }
}

/// `--commands`.
pub struct CommandFiles {
    place: Place,
    texts: Vec<(&'static str, String)>,
}

impl CommandFiles {
    pub fn new() -> Self {
        let list = "[(time: 2.5, command: Set(parameter: \"drum-speed\", value: 0.1)), (step: 7, \
                    command: Set(parameter: \"friction.glass.drum\", value: 0.2)), (step: 0, command: Play)]";
        let json = r#"{"commands": [{"step": 3, "time": 0.1, "command": {"Set": {"parameter": "gravity",
                      "value": 3.0}}}, {"step": 9, "command": {"Set": {"parameter": "bridge-law", "value": "as-coded"}}}]}"#;
        Self {
            place: Place::new(),
            texts: vec![
                ("list.ron", list.to_owned()),
                ("list.json", json.to_owned()),
            ],
        }
    }
}

impl Target for CommandFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let (name, text) = one_of(&self.texts, rng);
        let path = self.place.write(name, mutator::text(text, rng));
        read_commands(&path).is_ok()
    }
}

/// Sessions, with the checksum that their contents have. What is accepted is gone on with.
pub struct SessionFiles {
    place: Place,
    wholes: Vec<Vec<u8>>,
}

impl SessionFiles {
    pub fn new() -> Self {
        let place = Place::new();
        let mut wholes = Vec::new();
        for scene in small_scenes() {
            let run = short_run(&scene, &BedStore::none());
            let mut timeline = Timeline::new(run, 1 << 24);
            timeline.seek(700);
            while timeline.destination().is_some() {
                let step = timeline.run().world().clock.step;
                timeline.advance_to(step + 100).expect("it runs");
            }
            let path = place.path("good.grainfall");
            (Session::of("a session", &timeline).write(&path)).expect("it can be written");
            wholes.push(fs::read(&path).expect("it was written"));
        }
        Self { place, wholes }
    }
}

/// The index behind the first line.
fn body(bytes: &[u8]) -> usize {
    1 + bytes.iter().position(|byte| *byte == b'\n').unwrap_or(0)
}

impl Target for SessionFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let whole = one_of(&self.wholes, rng);
        let start = body(whole);
        let second = start + body(&whole[start..]);
        let mut contents = whole[start..second].to_vec();
        match rng.random_range(0..16) {
            // One in a few is left as it is.
            0 => contents.extend(&whole[second..]),
            1 => {
                contents = byte_mutator::bytes(&contents, rng);
                contents.extend(&whole[second..]);
            }
            _ => contents.extend(byte_mutator::bytes(&whole[second..], rng)),
        }
        let head = String::from_utf8_lossy(&whole[..start]);
        let head: Vec<&str> = head.split_whitespace().collect();
        let head = format!(
            "{} {}\n",
            head[..head.len() - 1].join(" "),
            blake3::hash(&contents).to_hex()
        );
        let path = self
            .place
            .write("a.grainfall", [head.as_bytes(), &contents].concat());
        let Ok(session) = Session::read(&path) else {
            return false;
        };
        let mut timeline = session.into_timeline(1, 1 << 24);
        let step = timeline.run().world().clock.step;
        let _ = timeline.advance_to(step.saturating_add(3));
        timeline.undo();
        let _ = timeline.past();
        true
    }
}

/// Kept beds, with the checksum that their contents have.
pub struct BedFiles {
    place: Place,
    scene: Scene,
    name: String,
    whole: Vec<u8>,
}

/// Bytes of a bed's file before its checksum, and of that.
const BED_HEAD: usize = 12 + 4 + 32;
const CHECKSUM: usize = 32;

impl BedFiles {
    pub fn new() -> Self {
        let place = Place::new();
        let scene = small_scenes().swap_remove(0);
        short_run(&scene, &BedStore::at(place.folder.path()));
        let file = fs::read_dir(place.folder.path())
            .expect("there is a bed")
            .next();
        let path = file.expect("there is a bed").expect("it has a name").path();
        let name = path.file_name().expect("it has a name");
        Self {
            whole: fs::read(&path).expect("it can be read"),
            name: name.to_string_lossy().into_owned(),
            place,
            scene,
        }
    }
}

/// The bytes of a file with this much before the checksum, its contents mutated.
fn with_checksum(whole: &[u8], head: usize, rng: &mut ChaCha8Rng) -> Vec<u8> {
    let contents = &whole[head + CHECKSUM..];
    let contents = if rng.random_range(0..16) == 0 {
        contents.to_vec()
    } else {
        byte_mutator::bytes(contents, rng)
    };
    [
        &whole[..head],
        blake3::hash(&contents).as_bytes(),
        &contents,
    ]
    .concat()
}

impl Target for BedFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        self.place
            .write(&self.name, with_checksum(&self.whole, BED_HEAD, rng));
        let scene = Arc::new(self.scene.clone());
        let step = advise(&scene).time_step;
        let beds = BedStore::at(self.place.folder.path());
        let mut preparation = Preparation::new(scene, step, 1, beds);
        // Without its bed it would begin to settle.
        let Ok(Prepared::Ready(mut run)) = preparation.advance() else {
            return false;
        };
        step_on(&mut run);
        true
    }
}

/// Packings, with the checksum that their contents have, and scenes of them.
pub struct PackingFiles {
    place: Place,
    whole: Vec<u8>,
    scene: PathBuf,
}

const PACKING_HEAD: usize = 12 + 4;

impl PackingFiles {
    pub fn new() -> Self {
        let place = Place::new();
        let small = small_scenes().swap_remove(1);
        let grains = Packing::new(&small).expect("it has cells").finish();
        let text = "(title: \"a packing\", materials: {\"stone\": (), \"floor\": ()}, \
                    container: Column(radius_mm: 8, height_mm: 8, material: \"floor\"), \
                    grains: Voronoi(packing: \"cells.pack\", species: [(material: \"stone\")]))";
        Self {
            scene: place.write("scene.ron", text),
            whole: StoredCells::encode(&grains).expect("they can be written"),
            place,
        }
    }
}

impl Target for PackingFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let bytes = with_checksum(&self.whole, PACKING_HEAD, rng);
        self.place.write("cells.pack", bytes);
        let Ok(scene) = Scene::load(&self.scene) else {
            return false;
        };
        built(&scene);
        true
    }
}

/// Checkpoints, behind their checksum.
pub struct Checkpoints(Vec<(Arc<Scene>, Arc<world::World>, Vec<u8>)>);

impl Checkpoints {
    pub fn new() -> Self {
        let kept = |scene: Scene| {
            let run = short_run(&scene, &BedStore::none());
            let bytes = postcard::to_stdvec(&run.checkpoint()).expect("it can be written");
            (Arc::new(scene), run.bed().clone(), bytes)
        };
        Self(small_scenes().into_iter().map(kept).collect())
    }
}

impl Target for Checkpoints {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let (scene, bed, bytes) = one_of(&self.0, rng);
        let Ok(checkpoint) = postcard::from_bytes::<Checkpoint>(&byte_mutator::bytes(bytes, rng))
        else {
            return false;
        };
        if checkpoint.check(scene).is_err() {
            return false;
        }
        let mut run = Run::new(scene.clone(), bed.clone(), 1);
        run.resume(checkpoint);
        step_on(&mut run);
        true
    }
}

/// Records with the fingerprint that they have, computed again for as long as that takes little.
pub struct RecordFiles {
    place: Place,
    records: Vec<serde_json::Value>,
}

impl RecordFiles {
    pub fn new() -> Self {
        let record = |scene: Scene| {
            let run = short_run(&scene, &BedStore::none());
            let record = RunRecord::of("a record", &scene, run.commands(), run.world());
            serde_json::to_value(record).expect("it can be written")
        };
        Self {
            place: Place::new(),
            records: small_scenes().into_iter().map(record).collect(),
        }
    }
}

impl Target for RecordFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let mut value = one_of(&self.records, rng).clone();
        for _ in 0..rng.random_range(0..=2) {
            mutator::json(&mut value, rng);
        }
        // What is a record at all gets the fingerprint that it has.
        let sealed = serde_json::from_value::<RunRecord>(value.clone()).map(RunRecord::sealed);
        let text = sealed.map_or(value.to_string(), |record| {
            serde_json::to_string(&record).expect("it can be written")
        });
        let path = self.place.write("summary.json", text);
        let Ok(record) = RunRecord::read(&path) else {
            return false;
        };
        if is_small(&record.scene) {
            let looks = AtomicU32::new(0);
            let stop = || looks.fetch_add(1, Ordering::Relaxed) >= 2;
            let _ = record.verify(1, BedStore::none(), &mut (), &stop);
        }
        true
    }
}

/// Files of recordings, one of them mutated.
pub struct Recordings {
    place: Place,
    /// Name and bytes of each file of each folder.
    folders: Vec<Vec<(PathBuf, Vec<u8>)>>,
}

impl Recordings {
    pub fn new() -> Self {
        let place = Place::new();
        let mut scenes = small_scenes();
        scenes.truncate(2);
        let folder = |(index, mut scene): (usize, Scene)| {
            let times = [("duration", "4ms"), ("output-interval", "2ms")];
            scene.set_all(&times).expect("they can be set");
            let out = place.path(&index.to_string());
            let job = Job {
                threads: 1,
                beds: BedStore::none(),
                ..Job::new("a recording", scene, &out)
            };
            run(&job, &mut (), &|| false).expect("it runs");
            // What a longer run of a bed that flows would write.
            let heads = flow_table().heads().join(",");
            let flow = format!("{heads}\n0.0,0.25,40,0.01\n0.001,0.2,39,NaN\n0.002,NaN,0,NaN\n");
            fs::write(out.join(FLOW), flow).expect("it can be written");
            let heads = events_table().heads().join(",");
            let events = "0.001,impact,0,1,0.2,,,,,,\n0.001,bridge forms,0,1,,,,,,,\n0.002,parting,0,1,,0.001,,,,,\n\
                          0.003,avalanche begins,,,,,0.5,0.1,,,\n0.003,change,,,,,,,,gravity,5.0\n";
            fs::write(out.join(EVENTS), format!("{heads}\n{events}")).expect("it can be written");
            let names = [
                "summary.json",
                "series.csv",
                FLOW,
                EVENTS,
                "grains.pvd",
                "contacts.pvd",
                "shapes.vtu",
                "grains/grains_000000.vtp",
                "grains/grains_000001.vtp",
                "contacts/contacts_000001.vtp",
            ];
            let files = names.iter().map(|name| out.join(name));
            let read = |path: PathBuf| Some((path.clone(), fs::read(&path).ok()?));
            files.filter_map(read).collect()
        };
        let folders = scenes.into_iter().enumerate().map(folder).collect();
        Self { place, folders }
    }
}

impl Target for Recordings {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let index = rng.random_range(0..self.folders.len());
        let (path, whole) = one_of(&self.folders[index], rng);
        let mutated = match std::str::from_utf8(whole) {
            Ok(text) if rng.random() => mutator::text(text, rng).into_bytes(),
            _ => byte_mutator::bytes(whole, rng),
        };
        fs::write(path, mutated).expect("it can be written");
        let accepted = is_shown(&self.place.path(&index.to_string()));
        fs::write(path, whole).expect("it can be written");
        accepted
    }
}

/// Whether the recording in `folder` opens, and all of its states are shown.
fn is_shown(folder: &Path) -> bool {
    let Ok(recording) = Recording::open(folder) else {
        return false;
    };
    let mut states = (0..recording.moments().len().min(4)).map(|index| recording.state(index));
    states.all(|state| {
        state.is_ok_and(|state| {
            let _ = sample(&state.world);
            if let Ok(scene) = sound_scene_from(recording.scene(), &state.world) {
                let _ = world::build(&scene, state.world.clock.time_step);
            }
            true
        })
    })
}
