//! What a simulation is at one instant: bodies made of material points.

use crate::material::{MaterialPoints, Present};
use crate::math::{Matrix, Vector, packed_len};
use crate::reorder;
use std::ops::Index;

/// The columns that every material point of a body has. Columns that a scene does not need stay empty.
#[derive(Clone, Debug, Default)]
pub struct Particles<const D: usize> {
    /// x, m.
    pub position: Vec<Vector<D>>,
    /// X, the position in the reference configuration, m, where the shape functions of the total Lagrangian frame are taken;
    /// empty in the updated frame.
    pub reference_position: Vec<Vector<D>>,
    /// v, m/s.
    pub velocity: Vec<Vector<D>>,
    /// m, kg, and with it V₀.
    pub mass: Masses,
    /// Kirchhoff stress τ = J σ, Pa, packed: `D (D + 1) / 2` numbers a point.
    pub stress: Vec<f64>,
    /// Deformation gradient F = ∂x/∂X in the modelled directions: in the total frame if the law does not remember it or the basis
    /// needs it, in the updated frame if points have domains that deform with them; else empty.
    pub deformation_gradient: Vec<Matrix<D>>,
    /// First Piola–Kirchhoff stress P = τ F⁻ᵀ in the modelled directions, Pa; empty in the updated frame.
    pub first_piola_stress: Vec<Matrix<D>>,
    /// APIC's affine velocity field C, 1/s; empty for other transfers.
    pub affine: Vec<Matrix<D>>,
    /// Kirchhoff hoop stress, Pa; empty unless axisymmetric.
    pub hoop_stress: Vec<f64>,
    /// Hoop stretch; empty unless axisymmetric.
    pub hoop_stretch: Vec<f64>,
    /// The number that the point got when its body was filled. Rows are re-sorted for speed as a run goes; this is not.
    pub id: Vec<u32>,
}

impl<const D: usize> Particles<D> {
    /// How many points there are.
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }

    /// Whether the shape functions are those of the reference configuration.
    pub fn is_total(&self) -> bool {
        !self.reference_position.is_empty()
    }

    /// Where the points stand in the grid, m: X in the total Lagrangian frame, x in the updated one.
    pub fn grid_position(&self) -> &[Vector<D>] {
        if self.is_total() {
            &self.reference_position
        } else {
            &self.position
        }
    }

    /// Hoop stretch of point `p`, 1 unless axisymmetric.
    pub fn hoop_stretch(&self, p: usize) -> f64 {
        self.hoop_stretch.get(p).copied().unwrap_or(1.0)
    }

    /// The present row of the point with number `id`.
    pub fn row_of(&self, id: u32) -> Option<usize> {
        self.id.iter().position(|&other| other == id)
    }

    /// What laws see of all points.
    pub fn present(&self) -> Present<'_> {
        Present {
            stress: &self.stress,
            hoop_stress: &self.hoop_stress,
            hoop_stretches: &self.hoop_stretch,
        }
    }

    /// Memory of one point's columns, bytes.
    pub fn bytes_per_point(&self) -> usize {
        if self.is_empty() {
            return 0;
        }
        let numbers = |column: usize| 8 * column / self.len();
        size_of::<Vector<D>>() * 2
            + self.mass.bytes_per_point()
            + 4
            + numbers(self.stress.len())
            + size_of::<Matrix<D>>() * usize::from(!self.affine.is_empty())
            + (size_of::<Vector<D>>() + size_of::<Matrix<D>>()) * usize::from(self.is_total())
            + size_of::<Matrix<D>>() * usize::from(!self.deformation_gradient.is_empty())
            + numbers(self.hoop_stress.len())
            + numbers(self.hoop_stretch.len())
    }

    /// Whether every column has one entry for each of `count` points, or none where the scene may do without.
    pub fn are_whole(&self, count: usize, affine: bool) -> bool {
        let hoops = if self.hoop_stretch.is_empty() {
            0
        } else {
            count
        };
        let total = if self.is_total() { count } else { 0 };
        self.position.len() == count
            && self.velocity.len() == count
            && self.mass.len() == count
            && self.stress.len() == packed_len(D) * count
            && self.reference_position.len() == total
            && (self.deformation_gradient.is_empty() || self.deformation_gradient.len() == count)
            && self.first_piola_stress.len() == total
            && self.affine.len() == if affine { count } else { 0 }
            && self.hoop_stress.len() == hoops
            && self.hoop_stretch.len() == hoops
            && self.id.len() == count
    }

    /// Puts all columns into another order, see [`reorder::cycles`].
    pub fn permute(&mut self, order: &[u32], leaders: &[u32], parallel: bool) {
        let Self {
            position,
            reference_position,
            velocity,
            mass,
            stress,
            deformation_gradient,
            first_piola_stress,
            affine,
            hoop_stress,
            hoop_stretch,
            id,
        } = self;
        let mut motion = || {
            reorder::permute_in_place(position, 1, order, leaders);
            reorder::permute_in_place(velocity, 1, order, leaders);
        };
        let mut rest = || {
            mass.permute(order, leaders);
            reorder::permute_in_place(id, 1, order, leaders);
        };
        let mut stresses = || {
            reorder::permute_in_place(stress, packed_len(D), order, leaders);
            if !hoop_stress.is_empty() {
                reorder::permute_in_place(hoop_stress, 1, order, leaders);
                reorder::permute_in_place(hoop_stretch, 1, order, leaders);
            }
            if !reference_position.is_empty() {
                reorder::permute_in_place(reference_position, 1, order, leaders);
                reorder::permute_in_place(first_piola_stress, 1, order, leaders);
            }
            if !deformation_gradient.is_empty() {
                reorder::permute_in_place(deformation_gradient, 1, order, leaders);
            }
        };
        let mut affines = || {
            if !affine.is_empty() {
                reorder::permute_in_place(affine, 1, order, leaders);
            }
        };
        // each of the four moves about as many bytes, but in the total frame, which sorts once; a join allocates nothing
        if parallel {
            rayon::join(
                || rayon::join(motion, rest),
                || rayon::join(stresses, affines),
            );
        } else {
            motion();
            rest();
            stresses();
            affines();
        }
    }
}

