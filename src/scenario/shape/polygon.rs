//! A polygon, in 2D only.

use super::{Bounds, Geometry};
use crate::input::{Reader, Unit};
use std::f64::consts::PI;

/// All places inside a closed line; where the line crosses itself, those that it winds around an odd number of times.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Corners in order, m; at least 3. The last is joined to the first.
    pub points: Vec<[f64; 2]>,
}

impl Polygon {
    /// The sides: from one corner to the next.
    fn sides(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
        let next = self.points.iter().cycle().skip(1);
        self.points.iter().copied().zip(next.copied())
    }

    /// Signed area, positive if the corners run counterclockwise.
    fn area(&self) -> f64 {
        self.sides().map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum()
    }

    /// Whether two sides cross; a polygon with too many sides to look at counts as if.
    fn crosses_itself(&self) -> bool {
        let sides: Vec<_> = self.sides().collect();
        let count = sides.len();
        if count > 4096 {
            return true;
        }
        let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        (0..count).any(|i| {
            (i + 2..count).filter(|j| (j + 1) % count != i).any(|j| {
                let ((a, b), (c, d)) = (sides[i], sides[j]);
                turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
            })
        })
    }
}

impl Geometry for Polygon {
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self> {
        let mut reader = parent.table(key)?;
        if dimension != 2 {
            reader.problem_here(format!("a polygon needs dimension = 2, found {dimension}: use a box"));
            return None;
        }
        let points = reader.vectors("points", Unit::LENGTH, 2)?;
        if points.len() < 3 {
            let found = points.len();
            reader.problem("points", format!("a polygon needs at least 3 corners, found {found}"));
            return None;
        }
        let polygon = Self { points: points.iter().map(|p| [p[0], p[1]]).collect() };
        if polygon.area() == 0.0 {
            reader.problem("points", "the polygon has no area: its corners must not lie on one line");
            return None;
        }
        Some(polygon)
    }

    /// Counts the sides that a ray to the right crosses.
    fn contains(&self, at: &[f64]) -> bool {
        let crossings = self.sides().filter(|(a, b)| {
            (a[1] > at[1]) != (b[1] > at[1])
                && at[0] < a[0] + (b[0] - a[0]) * (at[1] - a[1]) / (b[1] - a[1])
        });
        crossings.count() % 2 == 1
    }

    fn bounds(&self) -> Bounds {
        let extreme = |axis: usize, pick: fn(f64, f64) -> f64| {
            self.points.iter().map(|p| p[axis]).reduce(pick).unwrap_or(0.0)
        };
        Bounds {
            min: vec![extreme(0, f64::min), extreme(1, f64::min)],
            max: vec![extreme(0, f64::max), extreme(1, f64::max)],
        }
    }

    fn measure(&self) -> Option<f64> {
        (!self.crosses_itself()).then(|| self.area().abs())
    }

    /// 2π ∫ x dA = 2π Σ (a_x + b_x) (a_x b_y − b_x a_y) / 6 over the sides from a to b.
    fn revolved(&self) -> Option<f64> {
        let moment: f64 = self
            .sides()
            .map(|(a, b)| (a[0] + b[0]) * (a[0] * b[1] - b[0] * a[1]) / 6.0)
            .sum();
        let right = self.points.iter().all(|p| p[0] >= 0.0);
        (right && !self.crosses_itself()).then(|| 2.0 * PI * moment.abs())
    }
}
