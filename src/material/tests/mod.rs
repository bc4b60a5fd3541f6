//! What every registered law has to satisfy, seen as the solver sees it: one or a few points, no grid.

mod groups;
mod particular;
mod point;
mod reference;

use super::*;
use crate::math::Matrix;
use crate::real::Instructions;
use point::{Point, Values, determinant, inverse, symmetric_eigen};

const ELASTICITY: Isotropic = Isotropic::new(100.0, 0.3);

fn planes<const D: usize>() -> &'static [Plane] {
    match D {
        1 => &[Plane::Strain, Plane::Stress],
        2 => &[Plane::Strain, Plane::Stress, Plane::Axisymmetric],
        _ => &[Plane::Strain],
    }
}

/// Does something for every law in every plane, with several Poisson's ratios.
fn every_law<const D: usize>(check: impl Fn(&LawChoice, Plane, Isotropic, &str)) {
    for poissons_ratio in [0.3, 0.0, -0.4, 0.45] {
        let elasticity = Isotropic::new(ELASTICITY.youngs_modulus(), poissons_ratio);
        let laws = LawChoice::samples(elasticity);
        assert!(laws.len() >= LawChoice::NAMES.len());
        for law in laws {
            for &plane in planes::<D>() {
                check(&law, plane, elasticity, &format!("{D}D {plane:?} {law:?}"));
            }
        }
    }
}

fn hoop_of(plane: Plane, stretch: f64) -> f64 {
    if plane == Plane::Axisymmetric {
        stretch
    } else {
        1.0
    }
}

/// Runs a test that is generic over the dimension in 1D, 2D and 3D.
macro_rules! in_every_dimension {
    ($($name:ident => $check:ident),* $(,)?) => {
        $(#[test] fn $name() { $check::<1>(); $check::<2>(); $check::<3>(); })*
    };
}

use in_every_dimension;

in_every_dimension! {
    undeformed_points_have_neither_stress_nor_energy => undeformed,
    small_strains_give_linear_elasticity_to_nine_digits_less_the_strain => small_strain,
    a_superposed_rotation_rotates_the_stress_and_nothing_else => objective,
    stress_is_the_derivative_of_energy => conservative,
    energy_is_not_negative => not_negative,
    every_plane_is_what_three_dimensions_do => like_three_dimensions,
    no_wave_is_faster_than_the_stiffness_says => fast_enough,
    the_stiffness_is_close_where_strains_are_small => close_enough,
    points_turned_inside_out_have_a_stress_that_is_not_a_number => inside_out,
    what_is_remembered_has_names => named,
}

fn undeformed<const D: usize>() {
    every_law::<D>(|law, plane, elasticity, label| {
        let mut point = Point::<D>::new(law, plane);
        point.step(Matrix::zeros(), 0.0);
        assert_eq!(point.tau(), Matrix::<D>::zeros(), "{label}");
        assert_eq!(
            (point.energy(), point.volume_ratio()),
            (0.0, 1.0),
            "{label}"
        );
        let (_, mu) = elasticity.lame();
        let modulus = elasticity.plane_lambda::<D>(plane) + 2.0 * mu;
        assert!((point.stiffness() / modulus - 1.0).abs() < 1e-14, "{label}");
        assert_eq!(
            point.points.reference_stiffness(),
            point.stiffness(),
            "{label}"
        );
        let (e, nu) = (elasticity.youngs_modulus(), elasticity.poissons_ratio());
        match (D, plane) {
            (1, Plane::Stress) => assert!((modulus / e - 1.0).abs() < 1e-14),
            (2, Plane::Stress) => assert!((modulus * (1.0 - nu * nu) / e - 1.0).abs() < 1e-14),
            _ => {}
        }
    });
}

fn small_strain<const D: usize>() {
    every_law::<D>(|law, plane, elasticity, label| {
        let (_, mu) = elasticity.lame();
        let lambda = elasticity.plane_lambda::<D>(plane);
        let h = Values(1).matrix::<D>(1e-9);
        let hoop = hoop_of(plane, 1.0 + 2.0_f64.powi(-30)) - 1.0;
        let mut point = Point::<D>::new(law, plane);
        point.step(h, hoop);

        let strain = (h + h.transpose()) * 0.5;
        let trace = strain.trace() + hoop;
        let tau = Matrix::<D>::identity() * (lambda * trace) + strain * (2.0 * mu);
        let difference = (point.tau() - tau).norm() / tau.norm();
        assert!(difference < 1e-8, "{label}: stress off by {difference}");
        let energy = 0.5 * lambda * trace * trace + mu * (strain.norm_squared() + hoop * hoop);
        let difference = point.energy() / energy - 1.0;
        assert!(
            difference.abs() < 1e-7,
            "{label}: energy off by {difference}"
        );
        if plane == Plane::Axisymmetric {
            let hoop_stress = lambda * trace + 2.0 * mu * hoop;
            assert!((point.hoop[0] / hoop_stress - 1.0).abs() < 1e-7, "{label}");
        }
    });
}

fn objective<const D: usize>() {
    if D == 1 {
        return; // nothing turns on a line
    }
    every_law::<D>(|law, plane, _, label| {
        let mut numbers = Values(2);
        let f = numbers.stretched::<D>(0.8, 1.25);
        let mut point = Point::at(law, plane, f, hoop_of(plane, 1.1));
        let before = point.clone();
        let q = numbers.rotation::<D>(2.0);
        let mut turned = q * before.tau() * q.transpose();
        if law.is_hyperelastic() {
            point.step(q - Matrix::identity(), 0.0);
        } else {
            // a rate law is turned by spin alone: the skew gradient whose Cayley transform is the rotation
            let spin = (q - Matrix::identity()) * inverse(&(q + Matrix::identity())) * 2.0;
            point.step(spin, 0.0);
            // points that move along tangents grow, and τ = J σ with them if the rate is that of σ
            if matches!(law, LawChoice::LinearElastic(law) if law.rate == StressRate::Cauchy) {
                turned *= point.volume_ratio() / before.volume_ratio();
            }
            let size = |tau: &Matrix<D>| tau.norm();
            assert!(
                (size(&point.tau()) / size(&turned) - 1.0).abs() < 1e-13,
                "{label}"
            );
            let difference = (point.tau() - turned).norm() / turned.norm();
            assert!(difference < 1e-12, "{label}: {difference}");
            return;
        }
        assert!(
            (turned - before.tau()).norm() > 1.0,
            "{label}: nothing to see"
        );
        assert!(
            (point.tau() - turned).norm() < 1e-11,
            "{label}: {}",
            point.tau() - turned
        );
        assert!((point.energy() - before.energy()).abs() < 1e-11, "{label}");
        assert!(
            (point.volume_ratio() - before.volume_ratio()).abs() < 1e-14,
            "{label}"
        );
        if let (Some(now), Some(then)) = (point.hoop.first(), before.hoop.first()) {
            assert!((now - then).abs() < 1e-11, "{label}");
        }
    });
}

fn conservative<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        if !law.is_hyperelastic() {
            return;
        }
        let mut numbers = Values(3);
        for size in [1e-3, 0.2] {
            let f = numbers.stretched::<D>(1.0 - size, 1.0 + size);
            let hoop = hoop_of(plane, 1.0 + 0.5 * size);
            let point = Point::at(law, plane, f, hoop);
            let d = 1e-5;
            let first_piola = Matrix::<D>::from_fn(|i, j| {
                let energy = |d: f64| {
                    let mut f = f;
                    f[(i, j)] += d;
                    Point::at(law, plane, f, hoop).energy()
                };
                (energy(d) - energy(-d)) / (2.0 * d)
            });
            let difference = (first_piola * f.transpose() - point.tau()).norm();
            assert!(difference < 1e-6, "{label}, strain {size}: {difference}");
            if plane == Plane::Axisymmetric {
                let energy = |hoop: f64| Point::at(law, plane, f, hoop).energy();
                let slope = (energy(hoop + d) - energy(hoop - d)) / (2.0 * d);
                assert!((slope * hoop - point.hoop[0]).abs() < 1e-6, "{label}");
            }
        }
    });
}

