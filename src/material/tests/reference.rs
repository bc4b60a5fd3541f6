//! Points in the total frame against the same points in the updated one.

use super::*;
use crate::math::{packed_len, unpack};

/// A number of points that is a group of eight, one of four and some more.
const COUNT: usize = 15;

fn numbers<const D: usize>(matrices: &[Matrix<D>]) -> Vec<f64> {
    let flat = matrices.iter().flat_map(|matrix| matrix.as_slice());
    flat.copied().collect()
}

/// The largest difference between two lists of numbers, over the largest number.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = a
        .iter()
        .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0_f64, |most, (x, y)| most.max((x - y).abs())) / scale
}

in_every_dimension! {
    points_in_the_total_frame_get_what_they_get_in_the_updated_one => same_as_updated,
}

/// Some steps with Ḟ in the one frame and L = Ḟ F⁻¹ in the other; P = τ F⁻ᵀ, and F is the sum of the increments.
fn same_as_updated<const D: usize>() {
    let dt = 0.25;
    every_law::<D>(|law, plane, _, label| {
        let all = Instructions::all().map(|some| (some, true));
        for (instructions, keep) in all.chain(Instructions::all().map(|some| (some, false))) {
            let mut values = Values(17);
            let hoops = if plane == Plane::Axisymmetric {
                COUNT
            } else {
                0
            };
            let [total, updated] = [0, 1].map(|_| law.points::<D>(plane, COUNT));
            // kept beside the law, or not, if the law can do without
            let keep = keep || total.deformation_gradient(0).is_none();
            let mut f = vec![Matrix::<D>::identity(); COUNT];
            let mut kept = numbers(&f[..if keep { COUNT } else { 0 }]);
            let mut first_piola = vec![f64::NAN; D * D * COUNT];
            let mut stresses = [0, 1].map(|_| vec![0.0; packed_len(D) * COUNT]);
            let mut hoop_stresses = [0, 1].map(|_| vec![0.0; hoops]);
            let mut stretches = vec![1.0; hoops];
            for _ in 0..5 {
                let given: Vec<Matrix<D>> = (0..COUNT).map(|_| values.matrix(0.2)).collect();
                let spatial = given.iter().zip(&f).map(|(rate, f)| rate * inverse(f));
                let spatial: Vec<Matrix<D>> = spatial.collect();
                let of_frames = [&given, &spatial].map(|rates| FourRates::of(rates, f64::NAN));
                let hoop_rates: Vec<f64> = (0..hoops).map(|_| 0.2 * values.next()).collect();
                for (stretch, rate) in stretches.iter_mut().zip(&hoop_rates) {
                    *stretch *= 1.0 + dt * rate;
                }
                for (frame, rates) in of_frames.iter().enumerate() {
                    let increments = Increments {
                        rates,
                        hoop_rates: &hoop_rates,
                        hoop_stretches: &stretches,
                        dt,
                        instructions,
                    };
                    let reference = match frame {
                        0 => ReferenceMut {
                            deformation: &mut kept,
                            first_piola: &mut first_piola,
                        },
                        _ => ReferenceMut::default(),
                    };
                    let stress = StressMut {
                        plane: &mut stresses[frame],
                        hoop: &mut hoop_stresses[frame],
                        reference,
                    };
                    let points = [&total, &updated][frame];
                    // SAFETY: nobody else knows these points
                    unsafe { points.update(0..COUNT, stress, &increments) };
                }
                for (f, rate) in f.iter_mut().zip(&given) {
                    *f += rate * dt;
                }
            }
            let label = format!("{label}, {instructions:?}, F kept: {keep}");
            let bits = |points: &dyn MaterialPoints<D>| {
                let mut bits = Vec::new();
                points.state_bits(&mut bits);
                bits.into_iter().map(f64::from_bits).collect::<Vec<_>>()
            };
            // steps of a tenth, and neo-Hookean logarithms: errors of some ten roundings
            let [a, b] = &stresses;
            assert!(difference(a, b) < 1e-13, "{label}: τ");
            let [a, b] = &hoop_stresses;
            assert!(difference(a, b) < 1e-13, "{label}: hoop");
            assert!(
                difference(&bits(&*total), &bits(&*updated)) < 1e-13,
                "{label}: memory"
            );
            if keep {
                assert!(difference(&numbers(&f), &kept) < 1e-15, "{label}: F");
            }
            if let Some(remembered) = total.deformation_gradient(COUNT - 1) {
                let expected = f[COUNT - 1];
                assert!((remembered - expected).norm() < 1e-15, "{label}: F");
            }
            let packed = packed_len(D);
            let expected: Vec<Matrix<D>> = (0..COUNT)
                .map(|k| {
                    let kirchhoff: Matrix<D> = unpack(&stresses[0][k * packed..(k + 1) * packed]);
                    kirchhoff * inverse(&f[k]).transpose()
                })
                .collect();
            assert!(
                difference(&numbers(&expected), &first_piola) < 1e-14,
                "{label}: P"
            );
        }
    });
}
