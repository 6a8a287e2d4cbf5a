//! What happened in a run, and when: a list to search and to jump to.
//!
//! In: what a run has: its samples with their avalanches, the meetings of few grains, its changes.
//! Out: [`Event`]s in order of time. Nothing is measured here that is not measured elsewhere; the
//! words for people are the panels'.

use super::StampedCommand;
use super::changes::{Change, changes};
use super::meetings::{Meeting, MeetingKind};
use crate::measure::{Avalanche, Collapse, Series};
use crate::world::Partner;
use std::collections::BTreeMap;

/// Something that happened in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When [s].
    pub time: f64,
    /// What.
    pub what: Happening,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Happening {
    /// Two of few grains, or a grain and a wall, begin to touch.
    Impact {
        /// The two.
        pair: Pair,
        /// Speed at which they approached each other along the normal [m/s].
        speed: f64,
    },
    /// They touch no longer.
    Parting {
        /// The two.
        pair: Pair,
        /// How long they touched [s]; none where they did so from time zero on.
        duration: Option<f64>,
    },
    /// A liquid bridge forms between them.
    BridgeForms {
        /// The two.
        pair: Pair,
    },
    /// It ruptures.
    BridgeRuptures {
        /// The two.
        pair: Pair,
        /// How long there was one [s]; none where there was from time zero on.
        duration: Option<f64>,
    },
    /// The surface of a bed is at a maximum and begins to fall.
    AvalancheBegins(Avalanche),
    /// It comes to rest at a minimum.
    AvalancheEnds(Avalanche),
    /// The front of a column that collapsed has come to rest, at `t_f` of [`Collapse`].
    FrontStops {
        /// Its distance from the axis [m].
        radius: f64,
    },
    /// Parameters got other values.
    Changed(Change),
}

/// A grain and what it meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Pair {
    /// The grain, by index; of two the one with the smaller.
    pub grain: u32,
    /// The other side.
    pub partner: Partner,
}

/// Events that are shown or hidden together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EventKind {
    /// Contacts that begin.
    Impact,
    /// Contacts that end.
    Parting,
    /// Liquid bridges that form or rupture.
    Bridge,
    /// Avalanches, their starts and ends.
    Avalanche,
    /// A column that comes to rest.
    Front,
    /// Changes of parameters.
    Change,
}

impl EventKind {
    /// All of them, in the order in which they are shown.
    pub const ALL: [Self; 6] = [
        Self::Impact,
        Self::Parting,
        Self::Bridge,
        Self::Avalanche,
        Self::Front,
        Self::Change,
    ];

    /// What people call them.
    pub fn name(self) -> &'static str {
        match self {
            Self::Impact => "Impacts",
            Self::Parting => "Partings",
            Self::Bridge => "Bridges",
            Self::Avalanche => "Avalanches",
            Self::Front => "Front",
            Self::Change => "Changes",
        }
    }
}

impl Event {
    /// Of which kind it is.
    pub fn kind(&self) -> EventKind {
        match self.what {
            Happening::Impact { .. } => EventKind::Impact,
            Happening::Parting { .. } => EventKind::Parting,
            Happening::BridgeForms { .. } | Happening::BridgeRuptures { .. } => EventKind::Bridge,
            Happening::AvalancheBegins(_) | Happening::AvalancheEnds(_) => EventKind::Avalanche,
            Happening::FrontStops { .. } => EventKind::Front,
            Happening::Changed(_) => EventKind::Change,
        }
    }
}

/// The events of a run in order of time: of its `series` with the `avalanches` in it, of its
/// `meetings`, and of what was changed by `commands`, a slice for each change.
pub fn events<'a>(
    series: &Series,
    avalanches: &[Avalanche],
    meetings: &[Meeting],
    commands: impl Iterator<Item = &'a [StampedCommand]>,
) -> Vec<Event> {
    let mut events: Vec<Event> = changes(commands).into_iter().map(of_change).collect();
    events.extend(of_meetings(meetings));
    events.extend(avalanches.iter().flat_map(of_avalanche));
    events.extend(of_collapse(series));
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    events
}

fn of_change(change: Change) -> Event {
    Event {
        time: change.time,
        what: Happening::Changed(change),
    }
}

fn of_avalanche(avalanche: &Avalanche) -> [Event; 2] {
    [
        Event {
            time: avalanche.start,
            what: Happening::AvalancheBegins(*avalanche),
        },
        Event {
            time: avalanche.end,
            what: Happening::AvalancheEnds(*avalanche),
        },
    ]
}

fn of_collapse(series: &Series) -> Option<Event> {
    let collapse = Collapse::of(series)?;
    Some(Event {
        time: collapse.rest_time?,
        what: Happening::FrontStops {
            radius: collapse.front,
        },
    })
}

/// The events of contacts and bridges; what ends lasted since it began.
fn of_meetings(meetings: &[Meeting]) -> Vec<Event> {
    let (mut touching, mut bridged) = (BTreeMap::new(), BTreeMap::new());
    let happening = |meeting: &Meeting| {
        let (time, pair) = (meeting.time, Pair::of(meeting));
        let since = |begun: Option<f64>| begun.map(|begun| time - begun);
        let what = match meeting.kind {
            MeetingKind::Touch { speed } => {
                touching.insert(pair, time);
                Happening::Impact { pair, speed }
            }
            MeetingKind::Part => Happening::Parting {
                pair,
                duration: since(touching.remove(&pair)),
            },
            MeetingKind::BridgeForms => {
                bridged.insert(pair, time);
                Happening::BridgeForms { pair }
            }
            MeetingKind::BridgeRuptures => Happening::BridgeRuptures {
                pair,
                duration: since(bridged.remove(&pair)),
            },
        };
        Event { time, what }
    };
    meetings.iter().map(happening).collect()
}

impl Pair {
    fn of(meeting: &Meeting) -> Self {
        Self {
            grain: meeting.grain,
            partner: meeting.partner,
        }
    }
}
