//! From a scenario to a finished run: builds the state, the solver and the observers, and drives them.
//!
//! Names become types here, once; below this file nothing knows a path or a name.

use crate::basis::{Basis, BasisVisitor};
use crate::grid::Geometry;
use crate::input::Variables;
use crate::material::Plane;
use crate::math::{Vector, packed_len};
use crate::observe::{
    BodyTable, EnergyTable, Frame, Observer, Point, ProbeTable, ReactionTable, Sink, View,
};
use crate::scenario::{LoadKind, LoadSpec, PointSet, ProbeTarget, Region, Scenario, body_points};
use crate::solver::{
    Account, Fault, Kernels, Load, LoadForce, Mpm, Setup, Solver, Stencils, TimeStep,
};
use crate::state::{Body, Particles, State};
use crate::transfer::{Transfer, TransferVisitor};
use serde::Serialize;
use std::io;
use std::time::{Duration, Instant};

/// Points below which threads cost more than they bring.
pub const PARALLEL_FROM: usize = 8_000;

/// Why a run ended early.
#[derive(Debug)]
pub enum RunError {
    /// The motion went wrong.
    Fault(Fault),
    /// A file could not be written.
    Io(io::Error),
    /// Somebody asked the run to stop.
    Interrupted,
}

impl std::fmt::Display for RunError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Fault(fault) => fault.fmt(f),
            Self::Io(error) => error.fmt(f),
            Self::Interrupted => write!(f, "the run was interrupted"),
        }
    }
}

impl std::error::Error for RunError {}

impl From<Fault> for RunError {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

impl From<io::Error> for RunError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Simulated time, s.
    pub time: f64,
    /// Simulated time at the end, s.
    pub end: f64,
    /// Steps taken.
    pub steps: u64,
    /// Size of the last step, s.
    pub dt: f64,
    /// Points.
    pub points: usize,
}

/// What a finished (or stopped) run has to say, as in `summary.json`.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Summary {
    /// "done", or why the run stopped.
    pub status: String,
    /// Title of the scenario.
    pub title: String,
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Points of all bodies.
    pub particles: usize,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time reached, s.
    pub time: f64,
    /// Simulated time asked for, s.
    pub end: f64,
    /// Smallest and largest step, s (the last step of a fixed-step run, which is cut to meet the end, not counted).
    pub dt: [f64; 2],
    /// Wall time of the run, s.
    pub wall_seconds: f64,
    /// Points times steps a second of wall time.
    pub particle_steps_per_second: f64,
    /// Largest memory of the process so far, bytes; 0 where the system does not tell.
    pub peak_memory: u64,
    /// Threads that the run could use.
    pub threads: usize,
    /// Energies at the end, J.
    pub energy: Energies,
    /// Largest |residual| of the energy account at a recorded time, over the largest energy turned over.
    pub worst_energy_residual: f64,
    /// Linear momentum of all bodies at the start and at the end, kg m/s.
    pub momentum: [Vec<f64>; 2],
    /// Steps that exceeded the stable one by the wave-speed estimate, with the largest excess as a ratio; null if none did.
    pub warning: Option<String>,
    /// Recorded rows in each table.
    pub rows: u64,
}

/// The energy account, J.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct Energies {
    pub kinetic: f64,
    pub elastic: f64,
    pub potential: f64,
    pub external_work: f64,
    pub boundary_work: f64,
    pub damping: f64,
    pub numerical: f64,
    pub total: f64,
    pub residual: f64,
    pub turned_over: f64,
}

