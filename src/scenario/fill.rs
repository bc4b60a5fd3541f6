//! Fills shapes with material points. Knows geometry and the size of a cell; knows no mass and no motion.
//!
//! A box gets points of its own spacing that tile it exactly. Any other shape gets those points of a lattice aligned with
//! the grid's cells that are inside it, and their volumes are scaled so that they add up to the exact one where it is known.

mod faces;

pub use faces::{Faces, loaded_faces};

use super::shape::Shape;
use super::{BodySpec, GridSpec, LoadPlace, Region, Scenario};
use crate::boundary::Side;
use crate::material::Plane;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The material points of a body before the first step.
#[derive(Clone, Debug, PartialEq)]
pub struct PointSet {
    /// Positions, m; axes that the scene does not have are zero.
    pub positions: Vec<[f64; 3]>,
    /// Distance between neighbours on each axis, m, their mean if they are drawn together; 1 m on axes that the scene does not have.
    pub spacing: [f64; 3],
    /// Distance of the outermost points from the faces of a box on each axis, m; half a spacing of points in even distances.
    pub to_face: [f64; 3],
    /// What each point stands for: a volume, m³, or an area, m², of the half plane of an axisymmetric scene.
    cell: f64,
    /// Whether points are rings around x = 0.
    rings: bool,
}

impl PointSet {
    /// Initial volume of a point, m³. In 1D a cross-section of 1 m² is meant, in 2D a thickness of 1 m, and in an axisymmetric
    /// scene the full ring 2π r · area.
    pub fn volume(&self, index: usize) -> f64 {
        if self.rings {
            2.0 * PI * self.positions[index][0] * self.cell
        } else {
            self.cell
        }
    }

    /// Area, m², of the face that a point shows to a side of the body.
    pub fn side_area(&self, index: usize, side: Side) -> f64 {
        let face: f64 = (0..3)
            .filter(|axis| *axis != side.axis)
            .map(|axis| self.spacing[axis])
            .product();
        if !self.rings {
            return face;
        }
        let outwards = if side.upper { 1.0 } else { -1.0 };
        let half = outwards * self.to_face[0];
        let radius = self.positions[index][0] + if side.axis == 0 { half } else { 0.0 };
        2.0 * PI * radius.max(0.0) * face
    }

    /// The numbers of the points in a place: the outermost layer on a side, or all points inside a box or a shape.
    pub fn selected(&self, on: &LoadPlace) -> Vec<usize> {
        let all = || self.positions.iter().enumerate();
        match on {
            LoadPlace::Region(Region::Side(side)) => {
                let outwards = |at: &[f64; 3]| {
                    if side.upper {
                        at[side.axis]
                    } else {
                        -at[side.axis]
                    }
                };
                let outermost = all()
                    .map(|(_, at)| outwards(at))
                    .fold(f64::NEG_INFINITY, f64::max);
                let inner = outermost - 0.5 * self.spacing[side.axis];
                all()
                    .filter(|(_, at)| outwards(at) > inner)
                    .map(|(index, _)| index)
                    .collect()
            }
            LoadPlace::Region(Region::Box { min, max }) => {
                let inside = |at: &[f64; 3]| {
                    let bounds = min.iter().zip(max);
                    bounds.zip(at).all(|((min, max), x)| min <= x && x <= max)
                };
                all()
                    .filter(|(_, at)| inside(at))
                    .map(|(index, _)| index)
                    .collect()
            }
            LoadPlace::Shape(shape) => {
                let dimension = shape.bounds().min.len();
                all()
                    .filter(|(_, at)| shape.contains(&at[..dimension]))
                    .map(|(index, _)| index)
                    .collect()
            }
        }
    }

    /// The number of the point closest to a place, the lowest among equals; `None` if there is no point.
    pub fn nearest(&self, place: &[f64]) -> Option<usize> {
        let square =
            |at: &[f64; 3]| -> f64 { place.iter().zip(at).map(|(a, b)| (a - b) * (a - b)).sum() };
        let distances = self.positions.iter().map(square).enumerate();
        distances
            .reduce(|best, next| if next.1 < best.1 { next } else { best })
            .map(|(index, _)| index)
    }
}

/// The points of one body of a scene.
pub fn body_points(scenario: &Scenario, body: usize) -> PointSet {
    body_filling(scenario, body).points()
}

/// How many points one body of a scene has.
pub fn body_point_count(scenario: &Scenario, body: usize) -> u64 {
    body_filling(scenario, body).count()
}

fn body_filling(scenario: &Scenario, body: usize) -> Filling<'_> {
    Filling::of(&scenario.bodies[body], &scenario.grid, scenario.plane)
}

