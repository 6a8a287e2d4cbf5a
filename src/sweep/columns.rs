//! The columns of a sweep, as the statements of Man et al. 2023 compare them.
//!
//! In: ensembles of cases, and which of several measures count. Out: columns of polyhedra in the
//! order of their effective aspect ratio, and each result of one with its error.

use super::ensemble::Ensemble;
use crate::measure::{Estimate, Measure, ResultKey, RunQuantity, Summary};
use crate::scene::{SceneContainer, SceneGrains};

/// Degrees of freedom by which the scatter that a single column is given is known, at least.
const SCATTER_FREEDOM: usize = 6;
/// Solid fraction between the paper's two, 0.8 and 0.55, below which a column counts as loose.
const LOOSE: f64 = 0.675;

/// Which of several measures stand for the front at rest, `R_∞`, and for the time of rest, `t_f`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColumnMeasure {
    /// The mean of the outermost grains of 72 sectors; energy and front together.
    #[default]
    Usual,
    /// This radius at the end.
    Front(Measure),
    /// This time.
    Rest(RunQuantity),
}

impl ColumnMeasure {
    /// The result `key` of a column, as a mean over its runs.
    fn estimate(self, key: ResultKey, ensemble: &Ensemble) -> Option<Estimate> {
        if self == Self::Usual {
            return ensemble.estimate(key);
        }
        let [radius, _] = size_of(ensemble)?;
        let runs = ensemble.members.iter();
        let values = runs.filter_map(|run| self.value(key, &run.results, radius));
        let values: Vec<f64> = values.collect();
        (!values.is_empty()).then(|| Estimate::of_runs(&values))
    }

    /// The result `key` of one run of a column of this `radius` [m] at the start.
    fn value(self, key: ResultKey, results: &Summary, radius: f64) -> Option<f64> {
        let own = results.value(key);
        let ResultKey::OfRun(quantity) = key else {
            return own;
        };
        let front = |measure: Measure| results.value(measure);
        let of_run = |quantity: RunQuantity| results.value(quantity);
        match (self, quantity) {
            (Self::Front(measure), RunQuantity::FinalFront) => front(measure),
            (Self::Front(measure), RunQuantity::RunOut) => Some(front(measure)? / radius - 1.0),
            (Self::Front(measure), RunQuantity::RelativeConeVolume) => {
                let ratio = front(measure)? / of_run(RunQuantity::FinalFront)?;
                Some(own? * ratio * ratio)
            }
            (Self::Rest(time), RunQuantity::RestTime) => of_run(time),
            (Self::Rest(time), RunQuantity::DimensionlessRestTime) => {
                let unit =
                    of_run(RunQuantity::PeakTime)? / of_run(RunQuantity::DimensionlessPeakTime)?;
                Some(of_run(time)? / unit)
            }
            _ => own,
        }
    }
}

/// A column of polyhedra.
#[derive(Clone)]
pub struct Column<'a> {
    /// Height at the start [mm].
    pub height: f64,
    /// Solid fraction `φ_i` at the start.
    pub solid: f64,
    /// Share by number of the rough grains.
    pub share: f64,
    /// Effective aspect ratio.
    pub effective: f64,
    /// Its runs.
    pub ensemble: &'a Ensemble<'a>,
    /// By which measures.
    measured_by: ColumnMeasure,
    /// Those among which the ones like it are looked for.
    all: &'a [&'a Ensemble<'a>],
}

/// All columns, in the order of their effective aspect ratio.
pub struct Columns<'a>(pub Vec<Column<'a>>);

impl<'a> Columns<'a> {
    /// The columns of polyhedra among `ensembles`, judged by these measures. What one run scatters
    /// by is looked for in `all`.
    pub fn of(
        ensembles: impl IntoIterator<Item = &'a Ensemble<'a>>,
        all: &'a [&'a Ensemble<'a>],
        measured_by: ColumnMeasure,
    ) -> Self {
        let column = |ensemble: &'a Ensemble<'a>| {
            let SceneGrains::Voronoi(cells) = &ensemble.first().case.scene.grains else {
                return None;
            };
            let [_, height] = size_of(ensemble)?;
            Some(Column {
                height: 1e3 * height,
                solid: cells.solid_fraction,
                share: cells.species.get(1).map_or(0.0, |kind| kind.share),
                effective: ensemble.mean(RunQuantity::EffectiveAspectRatio)?,
                ensemble,
                measured_by,
                all,
            })
        };
        let mut columns: Vec<Column> = ensembles.into_iter().filter_map(column).collect();
        columns.sort_by(|a, b| a.effective.total_cmp(&b.effective));
        Self(columns)
    }

