//! Live parameters: a slider and a number for each, in the unit people think in; a change goes out
//! as one command. In the laboratory also what acts from the next start on.

use crate::simulation::Simulation;
use crate::ui::detail::{Detail, is_basic};
use crate::ui::panel::Panel;
use crate::ui::panels::start_values::StartValues;
use crate::ui::request::{Request, SweepAct};
use crate::ui::widgets::row_button::{row_button_ui, sweep_button_ui};
use crate::ui::widgets::touch;
use crate::ui::widgets::value_row::{ValueRow, value_ui};
use crate::ui::words::{number, symbol};
use crate::view::ViewSettings;
use bevy_egui::egui::{self, RichText};
use grainfall::lab::Half;
use grainfall::lesson::Touch;
use grainfall::parameters::{Choice, Kind, PanelSection, Parameter, ParameterInfo, Value, Values};
use grainfall::physics::{LIQUID_CASES, PAPER_VOLUME};
use grainfall::run::Command;
use grainfall::scene::Scene;

/// The panel of parameters.
#[derive(Default)]
pub struct Parameters {
    start: StartValues,
}

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

    /// That of a live parameter.
    fn of(parameter: &Parameter, scene: &Scene) -> Option<Self> {
        let [a, b] = parameter.names();
        match parameter.row().section {
            PanelSection::Drum => Some(Self::Drum),
            PanelSection::Gravity => Some(Self::Gravity),
            PanelSection::Mixture => Some(Self::Mixture),
            PanelSection::Liquid => Some(Self::Liquid),
            PanelSection::Contact
                if scene.has_grains_of(a) && scene.has_grains_of(b) && scene.grain_count() > 1 =>
            {
                Some(Self::GrainGrain)
            }
            PanelSection::Contact => Some(Self::GrainWall),
            PanelSection::Start | PanelSection::Nowhere => None,
        }
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
        let detail = Detail::ui(ui);
        if simulation.recording().is_some() {
            ui.weak("As they were in the recording.");
            if ui.button("Run anew to change them").clicked() {
                out.push(Request::RunAnew);
            }
        } else {
            ui.weak("These act at once, also while it runs.");
        }
        let is_live = simulation.recording().is_none();
        ui.add_enabled_ui(is_live, |ui| {
            for group in Group::ALL {
                group_ui(ui, group, detail, simulation, out);
            }
        });
        ui.add_space(4.0);
        self.footer_ui(ui, detail, simulation, out);
    }
}

impl Parameters {
    fn footer_ui(
        &mut self,
        ui: &mut egui::Ui,
        detail: Detail,
        simulation: &Simulation,
        out: &mut Vec<Request>,
    ) {
        let is_away = |info: &&ParameterInfo| {
            let value = simulation.value(&info.parameter);
            value.is_some_and(|value| value != info.default)
        };
        let away = || simulation.parameters().iter().filter(is_away);
        let of_start = self.start.changed(simulation);
        let button = ui
            .add_enabled(
                away().count() + of_start > 0 && simulation.recording().is_none(),
                egui::Button::new("Reset all"),
            )
            .on_hover_text("Every value back to the scene's; some of them act at the next start")
            .on_disabled_hover_text("Every value is the scene's");
        if button.clicked() {
            out.extend(away().map(|info| Request::Command(set(info, info.default))));
            self.start.reset(simulation);
        }
        if detail == Detail::Lab {
            self.start.rows_ui(ui, simulation, out);
        } else {
            let live = away().filter(|info| is_unseen(info, simulation));
            unseen_ui(ui, live.count() + of_start);
        }
        self.start.footer_ui(ui, out);
    }
}

/// Whether the panel does not show the parameter of `info`. Of two species that share the grains,
/// the share of the one that is shown says that of the other.
fn is_unseen(info: &ParameterInfo, simulation: &Simulation) -> bool {
    let scene = simulation.scene();
    let is_said = matches!(info.parameter, Parameter::Share(_)) && scene.species().len() == 2;
    !is_basic(info, scene) && !is_said
}

