//! What every registered basis has to satisfy.

use super::*;
use crate::real::{Portable, Real};

const CELLS: [i32; 6] = [1, 2, 3, 4, 7, 25];
const SPACINGS: [f64; 6] = [1.0, 0.5, 1.0 / 3.0, 0.25, 0.2, 0.7];

/// A property of one basis on a grid of `cells` cells.
trait Property {
    fn check<const N: usize, B: Basis<N>>(&self, basis: B, cells: i32, label: &str);
}

struct Check<'a, P>(&'a P, &'a str);

impl<P: Property> BasisVisitor for Check<'_, P> {
    type Output = ();
    fn visit<const N: usize, B: Basis<N>>(self, basis: B) {
        for cells in CELLS {
            for spacing in SPACINGS {
                let label = format!("{}, {cells} cells, spacing {spacing}", self.1);
                self.0.check(basis.for_spacing(spacing), cells, &label);
            }
        }
    }
}

fn every_basis(property: &impl Property) {
    assert!(BasisChoice::all().len() >= 4);
    for choice in BasisChoice::all() {
        choice.visit(Check(property, choice.name()));
    }
}

/// Both ends, all cell edges, their floating-point neighbours inside the grid, and places in between.
fn places(cells: i32) -> Vec<f64> {
    let end = f64::from(cells);
    let mut places = Vec::new();
    for edge in 0..=cells {
        let edge = f64::from(edge);
        places.extend([edge, edge.next_up(), edge.next_down()]);
        places.extend([0.05, 0.25, 0.3333, 0.5, 0.6180, 0.75, 0.99].map(|s| edge + s));
    }
    places.retain(|x| (0.0..=end).contains(x));
    places
}

/// Value and slope of whole function `index` at `x`.
fn function<const N: usize, B: Basis<N>>(basis: &B, x: f64, cells: i32, index: i32) -> (f64, f64) {
    let axis = basis.axis(x, cells);
    match usize::try_from(index - axis.first) {
        Ok(slot) if slot < N => (axis.weight[slot], axis.slope[slot]),
        _ => (0.0, 0.0),
    }
}

struct Complete;
impl Property for Complete {
    fn check<const N: usize, B: Basis<N>>(&self, basis: B, cells: i32, label: &str) {
        for x in places(cells) {
            let axis = basis.axis(x, cells);
            assert!(
                (0..=basis.count(cells) - N as i32).contains(&axis.first),
                "{label}: first function {} at {x}",
                axis.first
            );
            let [mut one, mut position, mut zero, mut unit] = [0.0; 4];
            for k in 0..N {
                let place = basis.position(axis.first + k as i32, cells);
                one += axis.weight[k];
                position += axis.weight[k] * place;
                assert!(
                    (axis.arm[k] - (place - x)).abs() < 1e-13,
                    "{label}: arm {k} at {x}"
                );
                zero += axis.slope[k];
                unit += axis.slope[k] * place;
                assert!(axis.weight[k] >= 0.0, "{label}: negative weight at {x}");
            }
            let (low, high) = basis.alike(cells);
            if let (Some(inertia), true) = (B::INERTIA, (low..=high).contains(&axis.first)) {
                let sum: f64 = (0..N)
                    .map(|k| axis.weight[k] * axis.arm[k] * axis.arm[k])
                    .sum();
                assert!((sum - inertia).abs() < 1e-15 * 4.0, "{label}: {sum} at {x}");
            }
            assert!((one - 1.0).abs() < 1e-15 * 4.0, "{label}: sum {one} at {x}");
            assert!(
                (position - x).abs() < 1e-14 * 2.0,
                "{label}: {position} at {x}"
            );
            assert!(
                zero.abs() < 1e-14,
                "{label}: slopes add up to {zero} at {x}"
            );
            assert!(
                (unit - 1.0).abs() < 1e-13,
                "{label}: slope of x is {unit} at {x}"
            );
        }
    }
}

#[test]
fn every_basis_reproduces_constant_and_linear_fields_and_their_slopes() {
    every_basis(&Complete);
}

