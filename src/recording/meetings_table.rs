//! `events.csv`, read back.
//!
//! In: the file. Out: the contacts and bridges in it that began and ended. Its other rows follow
//! from samples and changes, which are read from where they stand, and are only checked.

use super::RecordingError;
use super::own_files::OwnFile;
use crate::output::{
    AVALANCHE_BEGINS, AVALANCHE_ENDS, BRIDGE_FORMS, BRIDGE_RUPTURES, CHANGE, FRONT_STOPS, IMPACT,
    PARTING, events_table,
};
use crate::run::{MOST_MEETINGS, Meeting, MeetingKind, StepTimes};
use crate::world::{Partner, World};
use csv::StringRecord;

/// Largest table that is read [bytes]: avalanches and changes of a day have a tenth of it.
pub const LARGEST_EVENTS: u64 = 1 << 26;

/// Columns: those up to the wall or grain that is met, and the numbers behind it.
const TIME: usize = 0;
const EVENT: usize = 1;
const GRAIN: usize = 2;
const PARTNER: usize = 3;
const SPEED: usize = 4;
const NUMBERS: std::ops::RangeInclusive<usize> = SPEED..=8;

/// The contacts and bridges in `file` up to the first row that is no event, and what is wrong with
/// that. They are between the grains and walls of `world`, and of steps at these `steps`.
///
/// # Errors
/// When it has other columns.
pub fn meetings(
    file: &OwnFile,
    world: &World,
    steps: &StepTimes,
) -> Result<(Vec<Meeting>, Option<String>), RecordingError> {
    let refuse = |reason: String| RecordingError::of(&file.path, reason);
    let mut reader = csv::Reader::from_reader(&file.bytes[..]);
    let heads = reader
        .headers()
        .map_err(|error| refuse(error.to_string()))?;
    let expected = events_table().heads();
    if !heads.iter().eq(expected.iter()) {
        let expected = expected.join("`, `");
        return Err(refuse(format!("does not have the columns `{expected}`")));
    }
    let (mut meetings, mut last) = (Vec::new(), 0.0);
    for row in reader.records() {
        let line = |row: &StringRecord| row.position().map_or(0, csv::Position::line);
        let event = match &row {
            Ok(row) => event(row, world, steps).map_err(|reason| (line(row), reason)),
            Err(error) => {
                let line = error.position().map_or(0, csv::Position::line);
                Err((line, "is no row of a table".to_owned()))
            }
        };
        let event = event.and_then(|(time, meeting)| {
            let line = row.as_ref().map_or(0, line);
            if time < last {
                return Err((line, "is earlier than the one before".to_owned()));
            }
            if meeting.is_some() && meetings.len() == MOST_MEETINGS {
                let reason = format!("is one of more than {MOST_MEETINGS} contacts and bridges");
                return Err((line, reason));
            }
            last = time;
            Ok(meeting)
        });
        match event {
            Ok(meeting) => meetings.extend(meeting),
            Err((line, reason)) => {
                let path = file.path.display();
                let note = format!("{path}: line {line} {reason}; events end before it");
                return Ok((meetings, Some(note)));
            }
        }
    }
    Ok((meetings, None))
}

/// When the event in `row` was [s], and the contact or bridge that begins or ends with it.
///
/// # Errors
/// Why it is none, in words that follow on \"line 3\".
fn event(
    row: &StringRecord,
    world: &World,
    steps: &StepTimes,
) -> Result<(f64, Option<Meeting>), String> {
    let cell = |index: usize| row.get(index).unwrap_or_default();
    let time = finite(cell(TIME)).filter(|time| *time >= 0.0);
    let time = time.ok_or_else(|| format!("has {:?} where a time stands", cell(TIME)))?;
    for cell in row.iter().skip(SPEED).take(NUMBERS.count()) {
        if !cell.is_empty() && finite(cell).is_none() {
            return Err(format!("has {cell:?} where a number stands"));
        }
    }
    let kind = match cell(EVENT) {
        IMPACT => MeetingKind::Touch {
            speed: finite(cell(SPEED)).ok_or("is an impact without a speed")?,
        },
        PARTING => MeetingKind::Part,
        BRIDGE_FORMS => MeetingKind::BridgeForms,
        BRIDGE_RUPTURES => MeetingKind::BridgeRuptures,
        AVALANCHE_BEGINS | AVALANCHE_ENDS | FRONT_STOPS | CHANGE => return Ok((time, None)),
        other => return Err(format!("has {other:?} where an event stands")),
    };
    let pair = pair(cell(GRAIN), cell(PARTNER), world);
    let (grain, partner) = pair.ok_or_else(|| {
        let (grain, partner) = (cell(GRAIN), cell(PARTNER));
        format!("has {grain:?} and {partner:?} where a grain and what it meets stand")
    })?;
    let meeting = Meeting {
        step: steps.step_at(time),
        time,
        grain,
        partner,
        kind,
    };
    if meeting.is_sound(world.grains.len(), world.container.walls.len()) {
        Ok((time, Some(meeting)))
    } else {
        Err("is of grains, or of a step, that no run has".to_owned())
    }
}

/// The grain and what it meets: a grain of a larger number, or the wall of that name.
fn pair(grain: &str, partner: &str, world: &World) -> Option<(u32, Partner)> {
    let grain: u32 = grain.parse().ok()?;
    if let Ok(other) = partner.parse() {
        return (other > grain).then_some((grain, Partner::Grain(other)));
    }
    let mut walls = world.container.walls.iter();
    let wall = walls.position(|wall| wall.name == partner)?;
    Some((grain, Partner::Wall(wall as u32)))
}

fn finite(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|number: &f64| number.is_finite())
}
