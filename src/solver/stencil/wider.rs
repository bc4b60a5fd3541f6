//! More points at once than four, where registers are wide enough.

use super::group::{Fours, Group, Needs, Rows, start_together};
use super::same::Gifts;
use super::{Columns, Pass, Tile};
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

    /// Takes the next rows, if there are as many as go into this group and they have the same nodes: `group` has their stencils then, and
    /// here are their places, m. Points that need the nodes of the `middle` of their cells as well are left alone.
    ///
    /// # Safety
    /// No other thread writes to these rows meanwhile.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub(super) unsafe fn take<B: Basis<N>, T: Transfer>(
        &mut self,
        fours: &mut Fours,
        pass: &Pass<D, B, T>,
        columns: &Columns<D>,
        tile: &Tile<D>,
        needs: Needs,
        middle: bool,
    ) -> Option<(Rows, [E; D])> {
        if !Self::USED || middle {
            return None;
        }
        let rows = fours.ahead(E::LANES)?;
        // SAFETY: as the caller says
        let place = unsafe { columns.places::<E>(rows.first, E::LANES) };
        // most that fail do so along the first axis
        if !start_together(pass, &place) {
            return None;
        }
        self.group.set(pass, tile, &place, needs);
        if !self.group.same {
            return None;
        }
        fours.drop_first(E::LANES);
        Some((rows, place))
    }
}
