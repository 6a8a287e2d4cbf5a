//! Rows: elementwise sums of four numbers side by side in memory.

pub use crate::lanes::Row;

/// `a − b`, element by element.
#[inline(always)]
pub fn sub(a: Row, b: Row) -> Row {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

/// Square of the length of the vector part.
#[inline(always)]
pub fn length_squared(a: Row) -> f64 {
    a[0] * a[0] + a[1] * a[1] + a[2] * a[2]
}

/// The vector `v` with the companion `w`.
#[inline(always)]
pub fn row(v: glam::DVec3, w: f64) -> Row {
    [v.x, v.y, v.z, w]
}

/// The vector part.
#[inline(always)]
pub fn vector(a: Row) -> glam::DVec3 {
    glam::DVec3::new(a[0], a[1], a[2])
}
