//! How long a step may be.

use crate::scenario::StepRule;

/// What limits the time step at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Fastest elastic wave in any point, m/s.
    pub wave_speed: f64,
    /// Fastest point, m/s.
    pub particle_speed: f64,
    /// Edge of a cell, m.
    pub cell_size: f64,
}

impl Limit {
    /// Time in which the fastest signal crosses a cell, s; infinite if nothing moves and nothing is stiff.
    pub fn crossing_time(&self) -> f64 {
        self.cell_size / (self.wave_speed + self.particle_speed)
    }
}

/// Divides the time between recorded instants into steps.
#[derive(Clone, Copy, Debug)]
pub struct TimeStep {
    rule: StepRule,
    end: f64,
    taken: u64,
}

impl TimeStep {
    /// Steps by `rule` until `end`.
    pub fn new(rule: StepRule, end: f64) -> Self {
        Self {
            rule,
            end,
            taken: 0,
        }
    }

    /// The next step from `time`, s, and the time after it. With a Courant number steps are made equal so that `next_record`
    /// (which is later than `time`) is met exactly; with a fixed step all are the same, but for the last one, which meets the end.
    pub fn next(&mut self, time: f64, next_record: f64, limit: &Limit) -> (f64, f64) {
        self.taken += 1;
        match self.rule {
            StepRule::Fixed(dt) => {
                let after = self.taken as f64 * dt;
                if after >= self.end * (1.0 - 1e-12) {
                    (self.end - time, self.end)
                } else {
                    (dt, after)
                }
            }
            StepRule::Courant(courant) => {
                let largest = courant * limit.crossing_time();
                let left = next_record - time;
                let steps = (left / largest * (1.0 - 1e-12)).ceil().max(1.0);
                if steps == 1.0 {
                    (left, next_record)
                } else {
                    (left / steps, time + left / steps)
                }
            }
        }
    }

    /// Whether `time`, reached by a step of `dt`, is the one at which to record an instant planned for `next_record`.
    pub fn reached(&self, time: f64, dt: f64, next_record: f64) -> bool {
        match self.rule {
            // the step nearest to the planned time
            StepRule::Fixed(_) => time + 0.5 * dt * (1.0 - 1e-9) >= next_record || time >= self.end,
            StepRule::Courant(_) => time >= next_record,
        }
    }
}
