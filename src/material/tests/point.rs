//! One material point without a grid, and numbers to drive it.

use crate::material::*;
use crate::math::{Matrix, packed_len, unpack};
use crate::real::Instructions;
use crate::tensor::Tensor;

pub(super) fn determinant<const D: usize>(m: &Matrix<D>) -> f64 {
    Tensor::from(*m).determinant()
}

pub(super) fn inverse<const D: usize>(m: &Matrix<D>) -> Matrix<D> {
    Tensor::from(*m).inverse().into()
}

pub(super) fn symmetric_eigen<const D: usize>(m: &Matrix<D>) -> ([f64; D], Matrix<D>) {
    let (values, vectors) = Tensor::from(*m).symmetric_eigen();
    (values, vectors.into())
}

/// A material point that goes where a test sends it.
#[derive(Clone)]
pub(super) struct Point<const D: usize> {
    pub(super) points: Box<dyn MaterialPoints<D>>,
    pub(super) stress: Vec<f64>,
    pub(super) hoop: Vec<f64>,
    pub(super) f: Matrix<D>,
    pub(super) hoop_stretch: f64,
}

impl<const D: usize> Point<D> {
    pub(super) fn new(law: &LawChoice, plane: Plane) -> Self {
        let hoops = usize::from(plane == Plane::Axisymmetric);
        Self {
            points: law.points(plane, 1),
            stress: vec![0.0; packed_len(D)],
            hoop: vec![0.0; hoops],
            f: Matrix::identity(),
            hoop_stretch: 1.0,
        }
    }

    /// One step that maps dx to (I + increment) dx and multiplies the hoop stretch by 1 + hoop.
    pub(super) fn step(&mut self, increment: Matrix<D>, hoop: f64) {
        let dt = 0.25;
        self.f += increment * self.f;
        self.hoop_stretch *= 1.0 + hoop;
        let hoops = self.hoop.len();
        let increments = Increments {
            rates: &FourRates::of(&[increment / dt], f64::NAN),
            hoop_rates: &[hoop / dt][..hoops],
            hoop_stretches: &[self.hoop_stretch][..hoops],
            dt,
            instructions: Instructions::Widest,
        };
        let stress = StressMut {
            plane: &mut self.stress,
            hoop: &mut self.hoop,
            reference: ReferenceMut::default(),
        };
        // SAFETY: nobody else knows this point.
        unsafe { self.points.update(0..1, stress, &increments) };
    }

    /// Straight from the present deformation to another one.
    pub(super) fn go(&mut self, f: Matrix<D>, hoop_stretch: f64, steps: usize) {
        let (from, hoop_from) = (self.f, self.hoop_stretch);
        for k in 1..=steps {
            let s = k as f64 / steps as f64;
            let next = from + (f - from) * s;
            let hoop_next = hoop_from + (hoop_stretch - hoop_from) * s;
            let increment = (next - self.f) * inverse(&self.f);
            self.step(increment, hoop_next / self.hoop_stretch - 1.0);
        }
    }

    pub(super) fn at(law: &LawChoice, plane: Plane, f: Matrix<D>, hoop_stretch: f64) -> Self {
        let mut point = Self::new(law, plane);
        let steps = if law.is_hyperelastic() { 1 } else { 40 };
        point.go(f, hoop_stretch, steps);
        point
    }

    pub(super) fn present(&self) -> (Present<'_>, f64) {
        let present = Present {
            stress: &self.stress,
            hoop_stress: &self.hoop,
            hoop_stretches: &std::slice::from_ref(&self.hoop_stretch)[..self.hoop.len()],
        };
        (present, self.hoop_stretch)
    }

    pub(super) fn tau(&self) -> Matrix<D> {
        unpack(&self.stress)
    }

    pub(super) fn energy(&self) -> f64 {
        self.points.energy(0..1, &self.present().0, &|_| 1.0)
    }

    pub(super) fn stiffness(&self) -> f64 {
        let mut found = [0.0];
        let present = self.present().0;
        self.points
            .stiffness(0..1, &present, Instructions::Widest, &mut found);
        // as the time step takes it: a law that has collapsed has no waves
        if found[0] < 0.0 { 0.0 } else { found[0] }
    }

    pub(super) fn volume_ratio(&self) -> f64 {
        self.points.volume_ratio(0, self.hoop_stretch)
    }
}

/// Values between −1 and 1 without a pattern, the same in every run.
pub(super) struct Values(pub(super) u64);

impl Values {
    pub(super) fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(super) fn matrix<const D: usize>(&mut self, size: f64) -> Matrix<D> {
        Matrix::from_fn(|_, _| size * self.next())
    }

    pub(super) fn rotation<const D: usize>(&mut self, size: f64) -> Matrix<D> {
        let a = self.matrix::<D>(size);
        let spin = a - a.transpose();
        inverse(&(Matrix::identity() - spin)) * (Matrix::identity() + spin)
    }

    /// Stretches between `lower` and `upper` in any directions, then turned, but not so far that the straight way there
    /// would be a crushing one.
    pub(super) fn stretched<const D: usize>(&mut self, lower: f64, upper: f64) -> Matrix<D> {
        let (r, q) = (self.rotation::<D>(0.2), self.rotation::<D>(2.0));
        let mut stretch = Matrix::zeros();
        for i in 0..D {
            stretch[(i, i)] = lower * (upper / lower).powf(0.5 + 0.5 * self.next());
        }
        r * q * stretch * q.transpose()
    }
}
