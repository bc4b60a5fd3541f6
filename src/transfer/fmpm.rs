//! Full mass matrix: PIC with an approximate inverse of the full mass matrix in place of that of the lumped one.

use super::{Method, Pic};
use crate::input::{Parameters, Reader};

/// Most terms: a step with that many costs twenty of PIC.
const MOST: i64 = 20;

/// v = Σ N_i v_i, with v_i = Σ_{j<order} (I − S⁺S)^j p_i/m_i (see [`Method::terms`]).
///
/// The lumped masses times S⁺S are the full mass matrix M_ij = Σ_p m_p N_i N_j, so that with ever more terms v comes to M⁻¹ p (derived here;
/// eigenvalues of S⁺S lie between 0 and 1): points lose only what no velocities of the grid can give them.
///
/// Source: J. A. Nairn, nairn-mpm-fea, `XPICExtrapolationTask.cpp` and `MatVelocityField.cpp`, which build velocities up from
/// Δv(k) = (I − S⁺S) Δv(k−1), where Δv(1) is the lumped velocity and nodes that are held get nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fmpm {
    /// Terms of the sum; 1 is PIC.
    pub order: u32,
}

impl Parameters for Fmpm {
    fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let order = reader.integer_or("order", 1, MOST, 3)?;
        Some(Self {
            order: order as u32,
        })
    }
}

impl Method for Fmpm {
    type Point = Pic;

    fn point(&self) -> Pic {
        Pic
    }

    fn terms(&self) -> u32 {
        self.order
    }
}
