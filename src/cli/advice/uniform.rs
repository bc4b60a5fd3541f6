//! A scene that is the same all along an axis, between rollers: a dimension more than it needs.
//!
//! Shapes are prisms from one end of the grid to the other, no motion, load or condition has a component along the axis, and no
//! formula names its coordinate. By symmetry every velocity along the axis is then zero: plane strain in 2D, uniaxial strain in 1D.

use super::{AXES, Advice, Subject, aligned, along, cost, names, quoted, stencil};
use crate::basis::BasisChoice;
use crate::boundary::ConditionChoice;
use crate::input::Expression;
use crate::material::Plane;
use crate::scenario::shape::Shape;
use crate::scenario::{
    BodySpec, BoundarySpec, GridSpec, LoadKind, LoadPlace, LoadSpec, PointSet, ProbeTarget, Region,
    Scenario,
};
use crate::transfer::TransferChoice;

pub fn advise(subject: &Subject) -> Vec<Advice> {
    let scenario = subject.scenario;
    // there is a model for strain alone: none of a thin sheet, or of a long ring, has one dimension less
    if scenario.dimension == 1 || scenario.plane != Plane::Strain {
        return Vec::new();
    }
    let mut left_out = axes(subject);
    if left_out.len() == scenario.dimension {
        left_out.remove(0);
    }
    if left_out.is_empty() {
        return Vec::new();
    }
    let lower = scenario.dimension - left_out.len();
    let model = ["1D uniaxial strain", "2D plane strain"][lower - 1];
    let axes: Vec<_> = left_out.iter().map(|a| AXES[*a]).collect();
    let axes = axes.join(" and ");
    vec![Advice {
        kind: "uniform_along_axis",
        says: format!(
            "nothing varies along {axes}, where every body fills the grid between rollers: {model} gives the same answer{}",
            spared(scenario)
        ),
        change: change(scenario, &left_out),
        factor: Some(factor(subject, &left_out)),
    }]
}

/// What a model without the rollers spares: cubic splines, and MLS-APIC with any splines, err a little at the ends of a grid, so that
/// their motion along the bar is not quite uniform across it; all others give the same to round-off (`tests/advice.rs`).
fn spared(scenario: &Scenario) -> &'static str {
    let method = &scenario.method;
    let fitted = matches!(method.transfer, TransferChoice::MlsApic(_));
    match method.basis {
        BasisChoice::CubicBSpline(_) => ", without what cubic functions err at rollers",
        BasisChoice::QuadraticBSpline(_) if fitted => ", without what mls_apic errs at rollers",
        _ => "",
    }
}

/// The axes along which nothing varies.
pub fn axes(subject: &Subject) -> Vec<usize> {
    let axes = 0..subject.scenario.dimension;
    axes.filter(|axis| is_uniform(subject, *axis)).collect()
}

fn is_uniform(subject: &Subject, axis: usize) -> bool {
    let Subject { scenario, sets, .. } = *subject;
    let grid = &scenario.grid;
    let held = |upper| {
        scenario.boundaries.iter().any(|spec| {
            matches!(&spec.on, Region::Side(side) if side.axis == axis && side.upper == upper)
        })
    };
    held(false)
        && held(true)
        && scenario.gravity[axis] == 0.0
        && scenario
            .boundaries
            .iter()
            .all(|spec| boundary_allows(spec, grid, axis))
        && scenario
            .loads
            .iter()
            .all(|load| load_allows(load, grid, axis))
        && scenario.bodies.iter().zip(sets).all(|(body, points)| {
            moves_across(&body.velocity, axis)
                && is_prism(&body.shape, grid, axis)
                && has_layers(body, points, axis)
        })
}

/// Whether a vector field has no component along an axis and does not depend on the coordinate along it.
fn moves_across(field: &[Expression], axis: usize) -> bool {
    let mut components = field.iter().enumerate();
    components.all(|(component, formula)| formula.is_uniform_along(axis, component))
}

/// Whether two lengths are the same but for round-off.
pub fn same(a: f64, b: f64, grid: &GridSpec) -> bool {
    (a - b).abs() <= 1e-9 * grid.cell_size
}

/// Whether a region reaches from one end of the grid to the other.
fn spans(on: &Region, grid: &GridSpec, axis: usize) -> bool {
    match on {
        Region::Side(side) => side.axis != axis,
        Region::Box { min, max } => min[axis] <= grid.min[axis] && max[axis] >= grid.max[axis],
    }
}

fn boundary_allows(spec: &BoundarySpec, grid: &GridSpec, axis: usize) -> bool {
    if let Region::Side(side) = &spec.on
        && side.axis == axis
    {
        return matches!(spec.condition, ConditionChoice::Roller(_));
    }
    spans(&spec.on, grid, axis) && spec.condition.is_uniform_along(axis)
}

