//! What every condition promises.

use super::{
    Condition, ConditionChoice, ConditionParameters, Driven, Fixed, Node, Place, Roller, Side, Wall,
};
use crate::input::{Expression, Reader, Unit};
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

fn what_stands_still_sets_nothing_in_motion<const D: usize>() {
    each::<D>(|choice, condition, node, _| {
        let rest = Vector::zeros();
        if choice.stands_still() {
            assert_eq!(condition.impose(&node, &rest), rest, "{choice:?}");
            assert_eq!(condition.wall_velocity(&node), rest, "{choice:?}");
        }
    });
}

fn what_is_uniform_acts_the_same_all_along_an_axis<const D: usize>() {
    each::<D>(|choice, condition, node, mut velocity| {
        for axis in (0..D).filter(|axis| choice.is_uniform_along(*axis)) {
            velocity[axis] = 0.0;
            let here = condition.impose(&node, &velocity);
            assert_eq!(here[axis], 0.0, "{choice:?} along {axis}");
            let mut other = node;
            other.position[axis] += 1.5;
            assert_eq!(condition.impose(&other, &velocity), here, "{choice:?}");
        }
    });
}

fn the_image_of_a_condition_acts_on_the_image_of_a_motion<const D: usize>() {
    each::<D>(|choice, condition, node, velocity| {
        for axis in 0..D {
            let Some(image) = choice.mirrored(axis) else {
                continue;
            };
            assert_eq!(image.mirrored(axis).as_ref(), Some(choice));
            let reflect = |mut v: Vector<D>| {
                v[axis] *= -1.0;
                v
            };
            let mut there = node;
            there.position[axis] = 0.7 - node.position[axis];
            let found = image.build::<D>().impose(&there, &reflect(velocity));
            let expected = reflect(condition.impose(&node, &velocity));
            assert_eq!(found, expected, "{choice:?} across {axis}");
        }
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
    what_stands_still_sets_nothing_in_motion::<1>();
    what_stands_still_sets_nothing_in_motion::<2>();
    what_stands_still_sets_nothing_in_motion::<3>();
    what_is_uniform_acts_the_same_all_along_an_axis::<1>();
    what_is_uniform_acts_the_same_all_along_an_axis::<2>();
    what_is_uniform_acts_the_same_all_along_an_axis::<3>();
    the_image_of_a_condition_acts_on_the_image_of_a_motion::<1>();
    the_image_of_a_condition_acts_on_the_image_of_a_motion::<2>();
    the_image_of_a_condition_acts_on_the_image_of_a_motion::<3>();
}

#[test]
fn a_condition_that_says_no_more_gives_no_advice() {
    struct New;
    impl ConditionParameters for New {
        fn read(_: &mut Reader<'_>, _: &Place) -> Option<Self> {
            Some(Self)
        }
    }
    for axis in 0..3 {
        assert!(!New.is_uniform_along(axis) && New.mirrored(axis).is_none());
    }
    assert!(!New.stands_still() && !New.is_one_sided());
}

#[test]
fn what_is_known_of_each_condition() {
    let facts = samples::<2>().into_iter().map(|choice| {
        let across = [0, 1].map(|axis| choice.is_uniform_along(axis));
        let images = [0, 1].map(|axis| choice.mirrored(axis).is_some());
        let name = choice.name();
        (
            name,
            across,
            images,
            choice.stands_still(),
            choice.is_one_sided(),
        )
    });
    // the velocity that is given to the driven ones grows with x
    let expected = [
        ("fixed", [true, true], [true, true], true, false),
        ("roller", [false, true], [true, true], true, false),
        ("driven", [false, true], [false, true], false, false),
        ("wall", [false, true], [true, true], true, true),
        ("wall", [false, true], [true, true], true, true),
        ("roller", [true, false], [true, true], true, false),
        ("driven", [false, false], [false, false], false, false),
        ("wall", [true, false], [true, true], true, true),
        ("wall", [true, false], [true, true], true, true),
        ("driven", [false, false], [false, false], false, false),
    ];
    assert!(facts.eq(expected));
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
