//! Four or eight numbers at once: with wide instructions where the processor has them, one after the other where not.

use crate::real::{MOST_LANES, Portable, Real};

/// Something to be done with numbers of several points.
pub trait Task {
    /// Does it. Mark it `#[inline(always)]`.
    fn run(self);
}

/// The same number of several points, which are computed together.
///
/// In memory points stand one after the other, `D` numbers each; in lanes the same number of all points stands together.
pub trait Points: Real {
    /// Lanes of four, into which these fall apart.
    type Four: Lane;
    /// Numbers `4 h .. 4 h + 4`.
    fn four(self, h: usize) -> Self::Four;
    /// The same numbers, which the compiler is not to join with others to longer vectors. Where they are in one register nothing is
    /// done; else they go through memory. LLVM 22 takes the numbers of such vectors in the wrong order now and then.
    #[inline(always)]
    fn on_its_own(self) -> Self {
        self
    }
    /// Does something in a function of its own, which is compiled for these numbers: what is rare is not to make what is common slower.
    fn apart(task: impl Task);
    /// Whether all lie in `low ..= high`; false if one is not a number.
    fn all_within(self, low: f64, high: f64) -> bool;
    /// Writes whole numbers, not negative, one for each lane.
    fn whole(self, to: &mut [u32; MOST_LANES]);
    /// Reads points of `D` numbers each, one after the other: lane a has number a of each.
    ///
    /// # Safety
    /// `from` points to `D` readable numbers for each lane.
    unsafe fn load_points<const D: usize>(from: *const f64) -> [Self; D];
    /// Writes what [`Self::load_points`] reads.
    ///
    /// # Safety
    /// `to` points to `D` writable numbers for each lane.
    unsafe fn store_points<const D: usize>(points: &[Self; D], to: *mut f64);
    /// Reads `count` numbers, at least one and at most one for each lane; the others are zero.
    ///
    /// # Safety
    /// `from` points to `count` readable numbers.
    unsafe fn load_some(from: *const f64, count: usize) -> Self;
    /// Adds to each number of a node what all points give to it, first the sum of four points, then that of the next.
    ///
    /// # Safety
    /// `node` points to four readable and writable numbers, aligned to 32 bytes.
    unsafe fn add_sums(given: [Self; 4], node: *mut f64);
}

/// Four `f64` that are added and multiplied together: the same number of four points, or the numbers of one node.
pub trait Lane: Points<Four = Self> {
    /// From an array.
    fn new(x: [f64; 4]) -> Self;
    /// To an array.
    fn array(self) -> [f64; 4];
    /// Number `I` four times.
    fn broadcast<const I: usize>(self) -> Self;
    /// Reads four numbers.
    ///
    /// # Safety
    /// `from` points to four readable numbers, aligned to 32 bytes.
    unsafe fn load(from: *const f64) -> Self;
    /// Writes four numbers.
    ///
    /// # Safety
    /// `to` points to four writable numbers, aligned to 32 bytes.
    unsafe fn store(self, to: *mut f64);
    /// Reads `D` numbers; the others are zero.
    ///
    /// # Safety
    /// `from` points to `D` readable numbers.
    unsafe fn load_point<const D: usize>(from: *const f64) -> Self;
    /// Writes a `D` × `D` matrix, whose columns are the first `D` numbers of each lane.
    ///
    /// # Safety
    /// `to` points to `D²` writable numbers.
    unsafe fn store_matrix<const D: usize>(columns: &[Self; D], to: *mut f64);
    /// Lane a has number a of each of the four.
    fn turn<const D: usize>(points: &[Self; 4]) -> [Self; D];
    /// Reads two numbers at each of four addresses: lane a has number a of each.
    ///
    /// # Safety
    /// Each address leads to two readable numbers, aligned to 16 bytes.
    unsafe fn load_pairs(from: [*const f64; 4]) -> [Self; 2];
    /// Writes what [`Self::load_pairs`] reads.
    ///
    /// # Safety
    /// Each address leads to two writable numbers, aligned to 16 bytes.
    unsafe fn store_pairs(pairs: [Self; 2], to: [*mut f64; 4]);
    /// Adds the pairs to what there is, one after the other: addresses may be the same.
    ///
    /// # Safety
    /// As for [`Self::store_pairs`].
    unsafe fn add_pairs(pairs: [Self; 2], to: [*mut f64; 4]);
    /// The columns of a symmetric matrix that is stored row by row from the diagonal on; what follows the first `D` numbers of a
    /// column may be anything that the matrix holds.
    ///
    /// # Safety
    /// `from` points to `D (D + 1) / 2` readable numbers.
    unsafe fn load_symmetric<const D: usize>(from: *const f64) -> [Self; D];
}

impl Points for Portable {
    type Four = Self;

