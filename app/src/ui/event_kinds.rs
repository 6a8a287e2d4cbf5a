//! Which kinds of events are shown: in the list, on the time slider, and where its keys lead.

use bevy_egui::egui::{Context, Id};
use grainfall::run::EventKind;

/// Kinds of events that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EventKinds([bool; EventKind::ALL.len()]);

impl Default for EventKinds {
    /// All but the ends of contacts.
    fn default() -> Self {
        Self(EventKind::ALL.map(|kind| kind != EventKind::Parting))
    }
}

impl EventKinds {
    /// What is shown now.
    pub fn of(ctx: &Context) -> Self {
        let chosen = ctx.data(|data| data.get_temp(Id::new("event kinds")));
        chosen.unwrap_or_default()
    }

    /// Shows these from now on.
    pub fn choose(self, ctx: &Context) {
        ctx.data_mut(|data| data.insert_temp(Id::new("event kinds"), self));
    }

    /// Whether those of `kind` are shown.
    pub fn show(self, kind: EventKind) -> bool {
        self.0[kind as usize]
    }

    /// Whether those of `kind` are shown, to be changed.
    pub fn shown_mut(&mut self, kind: EventKind) -> &mut bool {
        &mut self.0[kind as usize]
    }

    /// Their names, as a session keeps them.
    pub fn in_words(self) -> String {
        let shown = EventKind::ALL.into_iter().filter(|kind| self.show(*kind));
        shown.map(EventKind::name).collect::<Vec<_>>().join(" ")
    }

    /// Those that are named in `words`.
    pub fn read(words: &str) -> Self {
        Self(EventKind::ALL.map(|kind| words.split(' ').any(|word| word == kind.name())))
    }
}
