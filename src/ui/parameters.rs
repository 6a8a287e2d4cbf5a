//! Live parameters: a slider and a number for each, in the unit people think in; a change goes out as one command.

use super::{Panel, Request, number, symbol};
use crate::scene::{LIQUID_CASES, PAPER_VOLUME, Scene, SceneContainer};
use crate::simulation::{Command, Parameter, ParameterInfo, Simulation};
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText, WidgetInfo, WidgetType};

/// Width of the field with the number and its unit, in points.
const NUMBER_WIDTH: f32 = 96.0;

/// The panel of live parameters.
#[derive(Default)]
pub struct Parameters;

/// What a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Group {
    Liquid,
    GrainGrain,
    GrainWall,
    Drum,
    Gravity,
    Mixture,
}

impl Group {
    const ALL: [Self; 6] = [
        Self::Liquid,
        Self::GrainGrain,
        Self::GrainWall,
        Self::Drum,
        Self::Gravity,
        Self::Mixture,
    ];

    fn title(self) -> &'static str {
        match self {
            Self::Liquid => "Liquid",
            Self::GrainGrain => "Grain – grain",
            Self::GrainWall => "Grain – wall",
            Self::Drum => "Drum",
            Self::Gravity => "Gravity",
            Self::Mixture => "Mixture",
        }
    }

    fn of(parameter: &Parameter, scene: &Scene) -> Self {
        match parameter {
            Parameter::DrumSpeed => Self::Drum,
            Parameter::Gravity => Self::Gravity,
            Parameter::Share(_) => Self::Mixture,
            Parameter::Viscosity
            | Parameter::SurfaceTension
            | Parameter::ContactAngle
            | Parameter::LiquidVolume
            | Parameter::BridgeLaw => Self::Liquid,
            Parameter::Friction(a, b)
            | Parameter::WetFriction(a, b)
            | Parameter::Restitution(a, b)
            | Parameter::RollingFriction(a, b) => {
                if scene.has_grains_of(a) && scene.has_grains_of(b) {
                    Self::GrainGrain
                } else {
                    Self::GrainWall
                }
            }
        }
    }
}

/// Whether walls of `scene` are made of `material`.
fn is_of_walls(scene: &Scene, material: &str) -> bool {
    match &scene.container {
        SceneContainer::Nothing => false,
        SceneContainer::Drum { material: own, .. } | SceneContainer::Box { material: own, .. } => {
            own == material
        }
        SceneContainer::Column {
            material: floor,
            tube,
            ..
        } => floor == material || tube.as_ref().is_some_and(|tube| tube.material == material),
        SceneContainer::Planes(planes) => planes.iter().any(|plane| plane.material == material),
    }
}

impl Panel for Parameters {
    fn title(&self) -> &'static str {
        "Parameters"
    }

    fn ui(
        &mut self,
        ui: &mut egui::Ui,
        simulation: &Simulation,
        _view: &mut ViewSettings,
        out: &mut Vec<Request>,
    ) {
        let list = simulation.parameters();
        if list.is_empty() {
            ui.weak("The parameters appear when the bed stands.");
            return;
        }
        let grouped = |group| {
            let own = move |info: &&ParameterInfo| {
                Group::of(&info.parameter, simulation.scene()) == group
            };
            list.iter().filter(own)
        };
        for group in Group::ALL {
            let mut pair = None;
            for info in grouped(group) {
                let own = pair_of(&info.parameter);
                if pair != Some(own) {
                    heading_ui(ui, group, own, simulation.scene());
                    if group == Group::Liquid {
                        out.extend(liquids_ui(ui, simulation));
                    }
                    pair = Some(own);
                }
                let value = simulation.value(&info.parameter);
                let wanted = match info.parameter {
                    Parameter::BridgeLaw => bridge_law_ui(ui, info, value),
                    _ => parameter_ui(ui, info, value),
                };
                out.extend(wanted.map(Request::Command));
            }
        }
        ui.add_space(4.0);
        let changed = list
            .iter()
            .any(|info| simulation.value(&info.parameter) != info.default);
        let button = ui.add_enabled(changed, egui::Button::new("Reset all"));
        if button
            .on_hover_text("Every parameter back to the scene's value")
            .clicked()
        {
            let away = list
                .iter()
                .filter(|info| simulation.value(&info.parameter) != info.default);
            out.extend(away.map(|info| Request::Command(set(info, info.default))));
        }
    }
}

