//! What accuracy costs: error against cost on logarithmic axes, with the frontier of what nothing beats.

use super::axis::{Axis, Ticks};
use super::chart::{TICK, TITLE, unit};
use super::color::{Color, FRAME, INK, PALETTE, PAPER};
use super::font;
use super::frame::Sides;
use super::picture::{Anchor, Disc, Picture, Rect, Shape, Size};
use std::io;
use std::path::Path;

/// Runs that share a color.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Group {
    /// For the legend.
    pub name: String,
    /// Cost and error of each run that can be shown.
    pub points: Vec<(f64, f64)>,
    /// Cost of each run that has no error to show: a cross at the upper border.
    pub failed: Vec<f64>,
}

/// A run that no other beats in both cost and error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Best {
    /// Cost.
    pub cost: f64,
    /// Error.
    pub error: f64,
    /// What it is.
    pub label: String,
    /// Index of its group.
    pub group: usize,
}

/// A chart of error against cost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TradeOff {
    /// Above the frame.
    pub title: String,
    /// A line of smaller text below the title: what was varied, what the labels mean.
    pub subtitle: String,
    /// What is paid, with its unit.
    pub cost_label: String,
    /// What is wrong, with its norm.
    pub error_label: String,
    /// Beside the crosses at the upper border.
    pub failed_label: String,
    /// All runs.
    pub groups: Vec<Group>,
    /// The frontier, from cheap to dear.
    pub frontier: Vec<Best>,
    /// The frontier of a part of the runs, dashed, and what part.
    pub other: Option<(String, Vec<(f64, f64)>)>,
    /// Runs in rings, and what they have in common.
    pub marked: Option<(String, Vec<(f64, f64)>)>,
    /// An error below which differences mean nothing: a dashed line.
    pub floor: Option<f64>,
}

/// Least share of the frame's width that is kept free at the left for labels of the frontier.
const LABEL_ROOM: f64 = 0.26;
/// Between the frame and the place of a label of the frontier, beside the label.
const LABEL_GAP: f64 = 17.0;
const SMALL: f64 = 12.5;

impl TradeOff {
    /// Writes the chart in the default size, as PNG or SVG by the file's ending.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        self.picture(Size::default()).write(path)
    }

    pub(crate) fn picture(&self, size: Size) -> Picture {
        let mut picture = Picture::new(size);
        Layout::new(self, size).draw(&mut picture);
        picture
    }

    /// The axis of costs, so many units of length long, with room at its left for the labels of the frontier.
    fn x_axis(&self, length: f64, unit: f64) -> Axis {
        let points = self.groups.iter().flat_map(|group| &group.points);
        let failed = self.groups.iter().flat_map(|group| &group.failed);
        let costs = points.map(|p| p.0).chain(failed.copied());
        let [low, high] = Axis::new(true, None, costs, 0.04).range();
        let span = (high / low).ln();
        // what has to be added at the left for a place to lie as far from it as its label is long
        let wanted = |best: &Best| {
            let label = font::width(&best.label, SMALL * unit) + LABEL_GAP * unit;
            let share = (label / length).min(0.6);
            (share * span - (best.cost / low).ln()) / (1.0 - share)
        };
        let least = LABEL_ROOM / (1.0 - LABEL_ROOM) * span;
        let room = self.frontier.iter().map(wanted).fold(least, f64::max).exp();
        Axis::new(true, Some([low / room, high]), std::iter::empty(), 0.0)
    }

    fn y_axis(&self) -> Axis {
        let points = self.groups.iter().flat_map(|group| &group.points);
        let errors = points.map(|p| p.1).chain(self.floor);
        let [low, high] = Axis::new(true, None, errors, 0.06).range();
        // room below for labels that have to give way
        let low = low / (high / low).powf(0.14);
        Axis::new(true, Some([low, high]), std::iter::empty(), 0.0)
    }
}

/// What stands before an entry of the legend.
#[derive(Clone, Copy)]
enum Mark {
    Disc(Color),
    Line,
    Dashes,
    Ring,
}

impl Mark {
    /// With the space before the text.
    fn width(self) -> f64 {
        match self {
            Self::Disc(_) => 16.0,
            Self::Line => 36.0,
            Self::Dashes => 44.0,
            Self::Ring => 25.0,
        }
    }
}

/// Space between entries of the legend.
const GAP: f64 = 24.0;

