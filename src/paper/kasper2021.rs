//! Kasper et al. 2021: the drum, dry and wet. Its cases and its tables.
//!
//! Order of the cases: coarse grains first, which cost least, with few seeds of the liquids that
//! tell most; then the other liquids and more seeds; then finer grains; then the bridges that the
//! paper's program computes instead of those it prints.

use super::markdown::{head, line};
use super::plan::{Batch, Paper, PaperTable};
use crate::measure::{DropThreshold, Measure, ResultKey, RunQuantity, drop_ratio_law};
use crate::sweep::{
    CaseResult, Drum, Drums, Ensemble, Sweep, TableColumn, drum_statements, ensembles,
    statements_table,
};

/// The paper.
pub static KASPER2021: Paper = Paper {
    name: "kasper2021",
    source: "Kasper, Magnanimo, de Jong, Beek, Jarray, Particuology (2021), doi 10.1016/j.partic.2020.12.001",
    scene: "wet",
    settings: &["duration=50s"],
    keys: &["bridge-law", "radius", "liquid"],
    readings: &[],
    beside: &[],
    batches: &[
        Batch::new("r3", R3, &["0", "1", "3", "5", "7"], (1, 2)),
        Batch::new("r3", R3, &["2", "4", "6"], (1, 2)),
        Batch::new("r3", R3, ALL, (3, 4)),
        Batch::new("r2", R2, &["0", "1", "3", "5", "7"], (1, 2)),
        Batch::new("r1.25", R1_25, &["0", "1", "5", "7"], (1, 1)),
        Batch::new("coded", CODED_R3, &["1", "3", "5", "7"], (1, 4)),
        Batch::new("r3", R3, ALL, (5, 8)),
        Batch::new("coded", CODED_R2, &["1", "3", "5", "7"], (1, 2)),
        Batch::new("r2", R2, &["0", "1", "3", "5", "7"], (3, 4)),
        Batch::new("r2", R2, &["2", "4", "6"], (1, 4)),
        Batch::new("r1.25", R1_25, &["0", "1", "5", "7"], (2, 2)),
    ],
    small_settings: &[
        "duration=1s",
        "count=36",
        "drum-radius=20mm",
        "drum-width=16mm",
        "drum-speed=10rpm",
        "liquid-volume=0.3ml",
    ],
    small_batches: &[
        Batch::new("r3", R3, &["0", "1", "7"], (1, 2)),
        Batch::new("coded", CODED_R3, &["7"], (1, 2)),
    ],
    tables,
};

const R3: &[&str] = &[PRINTED, "3mm"];
const R2: &[&str] = &[PRINTED, "2mm"];
const R1_25: &[&str] = &[PRINTED, "1.25mm"];
const CODED_R3: &[&str] = &[CODED, "3mm"];
const CODED_R2: &[&str] = &[CODED, "2mm"];
/// The readings of the bridges' law.
const PRINTED: &str = "as-printed";
const CODED: &str = "as-coded";
/// Dry, and all liquids of Table 1.
const ALL: &[&str] = &["0", "1", "2", "3", "4", "5", "6", "7"];

/// The tables, from the cases that are there.
fn tables(sweep: &Sweep, outcomes: &[CaseResult]) -> Vec<PaperTable> {
    let ensembles = ensembles(sweep, outcomes);
    let drums = |reading| {
        let own = |drum: &&Ensemble| is_of_reading(drum.first(), reading, sweep);
        Drums::of(ensembles.iter().filter(own))
    };
    let statements = |reading| {
        let drums = drums(reading);
        let is_wet = drums.wet().next().is_some();
        statements_table(&if is_wet {
            drum_statements(&drums)
        } else {
            Vec::new()
        })
    };
    let table = |name, title, text| PaperTable { name, title, text };
    vec![
        table("dry", "Dry", dry_table(&drums(PRINTED))),
        table(
            "wet",
            "Wet, bridges as printed",
            wet_table(&drums(PRINTED), sweep),
        ),
        table(
            "coded",
            "Wet, bridges as coded",
            wet_table(&drums(CODED), sweep),
        ),
        table(
            "flow",
            "The flowing layer, bridges as printed",
            flow_table(&drums(PRINTED), sweep),
        ),
        table(
            "statements",
            "Statements, bridges as printed",
            statements(PRINTED),
        ),
        table(
            "statements-coded",
            "Statements, bridges as coded",
            statements(CODED),
        ),
    ]
}

