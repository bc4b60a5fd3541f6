//! Where something starts to fail.

/// The smallest value of `[low, high]` at which `fails`, to the share `tolerance` of it; infinite if it fails nowhere, `low` if
/// it fails from the start.
///
/// Windows of stability above the first failure are real and of no use to anybody: the range is first walked upwards in steps of
/// `stride`, and only the first step that fails is bisected.
pub fn first_failure(
    [low, high]: [f64; 2],
    stride: f64,
    tolerance: f64,
    mut fails: impl FnMut(f64) -> bool,
) -> f64 {
    if fails(low) {
        return low;
    }
    let (mut good, mut bad) = (low, low);
    while bad < high {
        bad = (good + stride).min(high);
        if fails(bad) {
            break;
        }
        if bad >= high {
            return f64::INFINITY;
        }
        good = bad;
    }
    while bad - good > tolerance * bad {
        let middle = 0.5 * (good + bad);
        if fails(middle) {
            bad = middle;
        } else {
            good = middle;
        }
    }
    0.5 * (good + bad)
}

#[cfg(test)]
mod tests {
    use super::first_failure;

    #[test]
    fn the_first_failure_is_found_before_a_window_above_it() {
        let fails = |x: f64| (1.3..1.5).contains(&x) || x > 2.0;
        let found = first_failure([0.1, 3.0], 0.1, 1e-4, fails);
        assert!((found - 1.3).abs() < 2e-4, "{found}");
    }

    #[test]
    fn failing_nowhere_and_failing_at_once_are_told_apart() {
        assert_eq!(
            first_failure([0.1, 3.0], 0.1, 1e-4, |_| false),
            f64::INFINITY
        );
        assert_eq!(first_failure([0.1, 3.0], 0.1, 1e-4, |_| true), 0.1);
    }
}
