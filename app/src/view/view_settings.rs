//! What a person chose to see, and what the view tells the panels back.
//!
//! In: choices made in panels. Out: plain data that the view reads every frame. Nothing here draws.

use crate::view::measured::Measured;
use crate::view::ruler::Ruler;
use crate::view::trail::Trail;
use bevy::prelude::Resource;
use bevy_egui::egui;
use grainfall::lab::Half;
use grainfall::measure::{GrainQuantity, Measure};
use grainfall::world::World;
use serde::{Deserialize, Serialize};

/// Size of the grains in the picture at which one sees what lies between their centres.
const LOOK_BETWEEN: f32 = 0.4;
/// So many grains are watched one by one.
const FEW: usize = 24;

/// Everything about the picture that a person can choose, and the two things that the panels need
/// to know of it.
#[derive(Resource, Clone, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of a panel")]
pub struct ViewSettings {
    /// Which property of a grain gives its colour.
    pub colour_by: ColourBy,
    /// How a number becomes a colour; species have their own palette.
    pub colour_map: ColourMap,
    /// The numbers at the two ends of the colour map.
    pub range: ColourRange,
    /// Whether equal steps of colour are equal factors.
    pub log_colours: bool,
    /// What is cut away.
    pub cut: Option<Cut>,
    /// Size of the grains in the picture over their own: smaller ones let one look between them.
    pub grain_size: f32,
    /// Whether grains that are drawn smaller have a ghost of their own size; `None`: where forces are
    /// drawn.
    pub show_ghosts: Option<bool>,
    /// Whether spheres have a pattern that shows how they turn; `None`: where there are a few.
    pub show_turning: Option<bool>,
    /// Whether the forces between grains are drawn.
    pub show_forces: bool,
    /// Whether liquid bridges are drawn.
    pub show_bridges: bool,
    /// Whether the grains' velocities are drawn.
    pub show_velocities: bool,
    /// The grain that is looked at closely, by its number; one that the world shown does not have
    /// counts as none.
    pub selected: Option<usize>,
    /// The grain beside it whose contact with it is looked at.
    pub beside: Option<usize>,
    /// Whether the picture keeps that grain in its middle.
    pub follows_selected: bool,
    /// The grains whose ways are drawn, by their numbers.
    pub traced: Vec<usize>,
    /// The ruler.
    pub ruler: Ruler,
    /// The half of the picture that the panels describe, where there are two.
    pub focus: Half,
    /// Whether the directions of the axes are drawn.
    pub show_axes: bool,
    /// Whether the container is drawn.
    pub show_container: bool,
    /// How strongly the container's glass-like surfaces are drawn, 0 … 1.
    pub container_opacity: f32,
    /// Whether the scale bar, the clock and the legend are drawn into the picture.
    pub show_overlay: bool,
    /// Whether what is measured is drawn where it is measured.
    pub show_measured: bool,
    /// Whether the flowing layer is drawn on the bed.
    pub show_flow: bool,
    /// Whether the granular temperature lies over the bed as a veil.
    pub show_temperature: bool,
    /// How depth is shown.
    pub projection: ProjectionKind,
    /// The background.
    pub background: Background,
    /// What the camera is asked to do next; the view takes it.
    pub camera_request: Option<CameraRequest>,
    /// In: the part of the window that the panels leave free, in egui points. `None`: the whole
    /// window.
    pub free_rect: Option<egui::Rect>,
    /// Out: how much of that at its right is kept for what the colours mean, in egui points.
    pub margin: f32,
    /// Out: whether the picture goes on under that, as no grain does.
    pub margin_is_free: bool,
    /// In: physical pixels per egui point.
    pub pixels_per_point: f32,
    /// Whether edges are smoothed by several samples a pixel; read when the picture is set up.
    pub smooth_edges: bool,
    /// Out: what the colours mean now. `None` while grains are coloured by species.
    pub legend: Option<Legend>,
    /// Out: what the colours of the veil mean, where there is one.
    pub veil: Option<Legend>,
    /// Out: what thickness and length of bars and arrows mean.
    pub link_scales: LinkScales,
    /// Out: where the traced grains have been.
    pub trails: Vec<Trail>,
    /// Out: what is measured of the worlds shown, in each half; nothing where it is not drawn.
    pub measured: [Measured; 2],
    /// In: the measure whose curve is under the pointer.
    pub lit_by_plot: Option<Measure>,
    /// Out: the measure whose mark in the picture is under the pointer.
    pub lit_by_picture: Option<Measure>,
}

