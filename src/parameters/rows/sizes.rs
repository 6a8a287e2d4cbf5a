//! How many grains there are, how large they are, and how large what holds them is.

use crate::geometry::spheres_volume;
use crate::parameters::Value;
use crate::parameters::parameter_row::{InScene, Kind, PanelSection, ParameterRow};
use crate::physics::limits;
use crate::physics::units;
use crate::scene::{Scene, SceneCells, SceneContainer, SceneGrains, count_of};

/// Most grains a field offers, as a multiple of the scene's.
const MORE_GRAINS: f64 = 4.0;
/// What both radii take.
const RADIUS: &str = "a length such as `2mm`: of the column, or in a scene that fills its container with grains of one radius, of \
                      those";

pub static GRAIN_COUNT: ParameterRow = ParameterRow {
    key: "count",
    name: |_| "number of grains",
    symbol: "N",
    kind: Kind::Count,
    expected: "a whole number of grains, in a scene that fills its container",
    limits: Some(&limits::GRAINS),
    slider: |count, _, _| 1.0..=(MORE_GRAINS * count).ceil(),
    description: "How many grains the container is filled with. Twice as many take about twice as long to compute.",
    in_scene: Some(InScene {
        read: |scene, _| match &scene.grains {
            SceneGrains::Fill { count, .. } => Some(Value::Count(*count as u64)),
            SceneGrains::Voronoi(_) | SceneGrains::List(_) => None,
        },
        write: |scene, _, value| match (&mut scene.grains, value) {
            (
                SceneGrains::Fill {
                    count,
                    solid_volume,
                    ..
                },
                Value::Count(wanted),
            ) => {
                *count = usize::try_from(wanted).ok()?;
                *solid_volume = None;
                Some(())
            }
            _ => None,
        },
    }),
    ..super::AT_START
};

pub static GRAIN_RADIUS: ParameterRow = ParameterRow {
    key: "radius",
    name: |_| "grain radius",
    symbol: "r",
    kind: Kind::Number(&units::LENGTH),
    expected: RADIUS,
    limits: Some(&limits::RADIUS),
    slider: |radius, _, _| radius / 2.0..=radius * 2.0,
    description: "The bed keeps its volume: half the radius makes eight times as many grains.",
    in_scene: Some(InScene {
        read: |scene, _| match &scene.grains {
            SceneGrains::Fill { species, .. } => {
                let radius = species.first()?.radius;
                let is_one = species.iter().all(|kind| kind.radius == radius);
                is_one.then_some(Value::Number(radius))
            }
            SceneGrains::Voronoi(_) | SceneGrains::List(_) => None,
        },
        write: |scene, _, value| set_grain_radius(scene, value.number()),
    }),
    ..super::AT_START
};

