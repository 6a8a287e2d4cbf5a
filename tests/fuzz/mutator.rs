//! Mutations of texts and of JSON values, the same for the same random numbers.

use super::byte_mutator::{NUMBERS, power_of_ten};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::ops::Range;

/// Scraps that upset readers: numbers at the edge, brackets, quotes, keys where none belongs.
const SCRAPS: [&str; 48] = [
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
    "-9223372036854775808..9223372036854775807",
    "..",
    "0..9999",
    "Set(",
    "null",
    "true",
    "\u{1b}[2J",
    "\r\n",
    "--",
    "../../etc/passwd",
    "/dev/zero",
    "1e-12",
    "9007199254740993",
    "[[[[[[[[[[[[[[[[",
    "((((((((((((((((",
    "mm",
    "-->",
    "=",
];

/// `text` with one to four mutations, more often few than many: what has one mistake gets furthest.
pub fn text(text: &str, rng: &mut ChaCha8Rng) -> String {
    let mut text = text.to_owned();
    let most = rng.random_range(1..=4);
    for _ in 0..rng.random_range(1..=most) {
        match rng.random_range(0..7) {
            0 | 1 => replace_a_number(&mut text, rng),
            2 => {
                let at = some_place(&text, rng);
                text.insert_str(at, SCRAPS[rng.random_range(0..SCRAPS.len())]);
            }
            3 => {
                let piece = some_piece(&text, rng);
                text.replace_range(piece, "");
            }
            4 => {
                let piece = some_piece(&text, rng);
                let times = if rng.random_range(0..50) == 0 {
                    2000
                } else {
                    1
                };
                let copy = text[piece.clone()].repeat(times);
                text.insert_str(piece.end, &copy);
            }
            5 => {
                let (from, to) = (some_piece(&text, rng), some_place(&text, rng));
                let copy = text[from].to_owned();
                text.insert_str(to, &copy);
            }
            _ => {
                let at = some_place(&text, rng);
                if let Some(old) = text[at..].chars().next() {
                    let new = char::from(rng.random_range(0x20..0x7f_u8));
                    text.replace_range(at..at + old.len_utf8(), new.encode_utf8(&mut [0; 4]));
                }
            }
        }
    }
    text
}

fn some_place(text: &str, rng: &mut ChaCha8Rng) -> usize {
    text.floor_char_boundary(rng.random_range(0..=text.len()))
}

fn some_piece(text: &str, rng: &mut ChaCha8Rng) -> Range<usize> {
    let start = some_place(text, rng);
    let end = text.floor_char_boundary((start + rng.random_range(0..40)).min(text.len()));
    start..end.max(start)
}

fn replace_a_number(text: &mut String, rng: &mut ChaCha8Rng) {
    let digits: Vec<usize> = text
        .match_indices(|c: char| c.is_ascii_digit())
        .map(|found| found.0)
        .collect();
    if digits.is_empty() {
        return;
    }
    let start = digits[rng.random_range(0..digits.len())];
    let rest = &text[start..];
    let length = rest
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(rest.len());
    let number = match rng.random_range(0..4) {
        0 => format!("{:e}", rng.random::<f64>() * power_of_ten(rng)),
        1 => format!("{:?}", NUMBERS[rng.random_range(0..NUMBERS.len())]),
        2 => rng.random_range(0..10_u32).to_string(),
        _ => SCRAPS[rng.random_range(0..12)].to_owned(),
    };
    text.replace_range(start..start + length, &number);
}

/// Random bytes, as a text.
pub fn noise(rng: &mut ChaCha8Rng) -> String {
    let bytes = (0..rng.random_range(1..400)).map(|_| rng.random());
    String::from_utf8_lossy(&bytes.collect::<Vec<u8>>()).into_owned()
}

/// A JSON value with one mutation somewhere in it.
pub fn json(value: &mut serde_json::Value, rng: &mut ChaCha8Rng) {
    use serde_json::{Value, json};
    let goes_deeper = rng.random_range(0..8) > 0;
    match value {
        Value::Object(map) if goes_deeper && !map.is_empty() => {
            let index = rng.random_range(0..map.len());
            if let Some((_, inner)) = map.iter_mut().nth(index) {
                json(inner, rng);
            }
        }
        Value::Array(list) if goes_deeper && !list.is_empty() => {
            let index = rng.random_range(0..list.len());
            match rng.random_range(0..10) {
                0 => {
                    list.remove(index);
                }
                1 => {
                    let times = if rng.random_range(0..10) == 0 { 500 } else { 1 };
                    let copy = list[index].clone();
                    list.extend(std::iter::repeat_n(copy, times));
                }
                _ => json(&mut list[index], rng),
            }
        }
        Value::Number(_) => {
            *value = match rng.random_range(0..4) {
                0 => json!(rng.random_range(0..10_u32)),
                1 => json!(u64::MAX),
                2 => json!(rng.random::<f64>() * power_of_ten(rng)),
                _ => json!(NUMBERS[rng.random_range(0..NUMBERS.len())]),
            }
        }
        Value::String(own) if rng.random() => *own = text(own, rng),
        other => {
            *other = [json!(null), json!(0), json!("x"), json!([]), json!({})]
                [rng.random_range(0..5)]
            .clone();
        }
    }
}
