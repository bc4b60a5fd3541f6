//! The faces of points that a traction or a pressure acts on.
//!
//! A point stands for a cell of the lattice that its body is filled with, and the faces between a cell of the body and one that is
//! not are the body's surface. Of a curved one this is a staircase. Its area is too large, but by the divergence theorem the
//! vector sum of the faces of any part is that of a smooth surface with the same rim: a pressure on them has the same resultant and the same moment.

use super::{Filling, PointSet, body_filling};
use crate::boundary::Side;
use crate::scenario::shape::Shape;
use crate::scenario::{LoadKind, LoadPlace, LoadSpec, Scenario};
use rayon::prelude::*;

/// Loaded faces that look towards the same side. Their centres lie [`PointSet::to_face`] from their points.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    /// Where they look.
    pub side: Side,
    /// The numbers of their points, ascending.
    pub points: Vec<usize>,
    /// The area of each, m²; of a section of 1 m² in 1D and a thickness of 1 m in 2D, of the full ring in an axisymmetric scene.
    pub areas: Vec<f64>,
}

impl Faces {
    /// The component along the axis of the side of the unit vector into the body.
    pub fn inwards(&self) -> f64 {
        if self.side.upper { -1.0 } else { 1.0 }
    }

    /// The area of all of them, m².
    pub fn area(&self) -> f64 {
        self.areas.iter().sum()
    }
}

/// The faces that a load acts on, by side in the order of [`Side::NAMES`]; none if it needs no area.
pub fn loaded_faces(scenario: &Scenario, load: &LoadSpec, points: &PointSet) -> Vec<Faces> {
    let side = match (&load.kind, &load.on) {
        (LoadKind::Pressure { .. }, LoadPlace::Shape(shape)) => {
            return body_filling(scenario, load.body).faces(shape, points);
        }
        (LoadKind::Pressure { side, .. }, _) => *side,
        (LoadKind::Traction { side, .. }, _) => Some(*side),
        _ => None,
    };
    let on_side = |side| {
        let chosen = points.selected(&load.on);
        Faces {
            side,
            areas: chosen.iter().map(|p| points.side_area(*p, side)).collect(),
            points: chosen,
        }
    };
    side.map(on_side).into_iter().collect()
}

impl Filling<'_> {
    /// Whether a free face of at least one point looks into a shape.
    pub fn looks_into(&self, shape: &Shape) -> bool {
        (self.first[0]..self.first[0] + self.count[0])
            .into_par_iter()
            .any(|x| {
                let mut found = false;
                self.slice(x, self.first, self.count, |cell, at| {
                    found = found || self.sides_into(shape, cell, at).next().is_some();
                });
                found
            })
    }

    /// The free faces of all points that look into a shape.
    fn faces(&self, shape: &Shape, points: &PointSet) -> Vec<Faces> {
        let mut faces: Vec<Faces> = sides(self.dimension)
            .map(|side| Faces {
                side,
                points: Vec::new(),
                areas: Vec::new(),
            })
            .collect();
        // Where volumes are scaled, so are areas: a body under the same pressure from all sides then carries that pressure.
        let scale = points.cell / self.cell();
        let mut number = 0;
        for x in self.first[0]..self.first[0] + self.count[0] {
            self.slice(x, self.first, self.count, |cell, at| {
                for side in self.sides_into(shape, cell, at) {
                    let same = &mut faces[2 * side.axis + usize::from(side.upper)];
                    same.points.push(number);
                    same.areas.push(scale * points.side_area(number, side));
                }
                number += 1;
            });
        }
        faces.retain(|same| !same.points.is_empty());
        faces
    }

    /// The sides on which the next cell is none of the body's and has its centre in a shape. The axis of an axisymmetric scene is no
    /// side.
    fn sides_into<'a>(
        &'a self,
        shape: &'a Shape,
        cell: [u64; 3],
        at: [f64; 3],
    ) -> impl Iterator<Item = Side> + 'a {
        sides(self.dimension).filter(move |side| {
            let axis = side.axis;
            let step = if side.upper { 1.0 } else { -1.0 };
            let next = cell[axis] as f64 + step;
            let mut beyond = at;
            // as the centre of a cell is computed: a hole and a load in it agree on what is inside
            beyond[axis] = self.origin[axis] + (next + 0.5) * self.spacing[axis];
            let beyond = &beyond[..self.dimension];
            let (first, count) = (self.first[axis] as f64, self.count[axis] as f64);
            let filled = (first..first + count).contains(&next)
                && (matches!(self.shape, Shape::Cuboid(_)) || self.shape.contains(beyond));
            let is_axis = self.rings && axis == 0 && beyond[0] < 0.0;
            shape.contains(beyond) && !filled && !is_axis
        })
    }
}

/// All sides, in the order of [`Side::NAMES`].
fn sides(dimension: usize) -> impl Iterator<Item = Side> {
    (0..dimension).flat_map(|axis| [false, true].map(|upper| Side { axis, upper }))
}

#[cfg(test)]
mod tests;
