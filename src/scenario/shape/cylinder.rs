//! A solid round cylinder with any axis, in 3D only.

use super::{Bounds, Geometry};
use crate::input::{Bound, Reader, Unit};
use std::f64::consts::PI;

/// All places within a radius of the line between two points, cut off square at both.
#[derive(Clone, Debug, PartialEq)]
pub struct Cylinder {
    /// Centre of one end, m.
    pub from: Vec<f64>,
    /// Centre of the other end, m.
    pub to: Vec<f64>,
    /// Radius, m; positive.
    pub radius: f64,
}

impl Cylinder {
    /// The vector from one end to the other, and its squared length.
    fn axis(&self) -> ([f64; 3], f64) {
        let axis = std::array::from_fn(|i| self.to[i] - self.from[i]);
        (axis, axis.iter().map(|a| a * a).sum())
    }
}

impl Geometry for Cylinder {
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self> {
        let mut reader = parent.table(key)?;
        if dimension != 3 {
            let other = if dimension == 2 { "a ball or a box" } else { "a box" };
            reader.problem_here(format!("a cylinder needs dimension = 3, found {dimension}: use {other}"));
            return None;
        }
        let from = reader.vector("from", Unit::LENGTH, 3);
        let to = reader.vector("to", Unit::LENGTH, 3);
        let radius = reader.required("radius", Unit::LENGTH, Bound::Positive);
        let cylinder = Self { from: from?, to: to?, radius: radius? };
        if cylinder.axis().1 <= 0.0 {
            reader.problem("to", "both ends are the same point: move one of them");
            return None;
        }
        Some(cylinder)
    }

    fn contains(&self, at: &[f64]) -> bool {
        let (axis, square) = self.axis();
        let arm: [f64; 3] = std::array::from_fn(|i| at[i] - self.from[i]);
        let along: f64 = (0..3).map(|i| arm[i] * axis[i]).sum::<f64>() / square;
        let across: f64 = (0..3).map(|i| (arm[i] - along * axis[i]).powi(2)).sum();
        (0.0..=1.0).contains(&along) && across <= self.radius * self.radius
    }

    /// An end disk of normal n reaches radius · √(1 − n_i²) from its centre along axis i.
    fn bounds(&self) -> Bounds {
        let (axis, square) = self.axis();
        let reach = |i: usize| self.radius * (1.0 - axis[i] * axis[i] / square).max(0.0).sqrt();
        Bounds {
            min: (0..3).map(|i| self.from[i].min(self.to[i]) - reach(i)).collect(),
            max: (0..3).map(|i| self.from[i].max(self.to[i]) + reach(i)).collect(),
        }
    }

    fn measure(&self) -> Option<f64> {
        Some(PI * self.radius * self.radius * self.axis().1.sqrt())
    }
}
