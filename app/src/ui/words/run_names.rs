//! What the runs of a window are called: `μ 0.8`, `μ 0.8 from 3.20 s`, `glycerol`, or as a person named
//! them.
//!
//! In: the simulation. Out: a name for each run, no two alike, for plots, lists, exports and the
//! picture. A name that a person gave wins; else a run is called by the values of the parameters in
//! which the runs differ, a value that came later with its moment. Of runs that do not differ the
//! first is called so, the others by their numbers: `run 2`.

use crate::simulation::Simulation;
use crate::ui::words::names::{parameter_name, value_in_words};
use crate::ui::words::number;
use grainfall::lab::{Half, RunView};
use grainfall::parameters::{Parameter, Value};
use grainfall::physics::{Liquid, LiquidCase};
use grainfall::run::{Branch, Change, changes};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Most parameters that every run is called by: of more, each by those alone that were changed in
/// it.
const FEW: usize = 2;
/// Most values in one label.
const MOST: usize = 3;

/// What the runs of a window are called: a name that a person gave, or else what differs in each.
/// No two are called alike.
pub struct RunNames {
    halves: Vec<String>,
    /// Those that were left for others: of the left run, then of the right one.
    pub kept: Vec<KeptRun>,
}

/// A run that was left for another, with its name.
pub type KeptRun = (String, Arc<Branch>);

impl RunNames {
    /// Of all runs of `simulation`.
    pub fn of(simulation: &Simulation) -> Self {
        let right = simulation.comparison().map(|comparison| comparison.right);
        let left = simulation.half(Half::Left);
        let halves: Vec<&RunView> = [left].into_iter().chain(right).collect();
        let kept: Vec<(&RunView, &Arc<Branch>)> = (halves.iter())
            .flat_map(|run| run.past().kept.iter().map(|branch| (*run, branch)))
            .collect();
        if halves.len() + kept.len() == 1 {
            let past = simulation.past();
            let given = past.names.of(past.number).unwrap_or(THIS_RUN);
            return Self {
                halves: vec![given.to_owned()],
                kept: Vec::new(),
            };
        }
        let present = halves.iter().map(|run| Unnamed {
            changes: changes(run.each_change()),
            given: run.past().names.of(run.past().number),
            number: run.past().number,
        });
        let left = kept.iter().map(|(run, branch)| Unnamed {
            changes: changes(branch.history.each_change()),
            given: run.past().names.of(branch.number),
            number: branch.number,
        });
        let all: Vec<Unnamed> = present.chain(left).collect();
        let mut names = labels(&all, simulation);
        let of_kept = names.split_off(halves.len());
        let branches = kept.into_iter().map(|(_, branch)| branch.clone());
        Self {
            halves: names,
            kept: of_kept.into_iter().zip(branches).collect(),
        }
    }

    /// Whether there is more than one run, or one that has a name of its own: then it is worth being
    /// told.
    pub fn are_told(&self) -> bool {
        self.halves.len() + self.kept.len() > 1 || self.present(Half::Left) != THIS_RUN
    }

    /// What the present run in `half` is called.
    pub fn present(&self, half: Half) -> &str {
        (self.halves.get(half.index())).map_or(THIS_RUN, String::as_str)
    }
}

/// What a run is called that is alone.
const THIS_RUN: &str = "this run";
/// What a run is called in which nothing was changed, among those in which much was.
const UNCHANGED: &str = "the scene unchanged";

/// What one of two runs side by side is called.
pub fn half_title(simulation: &Simulation, half: Half) -> String {
    RunNames::of(simulation).present(half).to_owned()
}

/// A run to be called something.
struct Unnamed<'a> {
    /// What was changed in it.
    changes: Vec<Change>,
    /// What a person called it.
    given: Option<&'a str>,
    /// Its number among all branches.
    number: u32,
}

/// The values of one parameter, each with the time from which on it holds [s]; the first from zero
/// on.
type Course = Vec<(f64, Value)>;

