//! Where the energy and the momentum went, booked step by step from what happened on grid and points.

use crate::math::{Sum, Vector};

/// What one step did to the grid, summed over its nodes, J.
#[derive(Clone, Copy, Debug, Default)]
pub struct GridSums {
    /// Kinetic energy as it arrived from the points (with the impulse of internal forces where the two travel together).
    pub arrived: f64,
    /// Kinetic energy at the end.
    pub left: f64,
    /// Work of internal forces, where they are stored by themselves.
    pub internal: f64,
    /// Work of gravity.
    pub gravity: f64,
    /// Work of loads.
    pub external: f64,
    /// Work of damping, negative.
    pub damping: f64,
    /// Kinetic energy that conditions on nodes took without doing work: the momentum of points next to a wall that lands on
    /// nodes of the wall.
    pub absorbed: f64,
    /// Work of boundaries: reaction times velocity of the wall.
    pub boundary: f64,
}

impl GridSums {
    /// Both together.
    pub fn and(self, o: &Self) -> Self {
        Self {
            arrived: self.arrived + o.arrived,
            left: self.left + o.left,
            internal: self.internal + o.internal,
            gravity: self.gravity + o.gravity,
            external: self.external + o.external,
            damping: self.damping + o.damping,
            absorbed: self.absorbed + o.absorbed,
            boundary: self.boundary + o.boundary,
        }
    }
}

/// Compensated sums over all steps so far.
#[derive(Clone, Debug, Default)]
pub struct Ledger<const D: usize> {
    internal: Sum,
    gravity: Sum,
    external: Sum,
    damping: Sum,
    boundary: Sum,
    /// Changes of kinetic energy that no force accounts for: from points to grid, at walls, and from grid to points.
    transfer: Sum,
    turned_over: f64,
    /// Kinetic energy of the points, J.
    kinetic: f64,
    start: Start<D>,
    /// Momentum given by each boundary, N s.
    pub reactions: Vec<Vector<D>>,
    impulses: Vec<[Sum; D]>,
}

#[derive(Clone, Debug)]
struct Start<const D: usize> {
    kinetic: f64,
    elastic: f64,
    potential: f64,
}

impl<const D: usize> Default for Start<D> {
    fn default() -> Self {
        Self {
            kinetic: 0.0,
            elastic: 0.0,
            potential: 0.0,
        }
    }
}

/// The state's energies at one instant, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// Σ ½ m v² over the points.
    pub kinetic: f64,
    /// Elastic energy.
    pub elastic: f64,
    /// −Σ m g·x.
    pub potential: f64,
}

/// One line of the account, J. Stored energies, what went in and out since the start, and what does not add up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Account {
    /// Stored now.
    pub stored: Stored,
    /// Put in by loads.
    pub external_work: f64,
    /// Put in by boundaries that move.
    pub boundary_work: f64,
    /// Taken out by damping.
    pub damping: f64,
    /// Taken out by the method itself (negative where it adds energy): exchange between points and grid, walls that absorb
    /// the momentum of points, and stored energy that differs from the work of the stresses.
    pub numerical: f64,
    /// kinetic + elastic + potential.
    pub total: f64,
    /// total − total at the start − external_work − boundary_work + damping + numerical: round-off, if the account is right.
    pub residual: f64,
    /// The largest energy that was stored, brought in or taken out so far.
    pub turned_over: f64,
}

impl<const D: usize> Ledger<D> {
    /// Opens the account.
    pub fn open(&mut self, stored: Stored, boundaries: usize) {
        *self = Self {
            kinetic: stored.kinetic,
            start: Start {
                kinetic: stored.kinetic,
                elastic: stored.elastic,
                potential: stored.potential,
            },
            reactions: vec![Vector::zeros(); boundaries],
            impulses: vec![[Sum::default(); D]; boundaries],
            ..Self::default()
        };
    }

    /// Books one step: what the grid did, and the kinetic energy with which the points came out of it.
    pub fn book(&mut self, grid: &GridSums, kinetic: f64) {
        self.transfer.add(grid.arrived - self.kinetic);
        self.transfer.add(-grid.absorbed);
        self.transfer.add(kinetic - grid.left);
        self.internal.add(grid.internal);
        self.gravity.add(grid.gravity);
        self.external.add(grid.external);
        self.damping.add(grid.damping);
        self.boundary.add(grid.boundary);
        self.kinetic = kinetic;
        self.turned_over = self.turned_over.max(kinetic).max(grid.left);
    }

    /// Books the impulse of a boundary over one step, N s.
    pub fn push(&mut self, boundary: usize, impulse: &Vector<D>) {
        for a in 0..D {
            self.impulses[boundary][a].add(impulse[a]);
        }
    }

    /// Momentum that boundary `index` has given to the bodies so far, N s.
    pub fn impulse(&self, index: usize) -> Vector<D> {
        Vector::from_fn(|a, _| self.impulses[index][a].value())
    }

    /// Kinetic energy of the points after the last booked step, J.
    pub fn kinetic(&self) -> f64 {
        self.kinetic
    }

    /// The account at an instant at which the points hold `stored`.
    pub fn account(&self, stored: Stored) -> Account {
        let (elastic, potential) = (
            stored.elastic - self.start.elastic,
            stored.potential - self.start.potential,
        );
        // what internal forces and gravity gave to the grid should be what the points' stored energies lost
        let numerical: Sum = [
            -self.transfer.value(),
            -self.internal.value(),
            -elastic,
            -self.gravity.value(),
            -potential,
        ]
        .into_iter()
        .collect();
        let residual: Sum = [
            stored.kinetic,
            -self.start.kinetic,
            elastic,
            potential,
            -self.external.value(),
            -self.boundary.value(),
            -self.damping.value(),
            numerical.value(),
        ]
        .into_iter()
        .collect();
        let turned_over = [
            stored.kinetic,
            stored.elastic,
            potential,
            self.external.value(),
            self.boundary.value(),
            self.damping.value(),
            self.start.kinetic + self.start.elastic,
        ]
        .into_iter()
        .fold(self.turned_over, |most, energy| most.max(energy.abs()));
        Account {
            stored,
            external_work: self.external.value(),
            boundary_work: self.boundary.value(),
            damping: -self.damping.value(),
            numerical: numerical.value(),
            total: stored.kinetic + stored.elastic + stored.potential,
            residual: residual.value(),
            turned_over,
        }
    }
}
