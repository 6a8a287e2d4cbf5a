//! Both sides of panels: which panels stand on them, in which order, open or closed.
//!
//! In: the register of panels, what a person asks of their places. Out: both sides drawn; what their
//! panels ask for.

use crate::simulation::Simulation;
use crate::ui::arrangement::{Arrangement, OpenSides, Rearrangement, Side};
use crate::ui::request::Request;
use crate::ui::sections::{Section, sections_ui};
use crate::view::ViewSettings;
use bevy_egui::egui;
use grainfall::run::Parameter;

/// The panels on both sides.
pub struct Sides {
    left: Vec<Section>,
    right: Vec<Section>,
    /// Which sides are shown.
    pub shown: OpenSides,
    /// Where the panels stand at first.
    at_first: Arrangement,
}

impl Sides {
    /// Both sides as they are at first.
    pub fn new([left, right]: [Vec<Section>; 2]) -> Self {
        let shown = OpenSides {
            left: true,
            right: true,
        };
        let mut sides = Self {
            left,
            right,
            shown,
            at_first: Arrangement::default(),
        };
        sides.at_first = sides.arrangement();
        sides
    }

    /// The same panels as at first, standing as in `arrangement`.
    pub fn renewed(&self, panels: [Vec<Section>; 2], arrangement: &Arrangement) -> Self {
        let mut sides = Self::new(panels);
        sides.shown = self.shown;
        sides.arrange(arrangement);
        sides
    }

    /// The sections of both sides.
    pub fn sections(&self) -> impl Iterator<Item = &Section> {
        self.left.iter().chain(&self.right)
    }

    /// The same, to be changed.
    pub fn sections_mut(&mut self) -> impl Iterator<Item = &mut Section> {
        self.left.iter_mut().chain(&mut self.right)
    }

    /// Where the panels stand now.
    pub fn arrangement(&self) -> Arrangement {
        let titles = |sections: &mut dyn Iterator<Item = &Section>| {
            let mut titles: Vec<String> = Vec::new();
            for section in sections {
                let title = section.panel.title();
                // For different kinds of scenes there are two of one title.
                if !titles.iter().any(|known| known == title) {
                    titles.push(title.to_owned());
                }
            }
            titles
        };
        Arrangement {
            left: titles(&mut self.left.iter()),
            right: titles(&mut self.right.iter()),
            closed: titles(&mut self.sections().filter(|section| section.is_closed)),
        }
    }

    /// Lets the panels stand as in `places`; those that it does not know stay where they are.
    pub fn arrange(&mut self, places: &Arrangement) {
        let mut others = Vec::new();
        let mut listed: [Vec<(usize, Section)>; 2] = [Vec::new(), Vec::new()];
        let left = std::mem::take(&mut self.left).into_iter();
        let right = std::mem::take(&mut self.right).into_iter();
        let left = left.enumerate().map(|(at, own)| (Side::Left, at, own));
        let right = right.enumerate().map(|(at, own)| (Side::Right, at, own));
        for (own_side, at, mut section) in left.chain(right) {
            let title = section.panel.title();
            section.is_closed = places.is_closed(title);
            let Some((side, place)) = places.place(title) else {
                others.push((own_side, at, section));
                continue;
            };
            if side != own_side {
                // Elsewhere it would be open or folded as at first.
                section.is_to_be_open = section.is_to_be_open.or(Some(section.is_open()));
            }
            listed[side as usize].push((place, section));
        }
        for (side, mut sections) in Side::ALL.into_iter().zip(listed) {
            sections.sort_by_key(|(place, _)| *place);
            *self.of_mut(side) = sections.into_iter().map(|(_, section)| section).collect();
        }
        for (side, at, section) in others {
            let own = self.of_mut(side);
            own.insert(at.min(own.len()), section);
        }
    }

    fn of_mut(&mut self, side: Side) -> &mut Vec<Section> {
        match side {
            Side::Left => &mut self.left,
            Side::Right => &mut self.right,
        }
    }

    /// Does what was `asked` of the places of panels.
    pub fn rearrange(&mut self, asked: Rearrangement, simulation: Option<&Simulation>) {
        if asked == Rearrangement::AsAtFirst {
            return self.arrange(&self.at_first.clone());
        }
        let is_shown =
            |section: &&Section| simulation.is_none_or(|simulation| section.is_shown(simulation));
        let shown = self.sections().filter(is_shown);
        let shown: Vec<&str> = shown.map(|section| section.panel.title()).collect();
        let mut places = self.arrangement();
        places.rearrange(asked, &shown);
        self.arrange(&places);
    }

    /// The panels that `simulation` has, by their titles, and whether each is shown.
    pub fn titles(&self, simulation: Option<&Simulation>) -> Vec<(&'static str, bool)> {
        let Some(simulation) = simulation else {
            return Vec::new();
        };
        let own = self.sections();
        let own = own.filter(|section| section.panel.applies_to(simulation));
        own.map(|section| (section.panel.title(), !section.is_closed))
            .collect()
    }

    /// Opens the panel called `title`, on whichever side it stands.
    pub fn show_panel(&mut self, title: &str) {
        let sides = [
            (&mut self.left, &mut self.shown.left),
            (&mut self.right, &mut self.shown.right),
        ];
        for (sections, shown) in sides {
            let wanted = sections
                .iter_mut()
                .find(|section| section.panel.title() == title);
            if let Some(section) = wanted {
                (section.is_wanted, *shown) = (true, true);
                section.is_closed = false;
            }
        }
    }

    /// Lets the panel called `title` be about `parameter`.
    pub fn take_up(&mut self, title: &str, parameter: &Parameter) {
        let mut sections = self.sections_mut();
        if let Some(section) = sections.find(|section| section.panel.title() == title) {
            section.panel.take_up(parameter);
        }
    }

    /// Opens every panel.
    pub fn open_all(&mut self) {
        for section in self.sections_mut() {
            section.is_wanted = true;
        }
    }

    /// Draws both sides as far as the window has room for them, `above` over the panels on the left.
    pub fn ui(
        &mut self,
        root: &mut egui::Ui,
        simulation: &Simulation,
        view: &mut ViewSettings,
        out: &mut Vec<Request>,
        above: impl FnOnce(&mut egui::Ui, &mut Vec<Request>),
    ) {
        let window = root.ctx().content_rect().size();
        // Where there is room for one side, it is that of a panel that is asked for.
        let is_asked = |sections: &[Section]| sections.iter().any(|section| section.is_wanted);
        let has_room = self.shown.has_room(Side::Right, window.x);
        self.shown.left &= has_room || !is_asked(&self.right) || is_asked(&self.left);
        let shown = self.shown;
        let panel = |side: Side, name: &'static str| {
            let widths = shown.widths(side, window);
            let panel = match side {
                Side::Left => egui::Panel::left(name),
                Side::Right => egui::Panel::right(name),
            };
            panel
                .default_size(widths.first)
                .size_range(widths.least..=widths.most)
        };
        if shown.has_room(Side::Left, window.x) {
            let panel = panel(Side::Left, "controls");
            panel.show_collapsible(root, &mut self.shown.left, |ui| {
                above(ui, out);
                sections_ui(ui, (Side::Left, &mut self.left), simulation, view, out);
            });
        }
        if shown.has_room(Side::Right, window.x) {
            let panel = panel(Side::Right, "measures");
            panel.show_collapsible(root, &mut self.shown.right, |ui| {
                sections_ui(ui, (Side::Right, &mut self.right), simulation, view, out);
            });
        }
    }
}