/// In what runs differ.
struct Differing {
    /// These parameters have not the same values in all of them.
    parameters: Vec<Parameter>,
    /// Their liquids are different ones of the paper's table, and not only in their viscosity, which
    /// stands for all of it.
    are_liquids: bool,
}

/// A label for each of `runs`, all of the scene of `run`, no two alike.
fn labels(runs: &[Unnamed], run: &RunView) -> Vec<String> {
    let courses: Vec<Courses> = runs.iter().map(|own| Courses::of(own, run)).collect();
    let differing = differing(&courses, run);
    let unnamed = |index: &usize| runs[*index].given.is_none();
    let is_again = |index: usize| {
        let mut before = (0..index).filter(unnamed);
        before.any(|other| courses[other].are_those_of(&courses[index], run))
    };
    let own = |index: usize, is_long: bool| match runs[index].given {
        Some(given) => given.to_owned(),
        None if is_again(index) => String::new(),
        None => courses[index].label(&differing, run, is_long),
    };
    let short: Vec<String> = (0..runs.len()).map(|index| own(index, false)).collect();
    let is_double = |label: &String| short.iter().filter(|other| *other == label).count() > 1;
    let told = |index: usize| {
        if is_double(&short[index]) {
            own(index, true)
        } else {
            short[index].clone()
        }
    };
    unlike((0..runs.len()).map(told).collect(), runs)
}

/// The `labels` with the number of the run behind those that another run has, too, and in the place
/// of those that say nothing.
fn unlike(labels: Vec<String>, runs: &[Unnamed]) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let mut own = |(label, run): (String, &Unnamed)| {
        let label = match label.as_str() {
            "" => format!("run {}", run.number),
            label if seen.contains(label) => format!("{label} (run {})", run.number),
            _ => label,
        };
        seen.insert(label.clone());
        label
    };
    labels.into_iter().zip(runs).map(&mut own).collect()
}

/// The values of all parameters of one run that were changed in it.
struct Courses(BTreeMap<Parameter, Course>);

impl Courses {
    fn of(own: &Unnamed, run: &RunView) -> Self {
        let mut courses = BTreeMap::new();
        for change in &own.changes {
            for setting in &change.set {
                let course = courses
                    .entry(setting.parameter.clone())
                    .or_insert_with(|| begin(&setting.parameter, run));
                go_on(course, change.time, setting.value);
            }
        }
        Self(courses)
    }

    /// The values of `parameter`.
    fn course(&self, parameter: &Parameter, run: &RunView) -> Course {
        let own = self.0.get(parameter).cloned();
        own.unwrap_or_else(|| begin(parameter, run))
    }

    /// Whether all parameters have the same values at the same times in `other`.
    fn are_those_of(&self, other: &Self, run: &RunView) -> bool {
        let mut changed = self.0.keys().chain(other.0.keys());
        changed.all(|parameter| self.course(parameter, run) == other.course(parameter, run))
    }

    /// The last value of `parameter`.
    fn last(&self, parameter: &Parameter, run: &RunView) -> Option<f64> {
        let course = self.course(parameter, run);
        course.last().map(|(_, value)| value.number())
    }

    /// What the run is called among those that differ in `differing`; with all values that it had
    /// had where it `is_long`.
    fn label(&self, differing: &Differing, run: &RunView, is_long: bool) -> String {
        let was_changed = |parameter: &&Parameter| {
            let course = self.course(parameter, run);
            course != begin(parameter, run)
        };
        let differing_ones = &differing.parameters;
        let told: Vec<&Parameter> = if differing_ones.len() <= FEW {
            differing_ones.iter().collect()
        } else {
            differing_ones.iter().filter(was_changed).collect()
        };
        if told.is_empty() && !differing_ones.is_empty() {
            return UNCHANGED.to_owned();
        }
        let parts = told.iter().take(MOST);
        let parts = parts.map(|parameter| self.part(parameter, differing, run, is_long));
        let text = parts.collect::<Vec<_>>().join(", ");
        if told.len() > MOST {
            format!("{text} …")
        } else {
            text
        }
    }

