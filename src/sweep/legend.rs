//! Where the legend of a plot hides nothing.
//!
//! In: the names that it lists and where points and curves lie, in shares of the plot's area. Out: a
//! corner of it, or a place beside it.

use plotters::prelude::SeriesLabelPosition;

/// Height of a line of text, and width of a letter on the mean, in pixels.
pub const LINE: f64 = 18.5;
const LETTER: f64 = 7.0;
/// What a legend takes beside its text, across and upright, in pixels.
const BESIDE: (f64, f64) = (56.0, 24.0);

/// Corners in the order in which they are liked: to the right, above.
const CORNERS: [(bool, bool); 4] = [(true, true), (false, true), (true, false), (false, false)];

/// How large a legend is.
#[derive(Clone, Copy, Debug)]
pub struct Legend {
    /// Its width in pixels.
    pub width: f64,
    /// Its width and height as shares of the area between the axes.
    shares: (f64, f64),
}

impl Legend {
    /// That of lines with these names, on an area of so many pixels.
    pub fn of<'a>(names: impl Iterator<Item = &'a str>, (width, height): (f64, f64)) -> Self {
        let names: Vec<usize> = names.map(|name| name.chars().count()).collect();
        let longest = names.iter().max().copied().unwrap_or(0);
        let own = BESIDE.0 + LETTER * longest as f64;
        let upright = BESIDE.1 + LINE * names.len() as f64;
        Self {
            width: own,
            shares: (own / width, upright / height),
        }
    }

    /// The corner in which it hides no point, and as little as may be of the curves; none where it would
    /// hide points in each: it belongs beside the area then.
    pub fn corner(
        self,
        points: &[(f64, f64)],
        curves: &[(f64, f64)],
    ) -> Option<SeriesLabelPosition> {
        let hidden = |corner, places: &[(f64, f64)]| {
            let hidden = places.iter().filter(|place| self.hides(corner, **place));
            hidden.count()
        };
        let free = CORNERS.into_iter().filter(|own| hidden(*own, points) == 0);
        free.min_by_key(|own| hidden(*own, curves)).map(position)
    }

    fn hides(self, (right, upper): (bool, bool), (x, y): (f64, f64)) -> bool {
        let from_side = if right { 1.0 - x } else { x };
        let from_end = if upper { 1.0 - y } else { y };
        from_side < self.shares.0 && from_end < self.shares.1
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
        width: 165.0,
        shares: (0.25, 0.2),
    };

    #[test]
    fn a_legend_hides_no_point_and_few_curves() {
        let place = |points: &[(f64, f64)], curves: &[(f64, f64)]| {
            let corner = LEGEND.corner(points, curves);
            corner.map_or("beside".to_owned(), |corner| format!("{corner:?}"))
        };
        assert_eq!(place(&[], &[]), "UpperRight");
        let right = (0.9, 0.9);
        assert_eq!(place(&[right], &[]), "UpperLeft");
        // Beside it, not under it.
        assert_eq!(place(&[(0.7, 0.9)], &[]), "UpperRight");
        let upper = [right, (0.1, 0.85)];
        assert_eq!(place(&upper, &[]), "LowerRight");
        let crossed = [(0.9, 0.1), (0.85, 0.15)];
        assert_eq!(place(&upper, &crossed), "LowerLeft");
        let all = [right, (0.1, 0.85), (0.9, 0.1), (0.1, 0.1)];
        assert_eq!(place(&all, &[]), "beside");
    }

    #[test]
    fn a_legend_grows_with_its_names() {
        let of = |names: &[&str]| Legend::of(names.iter().copied(), (660.0, 420.0));
        let (short, long) = (of(&["a"]), of(&["a", "r = 3 mm, bridge-law=as-printed"]));
        assert!(long.width > 2.0 * short.width && long.shares.1 > short.shares.1);
        assert!(long.shares.0 < 0.5, "{long:?}");
    }
}
