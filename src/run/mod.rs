//! From a scenario to a finished run: builds the state, the solver and the observers, and drives them.
//!
//! Names become types here, once; below this folder nothing knows a path or a name.

mod build;
mod method;
mod summary;

pub use build::{Computing, PARALLEL_FROM, Scene, SceneVisitor, build, build_with, with_scene};
pub use summary::{Energies, Progress, Summary, memory_now, peak_memory};

use crate::math::Vector;
use crate::observe::{Frame, Observer, Point, Sink, View};
use crate::scenario::{Scenario, StepRule};
use crate::solver::{Fault, Solver, TimeStep};
use crate::state::{Body, State};
use crate::totals::Totals;
use std::io;
use std::time::{Duration, Instant};

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
    summary.momentum[0] = momentum(&totals(state));
    record(state, solver.as_ref(), observers, sink, summary)?;
    let mut time_step = TimeStep::new(scenario.step, scenario.end);
    let mut monitoring = Pace::new();
    let (mut records, mut excess) = (0_u64, 0.0_f64);
    while state.time < scenario.end {
        let planned = planned(scenario, records + 1);
        let limit = solver.limit(state);
        let (dt, after) = time_step.next(state.time, planned, &limit);
        if dt.is_nan() || dt <= 1e-15 * scenario.end {
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
    let gained = -summary.energy.numerical / summary.energy.turned_over.max(f64::MIN_POSITIVE);
    if gained > 0.05 {
        summary.warning = Some(format!(
            "the method added {:.0} % of the energy turned over: take a smaller time step, more cells or another method",
            100.0 * gained
        ));
    }
    if let StepRule::Fixed(dt) = scenario.step
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
                initial_volume: p.mass.initial_volume(row),
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

/// Linear momentum of all bodies, kg m/s.
fn momentum<const D: usize>(totals: &[Totals<D>]) -> Vec<f64> {
    let sum: Vector<D> = totals.iter().map(|body| body.momentum).sum();
    sum.iter().copied().collect()
}

/// The sums of every body.
fn totals<const D: usize>(state: &State<D>) -> Vec<Totals<D>> {
    state.bodies.iter().map(Body::totals).collect()
}

fn record<const D: usize>(
    state: &State<D>,
    solver: &dyn Solver<D>,
    observers: &[Box<dyn Observer<D>>],
    sink: &mut dyn Sink,
    summary: &mut Summary,
) -> Result<(), RunError> {
    let totals = totals(state);
    let account = solver.ledger().account(solver.stored(&totals));
    let spin: Vec<Vec<f64>> = (0..state.bodies.len())
        .map(|body| solver.angular_momentum(state, body))
        .collect();
    let view = View {
        state,
        account,
        ledger: solver.ledger(),
        spin: &spin,
        totals: &totals,
    };
    for observer in observers {
        sink.row(&observer.name(), &observer.row(&view))?;
    }
    if sink.wants_frames() {
        sink.frame(frame(state))?;
    }
    summary.rows += 1;
    summary.recorded = state.time;
    summary.momentum[1] = momentum(&totals);
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