/// Masses m of a body's points, kg, and with them their initial volumes V₀ = m / ρ₀, m³ (2D: for a thickness of 1 m, or the full
/// ring of an axisymmetric scene; 1D: for a section of 1 m²).
///
/// Points that all have the same mass, as they have unless they are rings, share one number.
#[derive(Clone, Debug, Default)]
pub struct Masses {
    /// One number for all points, or one a point.
    numbers: Vec<f64>,
    count: usize,
    density: f64,
}

impl Masses {
    /// Masses of `count` points of a body with this initial density, kg/m³, given their initial volumes, m³.
    pub fn of_volumes(density: f64, count: usize, volume: impl Fn(usize) -> f64) -> Self {
        let same = (1..count).all(|p| volume(p) == volume(0));
        let stored = if same { count.min(1) } else { count };
        Self {
            numbers: (0..stored).map(|p| density * volume(p)).collect(),
            count,
            density,
        }
    }

    /// Of how many points.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether all points share one number.
    pub fn are_same(&self) -> bool {
        self.numbers.len() < self.count
    }

    /// ρ₀, kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// V₀ of point `p`, m³.
    pub fn initial_volume(&self, p: usize) -> f64 {
        self[p] / self.density
    }

    /// The numbers: one for all points if [they are the same](Self::are_same), else one a point.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// Memory of one point's mass, bytes.
    pub fn bytes_per_point(&self) -> usize {
        if self.are_same() { 0 } else { size_of::<f64>() }
    }

    fn permute(&mut self, order: &[u32], leaders: &[u32]) {
        if !self.are_same() {
            reorder::permute_in_place(&mut self.numbers, 1, order, leaders);
        }
    }
}

impl Index<usize> for Masses {
    type Output = f64;

    fn index(&self, p: usize) -> &f64 {
        &self.numbers[if self.are_same() { 0 } else { p }]
    }
}

/// One deforming thing.
pub struct Body<const D: usize> {
    /// Its name in the scenario.
    pub name: String,
    /// Its points.
    pub particles: Particles<D>,
    /// Their law, and what they remember for it.
    pub material: Box<dyn MaterialPoints<D>>,
    /// Distance between neighbouring points at the start, m, one number an axis.
    pub spacing: Vector<D>,
}

impl<const D: usize> Body<D> {
    /// F of the point in row `p` of a body in the total frame, which keeps it unless the law remembers it.
    ///
    /// # Panics
    /// If neither does.
    pub fn deformation_gradient(&self, p: usize) -> Matrix<D> {
        let kept = self.particles.deformation_gradient.get(p).copied();
        kept.or_else(|| self.material.deformation_gradient(p))
            .expect("F is remembered by the law or kept beside it")
    }

    /// The Cauchy stress of point `p`, Pa, in the modelled directions.
    pub fn cauchy_stress(&self, p: usize) -> Matrix<D> {
        let width = packed_len(D);
        let j = self
            .material
            .volume_ratio(p, self.particles.hoop_stretch(p));
        crate::math::unpack(&self.particles.stress[p * width..(p + 1) * width]) / j
    }
}

/// Everything at one instant.
pub struct State<const D: usize> {
    /// t, s.
    pub time: f64,
    /// Steps taken.
    pub step: u64,
    /// The bodies, in scenario order.
    pub bodies: Vec<Body<D>>,
}

impl<const D: usize> State<D> {
    /// How many points all bodies have together.
    pub fn point_count(&self) -> usize {
        self.bodies.iter().map(|body| body.particles.len()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_equal_mass_share_one_number() {
        let mut same = Masses::of_volumes(4.0, 3, |_| 0.25);
        assert!(same.are_same() && same.len() == 3 && same.bytes_per_point() == 0);
        same.permute(&[0, 1, 2], &[0]);
        for p in 0..3 {
            assert_eq!((same[p], same.initial_volume(p)), (1.0, 0.25));
        }
    }

    #[test]
    fn rings_keep_their_own_masses_wherever_they_are_sorted() {
        let mut rings = Masses::of_volumes(2.0, 3, |p| 1.0 + p as f64);
        assert!(!rings.are_same() && rings.bytes_per_point() == 8);
        // row 0 goes to place 1, that to 2, that to 0
        let (mut order, mut leaders) = (Vec::new(), Vec::new());
        reorder::cycles(&mut [1, 2, 0], &mut order, &mut leaders);
        rings.permute(&order, &leaders);
        assert_eq!(rings.numbers(), [6.0, 2.0, 4.0]);
        assert_eq!([0, 1, 2].map(|p| rings.initial_volume(p)), [3.0, 1.0, 2.0]);
    }
}
