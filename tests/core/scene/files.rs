//! Good files are read; each bad one is refused with the message that stands in it.

use grainfall::physics::{BridgeLaw, ContactLaw, LiquidCase};
use grainfall::scene::{Scene, SceneContainer, SceneGrains, TimeStep, built_in};
use std::fs;
use std::path::{Path, PathBuf};

fn files_below(folder: &str) -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut folders = vec![root];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "ron") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

#[test]
fn good_files_are_read() {
    let files = files_below("tests/core/scene/good");
    assert!(files.len() >= 3);
    for file in files {
        Scene::load(&file).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn each_bad_file_is_refused_with_its_message() {
    let files = files_below("tests/core/scene/bad");
    assert!(files.len() >= 80);
    let mut wrong = Vec::new();
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let expected: Vec<&str> = text
            .lines()
            .filter_map(|line| line.strip_prefix("// expect: "))
            .collect();
        assert!(!expected.is_empty(), "{} expects nothing", file.display());
        match Scene::load(&file) {
            Ok(_) => wrong.push(format!("{} was read", file.display())),
            Err(error) => {
                let message = error.to_string();
                let name = file.display().to_string();
                let missing = |part: &&&str| !message.contains(**part);
                for part in expected.iter().chain([&name.as_str()]).filter(missing) {
                    wrong.push(format!("«{part}» is missing in: {message}"));
                }
                if error.line().is_none() {
                    wrong.push(format!("no line in: {message}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_number_that_is_none_is_refused_at_its_own_line_and_key() {
    let text = r#"(
        title: "Each number on a line of its own",
        materials: {
            "glass": (
                youngs_modulus: 63e6,
                poisson_ratio: 0.21,
                density: 2500,
                restitution: 0.95,
                friction: 0.4,
                rolling_friction: 0.01,
            ),
            "drum": (),
        },
        pairs: [(
            between: ("glass", "drum"),
            restitution: 0.7,
            friction: 0.3,
            rolling_friction: 0.02,
        )],
        container: Drum(
            radius_mm: 60.5,
            width_mm: 22,
            speed_rpm: 0.5,
            material: "drum",
        ),
        grains: Fill(
            bulk_fraction: 0.35,
            packing: 0.6,
            species: [(
                radius_mm: 3,
                share: 1,
                material: "glass",
            )],
        ),
        law: Hooke(
            normal_stiffness: 4000,
            tangential_stiffness: 2000,
        ),
        duration: 50,
        output_interval: 0.1,
    )"#;
    assert!(Scene::parse("sound", text).is_ok());
    let lines: Vec<&str> = text.lines().collect();
    let mut tried = 0;
    for (index, line) in lines.iter().enumerate() {
        let Some((key, value)) = line.trim().trim_end_matches(',').split_once(": ") else {
            continue;
        };
        if value.parse::<f64>().is_err() {
            continue;
        }
        for wrong in ["NaN", "-inf", "-1e300"] {
            let mut changed = lines.clone();
            let replaced = line.replace(value, wrong);
            changed[index] = &replaced;
            let error = Scene::parse("wrong", &changed.join("\n")).unwrap_err();
            assert_eq!(error.file(), "wrong");
            assert_eq!(error.line(), Some(index + 1), "{error}");
            assert!(
                error.key().is_some_and(|path| path.ends_with(key)),
                "{error}"
            );
            assert_eq!(error.value(), Some(wrong), "{error}");
            assert!(!error.expected().is_empty(), "{error}");
        }
        tried += 1;
    }
    assert_eq!(tried, 20);
}

#[test]
fn the_example_in_the_documentation_is_read() {
    let documentation = include_str!("../../../scenes/README.md");
    let (_, rest) = documentation.split_once("```ron").unwrap();
    let (example, _) = rest.split_once("```").unwrap();
    let scene = Scene::parse("example", example).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.materials.len(), 3);
}

#[test]
fn every_shipped_scene_is_built_in_and_sound() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut shipped: Vec<PathBuf> = files_below("scenes");
    // Lessons and what they bring have a list and tests of their own; what has a file beside it is no
    // single text that the program could hold.
    shipped.retain(|path| !path.starts_with(root.join("scenes/lessons")));
    shipped.retain(|path| !path.starts_with(root.join("scenes/meshes")));
    let mut known: Vec<PathBuf> = built_in().iter().map(|s| root.join(s.path)).collect();
    known.sort();
    assert_eq!(shipped, known);
    for scene in built_in() {
        let parsed = Scene::parse(scene.path, scene.text).unwrap_or_else(|e| panic!("{e}"));
        assert!(!parsed.look_for.is_empty(), "{}", scene.path);
        assert!(!parsed.source.is_empty(), "{}", scene.path);
        assert_eq!(Scene::open(scene.name), Ok(parsed));
    }
}

#[test]
fn the_paper_drums_hold_the_paper_number_of_grains() {
    for (name, wanted, radius_mm) in [
        ("dry-r3", 470, 3.0),
        ("dry-r2", 1585, 2.0),
        ("dry-r1.25", 6494, 1.25),
    ] {
        let scene = Scene::open(name).unwrap();
        let SceneGrains::Fill { count, species, .. } = &scene.grains else {
            panic!("{name} lists its grains");
        };
        assert_eq!(*count, wanted);
        assert_eq!(species[0].radius, radius_mm / 1000.0);
        let SceneContainer::Drum {
            radius,
            width,
            speed,
            ..
        } = scene.container
        else {
            panic!("{name} is no drum");
        };
        assert_eq!((radius, width), (0.0605, 0.022));
        // 0.5 rpm is 3 degrees a second; both are rounded once or twice.
        assert!((speed.to_degrees() - 3.0).abs() < 1e-14);
    }
}

#[test]
fn what_is_left_out_is_the_papers() {
    let smallest = Scene::load("tests/core/scene/good/smallest.ron").unwrap();
    let paper = Scene::open("dry-r3").unwrap();
    assert_eq!(smallest.materials[0], paper.materials[0]);
    assert_eq!(smallest.gravity, paper.gravity);
    assert_eq!(smallest.law, ContactLaw::HertzMindlin);
    assert_eq!(smallest.time_step, TimeStep::Automatic);
    assert_eq!(
        (smallest.duration, smallest.seed),
        (paper.duration, paper.seed)
    );
    let SceneGrains::Fill { count, .. } = smallest.grains else {
        panic!("not filled");
    };
    assert_eq!(count, 470);
}

#[test]
fn materials_keep_the_order_of_the_file() {
    let scene = Scene::load("tests/core/scene/good/every-key.ron").unwrap();
    let names: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["größer-1", "wall_2"]);
}

#[test]
fn unreadable_files_are_refused_in_plain_words() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&str, &[u8], &str); 3] = [
        ("empty.ron", b" \n", "the file is empty"),
        (
            "latin.ron",
            b"(\n  title: \"gr\xf6\xdfer\",\n)",
            "line 2: is not UTF-8 text",
        ),
        ("binary.ron", &[0, 159, 146, 150], "is not UTF-8 text"),
    ];
    for (name, bytes, expected) in cases {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let message = Scene::load(&path).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
        assert!(message.contains(name), "{message}");
    }
    let message = Scene::load(folder.path()).unwrap_err().to_string();
    assert!(message.contains("this is a folder"), "{message}");
    let message = Scene::load(folder.path().join("none.ron"))
        .unwrap_err()
        .to_string();
    assert!(message.contains("cannot be read"), "{message}");
}

