//! The free surface as a straight line in the x–y plane: its angle θ and its roughness h.
//!
//! The middle part of the free surface (its chord between the container's walls) is cut into as
//! many bins as fit if none is narrower than two mean radii, so that a closed row of grains leaves
//! no bin empty; in each bin the grain that reaches highest is taken, over the whole depth along z,
//! and a straight line is fitted through the centres of these grains by least squares. Bins and
//! heights are measured along and across the line itself: the fit is repeated in the frame of the
//! last line until the line no longer moves, so a steep surface is measured as well as a level one.
//! Only grains that touch something count, unless none does, so a single grain in flight does not
//! lift the surface; two that meet in flight can, for the moment of their impact.
//!
//! Where a container is a mesh, its walls are met by a ray from within the bed, at the depth of the
//! bed's middle: what stands in the chamber at other depths does not count.
//!
//! There is no surface line without a drum, a box or a mesh, or with fewer than three bins that hold a
//! grain.

use crate::world::{Container, Grains, Shape, World};
use glam::{DVec2, DVec3};

/// Bins of a surface at most: a large container with a few small grains takes no memory.
const MOST_BINS: f64 = 1e5;
/// Share of the free surface, about its middle, through which the line is fitted.
pub const MIDDLE_SHARE: f64 = 0.7;

/// Fits of the line at most.
const MOST_FITS: i32 = 14;

/// Fits that the line follows the whole way; it follows each later one half as far as the one
/// before.
const FREE_FITS: i32 = 6;

/// A line that turns by less than this [rad], and shifts by less than this share of its length,
/// from one fit to the next is final.
const SETTLED: f64 = 1e-6;

/// A straight line through the top grains' centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceLine {
    /// Angle θ from the x axis, positive where the surface rises to the right [rad].
    pub angle: f64,
    /// Middle of the fitted part [m].
    pub midpoint: DVec2,
    /// Unit vector along the line, to the right where the bed lies below.
    pub direction: DVec2,
    /// Half the length of the fitted part [m].
    pub half_length: f64,
    /// Mean distance h of the top grains' centres from the line (Eq. 24 of Kasper et al. 2021) [m].
    pub roughness: f64,
    /// Curvature of the parabola through the same centres, positive where the surface is convex
    /// [1/m].
    pub curvature: f64,
    /// Bins that held a grain.
    pub bins: usize,
}

impl SurfaceLine {
    /// Unit normal of the line, out of the bed.
    pub fn normal(&self) -> DVec2 {
        self.direction.perp()
    }

    /// Height of `point` above the line, negative inside the bed [m].
    pub fn height(&self, point: DVec2) -> f64 {
        (point - self.midpoint).dot(self.normal())
    }
}

/// The line through the free surface of `world`, fitted over the `middle_share` (0 … 1, usually
/// [`MIDDLE_SHARE`]) of its length.
pub fn surface_line(world: &World, middle_share: f64) -> Option<SurfaceLine> {
    let container = &world.container;
    let grains = Silhouette::of(&world.grains)?;
    let mut guess = first_guess(container.shape, &grains)?;
    let mut line = None;
    for done in 0..MOST_FITS {
        let (low, high) = chord(container, guess, &grains)?;
        let middle = FittedPart {
            centre: 0.5 * (low + high),
            half_length: 0.5 * (high - low) * middle_share,
        };
        let tops = grains.tops(guess, middle);
        let fit = Fit::through(&tops)?;
        let fitted = fit.turned(guess);
        let shift = (fitted.height - guess.height).abs() / (high - low);
        // Two lines can each make the other by moving one grain over the edge of a bin; the
        // shrinking steps end between.
        guess = guess.towards(fitted, 0.5_f64.powi((done + 1 - FREE_FITS).max(0)));
        line = Some(fit.line(guess, middle, &tops));
        if fit.slope.abs() < SETTLED && shift < SETTLED {
            break;
        }
    }
    line
}

