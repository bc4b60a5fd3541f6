//! The loop over points: four together, with wide instructions where the processor has them.

use super::{Increments, Kinematics, MOST, Material, Numbers, Rate, Stress, StressMut};
use crate::math::packed_len;
use crate::real::{Portable, Real, filled_up};
use crate::tensor::Tensor;

/// Points that are computed together.
const GROUP: usize = 4;

/// Rows of points, all of the same points.
pub(super) struct Rows<'a, const D: usize> {
    pub(super) memory: &'a mut [f64],
    pub(super) stress: StressMut<'a>,
    pub(super) increments: Increments<'a, D>,
}

/// Carries the rows of some points over one step: whole groups of four, then what is left, filled up to a group with copies of
/// one of its points. So what a point gets depends neither on its neighbours nor on its place.
pub(super) fn update<const D: usize, M: Material<D>>(
    material: &M,
    memory: &mut [f64],
    stress: StressMut<'_>,
    increments: &Increments<'_, D>,
) {
    let width = <M::Memory<f64> as Numbers<f64>>::COUNT;
    let packed = packed_len(D);
    let count = increments.rates.len();
    assert_eq!(memory.len(), width * count);
    assert_eq!(stress.plane.len(), packed * count);
    let hoops = stress.hoop.len();
    assert!(hoops == 0 || hoops == count);
    assert_eq!(increments.hoop_rates.len(), hoops);
    assert_eq!(increments.hoop_stretches.len(), hoops);

    let whole = count - count % GROUP;
    let hoop_whole = whole.min(hoops);
    let (memory, memory_left) = memory.split_at_mut(whole * width);
    let (plane, plane_left) = stress.plane.split_at_mut(whole * packed);
    let (hoop, hoop_left) = stress.hoop.split_at_mut(hoop_whole);
    let (rates, rates_left) = increments.rates.split_at(whole);
    let (hoop_rates, hoop_rates_left) = increments.hoop_rates.split_at(hoop_whole);
    let (hoop_stretches, hoop_stretches_left) = increments.hoop_stretches.split_at(hoop_whole);
    if whole > 0 {
        groups(
            material,
            Rows {
                memory,
                stress: StressMut { plane, hoop },
                increments: Increments {
                    rates,
                    hoop_rates,
                    hoop_stretches,
                    ..*increments
                },
            },
        );
    }
    let left = count - whole;
    if left == 0 {
        return;
    }
    let mut memory = filled_up::<{ GROUP * MOST }>(memory_left, width);
    let mut plane = filled_up::<{ GROUP * 6 }>(plane_left, packed);
    let mut hoop = filled_up::<GROUP>(hoop_left, 1);
    let hoop_rates = filled_up::<GROUP>(hoop_rates_left, 1);
    let hoop_stretches = filled_up::<GROUP>(hoop_stretches_left, 1);
    let rates: [Rate<D>; GROUP] = std::array::from_fn(|k| rates_left[k.min(left - 1)]);
    let group_hoops = GROUP.min(hoops * GROUP);
    groups(
        material,
        Rows {
            memory: &mut memory[..GROUP * width],
            stress: StressMut {
                plane: &mut plane[..GROUP * packed],
                hoop: &mut hoop[..group_hoops],
            },
            increments: Increments {
                rates: &rates,
                hoop_rates: &hoop_rates[..group_hoops],
                hoop_stretches: &hoop_stretches[..group_hoops],
                ..*increments
            },
        },
    );
    memory_left.copy_from_slice(&memory[..left * width]);
    plane_left.copy_from_slice(&plane[..left * packed]);
    let hoops_left = hoop_left.len();
    hoop_left.copy_from_slice(&hoop[..hoops_left]);
}

/// Whole groups of points.
fn groups<const D: usize, M: Material<D>>(material: &M, rows: Rows<'_, D>) {
    #[cfg(target_arch = "x86_64")]
    if rows.increments.wide && crate::real::wide_instructions() {
        // SAFETY: the instructions were just found
        unsafe { wide(material, rows) };
        return;
    }
    every_group::<Portable, D, M>(material, rows);
}

