//! Domains: their functions node by node, and what they promise.

use super::cloud::Kind;
use super::compare::{EveryPass, SPACING};
use super::*;
use crate::basis::Cpdi;
use crate::real::Instructions;
use crate::solver::Domains;
use crate::solver::kernels::Kernels;
use crate::transfer::{Apic, Flip, MlsApic, Pic, Tpic, Transfer};
use std::cell::Cell;

/// The hat function, in cells.
fn hat(x: f64) -> f64 {
    (1.0 - x.abs()).max(0.0)
}

/// R, m: F times the undeformed half-edges, each row cut to two cells.
fn edges<const D: usize>(geometry: &Geometry<D>, p: &Particles<D>, i: usize) -> Matrix<D> {
    let h = geometry.cell_size;
    let mut edges = Matrix::from_diagonal(&Vector::from_fn(|a, _| 0.5 * h * SPACING[a]));
    if !p.is_total() {
        edges = p.deformation_gradient[i] * edges;
    }
    for mut row in edges.row_iter_mut() {
        let extent = row.iter().map(|r| r.abs()).sum::<f64>();
        row *= (2.0 * h / extent).min(1.0);
    }
    edges
}

/// All nodes within three cells: φ the mean of the hats of all corners, ∇φ that of the hats times R⁻ᵀ s.
fn known_by_domain<const D: usize>(
    geometry: &Geometry<D>,
    p: &Particles<D>,
    i: usize,
) -> Vec<Known<D>> {
    let h = geometry.cell_size;
    let (x, edges) = (p.grid_position()[i], edges(geometry, p, i));
    let turned = edges.try_inverse().expect("not flat").transpose();
    let signs = (0..1_usize << D)
        .map(|c| Vector::<D>::from_fn(|a, _| if c >> a & 1 == 1 { 1.0 } else { -1.0 }));
    let signs: Vec<Vector<D>> = signs.collect();
    let share = 1.0 / signs.len() as f64;
    let near = geometry.in_cells(&x, 1.0 / h).map(|x| x.round() as i32 - 3);
    let mut nodes: Vec<Known<D>> = (0..7_usize.pow(D as u32))
        .map(|k| {
            let place: [i32; D] =
                std::array::from_fn(|a| near[a] + (k / 7_usize.pow(a as u32) % 7) as i32);
            let arm = Vector::from_fn(|a, _| geometry.min[a] + h * f64::from(place[a]) - x[a]);
            let at = |s: &Vector<D>| -> f64 {
                let away = (arm - edges * s) / h;
                share * away.iter().map(|x| hat(*x)).product::<f64>()
            };
            let hats: Vec<f64> = signs.iter().map(at).collect();
            let lean = |a: usize| -> f64 {
                let faces = signs.iter().zip(&hats).map(|(s, at)| s[a] * at);
                faces.sum::<f64>() / (0.5 * h * SPACING[a])
            };
            Known {
                lean: Vector::from_fn(|a, _| lean(a)),
                node: place.map(|node| node + Cpdi::REACH),
                arm,
                weight: hats.iter().sum(),
                gradient: turned
                    * signs
                        .iter()
                        .zip(&hats)
                        .map(|(s, at)| s * *at)
                        .sum::<Vector<D>>(),
                fitted: Vector::zeros(),
                middle: None,
            }
        })
        // nor are those that a corner on the edge of a cell touches by rounding
        .filter(|known| known.weight > 1e-14)
        .collect();
    let inertia: Matrix<D> = nodes
        .iter()
        .map(|k| k.arm * k.arm.transpose() * k.weight)
        .sum();
    let inverse = inertia.try_inverse().expect("a domain has an extent");
    for known in &mut nodes {
        known.fitted = inverse * known.arm * known.weight;
    }
    nodes
}

