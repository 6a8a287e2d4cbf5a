//! `events.csv`: what happened in a run, in order of time, a row for each event.
//!
//! In: the events of a run at its end. Out: the table, in SI units; what an event does not have is
//! left empty. Where nothing happened there is no such file.

use crate::run::{Cells, Column, Event, Happening, Pair, Setting, Table};
use crate::world::{Partner, Wall};
use std::io::{self, Write};

/// The file's name.
pub const EVENTS: &str = "events.csv";

/// What a contact that begins is called in it.
pub const IMPACT: &str = "impact";
/// What a contact that ends is called.
pub const PARTING: &str = "parting";
/// What a liquid bridge that begins is called.
pub const BRIDGE_FORMS: &str = "bridge forms";
/// What a liquid bridge that ends is called.
pub const BRIDGE_RUPTURES: &str = "bridge ruptures";
/// What the maximum of θ before an avalanche is called.
pub const AVALANCHE_BEGINS: &str = "avalanche begins";
/// What the minimum of θ after it is called.
pub const AVALANCHE_ENDS: &str = "avalanche ends";
/// What the rest of a column's front is called.
pub const FRONT_STOPS: &str = "front stops";
/// What a parameter's new value is called.
pub const CHANGE: &str = "change";

/// What stands in [`EVENTS`].
pub fn events_table() -> Table {
    Table::new(
        EVENTS,
        [
            Column::numbers("time", "s"),
            Column::new("event", Cells::Words).described(
                "impact or parting of two of few grains; bridge forms, bridge ruptures; avalanche \
                 begins, avalanche ends; front stops; change",
            ),
            Column::new("grain", Cells::Counts).described("number of the grain, from 0 on"),
            Column::new("partner", Cells::Words)
                .described("number of the other grain, or name of the wall"),
            Column::numbers("speed", "m/s").described("of approach along the normal at an impact"),
            Column::numbers("duration", "s")
                .described("of the contact, the bridge or the avalanche that ends"),
            Column::numbers("angle", "rad").described("of the surface at that end of an avalanche"),
            Column::numbers("drop", "rad").described("of the surface in the whole avalanche"),
            Column::numbers("radius", "m").described("of the front that stops"),
            Column::new("parameter", Cells::Words).described("what was changed, as --set names it"),
            Column::new("value", Cells::Words).described("its new value, in the SI unit"),
        ],
    )
}

/// What an event has beside its time.
#[derive(Default)]
struct Row<'a> {
    event: &'static str,
    pair: Option<Pair>,
    speed: Option<f64>,
    duration: Option<f64>,
    angle: Option<f64>,
    drop: Option<f64>,
    radius: Option<f64>,
    setting: Option<&'a Setting>,
}

/// Writes `events` between grains and these `walls` to `file`.
///
/// # Errors
/// When the file cannot be written.
pub fn write_events(events: &[Event], walls: &[Wall], file: &mut dyn Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(file);
    writer.write_record(events_table().heads())?;
    for event in events {
        for row in rows(&event.what) {
            writer.write_record(row.cells(event.time, walls))?;
        }
    }
    writer.flush()
}

/// The rows of an event: of a change, one for each parameter.
fn rows(what: &Happening) -> Vec<Row<'_>> {
    let row = match what {
        Happening::Impact { pair, speed } => Row {
            event: IMPACT,
            pair: Some(*pair),
            speed: Some(*speed),
            ..Row::default()
        },
        Happening::Parting { pair, duration } => Row {
            event: PARTING,
            pair: Some(*pair),
            duration: *duration,
            ..Row::default()
        },
        Happening::BridgeForms { pair } => Row {
            event: BRIDGE_FORMS,
            pair: Some(*pair),
            ..Row::default()
        },
        Happening::BridgeRuptures { pair, duration } => Row {
            event: BRIDGE_RUPTURES,
            pair: Some(*pair),
            duration: *duration,
            ..Row::default()
        },
        Happening::AvalancheBegins(avalanche) => Row {
            event: AVALANCHE_BEGINS,
            angle: Some(avalanche.theta_m),
            drop: Some(avalanche.drop()),
            ..Row::default()
        },
        Happening::AvalancheEnds(avalanche) => Row {
            event: AVALANCHE_ENDS,
            duration: Some(avalanche.end - avalanche.start),
            angle: Some(avalanche.theta_r),
            drop: Some(avalanche.drop()),
            ..Row::default()
        },
        Happening::FrontStops { radius } => Row {
            event: FRONT_STOPS,
            radius: Some(*radius),
            ..Row::default()
        },
        Happening::Changed(change) => {
            let of_setting = |setting| Row {
                event: CHANGE,
                setting: Some(setting),
                ..Row::default()
            };
            return change.set.iter().map(of_setting).collect();
        }
    };
    vec![row]
}

impl Row<'_> {
    fn cells(&self, time: f64, walls: &[Wall]) -> [String; 11] {
        let number = |value: Option<f64>| value.map_or_else(String::new, |x| format!("{x:?}"));
        let word = |word: Option<String>| word.unwrap_or_default();
        [
            format!("{time:?}"),
            self.event.to_owned(),
            word(self.pair.map(|pair| pair.grain.to_string())),
            word(self.pair.map(|pair| partner(pair.partner, walls))),
            number(self.speed),
            number(self.duration),
            number(self.angle),
            number(self.drop),
            number(self.radius),
            word(self.setting.map(|setting| setting.parameter.to_string())),
            word(self.setting.map(|setting| setting.value.to_string())),
        ]
    }
}

fn partner(partner: Partner, walls: &[Wall]) -> String {
    match partner {
        Partner::Grain(other) => other.to_string(),
        Partner::Wall(wall) => {
            let known = walls.get(wall as usize);
            known.map_or_else(|| format!("wall {wall}"), |wall| wall.name.clone())
        }
    }
}
