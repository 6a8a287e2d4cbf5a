//! The picture in equal parts side by side.
//!
//! In: the free part of the window. Out: where each part lies in it.

use bevy_egui::egui::{Rect, pos2, vec2};

/// Room between two halves, in points.
pub(super) const BETWEEN: f32 = 2.0;

/// What is left of `rect` beside a `margin` at its right.
pub(super) fn beside(rect: Rect, margin: f32) -> Rect {
    Rect::from_min_max(rect.min, pos2(rect.max.x - margin, rect.max.y))
}

/// `rect` in `count` equal parts, from left to right.
pub(super) fn parts(rect: Rect, count: usize) -> impl Iterator<Item = Rect> {
    let width = ((rect.width() + BETWEEN) / count as f32 - BETWEEN).max(0.0);
    (0..count).map(move |i| {
        let left = rect.left() + i as f32 * (width + BETWEEN);
        Rect::from_min_size(pos2(left, rect.top()), vec2(width, rect.height()))
    })
}

/// Where the part of the picture that is framed in `rect` is seen: the last one goes on under a
/// `margin` that is free.
pub(super) fn seen_part(rect: Rect, is_last: bool, margin: f32) -> Rect {
    rect.with_max_x(rect.right() + if is_last { margin } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_equal_and_fill_the_picture() {
        let free = Rect::from_min_max(pos2(300.0, 40.0), pos2(1002.0, 700.0));
        let halves: Vec<Rect> = parts(free, 2).collect();
        assert_eq!(halves[0].size(), halves[1].size());
        assert_eq!((halves[0].left(), halves[1].right()), (300.0, 1002.0));
        assert_eq!(halves[1].left() - halves[0].right(), BETWEEN);
        assert_eq!(parts(free, 1).collect::<Vec<_>>(), [free]);
    }
}