/// The rows of the dry table.
const DRY: &[TableColumn] = &[
    TableColumn::of_samples("θ", Measure::SurfaceAngle),
    TableColumn::of_run("θ_m", RunQuantity::MaximumAngle),
    TableColumn::of_run("θ_r", RunQuantity::ReposeAngle),
    TableColumn::of_run("drop ⟨Δθ⟩", RunQuantity::Drop),
    TableColumn::of_run("drops", RunQuantity::Avalanches),
    TableColumn::drop_from("Δθ ≥ 2°", DropThreshold::TwoDegrees),
    TableColumn::of_run("time between drops", RunQuantity::Period),
    TableColumn::of_run("rise between drops", RunQuantity::RiseRate),
    TableColumn::of_samples("⟨Tg⟩", Measure::GranularTemperature),
    TableColumn::of_run("Tg in drops", RunQuantity::TemperatureInAvalanches),
    TableColumn::of_run(
        "Tg between drops, median",
        RunQuantity::TemperatureBetweenAvalanches,
    ),
    TableColumn::of_run("ta/ts", RunQuantity::NonRigidShare),
    TableColumn::of_run("ta/ts′", RunQuantity::CorotatingShare),
    TableColumn::of_samples("packing fraction φ", Measure::PackingFraction),
    TableColumn::of_samples("coordination number Z", Measure::CoordinationNumber),
    TableColumn::of_samples("roughness h", Measure::SurfaceRoughness),
    TableColumn::of_samples("curvature κ", Measure::SurfaceCurvature),
    TableColumn::of_samples("largest overlap", Measure::LargestOverlap).with_digits(4),
    TableColumn::of_run("energy residual", RunQuantity::RelativeEnergyResidual),
];

/// The columns of the wet tables behind those of the drops.
const WET: &[TableColumn] = &[
    TableColumn::of_samples("⟨Tg⟩", Measure::GranularTemperature),
    TableColumn::of_run("ta/ts", RunQuantity::NonRigidShare),
    TableColumn::of_run("ta/ts′", RunQuantity::CorotatingShare),
    TableColumn::of_samples("φ", Measure::PackingFraction),
    TableColumn::of_samples("Z", Measure::CoordinationNumber),
    TableColumn::of_samples("h", Measure::SurfaceRoughness),
    TableColumn::of_samples("κ", Measure::SurfaceCurvature),
];
/// Those of the table of the flow.
const FLOW: &[TableColumn] = &[
    TableColumn::of_run("u_0", RunQuantity::FlowSpeed),
    TableColumn::of_run("d_f", RunQuantity::FlowDepth),
];
const ANGLE: TableColumn = TableColumn::of_samples("θ", Measure::SurfaceAngle);
const DROP: TableColumn = TableColumn::of_run("Δθ", RunQuantity::Drop);
const DROPS: TableColumn = TableColumn::of_run("drops", RunQuantity::Avalanches);

/// A column for each dry drum, coarse grains first.
fn dry_table(drums: &Drums) -> String {
    let mut dry: Vec<&Drum> = drums.0.iter().filter(|drum| drum.is_dry()).collect();
    dry.reverse();
    let row = |first: String, cell: &dyn Fn(&Drum) -> String| {
        let cells = dry.iter().map(|drum| cell(drum));
        std::iter::once(first).chain(cells).collect::<Vec<_>>()
    };
    let grains = |drum: &Drum| drum.ensemble.first().case.scene.grain_count().to_string();
    let mut text = head(&row("quantity".into(), &|drum| {
        format!("r = {} mm", drum.radius)
    }));
    text += &line(&row("seeds".into(), &seeds));
    text += &line(&row("grains".into(), &grains));
    for result in DRY {
        let cell = |drum: &Drum| result.cell_for_people(&drum.ensemble.results());
        text += &line(&row(result.head(), &cell));
    }
    text
}

/// The heads of the columns that tell a drum from others.
const WHICH: [&str; 4] = ["r [mm]", "n", "η [mPa s]", "seeds"];

