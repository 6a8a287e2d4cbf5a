//! A world as pixels.

mod settings;

pub use settings::{
    Axis, Background, CameraRequest, ColourBy, ColourMap, ColourRange, Cut, Legend, ProjectionKind,
    Side, ViewSettings,
};
