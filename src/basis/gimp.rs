//! Hat functions averaged over the width of a material point (uniform GIMP).
//!
//! The width is that of the undeformed point; it does not follow the deformation.

use super::{Basis, Functions};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// The mean of the hat function over a point that reaches from x − l to x + l: the contiguous-particle form of the
/// generalised interpolation material point method (Bardenhagen and Kober 2004), derived here.
///
/// One ghost node stands a cell outside each end of the grid, for points that stick out: function `i` stands at i − 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gimp {
    /// l, half the width of a point, in cells; at most 1/2.
    half_width: f64,
}

impl Default for Gimp {
    /// Two points a cell.
    fn default() -> Self {
        Self { half_width: 0.25 }
    }
}

impl Parameters for Gimp {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self::default())
    }
}

impl Basis<3> for Gimp {
    const BENDS: bool = false;

    /// Let the lower end of the point lie in cell m, `1 − s` below node m + 1. Of the width 2l, q = min(1 − s, 2l) lies in
    /// cell m and r = 2l − q in cell m + 1; e = max(0, 1 − s − 2l) is what the upper end lacks to reach node m + 1.
    /// The hat of node m falls over q to e: its mean is q (e + q/2) / (2l) = e + q²/(4l), since q = 2l wherever e > 0. The hat
    /// of node m + 2 rises from zero over r: its mean is r²/(4l). The hat of node m + 1 is what these two leave of one.
    ///
    /// With s = 0 where the lower end of the point passes a node, `first = floor(x + 1 − l)`.
    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 3> {
        let l = R::splat(self.half_width);
        let width = R::splat(2.0 * self.half_width);
        let half = R::splat(0.5 / self.half_width);
        let (zero, one, two) = (R::splat(0.0), R::splat(1.0), R::splat(2.0));
        let left = one - s;
        let e = (left - width).max(zero);
        let q = left.min(width);
        let r = width - q;
        let first = R::splat(0.5) * half * q * q + e;
        let last = R::splat(0.5) * half * r * r;
        let rise = half * r;
        Functions {
            weight: [first, one - first - last, last],
            slope: [rise - one, one - two * rise, rise],
            arm: [left - l - one, left - l, left - l + one],
        }
    }

    /// Points `spacing` cells apart touch each other; above one cell they no longer do, because a wider point would reach
    /// more than three nodes.
    fn for_spacing(&self, spacing: f64) -> Self {
        Self {
            half_width: 0.5 * spacing.clamp(1e-6, 1.0),
        }
    }

    fn shift(&self) -> f64 {
        1.0 - self.half_width
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 3
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral of the hat function from −∞ to x.
    fn integrated_hat(x: f64) -> f64 {
        let x = x.clamp(-1.0, 1.0);
        0.5 + x - 0.5 * x * x.abs()
    }

    #[test]
    fn a_weight_is_the_mean_of_the_hat_function_over_the_point() {
        for spacing in [1.0, 0.5, 1.0 / 3.0, 0.1] {
            let basis = Gimp::default().for_spacing(spacing);
            let l = 0.5 * spacing;
            for k in 0..=400 {
                let x = f64::from(k) / 100.0;
                let axis = basis.axis(x, 4);
                for i in 0..basis.count(4) {
                    let arm = x - basis.position(i, 4);
                    let mean = (integrated_hat(arm + l) - integrated_hat(arm - l)) / (2.0 * l);
                    let slot = i - axis.first;
                    let weight = match slot {
                        0..=2 => axis.weight[slot as usize],
                        _ => 0.0,
                    };
                    assert!((weight - mean).abs() < 1e-14, "{spacing} {x} {i}");
                }
            }
        }
    }
}
