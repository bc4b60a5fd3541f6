//! Where rows go: files of a run folder, or memory.

use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

/// A place for tables.
pub trait Sink {
    /// Opens a table; called once for each, before the first step.
    fn open(&mut self, name: &str, header: &[String]) -> io::Result<()>;

    /// Adds a row.
    fn row(&mut self, name: &str, row: &[f64]) -> io::Result<()>;

    /// Whether it takes all points at every recorded time.
    fn wants_frames(&self) -> bool {
        false
    }

    /// Adds all points at one recorded time.
    fn frame(&mut self, frame: Frame) -> io::Result<()> {
        let _ = frame;
        Ok(())
    }

    /// Makes sure that everything so far can be read.
    fn flush(&mut self) -> io::Result<()>;
}

/// One material point at one time. Axes that the scene does not have are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Index of its body.
    pub body: usize,
    /// Its number in the body.
    pub id: u32,
    /// Mass, kg.
    pub mass: f64,
    /// Initial volume, m³.
    pub initial_volume: f64,
    /// J.
    pub volume_ratio: f64,
    /// Position, m.
    pub position: [f64; 3],
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Cauchy stress, Pa; in an axisymmetric scene the last one is the hoop stress.
    pub stress: [[f64; 3]; 3],
}

/// All points at one time, body by body, in the order in which bodies were filled.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// The points.
    pub points: Vec<Point>,
}

/// CSV files in a folder, with every digit that a number needs to be read back exactly.
///
/// If asked, it also keeps all points at up to three recorded times, for pictures.
pub struct CsvSink {
    folder: PathBuf,
    files: BTreeMap<String, csv::Writer<File>>,
    /// Time of the last row, s.
    time: f64,
    /// Times at which points are to be kept, s, ascending.
    wanted: Vec<f64>,
    frames: Vec<Frame>,
}

/// Scenes with more points than this get no picture of them: the copy would need as much memory as the run.
const MOST_POINTS: usize = 500_000;
/// Points that a picture shows at most.
const MOST_SHOWN: usize = 100_000;

impl CsvSink {
    /// Files in `folder`, which exists.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_path_buf(),
            files: BTreeMap::new(),
            time: 0.0,
            wanted: Vec::new(),
            frames: Vec::new(),
        }
    }

    /// Keeps the points (of very many, some) at the start, in the middle and at the `end`, s, of a run of so many points.
    pub fn keep_frames(&mut self, end: f64, points: usize) {
        if points <= MOST_POINTS {
            self.wanted = vec![0.0, 0.5 * end, end];
        }
    }

    /// The points that were kept.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(format!("{name}.csv"))
    }

    fn explain(&self, name: &str, error: impl std::fmt::Display) -> io::Error {
        io::Error::other(format!(
            "cannot write {}: {error}",
            self.path(name).display()
        ))
    }
}

impl Sink for CsvSink {
    fn open(&mut self, name: &str, header: &[String]) -> io::Result<()> {
        let file = File::create(self.path(name)).map_err(|error| self.explain(name, error))?;
        let mut writer = csv::Writer::from_writer(file);
        writer
            .write_record(header)
            .map_err(|error| self.explain(name, error))?;
        writer.flush().map_err(|error| self.explain(name, error))?;
        self.files.insert(name.to_string(), writer);
        Ok(())
    }

    fn row(&mut self, name: &str, row: &[f64]) -> io::Result<()> {
        let Some(writer) = self.files.get_mut(name) else {
            return Err(self.explain(name, "the table was never opened"));
        };
        self.time = row.first().copied().unwrap_or(self.time);
        // `{:?}` of f64 is the shortest text that reads back as the same number
        let result = writer.write_record(row.iter().map(|x| format!("{x:?}")));
        result.map_err(|error| self.explain(name, error))
    }

    fn wants_frames(&self) -> bool {
        let next = self.wanted.get(self.frames.len());
        next.is_some_and(|next| self.time >= next * (1.0 - 1e-9))
    }

    fn frame(&mut self, frame: Frame) -> io::Result<()> {
        let stride = frame.points.len().div_ceil(MOST_SHOWN).max(1);
        let points = frame.points.into_iter().step_by(stride).collect();
        self.frames.push(Frame {
            time: frame.time,
            points,
        });
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        for (name, writer) in &mut self.files {
            writer.flush().map_err(|error| {
                let path = self.folder.join(format!("{name}.csv"));
                io::Error::other(format!("cannot write {}: {error}", path.display()))
            })?;
        }
        Ok(())
    }
}

/// A table in memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// One a recorded time.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// A column by name; empty if there is none.
    pub fn column(&self, name: &str) -> Vec<f64> {
        match self.header.iter().position(|header| header == name) {
            Some(index) => self
                .rows
                .iter()
                .filter_map(|row| row.get(index).copied())
                .collect(),
            None => Vec::new(),
        }
    }
}

/// Tables in memory, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// The tables.
    pub tables: BTreeMap<String, Table>,
    /// Whether to keep all points at every recorded time.
    pub keep_frames: bool,
    /// All points at every recorded time, if kept.
    pub frames: Vec<Frame>,
}

impl Memory {
    /// A column of a table; empty if there is none.
    pub fn column(&self, table: &str, column: &str) -> Vec<f64> {
        self.tables
            .get(table)
            .map(|table| table.column(column))
            .unwrap_or_default()
    }
}

impl Sink for Memory {
    fn open(&mut self, name: &str, header: &[String]) -> io::Result<()> {
        self.tables.insert(
            name.to_string(),
            Table {
                header: header.to_vec(),
                rows: Vec::new(),
            },
        );
        Ok(())
    }

    fn row(&mut self, name: &str, row: &[f64]) -> io::Result<()> {
        self.tables
            .entry(name.to_string())
            .or_default()
            .rows
            .push(row.to_vec());
        Ok(())
    }

    fn wants_frames(&self) -> bool {
        self.keep_frames
    }

    fn frame(&mut self, frame: Frame) -> io::Result<()> {
        self.frames.push(frame);
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