/// Says how many values are others than the scene's and not shown, and shows them.
fn unseen_ui(ui: &mut egui::Ui, unseen: usize) {
    let text = format!("{unseen} more changed: show them in Lab");
    if unseen > 0 && ui.button(text).clicked() {
        Detail::Lab.choose(ui.ctx());
    }
}

/// The parameters of a group that `detail` shows, under their headings.
fn group_ui(
    ui: &mut egui::Ui,
    group: Group,
    detail: Detail,
    simulation: &Simulation,
    out: &mut Vec<Request>,
) {
    let scene = simulation.scene();
    let ctx = ui.ctx().clone();
    let is_asked =
        |info: &ParameterInfo| touch::is_asked(&ctx, &Touch::Parameter(info.parameter.clone()));
    let shown = |info: &&ParameterInfo| {
        let wanted = detail == Detail::Lab || is_basic(info, scene) || is_asked(info);
        wanted && info.acts && Group::of(&info.parameter, scene) == Some(group)
    };
    let mut pair = None;
    for info in in_order(simulation.parameters().iter().filter(shown), scene) {
        let own = info.parameter.pair();
        if pair != Some(own) {
            heading_ui(ui, group, own, scene);
            if group == Group::Liquid {
                out.extend(liquids_ui(ui, simulation));
            }
            pair = Some(own);
        }
        let is_compared = (simulation.comparison())
            .is_some_and(|comparison| *comparison.parameter == info.parameter);
        if !is_compared {
            let (mut compared, mut swept) = (false, false);
            let Some(value) = simulation.value(&info.parameter) else {
                continue;
            };
            let row = ui.scope(|ui| {
                parameter_ui(ui, info, value, detail, scene, |ui| {
                    let is_number = matches!(info.values, Values::Range(_));
                    swept = is_number && sweep_button_ui(ui, &info.label);
                    compared = compare_ui(ui, info, simulation);
                })
            });
            touch::mark_ui(
                ui,
                &Touch::Parameter(info.parameter.clone()),
                row.response.rect,
            );
            out.extend(row.inner.map(|value| Request::Command(set(info, value))));
            let about = || Some(info.parameter.clone());
            out.extend(compared.then(|| Request::Compare(about())));
            out.extend(swept.then(|| Request::Sweep(SweepAct::Ask(about()))));
            continue;
        }
        for half in Half::ALL {
            let named = ParameterInfo {
                label: format!("{}, {}", info.label, half.label()),
                ..info.clone()
            };
            ui.weak(number::capitalised(half.label()));
            let Some(value) = simulation.half(half).value(&info.parameter) else {
                continue;
            };
            let wanted = ui.push_id(half, |ui| {
                parameter_ui(ui, &named, value, detail, scene, |_| ())
            });
            let parameter = info.parameter.clone();
            let set_in = |value| Request::SetIn(half, parameter, value);
            out.extend(wanted.inner.map(set_in));
        }
    }
}

/// The `list` with the parameters of each pair of materials together, those that matter most first.
fn in_order<'a>(
    list: impl Iterator<Item = &'a ParameterInfo>,
    scene: &Scene,
) -> Vec<&'a ParameterInfo> {
    let mut list: Vec<&ParameterInfo> = list.collect();
    let pairs: Vec<_> = list.iter().map(|info| info.parameter.pair()).collect();
    let place = |info: &&ParameterInfo| {
        let pair = info.parameter.pair();
        let place = pairs.iter().position(|other| *other == pair);
        (place, !is_basic(info, scene))
    };
    list.sort_by_cached_key(place);
    list
}

/// The button that leads to two values of a parameter side by side; whether it was pressed.
fn compare_ui(ui: &mut egui::Ui, info: &ParameterInfo, simulation: &Simulation) -> bool {
    let other = "Two values are compared already: end that comparison first";
    let why_not = simulation.comparison().is_some().then_some(other);
    let name = format!("Compare {}…", info.label);
    let hint = "Compare two values of it side by side…";
    row_button_ui(ui, "⇄", &name, hint, why_not)
}

