use super::*;
use crate::material::Plane;
use crate::scenario::shape::{Ball, Cuboid, Cylinder, Difference, Polygon};
use crate::scenario::{GridSpec, Region};
use approx::assert_relative_eq;

/// Cells of 0.25 m around the origin, or from it on.
fn grid(dimension: usize, from: f64) -> GridSpec {
    let cells = ((4.0 - from) / 0.25) as i32;
    GridSpec {
        min: vec![from; dimension],
        max: vec![4.0; dimension],
        cell_size: 0.25,
        cells: vec![cells; dimension],
    }
}

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

/// A ball with a concentric hole, whose volume no formula gives.
fn ring(center: &[f64], inner: f64, outer: f64) -> Shape {
    Shape::Difference(Difference {
        of: Box::new(ball(center, outer)),
        minus: vec![ball(center, inner)],
    })
}

/// Everything around a body.
fn all(dimension: usize) -> Shape {
    cuboid(&[-9.0; 3][..dimension], &[9.0; 3][..dimension])
}

struct Surface {
    points: PointSet,
    faces: Vec<Faces>,
}

impl Surface {
    /// The faces of a body, with two points a cell and axis, that look into a shape.
    fn new(body: &Shape, into: &Shape, grid: &GridSpec, plane: Plane) -> Self {
        let filling = Filling::new(body, grid, &[2; 3][..grid.min.len()], plane);
        let points = filling.points();
        let faces = filling.faces(into, &points);
        assert_eq!(filling.looks_into(into), !faces.is_empty());
        Self { points, faces }
    }

    /// Σ of a function of the centre of each face and of its area along each axis, outwards.
    fn sum(&self, of: impl Fn([f64; 3], [f64; 3]) -> f64) -> f64 {
        let on_side = |faces: &Faces| {
            let axis = faces.side.axis;
            let both = faces.points.iter().zip(&faces.areas);
            let values = both.map(|(p, face)| {
                let (mut at, mut area) = (self.points.positions[*p], [0.0; 3]);
                at[axis] -= 0.5 * faces.inwards() * self.points.spacing[axis];
                area[axis] = -faces.inwards() * face;
                of(at, area)
            });
            values.sum::<f64>()
        };
        self.faces.iter().map(on_side).sum()
    }

    fn total(&self, axis: usize) -> f64 {
        self.sum(|_, area| area[axis])
    }

    fn volume(&self) -> f64 {
        let numbers = 0..self.points.positions.len();
        numbers.map(|number| self.points.volume(number)).sum()
    }
}

#[test]
fn a_pressure_all_around_a_body_has_no_resultant_and_no_moment() {
    let slope = Polygon {
        points: vec![[0.1, 0.2], [2.9, 0.4], [1.3, 3.1]],
    };
    let bodies = [
        ball(&[0.3], 1.1),
        ball(&[0.3, 1.02], 1.3),
        ring(&[0.1, 0.2], 0.7, 1.9),
        Shape::Polygon(slope),
        cuboid(&[0.1, 0.2], &[1.47, 2.0]),
        ball(&[0.3, 0.7, 0.22], 0.9),
        ring(&[0.1, 0.2, 0.3], 0.5, 1.2),
    ];
    for body in &bodies {
        let dimension = body.bounds().min.len();
        let grid = grid(dimension, -4.0);
        let surface = Surface::new(body, &all(dimension), &grid, Plane::Strain);
        for axis in 0..dimension {
            assert!(surface.total(axis).abs() < 1e-12, "{body:?}");
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let moment = surface.sum(|at, area| at[a] * area[b] - at[b] * area[a]);
            assert!(moment.abs() < 1e-12, "{body:?}");
        }
    }
}

#[test]
fn a_pressure_all_around_a_body_is_the_pressure_in_it() {
    // the mean stress of a body at rest is −p ∮ x·n dA / (number of axes · V)
    let mean = |body: &Shape, grid: &GridSpec, plane: Plane, axes: f64| {
        let surface = Surface::new(body, &all(grid.min.len()), grid, plane);
        let work = surface.sum(|at, area| (0..3).map(|a| at[a] * area[a]).sum());
        work / (axes * surface.volume())
    };
    for dimension in 1..=3 {
        let grid = grid(dimension, -4.0);
        let center = &[0.1, 0.2, 0.3][..dimension];
        let axes = dimension as f64;
        for body in [ball(center, 1.1), ring(center, 0.6, 1.7)] {
            let found = mean(&body, &grid, Plane::Strain, axes);
            assert_relative_eq!(found, 1.0, max_relative = 1e-12);
        }
    }
    // rings of points around the axis, the third of the axes being the hoop
    for body in [ball(&[0.0, 1.5], 1.3), ring(&[2.0, 2.0], 0.6, 1.7)] {
        let found = mean(&body, &grid(2, 0.0), Plane::Axisymmetric, 3.0);
        assert_relative_eq!(found, 1.0, max_relative = 1e-12);
    }
}