/// A shape and the lattice that fills it: what can be said before any memory is taken.
#[derive(Clone, Debug)]
pub struct Filling<'a> {
    shape: &'a Shape,
    dimension: usize,
    rings: bool,
    /// Where lattice cell 0 begins.
    origin: [f64; 3],
    spacing: [f64; 3],
    /// Lattice cells that may hold points: `first .. first + count` on each axis.
    first: [u64; 3],
    count: [u64; 3],
    /// Points of a cell of the grid along each axis, and what their distances from its middle are multiplied with.
    per_cell: [u64; 3],
    drawn: [f64; 3],
}

impl<'a> Filling<'a> {
    /// The points of a body.
    pub fn of(body: &'a BodySpec, grid: &GridSpec, plane: Plane) -> Self {
        let filling = Self::new(&body.shape, grid, &body.particles_per_cell, plane);
        match body.moment {
            Some(moment) if filling.fills_cells(grid) => filling.with_moment(moment),
            _ => filling,
        }
    }

    /// Lays the lattice for a shape.
    pub fn new(shape: &'a Shape, grid: &GridSpec, per_cell: &[u32], plane: Plane) -> Self {
        let dimension = grid.min.len();
        let mut filling = Self {
            shape,
            dimension,
            rings: plane == Plane::Axisymmetric,
            origin: [0.0; 3],
            spacing: [1.0; 3],
            first: [0; 3],
            count: [1; 3],
            per_cell: [1; 3],
            drawn: [1.0; 3],
        };
        for (axis, count) in per_cell.iter().enumerate() {
            filling.per_cell[axis] = u64::from(*count);
        }
        let bounds = shape.bounds();
        for axis in 0..dimension {
            let (min, max, per_cell) = (
                bounds.min[axis],
                bounds.max[axis],
                f64::from(per_cell[axis]),
            );
            if let Shape::Cuboid(_) = shape {
                let count = ((max - min) * per_cell / grid.cell_size).round().max(1.0);
                filling.origin[axis] = min;
                filling.spacing[axis] = (max - min) / count;
                filling.count[axis] = count as u64;
            } else {
                let spacing = grid.cell_size / per_cell;
                let number = |x: f64| ((x - grid.min[axis]) / spacing).floor();
                let last = f64::from(grid.cells[axis]) * per_cell - 1.0;
                let (first, end) = (number(min).clamp(0.0, last), number(max).clamp(0.0, last));
                filling.origin[axis] = grid.min[axis];
                filling.spacing[axis] = spacing;
                filling.first[axis] = first as u64;
                filling.count[axis] = (end - first) as u64 + 1;
            }
        }
        filling
    }

    /// How many lattice points have to be looked at.
    pub fn candidates(&self) -> f64 {
        self.count.iter().map(|count| *count as f64).product()
    }

    /// About how many points there will be, without looking at any.
    pub fn estimate(&self) -> f64 {
        match self.shape {
            Shape::Cuboid(_) => self.candidates(),
            shape => shape
                .measure()
                .map_or(self.candidates(), |size| size / self.cell())
                .min(self.candidates()),
        }
    }

    /// How many points there will be.
    pub fn count(&self) -> u64 {
        self.inside_count(self.first, self.count)
    }

    /// Whether at least one point is inside a closed box.
    pub fn reaches(&self, min: &[f64], max: &[f64]) -> bool {
        let (mut first, mut count) = (self.first, self.count);
        for axis in 0..self.dimension {
            let inside = |k: &u64| (min[axis]..=max[axis]).contains(&self.coordinate(axis, *k));
            let range = self.first[axis]..self.first[axis] + self.count[axis];
            let Some(start) = range.clone().find(inside) else {
                return false;
            };
            first[axis] = start;
            count[axis] = (start..range.end).take_while(inside).count() as u64;
        }
        self.inside_count(first, count) > 0
    }

    /// The first point, in order, for which `wanted` holds.
    pub fn find(&self, wanted: impl Fn(&[f64; 3]) -> bool + Sync) -> Option<[f64; 3]> {
        (self.first[0]..self.first[0] + self.count[0])
            .into_par_iter()
            .find_map_first(|x| {
                let mut found = None;
                self.slice(x, self.first, self.count, |_, at| {
                    if found.is_none() && wanted(&at) {
                        found = Some(at);
                    }
                });
                found
            })
    }

