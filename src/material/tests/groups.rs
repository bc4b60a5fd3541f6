//! Points computed in groups of four against points computed one by one.

use super::*;
use crate::math::packed_len;
use crate::real::Portable;
use std::ops::Range;

/// A number of points that is a group of eight, one of four and some more.
const COUNT: usize = 15;

/// How points are updated.
#[derive(Clone, Copy, Debug, PartialEq)]
enum How {
    /// One after the other, with single numbers.
    Singly,
    /// In groups.
    Grouped(Instructions),
    /// As before, but each point in a call of its own.
    Alone(Instructions),
}

impl How {
    fn instructions(self) -> Instructions {
        match self {
            Self::Singly => Instructions::Portable,
            Self::Grouped(some) | Self::Alone(some) => some,
        }
    }
}

/// Some points of a law, and what they went through.
struct Block<const D: usize> {
    points: Box<dyn MaterialPoints<D>>,
    stress: Vec<f64>,
    hoop: Vec<f64>,
    stretches: Vec<f64>,
}

impl<const D: usize> Block<D> {
    fn new(law: &LawChoice, plane: Plane) -> Self {
        let hoops = if plane == Plane::Axisymmetric {
            COUNT
        } else {
            0
        };
        Self {
            points: law.points(plane, COUNT),
            stress: vec![0.0; COUNT * packed_len(D)],
            hoop: vec![0.0; hoops],
            stretches: vec![1.0; hoops],
        }
    }

    /// The rows of each call with so many points, and which of them have hoops.
    fn parts(&self, each: usize) -> Vec<(Range<usize>, Range<usize>)> {
        let firsts = (0..COUNT).step_by(each);
        let ranges = firsts.map(|first| first..first + each);
        let hoops = |range: &Range<usize>| match self.hoop.is_empty() {
            true => 0..0,
            false => range.clone(),
        };
        ranges.map(|range| (range.clone(), hoops(&range))).collect()
    }

    /// A step; `garbage` stands where there are no points.
    fn step(&mut self, how: How, rates: &[Matrix<D>], hoop_rates: &[f64], garbage: f64) {
        let dt = 0.25;
        let hoop_rates = &hoop_rates[..self.hoop.len()];
        for (stretch, rate) in self.stretches.iter_mut().zip(hoop_rates) {
            *stretch *= 1.0 + dt * rate;
        }
        let each = match how {
            How::Alone(_) => 1,
            _ => COUNT,
        };
        for (range, hoops) in self.parts(each) {
            let increments = Increments {
                rates: &FourRates::of(&rates[range.clone()], garbage),
                hoop_rates: &hoop_rates[hoops.clone()],
                hoop_stretches: &self.stretches[hoops.clone()],
                dt,
                instructions: how.instructions(),
            };
            let width = packed_len(D);
            let stress = StressMut {
                plane: &mut self.stress[range.start * width..range.end * width],
                hoop: &mut self.hoop[hoops],
                reference: ReferenceMut::default(),
            };
            // SAFETY: nobody else knows these points.
            unsafe {
                match how {
                    How::Singly => self.points.update_singly(range, stress, &increments),
                    _ => self.points.update(range, stress, &increments),
                }
            }
        }
    }

    /// All numbers that the points have, and at last how stiff they are.
    fn numbers(&self, how: How) -> Vec<f64> {
        let mut bits = Vec::new();
        self.points.state_bits(&mut bits);
        let memory = bits.into_iter().map(f64::from_bits);
        let stress = self.stress.iter().chain(&self.hoop).copied();
        stress.chain(memory).chain(self.stiffness(how)).collect()
    }

    fn stiffness(&self, how: How) -> Vec<f64> {
        let each = match how {
            How::Grouped(_) => COUNT,
            How::Singly | How::Alone(_) => 1,
        };
        let width = packed_len(D);
        let mut found = vec![0.0; COUNT];
        for (range, hoops) in self.parts(each) {
            let present = Present {
                stress: &self.stress[range.start * width..range.end * width],
                hoop_stress: &self.hoop[hoops.clone()],
                hoop_stretches: &self.stretches[hoops],
            };
            let found = &mut found[range.clone()];
            self.points
                .stiffness(range, &present, how.instructions(), found);
        }
        found
    }
}

