//! Scenes for LIGGGHTS and LAMMPS: their files against golden ones, what is refused, and, where a
//! program is installed, its run beside ours.

mod beside;
mod exadem;
pub mod import;
mod scene_text;

use glam::DVec3;
use grainfall::engines::{Export, ExportError, Exported, MpiEngine, WallMesh, export};
use grainfall::scene::Scene;
use grainfall::solver::advise;
use grainfall::world::{World, build};
use std::fs;
use std::path::Path;

/// A drum that turns, with grains of two sizes and materials, without the liquid.
const DRUM: &str = r#"(
    title: "Three grains in a drum",
    materials: {
        "glass": (youngs_modulus: 63e6, poisson_ratio: 0.21, density: 2500, restitution: 0.95, friction: 0.40, wet_friction: 0.10, rolling_friction: 0.01),
        "steel": (youngs_modulus: 2e8, poisson_ratio: 0.3, density: 7800, restitution: 0.6, friction: 0.2),
        "drum": (youngs_modulus: 12e6, poisson_ratio: 0.35),
    },
    pairs: [(between: ("glass", "drum"), restitution: 0.72, friction: 0.30, wet_friction: 0.15)],
    container: Drum(radius_mm: 30, width_mm: 20, speed_rpm: -30, material: "drum"),
    grains: List([
        (position: (0.001, -0.026, 0.0015), radius_mm: 3, material: "glass"),
        (position: (0.012, -0.022, -0.002), velocity: (0.1, 0, -0.2), spin: (1, 2, 3), radius_mm: 2, material: "steel"),
        (position: (-0.012, -0.02, 0.005), radius_mm: 2.5, material: "glass"),
    ]),
    time_step: Given(1e-5), duration: 0.1, output_interval: 0.02,
    LIQUID
)"#;

const WATER: &str = "liquid: (case: 1, volume_ml: 0.02, law: AsCoded),";

/// A belt and a slope, which are no primitive walls, under linear springs.
const BELT: &str = r#"(
    title: "A grain on a belt",
    materials: {"glass": (restitution: 0.8)},
    container: Planes([
        (name: "belt", point: (0, 0, 0), normal: (0, 1, 0), velocity: (0.2, 0, 0), material: "glass"),
        (name: "slope", point: (0.05, 0, 0), normal: (-1, 1, 0), material: "glass"),
        (name: "back", point: (0, 0, -0.02), normal: (0, 0, 1), material: "glass"),
    ]),
    grains: List([(position: (0, 0.0032, 0), radius_mm: 3, material: "glass")]),
    law: LAW,
    time_step: Given(1e-5), duration: 0.1, output_interval: 0.02,
)"#;

const SPRING_DASHPOT: &str = "SpringDashpot(normal_stiffness: 10000, tangential_stiffness: 3000)";
const HOOKE: &str = "Hooke(normal_stiffness: 10000, tangential_stiffness: 3000)";

fn dry_drum() -> String {
    DRUM.replace("LIQUID", "")
}

fn wet_drum() -> String {
    DRUM.replace("LIQUID", WATER)
}

fn belt(law: &str) -> String {
    BELT.replace("LAW", law)
}

fn built(text: &str) -> (Scene, World) {
    let scene = Scene::parse("test", text).unwrap();
    let world = build(&scene, advise(&scene).time_step);
    (scene, world)
}

fn export_text(text: &str, engine: MpiEngine, out: &Path) -> Result<Exported, ExportError> {
    let (scene, world) = built(text);
    let handed = Export {
        name: "test",
        scene: &scene,
        commands: &[],
        world: &world,
        is_settled: true,
    };
    export(handed, engine, out)
}

/// The file called `name` without its first line, which states version and hash.
fn body(folder: &Path, name: &str) -> String {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    text.split_once('\n').unwrap().1.to_owned()
}

#[test]
fn decks_are_the_golden_ones() {
    let liggghts = MpiEngine::Liggghts;
    let cases = [
        ("drum.liggghts", dry_drum(), liggghts),
        ("wet.liggghts", wet_drum(), liggghts),
        ("belt.liggghts", belt(HOOKE), liggghts),
        ("drum.lammps", dry_drum(), MpiEngine::Lammps),
        ("belt.lammps", belt(SPRING_DASHPOT), MpiEngine::Lammps),
    ];
    let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/core/engines");
    let found = Path::new(env!("CARGO_TARGET_TMPDIR")).join("engines");
    fs::create_dir_all(&found).unwrap();
    let mut different = Vec::new();
    for (name, scene, engine) in cases {
        let folder = tempfile::tempdir().unwrap();
        export_text(&scene, engine, folder.path()).unwrap();
        let script = body(folder.path(), &format!("in.{}", engine.word()));
        fs::write(found.join(name), &script).unwrap();
        if script != fs::read_to_string(golden.join(name)).unwrap() {
            different.push(name);
        }
        assert!(folder.path().join("export.json").is_file());
    }
    assert!(
        different.is_empty(),
        "{different:?}: see {}",
        found.display()
    );
}