/// Mean radius of the grains [m]; NaN without grains.
pub(super) fn mean_radius(grains: &Grains) -> f64 {
    grains.radius.iter().sum::<f64>() / grains.len() as f64
}

/// A straight line by its angle and its signed distance from the origin, and the frame that goes
/// with it: `s` along the line, `n` out of the bed, both from the origin.
#[derive(Clone, Copy)]
struct Guess {
    direction: DVec2,
    height: f64,
}

impl Guess {
    fn at_angle(angle: f64, height: f64) -> Self {
        Self {
            direction: DVec2::from_angle(angle),
            height,
        }
    }

    fn normal(self) -> DVec2 {
        self.direction.perp()
    }

    /// The line that lies `share` of the way from this one to `other`.
    fn towards(self, other: Self, share: f64) -> Self {
        Self {
            direction: self.direction.lerp(other.direction, share).normalize(),
            height: self.height + share * (other.height - self.height),
        }
    }

    fn point(self, s: f64) -> DVec2 {
        self.direction * s + self.normal() * self.height
    }
}

/// A part of a line, in its own coordinate `s` [m].
#[derive(Clone, Copy)]
struct FittedPart {
    centre: f64,
    half_length: f64,
}

/// The grains as discs in the x–y plane.
struct Silhouette {
    discs: Vec<(DVec2, f64)>,
    mean_radius: f64,
    /// Mean of the centres' z [m].
    mean_depth: f64,
}

impl Silhouette {
    fn of(grains: &Grains) -> Option<Self> {
        let touching = |i: &usize| grains.contact_count[*i] > 0;
        let disc = |i: usize| (grains.position[i].truncate(), grains.radius[i]);
        let mut discs: Vec<_> = (0..grains.len()).filter(touching).map(disc).collect();
        if discs.is_empty() {
            discs = (0..grains.len()).map(disc).collect();
        }
        (!discs.is_empty()).then(|| Self {
            discs,
            mean_radius: mean_radius(grains),
            mean_depth: grains.position.iter().map(|x| x.z).sum::<f64>() / grains.len() as f64,
        })
    }

    fn mean_position(&self) -> DVec2 {
        self.discs.iter().map(|(centre, _)| *centre).sum::<DVec2>() / self.discs.len() as f64
    }

    /// Centres, as (s, n) in the frame of `guess`, of the highest disc in each bin of `middle` that
    /// holds one.
    fn tops(&self, guess: Guess, middle: FittedPart) -> Vec<DVec2> {
        let length = 2.0 * middle.half_length;
        let bins = (length / (2.0 * self.mean_radius))
            .floor()
            .clamp(1.0, MOST_BINS);
        let start = middle.centre - middle.half_length;
        let mut highest = vec![f64::NEG_INFINITY; bins as usize];
        let mut tops = vec![DVec2::NAN; bins as usize];
        for &(centre, radius) in &self.discs {
            let own = DVec2::new(centre.dot(guess.direction), centre.dot(guess.normal()));
            let bin = ((own.x - start) / length * bins).floor();
            if bin >= 0.0 && bin < bins && own.y + radius > highest[bin as usize] {
                highest[bin as usize] = own.y + radius;
                tops[bin as usize] = own;
            }
        }
        tops.retain(|top| !top.is_nan());
        tops
    }
}

/// Where to begin: in a drum, the centre of mass lies straight below the middle of a level surface
/// in the bed's own frame, so its direction tells the angle; in a box or a mesh, a level surface.
fn first_guess(shape: Shape, grains: &Silhouette) -> Option<Guess> {
    let mean = grains.mean_position();
    match shape {
        Shape::Planes | Shape::Column { .. } => None,
        Shape::Box { .. } | Shape::Mesh { .. } => Some(Guess::at_angle(0.0, mean.y)),
        Shape::Drum { .. } => Some(Guess::at_angle(f64::atan2(mean.x, -mean.y), -mean.length())),
    }
}