/// The two materials that a parameter is about.
fn pair_of(parameter: &Parameter) -> Option<(&str, &str)> {
    match parameter {
        Parameter::Friction(a, b)
        | Parameter::WetFriction(a, b)
        | Parameter::Restitution(a, b)
        | Parameter::RollingFriction(a, b) => Some((a, b)),
        _ => None,
    }
}

/// What stands beside a slider, under a heading that says the rest.
fn short_name(info: &ParameterInfo) -> String {
    match &info.parameter {
        Parameter::Friction(..) if info.label.starts_with("dry") => "Dry friction".into(),
        Parameter::Friction(..) => "Friction".into(),
        Parameter::WetFriction(..) => "Wet friction".into(),
        Parameter::Restitution(..) => "Restitution".into(),
        Parameter::RollingFriction(..) => "Rolling friction".into(),
        _ => number::capitalised(&info.label),
    }
}

fn heading_ui(ui: &mut egui::Ui, group: Group, pair: Option<(&str, &str)>, scene: &Scene) {
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new(group.title()).strong());
        let Some((a, b)) = pair else {
            return;
        };
        let names = ui.weak(format!("{a} – {b}"));
        if group == Group::GrainGrain && (is_of_walls(scene, a) || is_of_walls(scene, b)) {
            names.on_hover_text("Walls are made of it too: these values hold for them as well.");
        }
    });
}

/// The paper's liquids, water to glycerol, and none: each sets what makes it that liquid.
fn liquids_ui(ui: &mut egui::Ui, simulation: &Simulation) -> Vec<Request> {
    let set = |parameter, value| Request::Command(Command::Set { parameter, value });
    let volume = simulation.value(&Parameter::LiquidVolume);
    let mut wanted = Vec::new();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let dry = ui.selectable_label(volume == 0.0, "dry");
        if dry.on_hover_text("No liquid at all").clicked() {
            wanted.push(set(Parameter::LiquidVolume, 0.0));
        }
        for case in &LIQUID_CASES {
            let own = volume > 0.0 && simulation.value(&Parameter::Viscosity) == case.viscosity;
            let button = ui.selectable_label(own, case.name.trim_end_matches(" glycerol"));
            let hint = format!(
                "{}: {} mPa s, case {} of Table 1 of Kasper et al. 2021",
                case.name,
                number::short(1e3 * case.viscosity),
                case.number
            );
            if button.on_hover_text(hint).clicked() {
                if volume == 0.0 {
                    let scene = simulation.scene().liquid.as_ref();
                    let poured = scene.map_or(PAPER_VOLUME, |liquid| liquid.volume);
                    wanted.push(set(Parameter::LiquidVolume, poured));
                }
                wanted.push(set(Parameter::Viscosity, case.viscosity));
                wanted.push(set(Parameter::SurfaceTension, case.surface_tension()));
                wanted.push(set(Parameter::ContactAngle, case.contact_angle()));
            }
        }
    });
    wanted
}

/// The choice between the two bridge laws; the command that a change asks for.
fn bridge_law_ui(ui: &mut egui::Ui, info: &ParameterInfo, value: f64) -> Option<Command> {
    let mut chosen = value;
    ui.horizontal(|ui| {
        let name = ui.label("Bridges");
        name.on_hover_ui(|ui| explanation_ui(ui, info));
        for (law, name) in [(0.0, "as printed"), (1.0, "as coded")] {
            ui.selectable_value(&mut chosen, law, name)
                .on_hover_text(info.description);
        }
    });
    (chosen != value).then(|| set(info, chosen))
}

