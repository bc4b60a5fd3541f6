//! The points of one body, as their law sees them: the only loops over points that a law needs, and one virtual call for
//! each block of points.

use super::update::update;
use super::{Material, Numbers, Stress, survey};
use crate::math::{Matrix, Sum, packed_len};
use crate::real::Instructions;
use crate::reorder::permute_in_place;
use crate::tensor::Tensor;
use std::cell::UnsafeCell;
use std::ops::Range;

/// The stresses of a block of points, Pa, to be carried over a step.
pub struct StressMut<'a> {
    /// Kirchhoff stresses, packed (see [`pack`](crate::math::pack)), D(D+1)/2 numbers a point.
    pub plane: &'a mut [f64],
    /// The hoop stress of each point; empty unless axisymmetric.
    pub hoop: &'a mut [f64],
    /// What points have besides in the total frame; empty in the updated one.
    pub reference: ReferenceMut<'a>,
}

/// What points of the total Lagrangian frame have for the grid, which lives in the reference configuration: D² numbers a point each,
/// column by column.
#[derive(Default)]
pub struct ReferenceMut<'a> {
    /// Deformation gradients F, to be carried over a step; may be empty if the law remembers them.
    pub deformation: &'a mut [f64],
    /// First Piola–Kirchhoff stresses P = τ F⁻ᵀ after the step, Pa: the internal work per initial volume is P : Ḟ = τ : Ḟ F⁻¹, so
    /// that f_i = −Σ V₀ P ∇₀N_i.
    pub first_piola: &'a mut [f64],
}

impl<'a> ReferenceMut<'a> {
    /// The first numbers of each column, and the others.
    pub(super) fn split_at(self, numbers: usize) -> (Self, Self) {
        let part = |column: &'a mut [f64]| {
            let numbers = numbers.min(column.len());
            column.split_at_mut(numbers)
        };
        let (deformation, other_deformation) = part(self.deformation);
        let (first_piola, other_first_piola) = part(self.first_piola);
        (
            Self {
                deformation,
                first_piola,
            },
            Self {
                deformation: other_deformation,
                first_piola: other_first_piola,
            },
        )
    }
}

/// The velocity gradients of four points, 1/s: lane q of number i of column a is ∂v_i/∂x_a of point q. Where fewer points are left,
/// the other lanes may hold anything.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct FourRates<const D: usize>(pub [[[f64; 4]; D]; D]);

impl<const D: usize> FourRates<D> {
    /// Numbers of four points.
    pub(crate) const COUNT: usize = 4 * D * D;

    /// The numbers of some points' gradients, [`Self::COUNT`] of each four.
    pub(crate) fn numbers(rates: &[Self]) -> &[f64] {
        // SAFETY: so many numbers without gaps
        unsafe { std::slice::from_raw_parts(rates.as_ptr().cast(), Self::COUNT * rates.len()) }
    }

    /// Gradients of points, and `others` in the lanes that are left.
    #[cfg(test)]
    pub(crate) fn of(points: &[Matrix<D>], others: f64) -> Vec<Self> {
        let fours = points.chunks(4).map(|points| {
            let mut four = [[[others; 4]; D]; D];
            for (q, gradient) in points.iter().enumerate() {
                for a in 0..D {
                    for i in 0..D {
                        four[a][i][q] = gradient[(i, a)];
                    }
                }
            }
            Self(four)
        });
        fours.collect()
    }

    /// The gradient of a point.
    #[cfg(test)]
    pub(crate) fn point(rates: &[Self], p: usize) -> Matrix<D> {
        Matrix::from_fn(|i, a| rates[p / 4].0[a][i][p % 4])
    }
}

/// How a block of points deforms over one step.
#[derive(Clone, Copy)]
pub struct Increments<'a, const D: usize> {
    /// Velocity gradients, 1/s: ∂v/∂x, or in the total frame Ḟ = ∂v/∂X.
    pub rates: &'a [FourRates<D>],
    /// Hoop rates, 1/s; empty unless axisymmetric.
    pub hoop_rates: &'a [f64],
    /// Hoop stretches after the step; empty unless axisymmetric.
    pub hoop_stretches: &'a [f64],
    /// Duration of the step, s.
    pub dt: f64,
    /// Which instructions to use, as far as the processor has them.
    pub instructions: Instructions,
}

/// What the solver keeps of a block of points.
#[derive(Clone, Copy)]
pub struct Present<'a> {
    /// Kirchhoff stress, packed, Pa.
    pub stress: &'a [f64],
    /// Hoop stress, Pa; empty unless axisymmetric.
    pub hoop_stress: &'a [f64],
    /// Hoop stretches; empty unless axisymmetric.
    pub hoop_stretches: &'a [f64],
}

/// Object-safe access to a law and the memory of its points.
///
/// Slices that come with a `range` hold exactly the points of that range, in order.
pub trait MaterialPoints<const D: usize>: Send + Sync {
    /// How many points there are.
    fn count(&self) -> usize;

