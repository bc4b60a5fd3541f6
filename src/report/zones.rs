//! Up to where each of many things holds along one axis: bars that are blue as far as it holds and orange beyond.

use super::axis::Axis;
use super::chart::{LABEL, TICK, TITLE};
use super::color::{FRAME, INK};
use super::font;
use super::heat::{FAILS, HOLDS, legend, row_tops, shade};
use super::picture::{Anchor, Picture, Rect, Shape, Size};
use std::io;
use std::path::Path;

/// One column of bars.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ZonePanel {
    /// Above it.
    pub title: String,
    /// Where each row ends to hold; infinite if it holds everywhere, NaN if it has no bar.
    pub edges: Vec<f64>,
    /// Where each row was predicted to end.
    pub predicted: Vec<Option<f64>>,
}

/// Bars in rows, with panels side by side that share the rows' names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ZoneChart {
    /// Above all.
    pub title: String,
    /// Below each panel, with the unit.
    pub x_label: String,
    /// What is shown of the axis.
    pub x_range: [f64; 2],
    /// Whether the axis is logarithmic.
    pub x_log: bool,
    /// What blue means.
    pub holds: String,
    /// What orange means.
    pub fails: String,
    /// What the black line across a bar means.
    pub predicted: String,
    /// Names of the rows. A row whose first word differs from the one above begins a group.
    pub rows: Vec<String>,
    /// Columns of bars.
    pub panels: Vec<ZonePanel>,
}

const WIDTH: u32 = 1200;
const ROW: f64 = 22.0;
const MARGIN: f64 = 24.0;
const SMALL: f64 = TICK - 2.0;

impl ZoneChart {
    /// Writes the chart 1200 pixels wide and as high as its rows need, as PNG or SVG by the file's ending.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.picture().write(path)
    }

    pub(crate) fn picture(&self) -> Picture {
        let names = self.rows.iter().map(|row| font::width(row, TICK));
        let left = MARGIN + names.fold(0.0, f64::max) + 12.0;
        let top = MARGIN + TITLE + 34.0 + LABEL + 12.0;
        let (tops, height) = row_tops(&self.rows, ROW);
        let size = Size {
            width: WIDTH,
            height: (top + height + 26.0 + LABEL + 24.0) as u32,
        };
        let mut picture = Picture::new(size);
        let title = (MARGIN, MARGIN + TITLE * 0.8);
        picture.text(title, &self.title, TITLE, INK, Anchor::Start);
        let baseline = MARGIN + TITLE + 20.0;
        let entries = [
            (shade(&HOLDS, 0.5), self.holds.as_str()),
            (shade(&FAILS, 0.3), self.fails.as_str()),
        ];
        legend(&mut picture, MARGIN, baseline, &entries);
        let used: f64 = entries
            .iter()
            .map(|(_, text)| 51.0 + font::width(text, TICK))
            .sum();
        if !self.predicted.is_empty() {
            let x = MARGIN + used + 8.0;
            picture.line(vec![(x, baseline - 13.0), (x, baseline + 3.0)], INK, 2.2);
            let place = (x + 9.0, baseline);
            picture.text(place, &self.predicted, TICK, INK, Anchor::Start);
        }
        for (name, offset) in self.rows.iter().zip(&tops) {
            let place = (
                left - 10.0,
                top + offset + 0.5 * (ROW + font::CAP_HEIGHT * TICK),
            );
            picture.text(place, name, TICK, INK, Anchor::End);
        }
        let gap = 22.0;
        let count = self.panels.len().max(1) as f64;
        let wide = (f64::from(WIDTH) - MARGIN - left - gap * (count - 1.0)) / count;
        for (i, panel) in self.panels.iter().enumerate() {
            let x = left + i as f64 * (wide + gap);
            let frame = Rect::new(x, top, x + wide, top + height);
            self.draw(panel, &frame, &tops, &mut picture);
        }
        picture
    }

    fn draw(&self, panel: &ZonePanel, frame: &Rect, tops: &[f64], picture: &mut Picture) {
        let axis = Axis::new(self.x_log, Some(self.x_range), std::iter::empty(), 0.0);
        let place = |value: f64| {
            let share = axis
                .share(value)
                .unwrap_or(if value > 0.0 { 1.0 } else { 0.0 });
            frame.left + share.clamp(0.0, 1.0) * frame.width()
        };
        let center = 0.5 * (frame.left + frame.right);
        let above = (center, frame.top - 10.0);
        picture.text(above, &panel.title, LABEL, INK, Anchor::Middle);
        for ((edge, predicted), offset) in panel.edges.iter().zip(&panel.predicted).zip(tops) {
            if edge.is_nan() {
                continue;
            }
            let (y, end) = (frame.top + offset, place(*edge));
            let bottom = y + ROW - 3.0;
            let mut fill = |from: f64, to: f64, color| {
                let rect = Rect::new(from, y, to, bottom);
                picture.shapes.push(Shape::Fill { rect, color });
            };
            fill(frame.left, end, shade(&HOLDS, 0.5));
            fill(end, frame.right, shade(&FAILS, 0.3));
            if let Some(predicted) = predicted.filter(|x| x.is_finite()) {
                let x = place(predicted);
                picture.line(vec![(x, y - 1.5), (x, bottom + 1.5)], INK, 2.2);
            }
            let (text, inside) = if edge.is_finite() {
                (number(*edge), end + 50.0 > frame.right)
            } else {
                (format!("> {}", number(self.x_range[1])), true)
            };
            let baseline = y + 0.5 * (ROW - 3.0 + font::CAP_HEIGHT * SMALL);
            let (x, anchor) = if inside {
                (end - 7.0, Anchor::End)
            } else {
                (end + 7.0, Anchor::Start)
            };
            picture.text((x, baseline), &text, SMALL, INK, anchor);
        }
        let bottom = frame.bottom + 3.0;
        picture.line(
            vec![(frame.left, bottom), (frame.right, bottom)],
            FRAME,
            1.0,
        );
        let ticks = axis.ticks((frame.width() / 75.0) as usize);
        for tick in ticks.marks.iter().filter(|tick| !tick.label.is_empty()) {
            let x = place(tick.value);
            picture.line(vec![(x, bottom), (x, bottom + 5.0)], FRAME, 1.0);
            let under = (x, bottom + 9.0 + font::CAP_HEIGHT * TICK);
            picture.text(under, &tick.label, TICK, INK, Anchor::Middle);
        }
        let label = (center, bottom + 18.0 + TICK + LABEL);
        picture.text(label, &self.x_label, LABEL, INK, Anchor::Middle);
    }
}

/// Three digits that matter.
fn number(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0}")
    } else if value >= 0.0995 {
        format!("{value:.2}")
    } else if value >= 0.00095 {
        format!("{value:.3}")
    } else {
        format!("{value:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_without_end_is_blue_to_the_frame_and_says_so() {
        let chart = ZoneChart {
            x_range: [0.0, 3.0],
            rows: vec!["a".into(), "b".into()],
            panels: vec![ZonePanel {
                edges: vec![f64::INFINITY, 1.0],
                predicted: vec![None, Some(1.0)],
                ..ZonePanel::default()
            }],
            ..ZoneChart::default()
        };
        let text = chart.picture().svg().expect("it can be drawn");
        assert!(
            text.contains("&gt; 3.00") || text.contains("> 3.00"),
            "{text}"
        );
        assert!(text.contains("1.00"));
    }
}
