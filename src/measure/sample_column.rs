//! One measure at every sample of a series.
//!
//! In: values, one after the other. Out: all of them as a slice. While they are all the same, to
//! the bit, as in most columns of most scenes, only one of them is kept; who asks for the slice has
//! it made, and it is dropped with the next value.

use std::sync::OnceLock;

/// The values of one measure.
#[derive(Clone, Debug)]
pub enum Column {
    /// So many of the same value; the slice, where somebody asked for it.
    Same(f64, usize, OnceLock<Vec<f64>>),
    /// Values that differ.
    Values(Vec<f64>),
}

impl Default for Column {
    fn default() -> Self {
        Self::same(f64::NAN, 0)
    }
}

impl PartialEq for Column {
    fn eq(&self, other: &Self) -> bool {
        self.values() == other.values()
    }
}

impl From<Vec<f64>> for Column {
    fn from(values: Vec<f64>) -> Self {
        let first = values.first().copied().unwrap_or(f64::NAN);
        let are_same = values.iter().all(|value| is_same(*value, first));
        if are_same {
            Self::same(first, values.len())
        } else {
            Self::Values(values)
        }
    }
}

impl Column {
    fn same(value: f64, count: usize) -> Self {
        Self::Same(value, count, OnceLock::new())
    }

    /// Appends a value.
    pub fn push(&mut self, value: f64) {
        match self {
            Self::Values(values) => values.push(value),
            Self::Same(own, count, _) if *count == 0 || is_same(*own, value) => {
                *self = Self::same(value, *count + 1);
            }
            Self::Same(own, count, _) => {
                let mut values = vec![*own; *count];
                values.push(value);
                *self = Self::Values(values);
            }
        }
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Same(_, count, _) => *count,
            Self::Values(values) => values.len(),
        }
    }

    /// All of them.
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Same(value, count, slice) => slice.get_or_init(|| vec![*value; *count]),
            Self::Values(values) => values,
        }
    }

    /// The value at `index`, which there is.
    pub fn at(&self, index: usize) -> f64 {
        match self {
            Self::Same(value, ..) => *value,
            Self::Values(values) => values[index],
        }
    }

    /// Becomes the first `len` values of `other`.
    pub fn copy_first(&mut self, other: &Self, len: usize) {
        *self = match other {
            Self::Same(value, count, _) => Self::same(*value, len.min(*count)),
            Self::Values(values) => values[..len.min(values.len())].to_vec().into(),
        };
    }

    /// Forgets the first `count` values.
    pub fn forget(&mut self, count: usize) {
        match self {
            Self::Same(value, len, _) => *self = Self::same(*value, len.saturating_sub(count)),
            Self::Values(values) => drop(values.drain(..count.min(values.len()))),
        }
    }

    /// Keeps the first `len` values.
    pub fn truncate(&mut self, len: usize) {
        match self {
            Self::Same(value, count, _) => *self = Self::same(*value, len.min(*count)),
            Self::Values(values) => values.truncate(len),
        }
    }

    /// Memory that the values take [bytes], without room for more.
    pub fn memory(&self) -> usize {
        let kept = match self {
            Self::Same(_, _, slice) => slice.get().map_or(0, Vec::len),
            Self::Values(values) => values.len(),
        };
        kept * size_of::<f64>()
    }
}

/// Whether two numbers are the same, to the bit: a zero below zero is another.
fn is_same(one: f64, other: f64) -> bool {
    one.to_bits() == other.to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_as_they_were_pushed_and_those_that_are_the_same_take_no_room() {
        let mut column = Column::default();
        for _ in 0..1000 {
            column.push(0.0);
        }
        assert_eq!(column.memory(), 0);
        assert_eq!(column.values(), [0.0; 1000]);
        column.push(-0.0);
        assert_eq!((column.len(), column.at(999).to_bits()), (1001, 0));
        assert!(column.at(1000).is_sign_negative() && column.values()[1000].is_sign_negative());
        column.truncate(1000);
        let mut copy = Column::default();
        copy.copy_first(&column, 10);
        assert_eq!((copy.values(), copy.memory()), (&[0.0; 10][..], 80));
        copy.push(0.0);
        assert_eq!((copy.len(), copy.memory()), (11, 0));
    }
}
