//! A scene that begins with a state.
//!
//! In: a scene and a state of it, recorded or imported. Out: a scene whose grains are listed as they
//! are then, between its walls where they stand by then. Contacts begin without springs and bridges:
//! no file of states holds them.

use crate::scene::{Scene, SceneContainer, SceneGrain, SceneGrains, SceneMesh, SceneShape};
use crate::world::{Container, Surface, World};
use glam::DQuat;

/// A scene that begins with the grains of `world`, a state of `scene`: each as it is then, in the
/// same container, walls that move where they stand by then. Grains of one material are one kind.
pub fn scene_from(scene: &Scene, world: &World) -> Scene {
    let grains = &world.grains;
    let listed = |i: usize| {
        let species = &world.species[usize::from(grains.species[i].0)];
        let (shape, orientation) = shape_of(world, i);
        SceneGrain {
            position: grains.position[i],
            velocity: grains.velocity[i],
            spin: grains.spin[i],
            radius: if shape.is_sphere() {
                grains.radius[i]
            } else {
                shape.radius()
            },
            shape,
            orientation,
            material: world.materials.get(species.material).name.clone(),
            film: world.wetting().map(|_| grains.film[i]),
        }
    };
    Scene {
        grains: SceneGrains::List((0..grains.len()).map(listed).collect()),
        container: container_from(&scene.container, &world.container),
        ..scene.clone()
    }
}

/// The same, where that is a scene that can be run.
///
/// # Errors
/// In words, why it is none.
pub fn sound_scene_from(scene: &Scene, world: &World) -> Result<Scene, String> {
    let mut scene = scene_from(scene, world);
    scene.title = format!("{}, from t = {:.3} s", scene.title, world.time());
    scene.check().map_err(|error| error.to_string())?;
    Ok(scene)
}

/// What grain `i` of `world` is, and how it is turned.
fn shape_of(world: &World, i: usize) -> (SceneShape, DQuat) {
    let Some(polyhedra) = &world.polyhedra else {
        return (SceneShape::Sphere, DQuat::IDENTITY);
    };
    let (shape, turn) = (polyhedra.shape_of(i), polyhedra.orientation[i]);
    if shape.faces.is_empty() {
        return (SceneShape::Sphere, turn);
    }
    let core = SceneShape::Core {
        corners: shape.vertices.clone(),
        faces: shape.faces.clone(),
        rounding: shape.rounding,
        volume: shape.volume,
        gyration: shape.gyration,
    };
    (core, turn)
}

/// The container `asked` for, its walls where they stand in `now`.
fn container_from(asked: &SceneContainer, now: &Container) -> SceneContainer {
    let mut container = asked.clone();
    match &mut container {
        SceneContainer::Column {
            tube: Some(tube), ..
        } => {
            let rims = now.walls.iter().find_map(|wall| match wall.surface {
                Surface::Tube { rim, .. } => Some(rim),
                _ => None,
            });
            tube.rim = rims.unwrap_or(tube.rim);
        }
        SceneContainer::Planes(planes) => {
            for (plane, wall) in planes.iter_mut().zip(&now.walls) {
                if let Surface::Plane { point, .. } = wall.surface {
                    plane.point = point;
                }
            }
        }
        SceneContainer::Mesh { surface, .. } => {
            let parts = now.walls.iter().filter_map(|wall| match &wall.surface {
                Surface::Mesh(mesh) => Some(mesh.triangles()),
                _ => None,
            });
            // Corners that met meet still, so that what was a surface is one.
            if let Ok(turned) = SceneMesh::new(parts.flatten().collect()) {
                *surface = turned;
            }
        }
        // A drum looks the same however far it has turned; boxes and floors stand.
        SceneContainer::Nothing
        | SceneContainer::Drum { .. }
        | SceneContainer::Box { .. }
        | SceneContainer::Column { tube: None, .. } => {}
    }
    container
}
