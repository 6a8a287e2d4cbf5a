//! A whole session in one file: the scene, every change, every branch, and the moment shown, to the
//! bit.
//!
//! In: a timeline. Out: a file, and from it the same timeline. Its first line names program,
//! layout, version and the checksum of the rest; its second line is the [`RunRecord`] of the moment
//! shown, as JSON that people and `grainfall verify` read; then come states and samples, the grains
//! that the scene takes from a file, and how the window looked, packed in those that are shipped. A
//! file of another version is refused: another version may compute other bits.

use super::archive::Archive;
use super::record::{RunRecord, VERSION};
use super::script::ScriptedCommand;
use super::session_tail::{LAYOUT, Tail, is_known};
use super::timeline::Timeline;
use crate::files::{open_regular, read_whole, write_whole};
use crate::geometry::Rounded;
use crate::scene::{HeldCells, Scene, StoredCells, within_folders};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// What the first line begins with.
const MARK: &str = "grainfall session";
/// Largest file that is read [bytes]: a day of a drum with all its branches has less.
const LARGEST_FILE: u64 = 4 << 30;
/// What follows the layout of a file whose states and samples are packed.
const PACKED: &str = "-packed";
/// Most that they are unpacked to [bytes]: only what is shipped is packed, and a small file must not
/// fill the memory.
const LARGEST_UNPACKED: u64 = 64 << 20;

/// Extension of a session's file.
pub const SESSION_EXTENSION: &str = "grainfall";

/// A session as it was kept.
#[derive(Clone)]
pub struct Session {
    record: RunRecord,
    archive: Archive,
    /// The scene as it was opened, where what acts from the next start on was changed since.
    original: Option<Scene>,
    /// How the window looked, in its own words; empty where that is not known.
    look: String,
}

/// What follows the second line of a file.
#[derive(Serialize, Deserialize)]
struct Rest<A, C> {
    archive: A,
    /// The grains that the scene takes from a file of its own.
    cells: Option<C>,
    /// The scene as it was opened, as JSON, where it is another.
    original: Option<String>,
}

/// Why a file cannot be opened as a session, and what to do.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", .path.display())]
pub struct SessionError {
    path: PathBuf,
    reason: Reason,
}

#[derive(Debug, thiserror::Error)]
enum Reason {
    #[error("cannot be read: {0}")]
    Unreadable(io::Error),
    #[error(
        "is no session of Grainfall: its first line does not begin with `{MARK}`. Open a file that `Save the session` wrote"
    )]
    Foreign,
    #[error(
        "was saved by Grainfall {0}, and this is {VERSION}, which reads no states of it. Open it with Grainfall {0}, or \
         repeat it here: its second line, saved as a .json file, holds scene and changes for --commands"
    )]
    Version(String),
    #[error(
        "states a scene that cannot be made here: {0}. Where it names a file, put that file there and open this one again"
    )]
    Scene(String),
    #[error(
        "is damaged: {0}. Open another copy of it. If its second line is whole, that line, saved as a .json file, repeats \
         the run with --commands"
    )]
    Damaged(&'static str),
    #[error(
        "is damaged, or was not written by this program: {0}. Open another copy of it, and none of a stranger's"
    )]
    Unsound(String),
}

impl Session {
    /// `timeline` as it is now; `name` is what people call its scene.
    pub fn of(name: &str, timeline: &Timeline) -> Self {
        let run = timeline.run();
        let commands = timeline.branch().history.commands();
        Self {
            record: RunRecord::of(name, run.scene(), commands, run.world()),
            archive: timeline.archive(),
            original: None,
            look: String::new(),
        }
    }

    /// The same of a scene that was made of the `original` by changing what acts from a start on.
    #[must_use]
    pub fn of_original(self, original: &Scene) -> Self {
        let is_other = *original != self.record.scene;
        Self {
            original: is_other.then(|| original.clone()),
            ..self
        }
    }

    /// The same with how the window looks, in its own words.
    #[must_use]
    pub fn looking(self, look: String) -> Self {
        Self { look, ..self }
    }

    /// How the window looked, in its own words; empty where that is not known.
    pub fn look(&self) -> &str {
        &self.look
    }

    /// Whether the file at `path` says that it is one.
    pub fn is_at(path: &Path) -> bool {
        // What cannot be read says nothing; whoever opens it is told why.
        let mut start = [0; MARK.len()];
        let read = open_regular(path).and_then(|mut file| file.read_exact(&mut start));
        read.is_ok() && start == *MARK.as_bytes()
    }

