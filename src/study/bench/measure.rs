//! Times real steps of one case.

use super::{Bandwidth, BenchError, Case, Order, traffic};
use crate::reorder;
use crate::run::{Scene, SceneVisitor, memory_now, peak_memory, with_scene};
use crate::scenario::Scenario;
use crate::solver::{Fault, TimeStep};
use crate::state::State;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// How much is done for one row.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Effort {
    /// Timings whose median counts.
    pub repeats: usize,
    /// What all timings of a row should take together, s; each has one step at least.
    pub seconds: f64,
    /// Steps of a timing, if that is not for `seconds` to say.
    pub steps: Option<u64>,
}

/// What was measured of one case.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Row {
    /// What was asked for, with the number of points that there were.
    #[serde(flatten)]
    pub case: Case,
    /// Time per point and step, ns: the median of the repeats.
    pub nanoseconds: f64,
    /// The fastest repeat, ns.
    pub fastest: f64,
    /// The slowest repeat, ns.
    pub slowest: f64,
    /// Points times steps a second, at the median.
    pub particle_steps_per_second: f64,
    /// Steps of one repeat.
    pub steps: u64,
    /// Repeats.
    pub repeats: usize,
    /// The first sort and the look at all points before the first step, ns a point.
    pub start_nanoseconds: f64,
    /// Bytes of a point's columns and of what its law remembers, counted.
    pub bytes_per_particle: f64,
    /// What the memory of the process grew by at most, bytes a point: points, nodes and all else; 0 where the system does not tell.
    pub memory_per_particle: f64,
    /// Stored nodes a point.
    pub nodes_per_particle: f64,
    /// Bytes that a step has to move for each point.
    pub floor_bytes: f64,
    /// The time that this takes at the measured bandwidth, ns.
    pub floor_nanoseconds: Option<f64>,
    /// Floor / measured.
    pub share_of_floor: Option<f64>,
}

impl Row {
    /// Sets what the bandwidth of as many threads says of this row.
    pub fn compare(&mut self, bandwidths: &[Bandwidth]) {
        let own = bandwidths.iter().find(|b| b.threads == self.case.threads);
        self.floor_nanoseconds = own.map(|b| self.floor_bytes / b.best());
        self.share_of_floor = self.floor_nanoseconds.map(|floor| floor / self.nanoseconds);
    }
}

/// Steps before the first timed one: they take memory, fill caches and wake threads.
const WARM_UP: u64 = 3;

/// Measures a case. The memory is true only for the first case that a process measures.
///
/// # Errors
/// If the case makes no scenario, its motion goes wrong, or there are no threads to be had.
pub fn measure(case: &Case, effort: &Effort) -> Result<Row, BenchError> {
    let scenario = case.scenario()?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(case.threads)
        .build()
        .map_err(BenchError::Threads)?;
    let visitor = Measuring {
        case,
        effort,
        scenario: &scenario,
        before: memory_now(),
    };
    pool.install(|| with_scene(&scenario, visitor))
        .map_err(BenchError::Fault)
}

struct Measuring<'a> {
    case: &'a Case,
    effort: &'a Effort,
    scenario: &'a Scenario,
    /// Memory of the process before the scene was built, bytes.
    before: u64,
}

