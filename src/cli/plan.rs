//! What running a scenario would mean: what is modelled, what it costs, what is likely to surprise.

mod loads;

pub use loads::LoadPlan;

use super::advice::{Advice, Subject, advise};
use super::reach;
use super::run::step_warning;
use crate::material::Plane;
use crate::run::{Scene, SceneVisitor};
use crate::scenario::{PointSet, ReferenceFrame, Region, Scenario, StepRule, body_points};
use crate::solver::TimeStep;
use serde::Serialize;
use std::time::{Duration, Instant};

/// Everything that `mpm check` says.
#[derive(Debug, Serialize)]
pub struct Plan {
    pub status: &'static str,
    pub title: String,
    pub dimension: usize,
    /// What the directions that are not modelled do.
    pub plane: Option<&'static str>,
    pub basis: &'static str,
    pub transfer: &'static str,
    pub update: &'static str,
    /// Which configuration the shape functions belong to.
    pub frame: &'static str,
    /// What the file leaves out, and why the scene gets what it gets.
    pub defaults: Vec<String>,
    pub bodies: Vec<BodyPlan>,
    pub particles: usize,
    pub bytes_per_particle: f64,
    pub grid: GridPlan,
    /// Points, nodes and what a sort needs.
    pub memory_bytes: f64,
    pub time_step: StepPlan,
    pub output: OutputPlan,
    pub cost: CostPlan,
    pub boundaries: Vec<BoundaryPlan>,
    pub loads: Vec<LoadPlan>,
    pub gravity: Vec<f64>,
    pub damping_rate: f64,
    pub probes: Vec<String>,
    pub warnings: Vec<String>,
    /// What would be cheaper, or safer, and as good.
    pub advice: Vec<Advice>,
}

#[derive(Debug, Serialize)]
pub struct BodyPlan {
    pub name: String,
    pub material: String,
    pub law: &'static str,
    pub density: f64,
    pub particles: usize,
    pub mass: f64,
    pub bytes_per_particle: f64,
}

#[derive(Debug, Serialize)]
pub struct GridPlan {
    pub cells: Vec<i32>,
    pub cell_size: f64,
    pub nodes: f64,
    /// Only blocks of nodes around points have storage.
    pub stored_nodes: usize,
    pub bytes: f64,
}

#[derive(Debug, Serialize)]
pub struct StepPlan {
    pub rule: &'static str,
    /// Courant number, or the step in seconds.
    pub given: f64,
    /// At the start, s.
    pub dt: f64,
    /// Time in which the fastest signal crosses a cell, s.
    pub crossing_time: f64,
    /// dt / crossing time.
    pub ratio: f64,
    pub wave_speed: f64,
    pub particle_speed: f64,
    pub limited_by: &'static str,
    pub end: f64,
    /// As many as the step at the start gives.
    pub steps: f64,
}

#[derive(Debug, Serialize)]
pub struct OutputPlan {
    pub every: f64,
    pub rows: f64,
    pub tables: usize,
    pub bytes: f64,
}

#[derive(Debug, Serialize)]
pub struct CostPlan {
    pub threads: usize,
    /// Steps taken to find out.
    pub trial_steps: u64,
    pub seconds_per_step: f64,
    pub nanoseconds_per_particle_step: f64,
    pub expected_seconds: f64,
}

#[derive(Debug, Serialize)]
pub struct BoundaryPlan {
    pub name: String,
    pub condition: &'static str,
    pub on: String,
    /// Nodes there that have mass at the start.
    pub nodes: usize,
}

/// How long real steps are tried.
const TRIAL: Duration = Duration::from_millis(300);
/// Bytes that a sort of a body's points by block needs for each of them.
const SORT_BYTES: f64 = 8.0;
/// Bytes of a number in a table, with its comma.
const NUMBER_BYTES: f64 = 20.0;
/// Builds the scene and finds out.
pub struct Planner<'a> {
    pub scenario: &'a Scenario,
    /// What reading the scenario already noticed.
    pub warnings: Vec<String>,
}

