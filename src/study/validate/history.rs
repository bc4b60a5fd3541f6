//! What a case reads from recorded histories.

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

/// The frequency near `guess` (within a tenth), Hz, at which a history that spans several periods swings most: where the
/// Fourier integral of its swing about the mean, seen through a Hann window, is largest. The window keeps other modes out.
pub fn frequency_near(time: &[f64], values: &[f64], guess: f64) -> f64 {
    let (Some(first), Some(end)) = (time.first(), time.last()) else {
        return f64::NAN;
    };
    let window: Vec<f64> = time
        .iter()
        .map(|t| 0.5 - 0.5 * (TAU * (t - first) / (end - first)).cos())
        .collect();
    let weight: f64 = window.iter().sum();
    let mean = window.iter().zip(values).map(|(w, y)| w * y).sum::<f64>() / weight;
    let power = |frequency: f64| {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for ((t, y), w) in time.iter().zip(values).zip(&window) {
            let angle = TAU * frequency * t;
            cosine += w * (y - mean) * angle.cos();
            sine += w * (y - mean) * angle.sin();
        }
        cosine * cosine + sine * sine
    };
    let (mut low, mut high) = (0.9 * guess, 1.1 * guess);
    for _ in 0..60 {
        let third = (high - low) / 3.0;
        if power(low + third) < power(high - third) {
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
}