fn compare<const D: usize, T: Transfer>(cells: [i32; D], transfer: T, method: Method) {
    for kind in Kind::all::<D>(true) {
        let geometry = Geometry::new(kind.corner(), 0.0625, cells, &Cpdi::default());
        let half = |a: usize| Cpdi::default().for_spacing(SPACING[a]);
        let kernels = Domains::<D, T> {
            basis: vec![std::array::from_fn(half)],
            transfer,
        };
        let knows = |p: &Particles<D>, i: usize| known_by_domain(&geometry, p, i);
        for instructions in Instructions::all() {
            let name = std::any::type_name::<T>();
            let bits = &Cell::new(0);
            let pass = EveryPass { instructions, bits };
            pass.compare(name, &geometry, &kernels, &knows, method, kind);
        }
    }
}

fn compare_dimensions<T: Transfer>(transfer: T, method: Method) {
    compare([70], transfer, method);
    compare([41, 19], transfer, method);
    compare([13, 10, 11], transfer, method);
}

#[test]
fn the_kernels_of_domains_do_what_the_textbook_says() {
    compare_dimensions(Pic, Method::Pic);
    compare_dimensions(Flip { ratio: 0.9 }, Method::Flip(0.9));
    compare_dimensions(Apic, Method::Apic);
    compare_dimensions(MlsApic, Method::MlsApic);
    compare_dimensions(Tpic, Method::Tpic);
}

/// A point in the middle of a grid.
fn alone<const D: usize>(f: Matrix<D>, x: Vector<D>) -> (Geometry<D>, Particles<D>) {
    let geometry = Geometry::new(Vector::zeros(), 0.25, [12; D], &Cpdi::default());
    let p = Particles {
        position: vec![x],
        deformation_gradient: vec![f],
        ..Particles::default()
    };
    (geometry, p)
}

/// Σ φ = 1, Σ φ x_i = x, Σ ∇φ = 0, Σ x_i ∇φᵀ = I; and Σ φ (x_i − x)(x_i − x)ᵀ is what the angular momentum of C counts.
fn complete<const D: usize>() {
    let half = |a: usize| Cpdi::default().for_spacing(SPACING[a]);
    let kernels = Domains::<D, Apic> {
        basis: vec![std::array::from_fn(half)],
        transfer: Apic,
    };
    for k in 0..200 {
        let number = |n: usize| ((k * 37 + n) as f64 * 0.618_033_988_75).fract() - 0.5;
        // up to far beyond what a domain may be, and turned by any angle
        let size = 10.0_f64.powf(3.0 * number(50) - 0.5);
        let f = (Matrix::<D>::from_fn(|i, j| number(D * i + j)) + Matrix::identity() * 0.9) * size;
        let (geometry, p) = alone(f, Vector::from_fn(|a, _| 1.5 + 3.0 * number(20 + a)));
        let nodes = known_by_domain(&geometry, &p, 0);
        let one: f64 = nodes.iter().map(|k| k.weight).sum();
        let arm: Vector<D> = nodes.iter().map(|k| k.arm * k.weight).sum();
        let zero: Vector<D> = nodes.iter().map(|k| k.gradient).sum();
        let unit: Matrix<D> = nodes.iter().map(|k| k.arm * k.gradient.transpose()).sum();
        // of corners close to each other gradients are differences
        let inverse = edges(&geometry, &p, 0).try_inverse().expect("not flat");
        let scale = inverse.amax().max(1.0);
        assert!((one - 1.0).abs() < 1e-14, "{D}D: {one}");
        assert!(arm.amax() < 1e-14, "{D}D: {arm}");
        assert!(zero.amax() < 1e-14 * scale, "{D}D: {zero}");
        let unit = (unit - Matrix::identity()).amax();
        assert!(unit < 1e-13 * scale, "{D}D: {unit:e}");
        let per_cell = 1.0 / geometry.cell_size;
        let moments: Matrix<D> = nodes
            .iter()
            .map(|k| k.arm * k.arm.transpose() * (k.weight * per_cell * per_cell))
            .sum();
        let x = geometry.in_cells(&p.position[0], per_cell);
        let deformed = p.deformation_gradient.first();
        let inertia = kernels.inertia(0, &x, deformed, &geometry.cells);
        let off = (inertia - moments).amax() / moments.amax();
        assert!(off < 1e-13, "{D}D: {off:e}");
    }
}

