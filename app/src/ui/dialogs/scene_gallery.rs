//! The scenes that come with the program: a picture of each, what to look for, how fast it runs on
//! this machine; and the files opened last.
//!
//! In: what is remembered. Out: a request to open one. The pictures are the program's own, made by
//! `app/assets/gallery/make`.

use crate::ui::dialogs::dialog::dialog_ui;
use crate::ui::request::Request;
use crate::ui::user_memory::UserMemory;
use crate::ui::widgets::focus::{follow_focus, take_first_focus};
use crate::ui::words::number;
use bevy_egui::egui::{
    self, ColorImage, RichText, ScrollArea, Sense, TextureHandle, TextureOptions, UiBuilder,
    WidgetInfo, WidgetType, vec2,
};
use grainfall::lesson::{BuiltInLesson, Lesson, built_in_lessons};
use grainfall::run::openings;
use grainfall::scene::{BuiltIn, Scene, SceneContainer, built_in};
use grainfall::solver::advise;

/// Size of a picture in points, half as many as it has pixels where the screen is fine.
const PICTURE: egui::Vec2 = vec2(192.0, 120.0);
/// Scenes that show what they promise at once.
const FIRST: [&str; 2] = ["small-drum", "bouncing-grain"];
/// A window wider than this has two scenes in a row.
const TWO_IN_A_ROW: f32 = 900.0;

macro_rules! pictures {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_bytes!(concat!("../../../assets/gallery/", $name, ".png")))),+]
    };
}

/// The PNG files of the scenes, by their names.
const PICTURES: &[(&str, &[u8])] = pictures![
    "dry-r3",
    "dry-r2",
    "dry-r1.25",
    "wet",
    "column",
    "column-7-3",
    "column-1-1",
    "small-drum",
    "two-frictions-drum",
    "water-drum",
    "honey-drum",
    "two-sizes-drum",
    "two-sizes-wet-drum",
    "bouncing-grain",
    "small-column",
    "two-grains",
    "grain-chain",
    "slide-to-roll",
];

/// The gallery, made when it is first looked at.
#[derive(Default)]
pub struct Gallery {
    cards: Vec<Card>,
}

/// What scenes of the gallery have in common, in the order in which they stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Lesson,
    First,
    Drum,
    Column,
    FewGrains,
    Paper,
}

impl Kind {
    const ALL: [Self; 6] = [
        Self::Lesson,
        Self::First,
        Self::Drum,
        Self::Column,
        Self::FewGrains,
        Self::Paper,
    ];

    fn title(self) -> &'static str {
        match self {
            Self::Lesson => "Lessons",
            Self::First => "Start here",
            Self::Drum => "Drums",
            Self::Column => "Columns",
            Self::FewGrains => "One contact",
            Self::Paper => "Papers",
        }
    }

    /// That of the scene in the file at `path`.
    fn of(name: &str, path: &str, scene: &Scene) -> Self {
        if FIRST.contains(&name) {
            return Self::First;
        }
        if path.contains("papers/") {
            return Self::Paper;
        }
        match scene.container {
            SceneContainer::Drum { .. } => Self::Drum,
            SceneContainer::Column { .. } => Self::Column,
            _ => Self::FewGrains,
        }
    }
}

struct Card {
    name: &'static str,
    kind: Kind,
    title: String,
    look_for: String,
    grains: usize,
    /// The moment at which it opens [s], where that is not its start.
    moment: Option<f64>,
    /// Grain steps per simulated second [1/s]: what the time to compute it goes with.
    load: f64,
    /// Polyhedra take another time than spheres do.
    is_polyhedral: bool,
    picture: Option<TextureHandle>,
}

