//! Whatever a file holds, reading it ends in a scene that can be built or in a message: never in a
//! panic, never in a hang.

use grainfall::scene::{Scene, SceneGrains, built_in};
use grainfall::solver::{Solver, advise};
use grainfall::world;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Scraps that upset readers: numbers at the edge, brackets, quotes, keys where none belongs.
const SCRAPS: [&str; 30] = [
    "0",
    "-1",
    "1e-300",
    "1e300",
    "1e999",
    "NaN",
    "inf",
    "-inf",
    "0.5",
    "3",
    "1000000",
    "18446744073709551616",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "\"",
    ":",
    ",",
    "//",
    "/*",
    "r#\"",
    "'",
    "radius",
    "Fill(",
    "\u{0}",
    "ß",
    "None",
];

fn mutated(text: &str, rng: &mut ChaCha8Rng) -> String {
    let mut text = text.to_owned();
    for _ in 0..rng.random_range(1..=3) {
        match rng.random_range(0..5) {
            0 => replace_a_number(&mut text, rng),
            1 => insert_a_scrap(&mut text, rng),
            2 => cut_a_piece(&mut text, rng),
            3 => double_a_piece(&mut text, rng),
            _ => flip_a_byte(&mut text, rng),
        }
    }
    text
}

fn some_place(text: &str, rng: &mut ChaCha8Rng) -> usize {
    let mut at = rng.random_range(0..=text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn some_piece(text: &str, rng: &mut ChaCha8Rng) -> std::ops::Range<usize> {
    let start = some_place(text, rng);
    let mut end = (start + rng.random_range(0..40)).min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    start..end.max(start)
}

fn replace_a_number(text: &mut String, rng: &mut ChaCha8Rng) {
    let digits: Vec<usize> = text
        .match_indices(|c: char| c.is_ascii_digit())
        .map(|m| m.0)
        .collect();
    if digits.is_empty() {
        return;
    }
    let start = digits[rng.random_range(0..digits.len())];
    let rest = &text[start..];
    let length = rest
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(rest.len());
    let scrap = SCRAPS[rng.random_range(0..12)];
    text.replace_range(start..start + length, scrap);
}

fn insert_a_scrap(text: &mut String, rng: &mut ChaCha8Rng) {
    let at = some_place(text, rng);
    text.insert_str(at, SCRAPS[rng.random_range(0..SCRAPS.len())]);
}

fn cut_a_piece(text: &mut String, rng: &mut ChaCha8Rng) {
    let piece = some_piece(text, rng);
    text.replace_range(piece, "");
}

fn double_a_piece(text: &mut String, rng: &mut ChaCha8Rng) {
    let piece = some_piece(text, rng);
    let copy = text[piece.clone()].to_owned();
    text.insert_str(piece.end, &copy);
}

fn flip_a_byte(text: &mut String, rng: &mut ChaCha8Rng) {
    let at = some_place(text, rng);
    if let Some(old) = text[at..].chars().next() {
        let new = char::from(rng.random_range(0x20..0x7f_u8));
        text.replace_range(at..at + old.len_utf8(), new.encode_utf8(&mut [0; 4]));
    }
}

#[test]
fn no_mutation_of_a_scene_makes_it_panic() {
    let mut sources: Vec<String> = built_in()
        .iter()
        .map(|scene| scene.text.to_owned())
        .collect();
    for name in [
        "every-key",
        "every-shape",
        "held-column",
        "touching-list",
        "two-sizes-box",
    ] {
        sources.push(std::fs::read_to_string(format!("tests/core/scene/good/{name}.ron")).unwrap());
    }
    let mut rng = ChaCha8Rng::seed_from_u64(20_210_401);
    let mut solver = Solver::new(1);
    let (mut read, mut refused) = (0, 0);
    for round in 0..6000 {
        let text = mutated(&sources[round % sources.len()], &mut rng);
        match Scene::parse("mutated.ron", &text) {
            Ok(scene) => {
                read += 1;
                // Building large ones would only take time.
                if round % 20 == 0 {
                    assert!(scene.check().is_ok());
                    let cells = matches!(scene.grains, SceneGrains::Voronoi(_));
                    if cells && scene.grain_count() > 10_000 {
                        continue;
                    }
                    let mut world = world::build(&scene, advise(&scene).time_step);
                    // How many cells lie in a drum or in a column is known when they are made.
                    if !cells {
                        assert_eq!(world.grains.len(), scene.grain_count(), "{text}");
                    }
                    // A fault is a fair answer to an odd scene; a panic is not.
                    let _ = solver.advance(&mut world, 2);
                }
            }
            Err(error) => {
                refused += 1;
                let message = error.to_string();
                assert!(message.contains("mutated.ron"), "{message}");
                assert!(message.len() < 2000, "{message}");
            }
        }
    }
    // The test would prove little if nearly all were read, or none.
    assert!(
        read > 500 && refused > 2000,
        "{read} read, {refused} refused"
    );
}

#[test]
fn noise_is_refused() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for _ in 0..500 {
        let bytes: Vec<u8> = (0..rng.random_range(1..400))
            .map(|_| rng.random())
            .collect();
        assert!(Scene::parse("noise", &String::from_utf8_lossy(&bytes)).is_err());
    }
}
