//! Cases that can be set up at any resolution and measured against their answer: what speed is charted over.

use super::{
    Recorded, axisymmetric, bar1d, beam, breathing_ring, cantilever, cantilever_shear, column,
    impact, large_bar, manufactured, pressurised_ring, shear_box, vibration, vortex, wave,
};

/// A case at any resolution, and how wrong a run of it is.
pub struct Problem {
    /// Its name on the command line.
    pub name: &'static str,
    /// What moves, in one line.
    pub about: &'static str,
    /// What the error is: the norm, and what it is relative to.
    pub norm: &'static str,
    /// Where the answer comes from.
    pub reference: &'static str,
    /// What the number of cells counts: "along the bar".
    pub cells_are: &'static str,
    /// Dimensions that it can be set up in, lowest first.
    pub dimensions: &'static [usize],
    /// The scene with so many cells, by dimension and cells.
    pub layout: fn(usize, u32) -> Layout,
    /// The error of a run that kept all points at recorded times; relative, 1 is as wrong as no motion at all.
    pub error: fn(&Recorded) -> f64,
    /// Cells that a chart tries, coarsest first, by dimension.
    pub cells: fn(usize) -> &'static [u32],
    /// Points a cell and axis that a chart tries.
    pub points: &'static [u32],
    /// How wrong the answer itself may be, relative; 0 if it is exact.
    pub doubt: f64,
    /// What is known of the order of convergence, by basis.
    pub expected: &'static [Expected],
}

/// A scenario text and the overrides that give it its resolution.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// TOML.
    pub text: String,
    /// `KEY=VALUE`.
    pub overrides: Vec<String>,
}

/// An order of convergence that theory or a publication gives.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// The basis that it is of.
    pub basis: &'static str,
    /// The order.
    pub order: f64,
    /// Where it comes from.
    pub source: &'static str,
}

/// Every problem, in the order in which a reader should meet them.
pub const PROBLEMS: &[&Problem] = &[
    &manufactured::SMALL,
    &manufactured::LARGE,
    &bar1d::PROBLEM,
    &vibration::PROBLEM,
    &wave::PROBLEM,
    &impact::PROBLEM,
    &impact::FAST,
    &column::PROBLEM,
    &large_bar::PROBLEM,
    &vortex::PROBLEM,
    &beam::PROBLEM,
    &cantilever::PROBLEM,
    &cantilever_shear::PROBLEM,
    &shear_box::PROBLEM,
    &pressurised_ring::PROBLEM,
    &axisymmetric::PROBLEM,
    &axisymmetric::STRESS,
    &breathing_ring::PROBLEM,
];

/// Second order for smooth motion, in which no point leaves its cell.
pub(super) const SECOND: &str = "expected: weights and slopes that are exact for linear fields, points in fixed places of their cells";

/// Second order, of every basis of which it is expected.
pub(super) const SECOND_ORDER: &[Expected] = &[
    Expected {
        basis: "linear",
        order: 2.0,
        source: SECOND,
    },
    Expected {
        basis: "gimp",
        order: 2.0,
        source: SECOND,
    },
    Expected {
        basis: "quadratic",
        order: 2.0,
        source: SECOND,
    },
];

/// Root of the sum over recorded times and points of V⁰ |u − u_exact|², over the same of u_exact. The exact displacement is a
/// function of the initial position and the time.
pub(super) fn displacement_error(
    run: &Recorded,
    exact: impl Fn(&[f64; 3], f64) -> [f64; 3],
) -> f64 {
    let frames = &run.memory.frames;
    let Some(first) = frames.first() else {
        return f64::NAN;
    };
    let (mut error, mut size) = (0.0, 0.0);
    for frame in frames {
        for (point, start) in frame.points.iter().zip(&first.points) {
            let exact = exact(&start.position, frame.time);
            for axis in 0..run.scenario.dimension {
                let moved = point.position[axis] - start.position[axis];
                error += start.initial_volume * (moved - exact[axis]).powi(2);
                size += start.initial_volume * exact[axis].powi(2);
            }
        }
    }
    (error / size).sqrt()
}

/// Overrides that divide a length, m, into cells: a plain text for `grid.cell_size`.
pub(super) fn cell_size(length: f64, cells: u32) -> String {
    format!("grid.cell_size={}", length / f64::from(cells))
}

/// Overrides that divide a bar of this length, m, into cells, and give it so many cells more to move in.
pub(super) fn bar_grid(length: f64, cells: u32, spare: f64) -> Vec<String> {
    let max = length + spare * (length / f64::from(cells));
    vec![cell_size(length, cells), format!("grid.max=[{max}]")]
}
