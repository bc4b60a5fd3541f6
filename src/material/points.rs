//! The points of one body, as their law sees them: the only loops over points that a law needs, and one virtual call for
//! each block of points.

use super::{Kinematics, Material, Stress};
use crate::math::{Matrix, Sum, pack, packed_len, unpack};
use crate::reorder::permute_in_place;
use std::cell::UnsafeCell;
use std::ops::Range;

/// The Kirchhoff stresses of a block of points, Pa, to be carried over a step.
pub struct StressMut<'a> {
    /// Packed (see [`pack`]), D(D+1)/2 numbers a point.
    pub plane: &'a mut [f64],
    /// The hoop stress of each point; empty unless axisymmetric.
    pub hoop: &'a mut [f64],
}

/// How a block of points deforms over one step.
#[derive(Clone, Copy)]
pub struct Increments<'a, const D: usize> {
    /// Velocity gradients, 1/s.
    pub rates: &'a [Matrix<D>],
    /// Hoop rates, 1/s; empty unless axisymmetric.
    pub hoop_rates: &'a [f64],
    /// Hoop stretches after the step; empty unless axisymmetric.
    pub hoop_stretches: &'a [f64],
    /// Duration of the step, s.
    pub dt: f64,
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

    /// Elastic energy of the points in `range`, J, given their initial volumes, m³.
    fn energy(&self, range: Range<usize>, present: &Present<'_>, initial_volumes: &[f64]) -> f64;

    /// J of point `index`; `hoop_stretch` is 1 unless axisymmetric.
    fn volume_ratio(&self, index: usize, hoop_stretch: f64) -> f64;

    /// An upper estimate of the largest ρ₀ c² of the points in `range`, Pa, at least 0; NaN if one of them is.
    /// See [`Material::stiffness`].
    fn max_stiffness(&self, range: Range<usize>, present: &Present<'_>) -> f64;

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
    memory: Column<M::Memory>,
}

impl<const D: usize, M: Material<D>> Points<D, M> {
    /// `count` undeformed points.
    pub(super) fn new(material: M, count: usize) -> Self {
        let memory = Column::new(material.initial_memory(), count);
        Self { material, memory }
    }

    /// Memory, stress and hoop stretch of each point in `range`.
    fn present<'a>(
        &'a self,
        range: Range<usize>,
        present: &'a Present<'_>,
    ) -> impl Iterator<Item = (&'a M::Memory, Stress<D>, f64)> {
        let packed = present.stress.chunks_exact(packed_len(D));
        let points = self.memory.range(range).iter().zip(packed);
        points.enumerate().map(|(k, (memory, packed))| {
            let stress = Stress {
                plane: unpack(packed),
                transverse: present.hoop_stress.get(k).copied().unwrap_or(0.0),
            };
            let stretch = present.hoop_stretches.get(k).copied().unwrap_or(1.0);
            (memory, stress, stretch)
        })
    }
}

impl<const D: usize, M: Material<D>> MaterialPoints<D> for Points<D, M> {
    fn count(&self) -> usize {
        self.memory.0.len()
    }

    unsafe fn update(
        &self,
        range: Range<usize>,
        stress: StressMut<'_>,
        increments: &Increments<'_, D>,
    ) {
        debug_assert_eq!(stress.plane.len(), packed_len(D) * range.len());
        debug_assert_eq!(increments.rates.len(), range.len());
        // SAFETY: the caller keeps everybody else away from these points.
        let memory = unsafe { self.memory.range_mut(range) };
        let packed = stress.plane.chunks_exact_mut(packed_len(D));
        let points = memory.iter_mut().zip(packed).zip(increments.rates);
        let dt = increments.dt;
        if stress.hoop.is_empty() {
            for ((memory, packed), &rate) in points {
                let mut stress = Stress {
                    plane: unpack(packed),
                    transverse: 0.0,
                };
                let step = Kinematics {
                    rate,
                    hoop_rate: 0.0,
                    hoop_stretch: 1.0,
                    dt,
                };
                self.material.update_stress(memory, &mut stress, &step);
                pack(&stress.plane, packed);
            }
        } else {
            let hoops = stress.hoop.iter_mut().zip(increments.hoop_rates);
            let hoops = hoops.zip(increments.hoop_stretches);
            for (((memory, packed), &rate), ((hoop, &hoop_rate), &hoop_stretch)) in
                points.zip(hoops)
            {
                let mut stress = Stress {
                    plane: unpack(packed),
                    transverse: *hoop,
                };
                let step = Kinematics {
                    rate,
                    hoop_rate,
                    hoop_stretch,
                    dt,
                };
                self.material.update_stress(memory, &mut stress, &step);
                pack(&stress.plane, packed);
                *hoop = stress.transverse;
            }
        }
    }