impl From<&Account> for Energies {
    fn from(account: &Account) -> Self {
        Self {
            kinetic: account.stored.kinetic,
            elastic: account.stored.elastic,
            potential: account.stored.potential,
            external_work: account.external_work,
            boundary_work: account.boundary_work,
            damping: account.damping,
            numerical: account.numerical,
            total: account.total,
            residual: account.residual,
            turned_over: account.turned_over,
        }
    }
}

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
    /// Plain arithmetic even where the processor offers more.
    pub portable: bool,
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
    let solver = Box::new(if computing.portable {
        solver.portable()
    } else {
        solver
    });
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
    let volume: Vec<f64> = (0..count).map(|p| set.volume(p)).collect();
    let axisymmetric = scenario.plane == Plane::Axisymmetric;
    let affine = scenario.method.transfer.is_affine();
    let velocity = set.positions.iter().map(|&position| {
        let at = Variables {
            position,
            time: 0.0,
        };
        Vector::from_fn(|a, _| spec.velocity[a].value(&at))
    });
    Body {
        name: spec.name.clone(),
        particles: Particles {
            velocity: velocity.collect(),
            position: set
                .positions
                .iter()
                .map(|x| Vector::from_fn(|a, _| x[a]))
                .collect(),
            mass: volume
                .iter()
                .map(|volume| material.density * volume)
                .collect(),
            initial_volume: volume,
            stress: vec![0.0; count * packed_len(D)],
            affine: if affine {
                vec![nalgebra::zero(); count]
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
        material: material.law.points(scenario.plane, count),
        spacing: Vector::from_fn(|a, _| set.spacing[a]),
        density: material.density,
    }
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

struct WithBasis<'a, const D: usize> {
    scenario: &'a Scenario,
    state: &'a State<D>,
}

impl<const D: usize> BasisVisitor for WithBasis<'_, D> {
    type Output = Method<D>;

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) -> Self::Output {
        self.scenario
            .method
            .transfer
            .visit(WithTransfer::<D, N, B> { scene: self, basis })
    }
}

struct WithTransfer<'a, const D: usize, const N: usize, B> {
    scene: WithBasis<'a, D>,
    basis: B,
}

impl<const D: usize, const N: usize, B: Basis<N>> TransferVisitor for WithTransfer<'_, D, N, B> {
    type Output = Method<D>;

    fn visit<T: Transfer>(self, transfer: T) -> Self::Output {
        let WithBasis { scenario, state } = self.scene;
        let (basis, grid) = (self.basis, &scenario.grid);
        let min = Vector::from_fn(|a, _| grid.min[a]);
        let cells: [i32; D] = std::array::from_fn(|a| grid.cells[a]);
        let of_body = |body: &Body<D>| {
            std::array::from_fn(|a| basis.for_spacing(body.spacing[a] / grid.cell_size))
        };
        Method {
            geometry: Geometry::new(min, grid.cell_size, cells, &basis),
            kernels: Box::new(Stencils::<D, N, B, T> {
                nodes: basis,
                basis: state.bodies.iter().map(of_body).collect(),
                transfer,
            }),
        }
    }
}

/// What depends on the types of the basis and the transfer.
struct Method<const D: usize> {
    geometry: Geometry<D>,
    kernels: Box<dyn Kernels<D>>,
}

fn build_solver<const D: usize>(
    scenario: &Scenario,
    state: &State<D>,
    sets: &[PointSet],
    parallel: bool,
) -> Mpm<D> {
    let method = scenario.method.basis.visit(WithBasis { scenario, state });
    Mpm::new(Setup {
        geometry: method.geometry,
        kernels: method.kernels,
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
            .map(|spec| load(spec, state, sets))
            .collect(),
        parallel,
    })
}

