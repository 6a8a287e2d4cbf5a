//! Where panels stand: on which side, in which order, which of them are closed, and how much of the
//! window the sides may take.
//!
//! In: what a person asked for, the window's size. Out: plain data, by the titles of panels; a title
//! that is not listed stays where it is at first.

use bevy_egui::egui::Vec2;
use serde::{Deserialize, Serialize};

/// A window narrower than this has room for one side only [points]: the picture comes first.
const ROOM_FOR_BOTH: f32 = 1280.0;
/// A window narrower than this has room for none [points].
const ROOM_FOR_ONE: f32 = 680.0;
/// Share of the window that the picture has at least.
const PICTURE: f32 = 0.45;
/// Height of menu bar and transport bar together, at most [points].
const BARS: f32 = 128.0;
/// A side that is shown alone takes this share of what it may, at first.
const LONE: f32 = 0.75;
/// Narrowest sides [points]: below, numbers do not fit.
const NARROWEST: [f32; 2] = [240.0, 280.0];

/// The side of the window on which a panel stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Controls.
    Left,
    /// Plots and results.
    Right,
}

impl Side {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// `left` or `right`.
    pub fn label(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// Which of the side panels are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpenSides {
    /// Controls.
    pub left: bool,
    /// Plots and results.
    pub right: bool,
}

impl OpenSides {
    /// Whether a window of this `width` [points] shows that side.
    pub fn has_room(self, side: Side, width: f32) -> bool {
        match side {
            Side::Left => width >= ROOM_FOR_ONE,
            Side::Right => width >= ROOM_FOR_BOTH || (width >= ROOM_FOR_ONE && !self.left),
        }
    }

    /// Width of that side at first, and its limits, in a window of this `size` [points]: what is
    /// left for the picture is [`PICTURE`] of the window.
    pub fn widths(self, side: Side, size: Vec2) -> SideWidths {
        let picture = PICTURE * size.x * size.y / (size.y - BARS).max(1.0);
        let room = (size.x - picture).max(0.0);
        let both = self.left && self.right && size.x >= ROOM_FOR_BOTH;
        let (share, [usual, most], least) = match side {
            Side::Left => (0.44, [380.0, 520.0], NARROWEST[0]),
            Side::Right => (0.56, [560.0, 900.0], NARROWEST[1]),
        };
        let room = if both { share * room } else { room };
        let most = room.clamp(least, most);
        SideWidths {
            first: if both { room } else { LONE * room }.clamp(least, usual.min(most)),
            least,
            most,
        }
    }
}

/// How wide a side is [points].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideWidths {
    /// Until somebody drags its edge.
    pub first: f32,
    /// At least.
    pub least: f32,
    /// At most.
    pub most: f32,
}

/// Why the window does not show both sides, where it has no room for them.
pub fn why_not_both(width: f32) -> Option<&'static str> {
    if width >= ROOM_FOR_BOTH {
        None
    } else if width >= ROOM_FOR_ONE {
        Some("The window has room for one of them. Without the controls, the plots are shown.")
    } else {
        Some("The window is too narrow for them.")
    }
}

