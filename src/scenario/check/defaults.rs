//! What a scenario gets that leaves frame and basis out: the cheapest that the charts show to be safe in this scene.
//!
//! Where nothing can touch, the total Lagrangian frame needs the least work for its accuracy and has no cell crossing; it does not
//! see contact. Of its bases `gimp` has the errors of `linear`, and bears points close to a node; both lock near ν = ½, where splines
//! do not. In the updated frame points cross cells, which takes quadratic splines.

use super::numerics::GivenMethod;
use super::{CountedBody, Named};
use crate::basis::{BasisChoice, Gimp, QuadraticBSpline};
use crate::scenario::{
    BodySpec, BoundarySpec, Chosen, GridSpec, MaterialSpec, Method, ReferenceFrame, Region,
};

/// Poisson's ratio from which on hat functions are too stiff: they reach 9 tenths of a deflection at 0.45, 6 at 0.49.
const LOCKS: f64 = 0.4;

/// The basis whose nodes a region has to hold, before the scene has decided.
pub(super) fn basis_before_all(given: &GivenMethod) -> BasisChoice {
    given.basis.unwrap_or_else(quadratic)
}

fn quadratic() -> BasisChoice {
    BasisChoice::QuadraticBSpline(QuadraticBSpline)
}

/// The method of a scene: what the file says, and for the rest what suits the scene.
pub(super) fn method(
    given: &GivenMethod,
    bodies: &[Named<CountedBody>],
    boundaries: &[BoundarySpec],
    materials: &[Named<MaterialSpec>],
    grid: &GridSpec,
) -> Method {
    let (alone, why) = nothing_touches(bodies, boundaries, grid);
    // a basis that was chosen was chosen for points that move through the grid
    let free = given.frame.is_none() && given.basis.is_none();
    let frame = given.frame.unwrap_or(if free && alone {
        ReferenceFrame::Total
    } else {
        ReferenceFrame::Updated
    });
    let stiff = materials
        .iter()
        .filter_map(|named| named.found.as_ref()?.poissons_ratio)
        .any(|ratio| ratio >= LOCKS);
    let basis = given.basis.unwrap_or_else(|| match frame {
        ReferenceFrame::Total if !stiff => BasisChoice::Gimp(Gimp::default()),
        _ => quadratic(),
    });
    let mut chosen = Vec::new();
    if free {
        chosen.push(Chosen {
            key: "frame",
            value: frame.name(),
            why,
        });
    }
    if given.basis.is_none() {
        let why = match frame {
            ReferenceFrame::Updated => "points cross cells",
            ReferenceFrame::Total if stiff => "hat functions lock near Poisson's ratio 0.5",
            ReferenceFrame::Total => "points cross no cells",
        };
        chosen.push(Chosen {
            key: "basis",
            value: basis.name(),
            why,
        });
    }
    Method {
        basis,
        transfer: given.transfer,
        update: given.update,
        frame,
        chosen,
    }
}

/// Whether the only body touches nothing but what holds it from the start on, and a few words on why.
fn nothing_touches(
    bodies: &[Named<CountedBody>],
    boundaries: &[BoundarySpec],
    grid: &GridSpec,
) -> (bool, &'static str) {
    let [
        Named {
            found: Some(counted),
            ..
        },
    ] = bodies
    else {
        return (false, "bodies may touch each other");
    };
    for boundary in boundaries {
        if boundary.condition.is_one_sided() {
            return (false, "the body may touch or leave a wall");
        }
        if !is_reached(&counted.body, &boundary.on, grid) {
            return (
                false,
                "the body may come to a boundary that it does not touch at the start",
            );
        }
    }
    (true, "one body, which nothing can touch")
}

/// Whether a body begins less than a cell from a region.
fn is_reached(body: &BodySpec, on: &Region, grid: &GridSpec) -> bool {
    let bounds = body.shape.bounds();
    let h = grid.cell_size;
    match on {
        Region::Side(side) if side.upper => bounds.max[side.axis] > grid.max[side.axis] - h,
        Region::Side(side) => bounds.min[side.axis] < grid.min[side.axis] + h,
        Region::Box { min, max } => {
            (0..min.len()).all(|a| bounds.min[a] - h < max[a] && bounds.max[a] + h > min[a])
        }
    }
}
