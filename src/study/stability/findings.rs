//! What a case found: edges beside their predictions, pictures, and one sentence.

use super::{Method, Study};
use crate::report::{HeatCell, HeatMap, LineChart, Size, ZoneChart, panels};
use serde::Serialize;
use std::io;
use std::path::Path;

/// On which side of its limit an edge has to lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Sense {
    /// The measured value must be at least the limit.
    AtLeast,
    /// The measured value must be at most the limit.
    AtMost,
}

/// One method at one place of the map.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The method, or the law.
    pub method: String,
    /// The parameters that the edge belongs to.
    pub at: String,
    /// Where it should lie; null where nobody knows.
    pub predicted: Option<f64>,
    /// Where it lies; null (infinite) if it was not met in the range that was searched.
    pub measured: f64,
    /// Whether the method survives what the case asks of it.
    pub survives: bool,
    /// How far on the safe side it is: above 1 it survives, below 1 it fails.
    pub margin: f64,
}

/// A picture.
pub enum Drawing {
    /// Curves in panels.
    Lines(Vec<LineChart>),
    /// Bars that end where a method starts to fail.
    Zones(ZoneChart),
    /// Cells that hold or fail.
    Map(HeatMap),
}

impl Drawing {
    /// Writes it as PNG or SVG by the file's ending.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        match self {
            Self::Lines(charts) => {
                let rows = charts.len().div_ceil(2) as u32;
                let width = 1200;
                let height = if charts.len() == 1 { 700 } else { 480 * rows };
                panels(charts, path, Size { width, height })
            }
            Self::Zones(chart) => chart.write(path),
            Self::Map(map) => map.write(path),
        }
    }
}

/// A table: name, header, rows.
pub type NamedTable = (&'static str, Vec<&'static str>, Vec<Vec<String>>);

/// What a case found.
pub struct Findings {
    /// What an edge is, with its unit.
    pub quantity: &'static str,
    /// What the case asks for.
    pub limit: f64,
    /// On which side of it.
    pub sense: Sense,
    /// The edges.
    pub rows: Vec<Row>,
    /// What is shown, with its figures.
    pub shown: String,
    /// Pictures, by the ending of their file's name; the first one has none.
    pub drawings: Vec<(&'static str, Drawing)>,
    /// Further tables.
    pub tables: Vec<NamedTable>,
}

impl Findings {
    /// Nothing found yet.
    pub fn new(quantity: &'static str, sense: Sense, limit: f64) -> Self {
        Self {
            quantity,
            limit,
            sense,
            rows: Vec::new(),
            shown: String::new(),
            drawings: Vec::new(),
            tables: Vec::new(),
        }
    }

    /// Adds an edge, with its verdict.
    pub fn push(
        &mut self,
        method: impl ToString,
        at: impl Into<String>,
        predicted: Option<f64>,
        measured: f64,
    ) {
        let margin = match self.sense {
            Sense::AtLeast => measured / self.limit,
            Sense::AtMost => self.limit / measured.abs(),
        };
        self.rows.push(Row {
            method: method.to_string(),
            at: at.into(),
            predicted,
            measured,
            // not `!(margin < 1)`: what is not a number has not survived
            survives: margin >= 1.0,
            margin,
        });
    }

    /// Draws a map with one row a method, one map a frame; `map` comes without its rows and cells.
    pub(super) fn draw_maps(
        &mut self,
        study: &Study,
        map: &HeatMap,
        row: impl Fn(&Method) -> Vec<HeatCell>,
    ) {
        for (name, frame, methods) in study.frames() {
            let drawing = HeatMap {
                title: format!("{}{frame}", map.title),
                rows: methods.iter().map(Method::within_frame).collect(),
                cells: methods.iter().map(&row).collect(),
                ..map.clone()
            };
            self.drawings.push((name, Drawing::Map(drawing)));
        }
    }

    /// How many edges fail.
    pub fn failing(&self) -> usize {
        self.rows.iter().filter(|row| !row.survives).count()
    }

    /// The row of a method at a place.
    pub fn row(&self, method: &str, at: &str) -> Option<&Row> {
        self.rows
            .iter()
            .find(|row| row.method == method && row.at == at)
    }

    /// The largest |measured − predicted| / predicted of the rows that have both.
    pub fn worst_deviation(&self) -> f64 {
        let pairs = self.rows.iter().filter_map(|row| {
            let predicted = row.predicted.filter(|x| x.is_finite() && *x != 0.0)?;
            row.measured
                .is_finite()
                .then(|| (row.measured / predicted - 1.0).abs())
        });
        pairs.fold(0.0, f64::max)
    }
}
