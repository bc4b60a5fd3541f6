//! What every condition promises.

use super::{Condition, ConditionChoice, Driven, Fixed, Node, Roller, Side, Wall};
use crate::input::{Expression, Unit};
use crate::math::Vector;

/// Every condition, in every variant that `D` dimensions have.
fn samples<const D: usize>() -> Vec<ConditionChoice> {
    let moving = Expression::parse(
        "x / 1 s + 2 m/s^2 * t",
        Unit::VELOCITY,
        &["x", "y", "z", "t"],
        &Default::default(),
    );
    let moving = moving.unwrap_or_else(|error| panic!("{error}"));
    let mut samples = vec![ConditionChoice::Fixed(Fixed)];
    for axis in 0..D {
        samples.push(ConditionChoice::Roller(Roller { normal: axis }));
        let mut velocity = vec![None; D];
        velocity[axis] = Some(moving.clone());
        samples.push(ConditionChoice::Driven(Driven { velocity }));
        for upper in [false, true] {
            samples.push(ConditionChoice::Wall(Wall {
                side: Side { axis, upper },
            }));
        }
    }
    samples.push(ConditionChoice::Driven(Driven {
        velocity: vec![Some(moving); D],
    }));
    for name in ConditionChoice::NAMES {
        assert!(
            samples.iter().any(|sample| sample.name() == *name),
            "no sample of {name}"
        );
    }
    samples
}

/// Velocities in all directions, at several nodes and times.
fn each<const D: usize>(check: impl Fn(&ConditionChoice, &dyn Condition<D>, Node<D>, Vector<D>)) {
    for choice in samples::<D>() {
        let condition = choice.build::<D>();
        for number in 0..200 {
            let noise = |k: usize| (f64::from(number) * 12.9898 + k as f64 * 78.233).sin();
            let node = Node {
                position: Vector::from_fn(|k, _| noise(k)),
                time: noise(7).abs(),
            };
            check(
                &choice,
                condition.as_ref(),
                node,
                Vector::from_fn(|k, _| 3.0 * noise(k + 3)),
            );
        }
    }
}

fn imposing_twice_is_imposing_once<const D: usize>() {
    each::<D>(|choice, condition, node, velocity| {
        let once = condition.impose(&node, &velocity);
        assert_eq!(condition.impose(&node, &once), once, "{choice:?}");
    });
}

fn a_component_that_changes_takes_the_velocity_of_the_wall<const D: usize>() {
    each::<D>(|choice, condition, node, velocity| {
        let (imposed, wall) = (
            condition.impose(&node, &velocity),
            condition.wall_velocity(&node),
        );
        for axis in 0..D {
            let kept = imposed[axis] == velocity[axis];
            assert!(
                kept || imposed[axis] == wall[axis],
                "{choice:?} on axis {axis}"
            );
        }
    });
}

fn the_wall_itself_may_move_as_it_does<const D: usize>() {
    each::<D>(|choice, condition, node, _| {
        let wall = condition.wall_velocity(&node);
        assert_eq!(condition.impose(&node, &wall), wall, "{choice:?}");
    });
}

#[test]
fn every_condition_keeps_its_promises_in_every_dimension() {
    imposing_twice_is_imposing_once::<1>();
    imposing_twice_is_imposing_once::<2>();
    imposing_twice_is_imposing_once::<3>();
    a_component_that_changes_takes_the_velocity_of_the_wall::<1>();
    a_component_that_changes_takes_the_velocity_of_the_wall::<2>();
    a_component_that_changes_takes_the_velocity_of_the_wall::<3>();
    the_wall_itself_may_move_as_it_does::<1>();
    the_wall_itself_may_move_as_it_does::<2>();
    the_wall_itself_may_move_as_it_does::<3>();
}

#[test]
fn a_roller_lets_slide_and_a_wall_lets_go() {
    let node = Node {
        position: Vector::<2>::zeros(),
        time: 0.0,
    };
    let velocity = Vector::<2>::new(-1.0, 2.0);
    assert_eq!(
        Roller { normal: 0 }.impose(&node, &velocity),
        Vector::<2>::new(0.0, 2.0)
    );
    let left = Wall {
        side: Side {
            axis: 0,
            upper: false,
        },
    };
    let right = Wall {
        side: Side {
            axis: 0,
            upper: true,
        },
    };
    assert_eq!(left.impose(&node, &velocity), Vector::<2>::new(0.0, 2.0));
    assert_eq!(right.impose(&node, &velocity), velocity);
}

#[test]
fn sides_have_their_names() {
    let names: Vec<_> = (0..6)
        .map(|k| {
            Side {
                axis: k / 2,
                upper: k % 2 == 1,
            }
            .name()
        })
        .collect();
    assert_eq!(names, Side::NAMES);
}
