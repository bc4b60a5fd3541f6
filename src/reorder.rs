//! Putting columns into another order without a second copy of them.
//!
//! An order falls apart into cycles, along which every row goes to the place of the next. [`cycles`] writes the places of all
//! cycles into one list, once for all columns: walked along the list, moves need not wait for each other, which makes them
//! several times faster than following the order from place to place.

use crate::real::prefetch;

/// Lists the cycles of an order in which row `i` goes to place `target[i]`.
///
/// `target` must be a permutation of `0 .. target.len()`, and is used up. `order` gets the places of every cycle that is longer
/// than one, each after the one that gets its row, and `leaders` the index in `order` at which each cycle begins.
pub fn cycles(target: &mut [u32], order: &mut Vec<u32>, leaders: &mut Vec<u32>) {
    leaders.clear();
    order.clear();
    for start in 0..target.len() {
        let mut place = start;
        if target[place] as usize == place {
            continue;
        }
        let first = order.len();
        leaders.push(first as u32);
        while target[place] as usize != place {
            order.push(place as u32);
            // a place that goes to itself has been visited
            place = std::mem::replace(&mut target[place], place as u32) as usize;
        }
        order[first..].reverse();
    }
}

/// Puts a column with `width` numbers a row into the new order, given the lists that [`cycles`] makes.
pub fn permute_in_place<T: Copy>(column: &mut [T], width: usize, order: &[u32], leaders: &[u32]) {
    match width {
        1 => move_rows(column, order, leaders),
        2 => move_rows(column.as_chunks_mut::<2>().0, order, leaders),
        3 => move_rows(column.as_chunks_mut::<3>().0, order, leaders),
        4 => move_rows(column.as_chunks_mut::<4>().0, order, leaders),
        6 => move_rows(column.as_chunks_mut::<6>().0, order, leaders),
        9 => move_rows(column.as_chunks_mut::<9>().0, order, leaders),
        _ => {
            for places in each(order, leaders) {
                for pair in places.windows(2) {
                    for k in 0..width {
                        let [to, from] = [pair[0], pair[1]].map(|p| p as usize * width + k);
                        column.swap(from, to);
                    }
                }
            }
        }
    }
}

/// How many moves before its turn a row is asked for: their places follow no pattern that a processor could see.
const AHEAD: usize = 40;

fn move_rows<T: Copy>(rows: &mut [T], order: &[u32], leaders: &[u32]) {
    let mut moved = 0;
    for places in each(order, leaders) {
        let held = rows[places[0] as usize];
        for pair in places.windows(2) {
            if let Some(&soon) = order.get(moved + AHEAD) {
                // a row may begin anywhere in a cache line
                let row = rows.as_ptr().wrapping_add(soon as usize);
                prefetch(row, size_of::<T>());
                prefetch(row.wrapping_byte_add(size_of::<T>() - 1), 1);
            }
            moved += 1;
            rows[pair[0] as usize] = rows[pair[1] as usize];
        }
        moved += 1;
        rows[places[places.len() - 1] as usize] = held;
    }
}

/// The places of each cycle.
fn each<'a>(order: &'a [u32], leaders: &'a [u32]) -> impl Iterator<Item = &'a [u32]> {
    let ends = leaders.iter().skip(1).copied();
    let ends = ends.chain(std::iter::once(order.len() as u32));
    leaders
        .iter()
        .zip(ends)
        .map(|(&first, end)| &order[first as usize..end as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A permutation with cycles of many lengths: multiplication modulo a prime, and some fixed places after it.
    fn targets() -> Vec<u32> {
        (0..101).map(|i| i * 7 % 101).chain(101..110).collect()
    }

    #[test]
    fn every_row_goes_to_the_place_that_the_order_names() {
        let targets = targets();
        let (mut order, mut leaders) = (vec![9; 3], vec![9; 3]);
        cycles(&mut targets.clone(), &mut order, &mut leaders);
        for width in [1, 2, 3, 4, 5, 6, 9] {
            let old: Vec<usize> = (0..width * targets.len()).collect();
            let mut new = old.clone();
            permute_in_place(&mut new, width, &order, &leaders);
            for (i, &to) in targets.iter().enumerate() {
                let to = to as usize;
                assert_eq!(new[to * width..][..width], old[i * width..][..width]);
            }
        }
    }

    #[test]
    fn every_cycle_is_listed_once_and_fixed_places_are_not() {
        let (mut order, mut leaders) = (Vec::new(), Vec::new());
        cycles(&mut [1, 2, 0, 3, 5, 4], &mut order, &mut leaders);
        assert_eq!(order, [2, 1, 0, 5, 4]);
        assert_eq!(leaders, [0, 3]);
        cycles(&mut [0, 1, 2], &mut order, &mut leaders);
        assert!(order.is_empty() && leaders.is_empty());
        cycles(&mut [], &mut order, &mut leaders);
        assert!(order.is_empty() && leaders.is_empty());
    }
}
