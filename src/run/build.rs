//! From a scenario to bodies, loads and observers.

use super::method::method;
use crate::boundary::Side;
use crate::input::{Expression, Variables};
use crate::material::Plane;
use crate::math::{Matrix, Vector, packed_len};
use crate::observe::{BodyTable, EnergyTable, Observer, ProbeTable, ReactionTable};
use crate::real::Instructions;
use crate::scenario::{
    GridSpec, LoadKind, LoadPlace, LoadSpec, PointSet, ProbeTarget, ReferenceFrame, Region,
    Scenario, body_points, loaded_faces,
};
use crate::solver::{Factor, Load, LoadForce, Mpm, Setup, Solver};
use crate::state::{Body, Masses, Particles, State};

/// Points below which threads cost more than they bring: on two cores two threads gained 3 % with 4,000 points in 2D and 25 % with
/// 9,000, and lost 14 % with 2,000 in 1D (quadratic APIC, medians of three).
pub const PARALLEL_FROM: usize = 8_000;

/// Something to be done with a built scene, whose dimension is not known before the run.
pub trait SceneVisitor {
    /// What comes out.
    type Output;
    /// Does it.
    fn visit<const D: usize>(self, scene: Scene<D>) -> Self::Output;
}

/// A scene, ready to go.
pub struct Scene<const D: usize> {
    /// Bodies at time 0.
    pub state: State<D>,
    /// The method.
    pub solver: Box<dyn Solver<D>>,
    /// What the scenario asks to be recorded.
    pub observers: Vec<Box<dyn Observer<D>>>,
}

/// How a scene is computed, where that makes no difference to what is computed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Computing {
    /// Whether steps may use several threads; if not given, where that pays.
    pub parallel: Option<bool>,
    /// With which instructions; if not given, with the most that the processor has.
    pub instructions: Option<Instructions>,
}

/// Builds the scene of a scenario and hands it to the visitor.
pub fn with_scene<V: SceneVisitor>(scenario: &Scenario, visitor: V) -> V::Output {
    match scenario.dimension {
        1 => visitor.visit(build::<1>(scenario)),
        2 => visitor.visit(build::<2>(scenario)),
        _ => visitor.visit(build::<3>(scenario)),
    }
}

/// Builds the scene of a scenario whose dimension is known to be `D`.
pub fn build<const D: usize>(scenario: &Scenario) -> Scene<D> {
    build_with(scenario, &Computing::default())
}

/// Builds the scene of a scenario, to be computed in a certain way.
pub fn build_with<const D: usize>(scenario: &Scenario, computing: &Computing) -> Scene<D> {
    let sets: Vec<PointSet> = (0..scenario.bodies.len())
        .map(|b| body_points(scenario, b))
        .collect();
    let bodies = (0..scenario.bodies.len())
        .map(|b| build_body(scenario, b, &sets[b]))
        .collect();
    let state = State {
        time: 0.0,
        step: 0,
        bodies,
    };
    let observers = observers(scenario, &state, &sets);
    let pays = || state.point_count() >= PARALLEL_FROM && rayon::current_num_threads() > 1;
    let solver = build_solver(
        scenario,
        &state,
        &sets,
        computing.parallel.unwrap_or_else(pays),
    );
    let found = Instructions::found();
    let solver = Box::new(solver.with_instructions(computing.instructions.unwrap_or(found)));
    Scene {
        state,
        solver,
        observers,
    }
}

