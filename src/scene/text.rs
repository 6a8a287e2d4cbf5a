//! A scene as the text of a scene file: what [`Scene::parse`] reads as the same scene.
//!
//! In: a scene whose grains are listed spheres and cores. Out: its file, every number with every
//! digit; a plane's normal, or a mesh's axis, may change in its last one, as it is made a unit vector
//! when it is read. A mesh is written as its triangles. The keys are those of `file`.

use super::container::{SceneContainer, ScenePlane};
use super::description::{Scene, TimeStep, Until};
use super::grains::{SceneGrain, SceneGrains};
use super::materials::{PairOverride, SceneMaterial};
use super::mesh::MeshMotion;
use super::shape::SceneShape;
use crate::physics::{Integrator, Liquid};
use glam::DVec3;
use std::fmt::Write as _;

impl Scene {
    /// The text of a file that states it.
    ///
    /// # Errors
    /// When its grains are no listed spheres and cores, or a law cannot be written; for people.
    pub fn to_text(&self) -> Result<String, String> {
        let SceneGrains::List(grains) = &self.grains else {
            return Err("its grains are no list".to_owned());
        };
        let is_told =
            |shape: &SceneShape| matches!(shape, SceneShape::Sphere | SceneShape::Core { .. });
        if grains.iter().any(|grain| !is_told(&grain.shape)) {
            return Err("its grains are neither spheres nor cores".to_owned());
        }
        let law = ron::to_string(&self.law).map_err(|error| error.to_string())?;
        let mut text = String::from("(\n");
        let mut line = |key: &str, value: String| {
            let _ = writeln!(text, "    {key}: {value},");
        };
        line("title", quoted(&self.title));
        line("look_for", quoted(&self.look_for));
        line("source", quoted(&self.source));
        line(
            "materials",
            list('{', self.materials.iter().map(material), '}'),
        );
        line("pairs", list('[', self.pairs.iter().map(pair), ']'));
        line("container", container(&self.container));
        if let Some(liquid) = &self.liquid {
            line("liquid", liquid_text(liquid)?);
        }
        line("gravity", vector(self.gravity));
        line("law", law);
        if self.integrator != Integrator::Explicit {
            line("integrator", format!("{:?}", self.integrator));
        }
        line("time_step", time_step(self.time_step));
        line("duration", format!("{:?}", self.duration));
        if self.until == Until::Rest {
            line("until", "Rest".to_owned());
        }
        line("output_interval", format!("{:?}", self.output_interval));
        if let Some(interval) = self.sample_interval {
            line("sample_interval", format!("{interval:?}"));
        }
        line("seed", self.seed.to_string());
        line(
            "grains",
            format!("List({})", list('[', grains.iter().map(grain), ']')),
        );
        text += ")\n";
        Ok(text)
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.escape_debug())
}

fn vector(v: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", v.x, v.y, v.z)
}

/// Entries between brackets, each in a line of its own.
fn list(open: char, entries: impl Iterator<Item = String>, close: char) -> String {
    let mut text = String::from(open);
    for entry in entries {
        let _ = write!(text, "\n        {entry},");
    }
    if text.len() > 1 {
        text += "\n    ";
    }
    text.push(close);
    text
}

/// ` key: value,`, where there is a value.
fn optional(key: &str, value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!(", {key}: {value:?}"))
}

fn material(material: &SceneMaterial) -> String {
    format!(
        "{}: (youngs_modulus: {:?}, poisson_ratio: {:?}, density: {:?}, restitution: {:?}, friction: {:?}{}, \
         rolling_friction: {:?})",
        quoted(&material.name),
        material.youngs_modulus,
        material.poisson_ratio,
        material.density,
        material.restitution,
        material.friction,
        optional("wet_friction", material.wet_friction),
        material.rolling_friction
    )
}

fn pair(pair: &PairOverride) -> String {
    format!(
        "(between: ({}, {}){}{}{}{})",
        quoted(&pair.between.0),
        quoted(&pair.between.1),
        optional("restitution", pair.restitution),
        optional("friction", pair.friction),
        optional("wet_friction", pair.wet_friction),
        optional("rolling_friction", pair.rolling_friction)
    )
}

fn triangle([a, b, c]: &[DVec3; 3]) -> String {
    format!("({}, {}, {})", vector(*a), vector(*b), vector(*c))
}

