//! Claims about lessons: what is read and refused, and that a run answers what they ask.

use grainfall::lab::{DriverKind, Lab, LabCommand, Options, Status};
use grainfall::lesson::{
    Change, Lesson, LessonCut, LessonUnderWay, Prediction, QuestionKind, Seen, Shown, Stage, Touch,
    built_in_lessons,
};
use grainfall::measure::{Estimate, Verdict};
use grainfall::parameters::Parameter;
use grainfall::run::{BedStore, Command};
use grainfall::scene::Scene;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Duration;

/// A lesson about two grains that need no settling: they fall on a floor and lie.
const SCENE: &str = r#"(
    title: "Two grains on a floor",
    materials: {"glass": (friction: 0.4, restitution: 0.5)},
    container: Box(min: (0, 0, 0), max: (0.1, 0.1, 0.1), material: "glass"),
    grains: List([
        (position: (0.03, 0.0131, 0.05), radius_mm: 3, material: "glass"),
        (position: (0.07, 0.0231, 0.05), radius_mm: 3, material: "glass"),
    ]),
    duration: 1,
    sample_interval: 0.002,
)"#;

/// The same lesson with other lines in the place of those of its second and third steps.
fn lesson(second: &str, third: &str) -> String {
    format!(
        r#"// What falls on the Moon?
Lesson(
    title: "Falling",
    about: "Where do things fall faster?",
    scene: "falling.ron",
    settings: {{"seed": "3"}},
    look: (colour_by: "speed", from: Front, show: [Velocities]),
    steps: [
        (title: "Look", text: "Press Play.", touch: ["play", "gravity"]),
        (
            title: "Here",
            text: "Two beads fall.",
            ask: Number(
                question: "How fast is the faster energy?",
                quantity: "kinetic energy",
                of: Largest,
                span: (0, 0.1),
                scatter: (deviation: 1e-6, runs: 8),
                tolerance: 2e-5,
            ),
            hints: ["one", "two"],
            {second}
        ),
        (
            title: "On the Moon",
            text: "Two beads fall on the Moon.",
            {third}
        ),
    ],
)"#
    )
}

const MOON: &str = r#"set: {"gravity": "1.62"},
            speed: 50,
            look: (show: [Forces, Flow, Temperature], cut: Quarter),
            ask: Change(
                question: "And there?",
                quantity: "kinetic energy",
                of: Largest,
                span: (0, 0.1),
                scatter: (deviation: 1e-6, runs: 8),
                than: "Here",
                same_within: 1e-6,
                expected: Lower,
            ),"#;

fn written(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("falling.ron"), SCENE).unwrap();
    let path = folder.path().join("lesson.ron");
    fs::write(&path, text).unwrap();
    let name = path.display().to_string();
    (folder, name)
}

fn refused(text: &str) -> String {
    let (_folder, name) = written(text);
    let error = Lesson::open(&name).err();
    error
        .unwrap_or_else(|| panic!("it was opened: {text}"))
        .to_string()
}

#[test]
fn a_lesson_is_told_from_a_scene_and_read_with_its_scene() {
    let (_folder, name) = written(&lesson("", MOON));
    assert!(Lesson::is_at(&name));
    let (lesson, scene) = Lesson::open(&name).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((lesson.steps.len(), scene.seed), (3, 3));
    assert_eq!(
        lesson.steps[0].touch,
        [Touch::Play, Touch::Parameter(Parameter::Gravity)]
    );
    let moon = lesson.steps[2].question.as_ref().unwrap();
    let QuestionKind::Change {
        than,
        same_within,
        expected,
    } = &moon.kind
    else {
        panic!("{moon:?}");
    };
    assert_eq!(
        (*than, *same_within, *expected),
        (1, 1e-6, Some(Change::Lower))
    );
    let look = lesson.steps[2].look.as_ref().unwrap();
    assert_eq!(look.show, [Shown::Forces, Shown::Flow, Shown::Temperature]);
    assert_eq!(look.cut, Some(LessonCut::Quarter));
    let beside = Path::new(&name).with_file_name("falling.ron");
    assert!(!Lesson::is_at(&beside.display().to_string()));
    assert!(!Lesson::is_at("/dev/zero") && !Lesson::is_at("small-drum"));
}