impl SceneVisitor for Planner<'_> {
    type Output = Plan;

    fn visit<const D: usize>(self, mut scene: Scene<D>) -> Plan {
        let Self {
            scenario,
            mut warnings,
        } = self;
        let bodies = bodies(scenario, &scene);
        let nodes = reach::held_nodes(scenario, &scene.state);
        let boundaries = boundaries(scenario, &nodes, &mut warnings);
        let loads = loads::loads(scenario, &mut warnings);
        let particles = scene.state.point_count();
        let output = output(scenario, &scene);

        if let Err(fault) = scene.solver.start(&mut scene.state) {
            warnings.push(format!("the run cannot start: {fault}"));
        }
        let time_step = step(scenario, &scene);
        if let StepRule::Fixed(dt) = scenario.step {
            warnings.extend(step_warning(dt, time_step.ratio));
        }
        let stored_nodes = scene.solver.stored_nodes();
        let grid = GridPlan {
            cells: scenario.grid.cells.clone(),
            cell_size: scenario.grid.cell_size,
            nodes: reach::node_count(scenario),
            stored_nodes,
            bytes: (stored_nodes * scene.solver.bytes_per_node()) as f64,
        };
        let point_bytes: f64 = bodies
            .iter()
            .map(|body| body.bytes_per_particle * body.particles as f64)
            .sum();
        let largest = bodies.iter().map(|body| body.particles).max().unwrap_or(0);
        let sets: Vec<PointSet> = (0..scenario.bodies.len())
            .map(|body| body_points(scenario, body))
            .collect();
        let advice = advise(&Subject {
            scenario,
            sets: &sets,
            crossing_time: time_step.crossing_time,
            dt: time_step.dt,
        });
        let cost = cost(scenario, &mut scene, time_step.steps, &mut warnings);
        Plan {
            status: "ready",
            title: scenario.title.clone(),
            dimension: D,
            plane: plane(scenario),
            basis: scenario.method.basis.name(),
            transfer: scenario.method.transfer.name(),
            update: scenario.method.update.name(),
            frame: scenario.method.frame.name(),
            defaults: scenario
                .method
                .chosen
                .iter()
                .map(ToString::to_string)
                .collect(),
            particles,
            bytes_per_particle: point_bytes / particles.max(1) as f64,
            memory_bytes: point_bytes + SORT_BYTES * largest as f64 + grid.bytes,
            bodies,
            grid,
            time_step,
            output,
            cost,
            boundaries,
            loads,
            gravity: scenario.gravity.clone(),
            damping_rate: scenario.damping,
            probes: scenario.probes.iter().map(|p| p.name.clone()).collect(),
            warnings,
            advice,
        }
    }
}

fn plane(scenario: &Scenario) -> Option<&'static str> {
    match (scenario.dimension, scenario.plane) {
        (3, _) => None,
        (1, Plane::Stress) => Some("uniaxial stress"),
        (1, _) => Some("uniaxial strain"),
        (_, Plane::Strain) => Some("plane strain"),
        (_, Plane::Stress) => Some("plane stress"),
        (_, Plane::Axisymmetric) => Some("axisymmetric"),
    }
}

fn bodies<const D: usize>(scenario: &Scenario, scene: &Scene<D>) -> Vec<BodyPlan> {
    let plan = |(body, spec): (&crate::state::Body<D>, &crate::scenario::BodySpec)| {
        let material = &scenario.materials[spec.material];
        let bytes = body.particles.bytes_per_point() + body.material.bytes_per_point();
        BodyPlan {
            name: body.name.clone(),
            material: material.name.clone(),
            law: material.law.name(),
            density: material.density,
            particles: body.particles.len(),
            mass: body.totals().mass,
            bytes_per_particle: bytes as f64,
        }
    };
    scene
        .state
        .bodies
        .iter()
        .zip(&scenario.bodies)
        .map(plan)
        .collect()
}

fn place(on: &Region) -> String {
    match on {
        Region::Side(side) => format!("side {}", side.name()),
        Region::Box { .. } => "box".into(),
    }
}

