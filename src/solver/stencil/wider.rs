//! More points at once than four, where registers are wide enough.

use super::group::{Fours, Group, Needs, Rows, start_together};
use super::same::Gifts;
use super::{Pass, Tile};
use crate::basis::Basis;
use crate::solver::lane::Points;
use crate::transfer::Transfer;

/// A group of as many points as `E` has lanes, for those groups of a block that have the same nodes. In 3D alone: two points an axis
/// are eight a cell there. In 2D they are four.
pub(super) struct Wider<E, const D: usize, const N: usize> {
    pub group: Group<E, D, N>,
    pub gifts: Gifts<E, D, N>,
}

impl<E: Points, const D: usize, const N: usize> Wider<E, D, N> {
    /// Whether there is such a group at all.
    const USED: bool = D == 3 && E::LANES > 4;

    /// No points yet.
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            group: Group::new(),
            gifts: Gifts::none(),
        }
    }

    /// The next rows, if there are as many as go into this group and they do not need the nodes of the middle of their cells as well.
    #[inline(always)]
    pub(super) fn ahead(&self, fours: &Fours, middle: bool) -> Option<Rows> {
        if Self::USED && !middle {
            fours.ahead(E::LANES)
        } else {
            None
        }
    }

    /// The stencils of points at the given places, m, if they have the same nodes.
    #[inline(always)]
    pub(super) fn set<B: Basis<N>, T: Transfer>(
        &mut self,
        pass: &Pass<D, B, T>,
        tile: &Tile<D>,
        place: &[E; D],
        needs: Needs,
    ) -> bool {
        // most that fail do so along the first axis
        if !start_together(pass, place) {
            return false;
        }
        self.group.set(pass, tile, place, needs);
        self.group.same
    }
}