/// What tells `drum` from others, and of how many `seeds` a row is.
fn which(drum: &Drum, seeds: usize, sweep: &Sweep) -> [String; 4] {
    let viscosity = if drum.is_dry() {
        "dry".to_owned()
    } else {
        drum.viscosity.to_string()
    };
    let number = value(drum.ensemble.first(), "liquid", sweep).to_owned();
    [
        drum.radius.to_string(),
        number,
        viscosity,
        seeds.to_string(),
    ]
}

/// The drums radius by radius, coarse grains first.
fn by_radius<'a>(drums: &'a Drums) -> Vec<&'a [Drum<'a>]> {
    let mut radii: Vec<&[Drum]> = drums.0.chunk_by(|a, b| a.radius == b.radius).collect();
    radii.reverse();
    radii
}

/// A row for each drum of which it is known how fast it flows.
fn flow_table(drums: &Drums, sweep: &Sweep) -> String {
    let heads = WHICH.map(str::to_owned).into_iter();
    let mut text = head(
        &heads
            .chain(FLOW.iter().map(TableColumn::head))
            .collect::<Vec<_>>(),
    );
    for drum in by_radius(drums).into_iter().flatten() {
        let members = drum.ensemble.members.iter();
        let known = members.filter(|own| own.result(RunQuantity::FlowSpeed).is_some());
        let seeds = known.count();
        if seeds > 0 {
            let results = drum.ensemble.results();
            let cells = FLOW.iter().map(|column| column.cell_for_people(&results));
            text += &line(
                &(which(drum, seeds, sweep).into_iter())
                    .chain(cells)
                    .collect::<Vec<_>>(),
            );
        }
    }
    text
}

/// A row for each drum, coarse grains first and the dry one of each radius before the wet ones.
fn wet_table(drums: &Drums, sweep: &Sweep) -> String {
    let first = WHICH.map(str::to_owned);
    let drops = [ANGLE.head(), DROP.head(), DROPS.head()];
    let ratios = ["Δθ/Δθ dry", "Eq. 23"].map(str::to_owned);
    let rest = WET.iter().map(TableColumn::head);
    let heads = first.into_iter().chain(drops).chain(ratios).chain(rest);
    let mut text = head(&heads.collect::<Vec<_>>());
    for drums in by_radius(drums)
        .iter()
        .filter(|drums| drums.iter().any(|drum| !drum.is_dry()))
    {
        let dry = drums.iter().find(|drum| drum.is_dry());
        for drum in *drums {
            text += &line(&wet_row(drum, dry, sweep));
        }
    }
    text
}

fn wet_row(drum: &Drum, dry: Option<&Drum>, sweep: &Sweep) -> Vec<String> {
    let results = drum.ensemble.results();
    let drop = ResultKey::from(RunQuantity::Drop);
    let wet = || (!drum.is_dry()).then_some(drum);
    let ratio = wet().and_then(|wet| Some(wet.get(drop)?.over(dry?.get(drop)?)));
    let ratio = ratio.map(|own| RunQuantity::NonRigidShare.quantity().text(own));
    let law = wet().map(|wet| format!("{:.2}", drop_ratio_law(1e-3 * wet.viscosity)));
    let nothing = || crate::measure::numeral::NOTHING.to_owned();
    let cells = which(drum, drum.ensemble.members.len(), sweep).into_iter();
    let of_drops = [ANGLE, DROP, DROPS].map(|column| column.cell_for_people(&results));
    let ratios = [ratio, law].map(|cell| cell.unwrap_or_else(nothing));
    let rest = WET.iter().map(|column| column.cell_for_people(&results));
    cells.chain(of_drops).chain(ratios).chain(rest).collect()
}

/// Whether a case belongs to this reading of the bridges' law; dry drums, which have no bridges,
/// belong to all.
fn is_of_reading(case: &CaseResult, reading: &str, sweep: &Sweep) -> bool {
    case.case.scene.liquid.is_none() || value(case, "bridge-law", sweep) == reading
}

/// The value of the varied `key` in a case.
fn value<'a>(case: &'a CaseResult, key: &str, sweep: &Sweep) -> &'a str {
    let mut values = sweep.variations.iter().zip(&case.case.values);
    let own = values.find(|(variation, _)| variation.key == key);
    own.map_or("", |(_, value)| value.as_str())
}

fn seeds(drum: &Drum) -> String {
    drum.ensemble.members.len().to_string()
}
