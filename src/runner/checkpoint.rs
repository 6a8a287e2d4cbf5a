//! Checkpoints: a run as it stood, kept in its folder, so that a run that was stopped can go on.
//!
//! In: a run and what was written of it. Out: four files, and from them the same: logs of samples,
//! of profiles and of outputs that grow at their ends, and the rest, with how much of the logs belongs to it.
//! So a run may forget what it measured, and has it read again at its end. A finished run
//! keeps its last checkpoint: a longer duration goes on from there. Whether what is found belongs
//! to the run that is asked for is said with the reason; what to do then is decided by the caller.

use super::Job;
use super::log::{Log, LogPart};
use crate::files::{open_regular, read_whole, write_whole};
use crate::measure::{FlowProfile, Measure, Sample, Series};
use crate::output::{
    CHECKPOINT, FRAME_LOG, Frame, OutputError, PROFILES, RunSoFar, SAMPLES, Written, WrittenRest,
};
use crate::run::{Checkpoint, CheckpointParts, Measured, Meeting, Stored, VERSION};
use crate::scene::{Scene, Until};
use crate::solver::advise;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::io::{self, ErrorKind, Read};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What the file begins with.
const MARK: &str = "grainfall checkpoint";
/// Raised whenever the file is laid out otherwise.
const LAYOUT: &str = "9";
/// Largest file of a checkpoint that is read [bytes].
const LARGEST: u64 = 16 << 30;
/// Most of the file in which its first line ends.
const LONGEST: u64 = 512;
/// Most wall-clock time between two checkpoints.
const CHECKPOINT_TIME: Duration = Duration::from_secs(20);
/// Least wall-clock time between two checkpoints.
const LEAST_TIME: Duration = Duration::from_secs(1);
/// Most of a run's wall-clock time that keeping checkpoints may cost, as one part in so many.
const SHARE_OF_TIME: u32 = 20;
/// Bytes of a sample in the log: its step, its time and its values.
const SAMPLE_SIZE: usize = size_of::<f64>() * (2 + Measure::COUNT);

/// A run as it stood and what was written of it until then.
pub struct Kept {
    /// The run.
    pub checkpoint: Checkpoint,
    /// Its files.
    pub written: Written,
}

/// What the file of a checkpoint holds: `R` is [`CheckpointParts`] when it is written and
/// [`Checkpoint`] when it is read.
#[derive(Serialize, Deserialize)]
struct Contents<R> {
    run: R,
    written: WrittenRest,
    /// What of the logs belongs to it.
    samples: LogPart,
    profiles: LogPart,
    frames: LogPart,
}

/// What became of looking for a checkpoint.
pub enum CheckpointLookup {
    /// It is there.
    Kept(Box<Kept>),
    /// There is none.
    Nothing,
    /// There is one of another run, or one that cannot be read, for the reason given.
    Unusable(String),
}

/// The file that a run's checkpoints are kept in.
pub struct CheckpointFile {
    path: PathBuf,
    /// What the run is: scene and script. How long it goes on does not matter, nor, where no grains
    /// are written, how often they would be.
    key: blake3::Hash,
    samples: Log,
    /// Profiles of the flowing layer in seconds that are over.
    profiles: Log,
    /// Outputs: times and digests of their files.
    frames: Log,
    written: Instant,
    /// Wall-clock time that the last one took.
    cost: Duration,
    /// Whether one is due at every look, as tests ask for.
    is_always_due: bool,
}

impl CheckpointFile {
    /// The file of the run that `job` asks for.
    ///
    /// # Errors
    /// When the job cannot be told from others.
    pub fn of(job: &Job) -> Result<Self, OutputError> {
        let path = job.out.join(CHECKPOINT);
        let scene = Scene {
            duration: 0.0,
            until: Until::Duration,
            output_interval: if job.grains {
                job.scene.output_interval
            } else {
                0.0
            },
            ..job.scene.clone()
        };
        let time_step = advise(&job.scene).time_step;
        let all = (scene, time_step, &job.script, job.grains);
        let all = postcard::to_stdvec(&all)
            .map_err(|error| OutputError::write(&path, io::Error::other(error)))?;
        Ok(Self {
            key: blake3::hash(&all),
            samples: Log::new(job.out.join(SAMPLES)),
            profiles: Log::new(job.out.join(PROFILES)),
            frames: Log::new(job.out.join(FRAME_LOG)),
            path,
            written: Instant::now(),
            cost: Duration::ZERO,
            is_always_due: false,
        })
    }

    /// Makes a checkpoint due at every look.
    #[cfg(test)]
    pub fn keep_always(&mut self) {
        self.is_always_due = true;
    }

