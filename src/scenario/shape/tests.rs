//! What every shape promises.

use super::{Ball, Cuboid, Cylinder, Difference, Polygon, Shape, Union};

fn ball(center: &[f64], radius: f64) -> Shape {
    Shape::Ball(Ball {
        center: center.to_vec(),
        radius,
    })
}

fn cuboid(min: &[f64], max: &[f64]) -> Shape {
    Shape::Cuboid(Cuboid {
        min: min.to_vec(),
        max: max.to_vec(),
    })
}

fn samples() -> Vec<Shape> {
    let samples = vec![
        cuboid(&[-1.0], &[0.5]),
        cuboid(&[0.5, -1.0], &[1.5, 0.5]),
        cuboid(&[0.0, -1.0, 0.25], &[0.5, 0.5, 1.0]),
        ball(&[0.25], 1.0),
        ball(&[0.0, 0.5], 0.75),
        ball(&[1.0, 0.5], 0.75),
        ball(&[0.0, 0.5, 0.1], 0.75),
        Shape::Cylinder(Cylinder {
            from: vec![-0.5, -0.5, -0.5],
            to: vec![0.5, 0.25, 0.75],
            radius: 0.5,
        }),
        Shape::Polygon(Polygon {
            points: vec![[0.0, 0.0], [1.5, 0.25], [0.5, 0.5], [0.25, 1.5]],
        }),
        Shape::Union(Union {
            shapes: vec![ball(&[0.5, 0.5], 0.5), cuboid(&[1.0, 0.0], &[1.5, 0.5])],
        }),
        Shape::Union(Union {
            shapes: vec![ball(&[0.5, 0.5], 0.25), ball(&[1.25, 0.5], 0.5)],
        }),
        Shape::Difference(Difference {
            of: Box::new(cuboid(&[0.0, -1.0], &[1.5, 1.0])),
            minus: vec![ball(&[0.5, 0.5], 0.4), ball(&[1.0, -0.25], 0.3)],
        }),
        Shape::Difference(Difference {
            of: Box::new(cuboid(&[0.0, 0.0], &[1.0, 1.0])),
            minus: vec![ball(&[0.0, 0.0], 0.5)],
        }),
    ];
    for name in Shape::NAMES {
        assert!(
            samples.iter().any(|shape| shape.name() == *name),
            "no sample of {name}"
        );
    }
    samples
}

/// Calls `visit` with places in the cube from −2 to 2 and the size of the cell that each stands for.
fn places(dimension: usize, mut visit: impl FnMut(&[f64], f64)) {
    let count = [4000, 400, 80][dimension - 1];
    let step = 4.0 / f64::from(count);
    let along = |k: i32| -2.0 + (f64::from(k) + 0.5) * step;
    let range = |axis: usize| if axis < dimension { 0..count } else { 0..1 };
    for i in range(0) {
        for j in range(1) {
            for k in range(2) {
                visit(
                    &[along(i), along(j), along(k)][..dimension],
                    step.powi(dimension as i32),
                );
            }
        }
    }
}

#[test]
fn nothing_inside_a_shape_is_outside_its_bounds() {
    for shape in samples() {
        let bounds = shape.bounds();
        places(bounds.min.len(), |at, _| {
            let bounded = at
                .iter()
                .enumerate()
                .all(|(k, x)| bounds.min[k] <= *x && *x <= bounds.max[k]);
            assert!(bounded || !shape.contains(at), "{shape:?} at {at:?}");
        });
    }
}

#[test]
fn the_exact_measure_is_what_counting_gives() {
    for shape in samples() {
        let (mut size, mut turned) = (0.0, 0.0);
        let dimension = shape.bounds().min.len();
        places(dimension, |at, cell| {
            if shape.contains(at) {
                size += cell;
                turned += if at[0] > 0.0 {
                    2.0 * std::f64::consts::PI * at[0] * cell
                } else {
                    0.0
                };
            }
        });
        if let Some(exact) = shape.measure() {
            approx::assert_relative_eq!(size, exact, max_relative = 0.02);
        }
        if let Some(exact) = shape.revolved().filter(|_| dimension == 2) {
            approx::assert_relative_eq!(turned, exact, max_relative = 0.02);
        }
    }
}

#[test]
fn the_measure_of_a_polygon_that_crosses_itself_is_not_known() {
    let bow = Polygon {
        points: vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.5]],
    };
    assert_eq!(Shape::Polygon(bow).measure(), None);
}

#[test]
fn the_measure_of_shapes_that_may_overlap_is_not_known() {
    let overlapping = Union {
        shapes: vec![ball(&[0.0, 0.0], 1.0), ball(&[0.5, 0.0], 1.0)],
    };
    let notch = Difference {
        of: Box::new(cuboid(&[0.0, 0.0], &[1.0, 1.0])),
        minus: vec![ball(&[0.0, 0.0], 0.5)],
    };
    assert_eq!(Shape::Union(overlapping).measure(), None);
    assert_eq!(Shape::Difference(notch).measure(), None);
}
