//! What is computed: a block of points that flies through a box under gravity.

use super::BenchError;
use crate::scenario::{Scenario, parse};
use serde::{Deserialize, Serialize};

/// In which order points are stored before the first step.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// As a body is filled: along the axes.
    Lattice,
    /// None at all, as in points read from a file.
    Random,
}

/// One thing to measure.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Case {
    /// 1, 2 or 3.
    pub dimension: usize,
    /// Name of the basis.
    pub basis: String,
    /// Name of the transfer.
    pub transfer: String,
    /// Name of the update.
    pub update: String,
    /// Name of the law; it gets Young's modulus and Poisson's ratio.
    pub law: String,
    /// Points that are asked for; the block gets about as many.
    pub particles: usize,
    /// Their order at the start.
    pub order: Order,
    /// Threads.
    pub threads: usize,
}

/// Points per cell along an axis: 2, 4 and 8 a cell in 1D, 2D and 3D.
const PER_AXIS: usize = 2;

/// Empty cells between the block and each wall.
const MARGIN: usize = 8;

impl Case {
    /// Whether the same is asked for as by the other, but for the number of threads.
    pub fn differs_in_threads_alone(&self, other: &Self) -> bool {
        let threads = other.threads;
        let same = Self {
            threads,
            ..self.clone()
        };
        same == *other
    }

    /// Cells along each axis of a block of about `particles` points.
    fn block(&self) -> Vec<usize> {
        let cells = self.particles as f64 / PER_AXIS.pow(self.dimension as u32) as f64;
        let edge = (cells.powf(1.0 / self.dimension as f64).round() as usize).max(1);
        let mut block = vec![edge; self.dimension];
        // the last axis makes up for the rounding of the others
        let section = edge.pow(self.dimension as u32 - 1) as f64;
        block[self.dimension - 1] = ((cells / section).round() as usize).max(1);
        block
    }

    /// The scenario, as a user would write it.
    ///
    /// The block flies along the diagonal at a twentieth of its speed of sound, 33 m/s or so: at a Courant number of 0.4 a point crosses a
    /// cell in some 50 steps, so that re-sorting is part of what is measured.
    pub fn text(&self) -> String {
        const H: f64 = 0.01;
        let block = self.block();
        let list = |number: &dyn Fn(usize) -> f64| {
            let numbers: Vec<_> = (0..self.dimension)
                .map(|a| format!("{:?}", number(a)))
                .collect();
            format!("[{}]", numbers.join(", "))
        };
        let margin = MARGIN as f64 * H;
        let min = list(&|_| 0.0);
        let max = list(&|a| (block[a] + 2 * MARGIN) as f64 * H);
        let low = list(&|_| margin);
        let high = list(&|a| margin + block[a] as f64 * H);
        let gravity = list(&|a| if a + 1 == self.dimension { -9.81 } else { 0.0 });
        let velocity = list(&|_| 1.7 / (self.dimension as f64).sqrt());
        let sides: String = ["x", "y", "z"][..self.dimension]
            .iter()
            .flat_map(|axis| [format!("{axis}_min"), format!("{axis}_max")])
            .map(|side| {
                format!("[[boundary]]\nname = \"{side}\"\non.side = \"{side}\"\ncondition = \"roller\"\n")
            })
            .collect();
        let Self {
            dimension,
            basis,
            transfer,
            update,
            law,
            ..
        } = self;
        format!(
            "title = \"bench\"\ndimension = {dimension}\ngravity = {gravity}\n\
             [time]\nend = 1e4\ncourant = 0.4\n[output]\nevery = 1e4\n\
             [grid]\nmin = {min}\nmax = {max}\ncell_size = {H}\n\
             [method]\nbasis = \"{basis}\"\ntransfer = \"{transfer}\"\nupdate = \"{update}\"\n\
             [material.block]\ndensity = 1000\n{law} = {{ youngs_modulus = 1e6, poissons_ratio = 0.3 }}\n\
             [[body]]\nname = \"block\"\nmaterial = \"block\"\nparticles_per_cell = {PER_AXIS}\n\
             shape.box = {{ min = {low}, max = {high} }}\nvelocity = {velocity}\n{sides}"
        )
    }

    /// The scenario, checked.
    ///
    /// # Errors
    /// If a name is not known, or the law needs more than two elastic constants.
    pub fn scenario(&self) -> Result<Scenario, BenchError> {
        let loaded = parse("bench", &self.text(), &[]).map_err(BenchError::Input)?;
        Ok(loaded.scenario)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::body_point_count;

    #[test]
    fn blocks_have_about_as_many_points_as_asked_for() {
        for dimension in 1..=3 {
            for particles in [1_000, 100_000, 1_000_000] {
                let case = Case {
                    dimension,
                    basis: "linear".into(),
                    transfer: "flip".into(),
                    update: "usl".into(),
                    law: "hencky".into(),
                    particles,
                    order: Order::Lattice,
                    threads: 1,
                };
                let scenario = case.scenario().unwrap_or_else(|error| panic!("{error}"));
                let count = body_point_count(&scenario, 0) as f64;
                let ratio = count / particles as f64;
                assert!(
                    (ratio - 1.0).abs() < 0.1,
                    "{dimension}D {particles}: {count}"
                );
            }
        }
    }
}
