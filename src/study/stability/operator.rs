//! One step of small motion as a matrix, from the responses of the solver itself to unit disturbances, and its spectral radius:
//! what grows from step to step, without waiting for it to grow.

use super::bar::Specimen;
use crate::solver::Fault;
use nalgebra::{Complex, DMatrix, Schur};
use std::f64::consts::PI;

/// Size of a disturbance: large enough for all digits, small enough for the law to be linear to nine.
const UNIT: f64 = 1e-9;
/// How far above one an eigenvalue has to be to count. The step is the solver's answer to disturbances of [`UNIT`], right to about as
/// much, and a pair of eigenvalues that fall together (a velocity and a stress that no node resists) parts by the root of that.
pub const ROUND_OFF: f64 = 1e-4;
/// Wave numbers between 0 and π per cell at which an endless bar is examined.
/// A cubic bar is most critical between the quarters of that range.
const WAVES: usize = 24;

/// How an endless bar answers, within one step, to what happens in one of its cells.
pub struct Response {
    size: usize,
    /// Cells away, and the answer there.
    blocks: Vec<(f64, DMatrix<f64>)>,
}

/// What the points of one step hold afterwards, for each number of the points `of`, in the order of the points.
fn columns(
    specimen: &mut Specimen,
    of: std::ops::Range<usize>,
    dt: f64,
) -> Result<DMatrix<f64>, Fault> {
    let numbers = specimen.numbers();
    let mut matrix = DMatrix::zeros(specimen.len() * numbers, of.len() * numbers);
    for (q, point) in of.enumerate() {
        for b in 0..numbers {
            specimen.set(|id| {
                let mut held = [0.0; 3];
                if id == point {
                    held[b] = UNIT;
                }
                held
            });
            specimen.step(dt)?;
            for (p, held) in specimen.get().iter().enumerate() {
                for a in 0..numbers {
                    matrix[(p * numbers + a, q * numbers + b)] = held[a] / UNIT;
                }
            }
        }
    }
    Ok(matrix)
}

impl Response {
    /// The response of the middle of a long bar to a step of `dt` seconds.
    ///
    /// # Errors
    /// If the step fails, which one of so small a disturbance does not.
    pub fn of(specimen: &mut Specimen, per_cell: usize, dt: f64) -> Result<Self, Fault> {
        let middle = specimen.len() / per_cell / 2;
        let all = columns(specimen, middle * per_cell..(middle + 1) * per_cell, dt)?;
        let size = per_cell * specimen.numbers();
        let blocks = (0..specimen.len() / per_cell)
            .map(|cell| {
                let block = all.rows(cell * size, size).into_owned();
                (cell as f64 - middle as f64, block)
            })
            .filter(|(_, block)| block.iter().any(|x| *x != 0.0))
            .collect();
        Ok(Self { size, blocks })
    }

    /// The step of a wave exp(i k x), k in 1/cells.
    pub fn wave(&self, k: f64) -> DMatrix<Complex<f64>> {
        let mut sum = DMatrix::zeros(self.size, self.size);
        for (cell, block) in &self.blocks {
            // an answer `cell` cells above is, seen from there, one to a cause below
            let phase = Complex::from_polar(1.0, -k * cell);
            sum += block.map(|x| phase * x);
        }
        sum
    }

    /// Whether a wave of any number grows.
    pub fn grows(&self) -> bool {
        waves().any(|k| radius(&self.wave(k)) > 1.0 + ROUND_OFF)
    }
}

/// Wave numbers of an endless bar, 1/cells.
pub fn waves() -> impl Iterator<Item = f64> {
    (0..=WAVES).map(|i| PI * i as f64 / WAVES as f64)
}

/// One step of a whole bar as a matrix.
///
/// # Errors
/// As [`Response::of`].
pub fn whole(specimen: &mut Specimen, dt: f64) -> Result<DMatrix<f64>, Fault> {
    let count = specimen.len();
    columns(specimen, 0..count, dt)
}

/// How small a number counts as nothing when eigenvalues are sought: some matrices never come to the first of these.
const EXACTNESS: [f64; 3] = [1e-14, 1e-12, 1e-10];

/// Most sweeps of the search for eigenvalues.
const SWEEPS: usize = 1000;

/// How often a matrix is squared to see how its powers grow.
const SQUARINGS: i32 = 20;

/// The largest absolute eigenvalue, to about 1e-5; infinite if the matrix is not finite.
///
/// Gelfand's formula, ‖Mⁿ‖^(1/n) with n = 2²⁰, because the search for eigenvalues of [`Schur`] goes astray on some of these small matrices.
pub fn radius(matrix: &DMatrix<Complex<f64>>) -> f64 {
    let mut power = matrix.clone();
    let mut logarithm = 0.0; // of what was divided out of the power, over its exponent
    let mut exponent = 1.0;
    for _ in 0..SQUARINGS {
        let norm = power.norm();
        if norm == 0.0 {
            return 0.0;
        }
        if !norm.is_finite() {
            return f64::INFINITY;
        }
        power /= Complex::new(norm, 0.0);
        logarithm += norm.ln() / exponent;
        power = &power * &power;
        exponent *= 2.0;
    }
    (logarithm + power.norm().ln() / exponent).exp()
}

/// The same for a real matrix.
pub fn real_radius(matrix: &DMatrix<f64>) -> f64 {
    if matrix.iter().any(|x| !x.is_finite()) {
        return f64::INFINITY;
    }
    let schur = EXACTNESS
        .into_iter()
        .find_map(|exactness| Schur::try_new(matrix.clone(), exactness, SWEEPS));
    schur.map_or(f64::INFINITY, |schur| {
        let eigenvalues = schur.complex_eigenvalues();
        eigenvalues.iter().map(|x| x.norm()).fold(0.0, f64::max)
    })
}
