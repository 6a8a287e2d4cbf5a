//! Grainfall's library for Python: a scene is opened and changed, run for a while, and read as numpy arrays.
//!
//! In: names of scenes, files or texts, values as `--set` has them. Out: columns of samples, grains and contacts in SI units, and the
//! results with their errors. The same run gives the same bits here as in the program.

// What pyo3 makes of the functions below takes values that it hands over.
#![allow(clippy::needless_pass_by_value)]

mod columns;
mod run;
mod scene;

use pyo3::prelude::*;

/// A laboratory for granular matter: scenes, a discrete element solver and its measures as numpy arrays.
#[pymodule]
mod grainfall {
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::scene::{Scene, scenes};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

/// An error for whoever calls, in the library's own words.
fn refused(error: impl std::error::Error) -> PyErr {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    pyo3::exceptions::PyValueError::new_err(text)
}
