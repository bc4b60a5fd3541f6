//! The momentum equation on the nodes of the grid, and the conditions imposed there.

use super::disjoint::Disjoint;
use super::free::{Free, FreeSums, NO_MASS, PRESENT, divide};
use super::lane::Lane;
use super::ledger::GridSums;
use crate::boundary::{Condition, Node as Place};
use crate::grid::{Node, Row};
use crate::math::Vector;
use crate::real::Portable;
use rayon::prelude::*;

/// A condition on one node.
#[derive(Clone, Debug)]
pub struct Constraint<const D: usize> {
    /// Which boundary.
    pub boundary: usize,
    /// Which node of the row.
    pub offset: u32,
    /// Position of the node, m.
    pub position: Vector<D>,
    /// Impulse on the node in the last step, N s.
    pub impulse: Vector<D>,
}

/// The grid's arrays and what acts on all nodes alike.
pub struct GridStep<'a, const D: usize> {
    /// Momentum and mass; velocity after the step.
    pub main: &'a mut [Node],
    /// Internal force, N; change of velocity after the step. Empty if forces arrive as impulses in `main`.
    pub change: &'a mut [Node],
    /// Forces of loads, N; empty without loads.
    pub external: &'a [Node],
    /// Rows of nodes.
    pub rows: &'a [Row<D>],
    /// For each row the range of its constraints, sorted by node, then by boundary.
    pub ranges: &'a [(u32, u32)],
    /// All constraints.
    pub constraints: &'a mut [Constraint<D>],
    /// Conditions.
    pub boundaries: &'a [Box<dyn Condition<D>>],
    /// Acceleration of gravity, m/s².
    pub gravity: Vector<D>,
    /// Damping rate α, 1/s.
    pub damping: f64,
    /// The transfer's share of the points' own velocity, for the reactions.
    pub ratio: f64,
    /// Time at the start of the step, s.
    pub time: f64,
    /// Δt, s.
    pub dt: f64,
    /// Whether to use wide instructions; only if the processor has them.
    pub wide: bool,
}

/// Runs `work` on every row, on several threads if asked.
pub fn for_each_row<const D: usize, R: Send>(
    rows: &[Row<D>],
    out: &mut [R],
    parallel: bool,
    work: impl Fn(usize, &Row<D>) -> R + Sync,
) {
    if parallel {
        out.par_iter_mut()
            .zip(rows)
            .enumerate()
            .with_min_len(16)
            .for_each(|(index, (out, row))| *out = work(index, row));
    } else {
        for (index, (out, row)) in out.iter_mut().zip(rows).enumerate() {
            *out = work(index, row);
        }
    }
}