/// What a person asks of the places of panels, by their titles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rearrangement {
    /// One place up.
    Up(&'static str),
    /// One place down.
    Down(&'static str),
    /// To the top of the other side.
    Across(&'static str),
    /// Away, until it is asked for again.
    Close(&'static str),
    /// Back to where it was.
    Show(&'static str),
    /// All of them as at first.
    AsAtFirst,
}

/// Where panels stand, by their titles.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Arrangement {
    /// On the left, from top to bottom.
    pub left: Vec<String>,
    /// On the right, from top to bottom.
    pub right: Vec<String>,
    /// Those that are closed, on whichever side they stand.
    pub closed: Vec<String>,
}

impl Arrangement {
    /// Those of one side, from top to bottom.
    pub fn of(&self, side: Side) -> &[String] {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    fn of_mut(&mut self, side: Side) -> &mut Vec<String> {
        match side {
            Side::Left => &mut self.left,
            Side::Right => &mut self.right,
        }
    }

    /// Whether the panel called `title` is closed.
    pub fn is_closed(&self, title: &str) -> bool {
        self.closed.iter().any(|closed| closed == title)
    }

    /// On which side the panel called `title` stands, and at which place.
    pub fn place(&self, title: &str) -> Option<(Side, usize)> {
        let on = |side| {
            let place = self.of(side).iter().position(|own| own == title);
            Some((side, place?))
        };
        Side::ALL.into_iter().find_map(on)
    }

    /// Does what was asked, but [`Rearrangement::AsAtFirst`]. A panel goes past those that are not
    /// `shown` now without a place of its own for each.
    pub fn rearrange(&mut self, asked: Rearrangement, shown: &[&str]) {
        match asked {
            Rearrangement::Up(title) => self.shift(title, shown, |own, at| at < own),
            Rearrangement::Down(title) => self.shift(title, shown, |own, at| at > own),
            Rearrangement::Across(title) => {
                if let Some((side, place)) = self.place(title) {
                    let moved = self.of_mut(side).remove(place);
                    self.of_mut(side.other()).insert(0, moved);
                }
            }
            Rearrangement::Close(title) => {
                if !self.is_closed(title) {
                    self.closed.push(title.to_owned());
                }
            }
            Rearrangement::Show(title) => self.closed.retain(|closed| closed != title),
            Rearrangement::AsAtFirst => {}
        }
    }

    /// Takes `title` to the place of the nearest panel shown that lies on its way, `is_on_way` by
    /// its own place and the other's.
    fn shift(&mut self, title: &str, shown: &[&str], is_on_way: fn(usize, usize) -> bool) {
        let Some((side, own)) = self.place(title) else {
            return;
        };
        let list = self.of_mut(side);
        let others = list.iter().enumerate();
        let others =
            others.filter(|(at, other)| is_on_way(own, *at) && shown.contains(&other.as_str()));
        let nearest = others.map(|(at, _)| at).min_by_key(|at| at.abs_diff(own));
        if let Some(place) = nearest {
            let moved = list.remove(own);
            list.insert(place, moved);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_egui::egui::vec2;

    fn arrangement() -> Arrangement {
        let titles = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        Arrangement {
            left: titles(&["A", "B", "C", "D"]),
            right: titles(&["E"]),
            closed: Vec::new(),
        }
    }

    #[test]
    fn panels_go_past_those_that_are_not_shown() {
        let mut places = arrangement();
        let shown = ["A", "C", "D", "E"];
        places.rearrange(Rearrangement::Up("C"), &shown);
        assert_eq!(places.left, ["C", "A", "B", "D"]);
        places.rearrange(Rearrangement::Up("C"), &shown);
        assert_eq!(places.left, ["C", "A", "B", "D"], "it is the first");
        places.rearrange(Rearrangement::Down("A"), &shown);
        assert_eq!(places.left, ["C", "B", "D", "A"]);
        places.rearrange(Rearrangement::Across("D"), &shown);
        assert_eq!((places.left.len(), &places.right[0][..]), (3, "D"));
        for _ in 0..2 {
            places.rearrange(Rearrangement::Close("A"), &shown);
        }
        assert_eq!(places.closed, ["A"]);
        places.rearrange(Rearrangement::Show("A"), &shown);
        assert_eq!(places.closed, [""; 0]);
    }

    #[test]
    fn sides_leave_the_picture_its_share_however_they_are_dragged() {
        for [width, height] in [
            [1024.0, 640.0],
            [1280.0, 720.0],
            [1440.0, 900.0],
            [1920.0, 1080.0],
        ] {
            let size = vec2(width, height);
            for (left, right) in [(true, true), (true, false), (false, true)] {
                let sides = OpenSides { left, right };
                let open = |side| match side {
                    Side::Left => left,
                    Side::Right => right,
                };
                let shown = Side::ALL.into_iter();
                let shown = shown.filter(|side| open(*side) && sides.has_room(*side, width));
                let taken: f32 = shown.map(|side| sides.widths(side, size).most).sum();
                let picture = (width - taken) * (height - BARS) / (width * height);
                assert!(picture > PICTURE - 1e-3, "{size} {sides:?}: {picture}");
            }
        }
    }
}
