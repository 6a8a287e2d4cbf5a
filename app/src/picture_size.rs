//! How large pictures may be.
//!
//! In: what somebody typed. Out: width and height, or why they cannot be.

use bevy::math::UVec2;
use std::ops::RangeInclusive;

/// Width and height that a picture may have [pixels].
pub const SIDES: RangeInclusive<u32> = 64..=8192;
/// The most that a picture may have [pixels]: 7680 × 4320. With several samples a pixel it takes a
/// gigabyte while it is drawn.
pub const MOST_PIXELS: u32 = 7680 * 4320;

/// The size that `text` states: `1920x1080`, `1920 × 1080`, `1920*1080`.
///
/// # Errors
/// What is wrong with it, and what is expected.
pub fn read(text: &str) -> Result<UVec2, String> {
    let sides = text.split(['x', 'X', '×', '*']);
    let sides: Option<Vec<u64>> = sides.map(|side| side.trim().parse().ok()).collect();
    let Some([width, height]) = sides.as_deref() else {
        let text = text.trim();
        return Err(format!(
            "“{text}” is no size: expected width × height in pixels, such as 1920 × 1080"
        ));
    };
    let allowed = |side: &u64| u32::try_from(*side).is_ok_and(|side| SIDES.contains(&side));
    if ![width, height].into_iter().all(allowed) {
        let (least, most) = (SIDES.start(), SIDES.end());
        return Err(format!(
            "{width} × {height} pixels cannot be: expected {least} to {most} for width and for height"
        ));
    }
    if width * height > u64::from(MOST_PIXELS) {
        return Err(format!(
            "{width} × {height} pixels are too many: expected as many as 7680 × 4320 has, or fewer"
        ));
    }
    Ok(UVec2::new(*width as u32, *height as u32))
}

/// `1920 × 1080`.
pub fn in_words(size: UVec2) -> String {
    format!("{} × {}", size.x, size.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_as_people_write_them() {
        for text in ["1920x1080", " 1920 × 1080 ", "1920X1080", "1920*1080"] {
            assert_eq!(read(text), Ok(UVec2::new(1920, 1080)), "{text}");
        }
        assert_eq!(
            read(&in_words(UVec2::new(64, 8192))),
            Ok(UVec2::new(64, 8192))
        );
    }

    #[test]
    fn sizes_that_cannot_be_are_refused_with_what_can_be() {
        for (text, says) in [
            ("", "expected width × height"),
            ("wide", "expected width × height"),
            ("640", "expected width × height"),
            ("640x480x3", "expected width × height"),
            ("-640x480", "expected width × height"),
            ("0x0", "expected 64 to 8192"),
            ("100000x100000", "expected 64 to 8192"),
            ("640x99999999999", "expected 64 to 8192"),
            ("8192x8192", "expected as many as 7680 × 4320"),
        ] {
            let refused = read(text).unwrap_err();
            assert!(refused.contains(says), "{text}: {refused}");
        }
    }
}