    /// The session in the file at `path`, whose states are those that were saved.
    ///
    /// # Errors
    /// When the file cannot be read, is no session, is damaged or of another version.
    pub fn read(path: &Path) -> Result<Self, SessionError> {
        let bytes = read_whole(path, LARGEST_FILE).map_err(Reason::Unreadable);
        let read = bytes.and_then(|bytes| Self::decode(&bytes));
        read.map_err(|reason| SessionError {
            path: path.to_owned(),
            reason,
        })
    }

    /// The session in the `bytes` of a file that is shipped with the program.
    pub(super) fn of_bytes(bytes: &[u8]) -> Result<Self, SessionError> {
        Self::decode(bytes).map_err(|reason| SessionError {
            path: "the session shipped with the program".into(),
            reason,
        })
    }

    /// Writes it to the file at `path`, whole or not at all.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.write_as(path, LAYOUT, |rest| Ok(rest.into()))
    }

    /// The same with states and samples packed: in two thirds of the room, and slowly.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_packed(&self, path: &Path) -> io::Result<()> {
        self.write_as(path, &format!("{LAYOUT}{PACKED}"), |rest| {
            let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
            packed.write_all(rest)?;
            packed.finish().map(Cow::Owned)
        })
    }

    /// Writes it in this `layout`, where what follows the second line is turned by `laid`.
    fn write_as(
        &self,
        path: &Path,
        layout: &str,
        laid: impl FnOnce(&[u8]) -> io::Result<Cow<[u8]>>,
    ) -> io::Result<()> {
        self.record.check_fingerprint()?;
        let mut second = serde_json::to_vec(&self.record)?;
        second.push(b'\n');
        let rest = Rest {
            archive: &self.archive,
            cells: self.record.scene.stored_cells().map(StoredCells::grains),
            original: self
                .original
                .as_ref()
                .map(serde_json::to_string)
                .transpose()?,
        };
        let tail = Tail::of(&self.archive, &self.look);
        let rest = postcard::to_stdvec(&rest).map_err(io::Error::other)?;
        let rest = postcard::to_extend(&tail, rest).map_err(io::Error::other)?;
        let rest = laid(&rest)?;
        write_whole(path, |file| {
            let mut hasher = blake3::Hasher::new();
            let checksum = hasher.update(&second).update(&rest).finalize().to_hex();
            writeln!(file, "{MARK} {layout} {VERSION} {checksum}")?;
            file.write_all(&second)?;
            file.write_all(&rest)
        })
    }

    /// What it states: scene, changes, the moment shown and its state.
    pub fn record(&self) -> &RunRecord {
        &self.record
    }

    /// The scene as it was opened, before what acts from the next start on was changed.
    pub fn original(&self) -> &Scene {
        self.original.as_ref().unwrap_or(&self.record.scene)
    }

    /// What it states, without the rest.
    pub fn into_record(self) -> RunRecord {
        self.record
    }

    /// The timeline as it was, on `threads` threads, with keyframes in `budget` bytes.
    pub fn into_timeline(self, threads: usize, budget: usize) -> Timeline {
        Timeline::unpack(self.archive, self.record.scene.into(), threads, budget)
    }

    fn decode(bytes: &[u8]) -> Result<Self, Reason> {
        let (first, body) = first_line(bytes).ok_or(Reason::Foreign)?;
        let words = first.strip_prefix(MARK).ok_or(Reason::Foreign)?;
        let &[layout, version, checksum] = words.split_whitespace().collect::<Vec<_>>().as_slice()
        else {
            return Err(Reason::Damaged("its first line is not whole"));
        };
        let (layout, is_packed) = match layout.strip_suffix(PACKED) {
            Some(layout) => (layout, true),
            None => (layout, false),
        };
        if !is_known(layout) || version != VERSION {
            let build = if version == VERSION {
                " of another build"
            } else {
                ""
            };
            return Err(Reason::Version(format!("{version}{build}")));
        }
        if checksum != blake3::hash(body).to_hex().as_str() {
            return Err(Reason::Damaged(
                "its checksum does not fit, so it was cut off or edited",
            ));
        }
        let foreign = "its contents are those of another build of this version";
        let (second, rest) = first_line(body).ok_or(Reason::Damaged(foreign))?;
        let rest = if is_packed {
            unpacked(rest)?.into()
        } else {
            Cow::Borrowed(rest)
        };
        // A value that no parameter takes stands in the list of changes too, where it has a name.
        let (rest, tail): (Rest<Archive, Vec<Rounded>>, &[u8]) =
            postcard::take_from_bytes(&rest)
                .map_err(|_| unsuited(second).unwrap_or(Reason::Damaged(foreign)))?;
        let tail = Tail::read(tail, layout).map_err(|_| Reason::Damaged(foreign))?;
        let _held = rest.cells.and_then(HeldCells::hold);
        // The grains of its scene are in it: no other file is opened.
        let record: RunRecord = within_folders(&[], || of_json(second))?;
        let original = rest.original.as_deref();
        let original = within_folders(&[], || original.map(of_json::<Scene>).transpose())?;
        for scene in [Some(&record.scene), original.as_ref()]
            .into_iter()
            .flatten()
        {
            scene.check().map_err(|e| Reason::Scene(e.to_string()))?;
        }
        let mut archive = rest.archive;
        let look = tail.complete(&mut archive);
        archive.check(&record.scene).map_err(Reason::Unsound)?;
        let hash = archive.shown().map(|world| world.hash().to_string());
        if !record.is_genuine() || hash != record.state_hash {
            return Err(Reason::Damaged(
                "the state in it has another hash than it states",
            ));
        }
        Ok(Self {
            record,
            archive,
            original,
            look,
        })
    }
}

