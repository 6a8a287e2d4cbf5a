//! What is said on the terminal.
//!
//! In: text. Out: the same on standard output or standard error, control characters written out, as
//! files of others may bring some. Whoever reads may be gone, as behind `| head -1`: then nobody
//! hears it, and nothing else changes.

use grainfall::run::printable;
use std::io::{self, Write};

/// Says `text` and an end of line on standard output: results.
pub fn say(text: &str) {
    put(io::stdout().lock(), text);
}

/// Says `text` and an end of line on standard error: all that is not a result.
pub fn tell(text: &str) {
    put(io::stderr().lock(), text);
}

fn put(mut to: impl Write, text: &str) {
    let said = writeln!(to, "{}", printable(text)).and_then(|()| to.flush());
    // There is nobody left to tell that nobody listens.
    drop(said);
}
