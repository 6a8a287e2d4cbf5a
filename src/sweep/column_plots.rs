//! The plots of a sweep of columns: Figs. 5 to 14 and 16 of Man et al. 2023, with its laws drawn
//! in.
//!
//! Cases that differ in height alone share a colour. Where the mixing ratio is varied, plots over
//! the aspect ratio have one panel, a file of its own, for each ratio, as in the paper. Points are
//! means over the seeds, or single runs, with bars of one standard error, curves over time with
//! bands.

use super::Sweep;
use super::case::CaseResult;
use super::chart::{ChartAxis, Line, Plot};
use super::column_laws::{
    cone_volume_line, height_slopes, peak_time_line, rest_time_lines, run_out_line, run_out_slopes,
};
use super::ensemble::{Ensemble, ensembles};
use super::variation::SEED;
use crate::measure::{Estimate, Measure, RunQuantity, contact_shares_law};
use crate::physics::units;

/// The varied key that makes the points of a curve.
const HEIGHT: &str = "height";
/// The varied key that makes the panels of a figure.
const MIX: &str = "mix";

/// Every plot of these outcomes.
pub fn column_plots(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<Plot> {
    let figures = Figures { sweep, outcomes };
    let mut plots = figures.courses();
    plots.extend(figures.panels("run-out-aspect", RunQuantity::RunOut, run_out_slopes));
    plots.extend(figures.panels("height-aspect", RunQuantity::RelativeHeight, height_slopes));
    plots.extend(figures.over_effective());
    plots.extend(figures.shares());
    plots
}

struct Figures<'a> {
    sweep: &'a Sweep,
    outcomes: &'a [CaseResult],
}

