//! Curves over two axes.

use super::axis::{Axis, Ticks};
use super::color::{Color, FRAME, INK, PALETTE};
use super::curve;
use super::font;
use super::frame::Sides;
use super::picture::{Anchor, Disc, Picture, Rect, Shape, Size};
use std::io;
use std::path::Path;

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// A solid line, for computed values at many points.
    #[default]
    Line,
    /// A thin dark dashed line above the lines and below the markers of other series, for exact solutions and limits: where it
    /// coincides with a computed curve, both are seen.
    Dashed,
    /// A dot at each point.
    Markers,
    /// A line with dots, no denser than the eye can part.
    LineMarkers,
}

/// One curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// For the legend; a series without a name is not listed there.
    pub name: String,
    /// Points in order. One that cannot be drawn (not finite, or not positive on a logarithmic axis) leaves a gap.
    pub points: Vec<(f64, f64)>,
    /// How it is drawn.
    pub style: Style,
    /// Instead of the next one of [`PALETTE`] (dashed series: dark).
    pub color: Option<Color>,
}

impl Series {
    /// A series in the next color.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>, style: Style) -> Self {
        Self {
            name: name.into(),
            points,
            style,
            color: None,
        }
    }
}

/// Curves in one frame, with a legend that never covers them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineChart {
    /// Above the frame; may be empty.
    pub title: String,
    /// What runs to the right, with its unit: `time (s)`.
    pub x_label: String,
    /// What runs upwards, with its unit.
    pub y_label: String,
    /// Whether x is logarithmic.
    pub x_log: bool,
    /// Whether y is logarithmic.
    pub y_log: bool,
    /// What x the frame shows, if not all of the data: a run that blew up would flatten all others.
    pub x_range: Option<[f64; 2]>,
    /// What y the frame shows, if not all of the data.
    pub y_range: Option<[f64; 2]>,
    /// The curves.
    pub series: Vec<Series>,
}

impl LineChart {
    /// Writes the chart in the default size, as PNG or SVG by the file's ending.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        panels(std::slice::from_ref(self), path, Size::default())
    }

    fn axes(&self) -> (Axis, Axis) {
        let points = || self.series.iter().flat_map(|s| &s.points);
        let dots = self
            .series
            .iter()
            .any(|s| matches!(s.style, Style::Markers | Style::LineMarkers));
        let x = Axis::new(
            self.x_log,
            self.x_range,
            points().map(|p| p.0),
            if dots { 0.03 } else { 0.0 },
        );
        let y = Axis::new(self.y_log, self.y_range, points().map(|p| p.1), 0.06);
        (x, y)
    }

    /// The color of every series.
    fn colors(&self) -> Vec<Color> {
        let (mut solid, mut dashed) = (PALETTE.iter().cycle(), [INK, FRAME].iter().cycle());
        let next = |series: &Series| {
            let own = if series.style == Style::Dashed {
                dashed.next()
            } else {
                solid.next()
            };
            series.color.or(own.copied()).unwrap_or(INK)
        };
        self.series.iter().map(next).collect()
    }
}

/// Writes several charts as panels of one picture, as PNG or SVG by the file's ending.
pub fn panels(charts: &[LineChart], path: &Path, size: Size) -> io::Result<()> {
    picture(charts, size).write(path)
}

/// Lays the charts out in rows.
pub(crate) fn picture(charts: &[LineChart], size: Size) -> Picture {
    let mut picture = Picture::new(size);
    let columns = columns(charts.len(), size);
    let rows = charts.len().div_ceil(columns).max(1);
    let cell = (
        f64::from(size.width) / columns as f64,
        f64::from(size.height) / rows as f64,
    );
    let unit = unit(cell.0, cell.1);
    let rect = |i: usize| {
        let (left, top) = ((i % columns) as f64 * cell.0, (i / columns) as f64 * cell.1);
        let (outer, inner) = (22.0 * unit, 10.0 * unit);
        Rect::new(
            left + outer,
            top + inner,
            left + cell.0 - outer,
            top + cell.1 - inner,
        )
    };
    let plans: Vec<Plan> = charts
        .iter()
        .enumerate()
        .map(|(i, chart)| Plan::new(chart, rect(i), unit))
        .collect();
    for (i, plan) in plans.iter().enumerate() {
        // Frames in one column begin at the same x.
        let left = plans
            .iter()
            .skip(i % columns)
            .step_by(columns)
            .map(|p| p.margin)
            .fold(0.0, f64::max);
        plan.draw(left, &mut picture);
    }
    picture
}