    fn part(
        &self,
        parameter: &Parameter,
        differing: &Differing,
        run: &RunView,
        is_long: bool,
    ) -> String {
        let course = self.course(parameter, run);
        let names_liquid = *parameter == Parameter::Viscosity && differing.are_liquids;
        let case = self.liquid_case(run).filter(|_| names_liquid);
        let told = if is_long && case.is_none() {
            0
        } else {
            course.len() - 1
        };
        let values = course[told..].iter().map(|(time, value)| {
            let value = match case {
                Some(case) => case.name.to_owned(),
                None => value_in_words(parameter, *value),
            };
            format!("{value}{}", since(*time))
        });
        let values = values.collect::<Vec<_>>().join(", ");
        match case {
            Some(_) => values,
            None => format!("{} {values}", symbol(parameter, &differing.parameters, run)),
        }
    }

    /// The liquid of the paper's table that the run came to, where it is one of them.
    fn liquid_case(&self, run: &RunView) -> Option<&'static LiquidCase> {
        let stated = run.scene().liquid?;
        let now = |parameter| self.last(&parameter, run);
        LiquidCase::of_liquid(&Liquid {
            viscosity: now(Parameter::Viscosity)?,
            surface_tension: now(Parameter::SurfaceTension)?,
            contact_angle: now(Parameter::ContactAngle)?,
            ..stated
        })
    }
}

/// The values of a parameter that is not changed: that of the scene.
fn begin(parameter: &Parameter, run: &RunView) -> Course {
    let default = run.info_of(parameter).map(|info| info.default);
    vec![(0.0, default.unwrap_or(Value::Number(0.0)))]
}

/// From when on a value holds, where that is not the start.
fn since(time: f64) -> String {
    if time > 0.0 {
        format!(" from {}", number::moment(time))
    } else {
        String::new()
    }
}

/// Goes on with another `value` from `time` [s] on.
fn go_on(course: &mut Course, time: f64, value: Value) {
    if let Some(last) = course.last_mut() {
        if last.0 >= time {
            last.1 = value;
        } else if last.1 != value {
            course.push((time, value));
        }
    }
}

/// The parameters whose values are not the same in all runs.
fn differing(courses: &[Courses], run: &RunView) -> Differing {
    let changed: BTreeSet<&Parameter> = courses.iter().flat_map(|own| own.0.keys()).collect();
    let differs = |parameter: &&Parameter| {
        let mut all = courses.iter().map(|own| own.course(parameter, run));
        let first = all.next();
        all.any(|course| Some(course) != first)
    };
    let mut parameters: Vec<Parameter> = changed.into_iter().filter(differs).cloned().collect();
    let others = [Parameter::SurfaceTension, Parameter::ContactAngle];
    let are_liquids = parameters.contains(&Parameter::Viscosity)
        && others.iter().any(|own| parameters.contains(own))
        && courses.iter().all(|own| own.liquid_case(run).is_some());
    if are_liquids {
        parameters.retain(|own| !others.contains(own));
    }
    Differing {
        parameters,
        are_liquids,
    }
}

/// What stands before a value: the symbol, with the names where several of one symbol differ; a
/// name where there is no symbol that says all.
fn symbol(parameter: &Parameter, differing: &[Parameter], run: &RunView) -> String {
    let row = parameter.row();
    if row.symbol.is_empty() || matches!(parameter, Parameter::Share(_)) {
        return parameter_name(parameter, run);
    }
    let alike = differing
        .iter()
        .filter(|own| own.row().symbol == row.symbol);
    match parameter.pair() {
        Some((a, b)) if alike.count() > 1 => format!("{} {a} – {b}", row.symbol),
        _ => row.symbol.to_owned(),
    }
}
