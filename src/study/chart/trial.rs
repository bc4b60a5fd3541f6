//! One setting: run, measured, and timed.

use super::axes::{Setting, names_of};
use super::cost::work;
use super::frontier::median;
use super::subject::{Nowhere, Subject, run};
use crate::run::{RunError, Scene, SceneVisitor, build, with_scene};
use crate::scenario::{Scenario, StepRule};
use serde::Serialize;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It reached its end with an error below 1.
    Done,
    /// It reached its end, and is as wrong as no motion at all or worse.
    Unstable,
    /// It could not go on.
    Failed,
}

impl Status {
    /// As in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Unstable => "unstable",
            Self::Failed => "failed",
        }
    }
}

/// What became of a setting.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The setting.
    pub setting: Setting,
    /// Whether its method is the one that this scene gets if its file names none.
    pub default: bool,
    /// How it ended.
    pub status: Status,
    /// Why it failed; empty if it did not.
    pub message: String,
    /// In the norm of the subject, relative; NaN if it failed.
    pub error: f64,
    /// Wall time without building the scene, s: the median of the repeats, of a failed run that of the only one.
    pub wall: f64,
    /// Times that a point met a node (see [`super::work`]).
    pub work: f64,
    /// Points.
    pub particles: usize,
    /// Steps taken.
    pub steps: u64,
    /// Largest step, s.
    pub dt: f64,
    /// Edge of a cell, m.
    pub cell_size: f64,
}

/// A run that takes so many times the steps that its first step promised has blown up.
const MOST_STEPS: f64 = 10.0;

/// Runs a setting once for its error, and `repeats` times for its wall time.
pub fn trial(subject: &Subject, setting: &Setting, scenario: &Scenario, repeats: u32) -> Trial {
    let most_steps = (MOST_STEPS * planned_steps(scenario)).ceil() as u64;
    let (summary, result, error) = subject.measure(scenario, most_steps);
    let message = match &result {
        Ok(()) => String::new(),
        Err(RunError::Interrupted) => format!(
            "the body blew up: more than {MOST_STEPS} times the steps that the first one promised"
        ),
        Err(error) => error.to_string(),
    };
    let status = match result {
        Err(_) => Status::Failed,
        Ok(()) if error < 1.0 => Status::Done,
        Ok(()) => Status::Unstable,
    };
    let mut wall = summary.wall_seconds;
    if status == Status::Done {
        let once = |_| run(scenario, &mut Nowhere, &mut |_| true).0.wall_seconds;
        wall = median(&(0..repeats.max(1)).map(once).collect::<Vec<f64>>());
    }
    Trial {
        setting: setting.clone(),
        default: has_default_method(setting, scenario),
        status,
        message,
        error,
        wall,
        work: work(scenario, summary.particles, summary.steps),
        particles: summary.particles,
        steps: summary.steps,
        dt: if summary.dt[1] > 0.0 {
            summary.dt[1]
        } else {
            f64::NAN
        },
        cell_size: scenario.grid.cell_size,
    }
}

fn has_default_method(setting: &Setting, scenario: &Scenario) -> bool {
    scenario.default_method().is_some_and(|method| {
        let mut own = names_of(&method).into_iter();
        own.all(|(axis, name)| setting.get(axis) == name)
    })
}

/// Steps that the step at the start promises, and those of one recorded row at least.
pub(super) fn planned_steps(scenario: &Scenario) -> f64 {
    struct Limit<'a>(&'a Scenario);
    impl SceneVisitor for Limit<'_> {
        type Output = f64;

        fn visit<const D: usize>(self, mut scene: Scene<D>) -> f64 {
            match scene.solver.start(&mut scene.state) {
                Ok(()) => scene.solver.limit(&scene.state).crossing_time(),
                Err(_) => self.0.end,
            }
        }
    }
    let courant = match scenario.step {
        StepRule::Courant(courant) => courant,
        StepRule::Fixed(dt) => return (scenario.end / dt).ceil(),
    };
    let rows = (scenario.end / scenario.output.every).ceil();
    let crossing = with_scene(scenario, Limit(scenario));
    (scenario.end / (courant * crossing)).max(rows)
}

/// Work that a setting promises, for a guess of the time left.
pub(super) fn planned_work(scenario: &Scenario) -> f64 {
    let points: u64 = match scenario.dimension {
        1 => build::<1>(scenario).state.point_count() as u64,
        2 => build::<2>(scenario).state.point_count() as u64,
        _ => build::<3>(scenario).state.point_count() as u64,
    };
    // what a step costs beside its points, in units of a point and node
    let steps = planned_steps(scenario);
    work(scenario, points as usize, steps as u64) + 300.0 * steps
}
