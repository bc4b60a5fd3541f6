//! Particles in the plane, colored by a value, at one or more times.

use super::axis::{Axis, Ticks};
use super::chart::{LABEL, TICK, TITLE};
use super::color::{Color, ColorMap, FRAME, GRID, INK, PALETTE};
use super::font;
use super::picture::{Anchor, Disc, Picture, Rect, Shape, Size};
use std::io;
use std::path::Path;

/// The particles at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Under the picture: `t = 0.5 s`; may be empty.
    pub label: String,
    /// Positions in the plane; one that is not finite is left out.
    pub points: Vec<[f64; 2]>,
    /// A value a particle, for its color; without one it is grey. `None`: all have one color.
    pub values: Option<Vec<f64>>,
}

/// Particles at one or more times side by side, to one scale and with one color bar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParticlePlot {
    /// Above the pictures; may be empty.
    pub title: String,
    /// What runs to the right, with its unit.
    pub x_label: String,
    /// What runs upwards, with its unit.
    pub y_label: String,
    /// What the color says, with its unit.
    pub value_label: String,
    /// Diameter of a particle in the unit of the positions; it is drawn at least a pixel wide.
    pub particle_size: f64,
    /// From values to colors.
    pub color_map: ColorMap,
    /// Values at the ends of the color bar, if not the lowest and the highest.
    pub value_range: Option<[f64; 2]>,
    /// Lower left and upper right corner of what is shown, if not just all particles.
    pub bounds: Option<[[f64; 2]; 2]>,
    /// Draws the lines of a grid that starts at the lower left corner of `bounds`, or at the origin.
    pub cell_size: Option<f64>,
    /// The times.
    pub frames: Vec<Frame>,
}

/// Pixels across a picture for which no size is asked.
const WIDTH: u32 = 1200;
/// More grid lines than this along an axis would be a grey field.
const MOST_LINES: f64 = 400.0;

impl ParticlePlot {
    /// Writes the picture 1200 pixels wide and as high as needed, as PNG or SVG by the file's ending.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.write_sized(path, self.fitting_size())
    }

    /// Writes the picture in a size of the caller's choice.
    pub fn write_sized(&self, path: &Path, size: Size) -> io::Result<()> {
        self.picture(size).write(path)
    }

    /// A size without large empty margins.
    pub(crate) fn fitting_size(&self) -> Size {
        let height = if self.frames.len() > 1 {
            WIDTH / 2
        } else {
            WIDTH * 3 / 4
        };
        let trial = Size {
            width: WIDTH,
            height,
        };
        let plan = Plan::new(self, trial);
        Size {
            width: WIDTH,
            height: (plan.bottom.ceil() as u32).clamp(120, trial.height),
        }
    }

    pub(crate) fn picture(&self, size: Size) -> Picture {
        let mut picture = Picture::new(size);
        Plan::new(self, size).draw(&mut picture);
        picture
    }

    /// The values of the color bar.
    fn value_axis(&self) -> Option<Axis> {
        let values = || {
            self.frames
                .iter()
                .filter_map(|f| f.values.as_ref())
                .flatten()
                .copied()
        };
        values().next()?;
        let largest = values()
            .filter(|v| v.is_finite())
            .fold(0.0, |most: f64, v| most.max(v.abs()));
        let range = match self.color_map {
            ColorMap::BlueRed => self.value_range.or(Some([-largest, largest])),
            ColorMap::Viridis => self.value_range,
        };
        Some(Axis::new(false, range, values(), 0.0))
    }
}

/// Where everything goes.
struct Plan<'a> {
    plot: &'a ParticlePlot,
    unit: f64,
    /// Position of the title's base line.
    title: (f64, f64),
    frames: Vec<Rect>,
    /// Pixels a length of one.
    scale: f64,
    x: Axis,
    y: Axis,
    y_ticks: Ticks,
    values: Option<Axis>,
    /// Where the drawing ends.
    bottom: f64,
}

