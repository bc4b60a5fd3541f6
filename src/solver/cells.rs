//! Which cell and block a point is counted to, and in which order the points of a block are stored.

use super::disjoint::Disjoint;
use crate::grid::Geometry;
use crate::math::Vector;

/// Where the points of a body are counted to.
pub(super) struct Places<'a, const D: usize> {
    pub(super) geometry: &'a Geometry<D>,
    /// 1 / cell size, 1/m.
    pub(super) inverse: f64,
    /// Where stencils start relative to their point, in cells, and the last place at which they do.
    pub(super) shift: [f64; D],
    pub(super) last: [i32; D],
    /// Blocks have two to this power nodes along an edge.
    pub(super) exponent: u32,
}

impl<const D: usize> Places<'_, D> {
    /// Whether a position is in the grid; false if it is not a number.
    #[inline(always)]
    pub(super) fn holds(&self, position: &Vector<D>) -> bool {
        let x = self.geometry.in_cells(position, self.inverse);
        (0..D).all(|a| x[a] >= 0.0 && x[a] <= f64::from(self.geometry.cells[a]))
    }

    /// The first node of the stencil of a point in the grid.
    #[inline(always)]
    fn first(&self, position: &Vector<D>) -> [i32; D] {
        let x = self.geometry.in_cells(position, self.inverse);
        std::array::from_fn(|a| ((x[a] + self.shift[a]) as i32).min(self.last[a]))
    }

    /// The block that it is in.
    #[inline(always)]
    pub(super) fn block(&self, position: &Vector<D>) -> [i32; D] {
        self.first(position).map(|first| first >> self.exponent)
    }

    /// The number of its cell among those of the block.
    #[inline(always)]
    fn cell(&self, position: &Vector<D>) -> usize {
        let within = (1 << self.exponent) - 1;
        self.first(position).iter().fold(0, |number, first| {
            (number << self.exponent) + (first & within) as usize
        })
    }
}

/// Cells that a block has at most, 8³, and that most blocks have in 3D, 4³.
const MOST_CELLS: usize = 512;
const FEW_CELLS: usize = 64;

/// Where the points of a cell go.
#[derive(Clone, Copy, Default)]
struct Cell {
    points: u32,
    /// How many have their place.
    placed: u32,
    /// Points of whole groups of eight, and of those and whole groups of four.
    ends: [u32; 2],
    /// Rows for points of groups of eight, of four, and of none.
    rows: [u32; 3],
}

impl Cell {
    /// The row for the next point.
    fn next(&mut self) -> u32 {
        let part = self.ends.iter().filter(|end| self.placed >= **end).count();
        self.placed += 1;
        let row = self.rows[part];
        self.rows[part] += 1;
        row
    }
}

/// Finds rows for the points of cells, from row `first` on. Groups of eight are for 3D.
fn lay_out_cells<const D: usize>(cells: &mut [Cell], first: u32) {
    let mut totals = [0; 3];
    for cell in &mut *cells {
        let eights = if D == 3 { cell.points & !7 } else { 0 };
        cell.ends = [eights, cell.points & !3];
        let own = [eights, cell.ends[1] - eights, cell.points & 3];
        cell.rows = totals;
        for part in 0..3 {
            totals[part] += own[part];
        }
    }
    let starts = [first, first + totals[0], first + totals[0] + totals[1]];
    for cell in cells {
        for part in 0..3 {
            cell.rows[part] += starts[part];
        }
    }
}

/// Finds rows for the points of a block, from row `first` on, cell by cell and those of a cell as they were: first those of whole
/// groups of eight (in 3D), then those of whole groups of four, then what is left. So a cell with an odd point more does not keep the
/// cells after it from being taken in whole groups. `rows` are those that the points are in, `slots` gets those that they go to.
///
/// # Safety
/// Nobody else uses these slots meanwhile.
pub(super) unsafe fn order_block<const D: usize>(
    places: &Places<'_, D>,
    positions: &[Vector<D>],
    rows: &[u32],
    first: u32,
    slots: &Disjoint<'_, u32>,
) {
    // SAFETY: passed on to the caller
    unsafe {
        if D as u32 * places.exponent <= FEW_CELLS.ilog2() {
            order_cells::<D, FEW_CELLS>(places, positions, rows, first, slots);
        } else {
            order_cells::<D, MOST_CELLS>(places, positions, rows, first, slots);
        }
    }
}

/// [`order_block`] for a block with so many cells or fewer.
unsafe fn order_cells<const D: usize, const CELLS: usize>(
    places: &Places<'_, D>,
    positions: &[Vector<D>],
    rows: &[u32],
    first: u32,
    slots: &Disjoint<'_, u32>,
) {
    let mut cells = [Cell::default(); CELLS];
    for &row in rows {
        let row = row as usize;
        let cell = places.cell(&positions[row]);
        cells[cell].points += 1;
        // SAFETY: as the caller says
        unsafe { slots.slice(row..row + 1)[0] = cell as u32 };
    }
    lay_out_cells::<D>(&mut cells, first);
    for &row in rows {
        let row = row as usize;
        // SAFETY: as above
        let slot = unsafe { &mut slots.slice(row..row + 1)[0] };
        *slot = cells[*slot as usize].next();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells of the points in the order in which they are stored, given how many points each cell has; points come cell by cell in
    /// turn, so that no cell's are together before.
    fn stored<const D: usize>(counts: &[usize]) -> Vec<usize> {
        let geometry = Geometry {
            min: Vector::zeros(),
            cell_size: 1.0,
            cells: [4; D],
            counts: [5; D],
        };
        let places = Places::<D> {
            geometry: &geometry,
            inverse: 1.0,
            shift: [0.0; D],
            last: [3; D],
            exponent: 2,
        };
        let mut positions = Vec::new();
        let mut cell_of = Vec::new();
        for turn in 0..counts.iter().copied().max().unwrap_or(0) {
            for (cell, _) in counts.iter().enumerate().filter(|(_, n)| turn < **n) {
                let mut at = Vector::repeat(0.5);
                at[D - 1] += cell as f64;
                positions.push(at);
                cell_of.push(cell);
            }
        }
        let rows: Vec<u32> = (0..positions.len() as u32).collect();
        let mut slots = vec![0; rows.len()];
        // SAFETY: nobody else is here
        unsafe { order_block(&places, &positions, &rows, 0, &Disjoint::new(&mut slots)) };
        let mut stored = vec![usize::MAX; rows.len()];
        for (row, slot) in slots.iter().enumerate() {
            stored[*slot as usize] = cell_of[row];
        }
        stored
    }

    #[test]
    fn whole_groups_come_first_and_start_at_multiples_of_their_size() {
        let expected = |runs: &[(usize, usize)]| -> Vec<usize> {
            let runs = runs.iter();
            runs.flat_map(|&(cell, n)| vec![cell; n]).collect()
        };
        assert_eq!(
            stored::<3>(&[9, 17, 7]),
            expected(&[(0, 8), (1, 16), (2, 4), (0, 1), (1, 1), (2, 3)])
        );
        assert_eq!(
            stored::<2>(&[5, 3, 9]),
            expected(&[(0, 4), (2, 8), (0, 1), (1, 3), (2, 1)])
        );
        assert!(stored::<3>(&[]).is_empty());
    }
}