fn build_body<const D: usize>(scenario: &Scenario, index: usize, set: &PointSet) -> Body<D> {
    let spec = &scenario.bodies[index];
    let material = &scenario.materials[spec.material];
    let count = set.positions.len();
    let axisymmetric = scenario.plane == Plane::Axisymmetric;
    let affine = scenario.method.transfer.is_affine();
    let velocity = set.positions.iter().map(|&position| {
        let at = Variables {
            position,
            time: 0.0,
        };
        Vector::from_fn(|a, _| spec.velocity[a].value(&at))
    });
    let position: Vec<Vector<D>> = set
        .positions
        .iter()
        .map(|x| Vector::from_fn(|a, _| x[a]))
        .collect();
    let total = if scenario.method.frame == ReferenceFrame::Total {
        count
    } else {
        0
    };
    let points = material.law.points(scenario.plane, count);
    let basis = &scenario.method.basis;
    let remembered = count > 0 && points.deformation_gradient(0).is_some();
    let deforming = if basis.has_domains() {
        count
    } else if remembered && !basis.dilation_at_centre() {
        0
    } else {
        total
    };
    Body {
        name: spec.name.clone(),
        particles: Particles {
            velocity: velocity.collect(),
            reference_position: position[..total].to_vec(),
            position,
            mass: Masses::of_volumes(material.density, count, |p| set.volume(p)),
            stress: vec![0.0; count * packed_len(D)],
            deformation_gradient: vec![Matrix::identity(); deforming],
            first_piola_stress: vec![Matrix::zeros(); total],
            affine: if affine {
                let gradient = |at: &[f64; 3]| velocity_gradient(&spec.velocity, *at, &set.spacing);
                set.positions.iter().map(gradient).collect()
            } else {
                Vec::new()
            },
            hoop_stress: if axisymmetric {
                vec![0.0; count]
            } else {
                Vec::new()
            },
            hoop_stretch: if axisymmetric {
                vec![1.0; count]
            } else {
                Vec::new()
            },
            id: (0..count as u32).collect(),
        },
        material: points,
        spacing: Vector::from_fn(|a, _| set.spacing[a]),
    }
}

/// ∇v of the initial velocity at a position, 1/s: what an affine field has to start with, or the first step would lose the spin
/// and the stretching of points within their cells. Central differences over a hundredth of the points' spacing, exact for a
/// field that is linear in x.
fn velocity_gradient<const D: usize>(
    velocity: &[Expression],
    position: [f64; 3],
    spacing: &[f64; 3],
) -> Matrix<D> {
    let mut gradient = Matrix::zeros();
    for column in 0..D {
        let arm = 0.01 * spacing[column];
        for row in 0..D {
            let value = |side: f64| {
                let mut position = position;
                position[column] += side * arm;
                velocity[row].value(&Variables {
                    position,
                    time: 0.0,
                })
            };
            let slope = (value(1.0) - value(-1.0)) / (2.0 * arm);
            // a formula that is not defined beside a point still is at it
            gradient[(row, column)] = if slope.is_finite() { slope } else { 0.0 };
        }
    }
    gradient
}

fn observers<const D: usize>(
    scenario: &Scenario,
    state: &State<D>,
    sets: &[PointSet],
) -> Vec<Box<dyn Observer<D>>> {
    let mut observers: Vec<Box<dyn Observer<D>>> = vec![Box::new(EnergyTable {
        loads: !scenario.loads.is_empty(),
        boundaries: !scenario.boundaries.is_empty(),
        damping: scenario.damping > 0.0,
    })];
    for (body, spec) in scenario.bodies.iter().enumerate() {
        observers.push(Box::new(BodyTable {
            body,
            name: spec.name.clone(),
        }));
    }
    for probe in &scenario.probes {
        let particle = match &probe.target {
            ProbeTarget::Particle(number) => *number,
            ProbeTarget::Near(place) => sets[probe.body].nearest(place).unwrap_or(0),
        };
        observers.push(Box::new(ProbeTable {
            body: probe.body,
            particle: particle as u32,
            name: probe.name.clone(),
            memory: state.bodies[probe.body].material.memory_names(),
            axisymmetric: scenario.plane == Plane::Axisymmetric,
        }));
    }
    for (boundary, spec) in scenario.boundaries.iter().enumerate() {
        observers.push(Box::new(ReactionTable {
            boundary,
            name: spec.name.clone(),
        }));
    }
    observers
}

fn build_solver<const D: usize>(
    scenario: &Scenario,
    state: &State<D>,
    sets: &[PointSet],
    parallel: bool,
) -> Mpm<D> {
    let method = method(scenario, state);
    Mpm::new(Setup {
        geometry: method.geometry,
        kernels: method.kernels,
        terms: scenario.method.transfer.terms(),
        scheme: scenario.method.update,
        gravity: Vector::from_fn(|a, _| scenario.gravity[a]),
        damping: scenario.damping,
        boundaries: scenario
            .boundaries
            .iter()
            .map(|spec| spec.condition.build())
            .collect(),
        boundary_boxes: scenario
            .boundaries
            .iter()
            .map(|spec| region(&spec.on, &scenario.grid))
            .collect(),
        loads: scenario
            .loads
            .iter()
            .flat_map(|spec| loads(scenario, spec, state, &sets[spec.body]))
            .collect(),
        parallel,
    })
}