    /// The points, in lexicographic order of x, y, z.
    pub fn points(&self) -> PointSet {
        let total = self.count() as usize;
        let mut positions = Vec::with_capacity(total);
        for x in self.first[0]..self.first[0] + self.count[0] {
            self.slice(x, self.first, self.count, |_, at| positions.push(at));
        }
        let mut points = PointSet {
            positions,
            spacing: self.spacing,
            to_face: std::array::from_fn(|axis| self.to_face(axis)),
            cell: self.cell(),
            rings: self.rings,
        };
        let exact = if self.rings {
            self.shape.revolved()
        } else {
            self.shape.measure()
        };
        if let Some(exact) = exact {
            let sum = if self.rings {
                let volumes = (0..total).map(|index| points.volume(index));
                volumes.collect::<crate::math::Sum>().value()
            } else {
                points.cell * total as f64
            };
            if sum > 0.0 {
                points.cell *= exact / sum;
            }
        }
        points
    }

    /// Whether nodes of the grid lie on corners of lattice cells: then what a point stands for lies in one cell of the grid.
    pub fn divides_cells(&self, grid: &GridSpec) -> bool {
        (0..self.dimension).all(|axis| {
            let spacing = self.spacing[axis];
            whole(grid.cell_size / spacing) && whole((self.origin[axis] - grid.min[axis]) / spacing)
        })
    }

    /// Whether this is a box of whole cells of the grid with two points along each axis of a cell or more.
    pub fn fills_cells(&self, grid: &GridSpec) -> bool {
        matches!(self.shape, Shape::Cuboid(_))
            && self.divides_cells(grid)
            && (0..self.dimension).all(|axis| {
                let per_cell = self.per_cell[axis];
                let width = self.spacing[axis] * per_cell as f64;
                per_cell > 1
                    && self.count[axis].is_multiple_of(per_cell)
                    && (width / grid.cell_size - 1.0).abs() < 1e-9
                    && whole((self.origin[axis] - grid.min[axis]) / grid.cell_size)
            })
    }

    /// The same with this second moment of the points of a cell about its middle, in parts of that of the cell: p points in even distances
    /// have 1 − 1/p².
    fn with_moment(mut self, moment: f64) -> Self {
        for axis in 0..self.dimension {
            let even = 1.0 - (self.per_cell[axis] as f64).powi(-2);
            self.drawn[axis] = (moment / even).sqrt();
        }
        self
    }

    /// Length, area or volume of a lattice cell.
    fn cell(&self) -> f64 {
        self.spacing.iter().product()
    }

    fn coordinate(&self, axis: usize, index: u64) -> f64 {
        if self.drawn[axis] == 1.0 {
            return self.origin[axis] + (index as f64 + 0.5) * self.spacing[axis];
        }
        let half = 0.5 * self.per_cell[axis] as f64;
        let middle = (index - index % self.per_cell[axis]) as f64 + half;
        let from_middle = index as f64 + 0.5 - middle;
        self.origin[axis] + (middle + self.drawn[axis] * from_middle) * self.spacing[axis]
    }

    /// How far the outermost points lie from the faces of a box, m.
    fn to_face(&self, axis: usize) -> f64 {
        let half = 0.5 * self.per_cell[axis] as f64;
        (half - self.drawn[axis] * (half - 0.5)) * self.spacing[axis]
    }

    fn inside_count(&self, first: [u64; 3], count: [u64; 3]) -> u64 {
        if let Shape::Cuboid(_) = self.shape {
            return count.iter().product();
        }
        (first[0]..first[0] + count[0])
            .into_par_iter()
            .map(|x| {
                let mut inside = 0;
                self.slice(x, first, count, |_, _| inside += 1);
                inside
            })
            .sum()
    }

    /// Calls `visit` with the cell and the place of every point of the slice number `x` across the first axis.
    fn slice(
        &self,
        x: u64,
        first: [u64; 3],
        count: [u64; 3],
        mut visit: impl FnMut([u64; 3], [f64; 3]),
    ) {
        let whole = matches!(self.shape, Shape::Cuboid(_));
        let mut at = [self.coordinate(0, x), 0.0, 0.0];
        for y in first[1]..first[1] + count[1] {
            if self.dimension > 1 {
                at[1] = self.coordinate(1, y);
            }
            for z in first[2]..first[2] + count[2] {
                if self.dimension > 2 {
                    at[2] = self.coordinate(2, z);
                }
                if whole || self.shape.contains(&at[..self.dimension]) {
                    visit([x, y, z], at);
                }
            }
        }
    }
}

/// Whether a number is whole but for round-off.
fn whole(x: f64) -> bool {
    (x - x.round()).abs() < 1e-9 * x.abs().max(1.0)
}

#[cfg(test)]
mod tests;
