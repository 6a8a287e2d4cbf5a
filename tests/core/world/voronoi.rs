//! Voronoi cells: that they fill the box, what shape they have.

use glam::DVec3;
use grainfall::geometry::Solid;
use grainfall::world::{Boundary, Tessellation};

fn cells(counts: [u32; 3], boundary: Boundary, seed: u64) -> Vec<Solid> {
    let max = DVec3::from_array(counts.map(f64::from)) * 2e-3;
    let tessellation = Tessellation::new(DVec3::ZERO, max, 2e-3, boundary, seed);
    assert_eq!(tessellation.len(), counts.iter().product::<u32>() as usize);
    all_cells(&tessellation)
}

fn all_cells(tessellation: &Tessellation) -> Vec<Solid> {
    let all: Vec<usize> = (0..tessellation.len()).collect();
    tessellation.cells(&all)
}

fn mean(cells: &[Solid], count: impl Fn(&Solid) -> usize) -> f64 {
    cells.iter().map(count).sum::<usize>() as f64 / cells.len() as f64
}

#[test]
fn cells_fill_the_box() {
    for boundary in [Boundary::Walls, Boundary::Periodic] {
        for seed in 0..3 {
            let cells = cells([9, 5, 7], boundary, seed);
            for cell in &cells {
                cell.check().unwrap();
            }
            let filled: f64 = cells.iter().map(|cell| cell.moments().volume).sum();
            let whole = 9.0 * 5.0 * 7.0 * 8e-9;
            assert!(
                (filled / whole - 1.0).abs() < 1e-11,
                "{}",
                filled / whole - 1.0
            );
        }
    }
}

#[test]
fn some_of_the_cells_are_those_of_all() {
    let tessellation = Tessellation::new(DVec3::ZERO, DVec3::splat(0.6), 0.1, Boundary::Walls, 8);
    let all = all_cells(&tessellation);
    let some = [0, 3, 77, 78, 215];
    let expected: Vec<Solid> = some.iter().map(|index| all[*index].clone()).collect();
    assert_eq!(tessellation.cells(&some), expected);
    assert!(tessellation.cells(&[]).is_empty());
}

#[test]
fn a_box_of_few_cells_is_filled_too() {
    for counts in [[1, 1, 1], [1, 2, 1], [3, 1, 1]] {
        let cells = cells(counts, Boundary::Walls, 1);
        let filled: f64 = cells.iter().map(|cell| cell.moments().volume).sum();
        let whole = 8e-9 * f64::from(counts.iter().product::<u32>());
        assert!((filled / whole - 1.0).abs() < 1e-12);
    }
}

#[test]
fn a_cell_holds_its_point_and_none_is_as_near() {
    let tessellation = Tessellation::new(DVec3::ZERO, DVec3::splat(0.6), 0.1, Boundary::Walls, 8);
    for (index, cell) in all_cells(&tessellation).into_iter().enumerate() {
        let distance = |x: DVec3, point: usize| tessellation.point(point).distance(x);
        for &corner in &cell.vertices {
            let nearest = (0..tessellation.len())
                .map(|point| distance(corner, point))
                .fold(f64::INFINITY, f64::min);
            assert!((distance(corner, index) - nearest).abs() < 1e-12);
        }
    }
}

#[test]
fn bulk_cells_have_fifteen_and_a_half_faces() {
    let cells = cells([16, 16, 16], Boundary::Periodic, 1);
    let faces = mean(&cells, |cell| cell.faces.len());
    // Three edges meet in every corner, so by Euler's formula E = 3 F − 6 and V = 2 F − 4.
    assert!((mean(&cells, |cell| cell.edges().len()) - (3.0 * faces - 6.0)).abs() < 1e-9);
    assert!((mean(&cells, |cell| cell.vertices.len()) - (2.0 * faces - 4.0)).abs() < 1e-9);
    // 4096 cells with a scatter of 3.3 faces: ± 0.05.
    assert!((faces - 15.5).abs() < 0.15, "{faces}");
}
