//! Conditions on grid nodes.

use super::{CountedBody, Frame, Named, region};
use crate::basis::{Basis, BasisChoice, BasisVisitor};
use crate::boundary::{ConditionChoice, Place, Side};
use crate::input::Reader;
use crate::material::Plane;
use crate::scenario::{BoundarySpec, GridSpec, Region};

/// All boundaries, in file order.
pub(super) fn boundaries(
    root: &mut Reader<'_>,
    frame: Frame,
    grid: Option<&GridSpec>,
    basis: Option<BasisChoice>,
) -> Option<Vec<BoundarySpec>> {
    let mut taken = Vec::new();
    let tables = root.tables("boundary").into_iter();
    let found: Vec<_> = tables
        .map(|mut reader| {
            let name = super::name(&mut reader, "boundary", &taken, None);
            taken.extend(name.clone());
            let on = region(&mut reader, frame, grid);
            if let (Some(grid), Some(basis), Some(Region::Box { min, max })) = (grid, basis, &on)
                && !basis.visit(AnyNode { grid, min, max })
            {
                let message = "no grid node is inside this box: make it larger or move it to a multiple of the cell size";
                reader.problem("on.box", message);
            }
            // Where the place is unknown, its side is not what is missing.
            let side = match &on {
                Some(Region::Box { .. }) => None,
                Some(Region::Side(side)) => Some(*side),
                None => Some(Side { axis: 0, upper: false }),
            };
            let place = Place { dimension: frame.dimension, side };
            let condition = reader
                .name_or_table("condition", ConditionChoice::NAMES)
                .and_then(|(name, mut parameters)| ConditionChoice::read(name, &mut parameters, &place));
            reader.finish();
            Some(BoundarySpec { name: name?, on: on?, condition: condition? })
        })
        .collect();
    found.into_iter().collect()
}

/// Whether a closed box holds at least one node of a basis.
struct AnyNode<'a> {
    grid: &'a GridSpec,
    min: &'a [f64],
    max: &'a [f64],
}

impl BasisVisitor for AnyNode<'_> {
    type Output = bool;

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> bool {
        let Self { grid, min, max } = self;
        (0..min.len()).all(|axis| {
            let cells = grid.cells[axis];
            let count = basis.count(cells);
            let at = |index: i32| grid.min[axis] + grid.cell_size * basis.position(index, cells);
            // Nodes stand about a cell apart: the first one inside is close to where it would stand in a plain grid.
            let guess =
                ((min[axis] - grid.min[axis]) / grid.cell_size).clamp(0.0, f64::from(cells)) as i32;
            let first = (guess - 4).max(0);
            (first..count.min(guess + 8)).any(|index| (min[axis]..=max[axis]).contains(&at(index)))
        })
    }
}

/// Notes a problem if a body touches the axis of an axisymmetric scene and nothing keeps it there.
pub(super) fn check_axis(
    root: &mut Reader<'_>,
    frame: Frame,
    grid: Option<&GridSpec>,
    bodies: &[Named<CountedBody>],
    boundaries: Option<&[BoundarySpec]>,
) {
    let (Some(grid), Some(boundaries)) = (grid, boundaries) else {
        return;
    };
    let on_axis = |named: &Named<CountedBody>| {
        let bounds = named.found.as_ref().map(|found| found.body.shape.bounds());
        bounds.is_some_and(|bounds| bounds.min[0] < grid.cell_size)
    };
    let holds = |boundary: &BoundarySpec| match &boundary.on {
        Region::Side(side) => side.axis == 0 && !side.upper,
        Region::Box { min, max } => min[0] <= 0.0 && max[0] >= 0.0,
    };
    let axisymmetric = frame.plane == Plane::Axisymmetric && grid.min[0] == 0.0;
    if axisymmetric && bodies.iter().any(on_axis) && !boundaries.iter().any(holds) {
        let message = "a body reaches the axis x = 0 and nothing keeps it from crossing: add [[boundary]] with on.side = \"x_min\" and condition = \"roller\"";
        root.problem("boundary", message);
    }
}