    fn energy(&self, range: Range<usize>, present: &Present<'_>, initial_volumes: &[f64]) -> f64 {
        let points = self.present(range, present).zip(initial_volumes);
        let energies = points.map(|((memory, stress, stretch), volume)| {
            volume * self.material.energy(memory, &stress, stretch)
        });
        energies.collect::<Sum>().value()
    }

    fn volume_ratio(&self, index: usize, hoop_stretch: f64) -> f64 {
        self.material
            .volume_ratio(self.memory.get(index), hoop_stretch)
    }

    fn max_stiffness(&self, range: Range<usize>, present: &Present<'_>) -> f64 {
        let mut largest = 0.0_f64;
        for (memory, stress, stretch) in self.present(range, present) {
            let stiffness = self.material.stiffness(memory, &stress, stretch);
            if stiffness.is_nan() {
                return f64::NAN;
            }
            largest = largest.max(stiffness);
        }
        largest
    }

    fn reference_stiffness(&self) -> f64 {
        let memory = self.material.initial_memory();
        self.material.stiffness(&memory, &Stress::zero(), 1.0)
    }

    fn permute(&mut self, order: &[u32], leaders: &[u32]) {
        permute_in_place(self.memory.all_mut(), 1, order, leaders);
    }

    fn bytes_per_point(&self) -> usize {
        size_of::<M::Memory>()
    }

    fn memory_names(&self) -> Vec<String> {
        self.material.memory_names()
    }

    fn memory_values(&self, index: usize, values: &mut Vec<f64>) {
        self.material.memory_values(self.memory.get(index), values);
    }

    fn state_bits(&self, bits: &mut Vec<u64>) {
        for memory in self.memory.range(0..self.count()) {
            self.material.memory_bits(memory, bits);
        }
    }

    fn clone_box(&self) -> Box<dyn MaterialPoints<D>> {
        let memory = self.memory.range(0..self.count());
        let memory = memory
            .iter()
            .map(|&memory| UnsafeCell::new(memory))
            .collect();
        Box::new(Self {
            material: self.material.clone(),
            memory: Column(memory),
        })
    }
}

/// A column whose parts several threads may change at once, if they promise to keep apart.
///
/// The cells allow change through a shared reference; who changes what is settled by the one unsafe function,
/// [`Column::range_mut`], which only [`MaterialPoints::update`] calls and whose condition it hands on to its caller. All other
/// functions read, or have the column to themselves.
struct Column<T>(Vec<UnsafeCell<T>>);

// SAFETY: sharing a column lets threads read it (T: Sync) and, through `range_mut` alone, change it (T: Send); callers of
// `range_mut` promise that nobody else touches the rows that they change.
unsafe impl<T: Send + Sync> Sync for Column<T> {}

impl<T: Copy> Column<T> {
    fn new(value: T, count: usize) -> Self {
        Self((0..count).map(|_| UnsafeCell::new(value)).collect())
    }

    fn get(&self, index: usize) -> &T {
        &self.range(index..index + 1)[0]
    }

    fn range(&self, range: Range<usize>) -> &[T] {
        let cells: *const [UnsafeCell<T>] = &raw const self.0[range];
        // SAFETY: UnsafeCell<T> has the layout of T, and callers of `range_mut` keep readers of their rows away.
        unsafe { &*(cells as *const [T]) }
    }

    /// # Safety
    ///
    /// As long as the result lives, no other reference to one of its rows may be used or made.
    #[allow(clippy::mut_from_ref)] // that is what the cells are for
    unsafe fn range_mut(&self, range: Range<usize>) -> &mut [T] {
        let rows = &self.0[range];
        // SAFETY: UnsafeCell<T> has the layout of T and allows change behind a shared reference; nobody else uses these rows.
        unsafe { std::slice::from_raw_parts_mut(UnsafeCell::raw_get(rows.as_ptr()), rows.len()) }
    }

    fn all_mut(&mut self) -> &mut [T] {
        let count = self.0.len();
        // SAFETY: `&mut self` is the only reference there is.
        unsafe { self.range_mut(0..count) }
    }
}