struct Differentiable;
impl Property for Differentiable {
    fn check<const N: usize, B: Basis<N>>(&self, basis: B, cells: i32, label: &str) {
        let step = 1e-5;
        for cell in 0..cells {
            // none of these is a kink of any basis at the spacings above
            for s in [0.02, 0.13, 0.29, 0.41, 0.57, 0.77, 0.93] {
                let x = f64::from(cell) + s;
                for index in 0..basis.count(cells) {
                    let (_, slope) = function(&basis, x, cells, index);
                    let (above, _) = function(&basis, x + step, cells, index);
                    let (below, _) = function(&basis, x - step, cells, index);
                    let difference = (above - below) / (2.0 * step);
                    assert!(
                        (slope - difference).abs() < 1e-9,
                        "{label}: function {index} at {x}: slope {slope}, difference {difference}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_slope_is_the_derivative_of_its_weight() {
    for choice in BasisChoice::all() {
        // slopes of domains are those of a line between two corners, which passes over the kink of a hat
        if !choice.has_domains() {
            choice.visit(Check(&Differentiable, choice.name()));
        }
    }
}

struct Continuous {
    slopes: bool,
}
impl Property for Continuous {
    fn check<const N: usize, B: Basis<N>>(&self, basis: B, cells: i32, label: &str) {
        let step = 1e-9;
        // edges of cells, and of points whose edge is the edge of a cell
        for k in 1..cells * 60 {
            let x = f64::from(k) / 60.0;
            for index in 0..basis.count(cells) {
                let (below, slope_below) = function(&basis, x - step, cells, index);
                let (above, slope_above) = function(&basis, x + step, cells, index);
                assert!(
                    (above - below).abs() < 1e-8,
                    "{label}: {index} jumps at {x}"
                );
                if self.slopes {
                    assert!(
                        (slope_above - slope_below).abs() < 1e-7,
                        "{label}: the slope of function {index} jumps at {x}"
                    );
                }
            }
        }
    }
}

#[test]
fn every_basis_is_continuous() {
    every_basis(&Continuous { slopes: false });
}

#[test]
fn every_basis_but_the_linear_one_has_continuous_slopes() {
    for choice in BasisChoice::all() {
        if choice.name() != "linear" {
            choice.visit(Check(&Continuous { slopes: true }, choice.name()));
        }
    }
}

struct Together;
impl Property for Together {
    fn check<const N: usize, B: Basis<N>>(&self, basis: B, cells: i32, label: &str) {
        let (low, high) = basis.alike(cells);
        let places = places(cells);
        let ends: Vec<f64> = places
            .into_iter()
            .filter(|x| !(low..=high).contains(&basis.axis(*x, cells).first))
            .collect();
        for four in ends.chunks_exact(4) {
            let axes = [0, 1, 2, 3].map(|q| basis.axis(four[q], cells));
            let [mut x, mut first] = [Portable::splat(0.0); 2];
            for q in 0..4 {
                x = x.with_lane(q, four[q]);
                first = first.with_lane(q, f64::from(axes[q].first));
            }
            let together = basis.at_end(x, first, cells);
            for (q, alone) in axes.iter().enumerate() {
                for k in 0..N {
                    let [w, s, a] = [together.weight[k], together.slope[k], together.arm[k]];
                    assert_eq!(
                        [w.lane(q), s.lane(q), a.lane(q)],
                        [alone.weight[k], alone.slope[k], alone.arm[k]],
                        "{label}: function {k} at {}",
                        four[q]
                    );
                }
            }
        }
    }
}

#[test]
fn points_near_the_ends_have_the_same_functions_together_as_alone() {
    every_basis(&Together);
}

struct Mirrored;
impl Property for Mirrored {
    fn check<const N: usize, B: Basis<N>>(&self, basis: B, cells: i32, label: &str) {
        let count = basis.count(cells);
        for x in places(cells) {
            let mirrored = f64::from(cells) - x;
            for index in 0..count {
                let (weight, slope) = function(&basis, x, cells, index);
                let (weight_m, slope_m) = function(&basis, mirrored, cells, count - 1 - index);
                assert!((weight - weight_m).abs() < 1e-14, "{label}: {index} at {x}");
                // a slope that jumps at a cell edge is mirrored on either side of it only
                if (x - x.round()).abs() > 1e-6 {
                    assert!((slope + slope_m).abs() < 1e-13, "{label}: {index} at {x}");
                }
            }
        }
    }
}

#[test]
fn every_basis_is_the_same_seen_from_either_end() {
    every_basis(&Mirrored);
}

#[test]
fn splines_interpolate_at_the_ends_of_the_grid() {
    let axis = QuadraticBSpline.axis(0.0, 1);
    assert_eq!((axis.weight[0], axis.slope[0]), (1.0, -2.0));
    let axis = CubicBSpline.axis(5.0, 5);
    assert_eq!((axis.first, axis.weight[3], axis.slope[3]), (4, 1.0, 3.0));
}

#[test]
fn splines_on_one_cell_are_bernstein_polynomials() {
    let (s, r) = (0.3, 0.7);
    let axis = CubicBSpline.axis(s, 1);
    let expected = [r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s];
    for k in 0..4 {
        assert!((axis.weight[k] - expected[k]).abs() < 1e-15);
    }
}
