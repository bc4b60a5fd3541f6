//! What runs of one scenario at different resolutions have in common: displacements at places, and energies.

use crate::observe::{Frame, Memory, Point, Sink};
use crate::scenario::{ProbeTarget, Scenario, body_points};
use std::io;

/// Histories of one run, all at the same recorded times.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    /// Components of displacements, m, one after the other for each time.
    displacements: Vec<f64>,
    /// Kinetic and elastic energy, J.
    energies: Vec<f64>,
}

impl Signals {
    /// Root of the mean of two squares: the relative L2 error of all displacements, and that of the energies. A group that is
    /// zero in the reference does not count.
    pub(super) fn distance(&self, reference: &Self) -> f64 {
        let groups = [
            (&self.displacements, &reference.displacements),
            (&self.energies, &reference.energies),
        ];
        let (mut sum, mut count) = (0.0, 0.0);
        for (computed, exact) in groups {
            if computed.len() != exact.len() {
                return f64::NAN;
            }
            let size: f64 = exact.iter().map(|e| e * e).sum();
            if size > 0.0 {
                let pairs = computed.iter().zip(exact.iter());
                sum += pairs.map(|(c, e)| (c - e) * (c - e)).sum::<f64>() / size;
                count += 1.0;
            }
        }
        (sum / count).sqrt()
    }
}

/// The places of a scenario's probes at its own resolution, m, with their bodies.
pub(super) fn places(scenario: &Scenario) -> Vec<(usize, [f64; 3])> {
    let place = |probe: &crate::scenario::ProbeSpec| match &probe.target {
        ProbeTarget::Near(place) => {
            let mut at = [0.0; 3];
            at[..place.len()].copy_from_slice(place);
            (probe.body, at)
        }
        ProbeTarget::Particle(number) => (
            probe.body,
            body_points(scenario, probe.body).positions[*number],
        ),
    };
    scenario.probes.iter().map(place).collect()
}

/// Collects signals while a run goes.
pub(super) struct Watch<'a> {
    memory: Memory,
    places: &'a [(usize, [f64; 3])],
    /// For each place, the share of each point in the displacement there.
    shares: Vec<Vec<(usize, f64)>>,
    start: Vec<Point>,
    displacements: Vec<f64>,
}

impl<'a> Watch<'a> {
    /// Displacements at these places, or of the bodies' centres of mass if there are none.
    pub(super) fn new(places: &'a [(usize, [f64; 3])]) -> Self {
        Self {
            memory: Memory::default(),
            places,
            shares: Vec::new(),
            start: Vec::new(),
            displacements: Vec::new(),
        }
    }

    /// What was collected.
    pub(super) fn signals(self, scenario: &Scenario) -> Signals {
        let mut displacements = self.displacements;
        if self.places.is_empty() {
            for body in &scenario.bodies {
                for axis in &["x", "y", "z"][..scenario.dimension] {
                    let table = format!("body_{}", body.name);
                    let positions = self.memory.column(&table, &format!("position_{axis}"));
                    let first = positions.first().copied().unwrap_or(0.0);
                    displacements.extend(positions.iter().map(|x| x - first));
                }
            }
        }
        let columns = ["kinetic", "elastic"];
        let energies = columns.iter().flat_map(|c| self.memory.column("energy", c));
        Signals {
            displacements,
            energies: energies.collect(),
        }
    }
}

impl Sink for Watch<'_> {
    fn open(&mut self, name: &str, header: &[String]) -> io::Result<()> {
        self.memory.open(name, header)
    }

    fn row(&mut self, name: &str, row: &[f64]) -> io::Result<()> {
        self.memory.row(name, row)
    }

    fn wants_frames(&self) -> bool {
        !self.places.is_empty()
    }

    fn frame(&mut self, frame: Frame) -> io::Result<()> {
        if self.start.is_empty() {
            let places = self.places.iter();
            let shares = places.map(|(body, place)| shares(&frame.points, *body, place));
            self.shares = shares.collect();
            self.start = frame.points.clone();
        }
        for shares in &self.shares {
            for axis in 0..3 {
                let moved = |&(i, share): &(usize, f64)| {
                    share * (frame.points[i].position[axis] - self.start[i].position[axis])
                };
                self.displacements.push(shares.iter().map(moved).sum());
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Shares of points in the value at a place: of the linear function that fits the nearest ones best. The nearest point alone
/// would be off by its distance, which is of first order in the resolution.
fn shares(points: &[Point], body: usize, place: &[f64; 3]) -> Vec<(usize, f64)> {
    let distance = |i: &usize| {
        let x = &points[*i].position;
        (0..3).map(|a| (x[a] - place[a]).powi(2)).sum::<f64>()
    };
    let mut near: Vec<usize> = (0..points.len())
        .filter(|i| points[*i].body == body)
        .collect();
    near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let varies = |axis: usize| {
        let start = near.first().map_or(0.0, |&i| points[i].position[axis]);
        near.iter().any(|&i| points[i].position[axis] != start)
    };
    let axes: Vec<usize> = (0..3).filter(|axis| varies(*axis)).collect();
    near.truncate(3_usize.pow(axes.len() as u32));
    // the normal equations of a + b·(x − place), of which only a is wanted
    let scale = near.last().map_or(1.0, |last| distance(last).sqrt());
    let row = |i: usize| {
        let arm = |a: &usize| (points[i].position[*a] - place[*a]) / scale;
        let mut row = vec![1.0];
        row.extend(axes.iter().map(arm));
        nalgebra::DVector::from_vec(row)
    };
    let width = axes.len() + 1;
    let mut normal = nalgebra::DMatrix::<f64>::zeros(width, width);
    for &i in &near {
        normal += row(i) * row(i).transpose();
    }
    match normal.try_inverse() {
        Some(inverse) => near
            .iter()
            .map(|&i| (i, (inverse.row(0) * row(i))[0]))
            .collect(),
        // points in a row: the nearest has to do
        None => near.first().map(|&i| (i, 1.0)).into_iter().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_field_is_met_at_any_place() {
        let point = |x: f64, y: f64| Point {
            position: [x, y, 0.0],
            ..Point::default()
        };
        let all: Vec<Point> = (0..16)
            .map(|i| point(f64::from(i % 4) + 0.5, f64::from(i / 4) + 0.5))
            .collect();
        for place in [[1.3, 2.2, 0.0], [4.0, 4.0, 0.0], [0.5, 0.5, 0.0]] {
            let shares = shares(&all, 0, &place);
            let value = |i: usize| 2.0 + 3.0 * all[i].position[0] - all[i].position[1];
            let found: f64 = shares.iter().map(|(i, share)| share * value(*i)).sum();
            assert!(
                (found - (2.0 + 3.0 * place[0] - place[1])).abs() < 1e-12,
                "{found}"
            );
        }
    }

    #[test]
    fn what_stands_still_in_the_reference_does_not_count() {
        let signals = |displacements: Vec<f64>, energies: Vec<f64>| Signals {
            displacements,
            energies,
        };
        let reference = signals(vec![0.0; 2], vec![3.0, 4.0]);
        let found = signals(vec![1e-20; 2], vec![3.0, 4.5]).distance(&reference);
        assert!((found - 0.1).abs() < 1e-12);
    }
}
