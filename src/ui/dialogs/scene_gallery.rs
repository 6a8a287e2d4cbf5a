//! The scenes that come with the program: a picture of each, what to look for, how fast it runs on
//! this machine; and the files opened last.
//!
//! In: what is remembered. Out: a request to open one. The pictures are the program's own, made by
//! `assets/gallery/make`.

use crate::scene::{BuiltIn, Scene, built_in};
use crate::solver::advise;
use crate::ui::request::Request;
use crate::ui::user_memory::UserMemory;
use crate::ui::widgets::focus::follow_focus;
use crate::ui::words::number;
use bevy_egui::egui::{
    self, ColorImage, Id, Modal, RichText, ScrollArea, TextureHandle, TextureOptions, WidgetInfo,
    WidgetType, vec2,
};

/// Size of a picture in points, half as many as it has pixels where the screen is fine.
const PICTURE: egui::Vec2 = vec2(192.0, 120.0);
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

struct Card {
    name: &'static str,
    title: String,
    look_for: String,
    grains: usize,
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
            self.cards = built_in()
                .iter()
                .filter_map(|scene| Card::of(scene, ctx))
                .collect();
        }
        let frame = egui::Frame::window(&ctx.style_of(ctx.theme()));
        let modal = Modal::new(Id::new("gallery")).frame(frame).show(ctx, |ui| {
            let room = ui.ctx().content_rect().size();
            ui.set_width((0.9 * room.x).min(1080.0));
            let mut chosen = None;
            ui.heading("Scenes");
            ScrollArea::vertical()
                .max_height(0.72 * room.y)
                .min_scrolled_height(0.72 * room.y)
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
        !(modal.inner || modal.should_close())
    }

    fn cards_ui(&self, ui: &mut egui::Ui, memory: &UserMemory) -> Option<String> {
        let columns = if ui.available_width() > TWO_IN_A_ROW {
            2
        } else {
            1
        };
        let mut chosen = None;
        for row in self.cards.chunks(columns) {
            ui.columns(columns, |places| {
                for (ui, card) in places.iter_mut().zip(row) {
                    if card.ui(ui, &self.speed(card, memory)) {
                        chosen = Some(card.name.to_owned());
                    }
                }
            });
            ui.add_space(8.0);
        }
        chosen
    }

    /// How fast `card` runs here: as it did, or as its size lets expect from another of its kind
    /// that did.
    fn speed(&self, card: &Card, memory: &UserMemory) -> String {
        let speeds = memory.speeds();
        if let Some(speed) = speeds.get(card.name) {
            return format!("{} times real time here", number::rough(*speed));
        }
        let alike = |other: &&Card| other.is_polyhedral == card.is_polyhedral;
        let known = (self.cards.iter().filter(alike))
            .filter_map(|other| Some((other.load, *speeds.get(other.name)?)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        known.map_or("not run here yet".to_owned(), |(load, speed)| {
            let expected = number::rough(speed * load / card.load);
            format!("about {expected} times real time here, by its size")
        })
    }
}

impl Card {
    fn of(scene: &BuiltIn, ctx: &egui::Context) -> Option<Self> {
        // Every built-in scene is opened by a test: one that cannot be is not in the program.
        let opened = Scene::parse(scene.path, scene.text).ok()?;
        let grains = opened.grain_count();
        Some(Self {
            name: scene.name,
            grains,
            load: grains as f64 / advise(&opened).time_step,
            is_polyhedral: opened.is_polyhedral(),
            picture: picture(scene.name)
                .map(|image| ctx.load_texture(scene.name, image, TextureOptions::LINEAR)),
            title: opened.title,
            look_for: opened.look_for,
        })
    }

    /// Draws it; whether it was chosen.
    fn ui(&self, ui: &mut egui::Ui, speed: &str) -> bool {
        let mut chosen = false;
        ui.horizontal_top(|ui| {
            if let Some(picture) = &self.picture {
                let image = egui::Image::new((picture.id(), PICTURE)).corner_radius(4);
                let button = ui.add(egui::Button::image(image).frame(true));
                let label = format!("Open {}", self.title);
                button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &label));
                chosen = button.clicked();
            }
            ui.vertical(|ui| {
                ui.label(RichText::new(&self.title).strong());
                ui.label(RichText::new(&self.look_for).small());
                let grains = if self.grains == 1 { "grain" } else { "grains" };
                let size = format!("{} {grains} · {speed}", self.grains);
                ui.label(RichText::new(size).small().weak());
            });
        });
        chosen
    }
}

/// The files opened last; the one that was chosen.
fn recent_ui(ui: &mut egui::Ui, memory: &UserMemory) -> Option<String> {
    let is_file = |name: &&String| !built_in().iter().any(|scene| scene.name == name.as_str());
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
