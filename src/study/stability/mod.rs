//! Where methods fail: each way of failing is one case, which says who fails at what parameter, and who survives.
//!
//! A case is one file and one line in [`FAILURES`]. Methods come from the registries of bases, transfers and updates, so that a
//! new one shows up in every map.

mod bar;
mod bisect;
mod findings;
mod measure;
mod method;
mod operator;

pub use findings::{Drawing, Findings, NamedTable, Row, Sense};
pub use measure::{ENERGY_GROWTH, Failed};
pub use method::Method;

use crate::study::validate::CaseError;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A way in which methods fail.
pub struct Failure {
    /// Its name on the command line.
    pub name: &'static str,
    /// What happens, in one line.
    pub title: &'static str,
    /// What is measured, and what of it counts as failed.
    pub measure: &'static str,
    /// Where the predicted edges come from.
    pub prediction: &'static str,
    /// Finds the edges.
    pub run: fn(&Study) -> Result<Findings, CaseError>,
}

macro_rules! failures {
    ($($case:ident),* $(,)?) => {
        $(mod $case;)*

        /// Every case, in the order in which a reader should meet them.
        pub const FAILURES: &[Failure] = &[$($case::FAILURE),*];
    };
}

failures! {
    courant,
    block,
    point,
    small_mass,
    drift,
    crossing,
    fracture,
    cpdi_shear,
    ringing,
    dissipation,
    galilei,
    spin,
    vortex,
    locking,
    jaumann,
    walls,
}

/// What a study is to go through, and whom it tells how far it is.
pub struct Study<'a> {
    /// Methods.
    pub methods: Vec<Method>,
    /// Points per cell; where a case is free to choose if there are none.
    pub points: Vec<u32>,
    /// Told how many of how many pieces of work are done, from any thread.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
}

impl Study<'_> {
    /// The points per cell asked for, or a case's own choice.
    fn points_or(&self, own: &[u32]) -> Vec<u32> {
        if self.points.is_empty() {
            own.to_vec()
        } else {
            self.points.clone()
        }
    }

    /// Does the same to every job, on as many threads as there are, and keeps their order.
    fn map<J: Sync, R: Send>(&self, jobs: &[J], work: impl Fn(&J) -> R + Sync) -> Vec<R> {
        let done = AtomicUsize::new(0);
        (self.progress)(0, jobs.len());
        jobs.par_iter()
            .map(|job| {
                let result = work(job);
                let count = done.fetch_add(1, Ordering::Relaxed) + 1;
                (self.progress)(count, jobs.len());
                result
            })
            .collect()
    }

    /// Every method with every number of points.
    fn with_points(&self, points: &[u32]) -> Vec<(Method, u32)> {
        let of = |method: &Method| points.iter().map(|n| (*method, *n)).collect::<Vec<_>>();
        self.methods.iter().flat_map(of).collect()
    }

    /// The methods of each frame that is asked for, with the ending of their pictures' names and of their titles.
    fn frames(&self) -> Vec<(&'static str, &'static str, Vec<Method>)> {
        [("", ""), ("total", " (total frame)")]
            .into_iter()
            .map(|(name, title)| {
                let of = self.methods.iter().copied();
                let of = of.filter(|method| method.is_total() == (name == "total"));
                (name, title, of.collect())
            })
            .filter(|(_, _, methods): &(_, _, Vec<Method>)| !methods.is_empty())
            .collect()
    }

    /// The methods, but those that differ in their frame only once: for what no frame can change.
    fn whatever_frame(&self) -> Vec<Method> {
        let mut once: Vec<Method> = Vec::new();
        for method in &self.methods {
            let same = |other: &Method| other.within_frame() == method.within_frame();
            if !once.iter().any(same) {
                once.push(*method);
            }
        }
        once
    }
}
