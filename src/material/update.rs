//! The loop over points: four or eight together, with wide instructions where the processor has them.

use super::{
    FourRates, Increments, Kinematics, MOST, Material, Numbers, ReferenceMut, Stress, StressMut,
};
use crate::math::packed_len;
use crate::real::{Instructions, Portable, Real, filled_up};
use crate::tensor::Tensor;
use std::ops::Range;

/// Points that are computed together.
const GROUP: usize = 4;

/// Rows of points, all of the same points.
pub(super) struct Rows<'a, const D: usize> {
    pub(super) memory: &'a mut [f64],
    pub(super) stress: StressMut<'a>,
    pub(super) increments: Increments<'a, D>,
}

impl<'a, const D: usize> Rows<'a, D> {
    /// How many points.
    fn count(&self) -> usize {
        self.stress.plane.len() / packed_len(D)
    }

    /// The first `count` points of a law, a multiple of four, and the others.
    fn split_at<M: Material<D>>(self, count: usize) -> (Self, Self) {
        let width = <M::Memory<f64> as Numbers<f64>>::COUNT;
        let increments = self.increments;
        let hoops = count.min(self.stress.hoop.len());
        let (memory, other_memory) = self.memory.split_at_mut(count * width);
        let (plane, other_plane) = self.stress.plane.split_at_mut(count * packed_len(D));
        let (hoop, other_hoop) = self.stress.hoop.split_at_mut(hoops);
        let (reference, other_reference) = self.stress.reference.split_at(count * D * D);
        let stress = StressMut {
            plane,
            hoop,
            reference,
        };
        let other_stress = StressMut {
            plane: other_plane,
            hoop: other_hoop,
            reference: other_reference,
        };
        let all_hoops = increments.hoop_rates.len();
        let (four, fours) = (count / GROUP, increments.rates.len());
        (
            Rows {
                memory,
                stress,
                increments: part_of(&increments, 0..four, 0..hoops),
            },
            Rows {
                memory: other_memory,
                stress: other_stress,
                increments: part_of(&increments, four..fours, hoops..all_hoops),
            },
        )
    }
}

