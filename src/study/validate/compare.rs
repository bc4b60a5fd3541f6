//! Small tools that several cases share: curves, norms, orders of convergence.

use crate::observe::Point;
use crate::report::{LineChart, Series, Style};

/// A chart of one panel.
pub fn chart(title: &str, x_label: &str, y_label: &str, series: Vec<Series>) -> LineChart {
    LineChart {
        title: title.into(),
        x_label: x_label.into(),
        y_label: y_label.into(),
        series,
        ..LineChart::default()
    }
}

/// A curve from two columns.
pub fn curve(name: impl Into<String>, x: &[f64], y: &[f64], style: Style) -> Series {
    Series::new(
        name,
        x.iter().copied().zip(y.iter().copied()).collect(),
        style,
    )
}

/// A function of every entry of a column.
pub fn map(column: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    column.iter().map(|&x| f(x)).collect()
}

/// Largest `|computed − exact|`.
pub fn largest(computed: &[f64], exact: &[f64]) -> f64 {
    let differences = computed.iter().zip(exact).map(|(c, e)| (c - e).abs());
    differences.fold(0.0, larger)
}

/// The larger of two; not a number if one of them is not, which `f64::max` would forget.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// Orders of convergence between neighbours: ln(e₁/e₂) / ln(h₁/h₂).
pub fn orders(sizes: &[f64], errors: &[f64]) -> Vec<f64> {
    let pairs = sizes.windows(2).zip(errors.windows(2));
    pairs
        .map(|(h, e)| (e[0] / e[1]).ln() / (h[0] / h[1]).ln())
        .collect()
}

/// Root of the volume-weighted mean of a square over points.
pub fn root_mean(points: &[Point], square: impl Fn(usize, &Point) -> f64) -> f64 {
    let volume: f64 = points.iter().map(|point| point.initial_volume).sum();
    let sum: f64 = points
        .iter()
        .enumerate()
        .map(|(i, point)| point.initial_volume * square(i, point))
        .sum();
    (sum / volume).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_a_power_is_its_exponent_whatever_the_sizes() {
        let sizes = [0.3, 0.1, 0.02];
        let found = orders(&sizes, &sizes.map(|h: f64| 7.0 * h.powf(1.5)));
        assert_eq!(found.len(), 2);
        assert!(found.iter().all(|order| (order - 1.5).abs() < 1e-12));
    }

    #[test]
    fn the_largest_difference_is_not_hidden_by_what_is_no_number() {
        assert_eq!(largest(&[1.0, 5.0, 2.0], &[1.5, 3.0, 2.0]), 2.0);
        assert!(largest(&[f64::NAN, 5.0], &[1.0, 3.0]).is_nan());
        assert!(largest(&[5.0, f64::NAN, 1.0], &[3.0, 1.0, 1.0]).is_nan());
    }

    #[test]
    fn points_count_by_their_volume() {
        let of = |initial_volume| Point {
            initial_volume,
            ..Point::default()
        };
        let mean = root_mean(&[of(1.0), of(3.0)], |i, _| [4.0, 0.0][i]);
        assert_eq!(mean, 1.0);
    }
}