struct Layout<'a> {
    chart: &'a TradeOff,
    rect: Rect,
    frame: Rect,
    /// Where the crosses stand.
    failed_y: f64,
    unit: f64,
    x: Axis,
    y: Axis,
    y_ticks: Ticks,
}

impl<'a> Layout<'a> {
    fn new(chart: &'a TradeOff, size: Size) -> Self {
        let (width, height) = (f64::from(size.width), f64::from(size.height));
        let u = unit(width, height);
        let rect = Rect::new(
            22.0 * u,
            10.0 * u,
            width - 22.0 * u,
            (height - 10.0 * u).max(0.0),
        );
        let y = chart.y_axis();
        let y_ticks = y.ticks((rect.height() / (60.0 * u)) as usize);
        let widths = y_ticks.marks.iter();
        let widest = widths
            .map(|tick| font::width(&tick.label, TICK * u))
            .fold(0.0, f64::max);
        // title, subtitle, legend, the strip of the crosses
        let failed_y = rect.top + 100.0 * u;
        let frame = Rect::new(
            rect.left + widest + 33.0 * u,
            failed_y + 14.0 * u,
            rect.right,
            rect.bottom - 49.0 * u,
        );
        Self {
            chart,
            rect,
            frame,
            failed_y,
            unit: u,
            x: chart.x_axis(frame.width(), u),
            y,
            y_ticks,
        }
    }

    fn draw(&self, picture: &mut Picture) {
        let (u, left) = (self.unit, self.frame.left);
        let chart = self.chart;
        let at = (left, self.rect.top + 22.0 * u);
        let room = self.rect.right - left;
        let fitting = |text: &str, size: f64| size.min(size * room / font::width(text, size));
        let size = fitting(&chart.title, TITLE * u);
        picture.text(at, &chart.title, size, INK, Anchor::Start);
        let at = (left, self.rect.top + 44.0 * u);
        let size = fitting(&chart.subtitle, SMALL * u);
        picture.text(at, &chart.subtitle, size, FRAME, Anchor::Start);
        let x_ticks = self.x.ticks((self.frame.width() / (105.0 * u)) as usize);
        let sides = Sides {
            rect: self.rect,
            frame: self.frame,
            unit: u,
            x: (&self.x, &x_ticks, &chart.cost_label),
            y: (&self.y, &self.y_ticks, &chart.error_label),
        };
        sides.draw(picture);
        self.draw_legend(picture);
        self.draw_floor(picture);
        if let Some((_, marked)) = &chart.marked {
            // before the runs, which stand in them
            self.rings(picture, &self.places(marked));
        }
        self.draw_runs(picture);
        self.draw_failed(picture);
        self.draw_frontier(picture);
    }

    fn place(&self, cost: f64, error: f64) -> Option<(f64, f64)> {
        let (x, y) = (self.x.share(cost)?, self.y.share(error)?);
        let frame = &self.frame;
        Some((
            frame.left + x * frame.width(),
            frame.bottom - y * frame.height(),
        ))
    }

    /// Where runs of these costs and errors are drawn.
    fn places(&self, runs: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let places = runs.iter();
        places
            .filter_map(|&(cost, error)| self.place(cost, error))
            .collect()
    }

    fn draw_legend(&self, picture: &mut Picture) {
        let chart = self.chart;
        let groups = chart.groups.iter().enumerate();
        let mut entries: Vec<(Mark, &str)> = groups
            .map(|(index, group)| (Mark::Disc(color(index)), group.name.as_str()))
            .collect();
        if !chart.frontier.is_empty() {
            let text = match chart.other {
                Some(_) => "frontier",
                None => "frontier: nothing cheaper is as accurate",
            };
            entries.push((Mark::Line, text));
        }
        if let Some((name, _)) = &chart.other {
            entries.push((Mark::Dashes, name));
        }
        if let Some((name, _)) = &chart.marked {
            entries.push((Mark::Ring, name));
        }
        let widths = entries
            .iter()
            .map(|(mark, text)| mark.width() + font::width(text, TICK) + GAP);
        let room = self.frame.right - self.frame.left;
        let u = self.unit.min(room / (widths.sum::<f64>() - GAP).max(1.0));
        let (size, baseline) = (TICK * u, self.rect.top + 70.0 * self.unit);
        let middle = baseline - 0.5 * font::CAP_HEIGHT * size;
        let mut x = self.frame.left;
        for (mark, text) in entries {
            let line = vec![(x, middle), (x + (mark.width() - 8.0) * u, middle)];
            let disc = vec![(x + 5.0 * u, middle)];
            match mark {
                Mark::Disc(color) => self.discs(picture, disc, 4.5, color),
                Mark::Line => picture.line(line, INK, 2.0 * u),
                Mark::Dashes => self.dashed(picture, line),
                Mark::Ring => self.rings(picture, &[(x + 8.0 * u, middle)]),
            }
            x += mark.width() * u;
            picture.text((x, baseline), text, size, INK, Anchor::Start);
            x += font::width(text, size) + GAP * u;
        }
    }