#[test]
fn what_is_wrong_in_a_lesson_is_told_with_line_key_and_what_belongs_there() {
    let cases = [
        (
            lesson("hint: [],", MOON),
            vec!["line 22", "`steps[1].hint` is not a key of", "`hints`"],
        ),
        (
            lesson("why: 3,", MOON),
            vec!["`steps[1].why` is 3", "text in double quotes"],
        ),
        (
            lesson("touch: [\"ply\"],", MOON),
            vec!["`steps[1].touch[0]`", "Did you mean `play`?"],
        ),
        (
            lesson("touch: [\"drum-speed\"],", MOON),
            vec!["`drum-speed`", "`gravity`"],
        ),
        (
            lesson("speed: 0,", MOON),
            vec!["`steps[1].speed` is 0", "between 0.001 and 100"],
        ),
        (
            lesson("", "set: {\"gravity\": \"1.62\"},"),
            vec!["steps[2].set", "asks nothing"],
        ),
        (
            lesson("", &MOON.replace("1.62", "1e9")),
            vec!["`steps[2].set.gravity`", "…"],
        ),
        (
            lesson("", &MOON.replace("1.62", "heavy")),
            vec!["steps[2].set", "a number"],
        ),
        (
            lesson("", &MOON.replace("\"Here\"", "\"Hre\"")),
            vec!["ask.than", "Did you mean `Here`?"],
        ),
    ];
    for (index, (text, parts)) in cases.iter().enumerate() {
        let message = refused(text);
        for part in parts {
            assert!(
                message.contains(part),
                "{index}: «{part}» is missing in {message}"
            );
        }
        assert!(message.contains("lesson.ron, line "), "{index}: {message}");
    }
}

#[test]
fn an_answer_that_cannot_be_is_refused() {
    let others = [
        (
            "\"kinetic energy\"",
            "\"kinetic enrgy\"",
            "Did you mean `kinetic energy`?",
        ),
        (
            "\"kinetic energy\"",
            "\"front radius\"",
            "without a meaning in this scene",
        ),
        (
            "span: (0, 0.1)",
            "span: (0.1, 0.1)",
            "the earlier one first",
        ),
        ("span: (0, 0.1)", "span: (0, 1e9)", "at most 600 s"),
        ("tolerance: 2e-5", "tolerance: 0", "a number above 0"),
        (
            "tolerance: 2e-5",
            "tolerance: 1, expected: (3, 2)",
            "the smaller one first",
        ),
        (
            "scatter: (deviation: 1e-6, runs: 8),",
            "",
            "no error of its own",
        ),
        ("runs: 8", "runs: 1", "between 2 and"),
        (
            "than: \"Here\"",
            "than: \"Look\"",
            "measures something else, or nothing",
        ),
        (
            "title: \"On the Moon\"",
            "title: \"Here\"",
            "that of an earlier step",
        ),
        (
            "scene: \"falling.ron\"",
            "scene: \"smal-drum\"",
            "Did you mean `small-drum`?",
        ),
        (
            "scene: \"falling.ron\"",
            "scene: \"rising.ron\"",
            "cannot be opened",
        ),
        (
            "scene: \"falling.ron\"",
            "scene: \"../falling.ron\"",
            "cannot be opened",
        ),
        (
            "\"seed\": \"3\"",
            "\"sed\": \"3\"",
            "`settings.sed` cannot be set",
        ),
        (
            "colour_by: \"speed\"",
            "colour_by: \"sped\"",
            "Did you mean `speed`?",
        ),
        ("from: Front", "from: Frnt", "Did you mean `Front`?"),
        ("cut: Quarter", "cut: Quater", "Did you mean `Quarter`?"),
        (
            "steps: [",
            "steps: [], other: [",
            "is not a key of a lesson",
        ),
    ];
    for (good, bad, part) in others {
        let message = refused(&lesson("", MOON).replace(good, bad));
        assert!(message.contains(part), "«{part}» is missing in {message}");
    }
    let empty = Lesson::parse(
        "x",
        "Lesson(title: \"t\", about: \"a\", scene: \"small-drum\", steps: [])",
    );
    assert!(empty.unwrap_err().to_string().contains("has 0 steps"));
    assert!(
        Lesson::parse("x", "  ")
            .unwrap_err()
            .to_string()
            .contains("the file is empty")
    );
}

