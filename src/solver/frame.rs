//! The total Lagrangian frame: from gradients in the reference configuration, in which the grid lives, to those in the present
//! one, in which laws are written, and back.
//!
//! With N_i taken at the reference positions X, the velocities of the grid give Ḟ = Σ v_i ⊗ ∇₀N_i. Laws get the spatial gradient
//! L = ∂v/∂x = Ḟ F⁻¹, F at the start of the step: their own F ← (I + Δt L) F is F + Δt Ḟ. Internal work per initial volume is
//! P : Ḟ = τ : Ḟ F⁻¹, so that P = τ F⁻ᵀ, F at the end of the step as τ is, and f_i = −Σ V₀ P ∇₀N_i.

use crate::material::Rate;
use crate::math::{Matrix, packed_len};
use crate::real::{Portable, Real};
use crate::state::Body;
use crate::tensor::Tensor;
use std::ops::Range;

/// Points that are computed together.
const GROUP: usize = 4;

/// Carries the deformation gradients F of some points over a step, and turns their rates from Ḟ into L.
pub(super) fn deform<const D: usize>(
    f: &mut [Matrix<D>],
    rates: &mut [Rate<D>],
    dt: f64,
    wide: bool,
) {
    assert_eq!(f.len(), rates.len());
    #[cfg(target_arch = "x86_64")]
    if wide && crate::real::wide_instructions() {
        // SAFETY: the instructions were just found
        unsafe { wide::deform(f, rates, dt) };
        return;
    }
    let _ = wide;
    deform_all::<Portable, D>(f, rates, dt);
}

/// First Piola–Kirchhoff stresses P, Pa, of points with deformation gradients F and Kirchhoff stresses τ, Pa, packed.
pub(super) fn pull_back<const D: usize>(
    f: &[Matrix<D>],
    stress: &[f64],
    first_piola: &mut [Matrix<D>],
    wide: bool,
) {
    assert_eq!(stress.len(), packed_len(D) * f.len());
    assert_eq!(first_piola.len(), f.len());
    #[cfg(target_arch = "x86_64")]
    if wide && crate::real::wide_instructions() {
        // SAFETY: the instructions were just found
        unsafe { wide::pull_back(f, stress, first_piola) };
        return;
    }
    let _ = wide;
    pull_back_all::<Portable, D>(f, stress, first_piola);
}

#[inline(always)]
fn deform_all<R: Real, const D: usize>(f: &mut [Matrix<D>], rates: &mut [Rate<D>], dt: f64) {
    let mut numbers = [R::splat(0.0); 12];
    for (f, rates) in f.chunks_mut(GROUP).zip(rates.chunks_mut(GROUP)) {
        // copies, because the last group may have fewer points; what the others get depends on none of them
        let mut four = [Matrix::<D>::identity().data.0; GROUP];
        let mut padded = [[[0.0; 4]; D]; GROUP];
        for k in 0..f.len() {
            four[k] = f[k].data.0;
            padded[k] = rates[k].0;
        }
        let four = four.as_flattened_mut().as_flattened_mut();
        let padded = padded.as_flattened_mut().as_flattened_mut();
        R::read_rows(four, &mut numbers[..D * D]);
        let start = from_columns::<R, D>(&numbers, D);
        R::read_rows(padded, &mut numbers[..4 * D]);
        let rate = from_columns::<R, D>(&numbers, 4);
        let spatial = rate * start.inverse();
        to_columns(&spatial, &mut numbers, 4);
        R::write_rows(padded, &numbers[..4 * D]);
        let end = rate.scaled_plus(R::splat(dt), start);
        to_columns(&end, &mut numbers, D);
        R::write_rows(four, &numbers[..D * D]);
        for (k, f) in f.iter_mut().enumerate() {
            f.as_mut_slice()
                .copy_from_slice(&four[k * D * D..(k + 1) * D * D]);
        }
        for (k, rate) in rates.iter_mut().enumerate() {
            let own = &padded[4 * D * k..4 * D * (k + 1)];
            rate.0.as_flattened_mut().copy_from_slice(own);
        }
    }
}

#[inline(always)]
fn pull_back_all<R: Real, const D: usize>(
    f: &[Matrix<D>],
    stress: &[f64],
    first_piola: &mut [Matrix<D>],
) {
    let packed = packed_len(D);
    let mut numbers = [R::splat(0.0); 12];
    let groups = f
        .chunks(GROUP)
        .zip(stress.chunks(GROUP * packed))
        .zip(first_piola.chunks_mut(GROUP));
    for ((f, stress), first_piola) in groups {
        let mut four = [Matrix::<D>::identity().data.0; GROUP];
        let mut stresses = [0.0; GROUP * 6];
        for k in 0..f.len() {
            four[k] = f[k].data.0;
        }
        stresses[..stress.len()].copy_from_slice(stress);
        let four = four.as_flattened_mut().as_flattened_mut();
        R::read_rows(four, &mut numbers[..D * D]);
        let inverse = from_columns::<R, D>(&numbers, D).inverse();
        R::read_rows(&stresses[..GROUP * packed], &mut numbers[..packed]);
        let kirchhoff = Tensor::<R, D>::from_packed(&numbers[..packed]);
        to_columns(&(kirchhoff * inverse.transpose()), &mut numbers, D);
        R::write_rows(four, &numbers[..D * D]);
        for (k, p) in first_piola.iter_mut().enumerate() {
            p.as_mut_slice()
                .copy_from_slice(&four[k * D * D..(k + 1) * D * D]);
        }
    }
}