    fn draw_floor(&self, picture: &mut Picture) {
        let Some(share) = self.chart.floor.and_then(|error| self.y.share(error)) else {
            return;
        };
        let (u, frame) = (self.unit, &self.frame);
        let y = frame.bottom - share * frame.height();
        picture.shapes.push(Shape::Line {
            points: vec![(frame.left, y), (frame.right, y)],
            color: FRAME,
            width: 1.2 * u,
            dash: vec![6.0 * u, 5.0 * u],
        });
    }

    /// Runs off the frontier are small and pale, so that the frontier is what the eye meets first.
    fn draw_runs(&self, picture: &mut Picture) {
        for (index, group) in self.chart.groups.iter().enumerate() {
            let places = self.places(&group.points);
            self.discs(picture, places, 2.8, pale(color(index)));
        }
    }

    fn draw_failed(&self, picture: &mut Picture) {
        let u = self.unit;
        let groups = self.chart.groups.iter().enumerate();
        let mut any = false;
        for (index, group) in groups {
            for share in group.failed.iter().filter_map(|&cost| self.x.share(cost)) {
                any = true;
                let x = self.frame.left + share * self.frame.width();
                let (y, arm) = (self.failed_y, 4.0 * u);
                for side in [-1.0, 1.0] {
                    let ends = vec![(x - arm, y - side * arm), (x + arm, y + side * arm)];
                    picture.line(ends, color(index), 1.6 * u);
                }
            }
        }
        if any {
            let at = (self.frame.left, self.failed_y + 4.5 * u);
            let text = &self.chart.failed_label;
            picture.text(at, text, SMALL * u, FRAME, Anchor::Start);
        }
    }

    fn dashed(&self, picture: &mut Picture, points: Vec<(f64, f64)>) {
        picture.shapes.push(Shape::Line {
            points,
            color: INK,
            width: 1.6 * self.unit,
            dash: vec![7.0 * self.unit, 4.0 * self.unit],
        });
    }

    /// Wide enough for the discs of the frontier to stand in them.
    fn rings(&self, picture: &mut Picture, places: &[(f64, f64)]) {
        self.discs(picture, places.to_vec(), 9.2, INK);
        self.discs(picture, places.to_vec(), 7.8, PAPER);
    }

    fn draw_frontier(&self, picture: &mut Picture) {
        if let Some((_, other)) = &self.chart.other {
            self.dashed(picture, self.places(other));
        }
        let (u, best) = (self.unit, &self.chart.frontier);
        let places: Vec<(f64, f64)> = best
            .iter()
            .filter_map(|best| self.place(best.cost, best.error))
            .collect();
        if places.len() != best.len() {
            return;
        }
        picture.line(places.clone(), INK, 2.0 * u);
        for (best, place) in best.iter().zip(&places) {
            self.discs(picture, vec![*place], 6.0, INK);
            self.discs(picture, vec![*place], 4.6, color(best.group));
        }
        let step = 1.3 * SMALL * u;
        let heights = spread(&places, step, self.frame.bottom - 0.4 * step);
        for ((best, place), y) in best.iter().zip(&places).zip(heights) {
            let Some(y) = y else { continue };
            // below and to the left of the frontier nothing can be
            let end = place.0 - 14.0 * u;
            let middle = y - 0.5 * font::CAP_HEIGHT * SMALL * u;
            let leader = vec![(end + 3.0 * u, middle), (place.0 - 5.0 * u, place.1)];
            picture.line(leader, FRAME, 0.8 * u);
            let fits = end - font::width(&best.label, SMALL * u) > self.frame.left + 2.0 * u;
            let (x, anchor) = if fits {
                (end, Anchor::End)
            } else {
                (self.frame.left + 4.0 * u, Anchor::Start)
            };
            picture.text((x, y), &best.label, SMALL * u, INK, anchor);
        }
    }

