//! Work that is in no file, kept for the case that the program ends unasked: killed, a display that
//! goes, power that fails.
//!
//! In: the simulation and how it looks, the time, a flag that somebody wants the program to end. Out:
//! a session in the user's folder, twice a minute as long as there is work that would be missed, and
//! once more where a signal ends the program; none where a person closes the window, who was asked.
//! What an earlier window left is offered when the next one opens.

use crate::simulation::Simulation;
use crate::ui::dispatch::fulfil_requests;
use crate::ui::dock::Dock;
use crate::ui::session_look::SessionLook;
use crate::view::{OrbitCamera, ViewSettings};
use bevy::prelude::*;
use grainfall::files::remove_file;
use grainfall::lab::LabCommand;
use grainfall::run::Rescue;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Time between two sessions that are kept.
const INTERVAL: Duration = Duration::from_secs(30);
/// How long a program that is to end waits until its work is written.
const PATIENCE: Duration = Duration::from_secs(20);

/// Keeps work below `home`, and ends the app when `stop` becomes true.
pub struct RescuePlugin {
    /// The folder of the user that sessions are kept in.
    pub home: PathBuf,
    /// Whether somebody wants the program to end.
    pub stop: Arc<AtomicBool>,
}

impl Plugin for RescuePlugin {
    fn build(&self, app: &mut App) {
        let left = Rescue::left(&self.home);
        let place = Rescue::begin(&self.home);
        let mut dock = app.world_mut().resource_mut::<Dock>();
        dock.offer_left(left);
        match place {
            Ok(place) => {
                app.insert_resource(KeptWork::new(place, self.stop.clone()))
                    .add_systems(Update, keep_work.after(fulfil_requests))
                    .add_systems(Last, forget_at_exit);
            }
            Err(error) => dock.notify(format!(
                "What is done here would be lost if the program were stopped: {error}"
            )),
        }
    }
}

/// Where the work of this window is kept, and since when.
#[derive(Resource)]
struct KeptWork {
    place: Rescue,
    stop: Arc<AtomicBool>,
    /// Real time at which a session was last asked for; none where there is no session.
    asked: Option<Duration>,
    /// Real time at which it was first seen that the program is to end.
    ending: Option<Duration>,
}

impl KeptWork {
    fn new(place: Rescue, stop: Arc<AtomicBool>) -> Self {
        Self {
            place,
            stop,
            asked: None,
            ending: None,
        }
    }
}

/// Has the session kept from time to time, and once more before the program ends.
fn keep_work(
    mut kept: ResMut<KeptWork>,
    time: Res<Time<Real>>,
    simulation: Option<ResMut<Simulation>>,
    (mut dock, view, camera): (ResMut<Dock>, Res<ViewSettings>, Option<Res<OrbitCamera>>),
    mut exit: MessageWriter<AppExit>,
) {
    let now = time.elapsed();
    let is_ending = kept.stop.load(Ordering::Relaxed);
    let first = is_ending && kept.ending.is_none();
    let unsaved = simulation.filter(|simulation| simulation.is_unsaved());
    let Some(mut simulation) = unsaved else {
        if kept.asked.take().is_some() {
            // Nothing is lost where it cannot be removed: it is offered once too often.
            let _ = kept.place.clear();
        }
        if is_ending {
            exit.write(AppExit::Success);
        }
        return;
    };
    let is_due = (kept.asked).is_none_or(|asked| now.saturating_sub(asked) >= INTERVAL);
    if first || is_due && !is_ending {
        let look = SessionLook::of(&view, camera.as_deref(), &dock).in_words();
        let path = kept.place.path();
        simulation.send(LabCommand::Rescue { path, look });
        kept.asked = Some(now);
    }
    if kept.asked.is_some_and(|asked| asked < now) && simulation.has_answered() {
        let earlier = dock.bypass_change_detection().taken_up.take();
        // Where it cannot be removed it is offered once too often.
        let _ = earlier.map(|path| remove_file(&path));
    }
    if is_ending {
        let since = *kept.ending.get_or_insert(now);
        let is_written = !first && simulation.has_answered();
        if is_written || now.saturating_sub(since) > PATIENCE {
            exit.write(AppExit::Success);
        }
    }
}

/// Removes the session where a person closed the window: whether it was to be saved was asked.
fn forget_at_exit(kept: Res<KeptWork>, mut exits: MessageReader<AppExit>) {
    if exits.read().next().is_some() && kept.ending.is_none() {
        let _ = kept.place.clear();
    }
}
