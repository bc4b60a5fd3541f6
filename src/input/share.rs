//! Formulas say the same thing many times over: each repeated part of a program is computed once and kept.

use super::expression::{Op, SLOTS};
use std::collections::HashMap;

/// Two instructions that compute the same from the same operands have equal keys.
type Key = (u8, u64, usize, usize);

/// The same program, in which a part that occurs again is recalled instead of computed again. No value changes by a bit.
pub(super) fn share(program: &[Op]) -> Vec<Op> {
    let Parts { of, uses } = parts(program);
    let mut slots: HashMap<usize, u8> = HashMap::new();
    let mut shared: Vec<Op> = Vec::with_capacity(program.len());
    // where the instructions for each waiting value begin
    let mut starts: Vec<usize> = Vec::new();
    for (op, &part) in program.iter().zip(&of) {
        let start = match op {
            Op::One(_) => starts.pop(),
            Op::Two(_) => {
                starts.pop();
                starts.pop()
            }
            _ => None,
        };
        let start = start.unwrap_or(shared.len());
        starts.push(start);
        if let Some(&slot) = slots.get(&part) {
            // all of its own parts were computed the first time, so that nothing kept is lost here
            shared.truncate(start);
            shared.push(Op::Recall(slot));
            continue;
        }
        shared.push(*op);
        let leaf = matches!(op, Op::Push(_) | Op::Load(_));
        if !leaf && uses[part] > 1 && slots.len() < SLOTS {
            let slot = slots.len() as u8;
            slots.insert(part, slot);
            shared.push(Op::Keep(slot));
        }
    }
    shared
}

/// Which part of a formula each instruction completes, and by how many others each part is used.
struct Parts {
    of: Vec<usize>,
    uses: Vec<usize>,
}

fn parts(program: &[Op]) -> Parts {
    let mut known: HashMap<Key, usize> = HashMap::new();
    let mut uses: Vec<usize> = Vec::new();
    let mut of = Vec::with_capacity(program.len());
    let mut stack: Vec<usize> = Vec::new();
    for op in program {
        let mut take = || stack.pop().unwrap_or_default();
        let (key, operands) = match *op {
            Op::Push(value) => ((0, value.to_bits(), 0, 0), vec![]),
            Op::Load(number) => ((1, u64::from(number), 0, 0), vec![]),
            Op::One(function) => {
                let a = take();
                ((2, function as u64, a, 0), vec![a])
            }
            Op::Two(function) => {
                let (b, a) = (take(), take());
                ((3, function as u64, a, b), vec![a, b])
            }
            Op::Keep(slot) | Op::Recall(slot) => ((4, u64::from(slot), 0, 0), vec![]),
        };
        let part = *known.entry(key).or_insert_with(|| {
            // a part inside a repeated one is used once: it will not be computed again anyway
            operands.iter().for_each(|&operand| uses[operand] += 1);
            uses.push(0);
            uses.len() - 1
        });
        of.push(part);
        stack.push(part);
    }
    Parts { of, uses }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::expression::{One, Two};

    #[test]
    fn a_repeated_part_is_computed_once() {
        // (sin x * sin x) + sin x
        let sine = [Op::Load(0), Op::One(One::Sin)];
        let mut program = [sine, sine].concat();
        program.push(Op::Two(Two::Multiply));
        program.extend(sine);
        program.push(Op::Two(Two::Add));
        let expected = [
            Op::Load(0),
            Op::One(One::Sin),
            Op::Keep(0),
            Op::Recall(0),
            Op::Two(Two::Multiply),
            Op::Recall(0),
            Op::Two(Two::Add),
        ];
        assert_eq!(share(&program), expected);
    }

    #[test]
    fn what_is_not_repeated_stays_as_it_is() {
        let program = [
            Op::Load(0),
            Op::Push(2.0),
            Op::Two(Two::Power),
            Op::Load(1),
            Op::Two(Two::Add),
        ];
        assert_eq!(share(&program), program);
    }
}