/// [`every_group`], compiled for wide instructions.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn wide<const D: usize, M: Material<D>>(material: &M, rows: Rows<'_, D>) {
    every_group::<crate::real::Avx, D, M>(material, rows);
}

/// How many groups before their turn memory is asked for them.
const AHEAD: usize = 3;

#[inline(always)]
pub(super) fn every_group<R: Real, const D: usize, M: Material<D>>(
    material: &M,
    rows: Rows<'_, D>,
) {
    const { assert!(GROUP.is_multiple_of(R::LANES)) };
    if rows.stress.hoop.is_empty() {
        every_group_of::<R, D, M, false>(material, rows);
    } else {
        every_group_of::<R, D, M, true>(material, rows);
    }
}

#[inline(always)]
fn every_group_of<R: Real, const D: usize, M: Material<D>, const HOOP: bool>(
    material: &M,
    rows: Rows<'_, D>,
) {
    let width = <M::Memory<R> as Numbers<R>>::COUNT;
    let packed = packed_len(D);
    let Rows {
        memory,
        stress: StressMut { plane, hoop },
        increments,
    } = rows;
    let dt = R::splat(increments.dt);
    assert_eq!(memory.len(), width * increments.rates.len());
    assert_eq!(plane.len(), packed * increments.rates.len());
    let mut numbers = [R::splat(0.0); MOST];
    let mut one = [R::splat(0.0)];
    for (group, rates) in increments.rates.chunks_exact(R::LANES).enumerate() {
        let first = group * R::LANES;
        // SAFETY: the columns are as long as was just checked; checking every group costs a tenth of a simple law
        let (plane, memory) = unsafe {
            (
                plane.get_unchecked_mut(first * packed..(first + R::LANES) * packed),
                memory.get_unchecked_mut(first * width..(first + R::LANES) * width),
            )
        };

        // the columns go on beyond this block
        let ahead = AHEAD * R::LANES;
        R::prefetch(memory.as_ptr().wrapping_add(ahead * width), 4 * width);
        R::prefetch(plane.as_ptr().wrapping_add(ahead * packed), 4 * packed);

        let mut step = Kinematics {
            rate: Tensor::zero(),
            hoop_rate: R::splat(0.0),
            hoop_stretch: R::splat(1.0),
            dt,
        };
        for a in 0..D {
            let column = |k: usize| &rates[k.min(R::LANES - 1)].0[a];
            let columns = [column(0), column(1), column(2), column(3)];
            R::read_padded(columns, &mut numbers[..D]);
            for i in 0..D {
                step.rate[(i, a)] = numbers[i];
            }
        }
        R::read_rows(plane, &mut numbers[..packed]);
        let mut stress = Stress {
            plane: Tensor::from_packed(&numbers[..packed]),
            transverse: R::splat(0.0),
        };
        if HOOP {
            let group = first..first + R::LANES;
            R::read_rows(&increments.hoop_rates[group.clone()], &mut one);
            step.hoop_rate = one[0];
            R::read_rows(&increments.hoop_stretches[group.clone()], &mut one);
            step.hoop_stretch = one[0];
            R::read_rows(&hoop[group], &mut one);
            stress.transverse = one[0];
        }
        R::read_rows(memory, &mut numbers[..width]);
        let mut remembered = M::Memory::from_numbers(&numbers[..width]);

        material.update_stress(&mut remembered, &mut stress, &step);

        remembered.to_numbers(&mut numbers[..width]);
        R::write_rows(memory, &numbers[..width]);
        stress.plane.to_packed(&mut numbers[..packed]);
        R::write_rows(plane, &numbers[..packed]);
        if HOOP {
            one[0] = stress.transverse;
            R::write_rows(&mut hoop[first..first + R::LANES], &one);
        }
    }
}
