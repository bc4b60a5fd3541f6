//! Sums over the points of a body, part by part on several threads, with the same result on any number of them.

use crate::material::Present;
use crate::math::{Sum, Vector, packed_len};
use crate::state::{Body, Particles};
use rayon::prelude::*;
use std::ops::Range;

/// Points in a part: sums are taken over parts, then over the parts in order, whoever takes them.
const PART: usize = 4096;

/// What `work` makes of each part of `count` points, in order.
pub fn in_parts<R: Send>(count: usize, work: impl Fn(Range<usize>) -> R + Sync) -> Vec<R> {
    let part = |index: usize| index * PART..((index + 1) * PART).min(count);
    let parts = count.div_ceil(PART);
    if parts > 1 {
        (0..parts)
            .into_par_iter()
            .map(|index| work(part(index)))
            .collect()
    } else {
        (0..parts).map(|index| work(part(index))).collect()
    }
}

/// The largest that `work` finds in any part, at least zero; NaN if one is.
pub fn largest_in_parts(count: usize, work: impl Fn(Range<usize>) -> f64 + Sync) -> f64 {
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    let part = |index: usize| work(index * PART..((index + 1) * PART).min(count));
    let parts = count.div_ceil(PART);
    if parts > 1 {
        (0..parts).into_par_iter().map(part).reduce(|| 0.0, larger)
    } else {
        (0..parts).map(part).fold(0.0, larger)
    }
}

/// Sums over the points of one body or of all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals<const D: usize> {
    /// Mass, kg.
    pub mass: f64,
    /// Present volume, m³.
    pub volume: f64,
    /// Mass-weighted mean position, m.
    pub position: Vector<D>,
    /// Linear momentum, kg m/s.
    pub momentum: Vector<D>,
    /// Kinetic energy Σ ½ m v², J.
    pub kinetic: f64,
    /// Elastic energy, J.
    pub elastic: f64,
}

/// The sums of a part.
#[derive(Clone, Copy, Default)]
struct Sums<const D: usize> {
    mass: Sum,
    volume: Sum,
    kinetic: Sum,
    elastic: Sum,
    moment: [Sum; 3],
    momentum: [Sum; 3],
}

impl<const D: usize> Sums<D> {
    fn of(body: &Body<D>, part: Range<usize>) -> Self {
        let p = &body.particles;
        let mut sums = Self::default();
        for i in part.clone() {
            sums.mass.add(p.mass[i]);
            let ratio = body.material.volume_ratio(i, p.hoop_stretch(i));
            sums.volume.add(p.mass.initial_volume(i) * ratio);
            sums.kinetic
                .add(0.5 * p.mass[i] * p.velocity[i].norm_squared());
            for a in 0..D {
                sums.moment[a].add(p.mass[i] * p.position[i][a]);
                sums.momentum[a].add(p.mass[i] * p.velocity[i][a]);
            }
        }
        let present = present(p, part.clone());
        let volume = |i| p.mass.initial_volume(i);
        sums.elastic
            .add(body.material.energy(part, &present, &volume));
        sums
    }

    fn and(mut self, other: &Self) -> Self {
        self.mass.add_sum(&other.mass);
        self.volume.add_sum(&other.volume);
        self.kinetic.add_sum(&other.kinetic);
        self.elastic.add_sum(&other.elastic);
        for a in 0..D {
            self.moment[a].add_sum(&other.moment[a]);
            self.momentum[a].add_sum(&other.momentum[a]);
        }
        self
    }
}

/// What laws see of the points in `part`.
pub fn present<const D: usize>(p: &Particles<D>, part: Range<usize>) -> Present<'_> {
    let width = packed_len(D);
    let hoops = if p.hoop_stress.is_empty() {
        0..0
    } else {
        part.clone()
    };
    Present {
        stress: &p.stress[part.start * width..part.end * width],
        hoop_stress: &p.hoop_stress[hoops.clone()],
        hoop_stretches: &p.hoop_stretch[hoops],
    }
}

impl<const D: usize> Body<D> {
    /// Compensated sums over all points.
    pub fn totals(&self) -> Totals<D> {
        let parts = in_parts(self.particles.len(), |part| Sums::of(self, part));
        let sums = parts.iter().fold(Sums::default(), Sums::and);
        let mass = sums.mass.value();
        Totals {
            mass,
            volume: sums.volume.value(),
            position: Vector::from_fn(|a, _| sums.moment[a].value() / mass),
            momentum: Vector::from_fn(|a, _| sums.momentum[a].value()),
            kinetic: sums.kinetic.value(),
            elastic: sums.elastic.value(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_counts() {
        for count in [0, 1, PART, PART + 1, 3 * PART + 7] {
            let parts = in_parts(count, |part| part);
            let rows: Vec<usize> = parts.into_iter().flatten().collect();
            assert_eq!(rows, (0..count).collect::<Vec<_>>());
            for largest in [0, count / 2, count.saturating_sub(1)] {
                let height = |row: usize| if row == largest { 3.0 } else { 2.0 };
                let of = |part: Range<usize>| part.map(height).fold(0.0, f64::max);
                let expected = if count == 0 { 0.0 } else { 3.0 };
                assert_eq!(largest_in_parts(count, of), expected);
                let nan = |part: Range<usize>| {
                    if part.contains(&largest) {
                        f64::NAN
                    } else {
                        2.0
                    }
                };
                assert_eq!(largest_in_parts(count, nan).is_nan(), count > 0);
            }
        }
    }
}
