//! STL files with mutated bytes, and the scenes whose walls they are.

use super::byte_mutator;
use super::targets::{Place, Target, one_of};
use grainfall::scene::Scene;
use grainfall::solver::{Solver, advise};
use grainfall::world::build;
use rand_chacha::ChaCha8Rng;
use std::path::PathBuf;

const TEXT: &str = "solid a\nfacet normal 0 0 1\n outer loop\n  vertex -1 0 -1\n  vertex 1 0 -1\n  vertex 0 0.1 1\n \
                    endloop\nendfacet\nfacet normal 0 0 1\n outer loop\n  vertex 1 0 -1\n  vertex -1 0 -1\n  vertex 0 2 0\n \
                    endloop\nendfacet\nendsolid a\n";

/// Meshes in text and binary.
pub struct MeshFiles {
    place: Place,
    whole: [Vec<u8>; 2],
    scene: PathBuf,
}

impl MeshFiles {
    pub fn new() -> Self {
        let place = Place::new();
        let text = "(title: \"a mesh\", materials: {\"glass\": ()}, container: Mesh(file: \"walls.stl\", scale: 0.1, \
                    material: \"glass\", motion: Turning(axis: (0, 1, 0), speed: 1)), \
                    grains: List([(position: (0, 0.051, 0), radius_mm: 1, material: \"glass\")]))";
        let mut binary = vec![0; 80];
        binary.extend(2_u32.to_le_bytes());
        for corners in [
            [[-1.0_f32, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 0.1, 1.0]],
            [[1.0, 0.0, -1.0], [-1.0, 0.0, -1.0], [0.0, 2.0, 0.0]],
        ] {
            binary.extend([0; 12]);
            binary.extend(corners.iter().flatten().flat_map(|x| x.to_le_bytes()));
            binary.extend([0; 2]);
        }
        Self {
            scene: place.write("scene.ron", text),
            whole: [TEXT.as_bytes().to_vec(), binary],
            place,
        }
    }
}

impl Target for MeshFiles {
    fn take(&mut self, rng: &mut ChaCha8Rng) -> bool {
        let bytes = byte_mutator::bytes(one_of::<Vec<u8>>(&self.whole, rng), rng);
        self.place.write("walls.stl", bytes);
        let Ok(scene) = Scene::load(&self.scene) else {
            return false;
        };
        let mut world = build(&scene, advise(&scene).time_step);
        world.check().expect("what a scene makes is sound");
        // A fault is a fair end of an odd run.
        let _ = Solver::new(1).advance(&mut world, 3);
        true
    }
}