    /// Columns that are alike in `key`, two at least, in the order of their aspect ratio.
    pub fn alike(&self, key: impl Fn(&Column) -> String) -> Vec<Vec<&Column<'a>>> {
        let mut groups: Vec<(String, Vec<&Column>)> = Vec::new();
        for column in &self.0 {
            let key = key(column);
            match groups.iter_mut().find(|(known, _)| *known == key) {
                Some((_, group)) => group.push(column),
                None => groups.push((key, vec![column])),
            }
        }
        let groups = groups.into_iter().map(|(_, group)| group);
        groups.filter(|group| group.len() > 1).collect()
    }
}

impl Column<'_> {
    /// A result. One column alone says nothing of its error: it is given the relative scatter of
    /// the columns of several seeds that are nearest to it in height, for low columns scatter more.
    pub fn get(&self, key: impl Into<ResultKey>) -> Option<Estimate> {
        let key = key.into();
        let own = self.measured_by.estimate(key, self.ensemble)?;
        Some(if own.error.is_some() {
            own
        } else {
            own.scattering_as(self.nearest_in_height(key))
        })
    }

    /// A result of the columns of several seeds that are nearest to it in height.
    fn nearest_in_height(&self, key: ResultKey) -> Vec<Estimate> {
        let result = |other: &&Ensemble| {
            let own = self.measured_by.estimate(key, other)?;
            let [_, height] = size_of(other)?;
            let distance = (1e3 * height / self.height).ln().abs();
            own.error.is_some().then_some((distance, own))
        };
        nearest(self.all.iter().filter_map(result).collect())
    }

    /// `H = 50 mm, 30 % of rough grains, φ_i 0.55, one seed`.
    pub fn place(&self) -> String {
        let seeds = if self.ensemble.members.len() == 1 {
            ", one seed"
        } else {
            ""
        };
        let solid = if self.is_loose() {
            format!(", φ_i {}", rounded(self.solid))
        } else {
            String::new()
        };
        format!(
            "H = {} mm, {} % of rough grains{}{solid}{seeds}",
            rounded(self.height),
            rounded(100.0 * self.share),
            self.friction()
        )
    }

    /// What sets it apart from columns of other frictions.
    pub fn friction(&self) -> String {
        (self.ensemble).apart_from(&["height", "mix", "solid-fraction"])
    }

    /// Whether it is packed as loosely as the paper's looser ones.
    pub fn is_loose(&self) -> bool {
        self.solid < LOOSE
    }

    /// Whether it differs from the `other` in its solid fraction alone.
    pub fn is_like(&self, other: &Self) -> bool {
        let of = |own: &Self| (own.height, own.share, own.friction());
        of(self) == of(other)
    }
}

/// Of results, each with how far off its column is, those of the nearest columns: distance by
/// distance, until their scatter is known by [`SCATTER_FREEDOM`].
fn nearest(mut results: Vec<(f64, Estimate)>) -> Vec<Estimate> {
    results.sort_by(|a, b| a.0.total_cmp(&b.0));
    let distances = results.chunk_by(|a, b| a.0 == b.0);
    let counted = distances.scan(0, |freedom, alike| {
        let is_wanted = *freedom < SCATTER_FREEDOM;
        *freedom += alike.iter().map(|(_, own)| own.freedom).sum::<usize>();
        is_wanted.then_some(alike)
    });
    counted.flatten().map(|(_, own)| *own).collect()
}

/// Radius and height [m] of a column at the start; none of anything else.
fn size_of(ensemble: &Ensemble) -> Option<[f64; 2]> {
    match ensemble.first().case.scene.container {
        SceneContainer::Column { radius, height, .. } => Some([radius, height]),
        _ => None,
    }
}

/// Rounded, so that a unit's factor leaves no digits behind.
pub fn rounded(value: f64) -> String {
    ((value * 1e6).round() / 1e6).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_that_of_the_nearest_columns_by_which_it_is_known() {
        let of = |distance: f64, mean: f64, runs: usize| {
            let values: Vec<f64> = (0..runs).map(|run| mean + run as f64).collect();
            (distance, Estimate::of_runs(&values))
        };
        // 2 degrees of freedom at its own height, 2 more at each of three columns of the next.
        let far = [of(1.6, 100.0, 3), of(1.6, 110.0, 3)];
        let next = [of(0.7, 50.0, 3), of(0.7, 60.0, 3), of(0.7, 70.0, 3)];
        let own = [of(0.0, 10.0, 3)];
        let all = |parts: &[&[(f64, Estimate)]]| nearest(parts.concat());
        let means =
            |found: Vec<Estimate>| -> Vec<f64> { found.iter().map(|own| own.mean).collect() };
        assert_eq!(means(all(&[&far, &next, &own])), [11.0, 51.0, 61.0, 71.0]);
        assert_eq!(means(all(&[&far, &own])), [11.0, 101.0, 111.0]);
        assert_eq!(means(all(&[&next, &[of(0.0, 10.0, 7)]])), [13.0]);
        assert_eq!(means(nearest(Vec::new())), [] as [f64; 0]);
    }
}