impl SceneVisitor for Measuring<'_> {
    type Output = Result<Row, Fault>;

    fn visit<const D: usize>(self, mut scene: Scene<D>) -> Self::Output {
        if self.case.order == Order::Random {
            shuffle(&mut scene.state);
        }
        let count = scene.state.point_count() as f64;
        let started = Instant::now();
        scene.solver.start(&mut scene.state)?;
        let start = started.elapsed().as_secs_f64();
        let mut time_step = TimeStep::new(self.scenario.step, self.scenario.end);
        let mut steps = |scene: &mut Scene<D>, count: u64| -> Result<f64, Fault> {
            let started = Instant::now();
            for _ in 0..count {
                let limit = scene.solver.limit(&scene.state);
                let now = scene.state.time;
                let (dt, after) = time_step.next(now, self.scenario.end, &limit);
                scene.solver.step(&mut scene.state, dt)?;
                scene.state.time = after;
            }
            Ok(started.elapsed().as_secs_f64())
        };
        steps(&mut scene, WARM_UP)?;
        // short steps are tried for longer, so that one look at the clock does not decide
        let mut each = steps(&mut scene, 1)?;
        if each < 1e-3 {
            let trial = (2e-3 / each.max(1e-7)).ceil();
            each = steps(&mut scene, trial as u64)? / trial;
        }
        let repeats = self.effort.repeats.max(1);
        let share = self.effort.seconds / repeats as f64;
        let allowed = (share / each).round() as u64;
        let taken = self.effort.steps.unwrap_or(allowed).max(1);
        let mut times = Vec::with_capacity(repeats);
        for _ in 0..repeats {
            times.push(1e9 * steps(&mut scene, taken)? / (taken as f64 * count));
        }
        times.sort_unstable_by(f64::total_cmp);
        let nanoseconds = median(&times);
        let body = &scene.state.bodies[0];
        let bytes = body.particles.bytes_per_point() + body.material.bytes_per_point();
        let floor = traffic(self.scenario, &scene.state, scene.solver.bytes_per_node());
        let grown = peak_memory().saturating_sub(self.before);
        Ok(Row {
            case: Case {
                particles: scene.state.point_count(),
                ..self.case.clone()
            },
            nanoseconds,
            fastest: times[0],
            slowest: times[repeats - 1],
            particle_steps_per_second: 1e9 / nanoseconds,
            steps: taken,
            repeats,
            start_nanoseconds: 1e9 * start / count,
            bytes_per_particle: bytes as f64,
            memory_per_particle: grown as f64 / count,
            nodes_per_particle: scene.solver.stored_nodes() as f64 / count,
            floor_bytes: floor.total(),
            floor_nanoseconds: None,
            share_of_floor: None,
        })
    }
}

/// The middle one of sorted numbers, or the mean of the two in the middle.
fn median(sorted: &[f64]) -> f64 {
    let (low, high) = ((sorted.len() - 1) / 2, sorted.len() / 2);
    0.5 * (sorted[low] + sorted[high])
}

/// Puts the points of each body into an order that has nothing to do with where they are, always the same one.
fn shuffle<const D: usize>(state: &mut State<D>) {
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    for body in &mut state.bodies {
        let mut order: Vec<u32> = (0..body.particles.len() as u32).collect();
        for last in (1..order.len()).rev() {
            // xorshift64*
            random ^= random >> 12;
            random ^= random << 25;
            random ^= random >> 27;
            let number = random.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32;
            order.swap(last, ((number * (last as u64 + 1)) >> 32) as usize);
        }
        let (mut walk, mut leaders) = (Vec::new(), Vec::new());
        reorder::cycles(&mut order, &mut walk, &mut leaders);
        body.particles.permute(&walk, &leaders, false);
        body.material.permute(&walk, &leaders);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(&[3.0]), 3.0);
        assert_eq!(median(&[1.0, 2.0]), 1.5);
        assert_eq!(median(&[1.0, 2.0, 9.0]), 2.0);
    }

    #[test]
    fn every_dimension_and_order_can_be_measured() {
        for dimension in 1..=3 {
            for order in [Order::Lattice, Order::Random] {
                let case = Case {
                    dimension,
                    basis: "quadratic".into(),
                    transfer: "apic".into(),
                    update: "usl".into(),
                    law: "neo_hookean".into(),
                    particles: 2_000,
                    order,
                    threads: 2,
                };
                let effort = Effort {
                    repeats: 3,
                    seconds: 0.01,
                    steps: None,
                };
                let row = measure(&case, &effort).unwrap_or_else(|error| panic!("{error}"));
                assert!(row.fastest > 0.0 && row.fastest <= row.nanoseconds);
                assert!(row.nanoseconds <= row.slowest);
                assert!(row.floor_bytes > row.bytes_per_particle);
            }
        }
    }
}