/// The increments of some fours, and of some rows that have hoops.
fn part_of<'a, const D: usize>(
    all: &Increments<'a, D>,
    fours: Range<usize>,
    hoops: Range<usize>,
) -> Increments<'a, D> {
    Increments {
        rates: &all.rates[fours],
        hoop_rates: &all.hoop_rates[hoops.clone()],
        hoop_stretches: &all.hoop_stretches[hoops],
        ..*all
    }
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
    let count = stress.plane.len() / packed;
    assert_eq!(stress.plane.len(), packed * count);
    assert_eq!(memory.len(), width * count);
    assert_eq!(increments.rates.len(), count.div_ceil(GROUP));
    let hoops = stress.hoop.len();
    assert!(hoops == 0 || hoops == count);
    assert_eq!(increments.hoop_rates.len(), hoops);
    assert_eq!(increments.hoop_stretches.len(), hoops);
    let [deformations, references] = [
        stress.reference.deformation.len(),
        stress.reference.first_piola.len(),
    ];
    assert!(references == 0 || references == D * D * count);
    assert!(deformations == 0 || deformations == references);

    let rows = Rows {
        memory,
        stress,
        increments: *increments,
    };
    let left = count % GROUP;
    let (whole, rest) = rows.split_at::<M>(count - left);
    if left < count {
        groups(material, whole);
    }
    if left == 0 {
        return;
    }
    let Rows {
        memory: memory_left,
        stress:
            StressMut {
                plane: plane_left,
                hoop: hoop_left,
                reference: reference_left,
            },
        increments:
            Increments {
                rates: rates_left,
                hoop_rates: hoop_rates_left,
                hoop_stretches: hoop_stretches_left,
                ..
            },
    } = rest;
    let mut memory = filled_up::<{ GROUP * MOST }>(memory_left, width);
    let mut plane = filled_up::<{ GROUP * 6 }>(plane_left, packed);
    let mut hoop = filled_up::<GROUP>(hoop_left, 1);
    let hoop_rates = filled_up::<GROUP>(hoop_rates_left, 1);
    let hoop_stretches = filled_up::<GROUP>(hoop_stretches_left, 1);
    // the lanes that are left over may hold anything
    let mut rates = rates_left[0];
    for lanes in rates.0.as_flattened_mut() {
        let last = lanes[left - 1];
        lanes[left..].fill(last);
    }
    let group_hoops = GROUP.min(hoops * GROUP);
    let mut deformation = filled_up::<{ GROUP * 9 }>(reference_left.deformation, D * D);
    let mut first_piola = [0.0; GROUP * 9];
    let numbers = |column: usize| (GROUP * D * D).min(column * GROUP);
    groups(
        material,
        Rows {
            memory: &mut memory[..GROUP * width],
            stress: StressMut {
                plane: &mut plane[..GROUP * packed],
                hoop: &mut hoop[..group_hoops],
                reference: ReferenceMut {
                    deformation: &mut deformation[..numbers(deformations)],
                    first_piola: &mut first_piola[..numbers(references)],
                },
            },
            increments: Increments {
                rates: &[rates],
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
    let ReferenceMut {
        deformation: deformation_left,
        first_piola: first_piola_left,
    } = reference_left;
    let [deformations_left, references_left] = [deformation_left.len(), first_piola_left.len()];
    deformation_left.copy_from_slice(&deformation[..deformations_left]);
    first_piola_left.copy_from_slice(&first_piola[..references_left]);
}

/// Whole groups of points.
fn groups<const D: usize, M: Material<D>>(material: &M, rows: Rows<'_, D>) {
    match rows.increments.instructions.usable() {
        // SAFETY: the instructions were just found
        #[cfg(target_arch = "x86_64")]
        Instructions::Widest => unsafe { widest(material, rows) },
        // SAFETY: as above
        #[cfg(target_arch = "x86_64")]
        Instructions::Wide => unsafe { wide(material, rows) },
        _ => every_group::<Portable, D, M>(material, rows),
    }
}

/// [`every_group`], compiled for registers of four.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn wide<const D: usize, M: Material<D>>(material: &M, rows: Rows<'_, D>) {
    every_group::<crate::real::Avx, D, M>(material, rows);
}

/// [`every_group`], compiled for registers of eight; the last group may be one of four.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f,avx512vl,avx512dq")]
fn widest<const D: usize, M: Material<D>>(material: &M, rows: Rows<'_, D>) {
    let count = rows.count();
    let (eights, four) = rows.split_at::<M>(count - count % 8);
    every_group::<crate::real::Avx512, D, M>(material, eights);
    every_group::<crate::real::Avx, D, M>(material, four);
}

/// How many groups before their turn memory is asked for them.
const AHEAD: usize = 3;

#[inline(always)]
pub(super) fn every_group<R: Real, const D: usize, M: Material<D>>(
    material: &M,
    rows: Rows<'_, D>,
) {
    assert!(rows.count().is_multiple_of(R::LANES));
    let hoops = !rows.stress.hoop.is_empty();
    match (hoops, rows.stress.reference.first_piola.is_empty()) {
        (false, true) => every_group_of::<R, D, M, false, false>(material, rows),
        (false, false) => every_group_of::<R, D, M, false, true>(material, rows),
        (true, true) => every_group_of::<R, D, M, true, false>(material, rows),
        (true, false) => every_group_of::<R, D, M, true, true>(material, rows),
    }
}

#[inline(always)]
fn every_group_of<R: Real, const D: usize, M: Material<D>, const HOOP: bool, const TOTAL: bool>(
    material: &M,
    rows: Rows<'_, D>,
) {
    let width = <M::Memory<R> as Numbers<R>>::COUNT;
    let packed = packed_len(D);
    let Rows {
        memory,
        stress:
            StressMut {
                plane,
                hoop,
                reference:
                    ReferenceMut {
                        deformation,
                        first_piola,
                    },
            },
        increments,
    } = rows;
    let dt = R::splat(increments.dt);
    let count = plane.len() / packed;
    let rates = FourRates::numbers(increments.rates);
    assert_eq!(memory.len(), width * count);
    assert!(increments.rates.len() * GROUP >= count);
    // numbers of F that are kept for a point
    let kept = if deformation.is_empty() { 0 } else { D * D };
    if TOTAL {
        assert_eq!(first_piola.len(), D * D * count);
        assert!(kept == 0 || deformation.len() == first_piola.len());
    }
    let mut numbers = [R::splat(0.0); MOST];
    let mut one = [R::splat(0.0)];
    for first in (0..count / R::LANES).map(|group| group * R::LANES) {
        // SAFETY: the columns are as long as was just checked; checking every group costs a tenth of a simple law
        let (plane, memory) = unsafe {
            (
                plane.get_unchecked_mut(first * packed..(first + R::LANES) * packed),
                memory.get_unchecked_mut(first * width..(first + R::LANES) * width),
            )
        };

        // the columns go on beyond this block
        let ahead = AHEAD * R::LANES;
        R::prefetch(
            memory.as_ptr().wrapping_add(ahead * width),
            R::LANES * width,
        );
        R::prefetch(
            plane.as_ptr().wrapping_add(ahead * packed),
            R::LANES * packed,
        );

        let mut step = Kinematics {
            rate: Tensor::zero(),
            hoop_rate: R::splat(0.0),
            hoop_stretch: R::splat(1.0),
            dt,
        };
        let fours = FourRates::<D>::COUNT * R::LANES.div_ceil(GROUP);
        let own = &rates[first / GROUP * FourRates::<D>::COUNT..][..fours];
        for a in 0..D {
            for i in 0..D {
                let at = GROUP * (a * D + i) + first % GROUP;
                step.rate[(i, a)] = R::read_fours(&own[at..], FourRates::<D>::COUNT);
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

        if TOTAL {
            // SAFETY: as above
            let (deformation, first_piola) = unsafe {
                (
                    deformation.get_unchecked_mut(first * kept..(first + R::LANES) * kept),
                    first_piola.get_unchecked_mut(first * D * D..(first + R::LANES) * D * D),
                )
            };
            R::prefetch(
                deformation.as_ptr().wrapping_add(ahead * kept),
                R::LANES * kept,
            );
            R::prefetch(
                first_piola.as_ptr().wrapping_add(ahead * D * D),
                R::LANES * D * D,
            );
            let numbers = &mut numbers[..D * D];
            let start = match material.deformation_gradient(&remembered) {
                Some(start) => start,
                None => {
                    R::read_rows(deformation, numbers);
                    Tensor::from_columns(numbers)
                }
            };
            material.update_stress_in_reference(&mut remembered, &mut stress, &step, &start);
            let end = match material.deformation_gradient(&remembered) {
                Some(end) => end,
                None => step.rate.scaled_plus(dt, start),
            };
            if kept > 0 {
                end.to_columns(numbers);
                R::write_rows(deformation, numbers);
            }
            let piola = stress.plane * end.inverse().transpose();
            piola.to_columns(numbers);
            R::write_rows(first_piola, numbers);
        } else {
            material.update_stress(&mut remembered, &mut stress, &step);
        }

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
