//! Checkpoints: a run as it stood, kept in its folder, so that a run that was stopped can go on.
//!
//! In: a run and what was written of it. Out: two files, and from them the same: a log of samples
//! that grows at its end, and the rest, with how much of the log belongs to it. A finished run
//! keeps its last checkpoint: a longer duration goes on from there. Whether what is found belongs
//! to the run that is asked for is said with the reason; what to do then is decided by the caller.

use super::Job;
use crate::files::{GrowingFile, open_regular, read_whole, write_whole};
use crate::measure::{Measure, Sample, Series};
use crate::output::{CHECKPOINT, OutputError, RunSoFar, SAMPLES, Written};
use crate::run::{Checkpoint, CheckpointParts, VERSION};
use crate::scene::Scene;
use crate::solver::advise;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use std::io::{self, ErrorKind, Read};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What the file begins with.
const MARK: &str = "grainfall checkpoint";
/// Raised whenever the file is laid out otherwise.
const LAYOUT: &str = "6";
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
    written: Written,
    /// How many samples of the log belong to it, and the digest of these.
    samples: u64,
    digest: [u8; blake3::OUT_LEN],
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
    log: SampleLog,
    written: Instant,
    /// Wall-clock time that the last one took.
    cost: Duration,
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
            log: SampleLog::new(job.out.join(SAMPLES)),
            path,
            written: Instant::now(),
            cost: Duration::ZERO,
        })
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
        let contents: Contents<Checkpoint> = match postcard::from_bytes(contents) {
            Ok(contents) => contents,
            Err(error) => return CheckpointLookup::Unusable(damaged(&error)),
        };
        match self.log.read(contents.samples, contents.digest) {
            Ok(series) => CheckpointLookup::Kept(Box::new(Kept {
                checkpoint: contents.run.with_series(series),
                written: contents.written,
            })),
            Err(reason) => CheckpointLookup::Unusable(damaged(&reason)),
        }
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
        self.written.elapsed() >= spacing
    }

    /// Keeps `run`, of which so much was `written`; the work for it `started` then.
    ///
    /// # Errors
    /// When it cannot be written; what was kept before is kept on.
    pub fn write(
        &mut self,
        run: RunSoFar,
        written: Written,
        started: Instant,
    ) -> Result<(), OutputError> {
        self.log
            .add(run.series)
            .map_err(|source| OutputError::write(&self.log.path, source))?;
        let parts = CheckpointParts::of(run.world, run.commands, run.sampling, run.flow);
        let contents = Contents {
            run: parts,
            written,
            samples: run.series.len() as u64,
            digest: *self.log.digest.finalize().as_bytes(),
        };
        let failed = |source| OutputError::write(&self.path, source);
        let contents =
            postcard::to_stdvec(&contents).map_err(|error| failed(io::Error::other(error)))?;
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
}

fn damaged(reason: &dyn Display) -> String {
    format!("its checkpoint cannot be used: {reason}")
}

/// Samples one behind the other, each with as many bytes.
struct SampleLog {
    path: PathBuf,
    file: Option<GrowingFile>,
    /// Samples that are in it.
    samples: usize,
    /// Of these.
    digest: blake3::Hasher,
}

impl SampleLog {
    fn new(path: PathBuf) -> Self {
        Self {
            path,
            file: None,
            samples: 0,
            digest: blake3::Hasher::new(),
        }
    }

    /// The first `samples` of the file, which have this `digest`; what follows them is forgotten.
    fn read(&mut self, samples: u64, digest: [u8; blake3::OUT_LEN]) -> Result<Series, String> {
        let bytes =
            read_whole(&self.path, LARGEST).map_err(|error| format!("{SAMPLES}: {error}"))?;
        let length = usize::try_from(samples).ok();
        let length = length.and_then(|samples| samples.checked_mul(SAMPLE_SIZE));
        let bytes = length.and_then(|length| bytes.get(..length));
        let bytes = bytes.ok_or_else(|| format!("{SAMPLES} was cut off"))?;
        self.digest.update(bytes);
        if *self.digest.finalize().as_bytes() != digest {
            return Err(format!("the digest of {SAMPLES} does not fit"));
        }
        let mut series = Series::default();
        bytes
            .chunks_exact(SAMPLE_SIZE)
            .for_each(|bytes| series.push(sample(bytes)));
        let file = GrowingFile::go_on(&self.path, bytes.len() as u64);
        self.file = Some(file.map_err(|error| format!("{SAMPLES}: {error}"))?);
        self.samples = series.len();
        Ok(series)
    }

    /// Adds what of `series` is not in it yet, durably.
    fn add(&mut self, series: &Series) -> io::Result<()> {
        let new = (self.samples..series.len()).filter_map(|index| series.get(index));
        let bytes: Vec<u8> = new.flat_map(|sample| bytes_of(&sample)).collect();
        if let Some(file) = &mut self.file {
            file.add(&bytes)?;
            file.sync()?;
        } else {
            self.file = Some(GrowingFile::begin(&self.path, &bytes, b"")?);
        }
        self.digest.update(&bytes);
        self.samples = series.len();
        Ok(())
    }
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
