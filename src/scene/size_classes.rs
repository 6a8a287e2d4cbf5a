//! How many grains of each kind a filling has.
//!
//! In: the number of grains and the species with their shares. Out: whole numbers that add up,
//! grouped by radius: species that share one radius can change places while a run goes on, so their
//! grains are placed as one class.

use super::SceneSpecies;

/// The grains of one radius in a filling.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeClass {
    /// Radius [m].
    pub radius: f64,
    /// Grains in all.
    pub count: usize,
    /// Index of each of its species in the scene, and its grains.
    pub species: Vec<(usize, usize)>,
}

/// The `count` grains of `species` by radius, in the order in which the radii first occur.
pub fn size_classes(count: usize, species: &[SceneSpecies]) -> Vec<SizeClass> {
    let mut members: Vec<Vec<usize>> = Vec::new();
    for (index, kind) in species.iter().enumerate() {
        match members
            .iter_mut()
            .find(|class| species[class[0]].radius == kind.radius)
        {
            Some(class) => class.push(index),
            None => members.push(vec![index]),
        }
    }
    let shares: Vec<f64> = members
        .iter()
        .map(|class| class.iter().map(|&i| species[i].share).sum())
        .collect();
    let totals = apportion(count, &shares);
    members
        .into_iter()
        .zip(totals)
        .map(|(class, total)| {
            let shares: Vec<f64> = class.iter().map(|&i| species[i].share).collect();
            SizeClass {
                radius: species[class[0]].radius,
                count: total,
                species: class.into_iter().zip(apportion(total, &shares)).collect(),
            }
        })
        .collect()
}

/// The `count` grains of the species with these shares: the index of each and its grains.
pub fn species_counts(count: usize, shares: &[f64]) -> Vec<(usize, usize)> {
    apportion(count, shares).into_iter().enumerate().collect()
}

/// `total` split in proportion to `shares` by the method of the largest remainder; the first wins a
/// tie.
fn apportion(total: usize, shares: &[f64]) -> Vec<usize> {
    let sum: f64 = shares.iter().sum();
    if sum <= 0.0 {
        let mut all_to_the_first = vec![0; shares.len()];
        if let Some(first) = all_to_the_first.first_mut() {
            *first = total;
        }
        return all_to_the_first;
    }
    // Quotas are rounded to a billionth so that 0.7 · 10 is 7 and ties are ties.
    let quotas: Vec<f64> = shares
        .iter()
        .map(|share| (share / sum * total as f64 * 1e9).round() / 1e9)
        .collect();
    let mut counts: Vec<usize> = quotas.iter().map(|quota| quota.floor() as usize).collect();
    let mut by_remainder: Vec<usize> = (0..shares.len()).collect();
    by_remainder.sort_by(|&a, &b| {
        let remainder = |i: usize| quotas[i] - quotas[i].floor();
        remainder(b).total_cmp(&remainder(a))
    });
    let missing = total.saturating_sub(counts.iter().sum());
    for &index in by_remainder.iter().cycle().take(missing) {
        counts[index] += 1;
    }
    counts
}