/// How many panels stand side by side: what brings a panel nearest to 8 : 5.
fn columns(panels: usize, size: Size) -> usize {
    let misfit = |columns: usize| {
        let rows = panels.div_ceil(columns);
        let aspect =
            f64::from(size.width) * rows as f64 / (f64::from(size.height.max(1)) * columns as f64);
        (aspect / 1.6).ln().abs() + 0.3 * (rows * columns - panels) as f64 / rows as f64
    };
    (1..=panels.clamp(1, 64))
        .min_by(|&a, &b| misfit(a).total_cmp(&misfit(b)))
        .unwrap_or(1)
}

/// What a length of 1 in the layout is in pixels, so that text grows with a panel.
pub(crate) fn unit(width: f64, height: f64) -> f64 {
    (width / 800.0).min(height / 500.0).clamp(0.5, 4.0)
}

pub(crate) const TITLE: f64 = 18.0;
pub(crate) const LABEL: f64 = 15.0;
pub(crate) const TICK: f64 = 14.0;

/// A chart with all that must be known before its frame can be placed.
struct Plan<'a> {
    chart: &'a LineChart,
    rect: Rect,
    unit: f64,
    x: Axis,
    y: Axis,
    y_ticks: Ticks,
    colors: Vec<Color>,
    /// Room left of the frame.
    margin: f64,
}

impl<'a> Plan<'a> {
    fn new(chart: &'a LineChart, rect: Rect, unit: f64) -> Self {
        let (x, y) = chart.axes();
        let y_ticks = y.ticks((rect.height() / (75.0 * unit)) as usize);
        let widest = y_ticks
            .marks
            .iter()
            .map(|t| font::width(&t.label, TICK * unit))
            .fold(0.0, f64::max);
        let label = if chart.y_label.is_empty() {
            0.0
        } else {
            LABEL + 10.0
        };
        let margin = widest + (label + 8.0) * unit;
        Self {
            chart,
            rect,
            unit,
            x,
            y,
            y_ticks,
            colors: chart.colors(),
            margin,
        }
    }

    fn draw(&self, margin: f64, picture: &mut Picture) {
        let (u, rect) = (self.unit, &self.rect);
        let left = rect.left + margin;
        let mut top = rect.top + 8.0 * u;
        if !self.chart.title.is_empty() {
            top += TITLE * u;
            picture.text(
                (left, top - 2.0 * u),
                &self.chart.title,
                TITLE * u,
                INK,
                Anchor::Start,
            );
            top += 8.0 * u;
        }
        top = self.legend(left, top, picture);
        if !self.y_ticks.note.is_empty() {
            top += TICK * u;
            let x = left - font::width(&self.y_ticks.note, TICK * u).min(margin);
            picture.text((x, top), &self.y_ticks.note, TICK * u, INK, Anchor::Start);
            top += 4.0 * u;
        }
        let below = TICK
            + 10.0
            + if self.chart.x_label.is_empty() {
                0.0
            } else {
                LABEL + 10.0
            };
        let frame = Rect::new(left, top + 6.0 * u, rect.right, rect.bottom - below * u);
        let x_ticks = self.x.ticks((frame.width() / (105.0 * u)) as usize);
        let sides = Sides {
            rect: self.rect,
            frame,
            unit: self.unit,
            x: (&self.x, &x_ticks, &self.chart.x_label),
            y: (&self.y, &self.y_ticks, &self.chart.y_label),
        };
        sides.draw(picture);
        self.draw_series(&frame, picture);
    }

