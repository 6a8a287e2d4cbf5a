//! Mutations of bytes, the same for the same random numbers.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Numbers that upset arithmetic.
pub const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    -1.0,
    1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    1e300,
    1e-300,
    1e18,
    9_007_199_254_740_993.0,
    0.02,
    1e-12,
];

/// Anything between a billionth of a millionth and a million millions.
pub fn power_of_ten(rng: &mut ChaCha8Rng) -> f64 {
    10_f64.powi(rng.random_range(-12..12))
}

/// `bytes` with one to three mutations.
pub fn bytes(bytes: &[u8], rng: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..rng.random_range(1..=3) {
        if bytes.is_empty() {
            break;
        }
        // What comes first says how much follows: it is hit as often as all the rest.
        let end = if rng.random() {
            bytes.len()
        } else {
            bytes.len().min(64)
        };
        let at = rng.random_range(0..end);
        match rng.random_range(0..8) {
            0 => bytes[at] ^= 1 << rng.random_range(0..8),
            1 => bytes[at] = rng.random(),
            2 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][rng.random_range(0..5)],
            3 | 4 => {
                let number = match rng.random_range(0..3) {
                    0 => rng.random::<f64>() * power_of_ten(rng),
                    _ => NUMBERS[rng.random_range(0..NUMBERS.len())],
                };
                let number = number.to_le_bytes();
                let end = (at + number.len()).min(bytes.len());
                bytes[at..end].copy_from_slice(&number[..end - at]);
            }
            5 => {
                let end = (at + rng.random_range(1..16)).min(bytes.len());
                bytes.drain(at..end);
            }
            6 => {
                let end = (at + rng.random_range(1..16)).min(bytes.len());
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            // A length, as postcard writes it, that is enormous.
            _ => {
                let length = [0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f];
                let digits = rng.random_range(2..=length.len());
                bytes.splice(at..=at, length[length.len() - digits..].iter().copied());
            }
        }
    }
    bytes
}
