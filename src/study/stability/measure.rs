//! What counts as failed. Every case measures with these, so that verdicts on different methods and in different cases mean
//! the same.

use super::bar::Specimen;
use crate::solver::Fault;

/// Energy may swing by this factor and no more: near its critical step the symplectic Euler rule exchanges energy with the step's
/// own ripple by factors of hundreds, and stays bounded.
pub const ENERGY_GROWTH: f64 = 1e3;

/// How a run failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failed {
    /// The energy of a body on which nothing acts grew a thousandfold.
    EnergyGrowth,
    /// A point left the grid, or its motion is no longer a number.
    PointsLost,
}

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::EnergyGrowth => "energy grew 1000-fold",
            Self::PointsLost => "points lost",
        })
    }
}

impl From<Fault> for Failed {
    fn from(_: Fault) -> Self {
        Self::PointsLost
    }
}

/// Steps a specimen `steps` times by `dt` from its present state, in which it drifts at `drift` m/s.
///
/// # Errors
/// How it failed, if it did.
pub fn survive(specimen: &mut Specimen, drift: f64, dt: f64, steps: usize) -> Result<(), Failed> {
    let start = specimen.energy(drift);
    for step in 1..=steps {
        specimen.step(dt)?;
        if step % 8 == 0 || step == steps {
            let grown = specimen.energy(drift) / start;
            if grown.is_nan() {
                return Err(Failed::PointsLost);
            }
            if grown > ENERGY_GROWTH {
                return Err(Failed::EnergyGrowth);
            }
        }
    }
    Ok(())
}