    /// Names in rows from the left; returns where they end.
    fn legend(&self, left: f64, mut top: f64, picture: &mut Picture) -> f64 {
        let (u, size) = (self.unit, TICK * self.unit);
        let gap = 22.0 * u;
        let mut x = left;
        let named = self
            .chart
            .series
            .iter()
            .zip(&self.colors)
            .filter(|(s, _)| !s.name.is_empty());
        for (i, (series, &color)) in named.enumerate() {
            let sample = if series.style == Style::Markers {
                9.0
            } else {
                30.0
            } * u;
            let width = sample + 7.0 * u + font::width(&series.name, size);
            if i == 0 {
                top += 20.0 * u;
            } else if x + width > self.rect.right {
                x = left;
                top += 20.0 * u;
            }
            let y = top - 0.5 * font::CAP_HEIGHT * size;
            let middle = vec![(x + sample / 2.0, y)];
            self.stroke(vec![(x, y), (x + sample, y)], series.style, color, picture);
            self.dots(middle, series.style, color, &self.rect, picture);
            picture.text(
                (x + sample + 7.0 * u, top),
                &series.name,
                size,
                INK,
                Anchor::Start,
            );
            x += width + gap;
        }
        top + 4.0 * u
    }

    fn draw_series(&self, frame: &Rect, picture: &mut Picture) {
        let place = |&(x, y): &(f64, f64)| {
            let (x, y) = (self.x.share(x)?, self.y.share(y)?);
            Some((
                frame.left + x * frame.width(),
                frame.bottom - y * frame.height(),
            ))
        };
        let all = || self.chart.series.iter().zip(&self.colors);
        for dashed in [false, true] {
            for (series, &color) in all().filter(|(s, _)| (s.style == Style::Dashed) == dashed) {
                for piece in curve::pieces(series.points.iter().map(place), frame) {
                    self.stroke(piece, series.style, color, picture);
                }
            }
        }
        for (series, &color) in all() {
            let inside = |p: &(f64, f64)| {
                let slack = 1e-6;
                p.0 >= frame.left - slack
                    && p.0 <= frame.right + slack
                    && p.1 >= frame.top - slack
                    && p.1 <= frame.bottom + slack
            };
            let points: Vec<_> = series
                .points
                .iter()
                .filter_map(place)
                .filter(inside)
                .collect();
            // Dots at the frame's edge stay whole.
            self.dots(points, series.style, color, &self.rect, picture);
        }
    }

    fn stroke(&self, points: Vec<(f64, f64)>, style: Style, color: Color, picture: &mut Picture) {
        let u = self.unit;
        let (width, dash) = match style {
            Style::Markers => return,
            Style::Line => (3.2 * u, vec![]),
            Style::LineMarkers => (2.0 * u, vec![]),
            // Dashes that a tangle of lines hides anyway would cost more time than all else.
            Style::Dashed if curve::length(&points) > 1e5 * u => (1.3 * u, vec![]),
            Style::Dashed => (1.3 * u, vec![6.0 * u, 6.0 * u]),
        };
        picture.shapes.push(Shape::Line {
            points,
            color,
            width,
            dash,
        });
    }

    fn dots(
        &self,
        points: Vec<(f64, f64)>,
        style: Style,
        color: Color,
        clip: &Rect,
        picture: &mut Picture,
    ) {
        let points = match style {
            Style::Line | Style::Dashed => return,
            Style::Markers => curve::spaced(points, 0.5),
            Style::LineMarkers => curve::spaced(points, 14.0 * self.unit),
        };
        let discs = points
            .into_iter()
            .map(|(x, y)| Disc { x, y, color })
            .collect();
        picture.shapes.push(Shape::Discs {
            discs,
            radius: 4.0 * self.unit,
            clip: *clip,
        });
    }
}

#[cfg(test)]
#[path = "chart_tests.rs"]
mod tests;