#[test]
fn functions_of_any_domain_are_complete_to_first_order() {
    complete::<1>();
    complete::<2>();
    complete::<3>();
}

/// Points of equal stress and deformation that tile a block pull at no node inside it, whatever the deformation.
fn tiling<const D: usize>(f: Matrix<D>, per_axis: usize, cells: i32) {
    let h = 0.25;
    let geometry = Geometry::new(Vector::zeros(), h, [cells; D], &Cpdi::default());
    // no node on an edge of the block
    let middle = Vector::from_fn(|a, _| h * (0.5 * f64::from(cells) + 0.21 * (a + 1) as f64));
    let spacing = |a: usize| h * SPACING[a];
    let count = per_axis.pow(D as u32);
    let half = |a: usize| 0.5 * per_axis as f64 * spacing(a);
    let place = |k: usize| {
        let x = |a: usize| ((k / per_axis.pow(a as u32) % per_axis) as f64 + 0.5) * spacing(a);
        middle + f * Vector::<D>::from_fn(|a, _| x(a) - half(a))
    };
    let stress = [3.0, -1.0, 2.0, 5.0, 0.5, -4.0];
    let p = Particles {
        position: (0..count).map(place).collect(),
        velocity: vec![Vector::zeros(); count],
        deformation_gradient: vec![f; count],
        mass: Masses::of_volumes(1.3, count, |_| (0..D).map(spacing).product()),
        stress: stress[..packed_len(D)].repeat(count),
        ..Particles::default()
    };
    let knows = |p: &Particles<D>, i: usize| known_by_domain(&geometry, p, i);
    let mut main = Dense::new(geometry.counts);
    let mut force = Dense::new(geometry.counts);
    let what = Scattered::FORCE;
    plain_scatter(&knows, Method::Flip(1.0), &p, what, &mut main, &mut force);
    let inverse = f.try_inverse().expect("not flat");
    let inside = |x: Vector<D>| {
        let undeformed = inverse * (x - middle);
        (0..D).all(|a| undeformed[a].abs() < half(a))
    };
    let pulls = force.nodes.as_flattened().iter();
    let most = pulls.fold(0.0_f64, |most, pull| most.max(pull.abs()));
    let mut within = 0;
    for k in 0..geometry.counts.iter().product::<i32>() {
        let node: [i32; D] =
            std::array::from_fn(|a| k / geometry.counts[a].pow(a as u32) % geometry.counts[a]);
        let x = Vector::from_fn(|a, _| h * f64::from(node[a] - Cpdi::REACH));
        let pull = force.vector(&node).amax();
        // all that a node knows lies in the block
        let corners = (0..1_usize << D)
            .map(|c| x + Vector::from_fn(|a, _| if c >> a & 1 == 1 { h } else { -h }));
        if corners.into_iter().all(inside) {
            within += 1;
            // places have rounding errors of 1e-14 cells
            assert!(pull < 1e-13 * most, "{f} {node:?}: {pull:e} of {most:e}");
        }
    }
    assert!(within >= 4, "{f}: {within} nodes inside");
    assert!(most > 0.0, "the surface of the block is pulled");
}

#[test]
fn domains_that_tile_pull_at_no_node_between_them() {
    for stretch in [0.4, 0.83, 1.2, 2.37, 3.9] {
        tiling(Matrix::<1>::new(stretch), 40, 90);
        tiling(Matrix::<2>::new(stretch, 0.0, 0.0, 1.3), 24, 60);
    }
    tiling(Matrix::<2>::new(0.8, 0.6, -0.6, 0.8), 24, 40);
    tiling(Matrix::<2>::new(1.7, 2.5, -0.4, 0.9), 24, 60);
    let f = [1.3, 0.4, -0.2, -0.5, 0.9, 0.3, 0.1, 0.2, 1.2];
    tiling(Matrix::<3>::from_row_slice(&f), 12, 24);
}
