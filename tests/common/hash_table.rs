//! The table of hashes: which state of which scene every way comes to.
//!
//! `GRAINFALL_HASHES=FILE` writes its rows to a file, for the log of a build.

use std::fs::File;
use std::io::Write;

/// Tells a row of the table: a state of a scene, the way to it, its hash.
pub fn note(scene: &str, way: &str, hash: impl std::fmt::Display) {
    let row = format!("{scene:<44} {way:<44} {hash}\n");
    print!("{row}");
    if let Some(path) = std::env::var_os("GRAINFALL_HASHES") {
        let file = File::options().create(true).append(true).open(path);
        file.unwrap().write_all(row.as_bytes()).unwrap();
    }
}
