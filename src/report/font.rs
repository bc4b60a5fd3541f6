//! The one font of all pictures, compiled in: DejaVu Sans, cut down to Latin, Greek and common signs (see `font/LICENSE`).

use std::sync::LazyLock;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

static FACE: LazyLock<Option<Face<'static>>> =
    LazyLock::new(|| Face::parse(include_bytes!("font/sans.ttf"), 0).ok());

/// Height of a capital letter as a share of the size.
pub(crate) const CAP_HEIGHT: f64 = 0.729;

/// Width of a line of text in pixels at a size in pixels.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    let Some(face) = FACE.as_ref() else {
        return 0.0;
    };
    let units: u32 = text
        .chars()
        .map(|c| u32::from(advance(face, glyph(face, c))))
        .sum();
    f64::from(units) * size / f64::from(face.units_per_em())
}

/// Draws the outlines of a line of text, in font units with y upwards from the start of the base line: `pen` gets the x at
/// which a letter starts and gives what shall draw it, `done` gets that back.
pub(crate) fn outline<B: OutlineBuilder>(
    text: &str,
    mut pen: impl FnMut(f32) -> B,
    mut done: impl FnMut(B),
) {
    let Some(face) = FACE.as_ref() else {
        return;
    };
    let mut x = 0;
    for c in text.chars() {
        let id = glyph(face, c);
        let mut builder = pen(x as f32);
        face.outline_glyph(id, &mut builder);
        done(builder);
        x += u32::from(advance(face, id));
    }
}

/// Font units per size.
pub(crate) fn units() -> f64 {
    FACE.as_ref()
        .map_or(1.0, |face| f64::from(face.units_per_em()))
}

fn glyph(face: &Face, c: char) -> GlyphId {
    face.glyph_index(c).unwrap_or(GlyphId(0))
}

fn advance(face: &Face, id: GlyphId) -> u16 {
    face.glyph_hor_advance(id).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_sign_that_labels_use() {
        let face = FACE.as_ref().expect("the font is readable");
        for c in "AZaz09 ()[]/%+-−×·°±≤≥²³⁰¹⁴⁵⁶⁷⁸⁹⁻αβγδελμνπρσφωΔΣΩöüéß–—…∞√∂∇".chars()
        {
            assert!(face.glyph_index(c).is_some(), "no glyph for {c:?}");
        }
    }

    #[test]
    fn width_is_proportional_to_size_and_adds_up() {
        assert!((width("ab", 30.0) - 2.0 * width("ab", 15.0)).abs() < 1e-9);
        assert!((width("ab", 15.0) - width("a", 15.0) - width("b", 15.0)).abs() < 1e-9);
        assert!(width("m", 10.0) > 5.0);
    }
}
