//! A scene that is its own mirror image about the middle of the grid: half of it is enough.

use super::uniform::{axes as uniform_axes, same};
use super::{AXES, Advice, Subject, aligned, along, stencil};
use crate::input::Variables;
use crate::material::Plane;
use crate::scenario::{
    BodySpec, BoundarySpec, GridSpec, LoadKind, LoadPlace, LoadSpec, PointSet, Region, Scenario,
    loaded_faces,
};

pub fn advise(subject: &Subject) -> Vec<Advice> {
    let Subject { scenario, sets, .. } = *subject;
    let uniform = uniform_axes(subject);
    let dimension = scenario.dimension;
    let symmetric = (0..dimension).filter(|axis| {
        let is_radius = *axis == 0 && scenario.plane == Plane::Axisymmetric;
        !uniform.contains(axis) && !is_radius && is_symmetric(scenario, sets, *axis)
    });
    symmetric.map(|axis| advice(scenario, axis)).collect()
}

fn advice(scenario: &Scenario, axis: usize) -> Advice {
    let name = AXES[axis];
    let middle = Mirror::new(&scenario.grid, axis).middle;
    let whole = |load: &&LoadSpec| matches!(load.kind, LoadKind::Force(_));
    let halved = match scenario.loads.iter().find(whole) {
        Some(_) => "; halve forces whose points lie on both sides",
        None => "",
    };
    Advice {
        kind: "mirror_symmetry",
        says: format!(
            "the scene is its own mirror image about {name} = {middle} m: half of it, against a roller, gives the same answer{}",
            if stencil(scenario) == 2 {
                ""
            } else {
                " up to the error of the grid"
            }
        ),
        change: format!(
            "grid.min[{axis}] = {middle}, bodies and loads cut off there, a boundary with on.side = \"{name}_min\" and condition = \
             \"roller\" in place of those on that side{halved}"
        ),
        factor: Some(2.0),
    }
}

/// The plane in the middle of the grid across an axis.
struct Mirror<'a> {
    grid: &'a GridSpec,
    axis: usize,
    middle: f64,
}

impl<'a> Mirror<'a> {
    fn new(grid: &'a GridSpec, axis: usize) -> Self {
        Self {
            grid,
            axis,
            middle: 0.5 * (grid.min[axis] + grid.max[axis]),
        }
    }

    fn place(&self, x: f64) -> f64 {
        2.0 * self.middle - x
    }

    fn region(&self, on: &Region) -> Region {
        match on {
            Region::Side(side) => Region::Side(side.mirrored(self.axis)),
            Region::Box { min, max } => {
                let (mut low, mut high) = (min.clone(), max.clone());
                low[self.axis] = self.place(max[self.axis]);
                high[self.axis] = self.place(min[self.axis]);
                Region::Box {
                    min: low,
                    max: high,
                }
            }
        }
    }

    fn vector(&self, vector: &[f64]) -> Vec<f64> {
        let mut image = vector.to_vec();
        image[self.axis] *= -1.0;
        image
    }

    /// Whether two regions are the same but for round-off.
    fn same_region(&self, a: &Region, b: &Region) -> bool {
        let equal = |(a, b): (&f64, &f64)| a == b || same(*a, *b, self.grid);
        match (a, b) {
            (Region::Side(a), Region::Side(b)) => a == b,
            (
                Region::Box { min, max },
                Region::Box {
                    min: low,
                    max: high,
                },
            ) => min.iter().zip(low).all(equal) && max.iter().zip(high).all(equal),
            _ => false,
        }
    }

    fn load(&self, kind: &LoadKind) -> Option<LoadKind> {
        Some(match kind {
            LoadKind::Force(force) => LoadKind::Force(self.vector(force)),
            LoadKind::Traction { traction, side } => LoadKind::Traction {
                traction: self.vector(traction),
                side: side.mirrored(self.axis),
            },
            LoadKind::Pressure { pressure, side } => LoadKind::Pressure {
                pressure: *pressure,
                side: side.map(|side| side.mirrored(self.axis)),
            },
            LoadKind::Acceleration(field) => {
                let image = field.iter().enumerate();
                let image = image.map(|(a, formula)| formula.mirrored(self.axis, a));
                LoadKind::Acceleration(image.collect::<Option<_>>()?)
            }
        })
    }
}

