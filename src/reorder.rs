//! Putting columns into another order without a second copy of them.
//!
//! An order says where each place takes its content from: `new[i] = old[order[i]]`. It falls apart into cycles; a column is
//! reordered by walking each cycle once. The cycles are found once and serve every column.

/// Finds one place of every cycle of `order` that is longer than one, in ascending order of the places.
///
/// `order` must be a permutation of `0 .. order.len()`. `leaders` and `seen` are overwritten; reusing them saves allocations.
pub fn cycle_leaders(order: &[u32], leaders: &mut Vec<u32>, seen: &mut Vec<bool>) {
    leaders.clear();
    seen.clear();
    seen.resize(order.len(), false);
    for start in 0..order.len() {
        if seen[start] || order[start] as usize == start {
            continue;
        }
        leaders.push(start as u32);
        let mut place = start;
        while !seen[place] {
            seen[place] = true;
            place = order[place] as usize;
        }
    }
}

/// Puts a column with `width` numbers a row into the new order, given one place of each of its cycles.
pub fn permute_in_place<T: Copy>(column: &mut [T], width: usize, order: &[u32], leaders: &[u32]) {
    debug_assert_eq!(column.len(), width * order.len());
    for &leader in leaders {
        // Swapping along the cycle hands the leader's row on until it arrives where it belongs.
        let mut place = leader as usize;
        loop {
            let from = order[place] as usize;
            if from == leader as usize {
                break;
            }
            for k in 0..width {
                column.swap(place * width + k, from * width + k);
            }
            place = from;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A permutation with cycles of many lengths: multiplication modulo a prime, and some fixed places after it.
    fn order() -> Vec<u32> {
        (0..101).map(|i| i * 7 % 101).chain(101..110).collect()
    }

    #[test]
    fn every_row_comes_from_the_place_that_the_order_names() {
        let order = order();
        let (mut leaders, mut seen) = (vec![9; 3], vec![true; 500]);
        cycle_leaders(&order, &mut leaders, &mut seen);
        for width in [1, 3, 6] {
            let old: Vec<usize> = (0..width * order.len()).collect();
            let mut new = old.clone();
            permute_in_place(&mut new, width, &order, &leaders);
            for (i, &from) in order.iter().enumerate() {
                let from = from as usize;
                assert_eq!(new[i * width..][..width], old[from * width..][..width]);
            }
        }
    }

    #[test]
    fn every_cycle_has_one_leader_and_fixed_places_have_none() {
        let (mut leaders, mut seen) = (Vec::new(), Vec::new());
        cycle_leaders(&[1, 2, 0, 3, 5, 4], &mut leaders, &mut seen);
        assert_eq!(leaders, [0, 4]);
        cycle_leaders(&[0, 1, 2], &mut leaders, &mut seen);
        assert!(leaders.is_empty());
        cycle_leaders(&[], &mut leaders, &mut seen);
        assert!(leaders.is_empty());
    }
}
