//! What a case reads from recorded histories.

use super::compare::map;
use std::f64::consts::TAU;

/// Pairs of two columns, for a chart.
pub fn points(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    x.iter().copied().zip(y.iter().copied()).collect()
}

/// Every value times `factor`.
pub fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// Every value less the first one.
pub fn from_start(values: &[f64]) -> Vec<f64> {
    values.iter().map(|value| value - values[0]).collect()
}

/// The largest absolute value.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// The last value; NaN, which passes no check, if there is none.
pub fn last(values: &[f64]) -> f64 {
    values.last().copied().unwrap_or(f64::NAN)
}

/// The frequency near `guess` (within a tenth), Hz, of the swing about a constant that fits a history of two periods or more best, in least
/// squares seen through a Hann window. The window keeps other modes out. A single swing is found exactly, however few periods there are:
/// where its Fourier integral is largest is 0.1 % beside it in three periods, for the swing's own negative frequency is not far.
pub fn frequency_near(time: &[f64], values: &[f64], guess: f64) -> f64 {
    let (Some(first), Some(end)) = (time.first(), time.last()) else {
        return f64::NAN;
    };
    let window = map(time, |t| {
        0.5 - 0.5 * (TAU * (t - first) / (end - first)).cos()
    });
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let pairs = a.iter().zip(b);
        window.iter().zip(pairs).map(|(w, (a, b))| w * a * b).sum()
    };
    let ones = vec![1.0; time.len()];
    let about_mean = |column: Vec<f64>| {
        let mean = product(&column, &ones) / product(&ones, &ones);
        map(&column, |value| value - mean)
    };
    let swing = about_mean(values.to_vec());
    // the square of what the best cosine and sine of a frequency explain
    let explained = |frequency: f64| {
        let cosine = about_mean(map(time, |t| (TAU * frequency * t).cos()));
        let sine = about_mean(map(time, |t| (TAU * frequency * t).sin()));
        let (y_c, y_s) = (product(&swing, &cosine), product(&swing, &sine));
        let (c_c, s_s, c_s) = (
            product(&cosine, &cosine),
            product(&sine, &sine),
            product(&cosine, &sine),
        );
        (y_c * y_c * s_s - 2.0 * y_c * y_s * c_s + y_s * y_s * c_c) / (c_c * s_s - c_s * c_s)
    };
    let (mut low, mut high) = (0.9 * guess, 1.1 * guess);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if explained(low + third) < explained(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frequency_of_a_swing_is_found_beside_a_second_mode() {
        let time: Vec<f64> = (0..=800).map(|i| f64::from(i) * 1e-2).collect();
        let swing = |t: &f64| 1.0 - (TAU * 1.5 * t).cos() + 0.2 * (TAU * 3.7 * t).sin();
        let values: Vec<f64> = time.iter().map(swing).collect();
        let found = frequency_near(&time, &values, 1.45);
        assert!((found - 1.5).abs() < 1e-3, "{found}");
    }

    #[test]
    fn a_few_periods_of_a_single_swing_give_its_frequency() {
        for periods in [2.0, 3.0, 4.0] {
            let time: Vec<f64> = (0..=160).map(|i| f64::from(i) / 160.0 * periods).collect();
            let swing = map(&time, |t| 0.3 + (TAU * 1.004 * t).sin());
            let found = frequency_near(&time, &swing, 1.0);
            assert!((found - 1.004).abs() < 1e-7, "{found}");
        }
    }
}
