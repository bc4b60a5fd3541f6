//! The frame of a chart: grid lines, ticks, their labels and the names of the axes.

use super::axis::{Axis, Ticks};
use super::chart::{LABEL, TICK};
use super::color::{FRAME, GRID, INK};
use super::font;
use super::picture::{Anchor, Picture, Rect};

/// What is drawn around the data.
pub(crate) struct Sides<'a> {
    /// All of the chart, names of the axes included.
    pub rect: Rect,
    /// Where the data are.
    pub frame: Rect,
    /// Pixels a unit of length in the layout.
    pub unit: f64,
    /// To the right: range, marks, name.
    pub x: (&'a Axis, &'a Ticks, &'a str),
    /// Upwards: range, marks, name.
    pub y: (&'a Axis, &'a Ticks, &'a str),
}

impl Sides<'_> {
    /// Draws grid lines and the frame; data come on top of it.
    pub(crate) fn draw(&self, picture: &mut Picture) {
        let mut outside = Vec::new();
        self.draw_x(picture, &mut outside);
        self.draw_y(picture, &mut outside);
        let (u, frame) = (self.unit, &self.frame);
        for line in outside {
            picture.line(line.to_vec(), FRAME, u);
        }
        let corner = vec![
            (frame.left, frame.top),
            (frame.left, frame.bottom),
            (frame.right, frame.bottom),
        ];
        picture.line(corner, FRAME, 1.2 * u);
        let (center, baseline) = (0.5 * (frame.left + frame.right), self.rect.bottom - 4.0 * u);
        picture.text((center, baseline), self.x.2, LABEL * u, INK, Anchor::Middle);
        let note = &self.x.1.note;
        picture.text((frame.right, baseline), note, TICK * u, INK, Anchor::End);
        let place = (self.rect.left + LABEL * u, 0.5 * (frame.top + frame.bottom));
        picture.upright_text(place, self.y.2, LABEL * u, INK);
    }

    fn draw_x(&self, picture: &mut Picture, outside: &mut Vec<[(f64, f64); 2]>) {
        let (u, size, frame) = (self.unit, TICK * self.unit, &self.frame);
        for tick in &self.x.1.marks {
            let Some(share) = self.x.0.share(tick.value) else {
                continue;
            };
            let x = frame.left + share * frame.width();
            let major = !tick.label.is_empty();
            if major {
                picture.line(vec![(x, frame.top), (x, frame.bottom)], GRID, u);
                let place = (x, frame.bottom + 8.0 * u + font::CAP_HEIGHT * size);
                picture.text(place, &tick.label, size, INK, Anchor::Middle);
            }
            let length = if major { 5.0 } else { 3.0 } * u;
            outside.push([(x, frame.bottom), (x, frame.bottom + length)]);
        }
    }

    fn draw_y(&self, picture: &mut Picture, outside: &mut Vec<[(f64, f64); 2]>) {
        let (u, size, frame) = (self.unit, TICK * self.unit, &self.frame);
        for tick in &self.y.1.marks {
            let Some(share) = self.y.0.share(tick.value) else {
                continue;
            };
            let y = frame.bottom - share * frame.height();
            let major = !tick.label.is_empty();
            if major {
                picture.line(vec![(frame.left, y), (frame.right, y)], GRID, u);
                let place = (frame.left - 8.0 * u, y + 0.5 * font::CAP_HEIGHT * size);
                picture.text(place, &tick.label, size, INK, Anchor::End);
            }
            let length = if major { 5.0 } else { 3.0 } * u;
            outside.push([(frame.left, y), (frame.left - length, y)]);
        }
    }
}
