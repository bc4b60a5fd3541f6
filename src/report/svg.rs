//! A picture as SVG text.

use super::picture::{Anchor, Picture, Shape};
use std::fmt::Write;

/// The picture as an SVG file; its text stays text.
pub(crate) fn text(picture: &Picture) -> String {
    let (w, h) = (picture.size.width, picture.size.height);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n"
    );
    for (number, shape) in picture.shapes.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = write_shape(&mut out, number, shape);
    }
    out.push_str("</svg>\n");
    out
}

fn write_shape(out: &mut String, number: usize, shape: &Shape) -> std::fmt::Result {
    match shape {
        Shape::Line {
            points,
            color,
            width,
            dash,
        } => {
            out.push_str("<polyline fill=\"none\" stroke-linejoin=\"round\" points=\"");
            for (x, y) in points {
                write!(out, "{x:.2},{y:.2} ")?;
            }
            write!(
                out,
                "\" stroke=\"{}\" stroke-width=\"{width:.2}\"",
                color.hex()
            )?;
            if !dash.is_empty() {
                let lengths: Vec<String> = dash.iter().map(|d| format!("{d:.2}")).collect();
                write!(out, " stroke-dasharray=\"{}\"", lengths.join(" "))?;
            }
            writeln!(out, "/>")
        }
        Shape::Fill { rect, color } => writeln!(
            out,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{}\"/>",
            rect.left,
            rect.top,
            rect.width(),
            rect.height(),
            color.hex()
        ),
        Shape::Discs {
            discs,
            radius,
            clip,
        } => {
            writeln!(
                out,
                "<clipPath id=\"clip{number}\"><rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\"/></clipPath>\n\
                 <g clip-path=\"url(#clip{number})\">",
                clip.left,
                clip.top,
                clip.width(),
                clip.height()
            )?;
            for disc in discs.iter().filter(|d| d.x.is_finite() && d.y.is_finite()) {
                let color = disc.color.hex();
                writeln!(
                    out,
                    "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius:.2}\" fill=\"{color}\"/>",
                    disc.x, disc.y
                )?;
            }
            writeln!(out, "</g>")
        }
        Shape::Text {
            x,
            y,
            text,
            size,
            color,
            anchor,
            upright,
        } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let turn = if *upright {
                format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"")
            } else {
                String::new()
            };
            writeln!(
                out,
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size:.2}\" fill=\"{}\" text-anchor=\"{anchor}\"{turn}>{}</text>",
                color.hex(),
                escape(text)
            )
        }
    }
}

fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c if c.is_control() => safe.push(' '), // XML 1.0 forbids them
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_in_a_label_is_escaped() {
        assert_eq!(escape("a<b & \"c\"\u{1}"), "a&lt;b &amp; &quot;c&quot; ");
    }
}
