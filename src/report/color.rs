//! Colors: a palette for series and maps from a number to a color.

/// An opaque color, sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(
    /// Red.
    pub u8,
    /// Green.
    pub u8,
    /// Blue.
    pub u8,
);

impl Color {
    /// As SVG and CSS write it.
    pub(crate) fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Text, and the curves of exact solutions.
pub(crate) const INK: Color = Color(34, 34, 34);
/// What is drawn on.
pub(crate) const PAPER: Color = Color(255, 255, 255);
/// Axes.
pub(crate) const FRAME: Color = Color(110, 110, 110);
/// Lines behind the data.
pub(crate) const GRID: Color = Color(228, 228, 228);
/// What has no finite value.
pub(crate) const NO_VALUE: Color = Color(160, 160, 160);

/// Colors of series in order, told apart with any kind of color vision (Okabe and Ito, <https://jfly.uni-koeln.de/color/>; its
/// black is left to exact solutions, its yellow is too pale on white).
pub const PALETTE: [Color; 6] = [
    Color(0, 114, 178),
    Color(213, 94, 0),
    Color(0, 158, 115),
    Color(204, 121, 167),
    Color(86, 180, 233),
    Color(230, 159, 0),
];

/// From a number in [0, 1] to a color.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMap {
    /// Dark blue over green to yellow, evenly perceived, for values that have a lowest one.
    #[default]
    Viridis,
    /// Blue over grey to red, for values with a sign; the range is made symmetric about zero.
    BlueRed,
}

/// Nine colors of matplotlib's viridis at 0, 1/8, …, 1.
const VIRIDIS: [Color; 9] = [
    Color(68, 1, 84),
    Color(71, 45, 123),
    Color(59, 82, 139),
    Color(44, 114, 142),
    Color(33, 145, 140),
    Color(40, 174, 128),
    Color(94, 201, 98),
    Color(173, 220, 48),
    Color(253, 231, 37),
];

/// Nine colors of matplotlib's coolwarm at 0, 1/8, …, 1.
const BLUE_RED: [Color; 9] = [
    Color(59, 76, 192),
    Color(98, 130, 234),
    Color(141, 176, 254),
    Color(184, 208, 249),
    Color(221, 220, 220),
    Color(245, 196, 173),
    Color(244, 154, 123),
    Color(222, 96, 77),
    Color(180, 4, 38),
];

impl ColorMap {
    /// The color at `share` of the range; values outside [0, 1] get the end's color, NaN grey.
    pub fn at(self, share: f64) -> Color {
        if share.is_nan() {
            return NO_VALUE;
        }
        let table = match self {
            Self::Viridis => &VIRIDIS,
            Self::BlueRed => &BLUE_RED,
        };
        let place = share.clamp(0.0, 1.0) * (table.len() - 1) as f64;
        let low = (place as usize).min(table.len() - 2);
        let rest = place - low as f64;
        let mix =
            |a: u8, b: u8| (f64::from(a) + rest * (f64::from(b) - f64::from(a))).round() as u8;
        let (a, b) = (table[low], table[low + 1]);
        Color(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_color_map_begins_and_ends_with_its_table_and_clamps() {
        assert_eq!(ColorMap::Viridis.at(0.0), VIRIDIS[0]);
        assert_eq!(ColorMap::Viridis.at(1.0), VIRIDIS[8]);
        assert_eq!(ColorMap::Viridis.at(7.0), VIRIDIS[8]);
        assert_eq!(ColorMap::BlueRed.at(0.5), BLUE_RED[4]);
        assert_eq!(ColorMap::Viridis.at(f64::NAN), NO_VALUE);
    }

    #[test]
    fn viridis_grows_brighter_from_end_to_end() {
        let light =
            |c: Color| 0.2126 * f64::from(c.0) + 0.7152 * f64::from(c.1) + 0.0722 * f64::from(c.2);
        let steps: Vec<f64> = (0..=64)
            .map(|i| light(ColorMap::Viridis.at(f64::from(i) / 64.0)))
            .collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");
    }
}
