//! What a picture or a film is to be like: what it shows, how large, how fast, which part of the run.
//!
//! In: what somebody chose the last time, what is recorded, what is typed. Out: an order, or why
//! there can be none, in words.

use crate::picture_size;
use crate::simulation::Simulation;
use crate::ui::capture_choice::CaptureChoice;
use crate::ui::screenshot_orders::{FilmOrder, FilmSpan, PictureOf, PictureOrder, ScreenshotOrder};
use crate::ui::widgets::combo::combo_ui;
use crate::ui::widgets::field::number_of;
use crate::ui::widgets::focus::is_entered;
use crate::ui::words::number;
use crate::view::{FILM_RATES, FILM_SPEEDS, FilmKind, Pace};
use bevy::math::UVec2;
use bevy_egui::egui;
use std::ops::RangeInclusive;
use std::path::Path;

/// Sizes that are offered [pixels].
const SIZES: [UVec2; 2] = [UVec2::new(1920, 1080), UVec2::new(3840, 2160)];
/// The most frames that a film is asked to have.
const MOST_FRAMES: usize = 100_000;
/// Width of a field for a number, and of one for a size [points].
const FIELDS: [f32; 2] = [84.0, 120.0];

/// What is asked beside a path.
#[derive(Default)]
pub enum CaptureForm {
    /// Nothing.
    #[default]
    Nothing,
    /// What a picture is to be like.
    Picture(PictureForm),
    /// What a film is to be like.
    Film(FilmForm),
}

/// What a picture is to be like.
pub struct PictureForm {
    of: PictureOf,
    size: SizeForm,
}

/// What a film is to be like.
pub struct FilmForm {
    of: PictureOf,
    size: SizeForm,
    rate: String,
    speed: String,
    is_recorded: bool,
    from: String,
    to: String,
    /// Simulated times between which states are recorded [s].
    recorded: RangeInclusive<f64>,
}

/// How large it is to be.
struct SizeForm {
    /// Whether it is as large as the window.
    as_window: bool,
    /// Whether another size than those offered is typed.
    is_typed: bool,
    text: String,
}

impl CaptureForm {
    /// A picture of this, else as the last one was chosen.
    pub fn picture(of: PictureOf, last: &CaptureChoice) -> Self {
        let size = SizeForm::new(last.picture_size());
        Self::Picture(PictureForm { of, size })
    }

    /// A film of `simulation`, else as the last one was chosen.
    pub fn film(last: &CaptureChoice, simulation: &Simulation) -> Self {
        let start = simulation.start().map_or(0.0, |world| world.time());
        // No later than what there is, in digits that a person reads.
        let end = (1e6 * simulation.past().end.time).floor() / 1e6;
        let speed = Some(simulation.speed()).filter(|speed| speed.is_finite());
        Self::Film(FilmForm {
            of: last.film_of(),
            size: SizeForm::new(last.film_size()),
            rate: number::trimmed(last.film_rate()),
            speed: speed.unwrap_or(1.0).to_string(),
            is_recorded: simulation.looks_back() || simulation.recording().is_some(),
            from: start.to_string(),
            to: end.max(start).to_string(),
            recorded: start..=simulation.past().end.time.max(start),
        })
    }

    /// Draws it; whether somebody has pressed Enter in one of its fields.
    pub fn ui(&mut self, ui: &mut egui::Ui) -> bool {
        match self {
            Self::Nothing => false,
            Self::Picture(form) => {
                of_ui(ui, &mut form.of);
                form.size.ui(ui)
            }
            Self::Film(form) => form.ui(ui),
        }
    }

    /// What would be ordered for `path`, and that in words where there is something to say.
    ///
    /// # Errors
    /// Why it cannot be, in a sentence.
    pub fn order(&self, path: &Path) -> Result<Option<(ScreenshotOrder, String)>, String> {
        match self {
            Self::Nothing => Ok(None),
            Self::Picture(form) => {
                let order = PictureOrder {
                    path: path.to_owned(),
                    of: form.of,
                    size: form.size.read()?,
                };
                Ok(Some((ScreenshotOrder::Picture(order), String::new())))
            }
            Self::Film(form) => {
                let (order, words) = form.order(path)?;
                Ok(Some((ScreenshotOrder::Film(order), words)))
            }
        }
    }
}

impl FilmForm {
    fn ui(&mut self, ui: &mut egui::Ui) -> bool {
        of_ui(ui, &mut self.of);
        let mut entered = self.size.ui(ui);
        ui.horizontal_wrapped(|ui| {
            entered |= text_ui(ui, "Frames a second", "", &mut self.rate, FIELDS[0]);
            entered |= text_ui(ui, "Speed", "× real time", &mut self.speed, FIELDS[0]);
        });
        ui.horizontal_wrapped(|ui| {
            let now = "From now until it is stopped";
            ui.radio_value(&mut self.is_recorded, false, now);
            ui.radio_value(&mut self.is_recorded, true, "What is recorded");
        });
        ui.add_enabled_ui(self.is_recorded, |ui| {
            ui.horizontal_wrapped(|ui| {
                entered |= text_ui(ui, "from", "", &mut self.from, FIELDS[0]);
                entered |= text_ui(ui, "to", "s", &mut self.to, FIELDS[0]);
            });
        });
        entered
    }