fn not_negative<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        let mut numbers = Values(4);
        for upper in [1.0, 1.0 + 1e-12, 1.001, 1.2] {
            for _ in 0..10 {
                let f = numbers.stretched::<D>(1.0 / upper, upper);
                let energy = Point::at(law, plane, f, 1.0).energy();
                assert!(energy >= -1e-13, "{label}: {energy}");
            }
        }
    });
}

fn like_three_dimensions<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        let mut numbers = Values(5);
        for _ in 0..20 {
            let f = numbers.stretched::<D>(0.8, 1.2);
            let hoop = hoop_of(plane, 0.9);
            let mut plane_point = Point::<D>::new(law, plane);
            let mut solid = Point::<3>::new(law, Plane::Strain);
            let steps = 20;
            for k in 1..=steps {
                let s = f64::from(k) / f64::from(steps);
                let identity = Matrix::identity();
                plane_point.go(identity + (f - identity) * s, 1.0 + (hoop - 1.0) * s, 1);
                let ratio = plane_point.volume_ratio() / determinant(&plane_point.f);
                let side = if D == 1 { ratio.sqrt() } else { ratio };
                let mut f = Matrix::<3>::identity() * side;
                for i in 0..D {
                    for j in 0..D {
                        f[(i, j)] = plane_point.f[(i, j)];
                    }
                }
                if plane != Plane::Stress {
                    let expected = plane_point.hoop_stretch;
                    assert!(
                        D == 3 || (side / expected - 1.0).abs() < 1e-13,
                        "{label}: {side}"
                    );
                }
                solid.go(f, 1.0, 1);
            }
            let (tau, reference) = (plane_point.tau(), solid.tau());
            for i in 0..D {
                for j in 0..D {
                    assert!((tau[(i, j)] - reference[(i, j)]).abs() < 1e-11, "{label}");
                }
            }
            if D < 3 && plane == Plane::Stress {
                assert!(
                    reference[(2, 2)].abs() < 1e-11,
                    "{label}: {}",
                    reference[(2, 2)]
                );
            }
            if plane == Plane::Axisymmetric {
                assert!(
                    (reference[(2, 2)] - plane_point.hoop[0]).abs() < 1e-11,
                    "{label}"
                );
            }
            assert!(
                (plane_point.energy() - solid.energy()).abs() < 1e-11,
                "{label}"
            );
        }
    });
}

