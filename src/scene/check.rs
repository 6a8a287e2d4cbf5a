//! Which values make sense, each alone and all together.
//!
//! In: a [`Scene`] as a file or a program states it. Out: nothing, or the first mistake with the
//! path of its key. A scene that passes can be built: its grains fit, its names exist, its numbers
//! are finite and within what the solver can bear.

use super::container::{SceneContainer, ScenePlane, SceneTube, volume};
use super::description::{Scene, TimeStep};
use super::error::Problem;
use super::grains::{SceneCells, SceneGrain, SceneGrains, SceneSpecies};
use super::lattice::Lattice;
use super::materials::{PairOverride, SceneMaterial};
use super::shape::{MOST_POINTS, MOST_SIDES, SceneBody, SceneShape};
use super::size_classes::size_classes;
use super::stored_cells::StoredCells;
use crate::geometry::spheres_volume;
use crate::physics::limits::{self, Limits};
use crate::physics::{ContactLaw, Liquid, SmallestGap};
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};

type Checked = Result<(), Problem>;

/// Polyhedra a scene may have: up to 20 kB each in memory.
const MOST_POLYHEDRA: usize = 200_000;
/// Voronoi cells that are made to choose the grains from, in numbers of [`MOST_POLYHEDRA`].
const CELLS_PER_GRAIN: usize = 2;
/// Materials, species, planes or pairs a scene may have.
const MOST_KINDS: usize = 200;
/// States a run may write.
const MOST_OUTPUTS: f64 = 1e6;
/// Overlap of a listed polyhedron with a wall that is still a contact, in rounding radii.
const DEEPEST_ROUNDING: f64 = 0.5;
/// Overlap of two listed grains, or of one with a wall, that is still a contact, in radii of the
/// smaller grain.
const LARGEST_OVERLAP: f64 = 0.1;

/// Refuses a `value` of the key at `path` that is not within `limits`.
fn within(limits: &Limits, value: f64, path: impl FnOnce() -> String) -> Checked {
    if limits.accept(value) {
        Ok(())
    } else {
        Err(Problem::value(
            path(),
            format!("{value:?}"),
            limits.expected,
        ))
    }
}

impl Scene {
    /// Whether every value is in range and all of them fit together.
    pub(crate) fn problem(&self) -> Checked {
        check_title(&self.title)?;
        check_materials(&self.materials)?;
        check_pairs(&self.pairs, self)?;
        check_container(&self.container)?;
        self.check_container_materials()?;
        match &self.grains {
            SceneGrains::Fill { count, species, .. } => self.check_filling(*count, species)?,
            SceneGrains::Voronoi(cells) => self.check_cells(cells)?,
            SceneGrains::List(grains) => self.check_list(grains)?,
        }
        if self.is_polyhedral() {
            self.check_suits_polyhedra()?;
        }
        self.liquid.as_ref().map_or(Ok(()), check_liquid)?;
        vector(self.gravity, limits::GRAVITY.most, "m/s²", || {
            "gravity".to_owned()
        })?;
        check_law(self.law)?;
        self.check_times()
    }

    fn check_container_materials(&self) -> Checked {
        match &self.container {
            SceneContainer::Nothing => Ok(()),
            SceneContainer::Drum { material, .. } | SceneContainer::Box { material, .. } => {
                self.check_material(material, || "container.material".to_owned())
            }
            SceneContainer::Column { material, tube, .. } => {
                self.check_material(material, || "container.material".to_owned())?;
                tube.as_ref().map_or(Ok(()), |tube| {
                    self.check_material(&tube.material, || "container.tube.material".to_owned())
                })
            }
            SceneContainer::Planes(planes) => {
                planes.iter().enumerate().try_for_each(|(index, plane)| {
                    self.check_material(&plane.material, || format!("container[{index}].material"))
                })
            }
        }
    }

    fn check_material(&self, name: &str, path: impl FnOnce() -> String) -> Checked {
        if self.materials.iter().any(|m| m.name == name) {
            return Ok(());
        }
        let known = self.materials.iter().map(|m| m.name.as_str());
        Err(Problem::unknown_name(path(), "a material", name, known))
    }

    fn check_filling(&self, count: usize, species: &[SceneSpecies]) -> Checked {
        self.check_species()?;
        for (index, kind) in species.iter().enumerate() {
            within(&limits::RADIUS, kind.radius, || {
                format!("grains.species[{index}].radius")
            })?;
        }
        check_count(count)?;
        self.check_room(count, species)
    }