#[test]
fn a_pressure_in_half_a_bore_has_the_resultant_of_its_width() {
    // the bore is 16 points wide
    let (center, inner) = ([0.25, 0.5], 1.0);
    let body = ring(&center, inner, 2.1);
    let upper_half = Shape::Difference(Difference {
        of: Box::new(ball(&center, inner)),
        minus: vec![cuboid(&[-9.0, -9.0], &[9.0, center[1]])],
    });
    let surface = Surface::new(&body, &upper_half, &grid(2, -4.0), Plane::Strain);
    assert!(surface.total(0).abs() < 1e-12);
    // away from the body is down
    assert_relative_eq!(surface.total(1), -2.0 * inner, max_relative = 1e-12);
    // a staircase is longer than the half circle
    let steps: f64 = surface.faces.iter().map(Faces::area).sum();
    assert_relative_eq!(steps, 4.0 * inner, max_relative = 1e-12);
    // the same bore in a block, 1 m long
    let bore = |from: f64, to: f64| {
        Shape::Cylinder(Cylinder {
            from: vec![center[0], center[1], from],
            to: vec![center[0], center[1], to],
            radius: inner,
        })
    };
    let block = Shape::Difference(Difference {
        of: Box::new(cuboid(&[-1.0, -1.0, 0.0], &[2.0, 2.0, 1.0])),
        minus: vec![bore(-1.0, 2.0)],
    });
    let upper_half = Shape::Difference(Difference {
        of: Box::new(bore(0.0, 1.0)),
        minus: vec![cuboid(&[-9.0, -9.0, -9.0], &[9.0, center[1], 9.0])],
    });
    let surface = Surface::new(&block, &upper_half, &grid(3, -4.0), Plane::Strain);
    assert!(surface.total(0).abs() < 1e-12 && surface.total(2).abs() < 1e-12);
    assert_relative_eq!(surface.total(1), -2.0 * inner, max_relative = 1e-12);
}

#[test]
fn a_slab_before_a_box_loads_the_side_that_on_side_loads() {
    let cases = [
        (vec![0.5], vec![1.3], Plane::Strain),
        (vec![0.0, 0.3], vec![1.07, 1.0], Plane::Strain),
        (vec![0.5, 0.3], vec![1.07, 1.0], Plane::Axisymmetric),
        (vec![0.1, 0.2, 0.3], vec![1.0, 0.7, 1.23], Plane::Strain),
    ];
    for (min, max, plane) in cases {
        let dimension = min.len();
        let (body, grid) = (cuboid(&min, &max), grid(dimension, 0.0));
        for side in sides(dimension) {
            let (mut low, mut high) = (vec![-9.0; dimension], vec![9.0; dimension]);
            if side.upper {
                low[side.axis] = max[side.axis];
            } else {
                high[side.axis] = min[side.axis];
            }
            let Surface { points, faces } = Surface::new(&body, &cuboid(&low, &high), &grid, plane);
            let [found] = &faces[..] else {
                panic!("{side:?} of {body:?}: {faces:?}")
            };
            let expected = points.selected(&LoadPlace::Region(Region::Side(side)));
            assert_eq!((found.side, &found.points), (side, &expected));
            for (area, p) in found.areas.iter().zip(&expected) {
                assert_relative_eq!(*area, points.side_area(*p, side), max_relative = 1e-13);
            }
        }
    }
}

#[test]
fn the_axis_of_a_body_of_revolution_is_no_surface() {
    let bodies = [cuboid(&[0.0, 0.5], &[1.0, 1.5]), ball(&[0.0, 1.5], 1.0)];
    for body in bodies {
        let surface = Surface::new(&body, &all(2), &grid(2, 0.0), Plane::Axisymmetric);
        let inner = surface
            .faces
            .iter()
            .find(|faces| faces.side.name() == "x_min");
        assert_eq!(inner, None);
        assert!(surface.total(1).abs() < 1e-12);
    }
}

#[test]
fn a_shape_that_a_surface_does_not_look_into_has_none_of_its_faces() {
    let body = ring(&[0.0, 0.0], 1.0, 2.0);
    let count = |into: &Shape| {
        let surface = Surface::new(&body, into, &grid(2, -4.0), Plane::Strain);
        surface.faces.iter().map(|f| f.points.len()).sum::<usize>()
    };
    // a circle of radius R crosses 2R/s columns and as many rows of points, each twice
    assert_eq!(count(&ball(&[0.0, 0.0], 1.0)), 8 * 8);
    assert_eq!(count(&ball(&[0.0, 0.0], 1.9)), 8 * 8);
    assert_eq!(count(&all(2)), 8 * 8 + 8 * 16);
    assert_eq!(count(&ball(&[0.0, 0.0], 0.8)), 0);
    assert_eq!(count(&ball(&[0.0, 1.5], 0.3)), 0);
}