fn is_symmetric(scenario: &Scenario, sets: &[PointSet], axis: usize) -> bool {
    let mirror = Mirror::new(&scenario.grid, axis);
    let boundary_has_image = |spec: &BoundarySpec| {
        let (on, condition) = (mirror.region(&spec.on), spec.condition.mirrored(axis));
        scenario.boundaries.iter().any(|other| {
            mirror.same_region(&other.on, &on) && Some(&other.condition) == condition.as_ref()
        })
    };
    let load_has_image = |spec: &LoadSpec| {
        let kind = mirror.load(&spec.kind);
        let LoadPlace::Region(on) = &spec.on else {
            return kind.as_ref() == Some(&spec.kind)
                && shape_is_symmetric(&mirror, scenario, spec, &sets[spec.body]);
        };
        let on = mirror.region(on);
        scenario.loads.iter().any(|other| {
            let there = matches!(&other.on, LoadPlace::Region(own) if mirror.same_region(own, &on));
            there
                && other.body == spec.body
                && other.factor == spec.factor
                && Some(&other.kind) == kind.as_ref()
        })
    };
    // a cell that the plane cuts would have to be halved
    scenario.grid.cells[axis] % 2 == 0
        && scenario.gravity[axis] == 0.0
        && scenario.boundaries.iter().all(boundary_has_image)
        && scenario.loads.iter().all(load_has_image)
        && scenario
            .bodies
            .iter()
            .zip(sets)
            .all(|(body, points)| body_is_symmetric(&mirror, body, points))
}

/// Whether, of a body that is its own image, a load on a shape chooses points or faces that are their own image.
fn shape_is_symmetric(
    mirror: &Mirror,
    scenario: &Scenario,
    spec: &LoadSpec,
    points: &PointSet,
) -> bool {
    let LoadPlace::Shape(shape) = &spec.on else {
        return false;
    };
    let has_image = |mut at: [f64; 3]| {
        at[mirror.axis] = mirror.place(at[mirror.axis]);
        shape.contains(&at[..scenario.dimension])
    };
    if let LoadKind::Force(_) | LoadKind::Acceleration(_) = spec.kind {
        let mut chosen = points.selected(&spec.on).into_iter();
        return chosen.all(|p| has_image(points.positions[p]));
    }
    loaded_faces(scenario, spec, points).iter().all(|faces| {
        let axis = faces.side.axis;
        faces.points.iter().all(|&p| {
            // the place that has to be in the shape for the face to be loaded
            let mut beyond = points.positions[p];
            beyond[axis] -= faces.inwards() * points.spacing[axis];
            has_image(beyond)
        })
    })
}

/// Whether every point has an image that moves as its mirror image does, and none lies on the plane.
fn body_is_symmetric(mirror: &Mirror, body: &BodySpec, points: &PointSet) -> bool {
    let axis = mirror.axis;
    let velocity = |position: [f64; 3]| -> Vec<f64> {
        let at = Variables {
            position,
            time: 0.0,
        };
        body.velocity.iter().map(|v| v.value(&at)).collect()
    };
    let Some(sorted) = along(points, axis) else {
        return false;
    };
    let fastest = sorted.iter().flat_map(|at| velocity(*at));
    let fastest = fastest.fold(0.0, |most: f64, v| most.max(v.abs()));
    sorted.chunk_by(|p, q| aligned(axis, p, q)).all(|line| {
        line.len() % 2 == 0
            && line.iter().zip(line.iter().rev()).all(|(p, q)| {
                let image = mirror.vector(&velocity(*q));
                let moves = velocity(*p).iter().zip(&image).all(|(v, w)| {
                    // false too if a formula is not defined there
                    (v - w).abs() <= 1e-9 * fastest
                });
                same(p[axis], mirror.place(q[axis]), mirror.grid) && moves
            })
    })
}