fn mesh_motion(motion: MeshMotion) -> String {
    match motion {
        MeshMotion::Fixed => "Fixed".to_owned(),
        MeshMotion::Turning {
            through,
            axis,
            speed,
        } => format!(
            "Turning(through: {}, axis: {}, speed: {speed:?})",
            vector(through),
            vector(axis)
        ),
        MeshMotion::Moving { velocity } => format!("Moving(velocity: {})", vector(velocity)),
    }
}

fn container(container: &SceneContainer) -> String {
    match container {
        SceneContainer::Nothing => "Nothing".to_owned(),
        SceneContainer::Drum {
            radius,
            width,
            speed,
            material,
        } => format!(
            "Drum(radius: {radius:?}, width: {width:?}, speed: {speed:?}, material: {})",
            quoted(material)
        ),
        SceneContainer::Box { min, max, material } => format!(
            "Box(min: {}, max: {}, material: {})",
            vector(*min),
            vector(*max),
            quoted(material)
        ),
        SceneContainer::Column {
            radius,
            height,
            material,
            tube,
        } => {
            let tube = tube.as_ref().map_or_else(String::new, |tube| {
                let material = quoted(&tube.material);
                format!(
                    ", tube: (speed: {:?}, material: {material}, rim: {:?})",
                    tube.speed, tube.rim
                )
            });
            format!(
                "Column(radius: {radius:?}, height: {height:?}, material: {}{tube})",
                quoted(material)
            )
        }
        SceneContainer::Mesh {
            surface,
            material,
            motion,
            room,
        } => {
            let room = room.map_or_else(String::new, |(min, max)| {
                format!(", room: (min: {}, max: {})", vector(min), vector(max))
            });
            format!(
                "Mesh(triangles: {}, material: {}, motion: {}{room})",
                list('[', surface.triangles().iter().map(triangle), ']'),
                quoted(material),
                mesh_motion(*motion)
            )
        }
        SceneContainer::Planes(planes) => {
            format!("Planes({})", list('[', planes.iter().map(plane), ']'))
        }
    }
}

fn plane(plane: &ScenePlane) -> String {
    format!(
        "(name: {}, point: {}, normal: {}, velocity: {}, material: {})",
        quoted(&plane.name),
        vector(plane.point),
        vector(plane.normal),
        vector(plane.velocity),
        quoted(&plane.material)
    )
}

fn liquid_text(liquid: &Liquid) -> Result<String, String> {
    let law = ron::to_string(&liquid.law).map_err(|error| error.to_string())?;
    Ok(format!(
        "(surface_tension: {:?}, contact_angle: {:?}, viscosity: {:?}, volume: {:?}, law: Choices{law})",
        liquid.surface_tension, liquid.contact_angle, liquid.viscosity, liquid.volume
    ))
}

fn time_step(step: TimeStep) -> String {
    match step {
        TimeStep::Automatic => "Automatic".to_owned(),
        TimeStep::Following => "Following".to_owned(),
        TimeStep::Reference => "Reference".to_owned(),
        TimeStep::Fast => "Fast".to_owned(),
        TimeStep::Given(step) => format!("Given({step:?})"),
    }
}

fn grain(grain: &SceneGrain) -> String {
    format!(
        "(position: {}, velocity: {}, spin: {}, {}, material: {}{})",
        vector(grain.position),
        vector(grain.velocity),
        vector(grain.spin),
        body(grain),
        quoted(&grain.material),
        optional("film", grain.film)
    )
}

/// Size and shape: `radius: 0.003`, or shape, rounding and orientation.
fn body(grain: &SceneGrain) -> String {
    let SceneShape::Core {
        corners,
        faces,
        rounding,
        volume,
        gyration,
    } = &grain.shape
    else {
        return format!("radius: {:?}", grain.radius);
    };
    let corners: Vec<String> = corners.iter().copied().map(vector).collect();
    let turn = grain.orientation;
    format!(
        "shape: Core(corners: [{}], faces: {faces:?}, volume: {volume:?}, gyration: {}), rounding: {rounding:?}, \
         orientation: Quaternion(x: {:?}, y: {:?}, z: {:?}, w: {:?})",
        corners.join(", "),
        vector(*gyration),
        turn.x,
        turn.y,
        turn.z,
        turn.w
    )
}
