//! A reference for bars at large amplitude: the same equations solved by an unrelated method.
//!
//! ρ₀ u_tt = ∂P/∂X with P = E ln(1 + u_X) (σ = E ln F in uniaxial strain, where P = σ), u(0) = 0 and P(L) = 0. With
//! u = Σ aₙ(t) sin βₙX, βₙ = (2n − 1)π/(2L), Galerkin's method gives ρ₀ L/2 äₙ = −βₙ ∫ P cos βₙX dX. The integrands continue
//! periodically beyond the ends, so that the midpoint rule converges faster than any power; in time the classical Runge–Kutta
//! method of fourth order. No grid, no points, no weights: nothing is shared with the solver that it judges.

use std::f64::consts::PI;

/// Modes used: the solutions here stay smooth, and what is left out is of the size of the last amplitudes (see [`Swing::tail`]).
const MODES: usize = 40;
/// Quadrature points.
const PLACES: usize = 4 * MODES;

/// A swinging bar.
#[derive(Clone)]
pub struct Swing {
    length: f64,
    density: f64,
    modulus: f64,
    beta: Vec<f64>,
    /// cos βₙX at the quadrature points, mode by mode.
    cosines: Vec<f64>,
    /// aₙ, m.
    amplitudes: Vec<f64>,
    /// ȧₙ, m/s.
    rates: Vec<f64>,
}

impl Swing {
    /// A bar that starts undeformed with the velocity v₀ sin β₁X.
    pub fn new(length: f64, density: f64, modulus: f64, speed: f64) -> Self {
        let beta: Vec<f64> = (0..MODES)
            .map(|n| (2 * n + 1) as f64 * PI / (2.0 * length))
            .collect();
        let place = |i: usize| (i as f64 + 0.5) * length / PLACES as f64;
        let cosines = beta
            .iter()
            .flat_map(|beta| (0..PLACES).map(move |i| (beta * place(i)).cos()));
        let mut rates = vec![0.0; MODES];
        rates[0] = speed;
        Self {
            length,
            density,
            modulus,
            cosines: cosines.collect(),
            beta,
            amplitudes: vec![0.0; MODES],
            rates,
        }
    }

    /// Goes on for `duration`, s, in equal steps of at most `longest`, s.
    pub fn advance(&mut self, duration: f64, longest: f64) {
        let steps = (duration / longest).ceil();
        for _ in 0..steps as usize {
            self.step(duration / steps);
        }
    }

    fn step(&mut self, dt: f64) {
        let mix = |a: &[f64], b: &[f64], share: f64| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| a + share * b).collect()
        };
        let (a, v) = (&self.amplitudes, &self.rates);
        let f1 = self.accelerations(a);
        let (v2, f2) = (
            mix(v, &f1, 0.5 * dt),
            self.accelerations(&mix(a, v, 0.5 * dt)),
        );
        let (v3, f3) = (
            mix(v, &f2, 0.5 * dt),
            self.accelerations(&mix(a, &v2, 0.5 * dt)),
        );
        let (v4, f4) = (mix(v, &f3, dt), self.accelerations(&mix(a, &v3, dt)));
        for n in 0..MODES {
            self.amplitudes[n] += dt / 6.0 * (self.rates[n] + 2.0 * v2[n] + 2.0 * v3[n] + v4[n]);
            self.rates[n] += dt / 6.0 * (f1[n] + 2.0 * f2[n] + 2.0 * f3[n] + f4[n]);
        }
    }

    /// äₙ = −2βₙ/(ρ₀L) ∫ P cos βₙX dX.
    fn accelerations(&self, amplitudes: &[f64]) -> Vec<f64> {
        let mut stress = vec![0.0; PLACES];
        for (n, cosines) in self.cosines.chunks(PLACES).enumerate() {
            let slope = amplitudes[n] * self.beta[n];
            stress
                .iter_mut()
                .zip(cosines)
                .for_each(|(sum, cosine)| *sum += slope * cosine);
        }
        stress
            .iter_mut()
            .for_each(|strain| *strain = self.modulus * strain.ln_1p());
        let rows = self.cosines.chunks(PLACES).zip(&self.beta);
        rows.map(|(cosines, beta)| {
            let mean: f64 = stress.iter().zip(cosines).map(|(p, c)| p * c).sum::<f64>();
            -2.0 * beta / self.density * mean / PLACES as f64
        })
        .collect()
    }

    /// u(X), m.
    pub fn displacement(&self, x: f64) -> f64 {
        self.sum(&self.amplitudes, |beta| (beta * x).sin())
    }

    /// σ(X), Pa.
    pub fn stress(&self, x: f64) -> f64 {
        self.modulus
            * self
                .sum(&self.amplitudes, |beta| beta * (beta * x).cos())
                .ln_1p()
    }

    /// Velocity of the centre of mass, m/s: the mean of sin βₙX is 1/(βₙL).
    pub fn mean_velocity(&self) -> f64 {
        self.sum(&self.rates, |beta| 1.0 / (beta * self.length))
    }

    /// The largest of the last four amplitudes over the largest of all: how well the modes resolve the motion.
    pub fn tail(&self) -> f64 {
        let most = |amplitudes: &[f64]| {
            amplitudes
                .iter()
                .fold(0.0, |most: f64, a| most.max(a.abs()))
        };
        most(&self.amplitudes[MODES - 4..]) / most(&self.amplitudes)
    }

    fn sum(&self, coefficients: &[f64], function: impl Fn(f64) -> f64) -> f64 {
        coefficients
            .iter()
            .zip(&self.beta)
            .map(|(c, &beta)| c * function(beta))
            .sum()
    }
}