#[test]
fn data_file_states_grains_with_every_digit() {
    let folder = tempfile::tempdir().unwrap();
    export_text(&dry_drum(), MpiEngine::Liggghts, folder.path()).unwrap();
    let text = body(folder.path(), "grains.data");
    // Types: glass, steel; the drum's is the third.
    assert!(text.contains("3 atoms\n3 atom types\n"), "{text}");
    assert!(
        text.contains("\n2 2 4e-3 7.8e3 1.2e-2 -2.2e-2 -2e-3\n"),
        "{text}"
    );
    assert!(text.contains("\n2 1e-1 0e0 -2e-1 1e0 2e0 3e0\n"), "{text}");
    let lammps = tempfile::tempdir().unwrap();
    export_text(&dry_drum(), MpiEngine::Lammps, lammps.path()).unwrap();
    // There, a species of two radii is two types.
    let text = body(lammps.path(), "grains.data");
    assert!(
        text.contains("3 atoms\n3 atom types\n") && text.contains("\n3 3 5e-3 2.5e3 "),
        "{text}"
    );
}

#[test]
fn what_an_engine_does_not_have_is_refused_by_name() {
    let cube = r#"(
        title: "A cube", materials: {"glass": ()}, container: Nothing,
        grains: List([(position: (0, 0, 0), shape: Box(size: (0.01, 0.01, 0.01)), material: "glass")]),
    )"#;
    let tube = r#"(
        title: "A tube", materials: {"glass": ()},
        container: Column(radius_mm: 25, height_mm: 50, material: "glass", tube: (speed: 0.1)),
        grains: List([(position: (0, 0.01, 0), radius_mm: 3, material: "glass")]),
    )"#;
    let soft = dry_drum().replace("restitution: 0.6", "restitution: 0.1");
    let printed = wet_drum().replace("AsCoded", "AsPrinted");
    let filmy = wet_drum().replace("radius_mm: 2, ", "radius_mm: 2, film: 1e-10, ");
    let (liggghts, lammps) = (MpiEngine::Liggghts, MpiEngine::Lammps);
    let cases = [
        (cube, liggghts, "polyhedra"),
        (cube, lammps, "polyhedra"),
        (tube, liggghts, "`tube` is a rising tube"),
        (&printed, liggghts, "bridge-law=as-coded"),
        (&filmy, liggghts, "one share for all"),
        (&wet_drum(), lammps, "no liquid bridges"),
        (&soft, lammps, "a restitution of 0.1"),
        (
            &soft.replace("0.1,", "0.01,"),
            liggghts,
            "a restitution of 0.01",
        ),
    ];
    for (scene, engine, expected) in cases {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let error = export_text(scene, engine, &out).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
        assert!(!out.exists(), "{expected}: nothing is written");
    }
}