impl Default for ViewSettings {
    fn default() -> Self {
        Self {
            colour_by: ColourBy::Species,
            colour_map: ColourMap::Viridis,
            range: ColourRange::Automatic,
            log_colours: false,
            cut: None,
            grain_size: 1.0,
            show_ghosts: None,
            show_turning: None,
            show_forces: false,
            show_bridges: false,
            show_velocities: false,
            selected: None,
            beside: None,
            follows_selected: false,
            traced: Vec::new(),
            ruler: Ruler::default(),
            focus: Half::Left,
            show_axes: false,
            show_container: true,
            container_opacity: 0.5,
            show_overlay: true,
            show_measured: true,
            show_flow: false,
            show_temperature: false,
            projection: ProjectionKind::Perspective,
            background: Background::Dark,
            camera_request: None,
            free_rect: None,
            margin: 0.0,
            margin_is_free: false,
            pixels_per_point: 1.0,
            smooth_edges: true,
            legend: None,
            veil: None,
            link_scales: LinkScales::default(),
            trails: Vec::new(),
            measured: [const { Measured::NOTHING }; 2],
            lit_by_plot: None,
            lit_by_picture: None,
        }
    }
}

impl ViewSettings {
    /// Whether the spheres of `world` have a pattern.
    pub fn shows_turning(&self, world: &World) -> bool {
        (self.show_turning).unwrap_or(world.grains.len() <= FEW)
    }

    /// Whether ghosts of the grains are drawn at full size.
    pub fn shows_ghosts(&self) -> bool {
        self.grain_size < 1.0 && self.show_ghosts.unwrap_or(self.show_forces)
    }

    /// Draws the forces or no longer. Grains of their own size would hide them: these become smaller
    /// meanwhile.
    pub fn draw_forces(&mut self, draws: bool) {
        if draws && !self.show_forces && self.grain_size == 1.0 {
            self.grain_size = LOOK_BETWEEN;
        } else if !draws && self.show_forces && self.grain_size == LOOK_BETWEEN {
            self.grain_size = 1.0;
        }
        self.show_forces = draws;
    }

    /// How much of the margin the picture goes on under [points].
    pub fn free_margin(&self) -> f32 {
        if self.margin_is_free {
            self.margin
        } else {
            0.0
        }
    }

    /// Begins or ends to draw the way of `grain`.
    pub fn trace(&mut self, grain: usize) {
        match self.traced.iter().position(|traced| *traced == grain) {
            Some(index) => drop(self.traced.remove(index)),
            None => self.traced.push(grain),
        }
    }
}

/// Which property of a grain gives its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColourBy {
    /// What kind it is.
    #[default]
    Species,
    /// How much it has of this.
    Quantity(GrainQuantity),
    /// Where it was when its run began: how grains mix.
    Start(StartPlace),
}

/// Where a grain was when its run began.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StartPlace {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Distance from the axis.
    Distance,
}

impl StartPlace {
    const ALL: [Self; 3] = [Self::X, Self::Y, Self::Distance];

    /// What of the grains is looked at in the state with which the run began.
    pub fn quantity(self) -> GrainQuantity {
        match self {
            Self::X => GrainQuantity::PositionX,
            Self::Y => GrainQuantity::PositionY,
            Self::Distance => GrainQuantity::AxisDistance,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::X => "x at the start",
            Self::Y => "y at the start",
            Self::Distance => "Distance at the start",
        }
    }

    fn key(self) -> &'static str {
        match self {
            Self::X => "start x",
            Self::Y => "start y",
            Self::Distance => "start distance",
        }
    }
}

impl ColourBy {
    /// All of them, in the order of a menu.
    pub fn all() -> impl Iterator<Item = Self> {
        let quantities = GrainQuantity::ALL.into_iter().map(Self::Quantity);
        let starts = StartPlace::ALL.into_iter().map(Self::Start);
        std::iter::once(Self::Species)
            .chain(quantities)
            .chain(starts)
    }

    /// The number behind the colour; none of species.
    pub fn quantity(self) -> Option<GrainQuantity> {
        match self {
            Self::Species => None,
            Self::Quantity(quantity) => Some(quantity),
            Self::Start(place) => Some(place.quantity()),
        }
    }

    /// By what a file knows it; empty for species.
    pub fn key(self) -> &'static str {
        match self {
            Self::Species => "",
            Self::Quantity(quantity) => quantity.quantity().key,
            Self::Start(place) => place.key(),
        }
    }

    /// What people call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Species => "Species",
            Self::Quantity(quantity) => quantity.name(),
            Self::Start(place) => place.label(),
        }
    }

    /// SI unit of the number behind the colour; empty for a count and for species.
    pub fn unit(self) -> &'static str {
        self.quantity().map_or("", GrainQuantity::unit)
    }

    /// Whether grains of `world` have it.
    pub fn applies(self, world: &World) -> bool {
        self.quantity()
            .is_none_or(|quantity| quantity.applies_to(world))
    }
}

/// A perceptually even colour map that people with any kind of colour vision can read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ColourMap {
    /// Dark violet, green, yellow.
    #[default]
    Viridis,
    /// Dark blue, grey, yellow.
    Cividis,
    /// Black, purple, cream.
    Magma,
    /// Blue, magenta, yellow.
    Plasma,
}

impl ColourMap {
    /// All of them, in the order of a menu.
    pub const ALL: [Self; 4] = [Self::Viridis, Self::Cividis, Self::Magma, Self::Plasma];

