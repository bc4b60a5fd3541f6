//! The total Lagrangian frame: from gradients in the reference configuration, in which the grid lives, to those in the present
//! one, in which laws are written, and back.
//!
//! With N_i taken at the reference positions X, the velocities of the grid give Ḟ = Σ v_i ⊗ ∇₀N_i. Laws get the spatial gradient
//! L = ∂v/∂x = Ḟ F⁻¹, F at the start of the step: their own F ← (I + Δt L) F is F + Δt Ḟ. Internal work per initial volume is
//! P : Ḟ = τ : Ḟ F⁻¹, so that P = τ F⁻ᵀ, F at the end of the step as τ is, and f_i = −Σ V₀ P ∇₀N_i.

use crate::material::Rate;
use crate::math::{Matrix, packed_len};
use crate::real::{Instructions, Portable, Real, filled_up};
use crate::tensor::Tensor;

/// Points that are computed together at least.
const GROUP: usize = 4;

/// Carries the deformation gradients F of some points, D² numbers each, over a step, and turns their rates from Ḟ into L.
pub(super) fn deform<const D: usize>(
    f: &mut [f64],
    rates: &mut [Rate<D>],
    dt: f64,
    instructions: Instructions,
) {
    assert_eq!(f.len(), D * D * rates.len());
    match instructions.usable() {
        // SAFETY: the instructions were just found
        #[cfg(target_arch = "x86_64")]
        Instructions::Widest => unsafe { widest::deform(f, rates, dt) },
        // SAFETY: as above
        #[cfg(target_arch = "x86_64")]
        Instructions::Wide => unsafe { wide::deform(f, rates, dt) },
        _ => deform_all::<Portable, Portable, D>(f, rates, dt),
    }
}

/// First Piola–Kirchhoff stresses P, Pa, of points with deformation gradients F, D² numbers each, and Kirchhoff stresses τ, Pa,
/// packed.
pub(super) fn pull_back<const D: usize>(
    f: &[f64],
    stress: &[f64],
    first_piola: &mut [f64],
    instructions: Instructions,
) {
    assert_eq!(stress.len() * D * D, packed_len(D) * f.len());
    assert_eq!(first_piola.len(), f.len());
    match instructions.usable() {
        // SAFETY: the instructions were just found
        #[cfg(target_arch = "x86_64")]
        Instructions::Widest => unsafe { widest::pull_back::<D>(f, stress, first_piola) },
        // SAFETY: as above
        #[cfg(target_arch = "x86_64")]
        Instructions::Wide => unsafe { wide::pull_back::<D>(f, stress, first_piola) },
        _ => pull_back_all::<Portable, Portable, D>(f, stress, first_piola),
    }
}

/// As many as possible in groups of `R`, the others in groups of `Q`, the last of which is filled up.
#[inline(always)]
fn deform_all<R: Real, Q: Real, const D: usize>(f: &mut [f64], rates: &mut [Rate<D>], dt: f64) {
    let whole = rates.len() - rates.len() % R::LANES;
    let (rates, rates_left) = rates.split_at_mut(whole);
    let (f, f_left) = f.split_at_mut(whole * D * D);
    let groups = f.chunks_exact_mut(R::LANES * D * D);
    for (f, rates) in groups.zip(rates.chunks_exact_mut(R::LANES)) {
        deform_group::<R, D>(f, rates, dt);
    }
    let mut groups = f_left.chunks_exact_mut(GROUP * D * D);
    let mut rates = rates_left.chunks_exact_mut(GROUP);
    for (f, rates) in groups.by_ref().zip(rates.by_ref()) {
        deform_group::<Q, D>(f, rates, dt);
    }
    let (f, rates) = (groups.into_remainder(), rates.into_remainder());
    if !rates.is_empty() {
        // filled up to a group with copies of the last; what the others get depends on none of them
        let mut four = filled_up::<{ GROUP * 9 }>(f, D * D);
        let mut padded = std::array::from_fn::<_, GROUP, _>(|k| rates[k.min(rates.len() - 1)]);
        deform_group::<Q, D>(&mut four[..GROUP * D * D], &mut padded, dt);
        f.copy_from_slice(&four[..f.len()]);
        rates.copy_from_slice(&padded[..rates.len()]);
    }
}