    /// Carries stress and memory of the points in `range` over one step.
    ///
    /// # Safety
    ///
    /// While this runs, no other call that reads or writes the memory of a point in `range` may run: concurrent calls need
    /// ranges that do not overlap.
    unsafe fn update(
        &self,
        range: Range<usize>,
        stress: StressMut<'_>,
        increments: &Increments<'_, D>,
    );

    /// [`Self::update`] of one point after the other, the laws' functions being run for single numbers.
    ///
    /// # Safety
    ///
    /// As there.
    #[cfg(test)]
    unsafe fn update_singly(
        &self,
        range: Range<usize>,
        stress: StressMut<'_>,
        increments: &Increments<'_, D>,
    );

    /// Elastic energy of the points in `range`, J, given what the initial volume of each point is, m³.
    fn energy(
        &self,
        range: Range<usize>,
        present: &Present<'_>,
        initial_volume: &dyn Fn(usize) -> f64,
    ) -> f64;

    /// J of point `index`; `hoop_stretch` is 1 unless axisymmetric.
    fn volume_ratio(&self, index: usize, hoop_stretch: f64) -> f64;

    /// F of point `index`, if the law remembers it.
    fn deformation_gradient(&self, index: usize) -> Option<Matrix<D>>;

    /// Writes an upper estimate of ρ₀ c², Pa, of each point in `range`, see [`Material::stiffness`]; NaN where a point is turned
    /// inside out. The instructions are used as far as the processor has them.
    fn stiffness(
        &self,
        range: Range<usize>,
        present: &Present<'_>,
        instructions: Instructions,
        into: &mut [f64],
    );

    /// ρ₀ c² of the undeformed material, Pa.
    fn reference_stiffness(&self) -> f64;

    /// Puts the points into another order, see [`crate::reorder`].
    fn permute(&mut self, order: &[u32], leaders: &[u32]);

    /// What the law remembers of a point, bytes.
    fn bytes_per_point(&self) -> usize;

    /// What the numbers that [`Self::memory_values`] gives are called.
    fn memory_names(&self) -> Vec<String>;

    /// Appends what the law remembers of point `index`, for people to look at.
    fn memory_values(&self, index: usize, values: &mut Vec<f64>);

    /// Appends every bit that the law remembers, for comparing two states exactly.
    fn state_bits(&self, bits: &mut Vec<u64>);

    /// A copy.
    fn clone_box(&self) -> Box<dyn MaterialPoints<D>>;
}

impl<const D: usize> Clone for Box<dyn MaterialPoints<D>> {
    fn clone(&self) -> Self {
        self.clone_box()
    }
}

/// A law and the memory of its points.
pub(super) struct Points<const D: usize, M: Material<D>> {
    material: M,
    /// The numbers of each point's memory, point after point.
    memory: Column,
    count: usize,
}

impl<const D: usize, M: Material<D>> Points<D, M> {
    /// How many numbers the law remembers of a point.
    const WIDTH: usize = <M::Memory<f64> as Numbers<f64>>::COUNT;

    /// `count` undeformed points.
    pub(super) fn new(material: M, count: usize) -> Self {
        let mut initial = vec![0.0; Self::WIDTH];
        material.initial_memory().to_numbers(&mut initial);
        Self {
            material,
            memory: Column(
                initial
                    .iter()
                    .cycle()
                    .take(count * Self::WIDTH)
                    .map(|&x| UnsafeCell::new(x))
                    .collect(),
            ),
            count,
        }
    }

    /// What is remembered of one point.
    fn memory(&self, index: usize) -> M::Memory<f64> {
        let first = index * Self::WIDTH;
        M::Memory::from_numbers(self.memory.range(first..first + Self::WIDTH))
    }

    /// Memory, stress and hoop stretch of each point in `range`.
    fn present<'a>(
        &'a self,
        range: Range<usize>,
        present: &'a Present<'_>,
    ) -> impl Iterator<Item = (M::Memory<f64>, Stress<f64, D>, f64)> {
        let packed = present.stress.chunks_exact(packed_len(D));
        range.zip(packed).enumerate().map(|(k, (index, packed))| {
            let stress = Stress {
                plane: Tensor::from_packed(packed),
                transverse: present.hoop_stress.get(k).copied().unwrap_or(0.0),
            };
            let stretch = present.hoop_stretches.get(k).copied().unwrap_or(1.0);
            (self.memory(index), stress, stretch)
        })
    }
}

impl<const D: usize, M: Material<D>> MaterialPoints<D> for Points<D, M> {
    fn count(&self) -> usize {
        self.count
    }

    unsafe fn update(
        &self,
        range: Range<usize>,
        stress: StressMut<'_>,
        increments: &Increments<'_, D>,
    ) {
        let rows = range.start * Self::WIDTH..range.end * Self::WIDTH;
        // SAFETY: the caller keeps everybody else away from these points.
        let memory = unsafe { self.memory.range_mut(rows) };
        update(&self.material, memory, stress, increments);
    }

