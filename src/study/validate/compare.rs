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
    // not `f64::max`, which would forget a NaN
    let worst = |worst: f64, difference: f64| {
        if difference <= worst {
            worst
        } else {
            difference
        }
    };
    let differences = computed.iter().zip(exact).map(|(c, e)| (c - e).abs());
    differences.fold(0.0, worst)
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