fn load_allows(load: &LoadSpec, grid: &GridSpec, axis: usize) -> bool {
    let goes_through = match &load.on {
        LoadPlace::Region(on) => spans(on, grid, axis),
        // it ends with the grid: no face at the ends looks into it
        LoadPlace::Shape(shape) => is_prism(shape, grid, axis),
    };
    goes_through
        && match &load.kind {
            LoadKind::Force(force) => force[axis] == 0.0,
            LoadKind::Traction { traction, side } => traction[axis] == 0.0 && side.axis != axis,
            LoadKind::Pressure { side, .. } => side.is_none_or(|side| side.axis != axis),
            LoadKind::Acceleration(field) => moves_across(field, axis),
        }
}

/// Whether a shape has the same section all along an axis, from one end of the grid to the other.
fn is_prism(shape: &Shape, grid: &GridSpec, axis: usize) -> bool {
    let bounds = shape.bounds();
    let ends = same(bounds.min[axis], grid.min[axis], grid)
        && same(bounds.max[axis], grid.max[axis], grid);
    match shape {
        Shape::Cuboid(_) => ends,
        Shape::Cylinder(cylinder) => {
            let straight = (0..3).all(|a| a == axis || cylinder.from[a] == cylinder.to[a]);
            straight && ends
        }
        Shape::Union(union) => union.shapes.iter().all(|part| is_prism(part, grid, axis)),
        Shape::Difference(difference) => {
            let mut parts = std::iter::once(&*difference.of).chain(&difference.minus);
            parts.all(|part| is_prism(part, grid, axis))
        }
        Shape::Ball(_) | Shape::Polygon(_) => false,
    }
}

/// Whether the points of a body are the same in every layer across an axis.
fn has_layers(body: &BodySpec, points: &PointSet, axis: usize) -> bool {
    if let Shape::Cuboid(_) = body.shape {
        return true;
    }
    let Some(sorted) = along(points, axis) else {
        return false;
    };
    let mut lines = sorted.chunk_by(|p, q| aligned(axis, p, q));
    let Some(first) = lines.next() else {
        return false;
    };
    lines.all(|line| {
        line.len() == first.len() && line.iter().zip(first).all(|(p, q)| p[axis] == q[axis])
    })
}

/// How many times fewer points there are, times how many times cheaper a point is.
fn factor(subject: &Subject, left_out: &[usize]) -> f64 {
    let Subject { scenario, sets, .. } = *subject;
    let (mut all, mut kept) = (0.0, 0.0);
    for set in sets {
        let count = set.positions.len() as f64;
        let layers = |axis: &usize| {
            let size = scenario.grid.max[*axis] - scenario.grid.min[*axis];
            (size / set.spacing[*axis]).round()
        };
        all += count;
        kept += count / left_out.iter().map(layers).product::<f64>();
    }
    let nodes = stencil(scenario);
    let (dimension, lower) = (scenario.dimension, scenario.dimension - left_out.len());
    let frame = scenario.method.frame;
    all / kept * cost(nodes, dimension, frame) / cost(nodes, lower, frame)
}

fn change(scenario: &Scenario, left_out: &[usize]) -> String {
    let grid = &scenario.grid;
    let (dimension, lower) = (scenario.dimension, scenario.dimension - left_out.len());
    let letters = |axes: Vec<usize>| {
        let names: Vec<_> = axes.iter().map(|a| AXES[*a]).collect();
        names.join(" and ")
    };
    let kept: Vec<usize> = (0..dimension).filter(|a| !left_out.contains(a)).collect();
    let rollers = names(
        &scenario.boundaries,
        |spec| matches!(&spec.on, Region::Side(side) if left_out.contains(&side.axis)),
    );
    let mut said = format!(
        "dimension = {lower}; leave out the {} entry of every vector, and the boundaries {}",
        letters(left_out.to_vec()),
        quoted(&rollers)
    );
    if kept[0] > 0 || kept.last().is_some_and(|last| *last >= lower) {
        said += &format!(
            "; {} becomes {}",
            letters(kept),
            letters((0..lower).collect())
        );
    }
    let width: f64 = left_out
        .iter()
        .map(|a| grid.max[*a] - grid.min[*a])
        .product();
    let unit = ["m", "m²"][left_out.len() - 1];
    let forces = scenario.loads.iter();
    let forces = forces.filter(|load| matches!(load.kind, LoadKind::Force(_)));
    let forces: Vec<&str> = forces.map(|load| &load.name[..]).collect();
    if (width - 1.0).abs() > 1e-9 {
        if !forces.is_empty() {
            said += &format!("; divide the force of {} by {width}", quoted(&forces));
        }
        said += &format!(
            "; masses, forces and energies are then those of 1 {unit}, not of {width} {unit}"
        );
    }
    let numbered =
        |probe: &crate::scenario::ProbeSpec| matches!(probe.target, ProbeTarget::Particle(_));
    if scenario.probes.iter().any(numbered) {
        said += "; give probes a place, as the numbers of points change";
    }
    said
}
