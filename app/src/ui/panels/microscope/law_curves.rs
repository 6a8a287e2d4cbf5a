//! The force of a pair over its gap, as its law has it: the curves under the moving dot of the
//! microscope.
//!
//! In: a contact and its terms. Out: points, gap [µm] and force that pushes apart [mN].

use crate::ui::theme::{Palette, dash};
use egui_plot::{Line, LineStyle, PlotUi};
use grainfall::physics::BridgeLaw;
use grainfall::solver::{ForceTerms, NormalLaw};
use grainfall::world::{Contact, Partner, World};

const MICROMETRES: f64 = 1e6;
/// Points of a curve.
const CURVE: usize = 240;

/// The dot of a contact: gap [µm] and force that pushes apart [mN].
pub(super) fn dot(terms: &ForceTerms) -> [f64; 2] {
    let of_bodies = terms.feature.is_some();
    let force = if of_bodies {
        terms.normal_spring
    } else {
        terms.force()
    };
    [-MICROMETRES * terms.overlap, -1e3 * force.dot(terms.normal)]
}

/// A curve of the law.
pub(super) struct LawCurve {
    name: &'static str,
    /// Whether it is the law of this run.
    own: bool,
    /// Whether the viscous part at the present speed of approach is included.
    pub(super) moving: bool,
    points: Vec<[f64; 2]>,
}

impl LawCurve {
    /// Draws it as the curve of this `index`.
    pub(super) fn ui(self, plot: &mut PlotUi, index: usize, palette: Palette) {
        let colour = if self.own {
            palette.angle
        } else {
            palette.temperature
        };
        let line = Line::new(self.name, self.points)
            .color(colour)
            .width(if self.own && self.moving { 2.2 } else { 1.4 });
        plot.line(if self.moving {
            line.style(if self.own {
                LineStyle::Solid
            } else {
                LineStyle::Dashed {
                    length: dash(index),
                }
            })
        } else {
            line.style(LineStyle::dotted_dense())
        });
    }
}

/// The curves under the dot of `contact`.
pub(super) fn curves(world: &World, contact: &Contact, terms: &ForceTerms) -> Vec<LawCurve> {
    if terms.feature.is_some() {
        return vec![spring_of_features(terms)];
    }
    let own = world
        .wetting()
        .map_or(BridgeLaw::AS_PRINTED, |liquid| liquid.law);
    let wet = world.wetting().is_some() && matches!(contact.partner, Partner::Grain(_));
    let mut laws = vec![
        ("as the paper prints it", BridgeLaw::AS_PRINTED),
        ("as its program computes it", BridgeLaw::AS_CODED),
    ];
    if !wet {
        laws = vec![("law", own)];
    } else if !laws.iter().any(|(_, law)| *law == own) {
        laws.push(("this scene", own));
    }
    let reach = reach(world, contact, terms, &laws);
    let mut curves = Vec::new();
    for (name, choice) in laws {
        let law = NormalLaw::of(world, contact, choice);
        let is_own = choice == own;
        let curve = |name, approach: f64, moving| LawCurve {
            name,
            own: is_own,
            moving,
            points: sample(reach, law.rupture_gap(), |gap| law.force(gap, approach)),
        };
        curves.push(curve(name, terms.approach, true));
        if is_own {
            curves.push(curve("at rest", 0.0, false));
        }
    }
    curves
}

/// The gaps to draw [m]: as deep as the contact is or a little more; of grains that do not touch,
/// as far as a bridge reaches.
fn reach(
    world: &World,
    contact: &Contact,
    terms: &ForceTerms,
    laws: &[(&str, BridgeLaw)],
) -> (f64, f64) {
    let radius = world.grains.radius[contact.grain as usize];
    let deepest = (1.6 * terms.overlap).max(1e-4 * radius);
    let rupture = (laws.iter())
        .filter_map(|(_, law)| NormalLaw::of(world, contact, *law).rupture_gap())
        .fold(0.0, f64::max);
    if terms.overlap > 0.0 {
        // Bridges reach a hundred times as far as grains overlap: drawn whole they would hide the
        // contact.
        (-deepest, 3.0 * deepest)
    } else {
        (-deepest, (1.1 * rupture).max(0.8 * deepest))
    }
}

/// The points of a curve; close together near the moment of touching and on either side of a
/// rupture.
fn sample(
    (from, to): (f64, f64),
    rupture: Option<f64>,
    force: impl Fn(f64) -> f64,
) -> Vec<[f64; 2]> {
    let half = CURVE / 2;
    let share = |k: usize| k as f64 / half as f64;
    let mut gaps: Vec<f64> = (0..half).map(|k| from * (1.0 - share(k)).powi(2)).collect();
    gaps.extend((0..=half).map(|k| to * share(k).powi(2)));
    gaps.extend(
        rupture
            .into_iter()
            .flat_map(|gap| [gap, gap * (1.0 + 1e-9)]),
    );
    gaps.sort_by(f64::total_cmp);
    let point = |gap: f64| [MICROMETRES * gap, 1e3 * force(gap)];
    gaps.into_iter().map(point).collect()
}

/// The normal spring of a pair of features, which share the pair's stiffness.
fn spring_of_features(terms: &ForceTerms) -> LawCurve {
    let stiffness = terms.normal_spring.length() / terms.overlap;
    let deepest = 1.6 * terms.overlap;
    LawCurve {
        name: "law",
        own: true,
        moving: false,
        points: sample((-deepest, 0.8 * deepest), None, |gap| {
            stiffness * (-gap).max(0.0)
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curve_holds_both_sides_of_the_rupture_and_the_moment_of_touching() {
        let points = sample((-1e-6, 1e-4), Some(5e-5), |gap| f64::from(gap <= 5e-5));
        assert!(points.is_sorted_by(|a, b| a[0] <= b[0]));
        assert!(points.iter().any(|p| p[0] == 0.0));
        let fall = points.windows(2).find(|w| w[0][1] > w[1][1]).unwrap();
        assert!(fall[1][0] - fall[0][0] < 1e-6, "{fall:?}");
    }
}