/// Between which `s` the line runs inside the container, seen along z.
fn chord(container: &Container, line: Guess, grains: &Silhouette) -> Option<(f64, f64)> {
    match container.shape {
        Shape::Mesh { .. } => {
            let middle = grains.mean_position().dot(line.direction);
            let from = line.point(middle).extend(grains.mean_depth);
            let way = line.direction.extend(0.0);
            let reach = |way: DVec3| container.first_hit(from, way);
            Some((middle - reach(-way)?, middle + reach(way)?))
        }
        Shape::Planes | Shape::Column { .. } => None,
        Shape::Drum { radius, .. } => {
            let half_squared = radius * radius - line.height * line.height;
            (half_squared > 0.0).then(|| (-half_squared.sqrt(), half_squared.sqrt()))
        }
        Shape::Box { min, max } => {
            let origin = line.point(0.0);
            let across = slab(origin.x, line.direction.x, min.x, max.x);
            let upright = slab(origin.y, line.direction.y, min.y, max.y);
            let (low, high) = (across.0.max(upright.0), across.1.min(upright.1));
            (low < high).then_some((low, high))
        }
    }
}

/// Range of `s` in which `origin + s direction` lies between `min` and `max`.
fn slab(origin: f64, direction: f64, min: f64, max: f64) -> (f64, f64) {
    if direction == 0.0 {
        let inside = (min..=max).contains(&origin);
        return if inside {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            (f64::INFINITY, f64::NEG_INFINITY)
        };
    }
    let (a, b) = ((min - origin) / direction, (max - origin) / direction);
    (a.min(b), a.max(b))
}

/// A least-squares line through points (s, n): through their mean, with this slope.
struct Fit {
    mean: DVec2,
    slope: f64,
}

impl Fit {
    fn through(points: &[DVec2]) -> Option<Self> {
        if points.len() < 3 {
            return None;
        }
        let mean = points.iter().sum::<DVec2>() / points.len() as f64;
        let (mut spread, mut covariance) = (0.0, 0.0);
        for point in points {
            let offset = *point - mean;
            spread += offset.x * offset.x;
            covariance += offset.x * offset.y;
        }
        let slope = covariance / spread;
        slope.is_finite().then_some(Self { mean, slope })
    }

    /// Curvature of the least-squares parabola through `points`, positive where it is convex: `−2c`
    /// of the distances `c (s² − …)` from this line, with the quadratic made orthogonal to constant
    /// and slope [1/m].
    fn curvature(&self, points: &[DVec2]) -> f64 {
        let mean_of = |value: &dyn Fn(f64) -> f64| {
            points.iter().map(|p| value(p.x - self.mean.x)).sum::<f64>() / points.len() as f64
        };
        let (second, third) = (mean_of(&|s| s * s), mean_of(&|s| s * s * s));
        let quadratic = |s: f64| s * s - third / second * s - second;
        let (mut spread, mut covariance) = (0.0, 0.0);
        for point in points {
            let (s, n) = (point.x - self.mean.x, point.y - self.mean.y);
            spread += quadratic(s) * quadratic(s);
            covariance += quadratic(s) * n;
        }
        -2.0 * covariance / spread
    }

    /// This line, fitted in the frame of `guess`, as the next guess.
    fn turned(&self, guess: Guess) -> Guess {
        let direction = guess
            .direction
            .rotate(DVec2::new(1.0, self.slope).normalize());
        let through = guess.direction * self.mean.x + guess.normal() * self.mean.y;
        Guess {
            direction,
            height: through.dot(direction.perp()),
        }
    }

    fn line(&self, own: Guess, middle: FittedPart, tops: &[DVec2]) -> SurfaceLine {
        let across = (1.0 + self.slope * self.slope).sqrt();
        let distance =
            |top: &DVec2| (top.y - self.mean.y - self.slope * (top.x - self.mean.x)).abs() / across;
        SurfaceLine {
            angle: own.direction.to_angle(),
            midpoint: own.point(middle.centre),
            direction: own.direction,
            half_length: middle.half_length,
            roughness: tops.iter().map(distance).sum::<f64>() / tops.len() as f64,
            curvature: self.curvature(tops),
            bins: tops.len(),
        }
    }
}
