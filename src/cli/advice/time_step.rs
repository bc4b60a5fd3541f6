//! A time step far below what the method allows.

use super::{Advice, Subject};
use crate::scenario::StepRule;

/// Share of the crossing time below which there is something to say.
const SMALL: f64 = 0.2;
/// A Courant number that suits every method (docs/stability.md, "courant").
const USUAL: f64 = 0.4;

pub fn advise(subject: &Subject) -> Vec<Advice> {
    let Subject {
        scenario,
        crossing_time,
        dt,
        ..
    } = *subject;
    let share = dt / crossing_time;
    // false too if there is no crossing time
    if !(share > 0.0 && share < SMALL) {
        return Vec::new();
    }
    let usual = USUAL * crossing_time;
    // steps between two rows are equal and whole, so rows may ask for short ones whatever the Courant number
    let row = scenario.output.every.min(scenario.end);
    let longest = match scenario.step {
        StepRule::Courant(_) => row / (row / usual * (1.0 - 1e-12)).ceil().max(1.0),
        StepRule::Fixed(_) => usual,
    };
    let factor = longest / dt;
    if factor < 1.5 {
        return Vec::new();
    }
    let change = match scenario.step {
        StepRule::Courant(_) => format!("time.courant = {USUAL}"),
        StepRule::Fixed(_) => format!("time.courant = {USUAL} in place of time.step"),
    };
    vec![Advice {
        kind: "short_time_step",
        says: format!(
            "the time step is {share:.2} of the time in which a signal crosses a cell; the error of space is usually larger than that of \
             steps of {USUAL} (compare with mpm chart --courant 0.1,0.2,0.4)"
        ),
        change,
        factor: Some(factor),
    }]
}
