//! Grains that are listed one by one: their shapes and motions, inside of the container, clear of
//! each other.

use super::clearance::{DEEPEST_ROUNDING, LARGEST_OVERLAP, clearance};
use super::filling::check_count;
use super::overlaps::check_overlaps;
use super::values::{Checked, shown, vector, within};
use crate::geometry::{Polyhedron, sphere_volume};
use crate::physics::limits;
use crate::scene::Scene;
use crate::scene::container::SceneContainer;
use crate::scene::error::Problem;
use crate::scene::grains::SceneGrain;
use crate::scene::shape::{MOST_CORNERS, MOST_POINTS, MOST_SIDES, SceneBody, SceneShape};

/// Of a flat body the largest moment is the sum of the two others, but for rounding.
const OF_ROUNDING: f64 = 1e-6;

impl Scene {
    pub(super) fn check_list(&self, grains: &[SceneGrain]) -> Checked {
        check_count(grains.len())?;
        let mut bodies = Vec::with_capacity(grains.len());
        for (index, grain) in grains.iter().enumerate() {
            let path = |key: &str| format!("grains[{index}].{key}");
            check_shape(&grain.shape, path)?;
            within(&limits::RADIUS, grain.radius, || path("radius"))?;
            vector(grain.position, 1e5, "m", || path("position"))?;
            vector(grain.velocity, 1e5, "m/s", || path("velocity"))?;
            vector(grain.spin, 1e7, "rad/s", || path("spin"))?;
            if let Some(film) = grain.film {
                within(&limits::LIQUID_VOLUME, film, || path("film"))?;
            }
            self.check_material(&grain.material, || path("material"))?;
            let body = grain.body().ok_or_else(|| too_thin(grain, path("shape")))?;
            check_inside(&self.container, grain, &body, || path("position"))?;
            bodies.push(body);
        }
        check_overlaps(grains, &bodies)
    }
}

fn check_shape(shape: &SceneShape, path: impl Fn(&str) -> String) -> Checked {
    if let Some(rounding) = shape.rounding() {
        within(&limits::ROUNDING, rounding, || path("rounding"))?;
    }
    match shape {
        SceneShape::Sphere => Ok(()),
        SceneShape::Box { size, .. } => size
            .to_array()
            .into_iter()
            .try_for_each(|edge| within(&limits::LENGTH, edge, || path("shape.size"))),
        SceneShape::Tetrahedron { edge, .. } => {
            within(&limits::LENGTH, *edge, || path("shape.edge"))
        }
        SceneShape::Prism {
            sides,
            edge,
            height,
            ..
        } => {
            within(&limits::LENGTH, *edge, || path("shape.edge"))?;
            within(&limits::LENGTH, *height, || path("shape.height"))?;
            if (3..=MOST_SIDES).contains(sides) {
                return Ok(());
            }
            Err(Problem::value(
                path("shape.sides"),
                sides,
                format!("a number of sides between 3 and {MOST_SIDES}"),
            ))
        }
        SceneShape::Hull { points, .. } => {
            if !(4..=MOST_POINTS).contains(&points.len()) {
                return Err(Problem::new(
                    path("shape.points"),
                    format!("are {} in number", points.len()),
                    format!("4 to {MOST_POINTS} points"),
                ));
            }
            points
                .iter()
                .try_for_each(|point| vector(*point, 1e3, "m", || path("shape.points")))?;
            if shape.solid().is_some() {
                return Ok(());
            }
            Err(Problem::new(
                path("shape.points"),
                "lie in one plane",
                "points round a body",
            ))
        }
        SceneShape::Core { corners, .. } => {
            let mut corners = corners.iter();
            corners.try_for_each(|corner| vector(*corner, 1e3, "m", || path("shape.corners")))?;
            check_core(shape, path)
        }
    }
}

/// A core is a closed body, with mass and inertia that a body of its size can have.
fn check_core(shape: &SceneShape, path: impl Fn(&str) -> String) -> Checked {
    let (
        Some(core),
        SceneShape::Core {
            rounding,
            volume,
            gyration,
            ..
        },
    ) = (shape.core(), shape)
    else {
        return Err(Problem::new(
            path("shape.faces"),
            "are not those of a body with these corners",
            format!(
                "4 to {MOST_CORNERS} corners, and faces that name three or more of them each, counted from 0"
            ),
        ));
    };
    let (own, reach) = (core.moments().volume, shape.radius());
    let body = Polyhedron::of_core(core.clone(), *rounding, *volume, *gyration);
    if !core.is_closed() || !body.is_sound_core() {
        return Err(Problem::new(
            path("shape"),
            "is no body",
            "faces of which each edge is in two, their corners anticlockwise seen from outside, and a volume and a gyration \
             above zero",
        ));
    }
    if !(own..=sphere_volume(reach)).contains(volume) {
        return Err(Problem::value(
            path("shape.volume"),
            volume,
            format!(
                "one between that of the core, {own:e} m³, and that of a sphere round the grain"
            ),
        ));
    }
    let largest = gyration.max_element();
    let others = gyration.element_sum() - largest;
    if largest <= reach * reach && largest <= (1.0 + OF_ROUNDING) * others {
        return Ok(());
    }
    Err(Problem::value(
        path("shape.gyration"),
        shown(*gyration),
        "principal moments of inertia over the mass: none larger than the two others together, nor than the largest distance \
         from the centroid squared",
    ))
}

fn too_thin(grain: &SceneGrain, path: String) -> Problem {
    let rounding = grain.shape.rounding().unwrap_or(0.0);
    Problem::new(
        path,
        format!(
            "leaves nothing when its faces are moved inwards by the rounding radius of {rounding} m"
        ),
        "a convex body that is more than two rounding radii thick",
    )
    .advise("Its edges are rounded within its own size: give a smaller `rounding`")
}

/// A listed grain lies on the grains' side of every wall, but for a contact.
fn check_inside(
    container: &SceneContainer,
    grain: &SceneGrain,
    body: &SceneBody,
    path: impl FnOnce() -> String,
) -> Checked {
    let (room, least) = match body {
        SceneBody::Sphere => (
            clearance(container, grain.position),
            (1.0 - LARGEST_OVERLAP) * grain.radius,
        ),
        SceneBody::Polyhedron { core, rounding } => {
            let corners = core.vertices.iter().map(|x| clearance(container, *x));
            let room = corners.fold(f64::INFINITY, f64::min);
            (room, (1.0 - DEEPEST_ROUNDING) * rounding)
        }
    };
    if room >= least {
        return Ok(());
    }
    if !grain.shape.is_sphere() {
        return Err(Problem::value(
            path(),
            shown(grain.position),
            format!(
                "a place inside of the container (a touch may be {:.0} % of the rounding radius deep)",
                100.0 * DEEPEST_ROUNDING
            ),
        )
        .advise(format!(
            "One of its corners reaches {} m too far",
            least - room
        )));
    }
    Err(Problem::value(
        path(),
        shown(grain.position),
        format!(
            "a place inside of the container, {} m or more from every wall (a touch may be {:.0} % of the radius deep)",
            least,
            100.0 * LARGEST_OVERLAP
        ),
    )
    .advise(format!("It is {room} m from the nearest one")))
}
