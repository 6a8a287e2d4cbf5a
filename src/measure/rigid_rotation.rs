//! Where rigid rotation alone looks like flow.
//!
//! In: the granular temperature in the laboratory frame of a bed that turns with its drum as one
//! body. Out: a sentence for people where that comes to the paper's line. In the drum's own frame
//! such a bed has none, so the share of the time in which it flows stands there as well.

use super::flow::NON_RIGID_TEMPERATURE;
use super::run_quantity::RunQuantity;

/// Share of the line from which on rotation counts as coming to it: where grains lie, and so the
/// temperature of their rotation, changes by a fifth within a run.
const NEAR_THE_LINE: f64 = 0.8;

/// What to think of the non-rigid share ta/ts where rigid rotation alone has the granular
/// temperature `rotation` [m²/s²]; none where that is well below the line.
pub fn rotation_note(rotation: f64) -> Option<String> {
    let quantity = RunQuantity::RotationTemperature.quantity();
    let [own, line] = [rotation, NON_RIGID_TEMPERATURE].map(|value| quantity.text(value));
    let comes = if rotation >= NON_RIGID_TEMPERATURE {
        "passes"
    } else if rotation >= NEAR_THE_LINE * NON_RIGID_TEMPERATURE {
        "comes near"
    } else {
        return None;
    };
    Some(format!(
        "Turning with the drum as one rigid body, this bed alone has Tg = {own}, which {comes} the \
         paper's line of {line}: the paper's ta/ts counts rest as flow; ta/ts′, in the drum's \
         frame, does not."
    ))
}

#[cfg(test)]
mod tests {
    use super::rotation_note;

    #[test]
    fn only_rotation_that_comes_to_the_line_is_spoken_of() {
        assert_eq!(rotation_note(6.1e-10), None);
        assert_eq!(rotation_note(f64::NAN), None);
        assert!(
            rotation_note(1.8e-9)
                .unwrap()
                .contains("1.80·10⁻⁹ m²/s², which comes near")
        );
        assert!(
            rotation_note(2.4e-9)
                .unwrap()
                .contains("which passes the paper's line of 2.00·10⁻⁹")
        );
    }
}