#[cfg(unix)]
#[test]
fn a_lesson_opens_no_scene_outside_of_its_folder_and_reads_no_pipe() {
    let (folder, name) = written(&lesson("", MOON));
    let own = folder.path().join("falling.ron");
    let elsewhere = tempfile::tempdir().unwrap();
    let target = elsewhere.path().join("falling.ron");
    fs::rename(&own, &target).unwrap();
    std::os::unix::fs::symlink(&target, &own).unwrap();
    let message = Lesson::open(&name).unwrap_err().to_string();
    assert!(message.contains("lies elsewhere"), "{message}");
    let pipe = folder.path().join("pipe.ron");
    let made = std::process::Command::new("mkfifo")
        .arg(&pipe)
        .status()
        .unwrap();
    assert!(made.success());
    let pipe = pipe.display().to_string();
    assert!(!Lesson::is_at(&pipe));
    for path in [pipe.as_str(), "/dev/zero"] {
        let message = Lesson::open(path).unwrap_err().to_string();
        assert!(message.contains("only regular files are read"), "{message}");
    }
    let long = format!("{}{}", lesson("", MOON), " ".repeat(1 << 18));
    assert!(refused(&long).contains("larger than 256 kB"));
}

/// A lab of `scene` that a test moves.
fn lab(scene: Scene) -> Lab {
    let options = Options {
        driver: DriverKind::Inline,
        autoplay: false,
        beds: BedStore::none(),
        ..Options::headless()
    };
    let mut lab = Lab::open(scene, options);
    while matches!(lab.status(), Status::Preparing { .. }) {
        lab.tick(Duration::from_millis(16));
    }
    assert_eq!(*lab.status(), Status::Paused);
    lab
}

fn follow(lesson: &mut LessonUnderWay, lab: &mut Lab) {
    let seen = Seen {
        series: lab.series(),
        commands: lab.commands(),
        branch: lab.past().number,
        has_answered: lab.has_answered(),
    };
    if let Some(command) = lesson.follow(&seen) {
        lab.send(command);
    }
}

/// Plays the present step's experiment to its end, as fast as the machine can.
fn play(lesson: &mut LessonUnderWay, lab: &mut Lab) {
    let commands = {
        let value = |parameter: &Parameter| lab.value(parameter);
        lesson.play(lab.past().number, lab.parameters(), value)
    };
    assert!(!commands.is_empty(), "{:?}", lesson.stage());
    for command in commands {
        lab.send(command);
    }
    lab.send(Command::Speed(f64::INFINITY));
    for _ in 0..1_000_000 {
        follow(lesson, lab);
        if !matches!(lesson.stage(), Stage::Playing(_)) {
            return;
        }
        lab.tick(Duration::from_millis(16));
    }
    panic!("it does not end");
}