/// Runs a law for some steps; in the last one, point 5 is turned inside out.
fn run<const D: usize>(law: &LawChoice, plane: Plane, how: How, garbage: f64) -> Vec<Vec<f64>> {
    // with these no other point turns inside out
    let mut numbers = Values(11);
    let mut block = Block::<D>::new(law, plane);
    let mut history = Vec::new();
    for step in 0..12 {
        let mut rates: Vec<Matrix<D>> = (0..COUNT)
            .map(|k| numbers.matrix([0.4, 1e-6][k % 2]))
            .collect();
        let hoop_rates: Vec<f64> = (0..COUNT).map(|_| 0.2 * numbers.next()).collect();
        if step == 11 {
            rates[5] = Matrix::zeros();
            rates[5][(0, 0)] = -6.0;
        }
        block.step(how, &rates, &hoop_rates, garbage);
        history.push(block.numbers(how));
    }
    history
}

fn bits(history: &[Vec<f64>]) -> Vec<u64> {
    history.iter().flatten().map(|x| x.to_bits()).collect()
}

in_every_dimension! {
    four_points_at_once_get_what_each_of_them_would_get => same_as_single,
    what_a_point_gets_depends_neither_on_its_place_nor_on_its_neighbours => same_as_alone,
}

fn same_as_single<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        let single = run::<D>(law, plane, How::Singly, 0.0);
        for instructions in Instructions::all() {
            let grouped = run::<D>(law, plane, How::Grouped(instructions), f64::NAN);
            for (step, (single, grouped)) in single.iter().zip(&grouped).enumerate() {
                let scale = single.iter().copied().filter(|x| x.is_finite());
                let scale = scale.fold(0.0_f64, |most, x| most.max(x.abs()));
                assert!(scale > 0.0, "{label}");
                for (i, (x, y)) in single.iter().zip(grouped).enumerate() {
                    assert!(
                        (x - y).abs() <= 1e-13 * scale || (x.is_nan() && y.is_nan()),
                        "{label}, {instructions:?}, step {step}, number {i}: {x} {y}"
                    );
                }
            }
            let last = &grouped[11][..COUNT * packed_len(D)];
            let packed = packed_len(D);
            assert!(
                last[5 * packed..6 * packed].iter().all(|x| x.is_nan()),
                "{label}"
            );
            assert!(
                last[4 * packed..5 * packed].iter().all(|x| !x.is_nan()),
                "{label}"
            );
            let stiffness = &grouped[11][grouped[11].len() - COUNT..];
            for (k, stiffness) in stiffness.iter().enumerate() {
                assert_eq!(stiffness.is_nan(), k == 5, "{label}, point {k}");
            }
        }
    });
}

fn same_as_alone<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        for instructions in Instructions::all() {
            let grouped = run::<D>(law, plane, How::Grouped(instructions), 1.0);
            let alone = run::<D>(law, plane, How::Alone(instructions), f64::INFINITY);
            assert_eq!(bits(&grouped), bits(&alone), "{label}, {instructions:?}");
        }
    });
}

#[test]
fn functions_of_one_point_are_asked_about_one_after_the_other() {
    type Remembered<R> = ((), (R, crate::tensor::Tensor<R, 2>));
    let rows: Vec<f64> = (0..20).map(f64::from).collect();
    let mut numbers = [Portable::splat(0.0); 5];
    Portable::read_rows(&rows, &mut numbers);
    let four = Remembered::<Portable>::from_numbers(&numbers);
    let doubled: Remembered<Portable> = one_by_one(&four, |((), (x, tensor)): Remembered<f64>| {
        ((), (if x > 5.0 { x } else { -x }, tensor * 2.0))
    });
    doubled.to_numbers(&mut numbers);
    let mut found = vec![0.0; 20];
    Portable::write_rows(&mut found, &numbers);
    for (i, (found, given)) in found.iter().zip(&rows).enumerate() {
        let expected = match i % 5 {
            0 if *given > 5.0 => *given,
            0 => -given,
            _ => 2.0 * given,
        };
        assert_eq!(*found, expected);
    }
}