    /// Names, materials and shares of the species of a filling.
    fn check_species(&self) -> Checked {
        let species = self.species();
        check_number("grains.species", "species", species.len())?;
        for (index, (name, material)) in species.iter().enumerate() {
            let path = |key: &str| format!("grains.species[{index}].{key}");
            check_name(name, || path("name"))?;
            if species[..index].iter().any(|other| other.0 == *name) {
                return Err(twice(path("name"), "a species", name)
                    .advise("Species of one material need a `name` each"));
            }
            within(&limits::SHARE, self.share(index), || path("share"))?;
            self.check_material(material, || path("material"))?;
        }
        let sum = (0..species.len()).map(|index| self.share(index)).sum();
        check_shares(sum)
    }

    fn check_cells(&self, cells: &SceneCells) -> Checked {
        self.check_species()?;
        if let Some(packing) = &cells.packing {
            return self.check_packing(packing);
        }
        within(&limits::CELL, cells.cell, || "grains.cell".to_owned())?;
        within(&limits::ROUNDING, cells.rounding, || {
            "grains.rounding".to_owned()
        })?;
        if !(1e-3..=0.2).contains(&(cells.rounding / cells.cell)) {
            return Err(Problem::value(
                "grains.rounding",
                format!("{} m", cells.rounding),
                format!(
                    "between a thousandth and a fifth of the cell of {} m",
                    cells.cell
                ),
            ));
        }
        fraction("grains.solid_fraction", cells.solid_fraction)?;
        fraction("grains.bulk_fraction", cells.bulk_fraction)?;
        self.check_bed(cells)
    }

    /// The grains of a file stand in the container.
    fn check_packing(&self, packing: &StoredCells) -> Checked {
        let grains = packing.grains();
        let outside = grains.iter().filter(|grain| {
            let room = grain.corners().map(|x| clearance(&self.container, x));
            let least = (1.0 - DEEPEST_ROUNDING) * grain.shape.rounding;
            room.fold(f64::INFINITY, f64::min) < least
                || is_beside_column(&self.container, grain.position)
        });
        let outside = outside.count();
        if outside == 0 && grains.len() <= MOST_POLYHEDRA {
            return Ok(());
        }
        Err(Problem::new(
            "grains.packing",
            format!(
                "holds {} grains, {outside} of them not inside of the container",
                grains.len()
            ),
            format!("at most {MOST_POLYHEDRA} grains that stand clear of every wall, within the column where there is one"),
        )
        .advise("Take the container that the grains were packed in"))
    }

    fn check_bed(&self, cells: &SceneCells) -> Checked {
        let column = matches!(self.container, SceneContainer::Column { .. });
        if column && cells.bulk_fraction < 1.0 {
            return Err(Problem::new(
                "grains.bulk_fraction",
                "is given for a column, which is as high as its `height` says",
                "the `height` of the container alone",
            ));
        }
        if !column && volume(&self.container).is_err() {
            return Err(Problem::new(
                "grains",
                "are Voronoi cells, but the container is open",
                "a `Column`, a `Box` or a `Drum` to fill, or the grains as a `List`",
            ));
        }
        let (all, grains) = (
            cells.cell_count(&self.container),
            cells.grain_count(&self.container),
        );
        if (1..=MOST_POLYHEDRA).contains(&grains) && all <= CELLS_PER_GRAIN * MOST_POLYHEDRA {
            return Ok(());
        }
        Err(Problem::new(
            "grains",
            format!("are {grains} of {all} Voronoi cells"),
            format!(
                "between 1 and {MOST_POLYHEDRA} polyhedra, up to 20 kB of memory each, of {} cells at most",
                CELLS_PER_GRAIN * MOST_POLYHEDRA
            ),
        )
        .advise("Take larger cells or a smaller container"))
    }

