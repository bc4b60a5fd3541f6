//! Which blocks of the grid exist, where their nodes are stored, and which points each one holds.
//!
//! The grid is cut into cubes of `edge` nodes. A block is *occupied* if a point's stencil starts in it, and *active*
//! (stored) if it or a neighbour is occupied. Active blocks that follow each other along the last axis form a run, whose
//! nodes are stored row by row, so that a row of a stencil is contiguous in memory wherever it lies. Everything here costs
//! what the points cost, however large the grid around them is.

use std::ops::Range;

/// An occupied block of one body.
#[derive(Clone, Copy, Debug)]
pub struct Block<const D: usize> {
    /// First node along each axis.
    pub origin: [i32; D],
    /// First and one past the last row of the body's points in this block.
    pub points: (u32, u32),
    /// For each of the 3^(D−1) columns of blocks around this one: storage index of the first node at this block's height on
    /// the last axis, and the distance between rows.
    pub anchors: [(u32, u32); 9],
}

impl<const D: usize> Block<D> {
    /// Rows of the body's points in this block.
    pub fn points(&self) -> Range<usize> {
        self.points.0 as usize..self.points.1 as usize
    }
}

/// Coordinates of an occupied block, counted in blocks, and the first and one past the last row of the points in it.
pub type Occupied<const D: usize> = ([i32; D], (u32, u32));

/// Consecutive stored nodes along the last axis.
#[derive(Clone, Copy, Debug)]
pub struct Row<const D: usize> {
    /// Storage index of the first node.
    pub start: u32,
    /// How many nodes.
    pub len: u32,
    /// Grid indices of the first node.
    pub node: [i32; D],
}

/// The occupied blocks of one body in storage order, and by colour.
#[derive(Clone, Debug, Default)]
pub struct BodyBlocks<const D: usize> {
    /// Sorted by origin.
    pub blocks: Vec<Block<D>>,
    /// Indices into `blocks`: blocks of one colour are at least two apart, so that their stencils never share a node.
    pub colours: Vec<Vec<u32>>,
}

impl<const D: usize> BodyBlocks<D> {
    /// How many points the body had when it was sorted into its blocks.
    pub fn points(&self) -> usize {
        self.blocks.last().map_or(0, |block| block.points().end)
    }
}

/// All active blocks of the grid.
#[derive(Clone, Debug, Default)]
pub struct Blocks<const D: usize> {
    /// For each body.
    pub bodies: Vec<BodyBlocks<D>>,
    /// The nodes of active blocks that belong to the grid.
    pub rows: Vec<Row<D>>,
    /// How many nodes have storage.
    pub stored: usize,
    active: Vec<([i32; D], u32, u32)>,
    wanted: Vec<[i32; D]>,
}

impl<const D: usize> Blocks<D> {
    /// Lays out storage for the blocks that the bodies occupy; `occupied` gives for each body its sorted distinct block
    /// coordinates with the range of points in each.
    pub fn rebuild(&mut self, edge: i32, counts: &[i32; D], occupied: &[Vec<Occupied<D>>]) {
        self.activate(occupied);
        self.assign_storage(edge, counts);
        self.bodies.resize_with(occupied.len(), BodyBlocks::default);
        for (body, list) in occupied.iter().enumerate() {
            let mut target = std::mem::take(&mut self.bodies[body]);
            target.blocks.clear();
            target.colours.resize_with(1 << D, Vec::new);
            target.colours.iter_mut().for_each(Vec::clear);
            for (index, &(block, points)) in list.iter().enumerate() {
                target.blocks.push(Block {
                    origin: block.map(|b| b * edge),
                    points,
                    anchors: self.anchors(&block),
                });
                let colour = (0..D).fold(0, |c, a| 2 * c + (block[a] & 1) as usize);
                target.colours[colour].push(index as u32);
            }
            self.bodies[body] = target;
        }
    }

