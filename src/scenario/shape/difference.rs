//! A shape with holes.

use super::{Bounds, Geometry, Shape, lie_apart};
use crate::input::Reader;

/// All places of one shape that are in none of several others.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// What is cut.
    pub of: Box<Shape>,
    /// What is cut away.
    pub minus: Vec<Shape>,
}

impl Geometry for Difference {
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self> {
        let mut reader = parent.table(key)?;
        let of = reader.table("of").and_then(|mut table| Shape::read(&mut table, dimension));
        let given = reader.has("minus");
        if !given {
            reader.problem_here("a difference needs minus = [shapes that are cut away]");
        }
        let mut tables = reader.tables("minus");
        let count = tables.len();
        let minus: Vec<Shape> =
            tables.iter_mut().filter_map(|table| Shape::read(table, dimension)).collect();
        (given && minus.len() == count).then_some(Self { of: Box::new(of?), minus })
    }

    fn contains(&self, at: &[f64]) -> bool {
        self.of.contains(at) && !self.minus.iter().any(|shape| shape.contains(at))
    }

    fn bounds(&self) -> Bounds {
        self.of.bounds()
    }

    /// What is left, where separate holes are cut out of a box and do not stick out.
    fn measure(&self) -> Option<f64> {
        let cut: Option<f64> = self.minus.iter().map(Shape::measure).sum();
        if self.has_plain_holes() { Some(self.of.measure()? - cut?) } else { None }
    }

    fn revolved(&self) -> Option<f64> {
        let cut: Option<f64> = self.minus.iter().map(Shape::revolved).sum();
        if self.has_plain_holes() { Some(self.of.revolved()? - cut?) } else { None }
    }
}

impl Difference {
    fn has_plain_holes(&self) -> bool {
        let outer = self.of.bounds();
        let inside = |hole: &Shape| {
            let hole = hole.bounds();
            let axes = 0..outer.min.len();
            axes.into_iter().all(|k| outer.min[k] <= hole.min[k] && hole.max[k] <= outer.max[k])
        };
        matches!(*self.of, Shape::Cuboid(_)) && self.minus.iter().all(inside) && lie_apart(&self.minus)
    }
}
