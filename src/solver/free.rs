//! Nodes on which nothing but gravity and the points act, which are nearly all: a few wide operations each.

use super::lane::Lane;
use super::ledger::GridSums;
use crate::grid::Node;
use crate::math::Vector;
use crate::real::Portable;

/// What takes the place of the mass once a node has a velocity; a node without mass has none, and points must not take its
/// zero for one.
pub const PRESENT: f64 = 1.0;

/// Below this mass a node's velocity cannot be computed; no point comes near it.
pub const NO_MASS: f64 = 1e-290;

/// Sums over nodes on which nothing but gravity and the points act: for each component, or in 1D for every fourth node.
pub struct FreeSums<L> {
    /// Σ ½ m v∘v at the start of the step.
    arrived: L,
    /// The same at its end.
    left: L,
    /// Σ f ∘ (v + v'), twice the power of internal forces.
    internal: L,
    /// Σ m (v + v') / 2.
    momentum: L,
}

impl<L: Lane> FreeSums<L> {
    #[inline(always)]
    /// Nothing yet.
    #[allow(clippy::new_without_default)] // inlined into what is compiled for wide instructions
    pub fn new() -> Self {
        let zero = L::splat(0.0);
        Self {
            arrived: zero,
            left: zero,
            internal: zero,
            momentum: zero,
        }
    }
}

/// What acts on the nodes.
pub struct Free<const D: usize> {
    /// Acceleration of gravity, m/s².
    pub gravity: Vector<D>,
    /// Δt, s.
    pub dt: f64,
}

impl<const D: usize> Free<D> {
    /// Turns momenta and forces into velocities at the end of the step and their changes: all components of a node together, the mass
    /// among them as if it were one, or in 1D four nodes together.
    #[inline(always)]
    pub fn nodes<L: Lane>(&self, main: &mut [Node], change: &mut [Node], sums: &mut FreeSums<L>) {
        let split = !change.is_empty();
        if D == 1 {
            let gravity = L::splat(self.gravity[0]);
            let mut spare = [Node::default(); 2];
            let [spare, spare_change] = &mut spare;
            let (fours, left) = main.as_chunks_mut::<4>();
            let (changes, changes_left) = change.as_chunks_mut::<4>();
            // two loops: in one the addresses of nodes that may not be there go through memory
            if split {
                for (nodes, changes) in fours.iter_mut().zip(changes) {
                    // SAFETY: these are nodes
                    unsafe { self.four::<L>(four(nodes), Some(four(changes)), gravity, sums) };
                }
            } else {
                for nodes in fours {
                    // SAFETY: as above
                    unsafe { self.four::<L>(four(nodes), None, gravity, sums) };
                }
            }
            if !left.is_empty() {
                let nodes = filled_up(left, spare);
                let changes = split.then_some(filled_up(changes_left, spare_change));
                // SAFETY: as above
                unsafe { self.four::<L>(nodes, changes, gravity, sums) };
            }
            return;
        }
        let mut gravity = [0.0; 4];
        gravity[..D].copy_from_slice(self.gravity.as_slice());
        let gravity = L::new(gravity);
        let is_mass = mass_lane::<L, D>();
        let (zero, present) = (L::splat(0.0), L::splat(PRESENT));
        for k in 0..main.len() {
            let node = main[k].0.as_mut_ptr();
            // SAFETY: a node is four numbers, aligned to 32 bytes
            unsafe {
                let momentum = L::load(node);
                let mass = mass_of::<L, D>(momentum);
                let there = mass.greater(L::splat(NO_MASS));
                let pull = if split {
                    L::load(change[k].0.as_ptr())
                } else {
                    zero
                };
                let (end, difference) = self.node::<L>(momentum, mass, pull, gravity, sums, there);
                L::select(is_mass, L::select(there, present, zero), end).store(node);
                if split {
                    difference.store(change[k].0.as_mut_ptr());
                }
            }
        }
    }

    /// [`Self::nodes`] for four nodes in 1D.
    ///
    /// # Safety
    /// The addresses are those of nodes.
    #[inline(always)]
    unsafe fn four<L: Lane>(
        &self,
        nodes: [*mut f64; 4],
        changes: Option<[*mut f64; 4]>,
        gravity: L,
        sums: &mut FreeSums<L>,
    ) {
        let zero = L::splat(0.0);
        // SAFETY: a node is four numbers, aligned to 32 bytes
        unsafe {
            let [momentum, mass] = L::load_pairs(nodes.map(|node| node.cast_const()));
            let mut pull = zero;
            if let Some(changes) = changes {
                [pull, _] = L::load_pairs(changes.map(|node| node.cast_const()));
            }
            let there = mass.greater(L::splat(NO_MASS));
            let (end, difference) = self.node::<L>(momentum, mass, pull, gravity, sums, there);
            let presence = L::select(there, L::splat(PRESENT), zero);
            L::store_pairs([end, presence], nodes);
            if let Some(changes) = changes {
                L::store_pairs([difference, zero], changes);
            }
        }
    }