    /// What only spheres can have.
    fn check_suits_polyhedra(&self) -> Checked {
        if self.law.feature_springs().is_none() {
            return Err(Problem::new(
                "law",
                "is the one of spheres, but the scene has polyhedra",
                "`Hooke(normal_stiffness: …, tangential_stiffness: …)`, or no `law` for the springs of Man et al. 2023",
            ));
        }
        if self.liquid.is_some() {
            return Err(Problem::new(
                "liquid",
                "makes bridges between spheres, but the scene has polyhedra",
                "no `liquid`",
            ));
        }
        for material in &self.materials {
            if material.rolling_friction != 0.0 {
                let path = format!("materials.{}.rolling_friction", material.name);
                return Err(no_rolling(path, material.rolling_friction));
            }
        }
        for (index, pair) in self.pairs.iter().enumerate() {
            if let Some(value) = pair.rolling_friction.filter(|&value| value != 0.0) {
                return Err(no_rolling(
                    format!("pairs[{index}].rolling_friction"),
                    value,
                ));
            }
        }
        Ok(())
    }

    fn check_room(&self, count: usize, species: &[SceneSpecies]) -> Checked {
        let room = volume(&self.container)?;
        self.check_widths(species)?;
        let classes = size_classes(count, species);
        if Lattice::for_filling(&self.container, &classes).is_some() {
            return Ok(());
        }
        let solid: f64 = classes
            .iter()
            .map(|class| spheres_volume(class.count as f64, class.radius))
            .sum();
        let part = solid / room;
        Err(Problem::new(
            "grains",
            format!("do not fit into the container: {count} grains are {part:.3} of its volume, before they settle"),
            "a filling that leaves the grains room to be placed apart, about 0.4 of the volume or less",
        )
        .advise("Take fewer or smaller grains or a larger container"))
    }

    fn check_widths(&self, species: &[SceneSpecies]) -> Checked {
        let largest = 0.5 * narrowest(&self.container);
        let wide = species.iter().position(|kind| kind.radius > largest);
        wide.map_or(Ok(()), |index| {
            Err(Problem::value(
                format!("grains.species[{index}].radius"),
                format!("{} m", species[index].radius),
                format!("at most {largest} m, half of the container's narrowest width"),
            ))
        })
    }

