//! Claims about the command line: how a scene is named, what is listed, slips, what shells get.

use crate::headless::{Place, text};
use grainfall::scene::built_in;
use std::io::Write;
use std::process::{Output, Stdio};

const GRAIN: &str = include_str!("../../../scenes/gallery/bouncing-grain.ron");

/// What comes of `arguments` with `input` on standard input.
fn fed(place: &Place, arguments: &[&str], input: &[u8]) -> Output {
    let mut command = place.command(arguments);
    command.stdin(Stdio::piped());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A program that refuses its arguments need not read.
    drop(child.stdin.take().unwrap().write_all(input));
    child.wait_with_output().unwrap()
}

#[test]
fn scene_on_standard_input_is_run_like_a_file() {
    let place = Place::new();
    let file = place.write("grain.ron", GRAIN);
    let run = |name: &str, out: &str| {
        let run = ["--no-render", "--duration", "20ms", "--json", "--out", out];
        let output = fed(&place, &[&[name], &run[..]].concat(), GRAIN.as_bytes());
        assert!(output.status.success(), "{}", text(&output.stderr));
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        summary["state_hash"].clone()
    };
    let (read, named) = (run("-", "read"), run(file.to_str().unwrap(), "named"));
    assert!(read.is_string());
    assert_eq!(read, named);
    // A mistake has its line; what is no text, or nothing, is said to be so.
    for (input, expected) in [
        (
            GRAIN.replace("title", "tite").as_bytes(),
            "standard input, line",
        ),
        (b"\xff\xfe", "is not UTF-8 text"),
        (b"", "the file is empty"),
    ] {
        let output = fed(&place, &["settings", "-"], input);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(expected), "{said}");
    }
}

#[test]
fn scenes_are_listed_and_each_name_opens() {
    let place = Place::new();
    let listed = text(&place.run(&["scenes"]).stdout);
    assert_eq!(listed.lines().count(), built_in().len());
    let listed = place.run(&["scenes", "--json"]).stdout;
    let listed: serde_json::Value = serde_json::from_slice(&listed).unwrap();
    for (row, scene) in listed.as_array().unwrap().iter().zip(built_in()) {
        assert_eq!(row["name"], scene.name);
        assert!(!row["title"].as_str().unwrap().is_empty());
    }
}

#[test]
fn steps_are_listed_with_what_they_cost_and_one_that_is_given_beside_them() {
    let place = Place::new();
    let asked = ["time-steps", "dry-r3", "--set", "time-step=40us", "--json"];
    let listed: serde_json::Value = serde_json::from_slice(&place.run(&asked).stdout).unwrap();
    assert_eq!(listed["limits"][0]["name"], "Rayleigh wave");
    let choices = listed["choices"].as_array().unwrap();
    let names: Vec<&str> = choices
        .iter()
        .filter_map(|row| row["name"].as_str())
        .collect();
    assert_eq!(names, ["reference", "standard", "fast", "given"]);
    let spread = |row: &serde_json::Value| {
        let end = |k: usize| row["impact"]["range"][k].as_f64().unwrap();
        end(1) - end(0)
    };
    assert!(choices[..3].iter().map(spread).is_sorted(), "{choices:?}");
    let measured = listed["measured"]["steps"].as_array().unwrap();
    let angle = &measured[0]["results"][0];
    assert_eq!(angle["result"], "surface angle");
    assert!((angle["mean"].as_f64().unwrap().to_degrees() - 33.0).abs() < 0.1);
    let said = text(&place.run(&["time-steps", "dry-r3"]).stdout);
    let longer = said.lines().find(|line| line.contains("30.00 µs"));
    assert!(
        longer.is_some_and(|line| line.ends_with("Tg by (4.2 ± 1.4)·10⁻⁶ m²/s²")),
        "{said}"
    );
    let said = text(&place.run(&["time-steps", "column"]).stdout);
    assert!(said.contains("dashpots of a polyhedron"), "{said}");
    assert!(said.contains("20.00 µs implicit  4"), "{said}");
    assert!(
        said.contains("reference") && said.contains("0.25"),
        "{said}"
    );
    let refused = place.run(&["time-steps", "column", "--set", "time-step=long"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = text(&refused.stderr);
    assert!(said.contains("`reference`, `fast`"), "{said}");
}

#[test]
fn a_folder_called_like_a_scene_does_not_hide_it() {
    let place = Place::new();
    std::fs::create_dir(place.path("wet")).unwrap();
    let output = place.run(&["settings", "wet"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn a_slip_in_a_command_is_answered_with_the_command() {
    let place = Place::new();
    for arguments in [&["swep", "wet", "--vary", "seed=1,2"][..], &["swep"]] {
        let output = place.run(arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("Did you mean `grainfall sweep`?"), "{said}");
    }
}

#[test]
fn shells_and_manuals_are_served() {
    let place = Place::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = text(&place.run(&["completions", shell]).stdout);
        assert!(
            script.contains("no-render") && script.contains("sweep"),
            "{shell}"
        );
    }
    assert!(place.run(&["man", "pages"]).status.success());
    for page in ["grainfall.1", "grainfall-sweep.1", "grainfall-export.1"] {
        let page = std::fs::read_to_string(place.path("pages").join(page)).unwrap();
        assert!(
            page.starts_with(".ie") && page.contains(".TH grainfall"),
            "{page:.60}"
        );
    }
}

#[test]
fn no_color_is_heeded() {
    let place = Place::new();
    let mut command = place.command(&["--no-such-option"]);
    command.env("NO_COLOR", "1").env("CLICOLOR_FORCE", "");
    let said = command.output().unwrap().stderr;
    assert!(!said.contains(&0x1b), "{}", text(&said));
}

#[cfg(feature = "desktop")]
#[test]
fn film_that_cannot_be_is_refused_before_anything_is_computed() {
    let place = Place::new();
    place.write("taken.gif", "");
    for (film, code, expected) in [
        ("taken.gif", 2, "exists already"),
        ("film.avi", 2, "ends in .gif, .mp4, .webm or .mov"),
        ("film.gif", 1, "no Vulkan driver was found"),
    ] {
        let mut command = place.command(&["bouncing-grain", "--no-render", "--record", film]);
        command.env("WGPU_BACKEND", "vulkan");
        command
            .env("VK_DRIVER_FILES", "none")
            .env("VK_ICD_FILENAMES", "none");
        let output = command.output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(said.contains(expected), "{said}");
        assert!(!place.path("out").exists(), "{film}");
    }
}

#[cfg(not(feature = "desktop"))]
#[test]
fn film_is_refused_where_nothing_can_be_drawn() {
    let place = Place::new();
    let output = place.run(&["bouncing-grain", "--no-render", "--record", "film.gif"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("built without pictures"), "{said}");
}
