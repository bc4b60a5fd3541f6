use super::*;

/// Numbers of every size and kind.
fn numbers() -> Vec<f64> {
    let mut all = vec![
        0.0,
        -0.0,
        -1.0,
        1.0,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MIN_POSITIVE,
        f64::MIN_POSITIVE / 3.0,
        5e-324,
        f64::MAX,
        -f64::MAX,
        1.0 + f64::EPSILON,
        1.0 - f64::EPSILON / 2.0,
        -1.0 + f64::EPSILON / 2.0,
        std::f64::consts::SQRT_2,
        std::f64::consts::FRAC_1_SQRT_2,
        std::f64::consts::E,
    ];
    let mut state = 1_u64;
    for k in 0..400_000 {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        all.push(f64::from_bits(state)); // any exponent, any sign
        let unit = (state >> 11) as f64 / (1_u64 << 53) as f64;
        all.push(3.0 * unit);
        all.push((unit - 0.5) * 1500.0);
        all.push((unit - 0.5) * 10.0_f64.powi(-(k % 20)));
    }
    all.resize(all.len().next_multiple_of(8), 1.0);
    all
}

/// The distance of two numbers in units in the last place of the second; 0 if both are the same infinity or NaN.
fn distance(x: f64, exact: f64) -> f64 {
    if x == exact || (x.is_nan() && exact.is_nan()) {
        return 0.0;
    }
    let ulp = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
    (x - exact).abs() / ulp
}

#[inline(always)]
fn functions<R: Real>() {
    for some in numbers().chunks_exact(R::LANES) {
        let mut x = [R::splat(0.0)];
        R::read_rows(some, &mut x);
        let (ln, ln_1p, exp_m1) = (x[0].ln(), x[0].ln_1p(), x[0].exp_m1());
        for k in 0..R::LANES {
            // the library is right to half a unit or little more
            let error = distance(ln.lane(k), some[k].ln());
            assert!(error <= 1.0, "ln {:e}: {error} ulp", some[k]);
            let error = distance(ln_1p.lane(k), some[k].ln_1p());
            assert!(error <= 2.0, "ln(1 + {:e}): {error} ulp", some[k]);
            let error = distance(exp_m1.lane(k), some[k].exp_m1());
            assert!(error <= 3.0, "exp({:e}) - 1: {error} ulp", some[k]);
        }
    }
}

#[inline(always)]
fn arithmetic<R: Real>() {
    let a = [1.5, -2.0, 1e9, -0.25, 7.75, -1e-9, -3.5, 2.0];
    let b = [3.0, 0.5, -7.0, f64::NAN, 7.75, 1.0, -4.0, f64::INFINITY];
    let (mut x, mut y) = ([R::splat(0.0)], [R::splat(0.0)]);
    R::read_rows(&a[..R::LANES], &mut x);
    R::read_rows(&b[..R::LANES], &mut y);
    let (x, y) = (x[0], y[0]);
    let (more, less) = (x.greater(y), x.less(y));
    let both = (more | less) & !more & x.at_most(y);
    let chosen = R::select(more, x, y);
    for k in 0..R::LANES {
        let (a, b) = (a[k], b[k]);
        let same = |x: R, exact: f64| assert_eq!(x.lane(k).to_bits(), exact.to_bits());
        same(x + x, a + a);
        same(x - x * 2.0, a - a * 2.0);
        same(x / 3.0, a / 3.0);
        same(-x, -a);
        same(x.abs().sqrt(), a.abs().sqrt());
        same(x.floor(), a.floor());
        same(x.min(y), if a < b { a } else { b });
        same(x.max(y), if a > b { a } else { b });
        same(x.abs().copysign(x), a);
        same(x.with_lane(k, 5.0), 5.0);
        same(x.mul_add(R::splat(2.0), R::splat(1.0)), a * 2.0 + 1.0);
        same(chosen, if a > b { a } else { b });
        assert_eq!(
            (more.lane(k), less.lane(k), both.lane(k)),
            (a > b, a < b, a < b)
        );
    }
    assert!(!more.all() && (more | !more).all());
}

#[inline(always)]
fn rows<R: Real, const WIDTH: usize>() {
    let rows: Vec<f64> = (0..R::LANES * WIDTH).map(|i| i as f64).collect();
    let mut numbers = [R::splat(0.0); WIDTH];
    R::read_rows(&rows, &mut numbers);
    for i in 0..WIDTH {
        for k in 0..R::LANES {
            assert_eq!(numbers[i].lane(k), (k * WIDTH + i) as f64);
        }
    }
    let mut written = vec![0.0; rows.len()];
    R::write_rows(&mut written, &numbers);
    assert_eq!(written, rows);
    // rows that go on: the last one as far as it is read, or longer
    let stride = WIDTH + 5;
    for more in [0, 1, 5] {
        let padded: Vec<f64> = (0..(R::LANES - 1) * stride + WIDTH + more)
            .map(|i| i as f64)
            .collect();
        R::read_strided(&padded, stride, &mut numbers);
        for i in 0..WIDTH {
            for k in 0..R::LANES {
                assert_eq!(numbers[i].lane(k), (k * stride + i) as f64);
            }
        }
        let mut written = vec![-1.0; padded.len()];
        R::write_strided(&mut written, stride, &numbers);
        for (i, number) in written.iter().enumerate() {
            let expected = if i % stride < WIDTH { i as f64 } else { -1.0 };
            assert_eq!(*number, expected);
        }
    }
    // fours that lie apart
    let fours: Vec<f64> = (0..stride + 4).map(|i| i as f64).collect();
    let number = R::read_fours(&fours, stride);
    for k in 0..R::LANES {
        assert_eq!(number.lane(k), (k / 4 * stride + k % 4) as f64);
    }
}

#[test]
fn the_last_row_stands_for_those_that_there_are_not() {
    let rows = [1.0, 2.0, 3.0, 4.0];
    assert_eq!(
        filled_up(&rows, 2),
        [1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 3.0, 4.0, 0.0]
    );
    assert_eq!(filled_up(&rows[..3], 1), [1.0, 2.0, 3.0, 3.0]);
    assert_eq!(filled_up(&[], 1), [0.0; 4]);
    assert_eq!(filled_up(&[], 0), [0.0; 4]);
}

#[inline(always)]
fn all<R: Real>() {
    functions::<R>();
    arithmetic::<R>();
    rows::<R, 1>();
    rows::<R, 2>();
    rows::<R, 3>();
    rows::<R, 4>();
    rows::<R, 5>();
    rows::<R, 6>();
    rows::<R, 9>();
    rows::<R, 10>();
}

#[test]
fn four_portable_numbers_compute_like_four_single_ones() {
    all::<Portable>();
}

#[cfg(target_arch = "x86_64")]
#[test]
fn wide_numbers_compute_like_single_ones() {
    #[target_feature(enable = "avx2,fma")]
    fn wide() {
        all::<Avx>();
    }
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq")]
    fn widest() {
        all::<Avx512>();
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
