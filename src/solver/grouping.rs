//! When sorting again pays although no point has left its block.
//!
//! Points are stored cell by cell, so that groups of four, or of eight in 3D, have the same nodes and are taken as one. As points
//! move on, groups fall apart and cost more, until points are sorted again. A sort takes as long as so many steps lose that have all
//! groups apart.

/// What has become of the groups since the last sort.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grouping {
    /// The share of points in groups that were apart in the first step after the sort; sorting does not help those.
    at_first: Option<f64>,
    /// Steps with all other groups apart, and together, that would have lost and won as much as the steps since.
    apart: f64,
    together: f64,
    /// What `together` was before: half of it from before the last sort, a quarter from before the one before that, and so on.
    before: f64,
}

/// What four points lose that are one group of four but not half of a group of eight, as a share of what points lose whose group is
/// apart: measured, 11 ns of 22 a point.
const ALONE: f64 = 0.5;

impl Grouping {
    /// Notes how many of all points were in groups that are apart in a step, and how many in fours that stay alone in 3D.
    pub fn note(&mut self, apart: usize, alone: usize, points: usize) {
        let share = (apart as f64 + ALONE * alone as f64) / points.max(1) as f64;
        let first = *self.at_first.get_or_insert(share);
        let fallen = (share - first).max(0.0);
        self.apart += fallen;
        self.together += 1.0 - first - fallen;
    }

    /// Whether the groups that fell apart have cost as much as a sort, and groups have held for long enough after the last sorts. As
    /// often as groups hold t sorts' worth of steps, both sums together are 2 t: for t ≤ 1 a sort wins no more than it costs, and
    /// is tried the more seldom the less it wins, after 2 / t² sorts' worth of steps. `sort` is what a sort costs, in steps with all
    /// groups apart.
    pub fn is_worn(&self, sort: f64) -> bool {
        let (apart, held) = (self.apart / sort, (self.together + self.before) / sort);
        apart >= 1.0 && apart * held * held >= 8.0
    }

    /// Begins anew, points having been sorted.
    pub fn begin(&mut self) {
        *self = Self {
            before: 0.5 * (self.before + self.together),
            ..Self::default()
        };
    }
}

/// What sorting costs, in steps by what groups that are apart cost more: measured, some 48 ns over 6 ns a point in 2D and 70 over 18
/// in 3D.
pub const fn sort_in_steps(dimension: usize) -> f64 {
    match dimension {
        1 => f64::INFINITY,
        2 => 8.0,
        _ => 4.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps until a sort pays when the given share is apart in each step.
    fn steps(grouping: &mut Grouping, apart: impl Fn(usize) -> usize) -> Option<usize> {
        (0..1000).find(|&step| {
            grouping.note(apart(step), 0, 100);
            grouping.is_worn(10.0)
        })
    }

    /// The same after the first sort, groups having held for so many steps before it.
    fn first_steps(held: usize, apart: impl Fn(usize) -> usize) -> Option<usize> {
        let mut grouping = Grouping::default();
        (0..held).for_each(|_| grouping.note(0, 0, 100));
        grouping.begin();
        steps(&mut grouping, apart)
    }

    #[test]
    fn sorting_pays_when_groups_fell_apart_that_held_long_enough() {
        assert_eq!(first_steps(0, |_| 0), None, "all hold");
        assert_eq!(
            first_steps(0, |_| 100),
            None,
            "never together, so sorting is no use"
        );
        assert_eq!(first_steps(0, |_| 40), None, "nothing changes");
        let after = |held: usize| move |step| if step < held { 0 } else { 100 };
        assert_eq!(first_steps(0, after(50)), Some(59));
        // held for one sort's worth of steps: eight sorts' worth apart
        assert_eq!(first_steps(0, after(10)), Some(89));
        assert_eq!(first_steps(20, after(10)), Some(29));
        assert_eq!(
            first_steps(0, |step| if step < 50 { 25 } else { 75 }),
            Some(69),
            "half of them"
        );
    }

    #[test]
    fn where_groups_never_hold_sorting_takes_an_ever_smaller_share() {
        // groups fall apart in the third step after each sort
        let mut grouping = Grouping::default();
        let mut last = 0;
        for _ in 0..8 {
            last = steps(&mut grouping, |step| if step < 3 { 0 } else { 100 }).unwrap_or(1000);
            grouping.begin();
        }
        // twice held (0.3 sorts' worth) is 0.6: 8 / 0.6² sorts' worth of ten steps
        assert!((220..=230).contains(&last), "{last}");
    }

    #[test]
    fn fours_alone_lose_half_as_much_as_groups_apart() {
        let mut grouping = Grouping::default();
        grouping.note(0, 0, 100);
        let mut other = grouping;
        grouping.note(30, 40, 100);
        other.note(50, 0, 100);
        assert_eq!(grouping.apart, other.apart);
    }
}
