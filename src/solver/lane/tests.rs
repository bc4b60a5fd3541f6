use super::*;
use crate::real::Instructions;

/// Numbers that tell their places.
fn numbers(count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64).collect()
}

/// Room for numbers that stand where nodes do.
#[repr(align(32))]
struct Node([f64; 4]);

#[inline(always)]
fn points_of<P: Points, const D: usize>() {
    let given = numbers(P::LANES * D);
    // SAFETY: so many numbers there are, and so many are written
    let (points, written) = unsafe {
        let points = P::load_points::<D>(given.as_ptr());
        let mut written = vec![-1.0; given.len() + 1];
        P::store_points::<D>(&points, written.as_mut_ptr());
        (points, written)
    };
    for a in 0..D {
        for q in 0..P::LANES {
            assert_eq!(points[a].lane(q), (q * D + a) as f64);
            assert_eq!(points[a].four(q / 4).lane(q % 4), (q * D + a) as f64);
        }
    }
    assert_eq!(written[..given.len()], given);
    assert_eq!(written[given.len()], -1.0);
}

#[inline(always)]
fn every_method<P: Points>() {
    points_of::<P, 1>();
    points_of::<P, 2>();
    points_of::<P, 3>();

    let given = numbers(P::LANES);
    for count in 1..=P::LANES {
        // SAFETY: so many numbers there are
        let some = unsafe { P::load_some(given[P::LANES - count..].as_ptr(), count) };
        for q in 0..P::LANES {
            let expected = (P::LANES - count + q) as f64;
            assert_eq!(some.lane(q), if q < count { expected } else { 0.0 });
        }
    }

    let mut lane = [P::splat(0.0)];
    P::read_rows(&given, &mut lane);
    let [lane] = lane;
    let last = (P::LANES - 1) as f64;
    assert!(lane.all_within(0.0, last));
    assert!(!lane.all_within(0.5, last) && !lane.all_within(0.0, last - 0.5));
    for q in 0..P::LANES {
        assert!(!lane.with_lane(q, f64::NAN).all_within(f64::MIN, f64::MAX));
    }
    let mut whole = [u32::MAX; MOST_LANES];
    lane.whole(&mut whole);
    for q in 0..P::LANES {
        assert_eq!(whole[q] as usize, q);
    }

    let mut node = Node([0.5, 1.5, 2.5, 3.5]);
    let given = [lane, lane * 10.0, lane * 100.0, lane * 1000.0];
    // SAFETY: a node is four numbers, aligned
    unsafe { P::add_sums(given, node.0.as_mut_ptr()) };
    let sum: f64 = numbers(P::LANES).iter().sum();
    let expected = [
        0.5 + sum,
        1.5 + 10.0 * sum,
        2.5 + 100.0 * sum,
        3.5 + 1000.0 * sum,
    ];
    assert_eq!(node.0, expected);
}

#[test]
fn portable_lanes_read_and_write_what_they_say() {
    every_method::<Portable>();
}

#[cfg(target_arch = "x86_64")]
#[test]
fn wide_lanes_read_and_write_what_they_say() {
    #[target_feature(enable = "avx2,fma")]
    fn wide() {
        every_method::<crate::real::Avx>();
    }
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq")]
    fn widest() {
        every_method::<crate::real::Avx512>();
    }
    if Instructions::found() >= Instructions::Wide {
        // SAFETY: the instructions were found
        unsafe { wide() };
    }
    if Instructions::found() >= Instructions::Widest {
        // SAFETY: as above
        unsafe { widest() };
    }
}