    #[cfg(test)]
    unsafe fn update_singly(
        &self,
        range: Range<usize>,
        stress: StressMut<'_>,
        increments: &Increments<'_, D>,
    ) {
        let rows = range.start * Self::WIDTH..range.end * Self::WIDTH;
        // SAFETY: as above.
        let memory = unsafe { self.memory.range_mut(rows) };
        let rows = super::update::Rows {
            memory,
            stress,
            increments: *increments,
        };
        super::update::every_group::<f64, D, M>(&self.material, rows);
    }

    fn energy(
        &self,
        range: Range<usize>,
        present: &Present<'_>,
        initial_volume: &dyn Fn(usize) -> f64,
    ) -> f64 {
        let points = range.clone().zip(self.present(range, present));
        let energies = points.map(|(index, (memory, stress, stretch))| {
            initial_volume(index) * self.material.energy(&memory, &stress, stretch)
        });
        energies.collect::<Sum>().value()
    }

    fn volume_ratio(&self, index: usize, hoop_stretch: f64) -> f64 {
        self.material
            .volume_ratio(&self.memory(index), hoop_stretch)
    }

    fn deformation_gradient(&self, index: usize) -> Option<Matrix<D>> {
        let f = self.material.deformation_gradient(&self.memory(index))?;
        Some(Matrix::from_fn(|i, j| f[(i, j)]))
    }

    fn stiffness(
        &self,
        range: Range<usize>,
        present: &Present<'_>,
        instructions: Instructions,
        into: &mut [f64],
    ) {
        let rows = range.start * Self::WIDTH..range.end * Self::WIDTH;
        let memory = self.memory.range(rows);
        survey::stiffness(&self.material, memory, present, instructions, into);
    }

    fn reference_stiffness(&self) -> f64 {
        let memory = self.material.initial_memory();
        self.material.stiffness(&memory, &Stress::zero(), 1.0)
    }

    fn permute(&mut self, order: &[u32], leaders: &[u32]) {
        permute_in_place(self.memory.all_mut(), Self::WIDTH, order, leaders);
    }

    fn bytes_per_point(&self) -> usize {
        Self::WIDTH * size_of::<f64>()
    }

    fn memory_names(&self) -> Vec<String> {
        self.material.memory_names()
    }

    fn memory_values(&self, index: usize, values: &mut Vec<f64>) {
        self.material.memory_values(&self.memory(index), values);
    }

    fn state_bits(&self, bits: &mut Vec<u64>) {
        bits.extend(self.memory.all().iter().map(|x| x.to_bits()));
    }

    fn clone_box(&self) -> Box<dyn MaterialPoints<D>> {
        Box::new(Self {
            material: self.material.clone(),
            memory: Column::new(self.memory.all()),
            count: self.count,
        })
    }
}

/// A column of numbers whose parts several threads may change at once, if they promise to keep apart.
///
/// The cells allow change through a shared reference; who changes what is settled by the one unsafe function,
/// [`Column::range_mut`], which only [`MaterialPoints::update`] calls and whose condition it hands on to its caller. All other
/// functions read, or have the column to themselves.
struct Column(Vec<UnsafeCell<f64>>);

// SAFETY: sharing a column lets threads read it and, through `range_mut` alone, change it; callers of `range_mut` promise that
// nobody else touches the rows that they change.
unsafe impl Sync for Column {}

impl Column {
    fn new(numbers: &[f64]) -> Self {
        Self(numbers.iter().map(|&x| UnsafeCell::new(x)).collect())
    }

    fn range(&self, range: Range<usize>) -> &[f64] {
        let cells: *const [UnsafeCell<f64>] = &raw const self.0[range];
        // SAFETY: UnsafeCell<f64> has the layout of f64, and callers of `range_mut` keep readers of their rows away.
        unsafe { &*(cells as *const [f64]) }
    }

    fn all(&self) -> &[f64] {
        self.range(0..self.0.len())
    }

    /// # Safety
    ///
    /// As long as the result lives, no other reference to one of its rows may be used or made.
    #[allow(clippy::mut_from_ref)] // that is what the cells are for
    unsafe fn range_mut(&self, range: Range<usize>) -> &mut [f64] {
        let rows = &self.0[range];
        // SAFETY: UnsafeCell<f64> has the layout of f64 and allows change behind a shared reference; nobody else uses these
        // rows.
        unsafe { std::slice::from_raw_parts_mut(UnsafeCell::raw_get(rows.as_ptr()), rows.len()) }
    }

    fn all_mut(&mut self) -> &mut [f64] {
        let count = self.0.len();
        // SAFETY: `&mut self` is the only reference there is.
        unsafe { self.range_mut(0..count) }
    }
}
