//! Where in the cells of the grid the points of a body lie before the first step.
//!
//! Points that stay in their cells, as those of the total Lagrangian frame do, are places at which a cell's strains are looked up. How
//! stiff a cell is in bending follows from their second moment about its middle: let it be m h²/12 on each axis, where m = 1 would
//! be that of the cell itself. p points in even distances have m = 1 − 1/p².
//!
//! A beam of height H along the axes of the grid, bent by κ, stretches by κ y along itself. Between layers of points its modulus E′ (plane
//! strain: E/(1 − ν²)) meets the second moment H³/12 short by (1 − m)(h/H)², and it is too soft by as much. Hat functions cannot bend: in
//! each of their cells the shear κ x and the missing strain across it keep only their means, and the beam is too stiff by m (h/H)² times
//!
//! c = G/E′ + M/E′ − 1,
//!
//! M being the modulus if strains across are held. With m = 1/(1 + c) the two cancel, whatever the cells and the number of points: hat functions bend
//! as softly as the body. Functions that can bend have c = 0, and m = 1 is that of Gauss points. (Derived here; `mpm validate beam` holds it.)
//!
//! With Lamé's constants, G = μ; plane strain (and 3D, where a wide plate bends like that and a narrow beam nearly so):
//! E′ = 4μ(λ + μ)/M, M = λ + 2μ, so that c = (1 − ν)/2 + ν²/(1 − 2ν); plane stress: E′ = E, M = E/(1 − ν²), c = 1/(2 (1 + ν)) + ν²/(1 − ν²).

use super::MaterialSpec;
use crate::basis::BasisChoice;
use crate::material::Plane;

/// The largest c that points are drawn together for. Beyond it (ν > 0.39 in plane strain) hat functions lock, and few layers of points
/// cannot help it.
const MOST: f64 = 1.0;
/// Poisson's ratio from which on splines with points drawn apart hold volumes too well, which is worse than what they would gain: at 0.45
/// the clamped beam of `cantilever_shear` on 4 quadratic cells errs by −0.9 % in place of +1.5, at 0.499 by −3.6 % in place of −1.4.
const SPLINES_LOCK: f64 = 0.47;
/// c of a law that has no Poisson's ratio: that of ν = 0 and of ν = 1/4.
const USUAL: f64 = 0.5;

/// Where in their cells points lie before the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Placement {
    /// `even`: in equal distances.
    #[default]
    Even,
    /// `bending`: with the second moment that bends a cell as softly as its material, in boxes that fill whole cells.
    Bending,
}

impl Placement {
    /// All names.
    pub const NAMES: [&'static str; 2] = ["even", "bending"];

    /// Its name in a scenario.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Even => Self::NAMES[0],
            Self::Bending => Self::NAMES[1],
        }
    }
}

/// The second moment of a cell's points that cancels its errors in bending, in parts of that of the cell; none where nothing
/// bends (1D), for changes of volume at the middle of the cell, whose c is another, and for splines near incompressibility.
pub fn bending_moment(
    basis: &BasisChoice,
    material: &MaterialSpec,
    dimension: usize,
    plane: Plane,
) -> Option<f64> {
    if dimension == 1 || basis.dilation_at_centre() {
        return None;
    }
    if basis.bends() {
        let locks = material.poissons_ratio.is_some_and(|nu| nu >= SPLINES_LOCK);
        return (!locks).then_some(1.0);
    }
    let excess = material.poissons_ratio.map_or(USUAL, |nu| match plane {
        Plane::Stress => 0.5 / (1.0 + nu) + nu * nu / (1.0 - nu * nu),
        Plane::Strain | Plane::Axisymmetric => 0.5 * (1.0 - nu) + nu * nu / (1.0 - 2.0 * nu),
    });
    Some(1.0 / (1.0 + excess.min(MOST)))
}
