//! What single laws promise, and how blocks of points are handled.

use super::point::{Point, Values, inverse};
use super::*;
use crate::math::pack;

#[test]
fn jaumann_shear_stress_is_a_sine_of_the_shear_to_second_order_in_the_step() {
    let (_, shear) = ELASTICITY.lame();
    let mut f = Matrix::<2>::identity();
    f[(0, 1)] = 1.0;
    for rate in [StressRate::Cauchy, StressRate::Kirchhoff] {
        let law = LawChoice::LinearElastic(LinearElastic {
            elasticity: ELASTICITY,
            rate,
        });
        let error = |steps: usize| {
            let mut point = Point::<2>::new(&law, Plane::Strain);
            point.go(f, 1.0, steps);
            let (sine, cosine) = 1.0_f64.sin_cos();
            let expected = Matrix::<2>::new(1.0 - cosine, sine, sine, cosine - 1.0) * shear;
            (point.tau() - expected).norm() / shear
        };
        let (coarse, fine) = (error(20), error(40));
        assert!(fine < 1e-4, "{fine}");
        assert!((coarse / fine - 4.0).abs() < 0.05, "{coarse} {fine}");
    }
}

/// Work and shear stress over the shear modulus after shear, stretch, and back in the same order.
fn closed_cycle(law: &LawChoice, e: f64) -> (f64, f64) {
    let (_, shear) = ELASTICITY.lame();
    let mut point = Point::<2>::new(law, Plane::Strain);
    let mut work = 0.0;
    for (stretch, slide) in [(1.0, e), (1.0 + e, e), (1.0 + e, 0.0), (1.0, 0.0)] {
        let (from, steps) = (point.f, 2000);
        let (stretch_from, slide_from) = (from[(0, 0)], from[(0, 1)]);
        for k in 1..=steps {
            let s = f64::from(k) / f64::from(steps);
            let l = stretch_from + (stretch - stretch_from) * s;
            let f = Matrix::<2>::new(l, slide_from + (slide - slide_from) * s, 0.0, 1.0 / l);
            let increment = (f - point.f) * inverse(&point.f);
            let rate = increment * inverse(&(Matrix::identity() + increment * 0.5));
            let before = point.tau();
            point.step(increment, 0.0);
            work += ((before + point.tau()) * 0.5).dot(&rate);
        }
    }
    (work / shear, point.tau()[(0, 1)] / shear)
}

#[test]
fn a_closed_cycle_costs_nothing_but_with_the_jaumann_rate() {
    for law in LawChoice::samples(ELASTICITY) {
        let (work, shear) = closed_cycle(&law, 0.3);
        if law.is_hyperelastic() {
            assert!(
                work.abs() < 1e-7 && shear.abs() < 1e-12,
                "{law:?}: {work} {shear}"
            );
        } else {
            println!("{law:?} {work} {shear} {:?}", closed_cycle(&law, 0.5));
            assert!((work - 1.48e-3).abs() < 5e-6, "{law:?}: {work}");
            assert!((shear - 0.0430).abs() < 5e-5, "{law:?}: {shear}");
        }
    }
}

#[test]
fn plane_stress_without_a_solution_is_not_a_number() {
    let law = LawChoice::StVenantKirchhoff(StVenantKirchhoff {
        elasticity: ELASTICITY,
    });
    let point = Point::at(&law, Plane::Stress, Matrix::<2>::identity() * 2.0, 1.0);
    assert!(point.tau()[(0, 0)].is_nan());
}

#[test]
fn blocks_of_points_may_be_updated_from_several_threads() {
    let law = LawChoice::NeoHookean(NeoHookean {
        elasticity: ELASTICITY,
    });
    let count = 1000;
    let mut numbers = Values(9);
    let rates: Vec<Matrix<2>> = (0..count).map(|_| numbers.matrix(0.1)).collect();
    let run = |blocks: usize| {
        let points = law.points::<2>(Plane::Stress, count);
        let mut stress = vec![0.0; 3 * count];
        let size = count / blocks;
        std::thread::scope(|scope| {
            for (k, plane) in stress.chunks_mut(3 * size).enumerate() {
                let (points, rates) = (&points, &rates[k * size..][..size]);
                scope.spawn(move || {
                    let increments = Increments {
                        rates: &FourRates::of(rates, 0.0),
                        hoop_rates: &[],
                        hoop_stretches: &[],
                        dt: 1.0,
                        instructions: Instructions::Widest,
                    };
                    let stress = StressMut {
                        plane,
                        hoop: &mut [],
                        reference: ReferenceMut::default(),
                    };
                    // SAFETY: the blocks do not overlap.
                    unsafe { points.update(k * size..(k + 1) * size, stress, &increments) };
                });
            }
        });
        let mut bits: Vec<u64> = stress.iter().map(|x| x.to_bits()).collect();
        points.state_bits(&mut bits);
        bits
    };
    let alone = run(1);
    assert_eq!(alone.len(), count * (3 + 5));
    assert_eq!(alone, run(4));
}

#[test]
fn reordered_points_keep_their_memory() {
    let law = LawChoice::NeoHookean(NeoHookean {
        elasticity: ELASTICITY,
    });
    let count = 10;
    let mut points = law.points::<1>(Plane::Strain, count);
    let rates: Vec<Matrix<1>> = (0..count).map(|i| Matrix::from_element(i as f64)).collect();
    let mut stress = vec![0.0; count];
    let increments = Increments {
        rates: &FourRates::of(&rates, 0.0),
        hoop_rates: &[],
        hoop_stretches: &[],
        dt: 1.0,
        instructions: Instructions::Widest,
    };
    let all = StressMut {
        plane: &mut stress,
        hoop: &mut [],
        reference: ReferenceMut::default(),
    };
    // SAFETY: nobody else knows these points.
    unsafe { points.update(0..count, all, &increments) };
    let copy = points.clone();
    let targets = [3_u32, 1, 0, 2, 9, 8, 7, 6, 5, 4];
    let (mut order, mut leaders) = (Vec::new(), Vec::new());
    crate::reorder::cycles(&mut targets.clone(), &mut order, &mut leaders);
    points.permute(&order, &leaders);
    for (i, &to) in targets.iter().enumerate() {
        assert_eq!(points.volume_ratio(to as usize, 1.0), 1.0 + i as f64);
    }
    assert_eq!(copy.volume_ratio(0, 1.0), 1.0);
    assert_eq!((copy.count(), copy.bytes_per_point()), (count, 8));

    let mut packed = [0.0];
    pack(&Matrix::<1>::from_element(stress[4]), &mut packed);
    let present = Present {
        stress: &packed,
        hoop_stress: &[],
        hoop_stretches: &[],
    };
    let one = copy.energy(4..5, &present, &|_| 1.0);
    assert!((copy.energy(4..5, &present, &|_| 2.5) / one - 2.5).abs() < 1e-15);
}
