//! Pictures and tables from recorded numbers.
//!
//! [`LineChart`] draws curves, [`panels`] several charts in one picture, [`TradeOff`] error against cost, [`ParticlePlot`] a
//! field of particles at one or more times, [`Table`] aligned text for a terminal. It knows no solver, no scenario and no input file: it is given numbers and
//! labels. The same numbers always give the same bytes, on a machine with or without fonts, since the font is compiled in.
//!
//! A chart is first laid out into a list of shapes (`Picture`), which then becomes a PNG or an SVG.

mod axis;
mod chart;
mod color;
mod curve;
mod font;
mod frame;
mod heat;
mod particles;
mod picture;
mod raster;
mod svg;
mod table;
mod trade_off;
mod zones;

pub use chart::{LineChart, Series, Style, panels};
pub use color::{Color, ColorMap, PALETTE};
pub use heat::{HeatCell, HeatMap};
pub use particles::{Frame, ParticlePlot};
pub use picture::Size;
pub use table::{Align, Cell, Table};
pub use trade_off::{Best, Group, TradeOff};
pub use zones::{ZoneChart, ZonePanel};