    fn activate(&mut self, occupied: &[Vec<Occupied<D>>]) {
        self.wanted.clear();
        for &(block, _) in occupied.iter().flatten() {
            for neighbour in 0..3_i32.pow(D as u32) {
                let mut rest = neighbour;
                let mut coordinate = block;
                for a in (0..D).rev() {
                    coordinate[a] += rest % 3 - 1;
                    rest /= 3;
                }
                self.wanted.push(coordinate);
            }
        }
        self.wanted.sort_unstable();
        self.wanted.dedup();
    }

    fn assign_storage(&mut self, edge: i32, counts: &[i32; D]) {
        let rows_per_block = edge.pow(D as u32 - 1);
        self.active.clear();
        self.rows.clear();
        let (mut base, mut first) = (0_u32, 0);
        while first < self.wanted.len() {
            let start = self.wanted[first];
            let mut length = 1;
            while first + length < self.wanted.len()
                && follows(&start, &self.wanted[first + length], length)
            {
                length += 1;
            }
            let stride = length as u32 * edge as u32;
            for q in 0..length {
                self.active.push((
                    self.wanted[first + q],
                    base + q as u32 * edge as u32,
                    stride,
                ));
            }
            let low = (start[D - 1] * edge).max(0);
            let high = ((start[D - 1] + length as i32) * edge).min(counts[D - 1]);
            for r in 0..rows_per_block {
                let mut node = start.map(|b| b * edge);
                let mut rest = r;
                for a in (0..D - 1).rev() {
                    node[a] += rest % edge;
                    rest /= edge;
                }
                let inside = (0..D - 1).all(|a| (0..counts[a]).contains(&node[a]));
                if inside && low < high {
                    let skipped = (low - node[D - 1]) as u32;
                    node[D - 1] = low;
                    self.rows.push(Row {
                        start: base + r as u32 * stride + skipped,
                        len: (high - low) as u32,
                        node,
                    });
                }
            }
            // beyond this the nodes alone take more than 100 GB
            base = base
                .checked_add(rows_per_block as u32 * stride)
                .expect("fewer than 2^32 nodes are stored");
            first += length;
        }
        self.stored = base as usize;
    }

    fn anchors(&self, block: &[i32; D]) -> [(u32, u32); 9] {
        let mut anchors = [(0, 0); 9];
        for (neighbour, anchor) in anchors
            .iter_mut()
            .enumerate()
            .take(3_usize.pow(D as u32 - 1))
        {
            let mut coordinate = *block;
            let mut rest = neighbour as i32;
            for a in (0..D - 1).rev() {
                coordinate[a] += rest % 3 - 1;
                rest /= 3;
            }
            // every neighbour of an occupied block is active
            if let Ok(found) = self
                .active
                .binary_search_by(|(active, _, _)| active.cmp(&coordinate))
            {
                *anchor = (self.active[found].1, self.active[found].2);
            }
        }
        anchors
    }
}

/// Whether `block` comes `steps` after `start` along the last axis.
fn follows<const D: usize>(start: &[i32; D], block: &[i32; D], steps: usize) -> bool {
    start[..D - 1] == block[..D - 1] && block[D - 1] == start[D - 1] + steps as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_block_activates_its_neighbours_and_only_nodes_of_the_grid_get_rows() {
        let mut blocks = Blocks::<2>::default();
        blocks.rebuild(16, &[20, 20], &[vec![([0, 0], (0, 5))]]);
        assert_eq!(blocks.stored, 9 * 256);
        assert_eq!(
            blocks
                .rows
                .iter()
                .map(|row| row.len as usize)
                .sum::<usize>(),
            20 * 20
        );
        let anchors = blocks.bodies[0].blocks[0].anchors;
        assert_eq!(anchors[1].1, 48);
        // the row through the block's first node starts one block into its run
        assert_eq!(anchors[1].0, 9 * 256 / 3 + 16);
    }

    #[test]
    fn far_apart_blocks_cost_the_same_as_near_ones() {
        let mut blocks = Blocks::<3>::default();
        blocks.rebuild(
            4,
            &[1 << 29; 3],
            &[vec![([5, 5, 5], (0, 1)), ([90_000_000, 5, 7], (1, 2))]],
        );
        assert_eq!(blocks.stored, 2 * 27 * 64);
    }
}