#[test]
fn an_experiment_is_played_from_the_start_with_its_own_values_and_answers() {
    let (_folder, name) = written(&lesson("", MOON));
    let (lesson, scene) = Lesson::open(&name).unwrap();
    let mut lab = lab(scene.clone());
    let mut lesson = LessonUnderWay::new(lesson);
    assert_eq!(lesson.stage(), Stage::Reading);
    lesson.go_back();
    lesson.go_on();
    lesson.go_on();
    assert_eq!(lesson.stage(), Stage::Waiting(1));
    lesson.go_back();
    assert_eq!(lesson.stage(), Stage::Asking);
    // What was changed before counts no more in an experiment.
    let (parameter, value) = (Parameter::Gravity, 4.0.into());
    lab.send(Command::Set { parameter, value });
    lab.send(LabCommand::All(Command::Step(100)));
    lesson.predict(Prediction::Change(Change::Same));
    lesson.predict(Prediction::Number(f64::NAN));
    assert_eq!(lesson.stage(), Stage::Asking);
    lesson.predict(Prediction::Number(1.0));
    play(&mut lesson, &mut lab);
    assert_eq!(lesson.stage(), Stage::Answered);
    // m g h: two beads fall 10.1 mm together, or one falls 20.1 mm and the other has bounced; all
    // that there is at most are 30.2 mm. Samples are 2 ms apart.
    let mass = 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.003_f64.powi(3);
    let measured = lesson.answer().measured.unwrap();
    assert!(measured.mean > mass * 9.81 * 0.018, "{measured:?}");
    assert!(measured.mean < mass * 9.81 * 0.0302, "{measured:?}");
    assert_eq!(lesson.judged().unwrap().verdict, Verdict::DoesNot);
    assert_eq!(lesson.hints(), ["one"], "the first hint comes by itself");
    lab.tick(Duration::from_millis(16));
    assert_eq!(*lab.status(), Status::Paused);

    lesson.go_on();
    lesson.predict(Prediction::Change(Change::Lower));
    play(&mut lesson, &mut lab);
    let judged = lesson.judged().unwrap();
    assert_eq!(
        (judged.verdict, judged.is_unexpected),
        (Verdict::Holds, false),
        "{judged:?}"
    );
    assert_eq!(lab.value(&Parameter::Gravity), Some(1.62.into()));

    // As a session keeps it, also where the file is gone.
    let words = lesson.in_words();
    assert_eq!(LessonUnderWay::read(&words, &scene), Some(lesson.clone()));
    let other = Scene::open("small-drum").unwrap();
    assert!(
        LessonUnderWay::read(&words, &other).is_some(),
        "it suits any scene of grains"
    );
    assert!(LessonUnderWay::read(&words.replace("gravity", "gravty"), &scene).is_none());
    assert!(LessonUnderWay::read("{}", &scene).is_none());
    let late = words.replace("\"step\":2", "\"step\":99");
    assert_eq!(LessonUnderWay::read(&late, &scene).unwrap().index(), 2);
    lesson.try_again();
    assert_eq!(lesson.stage(), Stage::Asking);
}

#[test]
fn an_experiment_that_somebody_changes_gives_no_answer() {
    let (_folder, name) = written(&lesson("", MOON));
    let (lesson, scene) = Lesson::open(&name).unwrap();
    let mut lab = lab(scene);
    let mut lesson = LessonUnderWay::new(lesson);
    lesson.go_on();
    for disturbance in ["value", "start"] {
        lesson.predict(Prediction::Number(1e-5));
        let value = |parameter: &Parameter| lab.value(parameter);
        let commands = lesson.play(lab.past().number, lab.parameters(), value);
        for command in commands {
            lab.send(command);
        }
        lab.send(LabCommand::All(Command::Pause));
        lab.send(LabCommand::All(Command::Step(100)));
        for _ in 0..100 {
            lab.tick(Duration::from_millis(16));
            follow(&mut lesson, &mut lab);
        }
        assert!(
            matches!(lesson.stage(), Stage::Playing(_)),
            "{:?}",
            lesson.stage()
        );
        match disturbance {
            "value" => {
                let (parameter, value) = (Parameter::Gravity, 4.0.into());
                lab.send(Command::Set { parameter, value });
            }
            _ => lab.send(Command::Reset),
        }
        for _ in 0..100 {
            lab.tick(Duration::from_millis(16));
            follow(&mut lesson, &mut lab);
        }
        assert_eq!(lesson.stage(), Stage::Predicted, "{disturbance}");
        assert!(lesson.spoilt().is_some(), "{disturbance}");
    }
}