/// The row of one parameter whose present value is `value` (SI); the command that a change asks for.
pub fn parameter_ui(ui: &mut egui::Ui, info: &ParameterInfo, value: f64) -> Option<Command> {
    let mut shown = value * info.display.factor;
    let range = in_display_units(info);
    let decimals = decimals(range.end() - range.start());
    let mut reset = false;
    let edited = ui.push_id(info.parameter.to_string(), |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        let field = egui::DragValue::new(&mut shown)
            .range(range.clone())
            .clamp_existing_to_range(false)
            .speed((range.end() - range.start()) / 400.0)
            .max_decimals(decimals)
            .min_decimals(decimals.min(2))
            .suffix(suffix(info))
            .update_while_editing(false);
        let (name, field) = egui::Sides::new().shrink_left().truncate().show(
            ui,
            |ui| ui.label(symbol::named(ui, &short_name(info), info.symbol)),
            |ui| {
                reset = reset_ui(ui, info, value != info.default);
                ui.add_sized([NUMBER_WIDTH, 22.0], field)
            },
        );
        ui.spacing_mut().slider_width = ui.available_width();
        ui.spacing_mut().interact_size.y = 18.0;
        let slider = egui::Slider::new(&mut shown, range.clone())
            .show_value(false)
            .logarithmic(info.parameter == Parameter::Viscosity)
            .smallest_positive(0.1)
            .clamping(egui::SliderClamping::Edits);
        let slider = ui.add(slider);
        slider.widget_info(|| WidgetInfo::slider(true, shown, &info.label));
        field.widget_info(|| WidgetInfo {
            label: Some(info.label.clone()),
            ..WidgetInfo::drag_value(true, shown)
        });
        let explained =
            |response: egui::Response| response.on_hover_ui(|ui| explanation_ui(ui, info));
        explained(name);
        explained(slider).changed() | explained(field).changed()
    });
    let wanted = match (reset, edited.inner) {
        (true, _) => info.default,
        (false, true) => in_si(info, shown),
        (false, false) => value,
    };
    (wanted != value && wanted.is_finite()).then(|| set(info, wanted))
}

fn reset_ui(ui: &mut egui::Ui, info: &ParameterInfo, away: bool) -> bool {
    let hint = format!(
        "Back to {}{}",
        number::short(info.default * info.display.factor),
        suffix(info)
    );
    let button = ui
        .add_enabled(away, egui::Button::new("↺").frame(false))
        .on_hover_text(hint);
    let name = format!("Reset {}", info.label);
    button.widget_info(|| WidgetInfo::labeled(WidgetType::Button, away, &name));
    button.clicked()
}

fn explanation_ui(ui: &mut egui::Ui, info: &ParameterInfo) {
    let shown = |value: f64| number::short(value * info.display.factor);
    ui.label(info.description);
    ui.weak(format!(
        "{} from {} to {}{}, {} in the scene",
        info.symbol,
        shown(*info.range.start()),
        shown(*info.range.end()),
        suffix(info),
        shown(info.default),
    ));
    ui.weak(format!("--set {}=… on the command line", info.parameter));
}

fn set(info: &ParameterInfo, value: f64) -> Command {
    Command::Set {
        parameter: info.parameter.clone(),
        value,
    }
}

fn in_display_units(info: &ParameterInfo) -> std::ops::RangeInclusive<f64> {
    info.range.start() * info.display.factor..=info.range.end() * info.display.factor
}

fn in_si(info: &ParameterInfo, shown: f64) -> f64 {
    (shown / info.display.factor).clamp(*info.range.start(), *info.range.end())
}

fn suffix(info: &ParameterInfo) -> String {
    if info.display.name.is_empty() {
        String::new()
    } else {
        format!(" {}", info.display.name)
    }
}

/// Digits after the point that a value in a range of this `width` deserves: a ten-thousandth of it.
fn decimals(width: f64) -> usize {
    (4.0 - width.log10().ceil()).clamp(0.0, 6.0) as usize
}
