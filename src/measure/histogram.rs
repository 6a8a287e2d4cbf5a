//! How often values occur: counts over equal parts of their range.
//!
//! In: values. Out: a [`Histogram`] with their mean and spread; what is not finite is passed over.

/// Counts of values in parts of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// Where the first part begins: the smallest value.
    pub low: f64,
    /// Where the last part ends: the largest value.
    pub high: f64,
    /// Values in each part; the largest value is in the last one.
    pub counts: Vec<usize>,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation, of the values themselves: divided by their number.
    pub deviation: f64,
}

impl Histogram {
    /// That of `values` in so many `parts`; none where no value is finite. Where all are the same,
    /// one part holds them.
    pub fn of(values: &[f64], parts: usize) -> Option<Self> {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut number, mut sum) = (0_usize, 0.0);
        for value in finite() {
            (low, high) = (low.min(value), high.max(value));
            (number, sum) = (number + 1, sum + value);
        }
        if number == 0 {
            return None;
        }
        let mean = sum / number as f64;
        let parts = if low < high { parts.max(1) } else { 1 };
        let (mut counts, mut squares) = (vec![0; parts], 0.0);
        for value in finite() {
            let part = (value - low) / (high - low) * parts as f64;
            // Without a width all of them are in the first part; NaN becomes zero.
            counts[(part as usize).min(parts - 1)] += 1;
            squares += (value - mean) * (value - mean);
        }
        Some(Self {
            low,
            high,
            counts,
            mean,
            deviation: (squares / number as f64).sqrt(),
        })
    }

    /// Number of values.
    pub fn total(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Width of a part; zero where all values are the same.
    pub fn width(&self) -> f64 {
        (self.high - self.low) / self.counts.len() as f64
    }

    /// The parts: the middle of each and its count.
    pub fn parts(&self) -> impl Iterator<Item = (f64, usize)> {
        let (low, width) = (self.low, self.width());
        let counts = self.counts.iter().copied().enumerate();
        counts.map(move |(part, count)| (low + (part as f64 + 0.5) * width, count))
    }
}
