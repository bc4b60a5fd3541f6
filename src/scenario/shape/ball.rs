//! A ball: a disk in 2D, an interval in 1D.

use super::{Bounds, Geometry};
use crate::input::{Bound, Reader, Unit};
use std::f64::consts::PI;

/// All places within a radius of a centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    /// Centre, m.
    pub center: Vec<f64>,
    /// Radius, m; positive.
    pub radius: f64,
}

impl Geometry for Ball {
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self> {
        let mut reader = parent.table(key)?;
        let center = reader.vector("center", Unit::LENGTH, dimension);
        let radius = reader.required("radius", Unit::LENGTH, Bound::Positive);
        Some(Self { center: center?, radius: radius? })
    }

    fn contains(&self, at: &[f64]) -> bool {
        let square: f64 = self.center.iter().zip(at).map(|(c, x)| (x - c) * (x - c)).sum();
        square <= self.radius * self.radius
    }

    fn bounds(&self) -> Bounds {
        Bounds {
            min: self.center.iter().map(|c| c - self.radius).collect(),
            max: self.center.iter().map(|c| c + self.radius).collect(),
        }
    }

    fn measure(&self) -> Option<f64> {
        let r = self.radius;
        match self.center.len() {
            1 => Some(2.0 * r),
            2 => Some(PI * r * r),
            _ => Some(4.0 / 3.0 * PI * r * r * r),
        }
    }

    /// A sphere if the centre is on the axis, a torus if the disk does not touch it.
    fn revolved(&self) -> Option<f64> {
        let &[x, _] = &self.center[..] else { return None };
        let r = self.radius;
        if x == 0.0 {
            Some(4.0 / 3.0 * PI * r * r * r)
        } else if x >= r {
            Some(2.0 * PI * x * PI * r * r)
        } else {
            None
        }
    }
}