    /// Why what is there cannot be gone on with by this run, as far as its first line says.
    pub fn other(&self) -> Option<String> {
        let mut first = Vec::new();
        let read =
            open_regular(&self.path).and_then(|file| file.take(LONGEST).read_to_end(&mut first));
        match read {
            Ok(_) => self.claim(&first).err(),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => Some(damaged(&error)),
        }
    }

    /// What is kept of the run; later checkpoints are added to it.
    pub fn read(&mut self) -> CheckpointLookup {
        let bytes = match read_whole(&self.path, LARGEST) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return CheckpointLookup::Nothing,
            Err(error) => return CheckpointLookup::Unusable(damaged(&error)),
        };
        let contents = match self.contents(&bytes) {
            Ok(contents) => contents,
            Err(reason) => return CheckpointLookup::Unusable(reason),
        };
        let read = postcard::take_from_bytes::<Contents<Checkpoint>>(contents);
        let read = read.and_then(|(contents, rest)| Ok((contents, meetings(rest)?)));
        let (contents, meetings) = match read {
            Ok(read) => read,
            Err(error) => return CheckpointLookup::Unusable(damaged(&error)),
        };
        let samples = self.samples.go_on(contents.samples);
        let profiles = self.profiles.go_on(contents.profiles);
        let frames_kept = self.frames.go_on(contents.frames);
        let logs = samples.and_then(|samples| {
            Ok((
                series(&samples),
                seconds(&profiles?)?,
                frames(&frames_kept?),
            ))
        });
        match logs {
            Ok((series, seconds, frames)) => CheckpointLookup::Kept(Box::new(Kept {
                checkpoint: contents.run.with_measured(series, seconds, meetings),
                written: contents.written.with(frames),
            })),
            Err(error) => CheckpointLookup::Unusable(damaged(&error)),
        }
    }

    /// How much of what was measured is kept.
    pub fn stored(&self) -> Stored {
        Stored {
            samples: self.samples.records(),
            seconds: self.profiles.records(),
        }
    }

    /// Outputs that are kept.
    pub fn frames_stored(&self) -> usize {
        self.frames.records()
    }

    /// What is kept of all outputs.
    ///
    /// # Errors
    /// When that cannot be read.
    pub fn frames(&self) -> Result<Vec<Frame>, OutputError> {
        Ok(frames(&self.frames.read()?))
    }

    /// All that was measured of `run`, which may have forgotten what is kept.
    ///
    /// # Errors
    /// When that cannot be read.
    pub fn measured(&self, run: RunSoFar) -> Result<Measured, OutputError> {
        let samples = self.samples.read()?;
        let seconds = seconds(&self.profiles.read()?);
        let seconds = seconds.map_err(|error| self.profiles.unreadable(error))?;
        Ok(Measured {
            series: Arc::new(run.series.behind(series(&samples))),
            flow: Arc::new(run.flow.behind(seconds)),
        })
    }

    /// What stands behind the first line of `bytes`.
    ///
    /// # Errors
    /// Why the run cannot go on from it, in a sentence.
    fn contents<'a>(&self, bytes: &'a [u8]) -> Result<&'a [u8], String> {
        let (length, checksum) = self.claim(bytes)?;
        let contents = &bytes[length..];
        if checksum != blake3::hash(contents).to_hex().as_str() {
            return Err(damaged(&"its checksum does not fit"));
        }
        Ok(contents)
    }

    /// The length of the first line of `bytes`, which says that they are of this run, and the
    /// checksum that it states.
    ///
    /// # Errors
    /// Why the run cannot go on from it, in a sentence.
    fn claim<'a>(&self, bytes: &'a [u8]) -> Result<(usize, &'a str), String> {
        let length = bytes.iter().position(|byte| *byte == b'\n');
        let length = 1 + length.ok_or_else(|| damaged(&"its first line is not whole"))?;
        let first = std::str::from_utf8(&bytes[..length]).unwrap_or_default();
        let words = first.strip_prefix(MARK).unwrap_or_default();
        let words: Vec<&str> = words.split_whitespace().collect();
        let &[layout, version, key, checksum] = words.as_slice() else {
            return Err(damaged(&"its first line is not that of a checkpoint"));
        };
        if (layout, version) != (LAYOUT, VERSION) {
            return Err(format!(
                "it was computed by Grainfall {version}, and this is {VERSION}{}",
                if version == VERSION {
                    " of another build"
                } else {
                    ""
                }
            ));
        }
        if key != self.key.to_hex().as_str() {
            return Err("it is one of another scene, or with other values or commands".into());
        }
        Ok((length, checksum))
    }

    /// Whether the last checkpoint is so old that another is due; sooner at an output, after which
    /// the run's files are durable.
    pub fn is_due(&self, is_output: bool) -> bool {
        let affordable = self.cost.saturating_mul(SHARE_OF_TIME).max(LEAST_TIME);
        let spacing = if is_output {
            affordable
        } else {
            affordable.max(CHECKPOINT_TIME)
        };
        self.is_always_due || self.written.elapsed() >= spacing
    }

    /// Keeps `run`, of which so much was `written`; the work for it `started` then.
    ///
    /// # Errors
    /// When it cannot be written; what was kept before is kept on.
    pub fn write(
        &mut self,
        run: RunSoFar,
        written: &Written,
        started: Instant,
    ) -> Result<(), OutputError> {
        self.add_measured(run)?;
        self.add_frames(written)?;
        let rest = run.flow.rest(self.profiles.records());
        let contents = Contents {
            run: CheckpointParts::of(run.world, run.commands, run.sampling, &rest),
            written: written.rest(),
            samples: self.samples.part(),
            profiles: self.profiles.part(),
            frames: self.frames.part(),
        };
        let failed = |source| OutputError::write(&self.path, source);
        let contents = postcard::to_stdvec(&contents)
            .and_then(|contents| postcard::to_extend(run.meetings, contents))
            .map_err(|error| failed(io::Error::other(error)))?;
        let (key, checksum) = (self.key.to_hex(), blake3::hash(&contents).to_hex());
        let whole = write_whole(&self.path, |file| {
            writeln!(file, "{MARK} {LAYOUT} {VERSION} {key} {checksum}")?;
            file.write_all(&contents)
        });
        whole.map_err(failed)?;
        self.written = Instant::now();
        self.cost = started.elapsed();
        Ok(())
    }

    /// Adds what was measured of `run` since the last checkpoint to the logs.
    fn add_measured(&mut self, run: RunSoFar) -> Result<(), OutputError> {
        let new = run.series.since(self.samples.records());
        let bytes: Vec<u8> = new.flat_map(|sample| bytes_of(&sample)).collect();
        self.samples.add(&bytes, run.series.taken())?;
        let (known, done) = (self.profiles.records(), run.flow.done());
        let new = run.flow.profiles_since(known).iter();
        let mut bytes = Vec::new();
        for profile in new.take(done.saturating_sub(known)) {
            let failed = |error| OutputError::write(&self.path, io::Error::other(error));
            bytes.extend(postcard::to_stdvec(profile.as_ref()).map_err(failed)?);
        }
        self.profiles.add(&bytes, known.max(done))
    }

    /// Adds what is kept of the outputs since the last checkpoint to its log.
    fn add_frames(&mut self, written: &Written) -> Result<(), OutputError> {
        let known = self.frames.records();
        let new = written.frames_since(known);
        let bytes: Vec<u8> = new.iter().flat_map(|frame| frame.to_bytes()).collect();
        self.frames.add(&bytes, known + new.len())
    }
}

