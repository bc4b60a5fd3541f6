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

#[cfg(test)]
mod tests {
    use super::super::axes::{Value, axis};
    use super::*;
    use crate::study::validate::PROBLEMS;

    /// A setting of the case "manufactured", with two points a cell.
    fn setting(method: [&'static str; 4], courant: f64, cells: u32) -> Setting {
        let [frame, basis, transfer, update] = method.map(Value::Name);
        let mut values = vec![Value::Count(1); 8];
        for (name, value) in [
            ("frame", frame),
            ("basis", basis),
            ("transfer", transfer),
            ("update", update),
            ("points", Value::Count(2)),
            ("courant", Value::Number(courant)),
            ("cells", Value::Count(cells)),
        ] {
            values[axis(name)] = value;
        }
        Setting(values)
    }

    fn trial(setting: Setting, error: f64) -> Trial {
        let done = error.is_finite();
        Trial {
            default: false,
            setting,
            status: if done { Status::Done } else { Status::Failed },
            message: String::new(),
            error,
            wall: 1.0,
            work: 1.0,
            particles: 10,
            steps: 10,
            dt: 0.1,
            cell_size: 1.0,
        }
    }

    fn subject() -> Subject {
        named("manufactured")
    }

    fn named(name: &str) -> Subject {
        let problem = PROBLEMS.iter().find(|problem| problem.name == name);
        Subject::Problem(problem.expect("the case"))
    }

    const QUADRATIC: [&str; 4] = ["updated", "quadratic", "apic", "usl"];
    const MUSL: [&str; 4] = ["updated", "quadratic", "apic", "musl"];

    /// Errors of third order from 8 to 16 cells and of first from 16 to 32, in any order of the runs.
    #[test]
    fn a_series_has_the_order_of_its_two_finest_grids_and_of_all() {
        let runs = [(16, 0.02), (32, 0.01), (8, 0.16)];
        let mut trials: Vec<Trial> = runs
            .iter()
            .map(|(cells, error)| trial(setting(QUADRATIC, 0.4, *cells), *error))
            .collect();
        trials.push(trial(setting(MUSL, 0.4, 8), 0.3));
        let all = series(&subject(), &trials);
        assert_eq!(all.len(), 2);
        let one = &all[0];
        assert_eq!(one.setting, setting(QUADRATIC, 0.4, 8));
        assert_eq!(
            (&one.cells[..], &one.errors[..]),
            (&[8.0, 16.0, 32.0][..], &[0.16, 0.02, 0.01][..])
        );
        assert!((one.last - 1.0).abs() < 1e-12 && (one.fit - 2.0).abs() < 1e-12);
        assert_eq!(one.failed, 0);
        assert!(all[1].last.is_nan());
        let local: Vec<f64> = (0..4).map(|i| local_order(&trials, i)).collect();
        assert!((local[0] - 3.0).abs() < 1e-12 && (local[1] - 1.0).abs() < 1e-12);
        assert!(local[2].is_nan() && local[3].is_nan());

        // without the finest there is no order of the finest
        trials[1] = trial(setting(QUADRATIC, 0.4, 32), f64::NAN);
        let one = &series(&subject(), &trials)[0];
        assert!(one.last.is_nan() && (one.fit - 3.0).abs() < 1e-12);
        assert_eq!((one.failed, one.cells.len()), (1, 2));
    }

    #[test]
    fn the_best_update_errs_least_on_the_finest_grid_with_the_smallest_steps() {
        let trials = [
            trial(setting(QUADRATIC, 0.2, 8), 0.1),
            trial(setting(QUADRATIC, 0.2, 16), 0.04),
            trial(setting(MUSL, 0.2, 8), 0.2),
            trial(setting(MUSL, 0.2, 16), 0.02),
            // longer steps are not asked
            trial(setting(QUADRATIC, 0.5, 16), 0.001),
        ];
        let best = |trials: &[Trial]| -> Vec<String> {
            let all = series(&subject(), trials);
            let best = best_updates(&all);
            let name = |s: &&Series| s.setting.get("update").to_string();
            best.iter().map(name).collect()
        };
        assert_eq!(best(&trials), ["musl"]);
        // one that fails is never the best
        let mut failing = trials.to_vec();
        failing[2] = trial(setting(MUSL, 0.2, 8), f64::NAN);
        assert_eq!(best(&failing), ["usl"]);
    }

    #[test]
    fn what_is_expected_of_a_method_is_said_of_it_alone() {
        let of = |case, method| expected(&named(case), &setting(method, 0.4, 8)).map(|e| e.order);
        let second = of("manufactured", QUADRATIC);
        assert_eq!(second, Some(2.0));
        assert_eq!(of("manufactured", MUSL), second);
        let with = |frame, transfer, update| [frame, "quadratic", transfer, update];
        let first = with("updated", "apic", "usf");
        assert_eq!(of("manufactured", first), Some(1.0));
        assert_eq!(of("manufactured", with("updated", "pic", "usl")), None);
        // cells that are crossed are those of the updated frame
        assert_eq!(of("manufactured_large", QUADRATIC), Some(0.0));
        let total = with("total", "apic", "usl");
        assert_eq!(of("manufactured_large", total), None);
        assert_eq!(of("manufactured", total), second);
    }
}
