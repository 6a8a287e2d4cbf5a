//! What happened in a run, in words and numbers.
//!
//! In: an event and the run that it is of. Out: a line of text.

use crate::ui::words::names::setting_in_words;
use crate::ui::words::number;
use grainfall::lab::RunView;
use grainfall::measure::Measure;
use grainfall::run::{Event, Happening, Pair};
use grainfall::world::Partner;

/// What happened, without the time: `grain 0 meets the floor at 612.0 mm/s`.
pub fn event_in_words(event: &Event, simulation: &RunView) -> String {
    let both = |pair: &Pair| both(pair, simulation);
    match &event.what {
        Happening::Impact { pair, speed } => {
            let speed = number::with_prefix(*speed, "m/s");
            format!("{} meet at {speed}", both(pair))
        }
        Happening::Parting { pair, duration } => {
            format!("{} part{}", both(pair), after(*duration))
        }
        Happening::BridgeForms { pair } => format!("bridge forms: {}", both(pair)),
        Happening::BridgeRuptures { pair, duration } => {
            format!("bridge ruptures: {}{}", both(pair), after(*duration))
        }
        Happening::AvalancheBegins(avalanche) => format!(
            "avalanche begins at {}, falls by {}",
            angle(avalanche.theta_m),
            angle(avalanche.drop())
        ),
        Happening::AvalancheEnds(avalanche) => format!(
            "avalanche ends at {}{}",
            angle(avalanche.theta_r),
            after(Some(avalanche.end - avalanche.start))
        ),
        Happening::FrontStops { radius } => {
            let radius = Measure::FrontRadius.quantity().text(*radius);
            format!("the front stops at {radius}")
        }
        Happening::Changed(change) => {
            let set = change.set.iter();
            let set = set.map(|setting| setting_in_words(setting, simulation));
            set.collect::<Vec<_>>().join(", ")
        }
    }
}

fn angle(radians: f64) -> String {
    Measure::SurfaceAngle.quantity().text(radians)
}

/// `, after 62.10 µs`; nothing where that is not known.
fn after(duration: Option<f64>) -> String {
    duration.map_or_else(String::new, |duration| {
        format!(", after {}", number::moment(duration))
    })
}

/// `grains 0 and 1`, `grain 0 and floor`.
fn both(pair: &Pair, simulation: &RunView) -> String {
    let grain = pair.grain;
    match pair.partner {
        Partner::Grain(other) => format!("grains {grain} and {other}"),
        Partner::Wall(wall) => {
            let walls = simulation.world().map(|world| &world.container.walls);
            let known = walls.and_then(|walls| walls.get(wall as usize));
            let name = known.map_or_else(|| format!("wall {wall}"), |wall| wall.name.clone());
            format!("grain {grain} and {name}")
        }
    }
}
