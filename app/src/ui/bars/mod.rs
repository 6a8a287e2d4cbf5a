//! The bars round the picture: the menu, the bar under the picture, the film's bar, the badge of
//! trust.

pub mod badge;
pub mod film_bar;
pub mod menu;
pub mod time_marks;
pub mod time_slider;
pub mod transport;
