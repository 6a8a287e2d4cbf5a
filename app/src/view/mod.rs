//! A world as pixels.
//!
//! ```text
//! Simulation ──▶ ShownWorlds ──▶ grains, walls ──▶ WorldCamera ──▶ the free part of the window
//!                                    ▲                  ▲
//!                              ViewSettings        OrbitCamera ◀── viewport_ui (pointer, overlay)
//! ```
//! In: the newest world that the simulation has published, the settings, the pointer over the
//! picture. Out: the picture. The view only reads a world; it never steps or changes one.
//!
//! Each row of the table uses only rows below it; a test holds the files to that.
//!
//! | module | holds |
//! |---|---|
//! | `plugin` | what is set up, and what runs in which order |
//! | `viewport` | the pointer over the picture |
//! | `overlay` | scale bar, clock, legend in the picture |
//! | `bed_marks` | the flowing layer, the temperature as a veil |
//! | `measured_marks` | lines and numbers where something is measured |
//! | `ruler_marks` | the ruler in the picture |
//! | `pick` | which grain a point of the picture shows |
//! | `second_rig` | the cameras of a second picture, off screen |
//! | `rig` | Bevy's cameras, which follow the orbiting eye |
//! | `trace` | follows the grains that are traced, and what is measured |
//! | `container_walls`, `wall_material`, `wall_meshes` | drum, box and planes as one-sided panes |
//! | `links` | force chains, liquid bridges, velocity arrows |
//! | `ghosts` | grains at full size where they are drawn smaller, as thin as glass |
//! | `spheres` | spheres as one draw, exact |
//! | `polyhedron_meshes`, `facets` | polyhedra as a few draws of triangles; the surface of a rounded one |
//! | `grain_buffer` | place, colour and shadow of all grains in one buffer |
//! | `occlusion` | the soft shadow in the gaps between grains |
//! | `quads` | what spheres and links are drawn on |
//! | `second_picture` | what belongs to that picture |
//! | `framing` | what of a scene a picture should hold |
//! | `sheet` | lines and labels in space |
//! | `camera` | the orbiting eye, without Bevy's entities |
//! | `ink` | text and lines into the picture |
//! | `colour` | every colour, the legend |
//! | `shown_worlds` | the worlds in the picture |
//! | `view_settings` | what a person chose to see |
//! | `trail`, `measured`, `ruler` | the ways of chosen grains; what is measured of a world; a ruler |
//! | `halves`, `scale` | the picture in parts; lengths and numbers in it |
//! | `film` | films as files |
//! | `video` | those that another program encodes |
//! | `film_pictures`, `film_kind` | the pictures of a film; what films are written as, how they pass |
//! | `png` | pictures as files |
//! | `cut_out` | a picture without its ground |

mod bed_marks;
mod camera;
mod colour;
mod container_walls;
mod cut_out;
mod facets;
mod film;
mod film_kind;
mod film_pictures;
mod framing;
mod ghosts;
mod grain_buffer;
mod halves;
mod ink;
mod links;
mod measured;
mod measured_marks;
mod occlusion;
mod overlay;
mod pick;
mod plugin;
mod png;
mod polyhedron_meshes;
mod quads;
mod rig;
mod ruler;
mod ruler_marks;
mod scale;
mod second_picture;
mod second_rig;
mod sheet;
mod shown_worlds;
mod spheres;
#[cfg(test)]
mod test_worlds;
mod trace;
mod trail;
mod video;
mod view_settings;
mod viewport;
mod wall_material;
mod wall_meshes;

pub use bed_marks::FlowLines;
pub use camera::{CameraPose, OrbitCamera, apply_response};
#[cfg(test)]
pub(crate) use colour::contrast;
pub(crate) use colour::{MEASURED_ON_DARK, MEASURED_ON_LIGHT, round_up};
pub use colour::{species_colour, trail_colour};
pub use cut_out::{Ground, cut_out};
pub use film::FilmWriter;
pub use film_kind::{Codec, FILM_RATE, FILM_RATES, FILM_SPEEDS, FilmKind, Pace};
pub use film_pictures::Drawn;
pub use grain_buffer::GrainBuffer;
pub use measured::Measured;
pub use measured_marks::Protractor;
pub use overlay::Caption;
pub use plugin::ViewPlugin;
pub use png::{save_cut_out, save_drawing, save_png};
pub use polyhedron_meshes::Meshing;
pub use rig::WorldCamera;
pub use ruler::{Reading, Ruler, RulerEnd};
pub use scale::ScaleBar;
pub use second_picture::{SecondLook, SecondOverlay, SecondPicture};
pub use second_rig::{OfSecondPicture, SecondCamera, second_camera};
pub use shown_worlds::{ShownWorlds, ViewSystems};
pub use trail::Trail;
pub use view_settings::{
    Background, CameraRequest, ColourBy, ColourMap, ColourRange, CoordinateAxis, Cut, Legend,
    LinkScales, ProjectionKind, SAVED_VIEWS, StandardView, StartPlace, ViewSettings,
};
pub use viewport::viewport_ui;
