//! Where the pointer was when a button was let go.
//!
//! In: the events of a frame, in order. Out: the same for egui, without the ways that the pointer went
//! after that; these come a frame later. Egui lets what is dragged follow the last place of a frame. In
//! a slow frame a slider that is let go would then jump to where the pointer went on to.

use bevy::prelude::*;
use bevy_egui::egui::Event;
use bevy_egui::{EguiInput, PrimaryEguiContext};

/// Corrects the events of this frame before egui reads them.
pub fn end_drags_where_they_end(
    mut later: Local<Vec<Event>>,
    context: Option<Single<&mut EguiInput, With<PrimaryEguiContext>>>,
) {
    if let Some(mut context) = context {
        hold_back(&mut context.0.events, &mut later);
    }
}

/// Puts what is `later` before the `events`, and takes from these where the pointer went after a button
/// was let go for the last time.
fn hold_back(events: &mut Vec<Event>, later: &mut Vec<Event>) {
    events.splice(0..0, later.drain(..));
    let is_release = |event: &Event| matches!(event, Event::PointerButton { pressed: false, .. });
    let Some(released) = events.iter().rposition(is_release) else {
        return;
    };
    let is_way = |event: &mut Event| matches!(event, Event::PointerMoved(_) | Event::PointerGone);
    later.extend(events.extract_if(released + 1.., is_way));
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::{
        CentralPanel, Context, Modifiers, PointerButton, Pos2, RawInput, Slider, pos2,
    };

    fn button(pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    /// The value of a slider from 0 to 1 after these frames.
    fn dragged(frames: impl IntoIterator<Item = Vec<Event>>) -> f64 {
        let (context, mut value) = (Context::default(), 0.0);
        for events in frames {
            let input = RawInput {
                events,
                ..RawInput::default()
            };
            let _ = context.run_ui(input, |ui| {
                CentralPanel::default().show(ui, |ui| {
                    ui.add(Slider::new(&mut value, 0.0..=1.0).show_value(false));
                });
            });
        }
        value
    }

    #[test]
    fn a_slider_stays_where_it_is_let_go_however_slow_the_frame() {
        let (begin, end, away) = (pos2(20.0, 18.0), pos2(60.0, 18.0), pos2(900.0, 300.0));
        let frames = [
            vec![Event::PointerMoved(begin)],
            vec![button(begin, true)],
            vec![
                Event::PointerMoved(end),
                button(end, false),
                Event::PointerMoved(away),
            ],
            vec![],
        ];
        assert_eq!(dragged(frames.clone()), 1.0, "egui needs this no more");
        let mut later = Vec::new();
        let corrected = frames.map(|mut events| {
            hold_back(&mut events, &mut later);
            events
        });
        assert_eq!(corrected[3], [Event::PointerMoved(away)]);
        let value = dragged(corrected);
        assert!((0.2..0.8).contains(&value), "{value}");
    }
}