#[test]
fn mesh_is_handed_to_liggghts_as_it_stands_and_refused_for_others() {
    let motion = "Turning(through: (0, 0.1, 0), axis: (0, 0, -2), speed: 4)";
    let meshed = |motion: &str| {
        format!(
            "(title: \"A mesh\", materials: {{\"glass\": (), \"steel\": ()}}, container: Mesh({}, material: \"steel\", \
             motion: {motion}), grains: List([(position: (0, 0, 0), radius_mm: 1, material: \"glass\")]), duration: 2)",
            crate::meshes::key(&crate::meshes::drum(0.03, 0.01, 36))
        )
    };
    let folder = tempfile::tempdir().unwrap();
    export_text(&meshed(motion), MpiEngine::Liggghts, folder.path()).unwrap();
    let script = body(folder.path(), "in.liggghts");
    for line in [
        "fix mesh all mesh/surface file mesh.stl type 2 curvature 20 curvature_tolerant yes\n",
        "rotate origin 0e0 1e-1 0e0 axis 0e0 0e0 -1e0 period 1.5707963267948966e0\n",
        "mesh n_meshes 1 meshes mesh",
    ] {
        assert!(script.contains(line), "{line}: {script}");
    }
    let stl = fs::read(folder.path().join("mesh.stl")).unwrap();
    let triangles = grainfall::geometry::read_stl(&stl).unwrap();
    assert_eq!(triangles.len(), 4 * 36);
    let out = folder.path().join("moving");
    export_text(
        &meshed("Moving(velocity: (0, 0.5, 0))"),
        MpiEngine::Liggghts,
        &out,
    )
    .unwrap();
    let script = body(&out, "in.liggghts");
    assert!(
        script.contains("move/mesh mesh mesh linear 0e0 5e-1 0e0\n"),
        "{script}"
    );
    let data = body(&out, "grains.data");
    let high = data.lines().find(|line| line.ends_with("ylo yhi")).unwrap();
    let high: f64 = high.split(' ').nth(1).unwrap().parse().unwrap();
    assert!(high > 1.03, "room for its way of 1 m: {high}");
    let out = folder.path().join("refused");
    for (engine, expected) in [
        (MpiEngine::Lammps, "`--to liggghts` takes meshes"),
        (MpiEngine::Exadem, "no plane at rest"),
    ] {
        let error = export_text(&meshed(motion), engine, &out)
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn folder_of_others_or_with_results_stays_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    export_text(&dry_drum(), MpiEngine::Liggghts, out).unwrap();
    // Again into the same folder: the same files.
    let before = body(out, "in.liggghts");
    export_text(&dry_drum(), MpiEngine::Liggghts, out).unwrap();
    assert_eq!(body(out, "in.liggghts"), before);
    fs::create_dir(out.join("dumps")).unwrap();
    fs::write(out.join("dumps/grains_0.dump"), "results").unwrap();
    let error = export_text(&wet_drum(), MpiEngine::Liggghts, out).unwrap_err();
    assert!(error.to_string().contains("its engine has run"), "{error}");
    assert_eq!(body(out, "in.liggghts"), before);
    let foreign = tempfile::tempdir().unwrap();
    fs::write(foreign.path().join("thesis.tex"), "years").unwrap();
    let error = export_text(&dry_drum(), MpiEngine::Liggghts, foreign.path()).unwrap_err();
    assert!(error.to_string().contains("not an export's"), "{error}");
    assert_eq!(fs::read_dir(foreign.path()).unwrap().count(), 1);
}

#[test]
fn deviations_are_said_in_the_folder_and_by_the_call() {
    let folder = tempfile::tempdir().unwrap();
    let exported = export_text(&wet_drum(), MpiEngine::Liggghts, folder.path()).unwrap();
    let text = body(folder.path(), "DEVIATIONS.txt");
    for deviation in &exported.deviations {
        assert!(text.contains(deviation), "{deviation}");
    }
    for word in [
        "does not turn",
        "flat facets",
        "cdt",
        "shares its liquid",
        "has no bound",
    ] {
        assert!(text.contains(word), "{word} in {text}");
    }
    // Nothing touches in it yet, so there are no springs to tell of.
    assert!(!text.contains("Contacts begin"), "{text}");
}

#[test]
fn names_from_a_scene_are_no_commands_of_an_engine() {
    let scene = belt(HOOKE)
        .replace("A grain on a belt", r#"A \"\"\" grain & on $x"#)
        .replace("slope", "slöpe-1");
    let folder = tempfile::tempdir().unwrap();
    export_text(&scene, MpiEngine::Liggghts, folder.path()).unwrap();
    let script = fs::read_to_string(folder.path().join("in.liggghts")).unwrap();
    let first = script.lines().next().unwrap();
    assert!(
        first.starts_with("# ") && first.contains("''' grain & on $x”, seed"),
        "{first}"
    );
    assert!(
        script.contains("\nfix sl_pe_1_2 all mesh/surface "),
        "{script}"
    );
    // The format of the dumps has two quotes.
    assert_eq!(script.matches('"').count(), 2, "{script}");
}

#[test]
fn what_has_not_settled_is_said_so() {
    let (scene, world) = built(&dry_drum());
    let folder = tempfile::tempdir().unwrap();
    let handed = Export {
        name: "test",
        scene: &scene,
        commands: &[],
        world: &world,
        is_settled: false,
    };
    let exported = export(handed, MpiEngine::Lammps, folder.path()).unwrap();
    assert!(
        exported
            .deviations
            .iter()
            .any(|text| text.contains("they fall first"))
    );
}

#[test]
fn facets_of_a_rim_have_its_mean_radius() {
    let (radius, facets) = (0.03, 60);
    let rim = WallMesh::rim("rim", radius, 0.01, facets);
    assert_eq!(rim.triangles().len(), 2 * facets);
    // Gap of a point near the rim, in all directions: the least over the facets.
    let gap = |angle: f64| {
        let x = 0.97 * radius * DVec3::new(angle.cos(), angle.sin(), 0.0);
        let of_facet = |[a, b, c]: &[DVec3; 3]| {
            let normal = (*b - *a).cross(*c - *a).normalize();
            assert!(normal.dot(*a) < 0.0, "normals point inward");
            (x - *a).dot(normal)
        };
        rim.triangles()
            .iter()
            .map(of_facet)
            .fold(f64::INFINITY, f64::min)
    };
    let count = 4000;
    let mean = (0..count)
        .map(|k| gap(f64::from(k) * 1e-3 * std::f64::consts::FRAC_PI_2))
        .sum::<f64>()
        / f64::from(count);
    let sagitta = radius * (std::f64::consts::PI / facets as f64).powi(2) / 2.0;
    assert!(
        (mean - 0.03 * radius).abs() < 0.05 * sagitta,
        "{mean:e}, {sagitta:e}"
    );
}
