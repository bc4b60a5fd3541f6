//! What nothing beats, and how fast errors fall.

/// A dearer run has to be better by this share: less is no accuracy, but luck or round-off.
const WORTH: f64 = 0.01;

/// Indices of the runs that no cheaper one matches to a hundredth of its error, from cheap to dear. Entries with a number that is
/// not finite are left out.
pub fn frontier(runs: &[(f64, f64)]) -> Vec<usize> {
    let finite = |i: &usize| runs[*i].0.is_finite() && runs[*i].1.is_finite();
    let mut order: Vec<usize> = (0..runs.len()).filter(finite).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (runs[a], runs[b]);
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = runs[i].1 < (1.0 - WORTH) * least;
        if better {
            least = runs[i].1;
        }
        better
    });
    order
}

/// The order p of errors that go as cells⁻ᵖ: the slope of the least-squares line through the logarithms. NaN for fewer than two
/// runs with a positive error.
pub fn order(cells: &[f64], errors: &[f64]) -> f64 {
    let pairs = cells.iter().zip(errors);
    let logs: Vec<(f64, f64)> = pairs
        .filter(|(n, e)| **n > 0.0 && **e > 0.0 && e.is_finite())
        .map(|(n, e)| (n.ln(), e.ln()))
        .collect();
    let count = logs.len() as f64;
    let (x, y) = logs
        .iter()
        .fold((0.0, 0.0), |(x, y), (a, b)| (x + a / count, y + b / count));
    let (sxx, sxy) = logs.iter().fold((0.0, 0.0), |(xx, xy), (a, b)| {
        (xx + (a - x).powi(2), xy + (a - x) * (b - y))
    });
    if sxx > 0.0 { -sxy / sxx } else { f64::NAN }
}

/// The median; NaN of nothing.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frontier_is_what_nothing_beats() {
        let runs = [
            (4.0, 0.1),
            (1.0, 1.0),
            (2.0, 0.5),
            (3.0, 0.6),
            (2.0, 0.5),
            (f64::NAN, 0.0),
            (0.5, f64::INFINITY),
            (9.0, 0.0999),
        ];
        assert_eq!(frontier(&runs), [1, 2, 0]);
        assert!(frontier(&[]).is_empty());
    }

    #[test]
    fn the_order_of_a_power_is_its_exponent() {
        let cells = [8.0, 16.0, 32.0, 64.0];
        let errors = cells.map(|n: f64| 3.0 * n.powf(-1.7));
        assert!((order(&cells, &errors) - 1.7).abs() < 1e-12);
        // a run that failed has no error and does not count
        assert!((order(&cells[..3], &[errors[0], f64::NAN, errors[2]]) - 1.7).abs() < 1e-12);
        assert!(order(&[8.0], &[0.1]).is_nan() && order(&[8.0, 8.0], &[0.1, 0.2]).is_nan());
    }

    #[test]
    fn the_median_does_not_care_for_an_outlier() {
        assert_eq!(median(&[3.0, 1e9, 1.0]), 3.0);
        assert_eq!(median(&[1.0, 3.0]), 2.0);
        assert!(median(&[]).is_nan());
    }
}
