//! A picture as anti-aliased pixels.

use super::color::Color;
use super::font;
use super::picture::{Anchor, Disc, Picture, Rect, Shape};
use std::io;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PremultipliedColorU8, Stroke,
    StrokeDash, Transform,
};

/// The picture as a PNG file.
pub(crate) fn png(picture: &Picture) -> io::Result<Vec<u8>> {
    let pixels = pixels(picture)?;
    let rgb: Vec<u8> = pixels
        .pixels()
        .iter()
        .flat_map(|p| [p.red(), p.green(), p.blue()])
        .collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(io::Error::from)?;
    writer.write_image_data(&rgb).map_err(io::Error::from)?;
    writer.finish().map_err(io::Error::from)?;
    Ok(file)
}

/// The picture on opaque white.
pub(crate) fn pixels(picture: &Picture) -> io::Result<Pixmap> {
    let (width, height) = (picture.size.width, picture.size.height);
    let mut canvas = Pixmap::new(width, height).ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidInput,
            format!("no picture of {width} x {height} pixels"),
        )
    })?;
    canvas.fill(tiny_skia::Color::WHITE);
    for shape in &picture.shapes {
        match shape {
            Shape::Line {
                points,
                color,
                width,
                dash,
            } => line(&mut canvas, points, *color, *width, dash),
            Shape::Fill { rect, color } => {
                if let Some(rect) = tiny_skia::Rect::from_ltrb(
                    rect.left as f32,
                    rect.top as f32,
                    rect.right as f32,
                    rect.bottom as f32,
                ) {
                    canvas.fill_rect(rect, &paint(*color), Transform::identity(), None);
                }
            }
            Shape::Discs {
                discs,
                radius,
                clip,
            } => stamp_discs(&mut canvas, discs, *radius, clip),
            Shape::Text {
                x,
                y,
                text,
                size,
                color,
                anchor,
                upright,
            } => {
                if let Some(path) = letters(text) {
                    let scale = (size / font::units()) as f32;
                    let back = match anchor {
                        Anchor::Start => 0.0,
                        Anchor::Middle => font::width(text, *size) / 2.0,
                        Anchor::End => font::width(text, *size),
                    };
                    let (x, y, back) = (*x as f32, *y as f32, back as f32);
                    let place = if *upright {
                        Transform::from_row(0.0, -scale, -scale, 0.0, x, y + back)
                    } else {
                        Transform::from_row(scale, 0.0, 0.0, -scale, x - back, y)
                    };
                    canvas.fill_path(&path, &paint(*color), FillRule::Winding, place, None);
                }
            }
        }
    }
    Ok(canvas)
}

fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(color.0, color.1, color.2, 255);
    paint.anti_alias = true;
    paint
}

fn line(canvas: &mut Pixmap, points: &[(f64, f64)], color: Color, width: f64, dash: &[f64]) {
    let mut builder = PathBuilder::new();
    for (i, &(x, y)) in points.iter().enumerate() {
        if i == 0 {
            builder.move_to(x as f32, y as f32);
        } else {
            builder.line_to(x as f32, y as f32);
        }
    }
    let Some(path) = builder.finish() else {
        return; // fewer than two points
    };
    let stroke = Stroke {
        width: width as f32,
        line_cap: LineCap::Butt,
        line_join: LineJoin::Round,
        dash: StrokeDash::new(dash.iter().map(|&length| length as f32).collect(), 0.0),
        ..Stroke::default()
    };
    canvas.stroke_path(&path, &paint(color), &stroke, Transform::identity(), None);
}

/// Blends each disc straight into the pixels: there may be 10^6, too many for a path each.
fn stamp_discs(canvas: &mut Pixmap, discs: &[Disc], radius: f64, clip: &Rect) {
    let (width, height) = (canvas.width() as usize, canvas.height() as usize);
    let edge = |value: f64, most: usize| (value.round().max(0.0) as usize).min(most);
    let columns = edge(clip.left, width)..edge(clip.right, width);
    let rows = edge(clip.top, height)..edge(clip.bottom, height);
    let pixels = canvas.pixels_mut();
    for disc in discs {
        let Disc { x, y, color } = *disc;
        if !(x.is_finite() && y.is_finite()) {
            continue;
        }
        let reach = radius + 0.5;
        let first_row = ((y - reach).floor().max(0.0) as usize).max(rows.start);
        let last_row = ((y + reach).ceil().max(0.0) as usize).min(rows.end);
        let first_column = ((x - reach).floor().max(0.0) as usize).max(columns.start);
        let last_column = ((x + reach).ceil().max(0.0) as usize).min(columns.end);
        for row in first_row..last_row {
            let dy = row as f64 + 0.5 - y;
            for column in first_column..last_column {
                let dx = column as f64 + 0.5 - x;
                let cover = (reach - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0);
                if cover > 0.0 {
                    let pixel = &mut pixels[row * width + column];
                    let mix = |new: u8, old: u8| {
                        (f64::from(old) + cover * (f64::from(new) - f64::from(old))).round() as u8
                    };
                    let (r, g, b) = (
                        mix(color.0, pixel.red()),
                        mix(color.1, pixel.green()),
                        mix(color.2, pixel.blue()),
                    );
                    if let Some(mixed) = PremultipliedColorU8::from_rgba(r, g, b, 255) {
                        *pixel = mixed;
                    }
                }
            }
        }
    }
}

/// All letters of a text in font units, y upwards.
fn letters(text: &str) -> Option<Path> {
    let mut all = PathBuilder::new();
    font::outline(
        text,
        |x| Letter {
            x,
            path: PathBuilder::new(),
        },
        |letter| {
            if let Some(path) = letter.path.finish() {
                all.push_path(&path);
            }
        },
    );
    all.finish()
}

struct Letter {
    x: f32,
    path: PathBuilder,
}

impl ttf_parser::OutlineBuilder for Letter {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + x1, y1, self.x + x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path
            .cubic_to(self.x + x1, y1, self.x + x2, y2, self.x + x, y);
    }
    fn close(&mut self) {
        self.path.close();
    }
}
