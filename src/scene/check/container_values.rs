//! The container: its sizes and speeds, its planes, the materials it names.

use super::values::{Checked, check_name, check_number, shown, twice, vector, within};
use crate::physics::limits;
use crate::scene::Scene;
use crate::scene::container::{SceneContainer, ScenePlane, SceneTube};
use crate::scene::error::Problem;
use crate::scene::mesh::{MeshMotion, SceneMesh};
use glam::DVec3;

impl Scene {
    pub(super) fn check_container_materials(&self) -> Checked {
        match &self.container {
            SceneContainer::Nothing => Ok(()),
            SceneContainer::Drum { material, .. }
            | SceneContainer::Box { material, .. }
            | SceneContainer::Mesh { material, .. } => {
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
}

pub(in crate::scene) fn check_container(container: &SceneContainer) -> Checked {
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
        SceneContainer::Box { min, max, .. } => check_box("container", *min, *max),
        SceneContainer::Mesh {
            surface,
            motion,
            room,
            ..
        } => {
            check_size(surface)?;
            if let Some((min, max)) = room {
                check_box("container.room", *min, *max)?;
            }
            check_motion(motion)
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

fn check_box(path: &str, min: DVec3, max: DVec3) -> Checked {
    vector(min, 1e4, "m", || format!("{path}.min"))?;
    vector(max, 1e4, "m", || format!("{path}.max"))?;
    let size = (max - min).to_array();
    if size.iter().all(|&length| limits::LENGTH.accept(length)) {
        return Ok(());
    }
    Err(Problem::value(
        format!("{path}.max"),
        shown(max),
        format!(
            "between 1e-6 m and 1000 m beyond `min` {} along each axis",
            shown(min)
        ),
    ))
}

fn check_size(surface: &SceneMesh) -> Checked {
    let (min, max) = surface.bounds();
    let size = (max - min).max_element();
    if limits::LENGTH.accept(size) && min.abs().max(max.abs()).max_element() <= 1e4 {
        return Ok(());
    }
    Err(Problem::new(
        "container",
        format!("is a mesh between {} m and {} m", shown(min), shown(max)),
        "a size between 1e-6 m and 1000 m, within 10 km of the origin",
    )
    .advise("STL files state no unit: `scale` is the length of theirs in m, 0.001 for millimetres"))
}

fn check_motion(motion: &MeshMotion) -> Checked {
    match *motion {
        MeshMotion::Fixed => Ok(()),
        MeshMotion::Turning {
            through,
            axis,
            speed,
        } => {
            let path = |key: &str| format!("container.motion.{key}");
            vector(through, 1e4, "m", || path("through"))?;
            within(&limits::DRUM_SPEED, speed, || path("speed"))?;
            if axis.is_normalized() {
                return Ok(());
            }
            Err(Problem::value(
                path("axis"),
                shown(axis),
                "the direction of the axis; its length does not matter, but must not be zero",
            ))
        }
        MeshMotion::Moving { velocity } => vector(velocity, 1e3, "m/s", || {
            "container.motion.velocity".to_owned()
        }),
    }
}

fn check_tube(tube: &SceneTube) -> Checked {
    within(&limits::TUBE_SPEED, tube.speed, || {
        "container.tube.speed".to_owned()
    })?;
    if (0.0..=1e5).contains(&tube.rim) {
        return Ok(());
    }
    Err(Problem::value(
        "container.tube.rim",
        tube.rim,
        "the height of its lower rim at the start, 0 to 100000 m",
    ))
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