#[test]
fn a_file_too_large_for_a_scene_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.ron");
    // A hole takes no room on the disk.
    fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
    let message = Scene::load(&path).unwrap_err().to_string();
    assert!(message.contains("larger than 64 MiB"), "{message}");
}

#[test]
fn a_name_that_nobody_knows_is_answered_with_those_that_exist() {
    let message = Scene::open("dry-r33").unwrap_err().to_string();
    assert!(message.contains("there is no such file"), "{message}");
    assert!(message.contains("Did you mean `dry-r3`?"), "{message}");
    assert!(message.contains("`small-drum`"), "{message}");
}

#[test]
fn values_can_be_replaced_before_a_run() {
    let mut scene = Scene::open("small-drum").unwrap();
    for (key, text) in [
        ("seed", "7"),
        ("duration", "250ms"),
        ("output-interval", "0.01"),
        ("time-step", "10us"),
        ("count", "50"),
    ] {
        scene
            .set(key, text)
            .unwrap_or_else(|error| panic!("{error}"));
    }
    assert_eq!(
        (scene.seed, scene.duration, scene.output_interval),
        (7, 0.25, 0.01)
    );
    assert_eq!(scene.time_step, TimeStep::Given(1e-5));
    assert!(matches!(scene.grains, SceneGrains::Fill { count: 50, .. }));
    assert_eq!(Scene::settings().count(), 32);
}

#[test]
fn one_scene_makes_every_case_of_the_paper() {
    for (radius, count) in [("3mm", 470), ("2mm", 1585), ("1.25mm", 6494)] {
        for case in 0..=7_u8 {
            let mut scene = Scene::open("wet").unwrap();
            scene.set("liquid", &case.to_string()).unwrap();
            scene.set("radius", radius).unwrap();
            let SceneGrains::Fill { count: found, .. } = scene.grains else {
                panic!("the drum is filled");
            };
            assert_eq!(found, count);
            let viscosity = scene.liquid.map(|liquid| liquid.viscosity);
            assert_eq!(viscosity, LiquidCase::of(case).map(|case| case.viscosity));
        }
    }
}

#[test]
fn dry_case_of_the_wet_drum_is_the_dry_drum() {
    let mut wet = Scene::open("wet").unwrap();
    wet.set("liquid", "dry").unwrap();
    let dry = Scene::open("dry-r3").unwrap();
    assert_eq!(wet.grains, dry.grains);
    assert_eq!(wet.container, dry.container);
    assert_eq!(wet.liquid, None);
}

#[test]
fn another_liquid_keeps_its_volume_and_its_bridge_law() {
    let mut scene = Scene::open("wet").unwrap();
    scene.liquid.as_mut().unwrap().volume = 2e-6;
    scene.set("bridge-law", "as-coded").unwrap();
    scene.set("liquid", "7").unwrap();
    let liquid = scene.liquid.unwrap();
    assert_eq!((liquid.volume, liquid.viscosity), (2e-6, 1.41));
    assert_eq!(liquid.law, BridgeLaw::AS_CODED);
}

#[test]
fn impossible_replacements_are_refused_and_change_nothing() {
    let original = Scene::open("small-drum").unwrap();
    let mut scene = original.clone();
    for (key, text, expected) in [
        ("seeds", "7", "Did you mean `seed`?"),
        ("duration", "soon", "expected a time such as `10s`"),
        ("duration", "0", "above 0 s"),
        ("count", "1e3", "a whole number"),
        ("count", "5000", "do not fit"),
        ("time-step", "-1", "`Automatic`"),
        ("output-interval", "1ns", "a time such as"),
        ("radius", "big", "a length such as `2mm`"),
        ("radius", "-1mm", "a length such as `2mm`"),
        ("liquid", "8", "1 (water) to 7 (glycerol)"),
        ("bridge-law", "as-coded", "in a scene with a liquid"),
    ] {
        let message = scene.set(key, text).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
        assert!(message.contains(&format!("{key}={text}")), "{message}");
        assert_eq!(scene, original);
    }
}
