//! A table as a picture: one row a thing, one column a parameter, each cell written out and colored by whether it holds.

use super::chart::{LABEL, TICK, TITLE};
use super::color::{Color, FRAME, INK};
use super::font;
use super::picture::{Anchor, Picture, Rect, Shape, Size};
use std::io;
use std::path::Path;

/// One entry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatCell {
    /// What is written into it.
    pub text: String,
    /// Whether it fails.
    pub fails: bool,
    /// How clearly it fails or holds, 0 (barely) to 1.
    pub strength: f64,
}

/// Cells in rows and columns, blue where something holds and orange where it fails.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatMap {
    /// Above the map.
    pub title: String,
    /// Below the columns, with the unit.
    pub x_label: String,
    /// What blue means.
    pub holds: String,
    /// What orange means.
    pub fails: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Names of the rows. A row whose first word differs from the one above begins a group.
    pub rows: Vec<String>,
    /// For each row one cell a column.
    pub cells: Vec<Vec<HeatCell>>,
}

const WIDTH: u32 = 1200;
const ROW: f64 = 24.0;
pub(super) const GAP: f64 = 10.0;
const MARGIN: f64 = 24.0;

/// Blue, and what it fades to.
pub(super) const HOLDS: [Color; 2] = [Color(214, 231, 243), Color(86, 160, 210)];
/// Orange, and what it fades to.
pub(super) const FAILS: [Color; 2] = [Color(252, 224, 204), Color(232, 122, 52)];

pub(super) fn shade(ends: &[Color; 2], strength: f64) -> Color {
    let share = if strength.is_nan() {
        1.0
    } else {
        strength.clamp(0.0, 1.0)
    };
    let mix = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    let [from, to] = ends;
    Color(mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

/// Where each row begins, counted from the first, and where the last one ends.
pub(super) fn row_tops(rows: &[String], row: f64) -> (Vec<f64>, f64) {
    let group = |name: &str| name.split_whitespace().next().unwrap_or("").to_owned();
    let mut tops = Vec::with_capacity(rows.len());
    let mut top = 0.0;
    for (i, name) in rows.iter().enumerate() {
        if i > 0 && group(name) != group(&rows[i - 1]) && rows.len() > 8 {
            top += GAP;
        }
        tops.push(top);
        top += row;
    }
    (tops, top)
}

/// Colored squares with what they mean, from `left` on.
pub(super) fn legend(
    picture: &mut Picture,
    mut left: f64,
    baseline: f64,
    entries: &[(Color, &str)],
) {
    for (color, text) in entries.iter().filter(|(_, text)| !text.is_empty()) {
        let rect = Rect::new(left, baseline - 12.0, left + 16.0, baseline + 2.0);
        picture.shapes.push(Shape::Fill {
            rect,
            color: *color,
        });
        picture.text((left + 23.0, baseline), text, TICK, INK, Anchor::Start);
        left += 23.0 + font::width(text, TICK) + 28.0;
    }
}

impl HeatMap {
    /// Writes the map 1200 pixels wide and as high as its rows need, as PNG or SVG by the file's ending.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.picture().write(path)
    }

    pub(crate) fn picture(&self) -> Picture {
        let names = self.rows.iter().map(|row| font::width(row, TICK));
        let left = MARGIN + names.fold(0.0, f64::max) + 12.0;
        let top = MARGIN + TITLE + 44.0;
        let (tops, height) = row_tops(&self.rows, ROW);
        let below = TICK + LABEL + 40.0;
        let size = Size {
            width: WIDTH,
            height: (top + height + below) as u32,
        };
        let mut picture = Picture::new(size);
        let title = (MARGIN, MARGIN + TITLE * 0.8);
        picture.text(title, &self.title, TITLE, INK, Anchor::Start);
        let entries = [
            (shade(&HOLDS, 0.6), self.holds.as_str()),
            (shade(&FAILS, 0.6), self.fails.as_str()),
        ];
        legend(&mut picture, MARGIN, MARGIN + TITLE + 20.0, &entries);
        let right = f64::from(WIDTH) - MARGIN;
        let wide = (right - left) / self.columns.len().max(1) as f64;
        for ((name, row), offset) in self.rows.iter().zip(&self.cells).zip(&tops) {
            let y = top + offset;
            let baseline = y + 0.5 * (ROW + font::CAP_HEIGHT * TICK);
            picture.text((left - 10.0, baseline), name, TICK, INK, Anchor::End);
            for (column, cell) in row.iter().enumerate() {
                let x = left + column as f64 * wide;
                let ends = if cell.fails { &FAILS } else { &HOLDS };
                picture.shapes.push(Shape::Fill {
                    rect: Rect::new(x, y, x + wide - 1.5, y + ROW - 1.5),
                    color: shade(ends, cell.strength),
                });
                let middle = (x + 0.5 * wide, baseline);
                picture.text(middle, &cell.text, TICK - 1.0, INK, Anchor::Middle);
            }
        }
        let bottom = top + height;
        picture.line(
            vec![(left, bottom + 2.0), (right, bottom + 2.0)],
            FRAME,
            1.0,
        );
        for (column, name) in self.columns.iter().enumerate() {
            let x = left + (column as f64 + 0.5) * wide;
            picture.text((x, bottom + 20.0), name, TICK, INK, Anchor::Middle);
        }
        let label = (0.5 * (left + right), bottom + 24.0 + LABEL + 6.0);
        picture.text(label, &self.x_label, LABEL, INK, Anchor::Middle);
        picture
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_is_drawn_and_written() {
        let cell = |fails| HeatCell {
            text: "1.5".into(),
            fails,
            strength: f64::NAN,
        };
        let map = HeatMap {
            title: "a map".into(),
            columns: vec!["1".into(), "2".into()],
            rows: vec!["linear flip".into(), "cubic apic".into()],
            cells: vec![vec![cell(true), cell(false)], vec![cell(false), cell(true)]],
            ..HeatMap::default()
        };
        let text = map.picture().svg().expect("it can be drawn");
        assert_eq!(text.matches(&FAILS[1].hex()).count(), 2);
        assert_eq!(text.matches(&HOLDS[1].hex()).count(), 2);
    }
}
