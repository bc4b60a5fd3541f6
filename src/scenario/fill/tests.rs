//! How bodies are filled.

use super::{Filling, PointSet};
use crate::boundary::Side;
use crate::material::Plane;
use crate::scenario::shape::{Ball, Cuboid, Shape};
use crate::scenario::{BodySpec, GridSpec, LoadPlace, Region};

fn grid(cells: &[i32], cell_size: f64) -> GridSpec {
    let max = cells
        .iter()
        .map(|count| f64::from(*count) * cell_size)
        .collect();
    GridSpec {
        min: vec![0.0; cells.len()],
        max,
        cell_size,
        cells: cells.to_vec(),
    }
}

fn cuboid(min: &[f64], max: &[f64]) -> Shape {
    Shape::Cuboid(Cuboid {
        min: min.to_vec(),
        max: max.to_vec(),
    })
}

fn ball(center: &[f64], radius: f64) -> Shape {
    Shape::Ball(Ball {
        center: center.to_vec(),
        radius,
    })
}

fn total(points: &PointSet) -> f64 {
    (0..points.positions.len())
        .map(|index| points.volume(index))
        .sum()
}

#[test]
fn points_tile_a_box_exactly() {
    let shape = cuboid(&[0.1, 0.2], &[1.15, 0.95]);
    let filling = Filling::new(&shape, &grid(&[4, 4], 0.5), &[2, 3], Plane::Strain);
    let points = filling.points();
    assert_eq!((filling.count(), points.positions.len()), (4 * 5, 20));
    approx::assert_relative_eq!(points.spacing[0], 1.05 / 4.0, max_relative = 1e-14);
    approx::assert_relative_eq!(points.spacing[1], 0.75 / 5.0, max_relative = 1e-14);
    approx::assert_relative_eq!(
        points.positions[0][0],
        0.1 + 0.5 * 1.05 / 4.0,
        max_relative = 1e-14
    );
    approx::assert_relative_eq!(
        points.positions[19][1],
        0.95 - 0.5 * 0.15,
        max_relative = 1e-14
    );
    approx::assert_relative_eq!(total(&points), 1.05 * 0.75, max_relative = 1e-14);
    assert!(
        points.positions.is_sorted_by(|a, b| a < b),
        "lexicographic order"
    );
}

#[test]
fn points_of_whole_cells_get_the_second_moment_asked_for() {
    let grid = grid(&[4, 4, 4], 0.5);
    let placed = |shape: Shape, per_cell: [u32; 3], moment| {
        let body = BodySpec {
            name: "box".into(),
            material: 0,
            shape,
            particles_per_cell: per_cell.to_vec(),
            moment,
            velocity: Vec::new(),
        };
        Filling::of(&body, &grid, Plane::Strain).points()
    };
    let whole = || cuboid(&[0.5, 0.0, 1.0], &[1.5, 2.0, 1.5]);
    for moment in [0.5, 0.63, 0.7, 1.0] {
        let points = placed(whole(), [2, 3, 4], Some(moment));
        assert_eq!(points.positions.len(), 4 * 12 * 4);
        assert!(points.positions.is_sorted_by(|a, b| a < b));
        for axis in 0..3 {
            let square = |at: &[f64; 3]| ((at[axis] / 0.5).fract() - 0.5).powi(2);
            let mean = points.positions.iter().map(square).sum::<f64>() / 192.0;
            approx::assert_relative_eq!(12.0 * mean, moment, max_relative = 1e-12);
            let upper = points.positions.iter().map(|at| at[axis]);
            let outermost = upper.fold(0.0, f64::max) + points.to_face[axis];
            approx::assert_relative_eq!(outermost, [1.5, 2.0, 1.5][axis], max_relative = 1e-14);
        }
        approx::assert_relative_eq!(total(&points), 1.0, max_relative = 1e-14);
    }
    // half cells, cells of one point and other shapes keep what they had
    let half = || cuboid(&[0.25, 0.0, 1.0], &[1.25, 2.0, 1.5]);
    let ball = || ball(&[1.0, 1.0, 1.0], 0.5);
    for (shape, per_cell) in [
        (&half as &dyn Fn() -> Shape, [2, 2, 2]),
        (&whole, [2, 1, 2]),
        (&ball, [2, 2, 2]),
    ] {
        let (even, drawn) = (
            placed(shape(), per_cell, None),
            placed(shape(), per_cell, Some(0.6)),
        );
        assert_eq!(even, drawn);
    }
}