pub static CELL: ParameterRow = ParameterRow {
    key: "cell",
    name: |_| "cell size",
    symbol: "d",
    kind: Kind::Number(&units::LENGTH),
    expected: "a length such as `2mm`, in a scene that cuts Voronoi cells",
    limits: Some(&limits::CELL),
    slider: |cell, _, _| cell / 2.0..=cell * 2.0,
    description: "Size of a lattice cell, of which each makes one Voronoi grain: half of it makes eight times as many.",
    in_scene: Some(InScene {
        read: |scene, _| Some(cut_cells(scene)?.cell.into()),
        write: |scene, _, value| {
            cut_cells_mut(scene)?.cell = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static ROUNDING: ParameterRow = ParameterRow {
    key: "rounding",
    name: |_| "rounding radius",
    symbol: "R_s",
    kind: Kind::Number(&units::LENGTH),
    expected: "a length such as `0.1mm`, in a scene that cuts Voronoi cells",
    limits: Some(&limits::ROUNDING),
    slider: |rounding, _, _| rounding / 4.0..=rounding * 2.0,
    description: "How round the edges and corners of the grains are.",
    in_scene: Some(InScene {
        read: |scene, _| Some(cut_cells(scene)?.rounding.into()),
        write: |scene, _, value| {
            cut_cells_mut(scene)?.rounding = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static SOLID_FRACTION: ParameterRow = ParameterRow {
    key: "solid-fraction",
    name: |_| "solid fraction",
    symbol: "φ_i",
    expected: "a fraction such as `0.8`, in a scene that cuts Voronoi cells",
    limits: Some(&limits::FRACTION),
    slider: |_, _, _| 0.3..=1.0,
    description: "Share of the cells that become grains; the others are left empty, at random.",
    in_scene: Some(InScene {
        read: |scene, _| Some(cut_cells(scene)?.solid_fraction.into()),
        write: |scene, _, value| {
            cut_cells_mut(scene)?.solid_fraction = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static MIX: ParameterRow = ParameterRow {
    key: "mix",
    name: |_| "share of the second species",
    expected: "the share of the second species such as `0.3`, in a scene of Voronoi cells of two species",
    limits: Some(&limits::SHARE),
    slider: |_, _, _| 0.0..=1.0,
    description: "Share of the second of two species by number, from the start on.",
    section: PanelSection::Nowhere,
    in_scene: Some(InScene {
        read: |scene, _| match cells(scene)?.species.as_slice() {
            [_, second] => Some(second.share.into()),
            _ => None,
        },
        write: |scene, _, value| {
            let [first, second] = cells_mut(scene)?.species.as_mut_slice() else {
                return None;
            };
            second.share = value.number();
            first.share = 1.0 - second.share;
            Some(())
        },
    }),
    ..super::AT_START
};

pub static DRUM_RADIUS: ParameterRow = ParameterRow {
    key: "drum-radius",
    name: |_| "drum radius",
    symbol: "R",
    kind: Kind::Number(&units::LENGTH),
    expected: "a length such as `60.5mm`, in a scene of a drum",
    limits: Some(&limits::LENGTH),
    slider: |radius, _, _| radius / 2.0..=radius * 2.0,
    description: "Inner radius of the drum; the grains stay as many as they are.",
    in_scene: Some(InScene {
        read: |scene, _| match scene.container {
            SceneContainer::Drum { radius, .. } => Some(radius.into()),
            _ => None,
        },
        write: |scene, _, value| {
            let SceneContainer::Drum { radius, .. } = &mut scene.container else {
                return None;
            };
            *radius = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static DRUM_WIDTH: ParameterRow = ParameterRow {
    key: "drum-width",
    name: |_| "drum width",
    symbol: "W",
    kind: Kind::Number(&units::LENGTH),
    expected: "a length such as `22mm`, in a scene of a drum",
    limits: Some(&limits::LENGTH),
    slider: |width, _, _| width / 4.0..=width * 4.0,
    description: "Inner width of the drum; the grains stay as many as they are.",
    in_scene: Some(InScene {
        read: |scene, _| match scene.container {
            SceneContainer::Drum { width, .. } => Some(width.into()),
            _ => None,
        },
        write: |scene, _, value| {
            let SceneContainer::Drum { width, .. } = &mut scene.container else {
                return None;
            };
            *width = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

pub static COLUMN_RADIUS: ParameterRow = ParameterRow {
    key: "radius",
    name: |_| "column radius",
    symbol: "R_i",
    kind: Kind::Number(&units::LENGTH),
    expected: RADIUS,
    limits: Some(&limits::LENGTH),
    slider: |radius, _, _| radius / 2.0..=radius * 2.0,
    description: "Radius of the column before it falls.",
    in_scene: Some(InScene {
        read: |scene, _| match scene.container {
            SceneContainer::Column { radius, .. } => Some(radius.into()),
            _ => None,
        },
        write: |scene, _, value| {
            let SceneContainer::Column { radius, .. } = &mut scene.container else {
                return None;
            };
            *radius = value.number();
            (*radius > 0.0).then_some(())
        },
    }),
    ..super::AT_START
};

pub static COLUMN_HEIGHT: ParameterRow = ParameterRow {
    key: "height",
    name: |_| "column height",
    symbol: "H_i",
    kind: Kind::Number(&units::LENGTH),
    expected: "a length such as `5cm`, in a scene of a column",
    limits: Some(&limits::LENGTH),
    slider: |height, _, _| height / 4.0..=height * 4.0,
    description: "Height of the column before it falls: over its radius it is the aspect ratio α.",
    in_scene: Some(InScene {
        read: |scene, _| match scene.container {
            SceneContainer::Column { height, .. } => Some(height.into()),
            _ => None,
        },
        write: |scene, _, value| {
            let SceneContainer::Column { height, .. } = &mut scene.container else {
                return None;
            };
            *height = value.number();
            Some(())
        },
    }),
    ..super::AT_START
};

fn cells(scene: &Scene) -> Option<&SceneCells> {
    match &scene.grains {
        SceneGrains::Voronoi(cells) => Some(cells),
        SceneGrains::Fill { .. } | SceneGrains::List(_) => None,
    }
}

fn cells_mut(scene: &mut Scene) -> Option<&mut SceneCells> {
    match &mut scene.grains {
        SceneGrains::Voronoi(cells) => Some(cells),
        SceneGrains::Fill { .. } | SceneGrains::List(_) => None,
    }
}

/// The cells of a scene that are cut anew, not read from a file.
fn cut_cells(scene: &Scene) -> Option<&SceneCells> {
    cells(scene).filter(|cells| cells.packing.is_none())
}

fn cut_cells_mut(scene: &mut Scene) -> Option<&mut SceneCells> {
    cells_mut(scene).filter(|cells| cells.packing.is_none())
}

/// Gives all grains of a filling the radius `wanted` [m]: the bed keeps its volume, so their number
/// changes.
fn set_grain_radius(scene: &mut Scene, wanted: f64) -> Option<()> {
    let SceneGrains::Fill {
        count,
        solid_volume,
        species,
    } = &mut scene.grains
    else {
        return None;
    };
    let old = species.first()?.radius;
    if species.iter().any(|kind| kind.radius != old) || wanted <= 0.0 {
        return None;
    }
    let volume = solid_volume.unwrap_or_else(|| spheres_volume(*count as f64, old));
    for kind in species.iter_mut() {
        kind.radius = wanted;
    }
    *count = count_of(volume, species);
    *solid_volume = Some(volume);
    Some(())
}