    #[inline(always)]
    fn four(self, _: usize) -> Self {
        self
    }
    #[inline(always)]
    fn on_its_own(self) -> Self {
        std::hint::black_box(self)
    }
    #[cold]
    #[inline(never)]
    fn apart(task: impl Task) {
        task.run();
    }
    #[inline(always)]
    fn all_within(self, low: f64, high: f64) -> bool {
        self.0.iter().all(|&x| x >= low && x <= high)
    }
    #[inline(always)]
    fn whole(self, to: &mut [u32; MOST_LANES]) {
        for k in 0..4 {
            to[k] = self.0[k] as u32;
        }
    }
    #[inline(always)]
    unsafe fn load_points<const D: usize>(from: *const f64) -> [Self; D] {
        // SAFETY: the caller vouches for 4 D numbers
        std::array::from_fn(|a| Self(std::array::from_fn(|q| unsafe { *from.add(q * D + a) })))
    }
    #[inline(always)]
    unsafe fn store_points<const D: usize>(points: &[Self; D], to: *mut f64) {
        for a in 0..D {
            for q in 0..4 {
                // SAFETY: the caller vouches for 4 D numbers
                unsafe { *to.add(q * D + a) = points[a].0[q] };
            }
        }
    }
    #[inline(always)]
    unsafe fn load_some(from: *const f64, count: usize) -> Self {
        // SAFETY: the caller vouches for `count` numbers
        Self(std::array::from_fn(|q| {
            if q < count {
                unsafe { *from.add(q) }
            } else {
                0.0
            }
        }))
    }
    #[inline(always)]
    unsafe fn add_sums(given: [Self; 4], node: *mut f64) {
        let sums = Self(given.map(|Self(x)| (x[0] + x[1]) + (x[2] + x[3])));
        // SAFETY: the caller vouches for four numbers
        unsafe { (Self::load(node) + sums).store(node) }
    }
}

impl Lane for Portable {
    #[inline(always)]
    fn new(x: [f64; 4]) -> Self {
        Self(x)
    }
    #[inline(always)]
    fn array(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    fn broadcast<const I: usize>(self) -> Self {
        Self([self.0[I]; 4])
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        // SAFETY: the caller vouches for four readable, aligned numbers
        Self(unsafe { *from.cast() })
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        // SAFETY: the caller vouches for four writable, aligned numbers
        unsafe { *to.cast() = self.0 }
    }
    #[inline(always)]
    unsafe fn load_point<const D: usize>(from: *const f64) -> Self {
        let mut x = [0.0; 4];
        for a in 0..D {
            // SAFETY: the caller vouches for D numbers
            x[a] = unsafe { *from.add(a) };
        }
        Self(x)
    }
    #[inline(always)]
    unsafe fn store_matrix<const D: usize>(columns: &[Self; D], to: *mut f64) {
        for a in 0..D {
            for b in 0..D {
                // SAFETY: the caller vouches for D² numbers
                unsafe { *to.add(a * D + b) = columns[a].0[b] };
            }
        }
    }
    #[inline(always)]
    fn turn<const D: usize>(points: &[Self; 4]) -> [Self; D] {
        std::array::from_fn(|a| Self(std::array::from_fn(|q| points[q].0[a])))
    }
    #[inline(always)]
    unsafe fn load_pairs(from: [*const f64; 4]) -> [Self; 2] {
        // SAFETY: the caller vouches for two numbers at each address
        std::array::from_fn(|a| Self(from.map(|pair| unsafe { *pair.add(a) })))
    }
    #[inline(always)]
    unsafe fn store_pairs(pairs: [Self; 2], to: [*mut f64; 4]) {
        for q in 0..4 {
            for a in 0..2 {
                // SAFETY: the caller vouches for two numbers at each address
                unsafe { *to[q].add(a) = pairs[a].0[q] };
            }
        }
    }
    #[inline(always)]
    unsafe fn add_pairs(pairs: [Self; 2], to: [*mut f64; 4]) {
        for q in 0..4 {
            for a in 0..2 {
                // SAFETY: the caller vouches for two numbers at each address
                unsafe { *to[q].add(a) += pairs[a].0[q] };
            }
        }
    }
    #[inline(always)]
    unsafe fn load_symmetric<const D: usize>(from: *const f64) -> [Self; D] {
        let mut columns = [Self([0.0; 4]); D];
        let mut at = 0;
        for i in 0..D {
            for j in i..D {
                // SAFETY: the caller vouches for D (D + 1) / 2 numbers
                let x = unsafe { *from.add(at) };
                columns[i].0[j] = x;
                columns[j].0[i] = x;
                at += 1;
            }
        }
        columns
    }
}

#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx512;

#[cfg(test)]
mod tests;
