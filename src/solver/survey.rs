//! How stiff points are, for the time step.

use super::frame;
use crate::math::Matrix;
use crate::real::Instructions;
use crate::state::Body;
use crate::totals::present;
use std::ops::Range;

/// Points that are looked at together.
const GROUPS: usize = 64;

/// An upper estimate of the largest ρ₀ c² of some of a body's points, Pa, at least zero and in the configuration that the grid lives
/// in; NaN if that of a point is.
pub(super) fn max_stiffness<const D: usize>(
    body: &Body<D>,
    range: Range<usize>,
    instructions: Instructions,
) -> f64 {
    let p = &body.particles;
    let mut numbers = [0.0; GROUPS];
    let mut largest = 0.0_f64;
    for first in range.clone().step_by(GROUPS) {
        let rows = first..(first + GROUPS).min(range.end);
        let found = &mut numbers[..rows.len()];
        let present = present(p, rows.clone());
        body.material
            .stiffness(rows.clone(), &present, instructions, found);
        if p.is_total() {
            let mut gradients = [Matrix::identity(); GROUPS];
            for (gradient, row) in gradients.iter_mut().zip(rows) {
                *gradient = body.deformation_gradient(row);
            }
            frame::seen_from_reference(&gradients[..found.len()], found);
        }
        for stiffness in found {
            if stiffness.is_nan() {
                return f64::NAN;
            }
            largest = largest.max(*stiffness);
        }
    }
    largest
}
