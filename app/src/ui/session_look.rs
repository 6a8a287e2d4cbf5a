//! How a window looked, as a session keeps it: what the picture shows and from where, which panels
//! were open and what was chosen in them.
//!
//! In: the view's settings, the camera, the dock; or the text that a session holds. Out: the text;
//! or all of it as it was. What belongs to a person rather than to a session (background, size of
//! text) is not here but in `user_memory`.

use crate::ui::arrangement::Arrangement;
use crate::ui::dock::Dock;
use crate::view::{
    CameraPose, ColourBy, ColourMap, ColourRange, Cut, OrbitCamera, ProjectionKind, ViewSettings,
};
use grainfall::scene::Scene;
use serde::{Deserialize, Serialize};

/// Most trails that a file may ask for.
const MOST_TRACED: usize = 64;
/// Smallest grains in a picture, over their own size.
const SMALLEST: f32 = 0.05;

/// How a window looked.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of a panel")]
pub struct SessionLook {
    /// Key of the quantity that gives the grains' colours; empty for their species.
    colour_by: String,
    colour_map: ColourMap,
    range: ColourRange,
    log_colours: bool,
    cut: Option<Cut>,
    grain_size: f32,
    show_ghosts: Option<bool>,
    show_turning: Option<bool>,
    show_forces: bool,
    show_bridges: bool,
    show_velocities: bool,
    show_axes: bool,
    show_container: bool,
    show_overlay: bool,
    /// Not known to sessions saved before it was drawn.
    #[serde(default = "yes")]
    show_measured: bool,
    show_flow: bool,
    show_temperature: bool,
    container_opacity: f32,
    projection: ProjectionKind,
    selected: Option<usize>,
    follows_selected: bool,
    beside: Option<usize>,
    traced: Vec<usize>,
    camera: Option<CameraPose>,
    panels: Vec<PanelLook>,
    /// Where they stood.
    arrangement: Arrangement,
    /// The lesson that was followed, in its own words; empty where none was.
    lesson: String,
}

/// How a panel looked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct PanelLook {
    title: String,
    is_open: bool,
    choices: String,
}

fn yes() -> bool {
    true
}

impl SessionLook {
    /// The present look.
    pub fn of(view: &ViewSettings, camera: Option<&OrbitCamera>, dock: &Dock) -> Self {
        let panels = dock.sides.sections().map(|section| PanelLook {
            title: section.panel.title().into(),
            is_open: section.is_open(),
            choices: section.panel.choices(),
        });
        Self {
            colour_by: view.colour_by.key().into(),
            colour_map: view.colour_map,
            range: view.range,
            log_colours: view.log_colours,
            cut: view.cut,
            grain_size: view.grain_size,
            show_ghosts: view.show_ghosts,
            show_turning: view.show_turning,
            show_forces: view.show_forces,
            show_bridges: view.show_bridges,
            show_velocities: view.show_velocities,
            show_axes: view.show_axes,
            show_container: view.show_container,
            show_overlay: view.show_overlay,
            show_measured: view.show_measured,
            show_flow: view.show_flow,
            show_temperature: view.show_temperature,
            container_opacity: view.container_opacity,
            projection: view.projection,
            selected: view.selected,
            follows_selected: view.follows_selected,
            beside: view.beside,
            traced: view.traced.clone(),
            camera: camera.map(OrbitCamera::pose),
            panels: panels.collect(),
            arrangement: dock.sides.arrangement(),
            lesson: dock.lesson.in_words(),
        }
    }

    /// It as a session keeps it.
    pub fn in_words(&self) -> String {
        // Plain data, of which every value has a form in JSON.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// What a session kept; none where it is not known, as in sessions of earlier builds.
    pub fn read(words: &str) -> Option<Self> {
        serde_json::from_str(words).ok()
    }

    /// Makes everything look so, in a session of `scene`.
    pub fn restore(
        self,
        view: &mut ViewSettings,
        camera: Option<&mut OrbitCamera>,
        dock: &mut Dock,
        scene: &Scene,
    ) {
        dock.lesson.take_up(&self.lesson, scene);
        let colour_by = ColourBy::all().find(|by| by.key() == self.colour_by);
        view.colour_by = colour_by.unwrap_or_default();
        view.colour_map = self.colour_map;
        view.range = self.range;
        view.log_colours = self.log_colours;
        view.cut = self.cut;
        view.grain_size = self.grain_size.clamp(SMALLEST, 1.0);
        view.show_ghosts = self.show_ghosts;
        view.show_turning = self.show_turning;
        view.show_forces = self.show_forces;
        view.show_bridges = self.show_bridges;
        view.show_velocities = self.show_velocities;
        view.show_axes = self.show_axes;
        view.show_container = self.show_container;
        view.show_overlay = self.show_overlay;
        view.show_measured = self.show_measured;
        view.show_flow = self.show_flow;
        view.show_temperature = self.show_temperature;
        view.container_opacity = self.container_opacity.clamp(0.0, 1.0);
        view.projection = self.projection;
        (view.selected, view.beside) = (self.selected, self.beside);
        view.follows_selected = self.follows_selected;
        view.traced = self.traced;
        view.traced.truncate(MOST_TRACED);
        if let (Some(camera), Some(pose)) = (camera, self.camera)
            && camera.take_pose(&pose)
        {
            view.camera_request = None;
        }
        dock.sides.arrange(&self.arrangement);
        let mut looks = self.panels;
        for section in dock.sides.sections_mut() {
            // Of two panels with one title the first is the first. Other builds have other panels.
            let title = section.panel.title();
            if let Some(index) = looks.iter().position(|look| look.title == title) {
                let look = looks.remove(index);
                section.is_to_be_open = Some(look.is_open);
                section.panel.take_choices(&look.choices);
            }
        }
    }
}