impl<const D: usize> GridStep<'_, D> {
    /// Turns momenta and forces into velocities at the end of the step and their changes; `sums` gets one entry a row.
    pub fn integrate(&mut self, sums: &mut [GridSums], parallel: bool) {
        let split = !self.change.is_empty();
        let main = Disjoint::new(self.main);
        let change = Disjoint::new(self.change);
        let constraints = Disjoint::new(self.constraints);
        let decay = if self.damping == 0.0 {
            1.0
        } else {
            (-self.damping * self.dt).exp()
        };
        #[cfg(target_arch = "x86_64")]
        let wide = self.wide;
        let this = Shared {
            external: self.external,
            ranges: self.ranges,
            boundaries: self.boundaries,
            gravity: self.gravity,
            ratio: self.ratio,
            time: self.time,
            dt: self.dt,
            decay,
        };
        for_each_row(self.rows, sums, parallel, |index, row| {
            let nodes = row.start as usize..(row.start + row.len) as usize;
            let (first, last) = this.ranges[index];
            // SAFETY: rows share no node and no constraint
            let (main, constraints) = unsafe {
                (
                    main.slice(nodes.clone()),
                    constraints.slice(first as usize..last as usize),
                )
            };
            let change: &mut [Node] = if split {
                // SAFETY: as above
                unsafe { change.slice(nodes.clone()) }
            } else {
                &mut []
            };
            let external = if this.external.is_empty() {
                &[]
            } else {
                &this.external[nodes]
            };
            #[cfg(target_arch = "x86_64")]
            if wide {
                // SAFETY: the instructions were found
                return unsafe { row_wide(&this, main, change, external, constraints) };
            }
            this.row::<Portable>(main, change, external, constraints)
        });
    }

    /// Turns momenta in `nodes` into velocities that satisfy all conditions at `time`, and leaves everything else alone.
    #[allow(clippy::too_many_arguments)] // half of what a step has
    pub fn velocities(
        nodes: &mut [Node],
        rows: &[Row<D>],
        ranges: &[(u32, u32)],
        constraints: &[Constraint<D>],
        boundaries: &[Box<dyn Condition<D>>],
        time: f64,
        scratch: &mut [GridSums],
        parallel: bool,
        wide: bool,
    ) {
        let nodes = Disjoint::new(nodes);
        for_each_row(rows, scratch, parallel, |index, row| {
            // SAFETY: rows share no node
            let nodes = unsafe { nodes.slice(row.start as usize..(row.start + row.len) as usize) };
            divide::<D>(nodes, wide);
            let (first, last) = ranges[index];
            for constraint in &constraints[first as usize..last as usize] {
                let node = &mut nodes[constraint.offset as usize];
                let place = Place {
                    position: constraint.position,
                    time,
                };
                let imposed = boundaries[constraint.boundary].impose(&place, &vector(node));
                node.0[..D].copy_from_slice(imposed.as_slice());
            }
            GridSums::default()
        });
    }
}

/// The first `D` numbers of a node.
#[inline(always)]
fn vector<const D: usize>(node: &Node) -> Vector<D> {
    Vector::from_fn(|a, _| node.0[a])
}

/// [`Shared::row`], compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn row_wide<const D: usize>(
    shared: &Shared<'_, D>,
    main: &mut [Node],
    change: &mut [Node],
    external: &[Node],
    constraints: &mut [Constraint<D>],
) -> GridSums {
    shared.row::<crate::real::Avx>(main, change, external, constraints)
}

struct Shared<'a, const D: usize> {
    external: &'a [Node],
    ranges: &'a [(u32, u32)],
    boundaries: &'a [Box<dyn Condition<D>>],
    gravity: Vector<D>,
    ratio: f64,
    time: f64,
    dt: f64,
    decay: f64,
}