    /// Velocities at the end of the step and their change; zero where there is no mass.
    #[inline(always)]
    fn node<L: Lane>(
        &self,
        momentum: L,
        mass: L,
        pull: L,
        gravity: L,
        sums: &mut FreeSums<L>,
        there: L::Mask,
    ) -> (L, L) {
        let zero = L::splat(0.0);
        let inverse = L::select(there, L::splat(1.0) / mass, zero);
        let start = momentum * inverse;
        let gained = pull.mul_add(inverse, L::select(there, gravity, zero)) * self.dt;
        let end = start + gained;
        let half = mass * 0.5;
        let sum = start + end;
        sums.arrived = (half * start).mul_add(start, sums.arrived);
        sums.left = (half * end).mul_add(end, sums.left);
        sums.internal = pull.mul_add(sum, sums.internal);
        sums.momentum = half.mul_add(sum, sums.momentum);
        (end, end - start)
    }

    /// Adds sums over free nodes to those of all nodes.
    #[inline(always)]
    pub fn account<L: Lane>(&self, free: &FreeSums<L>, sums: &mut GridSums) {
        let lanes = if D == 1 { 4 } else { D };
        let (arrived, left) = (free.arrived.array(), free.left.array());
        let (internal, momentum) = (free.internal.array(), free.momentum.array());
        for k in 0..lanes {
            let a = if D == 1 { 0 } else { k };
            sums.arrived += arrived[k];
            sums.left += left[k];
            sums.internal += 0.5 * self.dt * internal[k];
            sums.gravity += self.dt * self.gravity[a] * momentum[k];
        }
    }
}

/// The addresses of four nodes.
#[inline(always)]
fn four(nodes: &mut [Node; 4]) -> [*mut f64; 4] {
    nodes.each_mut().map(|node| node.0.as_mut_ptr())
}

/// The addresses of fewer than four nodes, and of a spare one in place of those that there are not.
#[inline(always)]
fn filled_up(nodes: &mut [Node], spare: &mut Node) -> [*mut f64; 4] {
    let mut four = [spare.0.as_mut_ptr(); 4];
    if let Some(node) = nodes.get_mut(0) {
        four[0] = node.0.as_mut_ptr();
    }
    if let Some(node) = nodes.get_mut(1) {
        four[1] = node.0.as_mut_ptr();
    }
    if let Some(node) = nodes.get_mut(2) {
        four[2] = node.0.as_mut_ptr();
    }
    four
}

/// [`divide_all`] for four nodes in 1D.
///
/// # Safety
/// The addresses are those of nodes.
#[inline(always)]
unsafe fn divide_four<L: Lane>(nodes: [*mut f64; 4]) {
    let zero = L::splat(0.0);
    // SAFETY: a node is four numbers, aligned to 32 bytes
    unsafe {
        let [momentum, mass] = L::load_pairs(nodes.map(|node| node.cast_const()));
        let there = mass.greater(L::splat(NO_MASS));
        let inverse = L::select(there, L::splat(1.0) / mass, zero);
        let presence = L::select(there, L::splat(PRESENT), zero);
        L::store_pairs([momentum * inverse, presence], nodes);
    }
}

/// Velocities and presence from momenta and masses; with wide instructions only if the processor has them.
pub fn divide<const D: usize>(nodes: &mut [Node], wide: bool) {
    #[cfg(target_arch = "x86_64")]
    if wide {
        // SAFETY: the instructions were found
        unsafe { divide_wide::<D>(nodes) };
        return;
    }
    let _ = wide;
    divide_all::<Portable, D>(nodes);
}

#[inline(always)]
fn divide_all<L: Lane, const D: usize>(nodes: &mut [Node]) {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let present = L::splat(PRESENT);
    if D == 1 {
        let (fours, left) = nodes.as_chunks_mut::<4>();
        for nodes in fours {
            // SAFETY: these are nodes
            unsafe { divide_four::<L>(four(nodes)) };
        }
        if !left.is_empty() {
            // SAFETY: as above
            unsafe { divide_four::<L>(filled_up(left, &mut Node::default())) };
        }
        return;
    }
    let is_mass = mass_lane::<L, D>();
    for node in nodes {
        // SAFETY: as above
        let momentum = unsafe { L::load(node.0.as_ptr()) };
        let mass = mass_of::<L, D>(momentum);
        let there = mass.greater(L::splat(NO_MASS));
        let inverse = L::select(there, one / mass, zero);
        let presence = L::select(there, present, zero);
        // SAFETY: as above
        unsafe { L::select(is_mass, presence, momentum * inverse).store(node.0.as_mut_ptr()) };
    }
}

