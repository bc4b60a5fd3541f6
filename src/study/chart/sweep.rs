//! What a chart tries if nobody says otherwise.

use super::axes::{AXES, Sweep, Value};
use super::subject::Subject;
use crate::scenario::ReferenceFrame;

/// Default values of every axis; those of `given` are taken instead where they are.
///
/// Only update stress last is tried, and not PIC: the other updates cost twice as much for errors that hardly differ, and update
/// stress first and PIC are of first order. In 2D and 3D, where runs are dearer, FLIP is left out as well, and points a cell and
/// Courant numbers are few. Cases are tried in both frames, for nothing touches in them; a scenario file, where bodies may meet,
/// in its own.
pub fn default_sweep(subject: &Subject, given: &[Option<Vec<Value>>]) -> Sweep {
    let lowest = Value::Count(subject.dimensions()[0] as u32);
    let asked = given.first().cloned().flatten();
    let dimensions = asked.unwrap_or_else(|| vec![lowest]);
    let highest = dimensions.iter().map(|value| match value {
        Value::Count(count) => *count as usize,
        _ => 1,
    });
    let highest = highest.max().unwrap_or(1);
    let names = |all: &[&'static str]| all.iter().map(|name| Value::Name(name)).collect();
    let counts = |all: &[u32]| all.iter().map(|count| Value::Count(*count)).collect();
    let numbers = |all: &[f64]| all.iter().map(|number| Value::Number(*number)).collect();
    let several = dimensions.len() > 1;
    let values = |i: usize| -> Vec<Value> {
        match (AXES[i].name, highest) {
            ("dimensions", _) => dimensions.clone(),
            ("frame", _) => match subject {
                Subject::Problem(_) if several => names(&["updated"]),
                Subject::Problem(_) => names(&ReferenceFrame::NAMES),
                Subject::File(file) => names(&[file.scenario.method.frame.name()]),
            },
            ("transfer", _) if several => names(&["apic"]),
            ("transfer", 2..) => names(&["apic", "mls_apic"]),
            ("transfer", _) => names(&["flip", "apic", "mls_apic"]),
            ("update", _) => names(&["usl"]),
            ("courant", 1) => numbers(&[0.2, 0.5]),
            ("courant", _) => numbers(&[0.4]),
            ("points", _) if several => counts(&[2]),
            ("points", _) => counts(&points(subject, highest)),
            ("cells", _) => counts(&cells(subject, highest)),
            _ => AXES[i].names(),
        }
    };
    let value = |i: usize| given.get(i).cloned().flatten().unwrap_or_else(|| values(i));
    Sweep((0..AXES.len()).map(value).collect())
}

fn points(subject: &Subject, dimension: usize) -> Vec<u32> {
    let all = match subject {
        Subject::Problem(problem) => problem.points.to_vec(),
        Subject::File(_) => vec![1, 2, 3],
    };
    match dimension {
        1 => all,
        // one point a cell leaves splines more nodes than points
        2 => all
            .into_iter()
            .filter(|points| *points > 1)
            .take(2)
            .collect(),
        _ => vec![2],
    }
}

fn cells(subject: &Subject, dimension: usize) -> Vec<u32> {
    match subject {
        Subject::Problem(problem) => (problem.cells)(dimension).to_vec(),
        Subject::File(file) => {
            // twice and four times as large cells, where that many fit along every axis
            let own = &file.scenario.grid.cells;
            let fits = |share: &i32| {
                own.iter()
                    .all(|cells| cells % share == 0 && cells / share > 0)
            };
            let shares = [4, 2, 1].into_iter().filter(fits);
            shares
                .map(|share| (own[0] / share).unsigned_abs())
                .collect()
        }
    }
}

/// Coarse runs with two points a cell and one Courant number: seconds instead of minutes. What `given` says stays.
pub fn quick(sweep: &mut Sweep, given: &[Option<Vec<Value>>]) {
    for (i, axis) in AXES.iter().enumerate() {
        if given.get(i).is_some_and(Option::is_some) {
            continue;
        }
        let values = &mut sweep.0[i];
        match axis.name {
            "cells" => values.truncate((values.len() - 1).max(1)),
            "points" => *values = vec![Value::Count(2)],
            "courant" => *values = vec![Value::Number(0.4)],
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::chart::FileSubject;
    use crate::study::validate::PROBLEMS;

    #[test]
    fn cases_are_tried_in_both_frames_and_a_file_in_its_own() {
        let frames = |subject: &Subject| -> Vec<String> {
            let sweep = default_sweep(subject, &[]);
            sweep.on("frame").iter().map(ToString::to_string).collect()
        };
        for problem in PROBLEMS {
            assert_eq!(frames(&Subject::Problem(problem)), ["updated", "total"]);
        }
        let text = include_str!("../../../scenarios/discs.toml");
        let file = FileSubject::new("discs", text.into(), Vec::new()).expect("a scenario");
        assert_eq!(frames(&Subject::File(Box::new(file))), ["updated"]);
    }
}