#[test]
fn every_shipped_lesson_opens_by_name_and_by_path() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for own in built_in_lessons() {
        assert!(Lesson::is_at(own.name));
        let (by_name, scene) = Lesson::open(own.name).unwrap_or_else(|error| panic!("{error}"));
        let path = root.join(own.path).display().to_string();
        assert!(Lesson::is_at(&path));
        let (by_path, same) = Lesson::open(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((by_name.steps, scene), (by_path.steps, same));
        assert!(!by_name.source.is_empty() && !by_name.about.is_empty());
    }
    // The page that tells how to write one shows one that can be opened.
    let page = fs::read_to_string(root.join("docs/lessons.md")).unwrap();
    let (_, rest) = page.split_once("```ron").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    let lesson = Lesson::parse("example", example).unwrap_or_else(|error| panic!("{error}"));
    lesson
        .check_in(&Scene::open("small-drum").unwrap())
        .unwrap_or_else(|error| panic!("{error}"));
}

/// Each shipped lesson to its end, with three seeds or as many as `LESSON_SEEDS` says: what it claims
/// is what is measured. `cargo test --test core -- --ignored lesson --nocapture` shows the figures,
/// and how much they differ from seed to seed.
#[test]
#[ignore = "it takes a minute or more"]
fn what_the_shipped_lessons_claim_is_measured_with_every_seed() {
    let seeds = std::env::var("LESSON_SEEDS")
        .ok()
        .and_then(|text| text.parse().ok());
    let mut wrong = Vec::new();
    for own in built_in_lessons() {
        let mut measured = BTreeMap::<usize, Vec<f64>>::new();
        for seed in 1..=seeds.unwrap_or(3_u32) {
            let (lesson, mut scene) = Lesson::open(own.name).unwrap();
            scene.set("seed", &seed.to_string()).unwrap();
            let mut lab = lab(scene);
            let mut lesson = LessonUnderWay::new(lesson);
            for step in 0..lesson.lesson().steps.len() {
                lesson.show(step);
                let Some(told) = claimed(&mut lesson, &mut lab) else {
                    continue;
                };
                let told = format!("{} · seed {seed} · {told:?}", own.name);
                println!("{told}");
                if !told.contains("true") {
                    wrong.push(told);
                }
                measured
                    .entry(step)
                    .or_default()
                    .push(lesson.answer().measured.unwrap().mean);
            }
        }
        for (step, values) in measured {
            let all = Estimate::of_runs(&values);
            let deviation = all.error.map(|error| error * (values.len() as f64).sqrt());
            println!(
                "{} · step {step}: mean {} deviation {deviation:?}",
                own.name, all.mean
            );
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Plays the present step, where it asks something: whether what it claims is measured, and what is
/// told of it.
fn claimed(lesson: &mut LessonUnderWay, lab: &mut Lab) -> Option<(bool, String)> {
    let question = lesson.step().question.clone()?;
    let said = match question.kind {
        QuestionKind::Number { expected, .. } => {
            let (low, high) = expected.expect("a shipped lesson says what it expects");
            Prediction::Number(0.5 * (low + high))
        }
        QuestionKind::Change { expected, .. } => Prediction::Change(expected.expect("as above")),
    };
    lesson.predict(said);
    let started = std::time::Instant::now();
    play(lesson, lab);
    let wall = started.elapsed().as_secs_f64();
    let judged = lesson.judged()?;
    let is_number = matches!(said, Prediction::Number(_));
    let holds = (is_number || judged.verdict == Verdict::Holds) && !judged.is_unexpected;
    Some((
        holds,
        format!("{} ({wall:.1} s): {}", lesson.step().title, judged.text),
    ))
}
