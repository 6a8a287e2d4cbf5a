//! Where the legend of a plot hides nothing.
//!
//! In: the names that it lists and where points and curves lie, in shares of the plot's area. Out: a
//! corner, and by how much the area has to grow upwards for it.

use plotters::prelude::SeriesLabelPosition;

/// Height of a line of text, and width of a letter on the mean, in pixels.
const LINE: f64 = 18.5;
const LETTER: f64 = 7.5;
/// What a legend takes beside its text, across and upright, in pixels.
const BESIDE: (f64, f64) = (56.0, 24.0);

/// Corners in the order in which they are liked: to the right, above.
const CORNERS: [(bool, bool); 4] = [(true, true), (false, true), (true, false), (false, false)];

/// How much of the area a legend takes.
#[derive(Clone, Copy, Debug)]
pub struct Legend {
    across: f64,
    upright: f64,
}

/// Where it stands.
pub struct LegendPlace {
    /// The corner.
    pub corner: SeriesLabelPosition,
    /// By which factor the area grows upwards, so that nothing is hidden: 1 where some corner is free.
    pub growth: f64,
}

impl Legend {
    /// That of lines with these names, on an area of so many pixels.
    pub fn of<'a>(names: impl Iterator<Item = &'a str>, (width, height): (f64, f64)) -> Self {
        let names: Vec<usize> = names.map(|name| name.chars().count()).collect();
        let longest = names.iter().max().copied().unwrap_or(0);
        Self {
            across: (BESIDE.0 + LETTER * longest as f64) / width,
            upright: (BESIDE.1 + LINE * names.len() as f64) / height,
        }
    }

    /// The corner in which it hides no point, and as little as may be of the curves; where there is none,
    /// one above all points.
    pub fn place(self, points: &[(f64, f64)], curves: &[(f64, f64)]) -> LegendPlace {
        let hidden = |corner, places: &[(f64, f64)]| {
            let hidden = places.iter().filter(|place| self.hides(corner, **place));
            hidden.count()
        };
        let free = CORNERS.into_iter().filter(|own| hidden(*own, points) == 0);
        match free.min_by_key(|own| hidden(*own, curves)) {
            Some(corner) => LegendPlace {
                corner: position(corner),
                growth: 1.0,
            },
            None => LegendPlace {
                corner: SeriesLabelPosition::UpperRight,
                growth: 1.0 / (1.0 - self.upright.min(0.5)),
            },
        }
    }

    fn hides(self, (right, upper): (bool, bool), (x, y): (f64, f64)) -> bool {
        let from_side = if right { 1.0 - x } else { x };
        let from_end = if upper { 1.0 - y } else { y };
        from_side < self.across && from_end < self.upright
    }
}

fn position(corner: (bool, bool)) -> SeriesLabelPosition {
    match corner {
        (true, true) => SeriesLabelPosition::UpperRight,
        (false, true) => SeriesLabelPosition::UpperLeft,
        (true, false) => SeriesLabelPosition::LowerRight,
        (false, false) => SeriesLabelPosition::LowerLeft,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A legend of a quarter of the width and a fifth of the height.
    const LEGEND: Legend = Legend {
        across: 0.25,
        upright: 0.2,
    };

    #[test]
    fn a_legend_hides_no_point_and_few_curves() {
        let place = |points: &[(f64, f64)], curves: &[(f64, f64)]| {
            let place = LEGEND.place(points, curves);
            (format!("{:?}", place.corner), place.growth)
        };
        assert_eq!(place(&[], &[]), ("UpperRight".into(), 1.0));
        let right = (0.9, 0.9);
        assert_eq!(place(&[right], &[]), ("UpperLeft".into(), 1.0));
        // Beside it, not under it.
        assert_eq!(place(&[(0.7, 0.9)], &[]), ("UpperRight".into(), 1.0));
        let upper = [right, (0.1, 0.85)];
        assert_eq!(place(&upper, &[]), ("LowerRight".into(), 1.0));
        let crossed = [(0.9, 0.1), (0.85, 0.15)];
        assert_eq!(place(&upper, &crossed), ("LowerLeft".into(), 1.0));
        // All four corners are taken: it stands above them, on a fifth of the grown area.
        let all = [right, (0.1, 0.85), (0.9, 0.1), (0.1, 0.1)];
        let (corner, growth) = place(&all, &[]);
        assert_eq!(corner, "UpperRight");
        assert!((growth * 0.8 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_legend_grows_with_its_names() {
        let of = |names: &[&str]| Legend::of(names.iter().copied(), (660.0, 420.0));
        let (short, long) = (of(&["a"]), of(&["a", "r = 3 mm, bridge-law=as-printed"]));
        assert!(long.across > 2.0 * short.across && long.upright > short.upright);
        assert!(long.across < 0.5, "{long:?}");
    }
}
