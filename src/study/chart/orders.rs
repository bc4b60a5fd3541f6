//! How fast the error of each method falls with the cells, beside what is expected.

use super::frontier::order;
use super::trial::{Status, Trial};
use super::{Setting, Subject};
use crate::study::validate::Expected;

/// Runs that differ in their cells only, coarsest first.
#[derive(Clone, Debug)]
pub struct Series {
    /// The setting of the coarsest.
    pub setting: Setting,
    /// Cells of those that were done.
    pub cells: Vec<f64>,
    /// Their errors.
    pub errors: Vec<f64>,
    /// Runs of the series that were not done.
    pub failed: usize,
    /// Between the last two grids; NaN if one of them failed.
    pub last: f64,
    /// Of the least-squares line through all that were done.
    pub fit: f64,
    /// What theory or a publication gives.
    pub expected: Option<Expected>,
}

/// The series of all trials, in their order.
pub fn series(subject: &Subject, trials: &[Trial]) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    let mut done: Vec<bool> = vec![false; trials.len()];
    for first in 0..trials.len() {
        if done[first] {
            continue;
        }
        let mut members: Vec<&Trial> = Vec::new();
        for (i, trial) in trials.iter().enumerate().skip(first) {
            if trial
                .setting
                .agrees_but_for(&trials[first].setting, "cells")
            {
                done[i] = true;
                members.push(trial);
            }
        }
        members.sort_by_key(|trial| trial.setting.count("cells"));
        all.push(one(subject, &members));
    }
    all
}

fn one(subject: &Subject, members: &[&Trial]) -> Series {
    let good: Vec<&&Trial> = members
        .iter()
        .filter(|trial| trial.status == Status::Done)
        .collect();
    let cells: Vec<f64> = good.iter().map(|t| t.setting.number("cells")).collect();
    let errors: Vec<f64> = good.iter().map(|t| t.error).collect();
    let two = &members[members.len().saturating_sub(2)..];
    let finest = two.iter().all(|trial| trial.status == Status::Done);
    let tail = cells.len().saturating_sub(2);
    Series {
        setting: members[0].setting.clone(),
        failed: members.len() - good.len(),
        last: if finest {
            order(&cells[tail..], &errors[tail..])
        } else {
            f64::NAN
        },
        fit: order(&cells, &errors),
        cells,
        errors,
        expected: expected(subject, &members[0].setting),
    }
}

/// What is known of a method on this subject; nothing of PIC, whose damping depends on the step and on the cells at once, and
/// nothing of cell crossing in the total Lagrangian frame, which has none.
fn expected(subject: &Subject, setting: &Setting) -> Option<Expected> {
    let Subject::Problem(problem) = subject else {
        return None;
    };
    let name = |axis: &str| setting.get(axis).to_string();
    let basis = name("basis");
    let known = problem.expected.iter().find(|e| e.basis == basis).copied();
    match (name("transfer").as_str(), name("update").as_str()) {
        ("pic", _) => None,
        _ if name("frame") == "total" && known.is_some_and(|known| known.order == 0.0) => None,
        (_, "usf") => known.filter(|known| known.order > 1.0).map(|known| Expected {
            order: 1.0,
            source: "expected: first order in time, stresses start half a step beside velocities",
            ..known
        }),
        _ => known,
    }
}

/// Of each frame, basis and transfer the update with the smallest error on the finest grid, where points are most and steps smallest,
/// so that the cells are what limits it.
pub fn best_updates(all: &[Series]) -> Vec<&Series> {
    let most = |f: &dyn Fn(&Series) -> f64| all.iter().map(f).fold(f64::NEG_INFINITY, f64::max);
    let points = most(&|series| series.setting.number("points"));
    let courant = -most(&|series| -series.setting.number("courant"));
    let rank = |series: &Series| {
        let error = series.errors.last().copied().unwrap_or(f64::INFINITY);
        (series.failed, error)
    };
    let mut best: Vec<&Series> = Vec::new();
    let limited = |s: &&Series| {
        s.setting.number("points") == points && s.setting.number("courant") == courant
    };
    for series in all.iter().filter(limited) {
        let same = |known: &&mut &Series| {
            let name = |axis: &str| known.setting.get(axis) == series.setting.get(axis);
            name("frame") && name("basis") && name("transfer") && name("dimensions")
        };
        match best.iter_mut().find(same) {
            Some(known) => {
                if rank(series).partial_cmp(&rank(known)) == Some(std::cmp::Ordering::Less) {
                    *known = series;
                }
            }
            None => best.push(series),
        }
    }
    best
}

/// The order between a trial and the one next coarser that differs in its cells only; NaN if there is none.
pub fn local_order(trials: &[Trial], index: usize) -> f64 {
    let trial = &trials[index];
    let cells = trial.setting.count("cells");
    let coarser = trials
        .iter()
        .filter(|other| {
            other.status == Status::Done
                && other.setting.count("cells") < cells
                && other.setting.agrees_but_for(&trial.setting, "cells")
        })
        .max_by_key(|other| other.setting.count("cells"));
    match coarser {
        Some(other) if trial.status == Status::Done => {
            let counts = [other.setting.number("cells"), trial.setting.number("cells")];
            order(&counts, &[other.error, trial.error])
        }
        _ => f64::NAN,
    }
}