impl Figures<'_> {
    /// The values of a case but those of the keys `without`, as `mix=0.1 mu22=0.4`.
    fn label(&self, outcome: &CaseResult, without: &[&str]) -> String {
        let varied = self.sweep.variations.iter().zip(&outcome.case.values);
        let kept = varied.filter(|(variation, _)| !without.contains(&variation.key.as_str()));
        let texts: Vec<String> = kept
            .map(|(v, value)| format!("{}={value}", v.key))
            .collect();
        texts.join(" ")
    }

    fn varies(&self, key: &str) -> bool {
        self.sweep.variations.iter().any(|v| v.key == key)
    }

    /// The outcomes by their labels without these keys, in the order in which the labels first
    /// occur.
    fn groups<'b>(
        &self,
        outcomes: &[&'b CaseResult],
        without: &[&str],
    ) -> Vec<(String, Vec<&'b CaseResult>)> {
        let mut groups: Vec<(String, Vec<&CaseResult>)> = Vec::new();
        for &outcome in outcomes {
            let label = self.label(outcome, without);
            match groups.iter_mut().find(|(known, _)| *known == label) {
                Some((_, members)) => members.push(outcome),
                None => groups.push((label, vec![outcome])),
            }
        }
        groups
    }

    /// A line of the result `y` over the result `x` for each group of cases that differ in height
    /// alone.
    fn lines(
        &self,
        outcomes: &[&CaseResult],
        hidden: &[&str],
        [x, y]: [RunQuantity; 2],
    ) -> Vec<Line> {
        let without: Vec<&str> = hidden.iter().copied().chain([HEIGHT, SEED]).collect();
        let line = |(label, members): (String, Vec<&CaseResult>)| {
            let members = ensembles(self.sweep, members);
            let points = members
                .iter()
                .filter_map(|ensemble| ensemble.mean(x).zip(ensemble.estimate(y)));
            let positive = points.filter(|(x, y)| *x > 0.0 && y.mean > 0.0);
            Line::means(or(label, "cases"), positive)
        };
        let groups = self.groups(outcomes, &without).into_iter();
        groups.map(line).collect()
    }

    /// The result `y` over the aspect ratio (Figs. 8, 9 and 12), one panel for each mixing ratio.
    fn panels(&self, file: &str, y: RunQuantity, laws: fn(&[Line]) -> Vec<Line>) -> Vec<Plot> {
        let all: Vec<&CaseResult> = self.outcomes.iter().collect();
        let keys = self.sweep.variations.iter().map(|v| v.key.as_str());
        let others: Vec<&str> = keys.filter(|key| *key != MIX).collect();
        let panel = |(label, members): (String, Vec<&CaseResult>)| {
            let mut lines = self.lines(&members, &[MIX], [RunQuantity::AspectRatio, y]);
            lines.extend(laws(&lines));
            Plot {
                file: format!("{}.svg", named(file, &label)),
                title: format!("{} over α {label}", y.quantity().key),
                x: axis(RunQuantity::AspectRatio),
                y: axis(y),
                lines,
            }
        };
        let groups = self.groups(&all, &others).into_iter();
        groups.map(panel).collect()
    }

    /// Run-out, volume of the cone and times over the effective aspect ratio (Figs. 11, 13, 14,
    /// 16).
    fn over_effective(&self) -> Vec<Plot> {
        let all: Vec<&CaseResult> = self.outcomes.iter().collect();
        let plot = |file: &str, x: RunQuantity, y: RunQuantity, laws: Vec<Line>| {
            let mut lines = self.lines(&all, &[], [x, y]);
            lines.extend(laws);
            Plot {
                file: format!("{file}.svg"),
                title: format!("{} over {}", y.quantity().key, x.quantity().key),
                x: axis(x),
                y: axis(y),
                lines,
            }
        };
        let effective = RunQuantity::EffectiveAspectRatio;
        let packed = RunQuantity::PackedAspectRatio;
        let volume = RunQuantity::RelativeConeVolume;
        let (peak_time, rest_time) = (
            RunQuantity::DimensionlessPeakTime,
            RunQuantity::DimensionlessRestTime,
        );
        vec![
            plot(
                "run-out",
                effective,
                RunQuantity::RunOut,
                vec![run_out_line()],
            ),
            plot("run-out-packed", packed, RunQuantity::RunOut, Vec::new()),
            plot(
                "cone-volume",
                effective,
                RunQuantity::ConeVolume,
                Vec::new(),
            ),
            plot(
                "cone-volume-ratio",
                effective,
                volume,
                vec![cone_volume_line()],
            ),
            plot("peak-time", effective, peak_time, vec![peak_time_line()]),
            plot("rest-time", effective, rest_time, rest_time_lines()),
        ]
    }

    /// Front and energy over time (Figs. 5 to 7): a plot of all heights for each group, or of all
    /// cases where the height is not varied.
    fn courses(&self) -> Vec<Plot> {
        let keys = self.sweep.variations.iter().map(|v| v.key.as_str());
        let others: Vec<&str> = keys.filter(|key| *key != HEIGHT).collect();
        let (together, hidden) = if self.varies(HEIGHT) {
            (self.groups(&self.with_course(), &[HEIGHT, SEED]), others)
        } else {
            (vec![(String::new(), self.with_course())], vec![SEED])
        };
        let both = |(label, members): (String, Vec<&CaseResult>)| {
            let mut members = ensembles(self.sweep, members);
            members.sort_by(by_aspect_ratio);
            let plot = |file: &str, y: ChartAxis, value: SampleValue| {
                let line = |ensemble: &Ensemble| {
                    let name = or(self.label(ensemble.first(), &hidden), "case");
                    Line::means(name, over_time(ensemble, value))
                };
                Plot {
                    file: format!("courses/{}.svg", named(file, &label)),
                    title: format!("{} {label}", y.label()),
                    x: ChartAxis::linear("time [s]"),
                    y,
                    lines: members.iter().map(line).collect(),
                }
            };
            let energy_axis = ChartAxis::logarithmic("kinetic energy per grain [g cm²/s²]");
            let front_axis = ChartAxis::linear("front radius R [mm]");
            [
                plot("front", front_axis, front),
                plot("energy", energy_axis, energy),
            ]
        };
        together.into_iter().flat_map(both).collect()
    }

    /// Shares of the pairs of species over time, with those that chance gives (Fig. 10): a plot of
    /// each case.
    fn shares(&self) -> Vec<Plot> {
        let plot = |ensemble: &Ensemble| {
            let label = self.label(ensemble.first(), &[SEED]);
            Plot {
                file: format!("courses/{}.svg", named("contacts", &label)),
                title: format!("contact shares {label}"),
                x: ChartAxis::linear("time [s]"),
                y: ChartAxis::linear("share of the touching pairs"),
                lines: shares_over_time(ensemble),
            }
        };
        let all = ensembles(self.sweep, self.with_course());
        all.iter().map(plot).collect()
    }

    /// The outcomes whose samples are there.
    fn with_course(&self) -> Vec<&CaseResult> {
        self.outcomes
            .iter()
            .filter(|own| own.has_course())
            .collect()
    }
}

