//! Where the keyboard's focus is: the ring round it, scrolling that keeps it in view, what has it
//! first in a dialog, and who gets it back from a dialog, a menu or a list that closes.
//!
//! In: egui's memory of the last frame. Out: a ring, a wish to scroll, a wish for the focus.

use crate::ui::theme::Palette;
use bevy_egui::egui::text::{CCursor, CCursorRange};
use bevy_egui::egui::text_edit::TextEditOutput;
use bevy_egui::egui::{self, Event, FocusDirection, Id, Key, Modifiers, Rect, Response};

/// What a dialog, a menu or a list lies over has the focus again when that goes.
#[derive(Default)]
pub struct FocusBelow {
    /// How many lie one over the other.
    covers: usize,
    /// What has the focus under all of them, over the first, and so on.
    kept: [Option<Id>; 3],
    /// What gets the focus back, as long as egui still keeps it from all that lies below a dialog:
    /// some frames longer than the dialog is there.
    owed: Option<Id>,
    /// Whether the focus was moved back, not on, the last time.
    goes_back: bool,
    /// Whether nothing is to have the focus.
    lets_go: bool,
}

impl FocusBelow {
    /// Takes note of the focus, and gives it back where fewer `covers` lie over the window than in
    /// the last frame. Nothing in the `menu_bar` gets it back: who has chosen there is done there.
    pub fn follow(&mut self, ctx: &egui::Context, covers: usize, menu_bar: Rect) {
        let mut focused = ctx.memory(egui::Memory::focused);
        if std::mem::take(&mut self.lets_go)
            && let Some(gone) = focused.take()
        {
            ctx.memory_mut(|memory| memory.surrender_focus(gone));
        }
        let is_left = focused.is_none() || focused == self.kept[self.covers];
        if covers < self.covers && is_left {
            self.owed = self.kept[covers];
            if let (None, Some(gone)) = (self.owed, focused) {
                ctx.memory_mut(|memory| memory.surrender_focus(gone));
            }
        }
        if let Some(below) = self.owed {
            self.owed = None;
            if let Some(control) = ctx.read_response(below) {
                control.request_focus();
                let may_have_it = ctx.memory(|memory| memory.allows_interaction(control.layer_id));
                self.owed = Some(below).filter(|_| !may_have_it);
            }
        } else if covers > 0 || !is_within(ctx, focused, menu_bar) {
            self.kept[covers] = focused;
        }
        self.covers = covers;
    }

    /// Nothing has the focus from the next frame on: another scene is there.
    pub fn let_go(&mut self) {
        (self.kept, self.owed, self.lets_go) = ([None; 3], None, true);
    }

    /// In a dialog, a menu or a list arrows lead on and back, as Tab does: where they led by the
    /// places of controls, they would lead to what lies below. To be called before these are drawn.
    pub fn lead(&mut self, ctx: &egui::Context) {
        let is_pressed = |wanted: Key, held: Modifiers| {
            let is_it = |event: &Event| match event {
                Event::Key {
                    key,
                    pressed,
                    modifiers,
                    ..
                } => *pressed && *key == wanted && *modifiers == held,
                _ => false,
            };
            ctx.input(|input| input.events.iter().any(is_it))
        };
        let is_plain = |key: &Key| is_pressed(*key, Modifiers::NONE);
        let arrows_on = [Key::ArrowDown, Key::ArrowRight].iter().any(is_plain);
        let arrows_back = [Key::ArrowUp, Key::ArrowLeft].iter().any(is_plain);
        if arrows_on || is_plain(&Key::Tab) {
            self.goes_back = false;
        } else if arrows_back || is_pressed(Key::Tab, Modifiers::SHIFT) {
            self.goes_back = true;
        }
        let by_arrows = (arrows_on || arrows_back) && !ctx.text_edit_focused();
        if by_arrows || is_on_a_ground(ctx) {
            let direction = if self.goes_back {
                FocusDirection::Previous
            } else {
                FocusDirection::Next
            };
            ctx.memory_mut(|memory| memory.move_focus(direction));
        }
    }
}

/// Whether the ground of a menu or a list has the focus, on which nothing can be done: egui counts
/// it among the controls.
fn is_on_a_ground(ctx: &egui::Context) -> bool {
    let focused = ctx.memory(egui::Memory::focused);
    let control = focused.and_then(|id| ctx.read_response(id));
    control.is_some_and(|control| control.id == control.layer_id.id.with("move"))
}

/// Whether what is `focused` stands in this `place`.
fn is_within(ctx: &egui::Context, focused: Option<Id>, place: Rect) -> bool {
    let control = focused.and_then(|id| ctx.read_response(id));
    control.is_some_and(|control| place.contains(control.rect.center()))
}

/// Gives the focus to `control` where nothing in the dialog that it stands in has it. Where Tab has
/// just led on from it, egui gives the focus to what comes next, and would do so later otherwise.
pub fn take_first_focus(control: &Response) {
    if control.lost_focus() {
        return;
    }
    let ctx = &control.ctx;
    let focused = ctx.memory(egui::Memory::focused);
    let layer = focused
        .and_then(|id| ctx.read_response(id))
        .map(|own| own.layer_id);
    if layer.is_none_or(|layer| !ctx.memory(|memory| memory.allows_interaction(layer))) {
        control.request_focus();
    }
}

/// Selects all of the `text` of a `field` that has just been drawn, so that what is typed takes its
/// place: where a key led to it, and where it `is_new`, in which case it gets the focus, too.
pub fn begin_to_type(ui: &egui::Ui, field: &mut TextEditOutput, text: &str, is_new: bool) {
    let response = &field.response.response;
    let by_key = response.gained_focus() && !response.is_pointer_button_down_on();
    if !is_new && !by_key {
        return;
    }
    let id = response.id;
    ui.memory_mut(|memory| memory.request_focus(id));
    let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
    field.state.cursor.set_char_range(Some(all));
    field.state.clone().store(ui.ctx(), id);
}

/// Whether somebody has pressed Enter in the `field` for a line of text.
pub fn is_entered(field: &Response) -> bool {
    field.lost_focus() && field.ctx.input(|input| input.key_pressed(Key::Enter))
}

/// Scrolls the area of `ui` so that a control that has just taken the keyboard's focus is in view.
pub fn follow_focus(ui: &egui::Ui) {
    let focused = ui.memory(egui::Memory::focused);
    let gained = focused.and_then(|id| ui.ctx().read_response(id));
    let is_within = |control: &egui::Response| {
        let is_here = ui.min_rect().intersects(control.rect);
        control.gained_focus() && control.layer_id == ui.layer_id() && is_here
    };
    if let Some(control) = gained.filter(is_within) {
        ui.scroll_to_rect(control.rect.expand(4.0), None);
    }
}

/// A ring round the control that the keyboard works.
pub fn focus_ui(ctx: &egui::Context, palette: Palette) {
    let focused = ctx.memory(egui::Memory::focused);
    let Some(response) = focused.and_then(|id| ctx.read_response(id)) else {
        return;
    };
    let ring = response.rect.intersect(response.interact_rect).expand(2.0);
    if ring.is_positive() {
        let stroke = egui::Stroke::new(2.0, palette.warning);
        ctx.layer_painter(egui::LayerId::new(
            egui::Order::Foreground,
            Id::new("focus"),
        ))
        .rect_stroke(ring, 4.0, stroke, egui::StrokeKind::Outside);
    }
}
