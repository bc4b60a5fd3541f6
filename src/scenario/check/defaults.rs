//! What a scenario gets that leaves frame and basis out: the cheapest that the charts show to be safe in this scene.
//!
//! Where nothing can touch, the total Lagrangian frame needs the least work for its accuracy and has no cell crossing; it does not
//! see contact. Of its bases `gimp` bears points close to a node, where `linear` blows up; but where no point reaches beyond its
//! cell the mean of a hat over the width of a point is the hat at its middle, and `linear` gives the same for fewer nodes. Both lock
//! near ν = ½, where splines do not, and their strains are of first order: a scene that is damped is on its way to a state of rest,
//! whose stresses splines give much more cheaply. In the updated frame points cross cells, which takes quadratic splines.

use super::numerics::GivenMethod;
use crate::basis::{BasisChoice, Gimp, Linear, QuadraticBSpline};
use crate::material::Plane;
use crate::scenario::fill::Filling;
use crate::scenario::{
    BodySpec, BoundarySpec, Chosen, GridSpec, MaterialSpec, Method, Placement, ReferenceFrame,
    Region, bending_moment,
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

/// What the choice of a method looks at.
pub(super) struct Surroundings<'a> {
    /// All bodies; none in place of one that could not be read.
    pub bodies: Vec<Option<&'a BodySpec>>,
    pub boundaries: &'a [BoundarySpec],
    pub materials: Vec<&'a MaterialSpec>,
    pub grid: &'a GridSpec,
    pub plane: Plane,
    /// Rate of damping, 1/s.
    pub damping: f64,
}

/// The method of a scene: what the file says, and for the rest what suits the scene.
pub(super) fn method(given: &GivenMethod, scene: &Surroundings<'_>) -> Method {
    let (alone, why) = nothing_touches(scene);
    // a basis that was chosen was chosen for points that move through the grid
    let free = given.frame.is_none() && given.basis.is_none();
    let frame = given.frame.unwrap_or(if free && alone {
        ReferenceFrame::Total
    } else {
        ReferenceFrame::Updated
    });
    let stiff = scene
        .materials
        .iter()
        .filter_map(|material| material.poissons_ratio)
        .any(|ratio| ratio >= LOCKS);
    let inside_cells = || {
        let divides =
            |body: &BodySpec| Filling::of(body, scene.grid, scene.plane).divides_cells(scene.grid);
        let mut bodies = scene.bodies.iter();
        bodies.all(|body| body.is_some_and(divides))
    };
    let (chosen_basis, why_basis) = match frame {
        ReferenceFrame::Updated => (quadratic(), "points cross cells"),
        ReferenceFrame::Total if stiff => {
            (quadratic(), "hat functions lock near Poisson's ratio 0.5")
        }
        ReferenceFrame::Total if scene.damping > 0.0 => (
            quadratic(),
            "damping leads to a state of rest, whose stresses hat functions give to first order only",
        ),
        ReferenceFrame::Total if inside_cells() => (
            BasisChoice::Linear(Linear::default()),
            "points cross no cells, and none reaches beyond its own",
        ),
        ReferenceFrame::Total => (
            BasisChoice::Gimp(Gimp::default()),
            "points cross no cells, but some reach beyond their own",
        ),
    };
    let basis = given.basis.unwrap_or(chosen_basis);
    let bends = frame == ReferenceFrame::Total
        && scene
            .bodies
            .iter()
            .flatten()
            .any(|body| moment(body, &basis, scene).is_some());
    let placement = given.placement.unwrap_or(if bends {
        Placement::Bending
    } else {
        Placement::Even
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
        chosen.push(Chosen {
            key: "basis",
            value: basis.name(),
            why: why_basis,
        });
    }
    if given.placement.is_none() && bends {
        chosen.push(Chosen {
            key: "placement",
            value: placement.name(),
            why: "points that keep their places in cells bend them as softly as the material",
        });
    }
    Method {
        basis,
        transfer: given.transfer,
        update: given.update,
        frame,
        placement,
        chosen,
    }
}

/// The second moment of a body's points in their cells that suits bending, if it can have one.
pub(super) fn moment(
    body: &BodySpec,
    basis: &BasisChoice,
    scene: &Surroundings<'_>,
) -> Option<f64> {
    let material = scene.materials.get(body.material)?;
    let moment = bending_moment(basis, material, scene.grid.min.len(), scene.plane)?;
    let filling = Filling::of(body, scene.grid, scene.plane);
    filling.fills_cells(scene.grid).then_some(moment)
}

/// Whether the only body touches nothing but what holds it from the start on, and a few words on why.
fn nothing_touches(scene: &Surroundings<'_>) -> (bool, &'static str) {
    let [Some(body)] = scene.bodies[..] else {
        return (false, "bodies may touch each other");
    };
    for boundary in scene.boundaries {
        if boundary.condition.is_one_sided() {
            return (false, "the body may touch or leave a wall");
        }
        if !is_reached(body, &boundary.on, scene.grid) {
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
