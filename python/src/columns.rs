//! Columns of a state as arrays.

use glam::DVec3;
use grainfall::world::{Partner, World};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One number for each row.
fn scalars<T: numpy::Element>(
    py: Python<'_>,
    values: impl IntoIterator<Item = T>,
) -> Bound<'_, PyArray1<T>> {
    PyArray1::from_vec(py, values.into_iter().collect())
}

/// Three numbers for each row.
fn vectors(
    py: Python<'_>,
    values: impl ExactSizeIterator<Item = DVec3>,
) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let count = values.len();
    let flat: Vec<f64> = values.flat_map(|v| v.to_array()).collect();
    PyArray1::from_vec(py, flat).reshape([count, 3])
}

/// The grains of `world`.
pub fn grains<'py>(py: Python<'py>, world: &World) -> PyResult<Bound<'py, PyDict>> {
    let grains = &world.grains;
    let columns = PyDict::new(py);
    let names = world.species.iter().map(|species| species.name.as_str());
    columns.set_item("position", vectors(py, grains.position.iter().copied())?)?;
    columns.set_item("velocity", vectors(py, grains.velocity.iter().copied())?)?;
    columns.set_item("spin", vectors(py, grains.spin.iter().copied())?)?;
    columns.set_item("force", vectors(py, grains.force.iter().copied())?)?;
    columns.set_item("torque", vectors(py, grains.torque.iter().copied())?)?;
    columns.set_item("radius", scalars(py, grains.radius.iter().copied()))?;
    columns.set_item("mass", scalars(py, grains.mass.iter().copied()))?;
    columns.set_item("film", scalars(py, grains.film.iter().copied()))?;
    columns.set_item(
        "contact_count",
        scalars(py, grains.contact_count.iter().copied()),
    )?;
    columns.set_item(
        "species",
        scalars(py, grains.species.iter().map(|species| species.0)),
    )?;
    columns.set_item("species_names", names.collect::<Vec<_>>())?;
    Ok(columns)
}

/// The contacts of `world`: a partner below zero is a wall, −1 the first.
pub fn contacts<'py>(py: Python<'py>, world: &World) -> PyResult<Bound<'py, PyDict>> {
    let contacts = &world.contacts;
    let partner = |partner: Partner| match partner {
        Partner::Grain(i) => i64::from(i),
        Partner::Wall(w) => -1 - i64::from(w),
    };
    let columns = PyDict::new(py);
    columns.set_item(
        "grain",
        scalars(py, contacts.iter().map(|c| i64::from(c.grain))),
    )?;
    columns.set_item(
        "partner",
        scalars(py, contacts.iter().map(|c| partner(c.partner))),
    )?;
    columns.set_item("force", vectors(py, contacts.iter().map(|c| c.force))?)?;
    columns.set_item("spring", vectors(py, contacts.iter().map(|c| c.spring))?)?;
    columns.set_item("touching", scalars(py, contacts.iter().map(|c| c.touching)))?;
    columns.set_item(
        "bridge",
        scalars(py, contacts.iter().map(|c| c.bridge.is_some())),
    )?;
    Ok(columns)
}