    fn discs(&self, picture: &mut Picture, places: Vec<(f64, f64)>, radius: f64, color: Color) {
        let disc = |(x, y): (f64, f64)| Disc { x, y, color };
        picture.shapes.push(Shape::Discs {
            discs: places.into_iter().map(disc).collect(),
            radius: radius * self.unit,
            clip: self.rect,
        });
    }
}

fn color(index: usize) -> Color {
    PALETTE[index % PALETTE.len()]
}

/// Three fifths of the way to white.
fn pale(color: Color) -> Color {
    let mix = |part: u8| (0.4 * f64::from(part) + 0.6 * 255.0).round() as u8;
    Color(mix(color.0), mix(color.1), mix(color.2))
}

/// Base lines of labels beside points that go down from one to the next: at least `step` apart, none below `bottom`. Where
/// there is no room for all, those in between give way; the first and the last stay.
fn spread(places: &[(f64, f64)], step: f64, bottom: f64) -> Vec<Option<f64>> {
    let last = places.len().saturating_sub(1);
    let mut lines: Vec<Option<f64>> = Vec::new();
    let mut next = f64::NEG_INFINITY;
    for (i, place) in places.iter().enumerate() {
        // below the line that comes from the left
        let before = i.checked_sub(1).map_or(f64::NEG_INFINITY, |i| places[i].1);
        let wanted = (place.1 + 0.3 * step).max(before + 1.1 * step);
        let line = wanted.max(next).min(bottom);
        // the last label needs room as well
        let crowded = line - wanted > 2.0 * step || line + step > bottom;
        if i != 0 && i != last && crowded {
            lines.push(None);
            continue;
        }
        next = line + step;
        lines.push(Some(line));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> TradeOff {
        let runs: Vec<(f64, f64)> = (0..20)
            .map(|i| (10f64.powi(i / 4), 10f64.powi(-i / 5)))
            .collect();
        TradeOff {
            title: "Bar".into(),
            groups: vec![Group {
                name: "linear".into(),
                points: runs.clone(),
                failed: vec![3.0, 400.0],
            }],
            frontier: vec![
                Best {
                    cost: 1.0,
                    error: 0.1,
                    label: "first".into(),
                    group: 0,
                },
                Best {
                    cost: 100.0,
                    error: 1e-3,
                    label: "last".into(),
                    group: 0,
                },
            ],
            ..TradeOff::default()
        }
    }

    #[test]
    fn labels_keep_their_distance_and_the_ends_are_named() {
        let places: Vec<(f64, f64)> = (0..30).map(|i| (f64::from(i), f64::from(3 * i))).collect();
        let lines = spread(&places, 10.0, 100.0);
        assert!(lines[0].is_some() && lines[29].is_some());
        let kept: Vec<f64> = lines.into_iter().flatten().collect();
        assert!(
            kept.windows(2).all(|pair| pair[1] - pair[0] >= 10.0 - 1e-9),
            "{kept:?}"
        );
        assert!(kept.len() >= 7 && kept.iter().all(|y| *y <= 100.0));
    }

    #[test]
    fn a_long_label_of_the_cheapest_run_ends_left_of_it() {
        let (mut chart, size) = (example(), Size::default());
        chart.frontier[0].label = "updated quadratic mls_apic, 25 × 2, C 0.5".into();
        let layout = Layout::new(&chart, size);
        let place = layout.place(1.0, 0.1).expect("inside the frame");
        let label = font::width(&chart.frontier[0].label, SMALL * layout.unit);
        assert!(place.0 - label > layout.frame.left + 14.0 * layout.unit);
    }

    #[test]
    fn every_failed_run_has_a_cross() {
        let all = example().picture(Size::default());
        let without = TradeOff {
            groups: vec![Group {
                failed: vec![],
                ..example().groups[0].clone()
            }],
            ..example()
        };
        let count = |picture: &Picture| {
            let line =
                |shape: &&Shape| matches!(shape, Shape::Line { color, .. } if *color == PALETTE[0]);
            picture.shapes.iter().filter(line).count()
        };
        assert_eq!(
            count(&all) - count(&without.picture(Size::default())),
            4,
            "two strokes each"
        );
    }

    #[test]
    fn a_chart_without_runs_can_be_drawn() {
        let empty = TradeOff::default();
        assert!(empty.picture(Size::default()).png().is_ok());
    }
}
