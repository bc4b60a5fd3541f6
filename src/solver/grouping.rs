//! When sorting again pays although no point has left its block.
//!
//! Points are stored cell by cell, so that groups of four have the same nodes and are taken as one. As points move on, groups fall
//! apart and cost more, until points are sorted again. A sort takes as long as so many steps lose that have all groups apart.

/// What has become of the groups since the last sort.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grouping {
    /// The share of points in groups that were apart in the first step after the sort; sorting does not help those.
    at_first: Option<f64>,
    /// Steps with all other groups apart, and together, that would have lost and won as much as the steps since.
    apart: f64,
    together: f64,
}

impl Grouping {
    /// Notes how many of all points were in groups that are apart in a step.
    pub fn note(&mut self, apart: usize, points: usize) {
        let share = apart as f64 / points.max(1) as f64;
        let first = *self.at_first.get_or_insert(share);
        let fallen = (share - first).max(0.0);
        self.apart += fallen;
        self.together += 1.0 - first - fallen;
    }

    /// Whether the groups that fell apart have cost as much as a sort, and those that held have won twice as much: then the next
    /// sort is likely to win as much again. `sort` is what a sort costs, in steps with all groups apart.
    pub fn is_worn(&self, sort: f64) -> bool {
        self.apart >= sort && self.together >= 2.0 * sort
    }
}

/// What sorting costs, in steps by what groups that are apart cost more: measured, some 55 ns over 6 ns a point in 2D and 104 over 4
/// in 3D.
pub const fn sort_in_steps(dimension: usize) -> f64 {
    match dimension {
        1 => f64::INFINITY,
        2 => 9.0,
        _ => 26.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps until a sort pays when the given share is apart in each step.
    fn steps(apart: impl Fn(usize) -> usize) -> Option<usize> {
        let mut grouping = Grouping::default();
        (0..1000).find(|&step| {
            grouping.note(apart(step), 100);
            grouping.is_worn(10.0)
        })
    }

    #[test]
    fn sorting_pays_when_groups_fell_apart_that_held_long_enough() {
        assert_eq!(steps(|_| 0), None, "all hold");
        assert_eq!(steps(|_| 100), None, "never together, so sorting is no use");
        assert_eq!(steps(|_| 40), None, "nothing changes");
        assert_eq!(steps(|step| if step < 50 { 0 } else { 100 }), Some(59));
        assert_eq!(
            steps(|step| if step < 15 { 0 } else { 100 }),
            None,
            "held too short"
        );
        assert_eq!(
            steps(|step| if step < 50 { 25 } else { 75 }),
            Some(69),
            "half of them"
        );
    }
}