/// The tensor whose column a starts at number `a * stride`.
#[inline(always)]
fn from_columns<R: Real, const D: usize>(numbers: &[R; 12], stride: usize) -> Tensor<R, D> {
    let mut tensor = Tensor::zero();
    for a in 0..D {
        for i in 0..D {
            tensor[(i, a)] = numbers[a * stride + i];
        }
    }
    tensor
}

/// Writes what [`from_columns`] reads.
#[inline(always)]
fn to_columns<R: Real, const D: usize>(
    tensor: &Tensor<R, D>,
    numbers: &mut [R; 12],
    stride: usize,
) {
    for a in 0..D {
        for i in 0..D {
            numbers[a * stride + i] = tensor[(i, a)];
        }
    }
}

/// The loops, compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
mod wide {
    use super::*;
    use crate::real::Avx;

    #[target_feature(enable = "avx2,fma")]
    pub fn deform<const D: usize>(f: &mut [Matrix<D>], rates: &mut [Rate<D>], dt: f64) {
        deform_all::<Avx, D>(f, rates, dt);
    }

    #[target_feature(enable = "avx2,fma")]
    pub fn pull_back<const D: usize>(
        f: &[Matrix<D>],
        stress: &[f64],
        first_piola: &mut [Matrix<D>],
    ) {
        pull_back_all::<Avx, D>(f, stress, first_piola);
    }
}

/// An upper estimate of the largest ρ₀ c₀² of some of a body's points, Pa, c₀ being the speed of a wave measured in the reference
/// configuration; NaN if that of a point is.
///
/// A wave with the wave vector K in the reference configuration has k = F⁻ᵀ K in the present one and the same frequency, so that
/// c₀ = c |k|/|K| ≤ c ‖F⁻¹‖.
pub(super) fn max_stiffness<const D: usize>(body: &Body<D>, range: Range<usize>) -> f64 {
    let p = &body.particles;
    let mut largest = 0.0_f64;
    for i in range {
        let f = &p.deformation_gradient[i];
        let present = body.material.max_stiffness(i..i + 1, &p.present_of(i));
        let inverse = Tensor::from(*f).inverse();
        let stiffness = present * (inverse * inverse.transpose()).largest_eigenvalue();
        if stiffness.is_nan() {
            return f64::NAN;
        }
        largest = largest.max(stiffness);
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::unpack;

    /// Any numbers between −½ and ½.
    fn number(k: usize) -> f64 {
        (0.37 + k as f64 * 0.618_033_988_75).fract() - 0.5
    }

    fn matrix<const D: usize>(k: usize) -> Matrix<D> {
        Matrix::from_fn(|i, j| number(100 * k + D * i + j))
    }

    /// Every number of points up to three groups, with all arithmetics.
    fn as_in_the_book<const D: usize>() {
        let dt = 0.3;
        let inverse = |f: &Matrix<D>| f.try_inverse().expect("F is not singular");
        for (count, wide) in (1..=12).flat_map(|n| [(n, false), (n, true)]) {
            let start: Vec<Matrix<D>> = (0..count)
                .map(|k| Matrix::identity() * 1.5 + matrix(k))
                .collect();
            let given: Vec<Matrix<D>> = (0..count).map(|k| matrix(50 + k)).collect();
            let mut rates: Vec<Rate<D>> = given.iter().map(|&rate| Rate::from(rate)).collect();
            let mut f = start.clone();
            deform(&mut f, &mut rates, dt, wide);
            let width = packed_len(D);
            let stress: Vec<f64> = (0..width * count).map(number).collect();
            let mut first_piola = vec![Matrix::zeros(); count];
            pull_back(&f, &stress, &mut first_piola, wide);
            for k in 0..count {
                let end = start[k] + given[k] * dt;
                assert!((f[k] - end).amax() < 1e-15 * 4.0, "{D}D F");
                let l = given[k] * inverse(&start[k]);
                for a in 0..D {
                    for i in 0..D {
                        let found = rates[k].0[a][i];
                        assert!((found - l[(i, a)]).abs() < 1e-14, "{D}D L");
                    }
                }
                let kirchhoff: Matrix<D> = unpack(&stress[k * width..(k + 1) * width]);
                let p = kirchhoff * inverse(&end).transpose();
                assert!((first_piola[k] - p).amax() < 1e-14, "{D}D P");
                // what laws make of L is the same F
                let own = (Matrix::identity() + l * dt) * start[k];
                assert!((own - end).amax() < 1e-14, "{D}D (I + Δt L) F");
            }
        }
    }

    #[test]
    fn rates_deformations_and_stresses_are_those_of_the_book() {
        as_in_the_book::<1>();
        as_in_the_book::<2>();
        as_in_the_book::<3>();
    }
}