#[test]
fn points_divide_cells_only_where_they_reach_across_none() {
    let grid = grid(&[4, 4], 0.1);
    let divides = |shape: &Shape, per_cell: [u32; 2]| {
        Filling::new(shape, &grid, &per_cell, Plane::Strain).divides_cells(&grid)
    };
    assert!(divides(&ball(&[0.17, 0.2], 0.11), [3, 2]));
    assert!(divides(&cuboid(&[0.1, 0.1], &[0.3, 0.4]), [1, 3]));
    // from the middle of a cell on: two points a cell end with it, one or three do not
    assert!(divides(&cuboid(&[0.05, 0.1], &[0.25, 0.4]), [2, 2]));
    assert!(!divides(&cuboid(&[0.05, 0.1], &[0.25, 0.4]), [1, 2]));
    assert!(!divides(&cuboid(&[0.1, 0.05], &[0.3, 0.35]), [2, 3]));
    // a box that is no whole number of cells long has points of its own width
    assert!(!divides(&cuboid(&[0.1, 0.1], &[0.33, 0.4]), [2, 2]));
}

#[test]
fn a_box_thinner_than_the_spacing_has_one_layer() {
    let shape = cuboid(&[0.0, 0.0, 0.0], &[1.0, 1.0, 1e-3]);
    let points = Filling::new(&shape, &grid(&[4, 4, 4], 0.5), &[1, 1, 1], Plane::Strain).points();
    assert_eq!(points.positions.len(), 4);
    approx::assert_relative_eq!(total(&points), 1e-3, max_relative = 1e-14);
}

#[test]
fn a_ball_is_filled_on_the_lattice_of_the_grid_with_its_exact_volume() {
    for dimension in 1..=3 {
        let shape = ball(&[1.02; 3][..dimension], 0.7);
        let grid = grid(&[8; 3][..dimension], 0.25);
        let filling = Filling::new(&shape, &grid, &[2; 3][..dimension], Plane::Strain);
        let points = filling.points();
        assert_eq!(filling.count(), points.positions.len() as u64);
        approx::assert_relative_eq!(
            total(&points),
            shape.measure().unwrap_or(0.0),
            max_relative = 1e-12
        );
        for at in &points.positions {
            assert!(shape.contains(&at[..dimension]));
            for x in &at[..dimension] {
                let lattice = x / 0.125 - 0.5;
                approx::assert_abs_diff_eq!(lattice, lattice.round(), epsilon = 1e-9);
            }
        }
        assert!(
            points.positions.is_sorted_by(|a, b| a < b),
            "lexicographic order"
        );
    }
}

#[test]
fn points_of_an_axisymmetric_scene_are_rings() {
    let shape = cuboid(&[0.5, 0.0], &[1.0, 2.0]);
    let points = Filling::new(&shape, &grid(&[8, 8], 0.25), &[2, 2], Plane::Axisymmetric).points();
    let exact = std::f64::consts::PI * (1.0 - 0.25) * 2.0;
    approx::assert_relative_eq!(total(&points), exact, max_relative = 1e-13);
    let outer = Side {
        axis: 0,
        upper: true,
    };
    let area: f64 = points
        .selected(&LoadPlace::Region(Region::Side(outer)))
        .iter()
        .map(|k| points.side_area(*k, outer))
        .sum();
    approx::assert_relative_eq!(area, 2.0 * std::f64::consts::PI * 2.0, max_relative = 1e-13);
    let top = Side {
        axis: 1,
        upper: true,
    };
    let area: f64 = points
        .selected(&LoadPlace::Region(Region::Side(top)))
        .iter()
        .map(|k| points.side_area(*k, top))
        .sum();
    approx::assert_relative_eq!(area, std::f64::consts::PI * 0.75, max_relative = 1e-13);
}

#[test]
fn a_side_is_its_outermost_layer_with_the_area_of_the_face() {
    let shape = cuboid(&[0.0, 0.0, 0.0], &[1.0, 2.0, 0.5]);
    let points = Filling::new(&shape, &grid(&[4, 4, 4], 0.5), &[2, 2, 2], Plane::Strain).points();
    let side = Side {
        axis: 1,
        upper: true,
    };
    let selected = points.selected(&LoadPlace::Region(Region::Side(side)));
    assert_eq!(selected.len(), 4 * 2);
    assert!(
        selected
            .iter()
            .all(|index| points.positions[*index][1] == 1.875)
    );
    let area: f64 = selected
        .iter()
        .map(|index| points.side_area(*index, side))
        .sum();
    approx::assert_relative_eq!(area, 0.5, max_relative = 1e-14);
}

#[test]
fn a_box_selects_what_it_holds() {
    let shape = cuboid(&[0.0, 0.0], &[1.0, 1.0]);
    let filling_grid = grid(&[2, 2], 0.5);
    let filling = Filling::new(&shape, &filling_grid, &[2, 2], Plane::Strain);
    let (min, max) = (vec![f64::NEG_INFINITY, 0.3], vec![0.375, f64::INFINITY]);
    assert!(filling.reaches(&min, &max));
    assert!(!filling.reaches(&[0.13, 0.0], &[0.37, 1.0]));
    let points = filling.points();
    let selected = points.selected(&LoadPlace::Region(Region::Box { min, max }));
    assert_eq!(selected, [1, 2, 3, 5, 6, 7]);
    assert_eq!(points.nearest(&[0.25, 0.25]), Some(0));
    assert_eq!(points.nearest(&[9.0, 0.4]), Some(13));
}
