//! How the two sides of a contact stand and move, every term of its force, and the sum.
//!
//! In: a contact and its terms from the solver. Out: rows of a table.

use crate::ui::widgets::value_table::TableRow;
use crate::ui::words::number;
use glam::DVec3;
use grainfall::solver::ForceTerms;
use grainfall::world::{Contact, Partner, World};

/// How the two sides of `contact` stand and move, every term of its force, and the sum.
pub(super) fn term_rows(contact: &Contact, terms: &[ForceTerms]) -> Vec<TableRow> {
    let mut rows = motion_rows(terms);
    rows.extend(normal_rows(contact, terms));
    rows.extend(tangential_rows(contact, terms));
    let sum: DVec3 = terms.iter().map(ForceTerms::force).sum();
    rows.extend([
        TableRow::of(
            "Sum of the terms",
            newtons(sum.length()),
            "Of all forces above",
        ),
        TableRow::of(
            "In the last step",
            newtons(contact.force.length()),
            "The force that moved the grains in the last time step; the sum above is that of the state shown",
        ),
    ]);
    rows
}

/// What a recording holds of `contact`: how its two sides stand, and the parts of the whole force.
pub(super) fn recorded_rows(world: &World, contact: &Contact) -> Vec<TableRow> {
    let (grains, i) = (&world.grains, contact.grain as usize);
    let mut rows = Vec::new();
    if contact.force.is_finite() {
        rows.push(TableRow::of(
            "Force",
            newtons(contact.force.length()),
            "The whole force, as the solver applied it",
        ));
    }
    if world.polyhedra.is_some() {
        return rows;
    }
    let (gap, towards) = match contact.partner {
        Partner::Grain(j) => {
            let (j, way) = (j as usize, grains.position[j as usize] - grains.position[i]);
            let gap = way.length() - grains.radius[i] - grains.radius[j];
            (gap, way.normalize_or_zero())
        }
        Partner::Wall(w) => {
            let surface = &world.container.walls[w as usize].surface;
            let (distance, towards) = surface.distance(grains.position[i]);
            (distance - grains.radius[i], towards)
        }
    };
    rows.push(place_row(-gap));
    if contact.force.is_finite() {
        let along = contact.force.dot(towards);
        let across = contact.force - along * towards;
        rows.extend([
            TableRow::of(
                "Normal",
                newtons(-along),
                "Positive where it pushes apart; the bridge's part too",
            ),
            TableRow::of("Tangential", newtons(across.length()), "Across the normal"),
        ]);
    }
    rows
}

/// How deep two sides overlap, or how far they are apart [m].
fn place_row(overlap: f64) -> TableRow {
    let (place, length) = if overlap > 0.0 {
        ("Overlap δ", overlap)
    } else {
        ("Gap D", -overlap)
    };
    TableRow::of(
        place,
        number::with_prefix(length, "m"),
        "At the deepest place where the two touch",
    )
}

fn newtons(force: f64) -> String {
    number::with_prefix(force, "N")
}

fn deepest(terms: &[ForceTerms]) -> f64 {
    (terms.iter().map(|t| t.overlap)).fold(f64::NEG_INFINITY, f64::max)
}

fn motion_rows(terms: &[ForceTerms]) -> Vec<TableRow> {
    let (approach, slip) = (terms.first()).map_or((0.0, 0.0), |t| (t.approach, t.slip.length()));
    let speed = |v: f64| number::with_prefix(v, "m/s");
    let mut rows = vec![
        place_row(deepest(terms)),
        TableRow::of(
            "Approach",
            speed(approach),
            "Along the normal, half a step ago; negative while parting",
        ),
        TableRow::of("Slip", speed(slip), "Of one surface over the other"),
    ];
    if terms.iter().any(|t| t.feature.is_some()) {
        let places = terms.len().to_string();
        rows.push(TableRow::of(
            "Places",
            places,
            "Pairs of features that touch",
        ));
    }
    rows
}

fn normal_rows(contact: &Contact, terms: &[ForceTerms]) -> Vec<TableRow> {
    let along =
        |of: fn(&ForceTerms) -> DVec3| newtons(terms.iter().map(|t| -of(t).dot(t.normal)).sum());
    let mut rows = vec![
        TableRow::of(
            "Normal spring",
            along(|t| t.normal_spring),
            "k_n δ, positive where it pushes apart",
        ),
        TableRow::of(
            "Normal dashpot",
            along(|t| t.normal_dashpot),
            "η_n times the speed of approach",
        ),
    ];
    if contact.bridge.is_some() {
        rows.push(TableRow::of(
            "Capillary",
            along(|t| t.capillary),
            "Eq. 13 of Kasper et al. 2021; negative where it pulls together",
        ));
        rows.push(TableRow::of(
            "Viscous, normal",
            along(|t| t.viscous_normal),
            "Eq. 16 of Kasper et al. 2021",
        ));
    }
    rows
}

fn tangential_rows(contact: &Contact, terms: &[ForceTerms]) -> Vec<TableRow> {
    let across = |of: fn(&ForceTerms) -> DVec3| {
        let sum: DVec3 = terms.iter().map(of).sum();
        newtons(sum.length())
    };
    let mut rows = vec![
        TableRow::of(
            "Tangential spring",
            across(|t| t.tangential_spring),
            "k_t times the elastic slip ξ",
        ),
        TableRow::of(
            "Tangential dashpot",
            across(|t| t.tangential_dashpot),
            "η_t times the slip velocity; none while it slides",
        ),
    ];
    if contact.bridge.is_some() {
        rows.push(TableRow::of(
            "Viscous, tangential",
            across(|t| t.viscous_tangential),
            "Eq. 17 of Kasper et al. 2021",
        ));
    }
    if deepest(terms) > 0.0 {
        rows.push(TableRow::of(
            "Coulomb bound",
            bound(terms),
            "μ times the normal force: what the tangential force cannot exceed",
        ));
    }
    let rolling: DVec3 = terms.iter().map(|t| t.rolling).sum();
    rows.push(TableRow::of(
        "Rolling torque",
        number::with_prefix(rolling.length(), "N m"),
        "Eq. 10 of Kasper et al. 2021, from the torque of now",
    ));
    rows
}

/// The Coulomb bound and how much of it is used.
fn bound(terms: &[ForceTerms]) -> String {
    let bound: f64 = terms.iter().map(|t| t.coulomb_bound).sum();
    let used: f64 = terms.iter().map(|t| t.tangential_spring.length()).sum();
    let state = if terms.iter().all(|t| t.slides) {
        "slides".to_owned()
    } else {
        format!("{} % used", number::fixed(100.0 * used / bound, 0))
    };
    format!("{} · {state}", number::with_prefix(bound, "N"))
}
