//! Files of other engines, mutated: dumps, data files, and the record of an export beside them.

use super::small_export::{drum, export_drum};
use super::targets::{Place, Target, one_of};
use super::{byte_mutator, mutator};
use grainfall::engines::{ImportSource, import, read_frames};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::fs;
use std::path::Path;

/// Grains up to which what is read is also measured and written.
const FEW_GRAINS: usize = 300;

/// Dumps and data files, some of them with a byte that is no text. What is accepted becomes a run.
pub struct EngineFiles {
    place: Place,
    texts: Vec<String>,
    source: ImportSource,
}

impl EngineFiles {
    pub fn new() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus");
        let names = ["liggghts.dump", "lammps.dump", "grains.data"];
        let text = |name| fs::read_to_string(folder.join(name)).expect("it is in the corpus");
        Self {
            place: Place::new(),
            texts: names.map(text).to_vec(),
            source: ImportSource::of_scene("mutated", drum(), Vec::new()),
        }
    }
}

impl Target for EngineFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let text = mutator::text(one_of::<String>(&self.texts, rng), rng);
        let bytes = if rng.random_range(0..8) == 0 {
            byte_mutator::bytes(text.as_bytes(), rng)
        } else {
            text.into_bytes()
        };
        let path = self.place.write("a.dump", bytes);
        let Ok(frames) = read_frames(&path) else {
            return false;
        };
        if frames.iter().all(|frame| frame.atoms.len() <= FEW_GRAINS) {
            let _ = import(
                &[path],
                &self.source,
                &self.place.path("out"),
                true,
                &mut (),
            );
        }
        true
    }
}

/// Records of exports, beside a data file that fits the sound one.
pub struct ExportRecords {
    place: Place,
    record: serde_json::Value,
}

impl ExportRecords {
    pub fn new() -> Self {
        let place = Place::new();
        export_drum(&place.path("deck")).expect("it can be written");
        let text = fs::read(place.path("deck/export.json")).expect("it was written");
        Self {
            place,
            record: serde_json::from_slice(&text).expect("it is JSON"),
        }
    }
}

impl Target for ExportRecords {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let mut record = self.record.clone();
        for _ in 0..rng.random_range(0..=2) {
            mutator::json(&mut record, rng);
        }
        self.place.write("deck/export.json", record.to_string());
        let Ok(Some(source)) = ImportSource::beside(&self.place.path("deck")) else {
            return false;
        };
        let data = [self.place.path("deck/grains.data")];
        if source.scene.grain_count() <= FEW_GRAINS {
            let _ = import(&data, &source, &self.place.path("out"), true, &mut ());
        }
        true
    }
}
