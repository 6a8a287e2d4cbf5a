//! A column: one entry per grain.
//!
//! In: entries, as grains are added. Out: slices to read and to change entry by entry. How many
//! entries there are is the world's own business: nobody else can make a column longer or shorter
//! than the others are.

use serde::{Deserialize, Serialize};
use std::ops::{Deref, DerefMut};

/// One entry per grain, in the order of the grains: a slice that only a world makes longer.
///
/// ```
/// use grainfall::world::Grains;
///
/// let mut grains = Grains::default();
/// # use grainfall::world::SpeciesId;
/// # grains.push_sphere(glam::DVec3::ZERO, 1e-3, 2500.0, SpeciesId(0));
/// grains.velocity[0].x = 0.1;
/// let fastest = grains.velocity.iter().map(|v| v.length()).fold(0.0, f64::max);
/// # assert_eq!(fastest, 0.1);
/// grains.velocity.set(vec![glam::DVec3::ZERO]);
/// # assert_eq!(grains.velocity[0], glam::DVec3::ZERO);
/// ```
///
/// ```compile_fail
/// # use grainfall::world::Grains;
/// let mut grains = Grains::default();
/// grains.radius.push(1e-3); // and its mass?
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct GrainColumn<T>(Vec<T>);

impl<T> GrainColumn<T> {
    /// Puts `entries` in the place of those that are there.
    ///
    /// # Panics
    /// When they are not as many.
    pub fn set(&mut self, entries: Vec<T>) {
        assert_eq!(entries.len(), self.0.len(), "one entry per grain");
        self.0 = entries;
    }

    /// The entry of a grain that is added.
    pub(super) fn push(&mut self, entry: T) {
        self.0.push(entry);
    }

    /// The entries of grains that are there already.
    pub(super) fn of(entries: Vec<T>) -> Self {
        Self(entries)
    }
}

impl<T> Default for GrainColumn<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Deref for GrainColumn<T> {
    type Target = [T];

    #[inline]
    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> DerefMut for GrainColumn<T> {
    #[inline]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.0
    }
}

impl<'a, T> IntoIterator for &'a GrainColumn<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a, T> IntoIterator for &'a mut GrainColumn<T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}
