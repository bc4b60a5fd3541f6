//! Speed charted against accuracy: what a digit of accuracy costs, over methods, resolutions and time steps.
//!
//! A [`Subject`] says what a run should have given; [`AXES`] what is varied; [`trial`] runs one setting, [`frontier`] picks
//! what nothing beats, [`series`] measures orders of convergence. It knows no terminal and no folder.

mod axes;
mod cost;
mod frontier;
mod orders;
mod picture;
mod signals;
mod subject;
mod sweep;
mod trial;

pub use axes::{AXES, Axis, Place, Setting, Sweep, Value, Values};
pub use cost::{passes, stencil_nodes, tensor_visits, term_passes, work};
pub use frontier::{frontier, median, order};
pub use orders::{Series, best_updates, local_order, series};
pub use picture::{label, picture};
pub use subject::{FileSubject, Subject};
pub use sweep::{default_sweep, quick};
pub use trial::{Status, Trial, trial};

use crate::scenario::{InputError, Scenario};

/// What is paid for accuracy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    /// Seconds on this machine.
    Wall,
    /// Times that a point meets a node, on any machine.
    Work,
}

impl Cost {
    /// Of a trial.
    pub fn of(self, trial: &Trial) -> f64 {
        match self {
            Self::Wall => trial.wall,
            Self::Work => trial.work,
        }
    }
}

/// A finished chart.
pub struct Chart {
    /// What was run.
    pub subject: Subject,
    /// Every run, in the order of the sweep.
    pub trials: Vec<Trial>,
}

/// How far a chart is: runs done, runs in all, seconds left at the pace so far.
pub type Watcher<'a> = &'a mut (dyn FnMut(usize, usize, f64) + Send);

impl Chart {
    /// Runs every setting. `found` gets each trial as it is done.
    pub fn draw(
        subject: Subject,
        settings: &[(Setting, Scenario)],
        repeats: u32,
        watch: Watcher<'_>,
        found: &mut (dyn FnMut(&Trial) + Send),
    ) -> Self {
        let promised: Vec<f64> = settings
            .iter()
            .map(|(_, scenario)| trial::planned_work(scenario))
            .collect();
        let all: f64 = promised.iter().sum();
        let (mut done, started) = (0.0, std::time::Instant::now());
        let mut trials = Vec::new();
        for (i, (setting, scenario)) in settings.iter().enumerate() {
            let trial = trial(&subject, setting, scenario, repeats);
            found(&trial);
            trials.push(trial);
            done += promised[i];
            let left = started.elapsed().as_secs_f64() * (all - done) / done.max(1.0);
            watch(i + 1, settings.len(), left);
        }
        Self { subject, trials }
    }

    /// Indices of what nothing beats, from cheap to dear.
    pub fn frontier(&self, cost: Cost) -> Vec<usize> {
        self.frontier_of(cost, |_| true)
    }

    /// Indices of what nothing beats among some of the runs, from cheap to dear.
    pub fn frontier_of(&self, cost: Cost, among: impl Fn(&Trial) -> bool) -> Vec<usize> {
        let point = |trial: &Trial| match trial.status {
            Status::Done if among(trial) => (cost.of(trial), trial.error),
            _ => (f64::NAN, f64::NAN),
        };
        frontier(&self.trials.iter().map(point).collect::<Vec<_>>())
    }

    /// The cheapest run with an error of at most this.
    pub fn cheapest(&self, cost: Cost, tolerance: f64) -> Option<&Trial> {
        self.cheapest_of(cost, tolerance, |_| true)
    }

    /// The cheapest of some of the runs with an error of at most this.
    pub fn cheapest_of(
        &self,
        cost: Cost,
        tolerance: f64,
        among: impl Fn(&Trial) -> bool,
    ) -> Option<&Trial> {
        let best = self.frontier_of(cost, among);
        let mut best = best.into_iter().map(|i| &self.trials[i]);
        best.find(|trial| trial.error <= tolerance)
    }

    /// Smallest error of all that was done.
    pub fn best_error(&self) -> f64 {
        let done = self.trials.iter().filter(|t| t.status == Status::Done);
        done.map(|t| t.error).fold(f64::INFINITY, f64::min)
    }
}

/// The scenario of each setting, or everything that is wrong with them, each problem once.
///
/// # Errors
/// If a setting does not fit the scene.
pub fn scenarios(
    subject: &Subject,
    settings: Vec<Setting>,
) -> Result<Vec<(Setting, Scenario)>, Vec<InputError>> {
    let (mut good, mut wrong) = (Vec::new(), Vec::<InputError>::new());
    for setting in settings {
        match subject.scenario(&setting) {
            Ok(scenario) => good.push((setting, scenario)),
            Err(error) if !wrong.contains(&error) => wrong.push(error),
            Err(_) => {}
        }
    }
    if wrong.is_empty() {
        Ok(good)
    } else {
        Err(wrong)
    }
}