    /// Its usual name.
    pub fn label(self) -> &'static str {
        match self {
            Self::Viridis => "Viridis",
            Self::Cividis => "Cividis",
            Self::Magma => "Magma",
            Self::Plasma => "Plasma",
        }
    }

    /// The sRGB colour at `t`, clamped to 0 … 1.
    pub fn colour(self, t: f64) -> [u8; 3] {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Cividis => colorous::CIVIDIS,
            Self::Magma => colorous::MAGMA,
            Self::Plasma => colorous::PLASMA,
        };
        let colour = gradient.eval_continuous(t.clamp(0.0, 1.0));
        [colour.r, colour.g, colour.b]
    }
}

/// The numbers at the two ends of the colour map, in the SI unit of what is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum ColourRange {
    /// From zero to a round number that most grains stay below.
    #[default]
    Automatic,
    /// From the first to the second.
    Fixed(f64, f64),
    /// From the number that this share of the grains stay below to that which the second share stay
    /// below, 0 … 1.
    Percentiles(f64, f64),
}

/// A direction along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[allow(missing_docs)]
pub enum CoordinateAxis {
    X,
    Y,
    Z,
}

impl CoordinateAxis {
    /// All three.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// `x`, `y` or `z`.
    pub fn label(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        }
    }

    /// Unit vector along the axis.
    pub fn unit(self) -> bevy::math::DVec3 {
        match self {
            Self::X => bevy::math::DVec3::X,
            Self::Y => bevy::math::DVec3::Y,
            Self::Z => bevy::math::DVec3::Z,
        }
    }
}

/// What is cut away; grains in a face of the cut show their section.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Cut {
    /// Everything beyond a plane.
    Beyond {
        /// Normal of the plane, pointing to the side that is cut away.
        axis: CoordinateAxis,
        /// Where along the axis [m].
        position: f64,
    },
    /// The quarter to the right of one upright plane and before another.
    Quarter {
        /// Where the first plane is along x [m].
        x: f64,
        /// Where the second plane is along z [m].
        z: f64,
    },
}

/// How depth is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ProjectionKind {
    /// Near things are larger.
    #[default]
    Perspective,
    /// Equal lengths look equal: for measuring.
    Orthographic,
}

/// The background of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Background {
    /// Dark slate, for screens.
    #[default]
    Dark,
    /// Nearly white, for projectors and print.
    Light,
}

/// Something asked of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CameraRequest {
    /// The view that a scene opens with.
    Home,
    /// Keep the direction, move so that everything fits.
    Fit,
    /// Look from this side, and move so that everything fits.
    From(StandardView),
    /// Keep the present view under this number, below [`SAVED_VIEWS`].
    Save(usize),
    /// The view that was kept under this number, if one was.
    Recall(usize),
}

/// How many views can be kept.
pub const SAVED_VIEWS: usize = 3;

/// What thickness and length of bars and arrows mean; nothing of what is not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinkScales {
    /// The force [N] whose bar is [`LinkScales::thickness`] thick.
    pub force: Option<f64>,
    /// Thickness of that bar [m].
    pub thickness: f64,
    /// The speed [m/s] whose arrow is [`LinkScales::length`] long.
    pub speed: Option<f64>,
    /// Length of that arrow [m].
    pub length: f64,
    /// Whether liquid bridges are drawn.
    pub liquid: bool,
}

/// The six sides that one can look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StandardView {
    /// From +x.
    Right,
    /// From −x.
    Left,
    /// From +y.
    Above,
    /// From −y.
    Below,
    /// From +z.
    Front,
    /// From −z.
    Back,
}

impl StandardView {
    /// All of them, in the order of a menu.
    pub const ALL: [Self; 6] = [
        Self::Front,
        Self::Back,
        Self::Left,
        Self::Right,
        Self::Above,
        Self::Below,
    ];

    /// What people call it.
    pub fn label(self) -> &'static str {
        match self {
            Self::Right => "Right (+x)",
            Self::Left => "Left (−x)",
            Self::Above => "Above (+y)",
            Self::Below => "Below (−y)",
            Self::Front => "Front (+z)",
            Self::Back => "Back (−z)",
        }
    }
}

/// What the colours mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// What is shown.
    pub title: &'static str,
    /// The number at the map's low end, in the SI unit.
    pub min: f64,
    /// The number at the map's high end, in the SI unit.
    pub max: f64,
    /// The SI unit; empty for a count.
    pub unit: &'static str,
    /// Whether equal steps of colour are equal factors; both ends are above zero then.
    pub is_log: bool,
}

impl Legend {
    /// Where `value` stands between the ends, 0 … 1 unless it lies beyond them.
    pub fn share(&self, value: f64) -> f64 {
        let place = |value: f64| if self.is_log { value.log10() } else { value };
        let (low, high) = (place(self.min), place(self.max));
        if high > low && value.is_finite() {
            // The logarithm of what is not above zero stands below everything.
            ((place(value) - low) / (high - low)).max(0.0)
        } else {
            0.0
        }
    }

    /// The value at a `share` of the way.
    pub fn value(&self, share: f64) -> f64 {
        if self.is_log {
            self.min * (self.max / self.min).powf(share)
        } else {
            self.min + share * (self.max - self.min)
        }
    }
}