/// As [`deform_all`].
#[inline(always)]
fn pull_back_all<R: Real, Q: Real, const D: usize>(
    f: &[f64],
    stress: &[f64],
    first_piola: &mut [f64],
) {
    let packed = packed_len(D);
    let count = stress.len() / packed;
    let whole = count - count % R::LANES;
    let (f, f_left) = f.split_at(whole * D * D);
    let (stress, stress_left) = stress.split_at(whole * packed);
    let (to, to_left) = first_piola.split_at_mut(whole * D * D);
    let groups = f.chunks_exact(R::LANES * D * D);
    let stresses = stress.chunks_exact(R::LANES * packed);
    for ((f, stress), to) in groups
        .zip(stresses)
        .zip(to.chunks_exact_mut(R::LANES * D * D))
    {
        pull_back_group::<R, D>(f, stress, to);
    }
    let groups = f_left.chunks_exact(GROUP * D * D);
    let stresses = stress_left.chunks_exact(GROUP * packed);
    let mut to = to_left.chunks_exact_mut(GROUP * D * D);
    let (f_left, stress_left) = (groups.remainder(), stresses.remainder());
    for ((f, stress), to) in groups.zip(stresses).zip(to.by_ref()) {
        pull_back_group::<Q, D>(f, stress, to);
    }
    let left = to.into_remainder();
    if !left.is_empty() {
        let four = filled_up::<{ GROUP * 9 }>(f_left, D * D);
        let stresses = filled_up::<{ GROUP * 6 }>(stress_left, packed);
        let mut result = [0.0; GROUP * 9];
        let numbers = GROUP * D * D;
        pull_back_group::<Q, D>(
            &four[..numbers],
            &stresses[..GROUP * packed],
            &mut result[..numbers],
        );
        left.copy_from_slice(&result[..left.len()]);
    }
}

/// One group of points.
#[inline(always)]
fn deform_group<R: Real, const D: usize>(f: &mut [f64], rates: &mut [Rate<D>], dt: f64) {
    let rates = Rate::numbers_mut(rates);
    let mut numbers = [R::splat(0.0); 9];
    R::read_rows(f, &mut numbers[..D * D]);
    let start = from_columns::<R, D>(&numbers);
    let mut rate = Tensor::zero();
    for a in 0..D {
        R::read_strided(&rates[4 * a..], 4 * D, &mut numbers[..D]);
        for i in 0..D {
            rate[(i, a)] = numbers[i];
        }
    }
    let spatial = rate * start.inverse();
    to_columns(&spatial, &mut numbers);
    for a in 0..D {
        let column = &numbers[D * a..D * (a + 1)];
        R::write_strided(&mut rates[4 * a..], 4 * D, column);
    }
    let end = rate.scaled_plus(R::splat(dt), start);
    to_columns(&end, &mut numbers);
    R::write_rows(f, &numbers[..D * D]);
}

/// One group of points.
#[inline(always)]
fn pull_back_group<R: Real, const D: usize>(f: &[f64], stress: &[f64], first_piola: &mut [f64]) {
    let packed = packed_len(D);
    let mut numbers = [R::splat(0.0); 9];
    R::read_rows(f, &mut numbers[..D * D]);
    let inverse = from_columns::<R, D>(&numbers).inverse();
    R::read_rows(stress, &mut numbers[..packed]);
    let kirchhoff = Tensor::<R, D>::from_packed(&numbers[..packed]);
    to_columns(&(kirchhoff * inverse.transpose()), &mut numbers);
    R::write_rows(first_piola, &numbers[..D * D]);
}

/// The tensor whose columns follow one another.
#[inline(always)]
fn from_columns<R: Real, const D: usize>(numbers: &[R; 9]) -> Tensor<R, D> {
    let mut tensor = Tensor::zero();
    for a in 0..D {
        for i in 0..D {
            tensor[(i, a)] = numbers[a * D + i];
        }
    }
    tensor
}

/// Writes what [`from_columns`] reads.
#[inline(always)]
fn to_columns<R: Real, const D: usize>(tensor: &Tensor<R, D>, numbers: &mut [R; 9]) {
    for a in 0..D {
        for i in 0..D {
            numbers[a * D + i] = tensor[(i, a)];
        }
    }
}

