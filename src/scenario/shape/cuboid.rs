//! A box with faces across the axes: an interval in 1D, a rectangle in 2D.

use super::{Bounds, Geometry};
use crate::input::{Reader, Unit};
use crate::scenario::check::shown;
use std::f64::consts::PI;

/// All places between two corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Cuboid {
    /// Lower corner, m.
    pub min: Vec<f64>,
    /// Upper corner, m; above `min` on every axis.
    pub max: Vec<f64>,
}

impl Geometry for Cuboid {
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self> {
        let mut reader = parent.table(key)?;
        let min = reader.vector("min", Unit::LENGTH, dimension);
        let max = reader.vector("max", Unit::LENGTH, dimension);
        let (min, max) = (min?, max?);
        for axis in 0..dimension {
            if min[axis] >= max[axis] {
                let key = format!("max[{axis}]");
                let (axis, min, max) = (["x", "y", "z"][axis], shown(min[axis]), shown(max[axis]));
                reader.problem(
                    &key,
                    format!("along {axis} the box ends at {max} m, which is not above its start {min} m: make max larger than min"),
                );
                return None;
            }
        }
        Some(Self { min, max })
    }

    fn contains(&self, at: &[f64]) -> bool {
        (self.min.iter().zip(&self.max).zip(at)).all(|((min, max), x)| min <= x && x <= max)
    }

    fn bounds(&self) -> Bounds {
        Bounds { min: self.min.clone(), max: self.max.clone() }
    }

    fn measure(&self) -> Option<f64> {
        Some(self.min.iter().zip(&self.max).map(|(min, max)| max - min).product())
    }

    /// π (r_max² − r_min²) height.
    fn revolved(&self) -> Option<f64> {
        let (&[inner, low], &[outer, high]) = (&self.min[..], &self.max[..]) else { return None };
        let (inner, outer) = (inner.max(0.0), outer.max(0.0));
        Some(PI * (outer - inner) * (outer + inner) * (high - low))
    }
}