/// The box of positions of a region of nodes.
fn region<const D: usize>(on: &Region, grid: &GridSpec) -> (Vector<D>, Vector<D>) {
    match on {
        Region::Box { min, max } => (
            Vector::from_fn(|a, _| min[a]),
            Vector::from_fn(|a, _| max[a]),
        ),
        Region::Side(side) => {
            // ghost nodes outside the side belong to it
            let mut min = Vector::repeat(f64::NEG_INFINITY);
            let mut max = Vector::repeat(f64::INFINITY);
            if side.upper {
                min[side.axis] = grid.max[side.axis];
            } else {
                max[side.axis] = grid.min[side.axis];
            }
            (min, max)
        }
    }
}

/// What a load of a scenario comes to: forces that act at one and the same offset from their points; of faces, one load for each direction.
fn loads<const D: usize>(
    scenario: &Scenario,
    spec: &LoadSpec,
    state: &State<D>,
    set: &PointSet,
) -> Vec<Load<D>> {
    let particles = &state.bodies[spec.body].particles;
    let load = |chosen: &[usize], side: Option<Side>, force: LoadForce<D>| Load {
        body: spec.body,
        points: chosen.iter().map(|&p| p as u32).collect(),
        offset: side.map_or(Vector::zeros(), |side| {
            // a loaded face lies outside its points
            let mut offset = Vector::zeros();
            let outwards = if side.upper { 1.0 } else { -1.0 };
            offset[side.axis] = outwards * set.to_face[side.axis];
            offset
        }),
        force,
    };
    // forces of an area, its side and the direction inwards
    let on_faces = |force: &dyn Fn(f64, Side, f64) -> Vector<D>| {
        let faces = loaded_faces(scenario, spec, set).into_iter();
        let on_side = faces.map(|faces| {
            let (side, inwards) = (faces.side, faces.inwards());
            let forces = faces.areas.iter().map(|area| force(*area, side, inwards));
            let forces = LoadForce::Forces(forces.collect(), factor(spec));
            load(&faces.points, Some(side), forces)
        });
        on_side.collect()
    };
    match &spec.kind {
        LoadKind::Acceleration(field) => {
            let chosen = set.selected(&spec.on);
            let (field, factor) = (field.clone(), factor(spec));
            let field = move |position: &Vector<D>, time: f64| {
                let mut at = Variables {
                    position: [0.0; 3],
                    time,
                };
                at.position[..D].copy_from_slice(position.as_slice());
                Vector::from_fn(|a, _| field[a].value(&at)) * factor(time)
            };
            let origins = chosen.iter().map(|&p| particles.position[p]).collect();
            let force = LoadForce::Acceleration(origins, Box::new(field));
            vec![load(&chosen, None, force)]
        }
        LoadKind::Force(total) => {
            let chosen = set.selected(&spec.on);
            let mass: f64 = chosen.iter().map(|&p| particles.mass[p]).sum();
            let share = |&p: &usize| Vector::from_fn(|a, _| total[a] * particles.mass[p] / mass);
            let forces = LoadForce::Forces(chosen.iter().map(share).collect(), factor(spec));
            let side = match &spec.on {
                LoadPlace::Region(Region::Side(side)) => Some(*side),
                _ => None,
            };
            vec![load(&chosen, side, forces)]
        }
        LoadKind::Traction { traction, .. } => {
            on_faces(&|area, _, _| Vector::from_fn(|a, _| traction[a] * area))
        }
        LoadKind::Pressure { pressure, .. } => on_faces(&|area, side, inwards| {
            let mut force = Vector::zeros();
            force[side.axis] = inwards * pressure * area;
            force
        }),
    }
}

/// The factor of a load over time.
fn factor(spec: &LoadSpec) -> Factor {
    let factor = spec.factor.clone();
    Box::new(move |time| match &factor {
        Some(factor) => factor.value(&Variables {
            position: [0.0; 3],
            time,
        }),
        None => 1.0,
    })
}
