//! What a person allows that no file can, and what is refused where nobody did.

use super::Report;
use grainfall::run::Estimate;
use grainfall::runner::RunnerError;
use grainfall::scene::take_packings_from_anywhere;
use std::path::Path;

/// What a person allows that no file can.
#[derive(clap::Args)]
pub struct Allowed {
    /// Take packings from where a scene or a record says, not only from the folder that it is in
    #[arg(long, global = true)]
    packings_anywhere: bool,
    /// Start what asks for more memory than is free, too
    #[arg(long, global = true)]
    beyond_memory: bool,
    /// Start what writes more than its disk has room for, too
    #[arg(long, global = true)]
    beyond_disk: bool,
}

impl Allowed {
    /// Lets the whole program do what is allowed.
    pub fn take_effect(&self) {
        if self.packings_anywhere {
            take_packings_from_anywhere();
        }
    }

    /// Refuses what asks for more memory than there is.
    ///
    /// # Errors
    /// When it does, and nobody allowed it.
    pub fn memory(&self, asked: &Estimate) -> Result<(), RunnerError> {
        if self.beyond_memory {
            return Ok(());
        }
        let fits = asked.fits_into_memory();
        fits.map_err(|error| RunnerError::Input(error.to_string()))
    }

    /// Says what is `asked` for, with files in the folder `out`, before it begins.
    ///
    /// # Errors
    /// When that is more memory, or more room on the disk, than there is, and nobody allowed it.
    pub fn begin(&self, asked: &Estimate, out: &Path, report: Report) -> Result<(), RunnerError> {
        self.memory(asked)?;
        if !self.beyond_disk {
            let fits = asked.fits_onto_disk(out);
            fits.map_err(|error| RunnerError::Input(error.to_string()))?;
        }
        report.note(&asked.to_string());
        Ok(())
    }
}
