//! Who of several workers gets which part of a slice.
//!
//! In: numbers of items and workers, or ranges given worker by worker. Out: the ranges, and slices
//! cut into them, each an ordinary `&mut` that only its worker holds. Nothing here is unsafe: what
//! workers write in one phase and read in the other is [`super::workers::Column`]'s business.
//!
//! A worker's ranges are the same for all rows that go by one index (its grains, its pairs), and
//! they hold for one batch: lists that are made anew may share the work out anew.

use std::ops::Range;

/// The range of `count` items that is `worker`'s, of `size` workers.
pub fn range_of(count: usize, worker: usize, size: usize) -> Range<usize> {
    count * worker / size..count * (worker + 1) / size
}

/// All ranges with the workers they belong to, from the lowest to the highest.
pub fn in_order(ranges: &[Vec<Range<usize>>]) -> Vec<(Range<usize>, usize)> {
    let of_worker = |(worker, own): (usize, &Vec<Range<usize>>)| {
        let own: Vec<_> = own.iter().map(|range| (range.clone(), worker)).collect();
        own
    };
    let mut all: Vec<_> = ranges.iter().enumerate().flat_map(of_worker).collect();
    all.sort_by_key(|(range, _)| (range.start, range.end));
    all
}

/// Cuts `slice` into the workers' own `ranges`, given worker by worker.
///
/// # Panics
/// When ranges overlap or do not lie within the slice.
pub fn split<'a, T>(
    mut slice: &'a mut [T],
    ranges: impl IntoIterator<Item = Vec<Range<usize>>>,
) -> Vec<Vec<&'a mut [T]>> {
    let ranges: Vec<Vec<Range<usize>>> = ranges.into_iter().collect();
    let mut parts: Vec<Vec<&'a mut [T]>> = ranges.iter().map(|_| Vec::new()).collect();
    let mut begin = 0;
    for (range, worker) in in_order(&ranges) {
        let (part, rest) = slice[range.start - begin..].split_at_mut(range.len());
        parts[worker].push(part);
        (slice, begin) = (rest, range.end);
    }
    parts
}

/// Cuts `slice` into one range for each worker: see [`split`].
pub fn split_once<T>(
    slice: &mut [T],
    ranges: impl Iterator<Item = Range<usize>>,
) -> impl Iterator<Item = &mut [T]> {
    let parts = split(slice, ranges.map(|range| vec![range]));
    parts.into_iter().filter_map(|part| part.into_iter().next())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slice_is_cut_into_the_ranges_of_each_worker() {
        let mut numbers: Vec<usize> = (0..10).collect();
        let parts = split(&mut numbers, [vec![0..2, 7..10], vec![2..2, 3..7]]);
        assert_eq!(parts[0], [&[0, 1][..], &[7, 8, 9]]);
        assert_eq!(parts[1], [&[][..], &[3, 4, 5, 6]]);
    }
}