impl<const D: usize> Shared<'_, D> {
    #[inline(always)]
    fn row<L: Lane>(
        &self,
        main: &mut [Node],
        change: &mut [Node],
        external: &[Node],
        constraints: &mut [Constraint<D>],
    ) -> GridSums {
        let mut sums = GridSums::default();
        let free = Free {
            gravity: self.gravity,
            dt: self.dt,
        };
        let mut free_sums = FreeSums::<L>::new();
        // without these a node needs a few operations; most scenes have no others, but for the nodes at their sides
        let plain = external.is_empty() && self.decay == 1.0;
        let mut rest = constraints;
        let mut next = 0;
        while next < main.len() {
            let k = next;
            if plain {
                let held = rest.first().map_or(main.len(), |c| c.offset as usize);
                if held > k {
                    let own = if change.is_empty() { 0..0 } else { k..held };
                    free.nodes::<L>(&mut main[k..held], &mut change[own], &mut free_sums);
                    next = held;
                    continue;
                }
            }
            next += 1;
            let held = rest.partition_point(|constraint| constraint.offset as usize == k);
            let (here, after) = std::mem::take(&mut rest).split_at_mut(held);
            rest = after;
            let mass = main[k].0[D];
            if mass <= NO_MASS {
                main[k] = Node::default();
                if let Some(change) = change.get_mut(k) {
                    *change = Node::default();
                }
                here.iter_mut()
                    .for_each(|constraint| constraint.impulse = Vector::zeros());
                continue;
            }
            let force = external.get(k).map_or(Vector::zeros(), vector);
            let internal = change.get(k).map(vector);
            let (velocity, difference) = self.node(
                mass,
                vector(&main[k]) / mass,
                internal,
                force,
                here,
                &mut sums,
            );
            main[k].0[..D].copy_from_slice(velocity.as_slice());
            main[k].0[D] = PRESENT;
            if let Some(change) = change.get_mut(k) {
                change.0[..D].copy_from_slice(difference.as_slice());
            }
        }
        free.account(&free_sums, &mut sums);
        sums
    }

    /// One node: velocity at the end of the step and its change.
    #[inline(always)]
    fn node(
        &self,
        mass: f64,
        arrived: Vector<D>,
        internal: Option<Vector<D>>,
        external: Vector<D>,
        constraints: &mut [Constraint<D>],
        sums: &mut GridSums,
    ) -> (Vector<D>, Vector<D>) {
        let mut start = arrived;
        if internal.is_some() {
            // a node that is held starts the step with the velocity of its wall; what its points brought is lost
            for constraint in constraints.iter_mut() {
                let place = Place {
                    position: constraint.position,
                    time: self.time,
                };
                let before = start;
                start = self.boundaries[constraint.boundary].impose(&place, &start);
                constraint.impulse = (start - before) * (mass * (1.0 - self.ratio));
            }
        } else {
            constraints
                .iter_mut()
                .for_each(|constraint| constraint.impulse = Vector::zeros());
        }
        let pull = internal.unwrap_or_else(Vector::zeros);
        let free = start + (self.gravity + (pull + external) / mass) * self.dt;
        let mut taken = 0.0;
        let held = self.hold(mass, free, constraints);
        // Damping acts on nodes as they are held, not on how their forces would have moved them; what still differs from a
        // moving wall afterwards, the wall makes up for.
        let damped = held * self.decay;
        let end = if self.decay == 1.0 {
            held
        } else {
            self.hold(mass, damped, constraints)
        };
        for constraint in constraints.iter() {
            let wall = |time: f64| {
                let position = constraint.position;
                self.boundaries[constraint.boundary].wall_velocity(&Place { position, time })
            };
            let mean = (wall(self.time) + wall(self.time + self.dt)) * 0.5;
            taken += constraint.impulse.dot(&mean);
        }
        let middle = (start + end) * 0.5;
        sums.arrived += 0.5 * mass * arrived.norm_squared();
        sums.left += 0.5 * mass * end.norm_squared();
        sums.internal += self.dt * pull.dot(&middle);
        sums.gravity += mass * self.dt * self.gravity.dot(&middle);
        // points move with the velocity at the end: the work of a load is force times the way of its points
        let pushed = self.dt * external.dot(&end);
        sums.external += pushed;
        sums.absorbed += pushed - self.dt * external.dot(&middle);
        sums.damping += mass * (damped - held).dot(&middle);
        sums.boundary += taken;
        if !constraints.is_empty() {
            let work = mass * ((held - free) + (end - damped)).dot(&middle);
            let lost = 0.5 * mass * (arrived.norm_squared() - start.norm_squared());
            sums.absorbed += lost - work + taken;
        }
        (end, end - start)
    }
    /// What all conditions of a node make of its velocity at the end of the step; their impulses are added up.
    #[inline(always)]
    fn hold(
        &self,
        mass: f64,
        mut velocity: Vector<D>,
        constraints: &mut [Constraint<D>],
    ) -> Vector<D> {
        for constraint in constraints.iter_mut() {
            let place = Place {
                position: constraint.position,
                time: self.time + self.dt,
            };
            let before = velocity;
            velocity = self.boundaries[constraint.boundary].impose(&place, &velocity);
            constraint.impulse += (velocity - before) * mass;
        }
        velocity
    }
}