    fn check_list(&self, grains: &[SceneGrain]) -> Checked {
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

    fn check_times(&self) -> Checked {
        within(&limits::DURATION, self.duration, || "duration".to_owned())?;
        within(&limits::DURATION, self.output_interval, || {
            "output_interval".to_owned()
        })?;
        if self.duration / self.output_interval > MOST_OUTPUTS {
            return Err(Problem::value(
                "output_interval",
                format!("{} s", self.output_interval),
                format!(
                    "at least {} s, so that a run writes at most a million states",
                    self.duration / MOST_OUTPUTS
                ),
            ));
        }
        let TimeStep::Given(step) = self.time_step else {
            return Ok(());
        };
        within(&limits::TIME_STEP, step, || "time_step".to_owned())?;
        if step > self.output_interval {
            return Err(Problem::value(
                "time_step",
                format!("{step} s"),
                format!("at most the output interval of {} s", self.output_interval),
            ));
        }
        Ok(())
    }
}

pub(super) fn fraction(path: &str, value: f64) -> Checked {
    within(&limits::FRACTION, value, || path.to_owned())
}

pub(super) fn check_container(container: &SceneContainer) -> Checked {
    match container {
        SceneContainer::Nothing => Ok(()),
        SceneContainer::Drum {
            radius,
            width,
            speed,
            ..
        } => {
            within(&limits::LENGTH, *radius, || "container.radius".to_owned())?;
            within(&limits::LENGTH, *width, || "container.width".to_owned())?;
            within(&limits::DRUM_SPEED, *speed, || "container.speed".to_owned())
        }
        SceneContainer::Box { min, max, .. } => {
            vector(*min, 1e4, "m", || "container.min".to_owned())?;
            vector(*max, 1e4, "m", || "container.max".to_owned())?;
            let size = (*max - *min).to_array();
            if size.iter().all(|&length| limits::LENGTH.accept(length)) {
                return Ok(());
            }
            Err(Problem::value(
                "container.max",
                shown(*max),
                format!(
                    "between 1e-6 m and 1000 m beyond `min` {} along each axis",
                    shown(*min)
                ),
            ))
        }
        SceneContainer::Column {
            radius,
            height,
            tube,
            ..
        } => {
            within(&limits::LENGTH, *radius, || "container.radius".to_owned())?;
            within(&limits::LENGTH, *height, || "container.height".to_owned())?;
            tube.as_ref().map_or(Ok(()), check_tube)
        }
        SceneContainer::Planes(planes) => check_planes(planes),
    }
}

fn check_tube(tube: &SceneTube) -> Checked {
    within(&limits::TUBE_SPEED, tube.speed, || {
        "container.tube.speed".to_owned()
    })
}

fn no_rolling(path: String, value: f64) -> Problem {
    Problem::value(
        path,
        value,
        "0, or nothing: polyhedra do not roll as spheres do and have no rolling friction",
    )
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
    }
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

fn check_planes(planes: &[ScenePlane]) -> Checked {
    check_number("container", "planes", planes.len())?;
    for (index, plane) in planes.iter().enumerate() {
        let path = |key: &str| format!("container[{index}].{key}");
        check_name(&plane.name, || path("name"))?;
        if planes[..index].iter().any(|other| other.name == plane.name) {
            return Err(twice(path("name"), "a plane", &plane.name));
        }
        vector(plane.point, 1e5, "m", || path("point"))?;
        vector(plane.velocity, 1e5, "m/s", || path("velocity"))?;
        check_plane_directions(plane, path)?;
    }
    Ok(())
}

fn check_plane_directions(plane: &ScenePlane, path: impl Fn(&str) -> String) -> Checked {
    if !plane.normal.is_normalized() {
        return Err(Problem::value(
            path("normal"),
            shown(plane.normal),
            "a direction towards the grains; its length does not matter, but must not be zero",
        ));
    }
    // Room for the rounding of a slanted velocity.
    if plane.velocity.dot(plane.normal).abs() <= 1e-6 * plane.velocity.length() {
        return Ok(());
    }
    Err(Problem::value(
        path("velocity"),
        shown(plane.velocity),
        "a velocity along the plane, at right angles to `normal`: it moves as a belt does, in itself",
    ))
}

fn check_title(title: &str) -> Checked {
    let length = title.trim().chars().count();
    if (1..=200).contains(&length) && !title.contains('\n') {
        return Ok(());
    }
    Err(Problem::value(
        "title",
        format!("{length} characters long"),
        "one line of 1 to 200 characters",
    ))
}

fn check_materials(materials: &[SceneMaterial]) -> Checked {
    check_number("materials", "materials", materials.len())?;
    for (index, material) in materials.iter().enumerate() {
        let name = &material.name;
        let path = |key: &str| format!("materials.{name}.{key}");
        check_name(name, || format!("materials.{name}"))?;
        if materials[..index].iter().any(|other| other.name == *name) {
            return Err(twice(format!("materials.{name}"), "a material", name));
        }
        within(&limits::YOUNGS_MODULUS, material.youngs_modulus, || {
            path("youngs_modulus")
        })?;
        within(&limits::POISSON_RATIO, material.poisson_ratio, || {
            path("poisson_ratio")
        })?;
        within(&limits::DENSITY, material.density, || path("density"))?;
        within(&limits::RESTITUTION, material.restitution, || {
            path("restitution")
        })?;
        within(&limits::FRICTION, material.friction, || path("friction"))?;
        if let Some(friction) = material.wet_friction {
            within(&limits::FRICTION, friction, || path("wet_friction"))?;
        }
        within(&limits::FRICTION, material.rolling_friction, || {
            path("rolling_friction")
        })?;
    }
    Ok(())
}

fn check_pairs(pairs: &[PairOverride], scene: &Scene) -> Checked {
    if pairs.len() > MOST_KINDS {
        return check_number("pairs", "pairs", pairs.len());
    }
    for (index, pair) in pairs.iter().enumerate() {
        let path = |key: &str| format!("pairs[{index}].{key}");
        let (a, b) = &pair.between;
        scene.check_material(a, || path("between"))?;
        scene.check_material(b, || path("between"))?;
        if a == b {
            return Err(Problem::new(
                path("between"),
                format!("names `{a}` twice"),
                "two different materials",
            )
            .advise(format!(
                "How two bodies of `{a}` meet stands in `materials.{a}`"
            )));
        }
        if pairs[..index].iter().any(|other| other.is_between(a, b)) {
            return Err(Problem::new(
                path("between"),
                format!("gives `{a}` and `{b}` a second time"),
                "each pair once",
            ));
        }
        check_pair_values(pair, path)?;
    }
    Ok(())
}

fn check_pair_values(pair: &PairOverride, path: impl Fn(&str) -> String) -> Checked {
    if let Some(restitution) = pair.restitution {
        within(&limits::RESTITUTION, restitution, || path("restitution"))?;
    }
    if let Some(friction) = pair.friction {
        within(&limits::FRICTION, friction, || path("friction"))?;
    }
    if let Some(friction) = pair.wet_friction {
        within(&limits::FRICTION, friction, || path("wet_friction"))?;
    }
    if let Some(rolling_friction) = pair.rolling_friction {
        within(&limits::FRICTION, rolling_friction, || {
            path("rolling_friction")
        })?;
    }
    Ok(())
}

fn check_liquid(liquid: &Liquid) -> Checked {
    within(&limits::SURFACE_TENSION, liquid.surface_tension, || {
        "liquid.surface_tension".to_owned()
    })?;
    within(&limits::CONTACT_ANGLE, liquid.contact_angle, || {
        "liquid.contact_angle".to_owned()
    })?;
    within(&limits::VISCOSITY, liquid.viscosity, || {
        "liquid.viscosity".to_owned()
    })?;
    within(&limits::LIQUID_VOLUME, liquid.volume, || {
        "liquid.volume".to_owned()
    })?;
    let (SmallestGap::OfRadii(gap) | SmallestGap::OfEffectiveRadius(gap)) = liquid.law.viscous_gap;
    within(&limits::SMALLEST_GAP, gap, || {
        "liquid.law.viscous_gap".to_owned()
    })
}

fn check_law(law: ContactLaw) -> Checked {
    law.told(|law| law.mistake()).map_or(Ok(()), |mistake| {
        Err(Problem::value(
            format!("law.{}", mistake.key),
            format!("{:?}", mistake.value),
            mistake.expected,
        ))
    })
}

fn check_shares(sum: f64) -> Checked {
    if (sum - 1.0).abs() <= 1e-6 {
        return Ok(());
    }
    Err(Problem::new(
        "grains.species",
        format!("has shares that add up to {sum}"),
        "shares that add up to 1",
    ))
}

fn check_count(count: usize) -> Checked {
    if limits::GRAINS.accept(count as f64) {
        return Ok(());
    }
    Err(Problem::new(
        "grains",
        format!("are {count} in number"),
        limits::GRAINS.expected,
    ))
}

fn check_number(path: &str, what: &str, number: usize) -> Checked {
    if (1..=MOST_KINDS).contains(&number) {
        return Ok(());
    }
    Err(Problem::new(
        path,
        format!("has {number} {what}"),
        format!("between 1 and {MOST_KINDS} {what}"),
    ))
}

/// Names become parts of keys such as `friction.glass.drum`.
fn check_name(name: &str, path: impl FnOnce() -> String) -> Checked {
    let fits = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if (1..=40).contains(&name.chars().count()) && name.chars().all(fits) {
        return Ok(());
    }
    Err(Problem::new(
        path(),
        format!("is not a usable name: {name:?}"),
        "1 to 40 letters, digits, `-` or `_`",
    ))
}

fn twice(path: String, what: &str, name: &str) -> Problem {
    Problem::new(
        path,
        format!("gives {what} called `{name}` a second time"),
        "each name once",
    )
}

/// A vector whose components are numbers no larger than `largest`.
fn vector(v: DVec3, largest: f64, unit: &str, path: impl FnOnce() -> String) -> Checked {
    if v.to_array().iter().all(|x| x.abs() <= largest) {
        return Ok(());
    }
    Err(Problem::value(
        path(),
        shown(v),
        format!("three numbers between -{largest} and {largest} {unit}"),
    ))
}

fn shown(v: DVec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

/// Width of the widest grain that the container takes [m].
fn narrowest(container: &SceneContainer) -> f64 {
    match container {
        SceneContainer::Drum { radius, width, .. } => width.min(2.0 * radius),
        SceneContainer::Box { min, max, .. } => (*max - *min).min_element(),
        SceneContainer::Nothing | SceneContainer::Column { .. } | SceneContainer::Planes(_) => {
            f64::INFINITY
        }
    }
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

/// Distance of `x` from the nearest wall, negative behind it [m].
fn clearance(container: &SceneContainer, x: DVec3) -> f64 {
    match container {
        SceneContainer::Nothing => f64::INFINITY,
        SceneContainer::Drum { radius, width, .. } => {
            (radius - x.truncate().length()).min(0.5 * width - x.z.abs())
        }
        SceneContainer::Box { min, max, .. } => (x - *min).min(*max - x).min_element(),
        SceneContainer::Column { radius, tube, .. } => {
            let inside = radius - (x.x * x.x + x.z * x.z).sqrt();
            tube.as_ref().map_or(x.y, |_| x.y.min(inside))
        }
        SceneContainer::Planes(planes) => planes
            .iter()
            .map(|plane| (x - plane.point).dot(plane.normal))
            .fold(f64::INFINITY, f64::min),
    }
}

/// Whether `x` is no part of the column that the container is for.
fn is_beside_column(container: &SceneContainer, x: DVec3) -> bool {
    matches!(container, SceneContainer::Column { radius, height, .. }
        if x.x * x.x + x.z * x.z > radius * radius || x.y > *height)
}

/// No two listed grains overlap by more than a contact does.
///
/// Grains lie in grids of cells, one grid for each power of two of the diameter, so that a few
/// large grains among many small ones cost no more than equal ones.
fn check_overlaps(grains: &[SceneGrain], bodies: &[SceneBody]) -> Checked {
    let mut grids: BTreeMap<i32, HashMap<[i64; 3], Vec<usize>>> = BTreeMap::new();
    for (index, grain) in grains.iter().enumerate() {
        let level = level_of(grain.radius);
        let cell = cell_of(grain.position, level);
        let grid = grids.entry(level).or_default();
        grid.entry(cell).or_default().push(index);
    }
    for (index, grain) in grains.iter().enumerate() {
        for (&level, grid) in grids.range(level_of(grain.radius)..) {
            let near = neighbourhood(cell_of(grain.position, level))
                .filter_map(|cell| grid.get(&cell))
                .flatten();
            for &other in near.filter(|&&other| other != index) {
                check_pair_overlap(grains, bodies, index.min(other), index.max(other))?;
            }
        }
    }
    Ok(())
}

fn check_pair_overlap(
    grains: &[SceneGrain],
    bodies: &[SceneBody],
    first: usize,
    second: usize,
) -> Checked {
    let (a, b) = (&grains[first], &grains[second]);
    let overlap = a.radius + b.radius - a.position.distance(b.position);
    if overlap <= 0.0 {
        return Ok(());
    }
    let cores_meet = match (&bodies[first], &bodies[second]) {
        (SceneBody::Sphere, SceneBody::Sphere) => None,
        (SceneBody::Polyhedron { core, .. }, SceneBody::Sphere) => Some(core.holds(b.position)),
        (SceneBody::Sphere, SceneBody::Polyhedron { core, .. }) => Some(core.holds(a.position)),
        (SceneBody::Polyhedron { core: a, .. }, SceneBody::Polyhedron { core: b, .. }) => {
            Some(!a.common_part(b).faces.is_empty())
        }
    };
    if let Some(meet) = cores_meet {
        return if meet {
            Err(Problem::new(
                format!("grains[{second}].position"),
                format!(
                    "makes it overlap the grain `grains[{first}]` with more than its rounded edges"
                ),
                "a place of its own: only roundings may overlap",
            ))
        } else {
            Ok(())
        };
    }
    let most = LARGEST_OVERLAP * a.radius.min(b.radius);
    if overlap <= most {
        return Ok(());
    }
    Err(Problem::new(
        format!("grains[{second}].position"),
        format!("makes it overlap the grain `grains[{first}]` by {overlap:.4e} m"),
        format!("at most {most:.4e} m, a tenth of the smaller radius"),
    ))
}

/// The power of two that is just not below the diameter.
#[expect(
    clippy::disallowed_methods,
    reason = "any size of cells that holds a grain finds the same overlaps"
)]
fn level_of(radius: f64) -> i32 {
    (2.0 * radius).log2().ceil() as i32
}

#[expect(
    clippy::disallowed_methods,
    reason = "a power of two to a whole exponent is exact"
)]
fn cell_of(position: DVec3, level: i32) -> [i64; 3] {
    let size = f64::from(level).exp2();
    position.to_array().map(|x| (x / size).floor() as i64)
}

fn neighbourhood(cell: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    let around = |x: i64| [x - 1, x, x + 1];
    around(cell[0]).into_iter().flat_map(move |x| {
        around(cell[1])
            .into_iter()
            .flat_map(move |y| around(cell[2]).into_iter().map(move |z| [x, y, z]))
    })
}
