//! The point of a triangle nearest to a point, and where a ray hits it.
//!
//! In: three corners, a point. Out: the nearest point and whether it lies inside, on an edge or at a
//! corner (Ericson, Real-Time Collision Detection, 2005, section 5.1.5). Only + − × ÷. A ray is met as
//! by Möller and Trumbore (1997, J. Graphics Tools 2, 21).

use glam::DVec3;

/// Which part of a triangle a point of it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Region {
    /// The inside.
    Face,
    /// The edge from this corner to the next.
    Edge(usize),
    /// This corner.
    Corner(usize),
}

/// The point of the triangle `abc` nearest to `x`, and where in it that lies.
pub fn nearest_on_triangle(x: DVec3, [a, b, c]: [DVec3; 3]) -> (DVec3, Region) {
    let (ab, ac, ax) = (b - a, c - a, x - a);
    let (d1, d2) = (ab.dot(ax), ac.dot(ax));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, Region::Corner(0));
    }
    let bx = x - b;
    let (d3, d4) = (ab.dot(bx), ac.dot(bx));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, Region::Corner(1));
    }
    let over_c = d1 * d4 - d3 * d2;
    if over_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), Region::Edge(0));
    }
    let cx = x - c;
    let (d5, d6) = (ab.dot(cx), ac.dot(cx));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, Region::Corner(2));
    }
    let over_b = d5 * d2 - d1 * d6;
    if over_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), Region::Edge(2));
    }
    let over_a = d3 * d6 - d5 * d4;
    if over_a <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (b + (c - b) * share, Region::Edge(1));
    }
    // The foot on the plane, from the normal: exact where the plane lies along the axes.
    let normal = ab.cross(ac);
    let away = normal.dot(ax) / normal.length_squared();
    (x - normal * away, Region::Face)
}

/// How far from `origin` a ray along the unit vector `direction` hits the triangle `abc`, its edges
/// included; none where it does not.
pub fn hit_triangle(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let off = origin - a;
    let u = off.dot(across) / determinant;
    let turned = off.cross(ab);
    let v = direction.dot(turned) / determinant;
    let distance = ac.dot(turned) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against a search over barycentric coordinates, from all sides.
    #[test]
    fn nearest_point_is_nearer_than_all_others() {
        let corners = [
            DVec3::new(0.1, 0.0, 0.3),
            DVec3::new(1.1, 0.2, 0.0),
            DVec3::new(0.4, 0.9, -0.2),
        ];
        let mut regions = std::collections::BTreeSet::new();
        for k in 0..4000_u32 {
            let part =
                |shift: u32| f64::from((k.wrapping_mul(2_654_435_761) >> shift) & 255) / 85.0 - 1.0;
            let x = DVec3::new(part(0), part(8), part(16));
            let (nearest, region) = nearest_on_triangle(x, corners);
            regions.insert(format!("{region:?}"));
            let distance = (x - nearest).length();
            for i in 0..=20_u32 {
                for j in 0..=20 - i {
                    let (u, v) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                    let point = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                    assert!(
                        (x - point).length() >= distance - 1e-12,
                        "{x}: {nearest}, {point}"
                    );
                }
            }
        }
        assert_eq!(regions.len(), 7, "{regions:?}");
    }

    #[test]
    fn ray_hits_a_triangle_where_its_plane_is_met_inside_of_it() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let from = DVec3::new(0.25, 0.25, 2.0);
        assert_eq!(hit_triangle(from, DVec3::NEG_Z, corners), Some(2.0));
        assert_eq!(hit_triangle(from, DVec3::Z, corners), None);
        assert_eq!(hit_triangle(from, DVec3::X, corners), None);
        assert_eq!(hit_triangle(from + DVec3::X, DVec3::NEG_Z, corners), None);
    }
}
