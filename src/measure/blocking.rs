//! The standard error of a time average, from the series itself.
//!
//! In: samples that lie evenly in time. Out: their mean as an [`Estimate`].
//!
//! Samples that follow one another are alike, so `s/√N` of all of them is far too small. Blocking
//! (H. Flyvbjerg and H. G. Petersen, J. Chem. Phys. 91, 461, 1989) averages over blocks of `B`
//! samples: `S(B) = B · variance of the block means` grows with `B` until blocks are independent of
//! each other, and the error of the mean is `√(S/N)`. Three choices make it automatic:
//!
//! - The block is the shortest of 1, 2, 3, 4, 6, 8, 12 … samples with `B³ > 2 N (S(B)/S(1))²`,
//!   where what longer blocks would still add is smaller than their own noise (U. Wolff, Comput.
//!   Phys. Commun. 156, 143, 2004; as a rule for blocks: R. M. Lee et al., Phys. Rev. E 83, 066706,
//!   2011), but none so long that fewer than [`FEWEST_BLOCKS`] remain.
//! - Blocks overlap, one begins at every eighth of a block (M. S. Meketon and B. Schmeiser, Proc.
//!   Winter Simulation Conf., 1984): the noise of `S` is a third less.
//! - What correlations longer than a block leave out is added once more, as far as half a block
//!   shows it: `S(B) + (S(B) − S(B/2))`, where that is more.
//!
//! The series is worth `N S(1)/S` independent samples. Below [`FEWEST_SAMPLES`] its own correlation
//! cannot be told from it, and no error is stated.
//!
//! No kept Rust crate does this (crates.io has general statistics, none with blocking), and how
//! errors are taken is part of the measure.

use super::estimate::{Estimate, variance};

/// Fewest blocks whose spread is looked at.
const FEWEST_BLOCKS: usize = 8;
/// Blocks that begin within the length of one.
const STARTS: usize = 8;
/// The shortest block that passes the rule in a series of so many samples that eight of them fit.
/// In fewer samples independence cannot be seen.
const SHORTEST_BLOCK: usize = 6;
/// Fewest independent samples for which an error is stated. On series of known answer the truth
/// lies within one stated error in 68 ± 3 of 100 cases from 30 independent samples on, in 64 at 25
/// and in 61 at 13.
const FEWEST_SAMPLES: usize = 10;

/// The mean of the finite ones of `samples`, which lie evenly in time, with its standard error.
pub fn time_average(samples: &[f64]) -> Estimate {
    let finite: Vec<f64> = (samples.iter().copied())
        .filter(|value| value.is_finite())
        .collect();
    let count = finite.len();
    let mean = finite.iter().sum::<f64>() / count as f64;
    if count < FEWEST_BLOCKS * SHORTEST_BLOCK {
        return Estimate::too_short(mean, (count / SHORTEST_BLOCK).max(count.min(1)));
    }
    if finite.iter().all(|value| *value == finite[0]) {
        return Estimate {
            mean: finite[0],
            error: Some(0.0),
            samples: count,
            freedom: count - 1,
        };
    }
    let single = variance(&finite, mean);
    let sums = sums_about(&finite, mean);
    let (block, inefficient) = chosen_block(&sums, single);
    let independent = (count as f64 * single / inefficient).min(count as f64);
    let samples = independent as usize;
    if samples < FEWEST_SAMPLES {
        return Estimate::too_short(mean, samples);
    }
    Estimate {
        mean,
        error: Some((inefficient / count as f64).sqrt()),
        samples,
        freedom: count / block - 1,
    }
}

/// The block's length and `S` of it, for the running `sums` of a series whose samples have the
/// variance `single`.
fn chosen_block(sums: &[f64], single: f64) -> (usize, f64) {
    let count = sums.len() - 1;
    let mut chosen = (1, single);
    for block in lengths().take_while(|block| block * FEWEST_BLOCKS <= count) {
        let spread = block_spread(sums, block);
        chosen = (block, spread);
        let (length, ratio) = (block as f64, spread / single);
        if length * length * length > 2.0 * count as f64 * ratio * ratio {
            break;
        }
    }
    let (block, spread) = chosen;
    let of_half = block_spread(sums, block.div_ceil(2));
    (block, spread + (spread - of_half).max(0.0))
}

/// 1, 2, 3, 4, 6, 8, 12, 16 …
fn lengths() -> impl Iterator<Item = usize> {
    let doubled = (1..usize::BITS - 2).map(|power| 1_usize << power);
    std::iter::once(1).chain(doubled.flat_map(|length| [length, length / 2 * 3]))
}

/// `S(B)`: `block` times the variance of the means over all blocks of so many samples, given the
/// running `sums` of the samples' distances from their mean.
fn block_spread(sums: &[f64], block: usize) -> f64 {
    let count = (sums.len() - 1) as f64;
    let length = block as f64;
    let (mut squares, mut blocks) = (0.0, 0.0);
    for (from, to) in sums
        .iter()
        .zip(&sums[block..])
        .step_by((block / STARTS).max(1))
    {
        squares += (to - from) * (to - from);
        blocks += 1.0;
    }
    // The distances are from the mean of the same samples, which takes a share of the spread.
    squares / (blocks * length * (1.0 - length / count))
}

/// Running sums of the distances of `values` from `mean`, from zero on.
fn sums_about(values: &[f64], mean: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let following = values.iter().map(|value| {
        sum += value - mean;
        sum
    });
    std::iter::once(0.0).chain(following).collect()
}