/// The largest eigenvalue of the symmetric part of Q(n), from the stresses that small steps m ⊗ n make.
fn acoustic<const D: usize>(point: &Point<D>, numbers: &mut Values) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for direction in 0..30 {
        let mut n = crate::math::Vector::<D>::from_fn(|_, _| numbers.next());
        if direction < D {
            // waves along the principal axes of stress are the fastest ones in most states
            let (_, axes) = symmetric_eigen(&point.tau());
            n = axes.column(direction).into_owned();
        }
        let n = n / n.norm();
        let d = 1e-5;
        let mut q = Matrix::<D>::zeros();
        for k in 0..D {
            let stress_after = |d: f64| {
                let mut point = point.clone();
                point.step(
                    Matrix::from_fn(|i, j| if i == k { d * n[j] } else { 0.0 }),
                    0.0,
                );
                point.tau()
            };
            let change = (stress_after(d) - stress_after(-d)) / (2.0 * d);
            let tau_n = point.tau() * n;
            for i in 0..D {
                // τ Lᵀ n = τ n (m · n)
                q[(i, k)] = (change * n)[i] - tau_n[i] * n[k];
            }
        }
        let (values, _) = symmetric_eigen(&((q + q.transpose()) * 0.5));
        largest = values.into_iter().fold(largest, f64::max);
    }
    largest
}

fn fast_enough<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        let mut numbers = Values(6);
        let mut defined = 0;
        for k in 0..40 {
            let upper = [1.01, 1.2, 1.5, 2.0][k % 4];
            let f = numbers.stretched::<D>(1.0 / upper, upper);
            let hoop = hoop_of(plane, 1.0 + 0.4 * numbers.next());
            let point = Point::at(law, plane, f, hoop);
            if point.tau()[(0, 0)].is_nan() {
                continue; // a law without a plane stress state there
            }
            defined += 1;
            let (bound, found) = (point.stiffness(), acoustic(&point, &mut numbers));
            assert!(
                bound > found * (1.0 - 1e-6) - 1e-6,
                "{label}: {bound} < {found} at {f}"
            );
        }
        assert!(defined >= 25, "{label}: {defined}");
    });
}

fn close_enough<const D: usize>() {
    every_law::<D>(|law, plane, elasticity, label| {
        if elasticity.poissons_ratio() < 0.0 {
            return;
        }
        let mut numbers = Values(7);
        for _ in 0..10 {
            let f = numbers.stretched::<D>(0.99, 1.01);
            let point = Point::at(law, plane, f, hoop_of(plane, 1.01));
            let (bound, found) = (point.stiffness(), acoustic(&point, &mut numbers));
            assert!(bound < 1.08 * found, "{label}: {bound}, {found}");
        }
    });
}

fn inside_out<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        let mut flat = Matrix::<D>::identity();
        flat[(0, 0)] = 0.0;
        let mut inverted = Matrix::<D>::identity();
        inverted[(0, 0)] = -0.5;
        for f in [flat, inverted, Matrix::from_element(f64::NAN)] {
            let mut point = Point::<D>::new(law, plane);
            point.step(f - Matrix::identity(), 0.0);
            assert!(
                point.stress.iter().all(|x| x.is_nan()),
                "{label}: {}",
                point.tau()
            );
            point.step(Matrix::zeros(), 0.0);
            assert!(
                point.stress.iter().all(|x| x.is_nan()),
                "{label}: {}",
                point.tau()
            );
            // whatever these are, they come back
            let _ = (point.energy(), point.stiffness(), point.volume_ratio());
        }
    });
}

fn named<const D: usize>() {
    every_law::<D>(|law, plane, _, label| {
        let f = Values(8).stretched::<D>(0.9, 1.1);
        let point = Point::at(law, plane, f, 1.0);
        let mut values = Vec::new();
        point.points.memory_values(0, &mut values);
        assert_eq!(values.len(), point.points.memory_names().len(), "{label}");
        if law.is_hyperelastic() {
            for i in 0..D {
                for j in 0..D {
                    assert!((values[i * D + j] - f[(i, j)]).abs() < 1e-15, "{label}");
                }
            }
        }
    });
}
