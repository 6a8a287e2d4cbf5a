//! Scenes written as text are read as the same scenes.

use super::{HOOKE, SPRING_DASHPOT, belt, dry_drum, wet_drum};
use crate::meshes::{drum, key};
use grainfall::scene::Scene;

#[test]
fn scene_as_text_is_read_as_the_same_scene() {
    let odd = dry_drum()
        .replace("Three grains", "Three \\\"grains\\\" \\\\ of α")
        .replace(
            "time_step: Given(1e-5)",
            "gravity: (0.1, -9, 1e-17), seed: 18446744073709551615, sample_interval: 2.5e-3",
        );
    // Normals across the axes are made unit vectors anew when they are read, to the last digit.
    let belt = |law| belt(law).replace("normal: (-1, 1, 0)", "normal: (-1, 0, 0)");
    let tube = r#"(
        title: "A tube", materials: {"glass": ()},
        container: Column(radius_mm: 25, height_mm: 50, material: "glass", tube: (speed: 0.1, rim: 0.02)),
        grains: List([(position: (0, 0.01, 0), radius_mm: 3, film: 1e-10, material: "glass")]),
        liquid: (case: 3),
    )"#;
    let cube = r#"(
        title: "A cube", materials: {"glass": ()}, container: Nothing,
        grains: List([(
            shape: Core(
                corners: [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)],
                faces: [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [1, 2, 6, 5], [3, 0, 4, 7]],
                volume: 11.390625, gyration: (0.84375, 0.84375, 0.84375),
            ),
            rounding: 0.125, position: (0, 0.01, 0), material: "glass",
            orientation: Quaternion(x: 0, y: 0, z: 0.6, w: 0.8),
        )]),
    )"#;
    let mesh = |motion: &str| {
        format!(
            "(title: \"A mesh\", materials: {{\"glass\": ()}}, container: Mesh({}, material: \"glass\"{motion}), \
             grains: List([(position: (0, 0, 0), radius_mm: 1, material: \"glass\")]))",
            key(&drum(0.03, 0.01, 12))
        )
    };
    for text in [
        cube.to_owned(),
        mesh(""),
        mesh(", motion: Turning(through: (0, 0.1, 0), axis: (0, -1, 0), speed_rpm: 7)"),
        mesh(
            ", motion: Moving(velocity: (0.1, 0, 1e-3)), room: (min: (-0.01, 0, 0), max: (0.01, 0.02, 0.005))",
        ),
        dry_drum(),
        wet_drum(),
        odd,
        belt(HOOKE),
        belt(SPRING_DASHPOT),
        tube.to_owned(),
    ] {
        let scene = Scene::parse("first", &text).unwrap();
        let written = scene.to_text().unwrap();
        let read = Scene::parse("written", &written).unwrap_or_else(|e| panic!("{e}: {written}"));
        assert_eq!(read, scene);
    }
    for name in ["dry-r3", "small-column", "two-grains"] {
        let scene = Scene::open(name).unwrap();
        let outcome = scene.to_text();
        assert_eq!(outcome.is_ok(), name == "two-grains", "{outcome:?}");
    }
}
