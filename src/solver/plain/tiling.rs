//! What a tiling of points does to the nodes between them.

use super::*;
use crate::basis::{BasisChoice, BasisVisitor};

/// Points that tile the cells evenly and carry the same stress leave the nodes between them alone, whatever the basis and however
/// far the points have moved: sums of ∇₀N over them vanish, as their integral does. Where shape functions move with the points
/// that holds only as long as they are not stretched.
struct EvenTiling;

impl BasisVisitor for EvenTiling {
    type Output = ();

    fn visit<const N: usize, B: Basis<N>>(self, basis: B) {
        let geometry = Geometry::new(Vector::<2>::zeros(), 0.5, [24, 24], &basis);
        let axes = [basis.for_spacing(0.5); 2];
        let nodes =
            |per_axis: i32| (0..per_axis * per_axis).map(move |k| [k / per_axis, k % per_axis]);
        let count = 48 * 48;
        // x = F X with a stretch of 3 and some shear
        let f = Matrix::<2>::new(3.0, 0.7, -0.2, 0.6);
        let reference: Vec<Vector<2>> = nodes(48)
            .map(|k| Vector::from_fn(|a, _| 0.25 * (f64::from(k[a]) + 0.5)))
            .collect();
        let p = Particles {
            position: reference.iter().map(|x| f * x).collect(),
            reference_position: reference,
            mass: Masses::of_volumes(3.0, count, |_| 0.0625),
            first_piola_stress: vec![Matrix::<2>::new(7.0, -2.0, 5.0, 3.0); count],
            velocity: vec![Vector::zeros(); count],
            ..Particles::default()
        };
        let p = Particles {
            stress: vec![f64::NAN; 3 * count],
            ..p
        };
        let mut main = Dense::new(geometry.counts);
        let mut force = Dense::new(geometry.counts);
        let flip = Method::Flip(1.0);
        let what = Scattered::FORCE;
        let knows = |p: &Particles<2>, i: usize| known(&geometry, &axes, &p.reference_position[i]);
        plain_scatter(&knows, flip, &p, what, &mut main, &mut force);
        let inner = 6..geometry.counts[0] - 6;
        let mut seen = 0;
        for node in nodes(geometry.counts[0]) {
            if node.iter().all(|i| inner.contains(i)) {
                seen += 1;
                let pull = force.vector(&node).amax();
                assert!(pull < 1e-14, "{}: {pull:e}", std::any::type_name::<B>());
            }
        }
        assert!(seen > 100);
        let most = force.nodes.as_flattened().iter();
        let most = most.fold(0.0_f64, |most, pull| most.max(pull.abs()));
        assert!(most > 0.1, "the nodes at the ends are pulled");
    }
}

#[test]
fn evenly_stressed_points_pull_at_no_node_between_them() {
    BasisChoice::all()
        .iter()
        .for_each(|basis| basis.visit(EvenTiling));
}
