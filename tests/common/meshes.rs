//! Surfaces of triangles, and how scene files spell them.

use glam::DVec3;
use grainfall::engines::WallMesh;

/// Triangles of a quadrilateral, round its outline.
pub fn quad([a, b, c, d]: [DVec3; 4]) -> Vec<[DVec3; 3]> {
    vec![[a, b, c], [a, c, d]]
}

/// A closed drum about the z axis of so many facets: the rim's mean radius is `radius`, and each plate
/// a fan of triangles about its middle [m].
pub fn drum(radius: f64, width: f64, facets: usize) -> Vec<[DVec3; 3]> {
    let half = 0.5 * width;
    let rim = WallMesh::rim("rim", radius, half, facets);
    let mut triangles = rim.triangles().to_vec();
    for two in rim.triangles() {
        for side in [-half, half] {
            let on_side: Vec<DVec3> = two.iter().copied().filter(|x| x.z == side).collect();
            if let [a, b] = on_side[..] {
                triangles.push([DVec3::new(0.0, 0.0, side), b, a]);
            }
        }
    }
    triangles
}

/// The drum of `scenes/meshes/lifters.stl`: 60 mm across and 15 mm wide, of 120 facets, with six
/// lifters 2.5 mm thick that stand 6 mm high on the rim [m].
pub fn lifter_drum() -> Vec<[DVec3; 3]> {
    let (radius, half) = (0.03, 0.0075);
    let mut triangles = drum(radius, 2.0 * half, 120);
    for k in 0..6 {
        let angle = f64::from(k) * std::f64::consts::TAU / 6.0;
        let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let along = DVec3::Z.cross(out);
        let corner = |r: f64, s: f64, z: f64| out * r + along * s + DVec3::Z * z;
        let outline = [(-0.006, -1.0), (-0.006, 1.0), (0.001, 1.0), (0.001, -1.0)];
        let end = |z: f64| outline.map(|(r, s)| corner(radius + r, 0.00125 * s, z));
        let [low, high] = [end(-half), end(half)];
        triangles.extend(quad(low));
        triangles.extend(quad(high));
        for j in 0..4 {
            let next = (j + 1) % 4;
            triangles.extend(quad([low[j], low[next], high[next], high[j]]));
        }
    }
    triangles
}

/// `triangles: […]`.
pub fn key(triangles: &[[DVec3; 3]]) -> String {
    let corner = |x: &DVec3| format!("({:?}, {:?}, {:?})", x.x, x.y, x.z);
    let each = triangles.iter().map(|triangle| {
        let corners: Vec<String> = triangle.iter().map(corner).collect();
        format!("({})", corners.join(", "))
    });
    format!("triangles: [{}]", each.collect::<Vec<_>>().join(", "))
}

/// A binary STL file of `triangles`.
pub fn stl(triangles: &[[DVec3; 3]]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for x in triangle.iter().flat_map(DVec3::to_array) {
            bytes.extend((x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}