/// The box of positions of a region of nodes.
fn region<const D: usize>(on: &Region, grid: &crate::scenario::GridSpec) -> (Vector<D>, Vector<D>) {
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

fn load<const D: usize>(spec: &LoadSpec, state: &State<D>, sets: &[PointSet]) -> Load<D> {
    let set = &sets[spec.body];
    let chosen = set.selected(&spec.on);
    let particles = &state.bodies[spec.body].particles;
    let factor = spec.factor.clone();
    let factor = Box::new(move |time| match &factor {
        Some(factor) => factor.value(&Variables {
            position: [0.0; 3],
            time,
        }),
        None => 1.0,
    });
    let forces = |force: &dyn Fn(usize) -> Vector<D>| chosen.iter().map(|&p| force(p)).collect();
    let points = chosen.iter().map(|&p| p as u32).collect();
    let forces: Vec<Vector<D>> = match &spec.kind {
        LoadKind::Acceleration(field) => {
            let field = field.clone();
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
            return Load {
                body: spec.body,
                points,
                force,
            };
        }
        LoadKind::Force(total) => {
            let mass: f64 = chosen.iter().map(|&p| particles.mass[p]).sum();
            forces(&|p| Vector::from_fn(|a, _| total[a] * particles.mass[p] / mass))
        }
        LoadKind::Traction { traction, side } => {
            forces(&|p| Vector::from_fn(|a, _| traction[a] * set.side_area(p, *side)))
        }
        LoadKind::Pressure { pressure, side } => forces(&|p| {
            let inward = if side.upper { -1.0 } else { 1.0 };
            let mut force = Vector::zeros();
            force[side.axis] = inward * pressure * set.side_area(p, *side);
            force
        }),
    };
    Load {
        body: spec.body,
        points,
        force: LoadForce::Forces(forces, factor),
    }
}

/// Runs a scene to its end, recording into `sink` and telling `monitor` how far it is about ten times a second; a monitor that
/// returns false stops the run.
///
/// # Errors
/// If the motion goes wrong, a row cannot be written, or the monitor stops the run. The summary tells how far it came.
pub fn drive<const D: usize>(
    scenario: &Scenario,
    scene: &mut Scene<D>,
    sink: &mut dyn Sink,
    monitor: &mut dyn FnMut(&Progress) -> bool,
) -> (Summary, Result<(), RunError>) {
    let started = Instant::now();
    let mut summary = Summary {
        title: scenario.title.clone(),
        dimension: D,
        particles: scene.state.point_count(),
        end: scenario.end,
        dt: [f64::INFINITY, 0.0],
        threads: rayon::current_num_threads(),
        ..Summary::default()
    };
    let mut result = advance(scenario, scene, sink, monitor, &mut summary);
    if let Err(error) = sink.flush()
        && result.is_ok()
    {
        result = Err(error.into());
    }
    summary.status = match &result {
        Ok(()) => "done".into(),
        Err(error) => error.to_string(),
    };
    summary.time = scene.state.time;
    summary.steps = scene.state.step;
    summary.wall_seconds = started.elapsed().as_secs_f64();
    summary.particle_steps_per_second =
        summary.particles as f64 * summary.steps as f64 / summary.wall_seconds.max(1e-9);
    summary.peak_memory = peak_memory();
    (summary, result)
}

fn advance<const D: usize>(
    scenario: &Scenario,
    scene: &mut Scene<D>,
    sink: &mut dyn Sink,
    monitor: &mut dyn FnMut(&Progress) -> bool,
    summary: &mut Summary,
) -> Result<(), RunError> {
    let Scene {
        state,
        solver,
        observers,
    } = scene;
    for observer in observers.iter() {
        sink.open(&observer.name(), &observer.header())?;
    }
    solver.start(state)?;
    summary.momentum[0] = momentum(state);
    record(state, solver.as_ref(), observers, sink, summary)?;
    let mut time_step = TimeStep::new(scenario.step, scenario.end);
    let mut monitoring = Pace::new();
    let (mut records, mut excess) = (0_u64, 0.0_f64);
    while state.time < scenario.end {
        let planned = planned(scenario, records + 1);
        let limit = solver.limit(state);
        let (dt, after) = time_step.next(state.time, planned, &limit);
        // also true if dt is not a number
        if !(dt > 1e-15 * scenario.end) {
            return Err(Fault::Collapsed {
                time: state.time,
                step: state.step,
                dt,
            }
            .into());
        }
        excess = excess.max(dt / limit.crossing_time());
        solver.step(state, dt)?;
        state.time = after;
        if after < scenario.end || summary.dt[1] == 0.0 {
            summary.dt = [summary.dt[0].min(dt), summary.dt[1].max(dt)];
        }
        if time_step.reached(state.time, dt, planned) {
            records += 1;
            while self::planned(scenario, records + 1) <= state.time
                && self::planned(scenario, records + 1) < scenario.end
            {
                records += 1;
            }
            record(state, solver.as_ref(), observers, sink, summary)?;
        }
        if monitoring.due(state.step) {
            let progress = Progress {
                time: state.time,
                end: scenario.end,
                steps: state.step,
                dt,
                points: summary.particles,
            };
            sink.flush()?;
            if !monitor(&progress) {
                return Err(RunError::Interrupted);
            }
        }
    }
    summary.momentum[1] = momentum(state);
    if let crate::scenario::StepRule::Fixed(dt) = scenario.step
        && excess > 1.0
    {
        summary.warning = Some(format!(
            "the fixed step of {dt:e} s was up to {excess:.2} times the time in which the fastest signal crosses a cell"
        ));
    }
    Ok(())
}

/// The time of record number `index`, s.
fn planned(scenario: &Scenario, index: u64) -> f64 {
    let time = index as f64 * scenario.output.every;
    if time >= scenario.end * (1.0 - 1e-9) {
        scenario.end
    } else {
        time
    }
}

/// All points, in the order in which their bodies were filled.
fn frame<const D: usize>(state: &State<D>) -> Frame {
    let mut points = Vec::with_capacity(state.point_count());
    for (index, body) in state.bodies.iter().enumerate() {
        let first = points.len();
        let p = &body.particles;
        for row in 0..p.len() {
            let stress = body.cauchy_stress(row);
            let mut point = Point {
                body: index,
                id: p.id[row],
                mass: p.mass[row],
                initial_volume: p.initial_volume[row],
                volume_ratio: body.material.volume_ratio(row, p.hoop_stretch(row)),
                ..Point::default()
            };
            for a in 0..D {
                point.position[a] = p.position[row][a];
                point.velocity[a] = p.velocity[row][a];
                for b in 0..D {
                    point.stress[a][b] = stress[(a, b)];
                }
            }
            if let Some(hoop) = p.hoop_stress.get(row) {
                point.stress[2][2] = hoop / point.volume_ratio;
            }
            points.push(point);
        }
        points[first..].sort_by_key(|point| point.id);
    }
    Frame {
        time: state.time,
        points,
    }
}

fn momentum<const D: usize>(state: &State<D>) -> Vec<f64> {
    let total: Vector<D> = state.bodies.iter().map(|body| body.totals().momentum).sum();
    total.iter().copied().collect()
}

fn record<const D: usize>(
    state: &State<D>,
    solver: &dyn Solver<D>,
    observers: &[Box<dyn Observer<D>>],
    sink: &mut dyn Sink,
    summary: &mut Summary,
) -> Result<(), RunError> {
    let account = solver.ledger().account(solver.stored(state));
    let spin: Vec<Vec<f64>> = (0..state.bodies.len())
        .map(|body| solver.angular_momentum(state, body))
        .collect();
    let view = View {
        state,
        account,
        ledger: solver.ledger(),
        spin: &spin,
    };
    for observer in observers {
        sink.row(&observer.name(), &observer.row(&view))?;
    }
    if sink.wants_frames() {
        sink.frame(frame(state))?;
    }
    summary.rows += 1;
    summary.energy = Energies::from(&account);
    let relative = account.residual.abs() / account.turned_over.max(f64::MIN_POSITIVE);
    summary.worst_energy_residual = summary.worst_energy_residual.max(relative);
    Ok(())
}

/// Decides when a tenth of a second has passed without looking at the clock every step.
struct Pace {
    last: Instant,
    interval: u64,
    next: u64,
}

impl Pace {
    fn new() -> Self {
        Self {
            last: Instant::now(),
            interval: 1,
            next: 1,
        }
    }

    fn due(&mut self, step: u64) -> bool {
        if step < self.next {
            return false;
        }
        let elapsed = self.last.elapsed();
        if elapsed < Duration::from_millis(50) {
            self.interval = (self.interval * 2).min(1 << 20);
        } else if elapsed > Duration::from_millis(200) {
            self.interval = (self.interval / 2).max(1);
        }
        self.next = step + self.interval;
        if elapsed < Duration::from_millis(100) {
            return false;
        }
        self.last = Instant::now();
        true
    }
}

/// Largest memory of this process so far, bytes; 0 where the system does not tell.
pub fn peak_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| {
        line.trim()
            .trim_end_matches("kB")
            .trim()
            .parse::<u64>()
            .ok()
    });
    kibibytes.unwrap_or(0) * 1024
}