impl Gallery {
    /// Draws it over everything; false once it is closed or something was chosen.
    pub fn ui(&mut self, ctx: &egui::Context, memory: &UserMemory, out: &mut Vec<Request>) -> bool {
        if self.cards.is_empty() {
            let lessons = built_in_lessons().iter();
            let scenes = built_in().iter();
            self.cards = (lessons.filter_map(|lesson| Card::of_lesson(lesson, ctx)))
                .chain(scenes.filter_map(|scene| Card::of(scene, ctx)))
                .collect();
        }
        let (is_over, is_left) = dialog_ui(ctx, "gallery", 1080.0, |ui| {
            let height = 0.72 * ui.ctx().content_rect().height();
            let mut chosen = None;
            ui.heading("Lessons and scenes");
            ScrollArea::vertical()
                .max_height(height)
                .min_scrolled_height(height)
                .show(ui, |ui| {
                    // Room for the scroll bar.
                    ui.set_width(ui.available_width() - 10.0);
                    chosen = recent_ui(ui, memory);
                    chosen = self.cards_ui(ui, memory).or(chosen.take());
                    follow_focus(ui);
                });
            ui.add_space(4.0);
            let mut closed = false;
            ui.horizontal(|ui| {
                if ui.button("Open a file…").clicked() {
                    out.push(Request::ChooseFile);
                    closed = true;
                }
                closed |= ui.button("Close").clicked();
            });
            closed |= chosen.is_some();
            out.extend(chosen.map(Request::Open));
            closed
        });
        !(is_over || is_left)
    }

    fn cards_ui(&self, ui: &mut egui::Ui, memory: &UserMemory) -> Option<String> {
        let columns = if ui.available_width() > TWO_IN_A_ROW {
            2
        } else {
            1
        };
        let mut chosen = None;
        for kind in Kind::ALL {
            let of_kind = |card: &&Card| card.kind == kind;
            let cards: Vec<&Card> = self.cards.iter().filter(of_kind).collect();
            ui.label(RichText::new(kind.title()).strong().size(17.0));
            for row in cards.chunks(columns) {
                ui.columns(columns, |places| {
                    for (ui, card) in places.iter_mut().zip(row) {
                        if card.ui(ui, &self.speed(card, memory)) {
                            chosen = Some(card.name.to_owned());
                        }
                    }
                });
            }
            ui.add_space(8.0);
        }
        chosen
    }