/// [`divide_all`], compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn divide_wide<const D: usize>(nodes: &mut [Node]) {
    divide_all::<crate::real::Avx, D>(nodes);
}

/// Where in 2D and 3D a node has its mass.
#[inline(always)]
fn mass_lane<L: Lane, const D: usize>() -> L::Mask {
    let mut unit = [0.0; 4];
    unit[D] = 1.0;
    L::new(unit).greater(L::splat(0.0))
}

/// The mass of a node in all lanes, in 2D and 3D.
#[inline(always)]
fn mass_of<L: Lane, const D: usize>(node: L) -> L {
    match D {
        2 => node.broadcast::<2>(),
        _ => node.broadcast::<3>(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[target_feature(enable = "avx2,fma")]
    #[cfg(target_arch = "x86_64")]
    fn wide<const D: usize>(
        free: &Free<D>,
        main: &mut [Node],
        change: &mut [Node],
    ) -> FreeSums<crate::real::Avx> {
        let mut sums = FreeSums::new();
        free.nodes(main, change, &mut sums);
        sums
    }

    /// Momenta, masses and forces of `count` nodes, every fifth without mass.
    fn nodes<const D: usize>(count: usize) -> (Vec<Node>, Vec<Node>) {
        let number = |k: usize| (0.37 + k as f64 * 0.618_033_988_75).fract() - 0.5;
        let (mut main, mut change) = (Vec::new(), Vec::new());
        for k in 0..count {
            let (mut node, mut pull) = (Node::default(), Node::default());
            if k % 5 != 3 {
                for a in 0..D {
                    node.0[a] = number(10 * k + a);
                    pull.0[a] = number(10 * k + 5 + a);
                }
                node.0[D] = 1.0 + number(10 * k + 9);
            }
            main.push(node);
            change.push(pull);
        }
        (main, change)
    }

    /// Every number of rows of up to nine nodes, groups of four and what is left of them, against Newton's law node by node.
    fn newton<const D: usize>(split: bool, use_wide: bool) {
        let free = Free::<D> {
            gravity: Vector::from_fn(|a, _| 0.3 - 0.7 * a as f64),
            dt: 0.2,
        };
        for count in 0..=9 {
            let (start, pulls) = nodes::<D>(count);
            let (mut main, mut change) = (start.clone(), pulls.clone());
            if !split {
                change.clear();
            }
            let mut found = GridSums::default();
            #[cfg(target_arch = "x86_64")]
            if use_wide && crate::real::Instructions::found().wide() {
                // SAFETY: the instructions were just found
                let sums = unsafe { wide(&free, &mut main, &mut change) };
                free.account(&sums, &mut found);
            }
            if !(use_wide && crate::real::Instructions::found().wide()) {
                let mut sums = FreeSums::<Portable>::new();
                free.nodes(&mut main, &mut change, &mut sums);
                free.account(&sums, &mut found);
            }
            let mut divided = start.clone();
            divide::<D>(
                &mut divided,
                use_wide && crate::real::Instructions::found().wide(),
            );
            let mut book = GridSums::default();
            for k in 0..count {
                let mass = start[k].0[D];
                let there = if mass > 0.0 { PRESENT } else { 0.0 };
                assert_eq!(main[k].0[D], there, "{D}D, {count} nodes");
                assert_eq!(divided[k].0[D], there);
                for a in 0..D {
                    let (mut v, mut dv) = (0.0, 0.0);
                    let pull = if split { pulls[k].0[a] } else { 0.0 };
                    if mass > 0.0 {
                        v = start[k].0[a] / mass;
                        dv = (free.gravity[a] + pull / mass) * free.dt;
                    }
                    let end = v + dv;
                    assert!((divided[k].0[a] - v).abs() < 1e-14);
                    assert!((main[k].0[a] - end).abs() < 1e-14, "{D}D, {count} nodes");
                    if split {
                        assert!((change[k].0[a] - dv).abs() < 1e-14);
                    }
                    book.arrived += 0.5 * mass * v * v;
                    book.left += 0.5 * mass * end * end;
                    book.internal += 0.5 * free.dt * pull * (v + end);
                    book.gravity += 0.5 * free.dt * mass * free.gravity[a] * (v + end);
                }
            }
            for (found, book) in [
                (found.arrived, book.arrived),
                (found.left, book.left),
                (found.internal, book.internal),
                (found.gravity, book.gravity),
            ] {
                assert!((found - book).abs() < 1e-13, "{D}D, {count} nodes");
            }
        }
    }

    #[test]
    fn free_nodes_follow_newtons_law_however_many_there_are() {
        for (split, wide) in [(false, false), (false, true), (true, false), (true, true)] {
            newton::<1>(split, wide);
            newton::<2>(split, wide);
            newton::<3>(split, wide);
        }
    }
}
