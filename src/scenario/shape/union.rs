//! Several shapes together.

use super::{Bounds, Geometry, Shape, lie_apart};
use crate::input::Reader;

/// All places that are inside at least one of several shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Union {
    /// At least one shape.
    pub shapes: Vec<Shape>,
}

impl Geometry for Union {
    fn read(parent: &mut Reader<'_>, key: &'static str, dimension: usize) -> Option<Self> {
        if parent.list_length(key) == Some(0) {
            parent.problem(key, "a union needs at least one shape");
        }
        let mut tables = parent.tables(key);
        let count = tables.len();
        let shapes: Vec<Shape> =
            tables.iter_mut().filter_map(|table| Shape::read(table, dimension)).collect();
        (count > 0 && shapes.len() == count).then_some(Self { shapes })
    }

    fn contains(&self, at: &[f64]) -> bool {
        self.shapes.iter().any(|shape| shape.contains(at))
    }

    fn bounds(&self) -> Bounds {
        let mut all = self.shapes.iter().map(Shape::bounds);
        let first = all.next().unwrap_or(Bounds { min: Vec::new(), max: Vec::new() });
        all.fold(first, |a, b| Bounds {
            min: a.min.iter().zip(&b.min).map(|(a, b)| a.min(*b)).collect(),
            max: a.max.iter().zip(&b.max).map(|(a, b)| a.max(*b)).collect(),
        })
    }

    /// The sum, where the shapes lie apart.
    fn measure(&self) -> Option<f64> {
        lie_apart(&self.shapes).then(|| self.shapes.iter().map(Shape::measure).sum())?
    }

    fn revolved(&self) -> Option<f64> {
        lie_apart(&self.shapes).then(|| self.shapes.iter().map(Shape::revolved).sum())?
    }
}
