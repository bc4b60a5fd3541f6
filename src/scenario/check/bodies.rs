//! Bodies.

use super::{AXES, CountedBody, Frame, Named, TINY, named, place, shown};
use crate::input::{Document, Reader, Unit, Variables};
use crate::material::Plane;
use crate::scenario::fill::Filling;
use crate::scenario::shape::Shape;
use crate::scenario::{BodySpec, GridSpec, MaterialSpec};

/// More points than this along each edge of a cell cost much and give nothing.
const MOST_PER_CELL: i64 = 16;
/// Looking at more places than this takes minutes.
pub(super) const MOST_CANDIDATES: f64 = 2e9;

/// All bodies, in file order.
pub(super) fn bodies(
    root: &mut Reader<'_>,
    document: &Document,
    frame: Frame,
    grid: Option<&GridSpec>,
    materials: &[Named<MaterialSpec>],
) -> Vec<Named<CountedBody>> {
    let none = !root.has("body") || root.list_length("body") == Some(0);
    if none && !document.is_broken() {
        root.problem(
            "body",
            "there is no body: add [[body]] with a name, a material and a shape",
        );
    }
    let mut taken = Vec::new();
    let tables = root.tables("body").into_iter();
    tables
        .map(|mut reader| {
            let name = super::name(&mut reader, "body", &taken, None).unwrap_or_default();
            taken.push(name.clone());
            let found = body(&mut reader, &name, frame, grid, materials);
            reader.finish();
            Named { name, found }
        })
        .collect()
}

fn body(
    reader: &mut Reader<'_>,
    name: &str,
    frame: Frame,
    grid: Option<&GridSpec>,
    materials: &[Named<MaterialSpec>],
) -> Option<CountedBody> {
    let dimension = frame.dimension;
    let material = named(
        reader,
        "material",
        "material",
        materials.iter().map(|named| &named.name[..]),
    );
    let shape = reader
        .table_such_as(
            "shape",
            "a shape such as shape.box = { min = [...], max = [...] }",
        )
        .and_then(|mut table| {
            let shape = Shape::read(&mut table, dimension);
            table.finish();
            shape
        });
    let per_cell = if reader.has("particles_per_cell") {
        reader.integers_one_or_list("particles_per_cell", dimension, 1, MOST_PER_CELL)
    } else {
        Some(vec![2; dimension])
    };
    let velocity = if reader.has("velocity") {
        reader.expressions("velocity", Unit::VELOCITY, dimension, &["x", "y", "z"])
    } else {
        Some(vec![crate::input::Expression::constant(0.0); dimension])
    };
    let body = BodySpec {
        name: name.into(),
        material: material.unwrap_or(0),
        shape: shape?,
        particles_per_cell: per_cell?.iter().map(|count| *count as u32).collect(),
        moment: None,
        velocity: velocity?,
    };
    let points = grid.and_then(|grid| count(reader, &body, grid, frame));
    material.map(|_| CountedBody { body, points })
}

/// Checks that a body has points, all inside the grid; `None` if it has not, or too many to count.
fn count(reader: &mut Reader<'_>, body: &BodySpec, grid: &GridSpec, frame: Frame) -> Option<u64> {
    let bounds = body.shape.bounds();
    let mut inside = true;
    for axis in 0..frame.dimension {
        let (mut min, max) = (bounds.min[axis], bounds.max[axis]);
        // Only the part at r ≥ 0 of a disk on the axis is meant: a sphere.
        let half = frame.plane == Plane::Axisymmetric
            && axis == 0
            && !matches!(body.shape, Shape::Cuboid(_));
        if half && max > 0.0 {
            min = min.max(0.0);
        }
        let (start, end, slack) = (grid.min[axis], grid.max[axis], TINY * grid.cell_size);
        if min < start - slack || max > end + slack {
            let (axis, min, max) = (AXES[axis], shown(min), shown(max));
            let (start, end) = (shown(start), shown(end));
            reader.problem(
                "shape",
                format!(
                    "along {axis} the body spans {min} m to {max} m, outside the grid from {start} m to {end} m: move the body or make the grid larger"
                ),
            );
            inside = false;
        }
    }
    if !inside {
        return None;
    }
    let filling = Filling::of(body, grid, frame.plane);
    if filling.candidates() > MOST_CANDIDATES {
        return None;
    }
    let points = filling.count();
    if points == 0 {
        let (size, per_cell) = (shown(grid.cell_size), &body.particles_per_cell);
        reader.problem(
            "shape",
            format!(
                "no material point is inside the shape with cells of {size} m and {per_cell:?} points a cell: use a larger shape, smaller cells or more points"
            ),
        );
        return None;
    }
    for (axis, velocity) in body.velocity.iter().enumerate() {
        let bad = |at: &[f64; 3]| {
            !velocity
                .value(&Variables {
                    position: *at,
                    time: 0.0,
                })
                .is_finite()
        };
        let found = if velocity.is_constant() {
            None
        } else {
            filling.find(bad)
        };
        if let Some(at) = found {
            let at = place(&at[..frame.dimension]);
            reader.problem(
                &format!("velocity[{axis}]"),
                format!("this is not a finite number at the point {at}: change the formula there"),
            );
        }
    }
    Some(points)
}