/// What the bytes `packed` in a file are.
fn unpacked(packed: &[u8]) -> Result<Vec<u8>, Reason> {
    let mut bytes = Vec::new();
    let mut unpacking = ZlibDecoder::new(packed).take(LARGEST_UNPACKED);
    match unpacking.read_to_end(&mut bytes) {
        Ok(_) if unpacking.limit() > 0 => Ok(bytes),
        _ => Err(Reason::Damaged("its states cannot be unpacked")),
    }
}

/// Why the list of changes in the claim `text` cannot be used, where it cannot.
fn unsuited(text: &str) -> Option<Reason> {
    #[derive(Deserialize)]
    struct Changes {
        #[serde(rename = "commands")]
        _commands: Vec<ScriptedCommand>,
    }
    of_json::<Changes>(text).err()
}

/// What the JSON `text` holds. By way of a value: an error then speaks of what is wrong, not of a
/// place in a long line.
fn of_json<T: DeserializeOwned>(text: &str) -> Result<T, Reason> {
    serde_json::from_str(text)
        .and_then(serde_json::from_value)
        .map_err(|error| Reason::Scene(error.to_string()))
}

/// The text up to the first line's end, and what follows it.
fn first_line(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    // A line that is no text is none that this program wrote; the caller says so.
    let line = std::str::from_utf8(&bytes[..end]).ok()?;
    Some((line, &bytes[end + 1..]))
}

#[cfg(test)]
#[path = "../../tests/fuzz/byte_mutator.rs"]
mod byte_mutator;

#[cfg(test)]
mod tests {
    //! Forged sessions: the states in them are other than any that was saved, and everything that
    //! vouches for them says that they are right. `FUZZ_SECONDS=60` forges for a minute.

    use super::*;
    use crate::run::session_tail::WITHOUT_TAIL;
    use crate::run::{BedStore, Command, Parameter, Preparation, Prepared, Run};
    use crate::solver::advise;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::Arc;
    use std::time::{Duration, Instant};

    /// A session of `scene` after some steps, a change, a step back and another.
    fn session(scene: &Scene) -> Session {
        let shared = Arc::new(scene.clone());
        let step = advise(scene).time_step;
        let mut preparation = Preparation::new(shared, step, 1, BedStore::none());
        let run: Run = loop {
            if let Prepared::Ready(run) = preparation.advance().unwrap() {
                break *run;
            }
        };
        let mut timeline = Timeline::new(run, 1 << 24);
        let gravity = |value: f64| Command::Set {
            parameter: Parameter::Gravity,
            value: value.into(),
        };
        timeline.advance_to(300).unwrap();
        timeline.change(gravity(5.0), false).unwrap();
        timeline.advance_to(600).unwrap();
        timeline.seek(400);
        while timeline.destination().is_some() {
            timeline.advance_to(400).unwrap();
        }
        timeline.change(gravity(7.0), false).unwrap();
        timeline.advance_to(500).unwrap();
        Session::of("a session", &timeline)
    }

    fn sessions() -> Vec<Session> {
        let scene = |name: &str, settings: &[(&str, &str)]| {
            let mut scene = Scene::open(name).unwrap();
            let set = |(key, value): &(&str, &str)| scene.set(key, value).unwrap();
            settings.iter().for_each(set);
            scene
        };
        let mut drum = scene("small-drum", &[("count", "30"), ("radius", "4mm")]);
        drum.liquid = Scene::open("water-drum").unwrap().liquid;
        let column = scene("small-column", &[("radius", "7mm"), ("height", "7mm")]);
        [drum, column, scene("two-grains", &[])]
            .iter()
            .map(session)
            .collect()
    }