impl<'a> Plan<'a> {
    fn new(plot: &'a ParticlePlot, size: Size) -> Self {
        let unit = (f64::from(size.width) / 1000.0).clamp(0.5, 4.0);
        let along = |axis: usize| {
            let range = plot
                .bounds
                .map(|corners| [corners[0][axis], corners[1][axis]]);
            let half = if plot.particle_size.is_finite() {
                0.5 * plot.particle_size.abs()
            } else {
                0.0
            };
            let all = plot
                .frames
                .iter()
                .flat_map(|f| &f.points)
                .filter(|p| p.iter().all(|c| c.is_finite()));
            Axis::new(
                false,
                range,
                all.flat_map(|p| [p[axis] - half, p[axis] + half]),
                0.04,
            )
        };
        let (x, y) = (along(0), along(1));
        let span = |axis: &Axis| axis.range()[1] - axis.range()[0];
        let (span_x, span_y) = (span(&x), span(&y));
        let values = plot.value_axis();

        let outer = 18.0 * unit;
        let y_ticks = y.ticks(4);
        let widest = y_ticks
            .marks
            .iter()
            .map(|t| font::width(&t.label, TICK * unit))
            .fold(0.0, f64::max);
        let label = if plot.y_label.is_empty() {
            0.0
        } else {
            LABEL + 8.0
        };
        let left = outer + widest + (8.0 + label) * unit;
        let right =
            f64::from(size.width) - outer - if values.is_some() { 118.0 * unit } else { 0.0 };
        let mut top = outer
            + if plot.title.is_empty() {
                0.0
            } else {
                (TITLE + 8.0) * unit
            };
        if !y_ticks.note.is_empty() {
            top += TICK * unit;
        }
        let below_label = if plot.x_label.is_empty() {
            0.0
        } else {
            LABEL + 6.0
        };
        let below = (TICK + 14.0 + below_label + LABEL + 12.0) * unit;
        let gap = 36.0 * unit;
        let room = |columns: usize| {
            let rows = plot.frames.len().div_ceil(columns).max(1);
            let wide = (right - left - gap * (columns - 1) as f64) / columns as f64;
            let high = (f64::from(size.height) - top - outer * 0.5) / rows as f64 - below;
            (wide.max(1.0) / span_x).min(high.max(1.0) / span_y)
        };
        // Empty places count against a number of columns.
        let merit = |columns: usize| {
            let places = plot.frames.len().div_ceil(columns) * columns;
            room(columns) * plot.frames.len() as f64 / places.max(1) as f64
        };
        let most = plot.frames.len().clamp(1, 12);
        let columns = (1..=most)
            .rev()
            .max_by(|&a, &b| merit(a).total_cmp(&merit(b)))
            .unwrap_or(1);
        let scale = room(columns);
        let (wide, high) = (span_x * scale, span_y * scale);
        let frame = |i: usize| {
            let (l, t) = (
                left + (i % columns) as f64 * (wide + gap),
                top + (i / columns) as f64 * (high + below),
            );
            Rect::new(l, t, l + wide, t + high)
        };
        let frames: Vec<Rect> = (0..plot.frames.len()).map(frame).collect();
        let bottom = frames.last().map_or(top, |f| f.bottom) + below + outer * 0.25;
        Self {
            plot,
            unit,
            title: (left, outer + TITLE * 0.8 * unit),
            frames,
            scale,
            x,
            y,
            y_ticks,
            values,
            bottom,
        }
    }

    fn draw(&self, picture: &mut Picture) {
        picture.text(
            self.title,
            &self.plot.title,
            TITLE * self.unit,
            INK,
            Anchor::Start,
        );
        for (frame, rect) in self.plot.frames.iter().zip(&self.frames) {
            self.draw_cells(rect, picture);
            self.draw_particles(frame, rect, picture);
            self.draw_axes(frame, rect, picture);
        }
        if let Some(values) = &self.values {
            self.draw_color_bar(values, picture);
        }
    }

    fn draw_cells(&self, rect: &Rect, picture: &mut Picture) {
        let Some(cell) = self.plot.cell_size.filter(|c| c.is_finite() && *c > 0.0) else {
            return;
        };
        let start = self.plot.bounds.map_or([0.0; 2], |corners| corners[0]);
        let lines = |axis: &Axis, start: f64| {
            let [low, high] = axis.range().map(|end| (end - start) / cell);
            let count = if high - low < MOST_LINES {
                high.floor() - low.ceil() + 1.0
            } else {
                0.0
            };
            (0..count.max(0.0) as usize).map(move |i| start + (low.ceil() + i as f64) * cell)
        };
        for x in lines(&self.x, start[0]).filter_map(|x| self.x.share(x)) {
            let x = rect.left + x * rect.width();
            picture.line(vec![(x, rect.top), (x, rect.bottom)], GRID, 0.8 * self.unit);
        }
        for y in lines(&self.y, start[1]).filter_map(|y| self.y.share(y)) {
            let y = rect.bottom - y * rect.height();
            picture.line(vec![(rect.left, y), (rect.right, y)], GRID, 0.8 * self.unit);
        }
    }

    fn draw_particles(&self, frame: &Frame, rect: &Rect, picture: &mut Picture) {
        let color = |i: usize| -> Color {
            let (Some(values), Some(axis)) = (&frame.values, &self.values) else {
                return PALETTE[0];
            };
            let share = values.get(i).and_then(|&v| axis.share(v));
            self.plot.color_map.at(share.unwrap_or(f64::NAN))
        };
        let discs = frame.points.iter().enumerate().filter_map(|(i, p)| {
            let (x, y) = (self.x.share(p[0])?, self.y.share(p[1])?);
            Some(Disc {
                x: rect.left + x * rect.width(),
                y: rect.bottom - y * rect.height(),
                color: color(i),
            })
        });
        let radius = (0.5 * self.plot.particle_size * self.scale).clamp(0.5, 1e4);
        let radius = if radius.is_nan() { 0.5 } else { radius };
        picture.shapes.push(Shape::Discs {
            discs: discs.collect(),
            radius,
            clip: *rect,
        });
    }

