//! The explicit solver. It knows bodies, a grid and time; no files and no names.

mod cells;
mod disjoint;
mod frame;
mod free;
mod grouping;
mod integrate;
mod kernels;
pub mod lane;
mod ledger;
mod loads;
mod mpm;
mod passes;
#[cfg(test)]
mod plain;
mod sharpen;
mod sort;
pub mod stencil;
mod survey;
mod time_step;

pub use kernels::{Kernels, Stencils};
pub use ledger::{Account, GridSums, Ledger, Stored};
pub use loads::{Factor, Load, LoadForce, Loads};
pub use mpm::{Mpm, Setup};
pub use stencil::Domains;
pub use time_step::{Limit, TimeStep};

use crate::state::State;
use crate::totals::Totals;

/// A method that carries a state forward in time.
pub trait Solver<const D: usize>: Send {
    /// Opens the energy account; called once, before the first step.
    fn start(&mut self, state: &mut State<D>) -> Result<(), Fault>;

    /// Takes one step of `dt` seconds.
    fn step(&mut self, state: &mut State<D>, dt: f64) -> Result<(), Fault>;

    /// The energies that the points hold now.
    fn stored(&self, totals: &[Totals<D>]) -> Stored;

    /// The account so far.
    fn ledger(&self) -> &Ledger<D>;

    /// What limits the time step now.
    fn limit(&self, state: &State<D>) -> Limit;

    /// Angular momentum of a body about the origin, kg m²/s, the points' affine fields included: none in 1D, one number in 2D,
    /// three in 3D.
    fn angular_momentum(&self, state: &State<D>, body: usize) -> Vec<f64>;

    /// Nodes that have storage now.
    fn stored_nodes(&self) -> usize;

    /// Bytes of storage a node.
    fn bytes_per_node(&self) -> usize;
}

/// Why a run cannot go on.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A point has left the grid.
    Escaped(Place),
    /// A point's position or velocity is not a number.
    NotFinite(Place),
    /// The time step has become too small to get anywhere.
    Collapsed {
        /// Time, s.
        time: f64,
        /// Steps taken.
        step: u64,
        /// The step that was asked for, s.
        dt: f64,
    },
}

/// The point that shows a fault first.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Time, s.
    pub time: f64,
    /// Steps taken.
    pub step: u64,
    /// Name of the body.
    pub body: String,
    /// Number of the point.
    pub particle: u32,
    /// Its position, m.
    pub position: Vec<f64>,
    /// Its velocity, m/s.
    pub velocity: Vec<f64>,
    /// Δt c / h of the last step: the wave speed's Courant number.
    pub courant: f64,
}

impl std::fmt::Display for Fault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let place = |f: &mut std::fmt::Formatter<'_>, p: &Place, what: &str| {
            write!(
                f,
                "{what} at t = {:e} s (step {}): particle {} of body \"{}\", position {:?} m, velocity {:?} m/s",
                p.time, p.step, p.particle, p.body, p.position, p.velocity
            )
        };
        match self {
            Self::Escaped(p) => {
                place(f, p, "a particle left the grid")?;
                write!(f, "; enlarge the grid, hold the body with a [[boundary]], ")?;
                write!(f, "or take a smaller time step if the body blew up")
            }
            Self::NotFinite(p) => {
                place(f, p, "the motion is no longer a number")?;
                if p.courant > 0.5 {
                    write!(
                        f,
                        "; likely cause: the time step, {:.2} of the time in which a wave crosses a cell",
                        p.courant
                    )
                } else {
                    write!(
                        f,
                        "; likely cause: a point that was turned inside out by the motion (Courant number {:.2})",
                        p.courant
                    )
                }
            }
            Self::Collapsed { time, step, dt } => write!(
                f,
                "the time step collapsed to {dt:e} s at t = {time:e} s (step {step}); likely cause: a body that moves or stiffens without bound"
            ),
        }
    }
}

impl std::error::Error for Fault {}