    /// `session` with other states, and with the hash and the fingerprint of these.
    fn forged(session: &Session, rng: &mut ChaCha8Rng) -> Option<Session> {
        let bytes = postcard::to_stdvec(&session.archive).unwrap();
        let archive: Archive = postcard::from_bytes(&byte_mutator::bytes(&bytes, rng)).ok()?;
        let mut record = session.record.clone();
        // A forger's program may fail where this one must not.
        let hash = || Some(archive.shown()?.hash().to_string());
        record.state_hash = catch_unwind(AssertUnwindSafe(hash)).ok()?;
        Some(Session {
            record: record.sealed(),
            archive,
            original: None,
            look: String::new(),
        })
    }

    /// What a person does with a session.
    fn use_up(session: Session) {
        let mut timeline = session.into_timeline(1, 1 << 24);
        let few_steps = |timeline: &mut Timeline| {
            let step = timeline.run().world().clock.step;
            // A fault is a fair end of an odd state.
            let _ = timeline.advance_to(step + 3);
            let _ = (
                timeline.run().advice(),
                timeline.past(),
                timeline.progress(),
            );
        };
        few_steps(&mut timeline);
        timeline.undo();
        few_steps(&mut timeline);
        timeline.redo();
        timeline.take_up(0);
        few_steps(&mut timeline);
        timeline.seek(0);
        few_steps(&mut timeline);
        timeline.reset();
        few_steps(&mut timeline);
    }

    #[test]
    fn sessions_of_the_layout_without_a_tail_open_still() {
        let folder = tempfile::tempdir().unwrap();
        let [new, old] = ["new.grainfall", "old.grainfall"].map(|name| folder.path().join(name));
        let written = session(&Scene::open("two-grains").unwrap()).looking("a look".into());
        written.write(&new).unwrap();
        let samplings = |session: &Session| session.archive.samplings().collect::<Vec<_>>();
        let read = Session::read(&new).unwrap();
        assert_eq!(read.look(), "a look");
        assert_eq!(samplings(&read), samplings(&written));
        let bytes = std::fs::read(&new).unwrap();
        let (_, body) = first_line(&bytes).unwrap();
        let (_, rest) = first_line(body).unwrap();
        let (_, tail): (Rest<Archive, Vec<Rounded>>, &[u8]) =
            postcard::take_from_bytes(rest).unwrap();
        let body = &body[..body.len() - tail.len()];
        let checksum = blake3::hash(body).to_hex();
        let first = format!("{MARK} {WITHOUT_TAIL} {VERSION} {checksum}\n");
        std::fs::write(&old, [first.as_bytes(), body].concat()).unwrap();
        let read = Session::read(&old).unwrap();
        assert_eq!(read.look(), "");
        use_up(read);
    }

    #[test]
    fn forged_sessions_are_refused_or_can_be_gone_on_with() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.grainfall");
        let sessions = sessions();
        let seconds = std::env::var("FUZZ_SECONDS").ok();
        let seconds = seconds.and_then(|seconds| seconds.parse().ok());
        let time = Duration::from_secs(seconds.unwrap_or(1));
        let (started, mut counts) = (Instant::now(), [0_u32; 4]);
        let mut failures = Vec::new();
        for number in 0.. {
            let mut rng = ChaCha8Rng::seed_from_u64(7);
            rng.set_stream(number);
            let session = &sessions[rng.random_range(0..sessions.len())];
            counts[0] += 1;
            if let Some(forged) = forged(session, &mut rng) {
                counts[1] += 1;
                forged.write(&path).unwrap();
                let begun = Instant::now();
                let used = catch_unwind(AssertUnwindSafe(|| {
                    let read = Session::read(&path);
                    read.is_ok_and(|session| {
                        use_up(session);
                        true
                    })
                }));
                match used {
                    Ok(accepted) => counts[2] += u32::from(accepted),
                    Err(_) => failures.push(number),
                }
                counts[3] += u32::from(begun.elapsed() > Duration::from_secs(10));
            }
            if started.elapsed() > time || failures.len() > 20 {
                break;
            }
        }
        let [made, forged, accepted, slow] = counts;
        println!("{made} forgeries, {forged} written, {accepted} accepted, {slow} slow");
        assert!(failures.is_empty(), "forgeries {failures:?} panic");
        assert_eq!(slow, 0);
        assert!(accepted > 0 && accepted < forged, "{accepted} of {forged}");
    }
}
