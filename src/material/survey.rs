//! How stiff points are: the loop over them, four together, with wide instructions where the processor has them.

use super::{MOST, Material, Numbers, Present, Stress};
use crate::math::packed_len;
use crate::real::{Instructions, Portable, Real, filled_up};
use crate::tensor::Tensor;

/// Points that are computed together.
const GROUP: usize = 4;

/// Writes the stiffness of each of some points: of whole groups of four, then of what is left, filled up to a group with copies
/// of its last point. So what a point gets depends neither on its neighbours nor on its place.
pub(super) fn stiffness<const D: usize, M: Material<D>>(
    material: &M,
    memory: &[f64],
    present: &Present<'_>,
    instructions: Instructions,
    into: &mut [f64],
) {
    let width = <M::Memory<f64> as Numbers<f64>>::COUNT;
    let packed = packed_len(D);
    let count = into.len();
    let hoops = present.hoop_stress.len();
    assert_eq!(memory.len(), width * count);
    assert_eq!(present.stress.len(), packed * count);
    assert!(hoops == 0 || hoops == count);
    assert_eq!(present.hoop_stretches.len(), hoops);

    let whole = count - count % GROUP;
    let hoop_whole = whole.min(hoops);
    let groups_of = Present {
        stress: &present.stress[..whole * packed],
        hoop_stress: &present.hoop_stress[..hoop_whole],
        hoop_stretches: &present.hoop_stretches[..hoop_whole],
    };
    groups(
        material,
        &memory[..whole * width],
        &groups_of,
        instructions,
        &mut into[..whole],
    );
    let left = count - whole;
    if left == 0 {
        return;
    }
    let plane = filled_up::<{ GROUP * 6 }>(&present.stress[whole * packed..], packed);
    let hoop = filled_up::<GROUP>(&present.hoop_stress[hoop_whole..], 1);
    let stretches = filled_up::<GROUP>(&present.hoop_stretches[hoop_whole..], 1);
    let group_hoops = GROUP.min(hoops * GROUP);
    let group = Present {
        stress: &plane[..GROUP * packed],
        hoop_stress: &hoop[..group_hoops],
        hoop_stretches: &stretches[..group_hoops],
    };
    let numbers = filled_up::<{ GROUP * MOST }>(&memory[whole * width..], width);
    let mut four = [0.0; GROUP];
    groups(
        material,
        &numbers[..GROUP * width],
        &group,
        instructions,
        &mut four,
    );
    into[whole..].copy_from_slice(&four[..left]);
}

/// Whole groups of points.
fn groups<const D: usize, M: Material<D>>(
    material: &M,
    memory: &[f64],
    present: &Present<'_>,
    instructions: Instructions,
    into: &mut [f64],
) {
    #[cfg(target_arch = "x86_64")]
    if instructions.usable().wide() {
        // SAFETY: the instructions were just found
        unsafe { every_group_wide(material, memory, present, into) };
        return;
    }
    let _ = instructions;
    every_group::<Portable, D, M>(material, memory, present, into);
}

/// [`every_group`], compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn every_group_wide<const D: usize, M: Material<D>>(
    material: &M,
    memory: &[f64],
    present: &Present<'_>,
    into: &mut [f64],
) {
    every_group::<crate::real::Avx, D, M>(material, memory, present, into);
}

#[inline(always)]
fn every_group<R: Real, const D: usize, M: Material<D>>(
    material: &M,
    memory: &[f64],
    present: &Present<'_>,
    into: &mut [f64],
) {
    const { assert!(R::LANES == GROUP) };
    let width = <M::Memory<R> as Numbers<R>>::COUNT;
    let packed = packed_len(D);
    let mut numbers = [R::splat(0.0); MOST];
    for (group, to) in into.chunks_exact_mut(GROUP).enumerate() {
        let rows = group * GROUP..(group + 1) * GROUP;
        let own = |width: usize| rows.start * width..rows.end * width;
        R::read_rows(&present.stress[own(packed)], &mut numbers[..packed]);
        let mut stress = Stress {
            plane: Tensor::from_packed(&numbers[..packed]),
            transverse: R::splat(0.0),
        };
        let mut stretch = [R::splat(1.0)];
        if !present.hoop_stress.is_empty() {
            let mut hoop = [R::splat(0.0)];
            R::read_rows(&present.hoop_stress[rows.clone()], &mut hoop);
            R::read_rows(&present.hoop_stretches[rows.clone()], &mut stretch);
            stress.transverse = hoop[0];
        }
        R::read_rows(&memory[own(width)], &mut numbers[..width]);
        let remembered = M::Memory::from_numbers(&numbers[..width]);
        let found = material.stiffness(&remembered, &stress, stretch[0]);
        R::write_rows(to, &[found]);
    }
}