/// The outputs that the `bytes` of the log hold.
fn frames(bytes: &[u8]) -> Vec<Frame> {
    let (frames, _) = bytes.as_chunks();
    frames.iter().map(Frame::from_bytes).collect()
}

fn damaged(reason: &dyn Display) -> String {
    format!("its checkpoint cannot be used: {reason}")
}

/// The samples that the `bytes` of the log hold.
fn series(bytes: &[u8]) -> Series {
    let mut series = Series::default();
    let samples = bytes.chunks_exact(SAMPLE_SIZE);
    samples.for_each(|bytes| series.push(sample(bytes)));
    series
}

/// Who met, as the `bytes` behind the rest of a checkpoint say it; nothing stands there in those of
/// earlier builds.
fn meetings(bytes: &[u8]) -> postcard::Result<Vec<Meeting>> {
    if bytes.is_empty() {
        return Ok(Vec::new());
    }
    postcard::from_bytes(bytes)
}

/// The profiles that the `bytes` of the log hold.
fn seconds(mut bytes: &[u8]) -> io::Result<Vec<FlowProfile>> {
    let mut seconds = Vec::new();
    while !bytes.is_empty() {
        let (profile, rest) = postcard::take_from_bytes(bytes).map_err(io::Error::other)?;
        seconds.push(profile);
        bytes = rest;
    }
    Ok(seconds)
}

fn bytes_of(sample: &Sample) -> Vec<u8> {
    let numbers = [sample.step, sample.time.to_bits()].into_iter();
    let numbers = numbers.chain(sample.values.iter().map(|value| value.to_bits()));
    numbers.flat_map(u64::to_le_bytes).collect()
}

fn sample(bytes: &[u8]) -> Sample {
    let number = |index: usize| {
        let mut number = [0; size_of::<u64>()];
        let start = index * number.len();
        number.copy_from_slice(&bytes[start..start + size_of::<u64>()]);
        u64::from_le_bytes(number)
    };
    Sample {
        step: number(0),
        time: f64::from_bits(number(1)),
        values: std::array::from_fn(|index| f64::from_bits(number(2 + index))),
    }
}