    fn order(&self, path: &Path) -> Result<(FilmOrder, String), String> {
        let kind = FilmKind::of(path).map_err(|reason| number::capitalised(&reason))?;
        let why_opaque = kind.why_opaque().filter(|_| self.of == PictureOf::CutOut);
        if let Some(reason) = why_opaque {
            return Err(reason.to_owned());
        }
        let size = self.size.read()?;
        let rate = number_of("Frames a second", &self.rate, &FILM_RATES, "")?;
        let pace = Pace {
            rate: kind.rate(rate),
            speed: number_of("The speed", &self.speed, &FILM_SPEEDS, "× real time")?,
        };
        let mut words = format!("{}.", number::capitalised(&pace.in_words()));
        let span = self.span()?;
        if let FilmSpan::Recorded { from, to } = span {
            let frames = pace.frames(from, to);
            if frames > MOST_FRAMES {
                return Err(format!(
                    "{frames} pictures are too many: expected {MOST_FRAMES} or fewer. Take fewer frames a second, a higher \
                     speed, or a shorter part"
                ));
            }
            let lasting = number::rounded(frames as f64 / pace.rate, 3);
            words = format!("{words} {frames} pictures: a film of {lasting} s.");
        }
        let order = FilmOrder {
            path: path.to_owned(),
            of: self.of,
            size,
            pace,
            span,
        };
        Ok((order, words))
    }

    /// Which part of the run it shows.
    fn span(&self) -> Result<FilmSpan, String> {
        if !self.is_recorded {
            return Ok(FilmSpan::FromNow);
        }
        let from = number_of("The start", &self.from, &self.recorded, "s")?;
        let to = number_of("The end", &self.to, &self.recorded, "s")?;
        if from > to {
            return Err(format!(
                "The film would start at {from} s, after its end at {to} s: expected an earlier start or a later end"
            ));
        }
        Ok(FilmSpan::Recorded { from, to })
    }
}

impl SizeForm {
    fn new(size: Option<UVec2>) -> Self {
        Self {
            as_window: size.is_none(),
            is_typed: size.is_some_and(|size| !SIZES.contains(&size)),
            text: picture_size::in_words(size.unwrap_or(SIZES[0])),
        }
    }

    /// Draws it; whether somebody has pressed Enter in its field.
    fn ui(&mut self, ui: &mut egui::Ui) -> bool {
        let chosen = match (self.as_window, self.is_typed) {
            (true, _) => "As in the window",
            (false, true) => "Another",
            (false, false) => &self.text,
        };
        let chosen = chosen.to_owned();
        combo_ui(ui, "Size", &chosen, |ui| {
            if ui
                .selectable_label(self.as_window, "As in the window")
                .clicked()
            {
                self.as_window = true;
            }
            for size in SIZES.map(picture_size::in_words) {
                let is_chosen = !self.as_window && !self.is_typed && self.text == size;
                if ui.selectable_label(is_chosen, &size).clicked() {
                    (self.as_window, self.is_typed, self.text) = (false, false, size);
                }
            }
            let is_another = !self.as_window && self.is_typed;
            if ui.selectable_label(is_another, "Another").clicked() {
                (self.as_window, self.is_typed) = (false, true);
            }
        });
        let is_asked = !self.as_window && self.is_typed;
        is_asked
            && ui
                .horizontal_wrapped(|ui| {
                    let label = "Width × height";
                    text_ui(ui, label, "pixels", &mut self.text, FIELDS[1])
                })
                .inner
    }

    fn read(&self) -> Result<Option<UVec2>, String> {
        if self.as_window {
            return Ok(None);
        }
        picture_size::read(&self.text).map(Some)
    }
}

/// The choice of what is shown.
fn of_ui(ui: &mut egui::Ui, of: &mut PictureOf) {
    combo_ui(ui, "Shows", of.label(), |ui| {
        for one in PictureOf::ALL {
            ui.selectable_value(of, one, one.label());
        }
    });
}

/// A field for `text` between its `label` and its `unit`; whether somebody has pressed Enter in it.
fn text_ui(ui: &mut egui::Ui, label: &str, unit: &str, text: &mut String, width: f32) -> bool {
    let label = ui.label(label);
    let field = ui.add(egui::TextEdit::singleline(text).desired_width(width));
    let field = field.labelled_by(label.id);
    if !unit.is_empty() {
        ui.label(unit);
    }
    is_entered(&field)
}