/// The axis of a result, by powers of ten and in the SI unit.
fn axis(quantity: RunQuantity) -> ChartAxis {
    ChartAxis::logarithmic(quantity.quantity().key)
}

/// A number that each sample of a case gives, by the sample's index.
type SampleValue = fn(&CaseResult, usize) -> f64;

fn front(outcome: &CaseResult, sample: usize) -> f64 {
    1e3 * outcome.series.column(Measure::FrontRadius)[sample]
}

fn energy(outcome: &CaseResult, sample: usize) -> f64 {
    let of = |measure: Measure| outcome.series.column(measure)[sample];
    (of(Measure::TranslationalEnergy) + of(Measure::RotationalEnergy)) * units::ERG.shown.factor
}

fn by_aspect_ratio(one: &Ensemble, other: &Ensemble) -> std::cmp::Ordering {
    let ratio = |own: &Ensemble| own.mean(RunQuantity::AspectRatio).unwrap_or(0.0);
    ratio(one).total_cmp(&ratio(other))
}

/// Means over the members at the times at which each of them has a sample.
fn over_time(ensemble: &Ensemble, value: SampleValue) -> Vec<(f64, Estimate)> {
    let times = ensemble.first().series.time();
    let mean = |time: &f64| {
        let values: Option<Vec<f64>> = ensemble
            .members
            .iter()
            .map(|member| Some(value(member, sample_at(member, *time)?)))
            .collect();
        Some((*time, Estimate::of_runs(&values?)))
    };
    times.iter().filter_map(mean).collect()
}

/// The index of the sample at exactly this time, if there is one.
fn sample_at(outcome: &CaseResult, time: f64) -> Option<usize> {
    let times = outcome.series.time();
    times.binary_search_by(|own| own.total_cmp(&time)).ok()
}

fn shares_over_time(ensemble: &Ensemble) -> Vec<Line> {
    let kinds: [(&str, SampleValue); 3] = [
        ("P11", |o, k| o.series.column(Measure::FirstPairs)[k]),
        ("P12", |o, k| o.series.column(Measure::MixedPairs)[k]),
        ("P22", |o, k| o.series.column(Measure::SecondPairs)[k]),
    ];
    let curve = |(kind, value): (&str, SampleValue)| Line::means(kind, over_time(ensemble, value));
    let mut lines: Vec<Line> = kinds.into_iter().map(curve).collect();
    let last = lines[0].points.last();
    let end = last.map_or(0.0, |(time, _)| *time);
    let second = ensemble.mean(RunQuantity::SecondShare).unwrap_or(0.0);
    // One entry in the legend names all three.
    let names = ["by chance (Eq. 4.1)", "", ""];
    let chance = contact_shares_law(second).into_iter().zip(names);
    lines.extend(chance.map(|(share, name)| Line {
        name: name.into(),
        points: vec![(0.0, share), (end, share)],
        is_law: true,
        ..Line::default()
    }));
    lines
}

/// A file's name with what tells it from the others of its kind.
fn named(file: &str, label: &str) -> String {
    let label = label.replace(['/', '\\'], "-").replace(' ', "_");
    if label.is_empty() {
        file.to_owned()
    } else {
        format!("{file}-{label}")
    }
}

fn or(label: String, otherwise: &str) -> String {
    if label.is_empty() {
        otherwise.to_owned()
    } else {
        label
    }
}

#[cfg(test)]
mod tests {
    use super::super::plot_files::plots;
    use super::super::{Case, Variation};
    use super::*;
    use crate::measure::{
        PEAK_TIME_LAW, REST_TIME_LAW, Sample, Series, Summary, cone_volume_law, run_out_law,
    };
    use crate::output::Ending;
    use crate::run::BedStore;
    use crate::scene::Scene;
    use crate::solver::{Fault, FaultKind};