    /// How fast `card` runs here: as it did, or as its size lets expect from another of its kind
    /// that did.
    fn speed(&self, card: &Card, memory: &UserMemory) -> String {
        let speeds = memory.speeds();
        if let Some(speed) = speeds.get(card.name) {
            return format!("{} here", pace(*speed));
        }
        let alike = |other: &&Card| other.is_polyhedral == card.is_polyhedral;
        let known = (self.cards.iter().filter(alike))
            .filter_map(|other| Some((other.load, *speeds.get(other.name)?)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        known.map_or("not run here yet".to_owned(), |(load, speed)| {
            format!("about {} here, by its size", pace(speed * load / card.load))
        })
    }
}

/// How fast `speed` is, in words: `2.1 times real time`, `80 s for each second`.
fn pace(speed: f64) -> String {
    if speed >= 0.1 {
        format!("{} times real time", number::rough(speed))
    } else {
        format!("{} s for each second", number::rough((1.0 / speed).round()))
    }
}

impl Card {
    fn of(scene: &BuiltIn, ctx: &egui::Context) -> Option<Self> {
        // Every built-in scene is opened by a test: one that cannot be is not in the program.
        let opened = Scene::parse(scene.path, scene.text).ok()?;
        let grains = opened.grain_count();
        Some(Self {
            name: scene.name,
            kind: Kind::of(scene.name, scene.path, &opened),
            grains,
            moment: (openings().iter())
                .find(|opening| opening.scene == scene.name)
                .map(|opening| opening.moment),
            load: grains as f64 / advise(&opened).time_step,
            is_polyhedral: opened.is_polyhedral(),
            picture: picture(scene.name)
                .map(|image| ctx.load_texture(scene.name, image, TextureOptions::LINEAR)),
            title: opened.title,
            look_for: opened.look_for,
        })
    }

    fn of_lesson(own: &BuiltInLesson, ctx: &egui::Context) -> Option<Self> {
        // As of scenes: a test opens each.
        let (lesson, scene) = Lesson::open(own.name).ok()?;
        let grains = scene.grain_count();
        Some(Self {
            name: own.name,
            kind: Kind::Lesson,
            grains,
            moment: None,
            load: grains as f64 / advise(&scene).time_step,
            is_polyhedral: scene.is_polyhedral(),
            picture: picture(own.picture)
                .map(|image| ctx.load_texture(own.name, image, TextureOptions::LINEAR)),
            title: lesson.title,
            look_for: lesson.about,
        })
    }

    /// Draws it, a button as a whole; whether it was chosen.
    fn ui(&self, ui: &mut egui::Ui, speed: &str) -> bool {
        let builder = UiBuilder::new().id_salt(self.name).sense(Sense::click());
        let card = ui.scope_builder(builder, |ui| {
            let response = ui.response();
            let visuals = ui.style().interact(&response);
            let is_aimed_at = response.hovered() || response.has_focus();
            let fill = is_aimed_at.then_some(visuals.weak_bg_fill);
            // A text that can be selected would take the click.
            ui.style_mut().interaction.selectable_labels = false;
            egui::Frame::new()
                .fill(fill.unwrap_or_default())
                .corner_radius(6)
                .inner_margin(6)
                .show(ui, |ui| {
                    ui.set_width(ui.available_width());
                    self.content_ui(ui, speed);
                });
        });
        let label = format!("Open {}", self.title);
        let info = || WidgetInfo::labeled(WidgetType::Button, true, &label);
        card.response.widget_info(info);
        if self.kind == Kind::ALL[0] {
            take_first_focus(&card.response);
        }
        card.response.clicked()
    }

    fn content_ui(&self, ui: &mut egui::Ui, speed: &str) {
        ui.horizontal_top(|ui| {
            if let Some(picture) = &self.picture {
                ui.add(egui::Image::new((picture.id(), PICTURE)).corner_radius(4));
            }
            ui.vertical(|ui| {
                ui.label(RichText::new(&self.title).strong());
                ui.label(RichText::new(&self.look_for).small());
                let grains = if self.grains == 1 { "grain" } else { "grains" };
                let opens = self
                    .moment
                    .map(|moment| format!("opens after {moment} s · "));
                let opens = opens.unwrap_or_default();
                let size = format!("{} {grains} · {opens}{speed}", self.grains);
                ui.label(RichText::new(size).small().weak());
            });
        });
    }
}

/// The files opened last; the one that was chosen.
fn recent_ui(ui: &mut egui::Ui, memory: &UserMemory) -> Option<String> {
    let is_known = |name: &str| {
        built_in().iter().any(|scene| scene.name == name)
            || built_in_lessons().iter().any(|lesson| lesson.name == name)
    };
    let is_file = |name: &&String| !is_known(name);
    let mut files = memory.recent().iter().filter(is_file).peekable();
    files.peek()?;
    ui.label(RichText::new("Files opened last").strong());
    let clicked = files.filter(|name| ui.link(name.as_str()).clicked());
    let chosen = clicked.last().cloned();
    ui.add_space(8.0);
    chosen
}

/// The picture of the scene called `name`. A test reads every one of them: none that cannot be read
/// is in the program.
fn picture(name: &str) -> Option<ColorImage> {
    let (_, bytes) = PICTURES.iter().find(|(known, _)| *known == name)?;
    let mut reader = png::Decoder::new(std::io::Cursor::new(*bytes))
        .read_info()
        .ok()?;
    let mut pixels = vec![0; reader.output_buffer_size()?];
    let frame = reader.next_frame(&mut pixels).ok()?;
    let size = [frame.width as usize, frame.height as usize];
    Some(ColorImage::from_rgb(size, &pixels[..frame.buffer_size()]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_is_told_in_numbers_that_say_something() {
        assert_eq!(pace(2.13), "2.1 times real time");
        assert_eq!(pace(0.012), "83 s for each second");
    }

    #[test]
    fn every_scene_has_a_small_picture() {
        for scene in built_in() {
            let (_, bytes) = PICTURES
                .iter()
                .find(|(name, _)| *name == scene.name)
                .unwrap();
            assert!(
                bytes.len() < 60_000,
                "{}: {} bytes",
                scene.name,
                bytes.len()
            );
            let size = picture(scene.name).unwrap().size;
            assert_eq!(size, [320, 200], "{}", scene.name);
        }
        assert_eq!(PICTURES.len(), built_in().len());
    }
}
