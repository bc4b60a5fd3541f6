//! A picture as a list of shapes in pixels, y downwards, before it becomes a file.

use super::color::Color;
use super::{raster, svg};
use std::io;
use std::path::Path;

/// Width and height of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from top to bottom.
    pub height: u32,
}

impl Default for Size {
    fn default() -> Self {
        Self {
            width: 1200,
            height: 750,
        }
    }
}

/// A rectangle; never of negative width or height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Rect {
    pub(crate) fn new(left: f64, top: f64, right: f64, bottom: f64) -> Self {
        Self {
            left,
            top,
            right: right.max(left),
            bottom: bottom.max(top),
        }
    }

    pub(crate) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(crate) fn height(&self) -> f64 {
        self.bottom - self.top
    }
}

/// Which point of a text its position means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// A filled circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Disc {
    pub x: f64,
    pub y: f64,
    pub color: Color,
}

#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// A stroked open line. `dash` alternates lengths of line and gap; empty is solid.
    Line {
        points: Vec<(f64, f64)>,
        color: Color,
        width: f64,
        dash: Vec<f64>,
    },
    /// A filled rectangle.
    Fill { rect: Rect, color: Color },
    /// Filled circles of one size, cut off at the edge of `clip`.
    Discs {
        discs: Vec<Disc>,
        radius: f64,
        clip: Rect,
    },
    /// A line of text; `x`, `y` on its base line. Upright text runs from bottom to top.
    Text {
        x: f64,
        y: f64,
        text: String,
        size: f64,
        color: Color,
        anchor: Anchor,
        upright: bool,
    },
}

/// Shapes, in the order in which they are drawn, on white.
#[derive(Clone, Debug)]
pub(crate) struct Picture {
    pub size: Size,
    pub shapes: Vec<Shape>,
}

/// Pixels along one side above which a picture is surely a mistake.
const LARGEST_SIDE: u32 = 20_000;

impl Picture {
    pub(crate) fn new(size: Size) -> Self {
        Self {
            size,
            shapes: Vec::new(),
        }
    }

    pub(crate) fn line(&mut self, points: Vec<(f64, f64)>, color: Color, width: f64) {
        self.shapes.push(Shape::Line {
            points,
            color,
            width,
            dash: Vec::new(),
        });
    }

    pub(crate) fn text(
        &mut self,
        (x, y): (f64, f64),
        text: &str,
        size: f64,
        color: Color,
        anchor: Anchor,
    ) {
        if !text.is_empty() {
            let text = text.to_owned();
            self.shapes.push(Shape::Text {
                x,
                y,
                text,
                size,
                color,
                anchor,
                upright: false,
            });
        }
    }

    pub(crate) fn upright_text(&mut self, (x, y): (f64, f64), text: &str, size: f64, color: Color) {
        if !text.is_empty() {
            let (text, anchor) = (text.to_owned(), Anchor::Middle);
            self.shapes.push(Shape::Text {
                x,
                y,
                text,
                size,
                color,
                anchor,
                upright: true,
            });
        }
    }

    /// Writes a `.png` or `.svg`.
    pub(crate) fn write(&self, path: &Path) -> io::Result<()> {
        let ending = path
            .extension()
            .and_then(|e| e.to_str())
            .unwrap_or("")
            .to_ascii_lowercase();
        let explain = |why: String| format!("cannot write the picture {}: {why}", path.display());
        let bytes = match ending.as_str() {
            "png" => self
                .png()
                .map_err(|e| io::Error::new(e.kind(), explain(e.to_string())))?,
            "svg" => self.svg()?.into_bytes(),
            _ => {
                let why = explain("its name must end in .png or .svg".to_owned());
                return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
            }
        };
        std::fs::write(path, bytes).map_err(|e| io::Error::new(e.kind(), explain(e.to_string())))
    }

    pub(crate) fn png(&self) -> io::Result<Vec<u8>> {
        self.check_size()?;
        raster::png(self)
    }

    pub(crate) fn svg(&self) -> io::Result<String> {
        self.check_size()?;
        Ok(svg::text(self))
    }

    fn check_size(&self) -> io::Result<()> {
        let Size { width, height } = self.size;
        if [width, height]
            .iter()
            .all(|side| (1..=LARGEST_SIDE).contains(side))
        {
            return Ok(());
        }
        let why = format!(
            "a picture of {width} x {height} pixels: each side must be from 1 to {LARGEST_SIDE}"
        );
        Err(io::Error::new(io::ErrorKind::InvalidInput, why))
    }
}