    fn draw_axes(&self, frame: &Frame, rect: &Rect, picture: &mut Picture) {
        let (u, size) = (self.unit, TICK * self.unit);
        let border = [
            (rect.left, rect.top),
            (rect.right, rect.top),
            (rect.right, rect.bottom),
            (rect.left, rect.bottom),
        ];
        picture.line(
            border.into_iter().chain([border[0], border[1]]).collect(),
            FRAME,
            u,
        );
        let x_ticks = self.x.ticks((rect.width() / (65.0 * u)) as usize);
        let mut baseline = rect.bottom + 8.0 * u + font::CAP_HEIGHT * size;
        for tick in &x_ticks.marks {
            let Some(x) = self
                .x
                .share(tick.value)
                .map(|s| rect.left + s * rect.width())
            else {
                continue;
            };
            picture.line(vec![(x, rect.bottom), (x, rect.bottom + 5.0 * u)], FRAME, u);
            picture.text((x, baseline), &tick.label, size, INK, Anchor::Middle);
        }
        let (center, middle) = (
            0.5 * (rect.left + rect.right),
            0.5 * (rect.top + rect.bottom),
        );
        let label = format!("{} {}", self.plot.x_label, x_ticks.note);
        if !label.trim().is_empty() {
            baseline += (LABEL + 6.0) * u;
            picture.text(
                (center, baseline),
                label.trim(),
                LABEL * u,
                INK,
                Anchor::Middle,
            );
        }
        picture.text(
            (center, baseline + (LABEL + 9.0) * u),
            &frame.label,
            LABEL * u,
            INK,
            Anchor::Middle,
        );
        if rect.left > self.title.0 + 1.0 {
            return; // the first column carries the labels of y
        }
        let mut widest: f64 = 0.0;
        for tick in &self.y_ticks.marks {
            let Some(y) = self
                .y
                .share(tick.value)
                .map(|s| rect.bottom - s * rect.height())
            else {
                continue;
            };
            picture.line(vec![(rect.left, y), (rect.left - 5.0 * u, y)], FRAME, u);
            let place = (rect.left - 8.0 * u, y + 0.5 * font::CAP_HEIGHT * size);
            picture.text(place, &tick.label, size, INK, Anchor::End);
            widest = widest.max(font::width(&tick.label, size));
        }
        picture.text(
            (rect.left, rect.top - 5.0 * u),
            &self.y_ticks.note,
            size,
            INK,
            Anchor::End,
        );
        let place = (rect.left - widest - 20.0 * u, middle);
        picture.upright_text(place, &self.plot.y_label, LABEL * u, INK);
    }

    fn draw_color_bar(&self, values: &Axis, picture: &mut Picture) {
        let Some((first, last)) = self.frames.first().zip(self.frames.last()) else {
            return;
        };
        let (u, size) = (self.unit, TICK * self.unit);
        let right = self.frames.iter().map(|f| f.right).fold(0.0, f64::max);
        let bar = Rect::new(right + 22.0 * u, first.top, right + 38.0 * u, last.bottom);
        let steps = (bar.height().ceil() as usize).clamp(1, 256);
        for i in (0..steps).rev() {
            // Each strip runs on below the next ones, so that no seam shows.
            let top = bar.bottom - (i + 1) as f64 / steps as f64 * bar.height();
            let rect = Rect::new(bar.left, top, bar.right, bar.bottom);
            let share = (i as f64 + 0.5) / steps as f64;
            picture.shapes.push(Shape::Fill {
                rect,
                color: self.plot.color_map.at(share),
            });
        }
        let ticks = values.ticks(((bar.height() / (50.0 * u)) as usize).max(4));
        let mut widest: f64 = 0.0;
        for tick in &ticks.marks {
            let Some(y) = values
                .share(tick.value)
                .map(|s| bar.bottom - s * bar.height())
            else {
                continue;
            };
            picture.line(vec![(bar.right, y), (bar.right + 5.0 * u, y)], FRAME, u);
            let place = (bar.right + 8.0 * u, y + 0.5 * font::CAP_HEIGHT * size);
            picture.text(place, &tick.label, size, INK, Anchor::Start);
            widest = widest.max(font::width(&tick.label, size));
        }
        let label = format!("{} {}", self.plot.value_label, ticks.note);
        let x = bar.right + 8.0 * u + widest + 8.0 * u + LABEL * u;
        picture.upright_text(
            (x, 0.5 * (bar.top + bar.bottom)),
            label.trim(),
            LABEL * u,
            INK,
        );
    }
}

#[cfg(test)]
#[path = "particles_tests.rs"]
mod tests;
