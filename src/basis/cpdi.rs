//! Hat functions as they are at the corners of a point's domain, which is carried along with the motion: convected particle
//! domain interpolation.
//!
//! What stands here is a point that is not deformed yet, or that stays undeformed because the frame is total: its domain is a box
//! along the axes, and its functions are products of functions of one coordinate. The domain of a point that has moved is a
//! parallelepiped in any position; the solver has loops of their own for it.

use super::{Basis, Functions};
use crate::input::{Parameters, Reader};
use crate::real::Real;

/// The mean of the hat functions at the two ends x − l and x + l of a point, and the difference of the two over 2l: what a line
/// between both ends has as its mean and slope.
///
/// Two ghost nodes stand outside each end of the grid, for points that stick out: function `i` stands at i − 2.
///
/// Source: R. Brannon, "Particle basis function in the CPDI method", csmbrannon.net, 2013: the basis is that of finite elements at
/// the corners of a point's domain and linear in between. Formulas derived here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cpdi {
    /// l, half the width of an undeformed point, in cells; at most 1/2.
    half_width: f64,
}

impl Cpdi {
    /// How far from its point a corner may be along any axis, in cells. A domain that has grown beyond it is cut to it.
    pub const REACH: i32 = 2;

    /// l, half the width of an undeformed point, in cells.
    pub fn half_width(&self) -> f64 {
        self.half_width
    }
}

impl Default for Cpdi {
    /// Two points a cell.
    fn default() -> Self {
        Self { half_width: 0.25 }
    }
}

impl Parameters for Cpdi {
    fn read(_: &mut Reader<'_>) -> Option<Self> {
        Some(Self::default())
    }
}

impl Basis<3> for Cpdi {
    const BENDS: bool = false;

    /// Let the lower end lie in cell m, `s` above node m; the upper end is u = s + 2l above it. The hats of m, m + 1 and m + 2
    /// are 1 − s, s, 0 at the lower end; at the upper one they are max(0, 1 − u), what the other two leave of one, max(0, u − 1).
    #[inline(always)]
    fn functions<R: Real>(&self, s: R) -> Functions<R, 3> {
        let l = R::splat(self.half_width);
        let slope = R::splat(0.5 / self.half_width);
        let (zero, half, one) = (R::splat(0.0), R::splat(0.5), R::splat(1.0));
        let u = s + R::splat(2.0 * self.half_width);
        let lower = [one - s, s, zero];
        let (first, last) = ((one - u).max(zero), (u - one).max(zero));
        let upper = [first, one - first - last, last];
        let mut functions = Functions {
            weight: lower,
            slope: upper,
            arm: [-s - l, one - s - l, R::splat(2.0) - s - l],
        };
        for k in 0..3 {
            functions.weight[k] = half * (lower[k] + upper[k]);
            functions.slope[k] = slope * (upper[k] - lower[k]);
        }
        functions
    }

    /// Points `spacing` cells apart touch each other; above one cell they no longer do, as those of `gimp`.
    fn for_spacing(&self, spacing: f64) -> Self {
        Self {
            half_width: 0.5 * spacing.clamp(1e-6, 1.0),
        }
    }

    fn shift(&self) -> f64 {
        f64::from(Self::REACH) - self.half_width
    }

    fn count(&self, cells: i32) -> i32 {
        cells + 1 + 2 * Self::REACH
    }

    fn position(&self, index: i32, _cells: i32) -> f64 {
        f64::from(index - Self::REACH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_and_slopes_are_those_of_hats_at_both_ends_of_the_point() {
        let hat = |x: f64| (1.0 - x.abs()).max(0.0);
        for spacing in [1.0, 0.5, 1.0 / 3.0, 0.1] {
            let basis = Cpdi::default().for_spacing(spacing);
            for k in 0..=400 {
                let x = f64::from(k) / 100.0;
                let axis = basis.axis(x, 4);
                for i in 0..basis.count(4) {
                    let node = basis.position(i, 4);
                    let ends = [-0.5, 0.5].map(|side| hat(x + side * spacing - node));
                    let (weight, slope) = match i - axis.first {
                        slot @ 0..=2 => (axis.weight[slot as usize], axis.slope[slot as usize]),
                        _ => (0.0, 0.0),
                    };
                    let place = format!("{spacing} {x} {i}");
                    assert!((weight - 0.5 * (ends[0] + ends[1])).abs() < 1e-14, "{place}");
                    assert!((slope * spacing - (ends[1] - ends[0])).abs() < 1e-14, "{place}");
                }
            }
        }
    }
}