/// The row of one parameter of `scene`, with what is drawn `beside` its field: what is wanted
/// instead of `value`, if anything.
pub fn parameter_ui(
    ui: &mut egui::Ui,
    info: &ParameterInfo,
    value: Value,
    detail: Detail,
    scene: &Scene,
    beside: impl FnOnce(&mut egui::Ui),
) -> Option<Value> {
    match &info.values {
        Values::Choices(choices) => choice_ui(ui, info, choices, value, scene, beside),
        Values::Range(_) => number_ui(ui, info, value, detail, scene, beside),
    }
}

/// What stands beside a slider, under a heading that says the rest.
fn short_name(info: &ParameterInfo, scene: &Scene) -> String {
    let row = info.row();
    if !row.short_name.is_empty() {
        row.short_name.to_owned()
    } else if info.parameter.pair().is_some() {
        number::capitalised((row.name)(scene))
    } else {
        number::capitalised(&info.label)
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
        if group == Group::GrainGrain && (scene.has_walls_of(a) || scene.has_walls_of(b)) {
            names.on_hover_text("Walls are made of it too: these values hold for them as well.");
        }
    });
}

/// The paper's liquids, water to glycerol, and none: each sets what makes it that liquid.
fn liquids_ui(ui: &mut egui::Ui, simulation: &Simulation) -> Vec<Request> {
    let set = |parameter, value: f64| {
        let value = value.into();
        Request::Command(Command::Set { parameter, value })
    };
    let value = |parameter| simulation.value(parameter).map(Value::number);
    let volume = value(&Parameter::LiquidVolume).unwrap_or(0.0);
    let mut wanted = Vec::new();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        let dry = ui.selectable_label(volume == 0.0, "dry");
        if dry.on_hover_text("No liquid at all").clicked() {
            wanted.push(set(Parameter::LiquidVolume, 0.0));
        }
        for (index, case) in LIQUID_CASES.iter().enumerate() {
            if index == 1 {
                ui.weak("glycerol in water:");
            }
            let own = volume > 0.0 && value(&Parameter::Viscosity) == Some(case.viscosity);
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

/// The choice between the values of `info`; what is wanted instead of `value`, if anything.
fn choice_ui(
    ui: &mut egui::Ui,
    info: &ParameterInfo,
    choices: &'static [Choice],
    value: Value,
    scene: &Scene,
    beside: impl FnOnce(&mut egui::Ui),
) -> Option<Value> {
    let (mut chosen, description) = (value, info.row().description);
    ui.horizontal(|ui| {
        ui.label(short_name(info, scene)).on_hover_text(description);
        for choice in choices {
            ui.selectable_value(&mut chosen, choice.into(), choice.name)
                .on_hover_text(description);
        }
        beside(ui);
    });
    (chosen != value).then_some(chosen)
}

/// The row of a number of `scene` that is `value` now, with what is drawn `beside` its field; what
/// is wanted instead, if anything.
fn number_ui(
    ui: &mut egui::Ui,
    info: &ParameterInfo,
    value: Value,
    detail: Detail,
    scene: &Scene,
    beside: impl FnOnce(&mut egui::Ui),
) -> Option<Value> {
    let own = info.row();
    let (name, range) = (short_name(info, scene), info.range());
    let mut row = ValueRow {
        label: &info.label,
        name: &name,
        symbol: own.symbol,
        default: info.default.number(),
        display: own.kind.unit().shown,
        is_logarithmic: own.is_logarithmic(&range),
        is_whole: own.kind == Kind::Count,
        presets: &[],
        caption: None,
        range,
    };
    let extent = row.extent();
    let presets = info.presets(scene);
    match detail {
        // Liquids have buttons of their own.
        Detail::Basics if info.parameter != Parameter::Viscosity => row.presets = &presets,
        Detail::Basics => {}
        Detail::Lab => row.caption = Some(format!("{extent} · acts at once")),
    }
    let wanted = value_ui(ui, &row, value.number(), beside, |ui| {
        ui.label(own.description);
        ui.label(symbol::text(ui, (own.equation)(scene)));
        ui.weak(&extent);
        ui.weak("It acts from the next step on.");
        ui.weak(format!("--set {}=… on the command line", info.parameter));
    });
    wanted.map(|wanted| own.value(wanted))
}

fn set(info: &ParameterInfo, value: Value) -> Command {
    Command::Set {
        parameter: info.parameter.clone(),
        value,
    }
}
