//! The momentum equation on the nodes of the grid, and the conditions imposed there.

use super::disjoint::Disjoint;
use super::ledger::GridSums;
use crate::boundary::{Condition, Node as Place};
use crate::grid::{Node, Row};
use crate::math::Vector;
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

/// What takes the place of the mass once a node has a velocity; a node without mass has none, and points must not take its
/// zero for one.
const PRESENT: f64 = 1.0;

/// Below this mass a node's velocity cannot be computed; no point comes near it.
pub const NO_MASS: f64 = 1e-290;

impl<const D: usize> GridStep<'_, D> {
    /// Turns momenta and forces into velocities at the end of the step and their changes; `sums` gets one entry a row.
    pub fn integrate(&mut self, sums: &mut [GridSums], parallel: bool) {
        let split = !self.change.is_empty();
        let main = Disjoint::new(self.main);
        let change = Disjoint::new(self.change);
        let constraints = Disjoint::new(self.constraints);
        let decay = (-self.damping * self.dt).exp();
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
            this.row(main, change, external, constraints)
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
    ) {
        let nodes = Disjoint::new(nodes);
        for_each_row(rows, scratch, parallel, |index, row| {
            // SAFETY: rows share no node
            let nodes = unsafe { nodes.slice(row.start as usize..(row.start + row.len) as usize) };
            for node in nodes.iter_mut() {
                let mass = node.0[D];
                let there = mass > NO_MASS;
                let inverse = if there { 1.0 / mass } else { 0.0 };
                node.0[D] = if there { PRESENT } else { 0.0 };
                for a in 0..D {
                    node.0[a] *= inverse;
                }
            }
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

/// Sums over nodes on which nothing but gravity and the points act; component D means nothing.
#[derive(Default)]
struct FreeSums {
    /// Σ ½ m v∘v at the start of the step.
    arrived: [f64; 4],
    /// The same at its end.
    left: [f64; 4],
    /// Σ f ∘ (v + v'), twice the power of internal forces.
    internal: [f64; 4],
    /// Σ m (v + v') / 2.
    momentum: [f64; 4],
}

impl FreeSums {
    fn add_to<const D: usize>(&self, dt: f64, gravity: &Vector<D>, sums: &mut GridSums) {
        for a in 0..D {
            sums.arrived += self.arrived[a];
            sums.left += self.left[a];
            sums.internal += 0.5 * dt * self.internal[a];
            sums.gravity += dt * gravity[a] * self.momentum[a];
        }
    }
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
    fn row(
        &self,
        main: &mut [Node],
        change: &mut [Node],
        external: &[Node],
        constraints: &mut [Constraint<D>],
    ) -> GridSums {
        let mut sums = GridSums::default();
        let mut free = FreeSums::default();
        // without these a node needs a few operations; most scenes have no others, but for the nodes at their sides
        let plain = external.is_empty() && self.decay == 1.0;
        let mut rest = constraints;
        for k in 0..main.len() {
            if plain && rest.first().is_none_or(|next| next.offset as usize > k) {
                self.free_node(&mut main[k], change.get_mut(k), &mut free);
                continue;
            }
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
        free.add_to::<D>(self.dt, &self.gravity, &mut sums);
        sums
    }

    /// What [`Self::node`] does where nothing but gravity and the points act: four numbers at once, the mass among them, the mass as if it
    /// were a component.
    #[inline(always)]
    fn free_node(&self, main: &mut Node, change: Option<&mut Node>, sums: &mut FreeSums) {
        let mass = main.0[D];
        if mass <= NO_MASS {
            *main = Node::default();
            if let Some(change) = change {
                *change = Node::default();
            }
            return;
        }
        let mut g = [0.0; 4];
        g[..D].copy_from_slice(self.gravity.as_slice());
        let inverse = 1.0 / mass;
        let half = 0.5 * mass;
        // four are added and multiplied as fast as three
        let components = if D == 3 { 4 } else { D };
        match change {
            Some(change) => {
                for a in 0..components {
                    let start = main.0[a] * inverse;
                    let pull = change.0[a];
                    let end = start + (g[a] + pull * inverse) * self.dt;
                    sums.arrived[a] += half * start * start;
                    sums.left[a] += half * end * end;
                    sums.internal[a] += pull * (start + end);
                    sums.momentum[a] += half * (start + end);
                    change.0[a] = end - start;
                    main.0[a] = end;
                }
            }
            None => {
                for a in 0..components {
                    let start = main.0[a] * inverse;
                    let end = start + g[a] * self.dt;
                    sums.arrived[a] += half * start * start;
                    sums.left[a] += half * end * end;
                    sums.momentum[a] += half * (start + end);
                    main.0[a] = end;
                }
            }
        }
        main.0[D] = PRESENT;
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