/// The loops, compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
macro_rules! compiled_for {
    ($module:ident, $most:ident, $features:literal) => {
        mod $module {
            use super::*;
            use crate::real::{Avx, $most as Most};

            #[target_feature(enable = $features)]
            pub fn deform<const D: usize>(f: &mut [f64], rates: &mut [Rate<D>], dt: f64) {
                deform_all::<Most, Avx, D>(f, rates, dt);
            }

            #[target_feature(enable = $features)]
            pub fn pull_back<const D: usize>(f: &[f64], stress: &[f64], first_piola: &mut [f64]) {
                pull_back_all::<Most, Avx, D>(f, stress, first_piola);
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
compiled_for!(wide, Avx, "avx2,fma");
#[cfg(target_arch = "x86_64")]
compiled_for!(widest, Avx512, "avx2,fma,avx512f,avx512vl,avx512dq");

/// Turns ρ₀ c² of some points, Pa, into an upper estimate of ρ₀ c₀², c₀ being the speed of a wave measured in the reference
/// configuration; `f` are their deformation gradients.
///
/// A wave with the wave vector K in the reference configuration has k = F⁻ᵀ K in the present one and the same frequency, so that
/// c₀ = c |k|/|K| ≤ c ‖F⁻¹‖.
pub(super) fn seen_from_reference<const D: usize>(f: &[Matrix<D>], stiffness: &mut [f64]) {
    for (f, stiffness) in f.chunks(GROUP).zip(stiffness.chunks_mut(GROUP)) {
        let mut numbers = [Portable::splat(0.0); 9];
        for (k, f) in f.iter().enumerate() {
            for (number, x) in numbers.iter_mut().zip(f.as_slice()) {
                *number = number.with_lane(k, *x);
            }
        }
        let inverse = from_columns::<Portable, D>(&numbers).inverse();
        let squares = (inverse * inverse.transpose()).largest_eigenvalue();
        for (k, stiffness) in stiffness.iter_mut().enumerate() {
            *stiffness *= squares.lane(k);
        }
    }
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

    fn numbers<const D: usize>(matrices: &[Matrix<D>]) -> Vec<f64> {
        let flat = matrices.iter().flat_map(|matrix| matrix.as_slice());
        flat.copied().collect()
    }

    /// Every number of points up to five groups, with all arithmetics.
    fn as_in_the_book<const D: usize>() {
        let dt = 0.3;
        let inverse = |f: &Matrix<D>| f.try_inverse().expect("F is not singular");
        let each = |n| Instructions::all().map(move |some| (n, some));
        for (count, instructions) in (1..=20).flat_map(each) {
            let start: Vec<Matrix<D>> = (0..count)
                .map(|k| Matrix::identity() * 1.5 + matrix(k))
                .collect();
            let given: Vec<Matrix<D>> = (0..count).map(|k| matrix(50 + k)).collect();
            let mut rates: Vec<Rate<D>> = given.iter().map(|&rate| Rate::from(rate)).collect();
            let mut f = numbers(&start);
            deform(&mut f, &mut rates, dt, instructions);
            let width = packed_len(D);
            let stress: Vec<f64> = (0..width * count).map(number).collect();
            let mut first_piola = vec![f64::NAN; f.len()];
            pull_back::<D>(&f, &stress, &mut first_piola, instructions);
            let mut stiffness: Vec<f64> = (0..count).map(|k| 1.0 + k as f64).collect();
            seen_from_reference(&start, &mut stiffness);
            for k in 0..count {
                let inverse = Tensor::from(inverse(&start[k]));
                let (squares, _) = (inverse * inverse.transpose()).symmetric_eigen();
                let largest = squares.into_iter().fold(0.0, f64::max);
                let expected = (1.0 + k as f64) * largest;
                assert!((stiffness[k] / expected - 1.0).abs() < 1e-13, "{D}D c₀");
            }
            let matrix_of = |numbers: &[f64], k: usize| {
                Matrix::<D>::from_column_slice(&numbers[k * D * D..(k + 1) * D * D])
            };
            for k in 0..count {
                let end = start[k] + given[k] * dt;
                assert!((matrix_of(&f, k) - end).amax() < 1e-15 * 4.0, "{D}D F");
                let l = given[k] * inverse(&start[k]);
                for a in 0..D {
                    for i in 0..D {
                        let found = rates[k].0[a][i];
                        assert!((found - l[(i, a)]).abs() < 1e-14, "{D}D L");
                    }
                }
                let kirchhoff: Matrix<D> = unpack(&stress[k * width..(k + 1) * width]);
                let p = kirchhoff * inverse(&end).transpose();
                assert!((matrix_of(&first_piola, k) - p).amax() < 1e-14, "{D}D P");
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
