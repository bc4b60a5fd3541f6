//! More terms of the velocities of the grid, see [`Method::terms`](crate::transfer::Method::terms).

use super::disjoint::Disjoint;
use super::free::NO_MASS;
use super::integrate::{Constraint, for_each_row};
use super::ledger::GridSums;
use super::mpm::Mpm;
use super::stencil::Sources;
use crate::boundary::{Condition, Node as Place};
use crate::grid::Node;
use crate::math::Vector;

impl<const D: usize> Mpm<D> {
    /// Adds all terms but the first to the velocities at the end of the step; points are left with the velocity of a term. Returns
    /// what that changes in what the step did to the grid.
    ///
    /// Terms are sums of momentum zero, so that momentum stays what it was, but for what conditions take: a term is what they
    /// leave of it, so that a node that is held gets none.
    pub(super) fn sharpen(&mut self, time: f64, dt: f64) -> GridSums {
        let mut total = GridSums::default();
        if !self.has_terms() {
            return total;
        }
        let mut image = std::mem::take(&mut self.image);
        self.term.copy_from_slice(&self.main);
        for _ in 1..self.terms {
            let from = Sources {
                main: self.term.as_ptr(),
                change: self.change.as_ptr(),
                second: self.second.as_ptr(),
            };
            self.exchange(dt, &from, &mut image);
            total = total.and(&self.next_term(&image, time, dt));
        }
        self.image = image;
        total
    }

    /// The next term from the last one and its image, added to the velocities.
    fn next_term(&mut self, image: &[Node], time: f64, dt: f64) -> GridSums {
        let main = Disjoint::new(&mut self.main);
        let term = Disjoint::new(&mut self.term);
        let constraints = Disjoint::new(&mut self.constraints);
        let hold = Hold {
            boundaries: &self.boundaries,
            time,
            dt,
        };
        let (ranges, external) = (&self.constraint_ranges, &self.external);
        for_each_row(
            &self.blocks.rows,
            &mut self.row_sums,
            self.parallel,
            |index, row| {
                let nodes = row.start as usize..(row.start + row.len) as usize;
                let (first, last) = ranges[index];
                // SAFETY: rows share no node and no constraint
                let (main, term, constraints) = unsafe {
                    (
                        main.slice(nodes.clone()),
                        term.slice(nodes.clone()),
                        constraints.slice(first as usize..last as usize),
                    )
                };
                let image = &image[nodes.clone()];
                for (term, image) in term.iter_mut().zip(image) {
                    let mass = image.0[D];
                    let inverse = if mass > NO_MASS { 1.0 / mass } else { 0.0 };
                    for a in 0..D {
                        term.0[a] -= image.0[a] * inverse;
                    }
                }
                let mut sums = GridSums::default();
                for constraint in constraints {
                    let k = constraint.offset as usize;
                    hold.term(constraint, image[k].0[D], &main[k], &mut term[k], &mut sums);
                }
                for (main, term) in main.iter_mut().zip(&*term) {
                    for a in 0..D {
                        main.0[a] += term.0[a];
                    }
                }
                if !external.is_empty() {
                    // points go farther by the term, and loads with them
                    let work = external[nodes].iter().zip(&*term);
                    let way = |(force, term): (&Node, &Node)| -> f64 {
                        (0..D).map(|a| force.0[a] * term.0[a]).sum()
                    };
                    let pushed = dt * work.map(way).sum::<f64>();
                    sums.external += pushed;
                    sums.absorbed += pushed;
                }
                sums
            },
        );
        self.row_sums
            .iter()
            .fold(GridSums::default(), GridSums::and)
    }
}

/// What holds nodes at the end of a step.
struct Hold<'a, const D: usize> {
    boundaries: &'a [Box<dyn Condition<D>>],
    time: f64,
    dt: f64,
}

impl<const D: usize> Hold<'_, D> {
    /// Makes `term` what the condition leaves of it, next to the velocity that satisfies the condition already.
    fn term(
        &self,
        constraint: &mut Constraint<D>,
        mass: f64,
        velocity: &Node,
        term: &mut Node,
        sums: &mut GridSums,
    ) {
        if mass <= NO_MASS {
            return;
        }
        let boundary = &self.boundaries[constraint.boundary];
        let wall = |time: f64| {
            boundary.wall_velocity(&Place {
                position: constraint.position,
                time,
            })
        };
        let place = Place {
            position: constraint.position,
            time: self.time + self.dt,
        };
        let velocity: Vector<D> = Vector::from_fn(|a, _| velocity.0[a]);
        let asked: Vector<D> = Vector::from_fn(|a, _| term.0[a]);
        let free = velocity + asked;
        let held = boundary.impose(&place, &free);
        // components that are left alone stay what they are to the last bit
        let left = Vector::from_fn(|a, _| {
            if held[a] == free[a] {
                asked[a]
            } else {
                held[a] - velocity[a]
            }
        });
        let impulse = (left - asked) * mass;
        let mean = (wall(self.time) + wall(self.time + self.dt)) * 0.5;
        let work = impulse.dot(&mean);
        term.0[..D].copy_from_slice(left.as_slice());
        constraint.impulse += impulse;
        sums.boundary += work;
        sums.absorbed += work;
    }
}