fn boundaries(
    scenario: &Scenario,
    nodes: &[usize],
    warnings: &mut Vec<String>,
) -> Vec<BoundaryPlan> {
    let specs = scenario.boundaries.iter().zip(nodes);
    let plan = |(spec, &nodes): (&crate::scenario::BoundarySpec, &usize)| {
        if nodes == 0 {
            let then = match scenario.method.frame {
                ReferenceFrame::Updated => "it acts only once a body gets there",
                ReferenceFrame::Total => "in the total frame it never acts",
            };
            warnings.push(format!(
                "boundary \"{}\" holds no node that a body reaches at the start: {then}",
                spec.name
            ));
        }
        BoundaryPlan {
            name: spec.name.clone(),
            condition: spec.condition.name(),
            on: place(&spec.on),
            nodes,
        }
    };
    specs.map(plan).collect()
}

fn output<const D: usize>(scenario: &Scenario, scene: &Scene<D>) -> OutputPlan {
    let every = scenario.output.every;
    let mut rows = (scenario.end / every * (1.0 - 1e-9)).ceil() + 1.0;
    if let StepRule::Fixed(dt) = scenario.step {
        rows = rows.min((scenario.end / dt).ceil() + 1.0);
    }
    let columns: usize = scene.observers.iter().map(|o| o.header().len()).sum();
    OutputPlan {
        every,
        rows,
        tables: scene.observers.len(),
        bytes: rows * columns as f64 * NUMBER_BYTES,
    }
}

fn step<const D: usize>(scenario: &Scenario, scene: &Scene<D>) -> StepPlan {
    let limit = scene.solver.limit(&scene.state);
    let crossing_time = limit.crossing_time();
    let every = scenario.output.every.min(scenario.end);
    let (rule, given, dt, steps) = match scenario.step {
        StepRule::Fixed(dt) => {
            let steps = (scenario.end / dt * (1.0 - 1e-12)).ceil();
            ("fixed", dt, dt, steps)
        }
        StepRule::Courant(courant) => {
            // equal steps from one recorded row to the next
            let steps = (every / (courant * crossing_time) * (1.0 - 1e-12)).ceil();
            let steps = steps.max(1.0);
            let dt = every / steps;
            ("courant", courant, dt, (scenario.end / dt).round().max(1.0))
        }
    };
    StepPlan {
        rule,
        given,
        dt,
        crossing_time,
        ratio: dt / crossing_time,
        wave_speed: limit.wave_speed,
        particle_speed: limit.particle_speed,
        limited_by: if limit.particle_speed > limit.wave_speed {
            "particle speed"
        } else {
            "wave speed"
        },
        end: scenario.end,
        steps,
    }
}

/// Takes real steps for a moment.
fn cost<const D: usize>(
    scenario: &Scenario,
    scene: &mut Scene<D>,
    steps: f64,
    warnings: &mut Vec<String>,
) -> CostPlan {
    let Scene { state, solver, .. } = scene;
    let mut time_step = TimeStep::new(scenario.step, scenario.end);
    let mut started = Instant::now();
    let mut taken = 0;
    let mut spent = 0.0;
    while state.time < scenario.end && started.elapsed() < TRIAL {
        let every = scenario.output.every;
        let next = ((state.time / every * (1.0 + 1e-9)).floor() + 1.0) * every;
        let limit = solver.limit(state);
        let (dt, after) = time_step.next(state.time, next.min(scenario.end), &limit);
        if dt.is_nan() || dt <= 0.0 {
            break;
        }
        if let Err(fault) = solver.step(state, dt) {
            warnings.push(format!("a run of the first steps fails: {fault}"));
            break;
        }
        state.time = after;
        if taken == 0 && spent == 0.0 && started.elapsed() < TRIAL / 2 {
            // the first step takes memory that later ones have
            spent = started.elapsed().as_secs_f64();
            started = Instant::now();
            continue;
        }
        taken += 1;
    }
    let seconds = started.elapsed().as_secs_f64();
    let each = if taken > 0 {
        seconds / taken as f64
    } else {
        spent
    };
    CostPlan {
        threads: rayon::current_num_threads(),
        trial_steps: taken,
        seconds_per_step: each,
        nanoseconds_per_particle_step: 1e9 * each / state.point_count().max(1) as f64,
        expected_seconds: each * steps,
    }
}