    const SCENE: &str = r#"(title: "Any", materials: {"a": ()}, container: Nothing, grains: List([
        (position: (0, 0, 0), radius: 1, material: "a")]))"#;

    fn variation(text: &str) -> Variation {
        Variation::parse(text).unwrap()
    }

    fn sweep(variations: &[&str]) -> Sweep {
        Sweep {
            name: "column".into(),
            scene: Scene::parse("any", SCENE).unwrap(),
            settings: Vec::new(),
            variations: variations.iter().map(|text| variation(text)).collect(),
            out: "nowhere".into(),
            jobs: 1,
            beds: BedStore::none(),
            restart: false,
        }
    }

    /// The results of a column `alpha` high, of the effective aspect ratio 1.2 times that, as the
    /// laws have them.
    fn results(alpha: f64) -> Summary {
        let effective = 1.2 * alpha;
        let root = effective.sqrt();
        let numbers = [
            (RunQuantity::AspectRatio, alpha),
            (RunQuantity::EffectiveAspectRatio, effective),
            (RunQuantity::PackedAspectRatio, 0.8_f64.sqrt() * effective),
            (RunQuantity::RunOut, run_out_law(effective)),
            (RunQuantity::RelativeHeight, alpha.min(0.8)),
            (RunQuantity::ConeVolume, 1e-5 * alpha),
            (RunQuantity::RelativeConeVolume, cone_volume_law(effective)),
            (RunQuantity::DimensionlessPeakTime, PEAK_TIME_LAW * root),
            (RunQuantity::DimensionlessRestTime, REST_TIME_LAW * root),
            (RunQuantity::SecondShare, 0.3),
        ];
        Summary::of_numbers(&numbers.map(|(quantity, value)| (quantity.into(), value)))
    }

    /// Thirty samples of a front that spreads evenly.
    fn samples() -> Series {
        let mut series = Series::default();
        for step in 0..30 {
            let time = step as f64 * 0.02;
            let mut values = [f64::NAN; Measure::COUNT];
            values[Measure::FrontRadius as usize] = 0.025 + 0.1 * time;
            values[Measure::TranslationalEnergy as usize] = 1e-6 * time;
            values[Measure::RotationalEnergy as usize] = 1e-7 * time;
            values[Measure::FirstPairs as usize] = 0.48;
            values[Measure::MixedPairs as usize] = 0.43;
            values[Measure::SecondPairs as usize] = 0.09;
            series.push(Sample { step, time, values });
        }
        series
    }

    /// A case of these varied values that follows the laws, `alpha` high.
    fn outcome(values: &[&str], alpha: f64) -> CaseResult {
        CaseResult {
            case: Case {
                name: values.join("_"),
                values: values.iter().map(|&value| value.to_owned()).collect(),
                scene: Scene::parse("any", SCENE).unwrap(),
                script: Vec::new(),
                time_step: 1e-6,
            },
            ending: Ending::Done,
            results: results(alpha),
            series: samples(),
            flow: Vec::new(),
            fastest: None,
            hash: "0".repeat(32),
            method: None,
        }
    }

    fn of<'a>(plots: &'a [Plot], file: &str) -> &'a Plot {
        let files = || {
            plots
                .iter()
                .map(|plot| plot.file.as_str())
                .collect::<Vec<_>>()
        };
        let mut plots = plots.iter();
        let found = plots.find(|plot| plot.file == file);
        found.unwrap_or_else(|| panic!("no {file} among {:?}", files()))
    }

    fn names(plot: &Plot) -> Vec<&str> {
        plot.lines.iter().map(|line| line.name.as_str()).collect()
    }

    #[test]
    fn figures_have_a_line_per_mixture_and_a_point_per_height() {
        let sweep = sweep(&["mix=0.1,0.3", "mu22=0.2,0.4", "height=1cm,5cm,30cm"]);
        let mut outcomes = Vec::new();
        for mix in ["0.1", "0.3"] {
            for friction in ["0.2", "0.4"] {
                for (height, alpha) in [("1cm", 0.4), ("5cm", 2.0), ("30cm", 12.0)] {
                    outcomes.push(outcome(&[mix, friction, height], alpha));
                }
            }
        }
        let plots = column_plots(&sweep, &outcomes);
        let run_out = of(&plots, "run-out.svg");
        assert_eq!(run_out.lines.len(), 4 + 1);
        assert_eq!(names(run_out)[0], "mix=0.1 mu22=0.2");
        // Over α_eff every point lies on the law.
        for (x, y) in &run_out.lines[0].points {
            assert!((y / run_out_law(*x) - 1.0).abs() < 1e-14);
        }
        let panel = of(&plots, "run-out-aspect-mix=0.3.svg");
        assert_eq!(names(panel)[..2], ["mu22=0.2", "mu22=0.4"]);
        assert_eq!(panel.lines[1].points.len(), 3);
        let courses = of(&plots, "courses/energy-mix=0.1_mu22=0.4.svg");
        assert_eq!(names(courses), ["height=1cm", "height=5cm", "height=30cm"]);
        let last = courses.lines[0].points[29];
        assert!((last.1 - 11.0 * 0.58).abs() < 1e-12, "in g cm²/s²");
        let contacts = of(&plots, "courses/contacts-mix=0.1_mu22=0.2_height=1cm.svg");
        assert_eq!(contacts.lines.len(), 6);
        assert!((contacts.lines[4].points[0].1 - 0.42).abs() < 1e-15);
        for plot in &plots {
            assert!(plot.has_points(), "{}", plot.file);
            let text = plot.draw().unwrap();
            assert!(
                text.starts_with("<svg") && !text.contains("NaN"),
                "{}",
                plot.file
            );
        }
        let files: std::collections::HashSet<_> = plots.iter().map(|plot| &plot.file).collect();
        assert_eq!(files.len(), plots.len());
    }

    #[test]
    fn heights_that_are_not_varied_leave_one_panel_and_one_course_of_all() {
        let sweep = sweep(&["mu11=0.1,0.4"]);
        let outcomes = [outcome(&["0.1"], 2.0), outcome(&["0.4"], 2.0)];
        let plots = column_plots(&sweep, &outcomes);
        let front = of(&plots, "courses/front.svg");
        assert_eq!(names(front), ["mu11=0.1", "mu11=0.4"]);
        // All at one aspect ratio: no slope can be drawn.
        assert_eq!(of(&plots, "run-out-aspect.svg").lines.len(), 2);
    }

    #[test]
    fn seeds_over_time_are_a_mean_with_its_error_while_all_of_them_run() {
        let sweep = sweep(&["height=1cm,5cm", "seed=1,2"]);
        let mut outcomes = [
            outcome(&["5cm", "1"], 2.0),
            outcome(&["1cm", "2"], 0.4),
            outcome(&["1cm", "1"], 0.4),
        ];
        let mut shorter = Series::default();
        for (step, time) in outcomes[1].series.time()[..20].iter().enumerate() {
            let mut values = [f64::NAN; Measure::COUNT];
            values[Measure::FrontRadius as usize] = 0.027 + 0.1 * time;
            shorter.push(Sample {
                step: step as u64,
                time: *time,
                values,
            });
        }
        outcomes[1].series = shorter;
        let plots = column_plots(&sweep, &outcomes);
        let front = of(&plots, "courses/front.svg");
        assert_eq!(names(front), ["height=1cm", "height=5cm"]);
        let [both, alone] = &front.lines[..] else {
            panic!("{:?}", names(front))
        };
        assert_eq!((both.points.len(), alone.points.len()), (20, 30));
        assert!((both.points[0].1 - 26.0).abs() < 1e-12);
        // 25 and 27 mm: a mean of 26 ± 1.
        let (_, low, high) = both.bars[0];
        assert!((low - 25.0).abs() < 1e-12 && (high - 27.0).abs() < 1e-12);
        assert!(alone.bars.is_empty());
    }

    #[test]
    fn a_case_that_met_a_fault_or_never_began_is_no_point() {
        let sweep = sweep(&["height=1cm,5cm"]);
        let mut outcomes = [outcome(&["1cm"], 0.4), outcome(&["5cm"], 2.0)];
        let drawn = |outcomes: &[CaseResult]| {
            let plots: Vec<Plot> = plots(&sweep, outcomes).collect();
            of(&plots, "run-out.svg").lines[0].points.len()
        };
        assert_eq!(drawn(&outcomes), 2);
        outcomes[1].ending = Ending::Faulted(Fault {
            grain: 0,
            time: 0.5,
            good_time: 0.4,
            kind: FaultKind::TooFast(1e3),
        });
        assert_eq!(drawn(&outcomes), 1);
        outcomes[1].ending = Ending::Interrupted;
        assert_eq!(drawn(&outcomes), 2, "what it came to so far");
        outcomes[1].results.to = 0.0;
        assert_eq!(drawn(&outcomes), 1);
    }

    #[test]
    fn a_single_case_is_drawn_and_what_did_not_rest_has_no_time() {
        let mut moving = outcome(&["5cm"], 2.0);
        let rest = RunQuantity::DimensionlessRestTime.into();
        moving.results.entries.retain(|entry| entry.key != rest);
        let plots = column_plots(&sweep(&["height=5cm"]), &[moving]);
        assert!(!of(&plots, "rest-time.svg").has_points());
        assert_eq!(names(of(&plots, "run-out.svg"))[0], "cases");
    }
}
