//! How long a step may be.

use crate::scenario::StepRule;

/// What limits the time step at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Fastest elastic wave in any point, m/s, as it travels through the grid.
    pub wave_speed: f64,
    /// Fastest point, m/s. It counts where points stay in the grid as well: velocities that differ by v from node to node strain
    /// them by v Δt/h.
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

/// How far beyond its limit a step may grow before the steps to the next recorded instant are divided anew: small changes of
/// the wave speed must not change every step.
const TOLERANCE: f64 = 1.02;

/// Divides the time between recorded instants into steps.
#[derive(Clone, Copy, Debug)]
pub struct TimeStep {
    rule: StepRule,
    end: f64,
    taken: u64,
    /// With a Courant number: the instant that the present steps lead to, how many are left, and their size, s.
    course: (f64, f64, f64),
}

impl TimeStep {
    /// Steps by `rule` until `end`.
    pub fn new(rule: StepRule, end: f64) -> Self {
        Self {
            rule,
            end,
            taken: 0,
            course: (f64::NAN, 0.0, 0.0),
        }
    }

    /// The next step from `time`, s, and the time after it. With a Courant number steps are made equal so that `next_record`
    /// (which is later than `time`) is met exactly, and stay so unless they exceed their limit by more than 2 %; with a fixed
    /// step all are the same, but for the last one, which meets the end.
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
                let (target, mut left, mut dt) = self.course;
                if target != next_record || left < 1.0 || dt.is_nan() || dt > TOLERANCE * largest {
                    left = ((next_record - time) / largest * (1.0 - 1e-12))
                        .ceil()
                        .max(1.0);
                    dt = (next_record - time) / left;
                }
                self.course = (next_record, left - 1.0, dt);
                let after = if left == 1.0 { next_record } else { time + dt };
                // the last of several steps takes up their rounding
                (after - time, after)
            }
        }
    }

    /// Whether `time`, reached by a step of `dt`, is the one at which to record an instant planned for `next_record`.
    pub fn reached(&self, time: f64, dt: f64, next_record: f64) -> bool {
        match self.rule {
            // the step nearest to the planned time; the end is met by the last one, and recorded once
            StepRule::Fixed(_) => {
                let nearest = time + 0.5 * dt * (1.0 - 1e-9) >= next_record;
                time >= self.end || (nearest && next_record < self.end)
            }
            StepRule::Courant(_) => time >= next_record,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limit(wave_speed: f64) -> Limit {
        Limit {
            wave_speed,
            particle_speed: 0.0,
            cell_size: 1.0,
        }
    }

    #[test]
    fn courant_steps_meet_every_record_and_do_not_follow_small_changes() {
        let mut steps = TimeStep::new(StepRule::Courant(0.1), 0.2);
        let (mut time, mut sizes) = (0.0, Vec::new());
        for record in [0.1, 0.2] {
            while time < record {
                let wave_speed = 10.2 + 0.1 * (sizes.len() as f64).sin();
                let (dt, after) = steps.next(time, record, &limit(wave_speed));
                assert!(dt * wave_speed <= 0.1 * TOLERANCE);
                sizes.push(dt);
                time = after;
            }
            assert_eq!(time, record);
        }
        assert_eq!(sizes.len(), 22);
        assert!(sizes.iter().all(|dt| (dt * 110.0 - 1.0).abs() < 1e-12));
    }

    #[test]
    fn a_wave_speed_that_doubles_shortens_the_next_step() {
        let mut steps = TimeStep::new(StepRule::Courant(0.5), 1.0);
        let (dt, after) = steps.next(0.0, 1.0, &limit(5.0));
        assert!((dt - 0.1).abs() < 1e-15);
        assert!(steps.next(after, 1.0, &limit(10.0)).0 <= 0.05 * (1.0 + 1e-12));
    }

    #[test]
    fn fixed_steps_are_all_the_same_but_the_last() {
        let mut steps = TimeStep::new(StepRule::Fixed(0.3), 1.0);
        let mut time = 0.0;
        let sizes: Vec<f64> = std::iter::from_fn(|| {
            (time < 1.0).then(|| {
                let (dt, after) = steps.next(time, 1.0, &limit(1.0));
                time = after;
                dt
            })
        })
        .collect();
        assert_eq!(sizes[..3], [0.3; 3]);
        assert!((sizes[3] - 0.1).abs() < 1e-15 && sizes.len() == 4);
    }

    #[test]
    fn a_row_is_that_of_the_nearest_step_and_the_end_has_one() {
        let mut steps = TimeStep::new(StepRule::Fixed(0.3), 1.0);
        let (mut time, mut rows) = (0.0, Vec::new());
        let planned = [0.4, 0.8, 1.0];
        while time < 1.0 {
            let next = planned[rows.len()];
            let (dt, after) = steps.next(time, next, &limit(1.0));
            time = after;
            if steps.reached(time, dt, next) {
                rows.push(time);
            }
        }
        assert_eq!(rows.len(), 3, "{rows:?}");
        let close = |(found, nearest): (&f64, f64)| (found - nearest).abs() < 1e-15;
        assert!(rows.iter().zip([0.3, 0.9, 1.0]).all(close), "{rows:?}");
    }
}
