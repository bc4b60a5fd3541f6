//! What is stored, point by point, of the things that laws compute with.

use super::{Deformation, Kinematics, Stress};
use crate::real::{MOST_LANES, Real};
use crate::tensor::Tensor;

/// Something that consists of numbers, always of the same count.
///
/// What a law remembers of a point is made of these: `()`, one number, a [`Tensor`], a [`Deformation`], or pairs of them.
pub trait Numbers<R: Real>: Copy {
    /// How many, at most [`MOST`].
    const COUNT: usize;

    /// From that many numbers.
    fn from_numbers(numbers: &[R]) -> Self;

    /// The numbers, in the same order.
    fn to_numbers(&self, numbers: &mut [R]);
}

/// The most numbers that something may consist of.
pub const MOST: usize = 48;

impl<R: Real> Numbers<R> for () {
    const COUNT: usize = 0;
    #[inline(always)]
    fn from_numbers(_: &[R]) {}
    #[inline(always)]
    fn to_numbers(&self, _: &mut [R]) {}
}

impl<R: Real> Numbers<R> for R {
    const COUNT: usize = 1;
    #[inline(always)]
    fn from_numbers(numbers: &[R]) -> R {
        numbers[0]
    }
    #[inline(always)]
    fn to_numbers(&self, numbers: &mut [R]) {
        numbers[0] = *self;
    }
}

impl<R: Real, const D: usize> Numbers<R> for Tensor<R, D> {
    const COUNT: usize = D * D;
    #[inline(always)]
    fn from_numbers(numbers: &[R]) -> Self {
        let mut tensor = Self::zero();
        for i in 0..D {
            for j in 0..D {
                tensor[(i, j)] = numbers[i * D + j];
            }
        }
        tensor
    }
    #[inline(always)]
    fn to_numbers(&self, numbers: &mut [R]) {
        for i in 0..D {
            for j in 0..D {
                numbers[i * D + j] = self[(i, j)];
            }
        }
    }
}

impl<R: Real, A: Numbers<R>, B: Numbers<R>> Numbers<R> for (A, B) {
    const COUNT: usize = A::COUNT + B::COUNT;
    #[inline(always)]
    fn from_numbers(numbers: &[R]) -> Self {
        let (a, b) = numbers.split_at(A::COUNT);
        (A::from_numbers(a), B::from_numbers(b))
    }
    #[inline(always)]
    fn to_numbers(&self, numbers: &mut [R]) {
        let (a, b) = numbers.split_at_mut(A::COUNT);
        self.0.to_numbers(a);
        self.1.to_numbers(b);
    }
}

/// Implements [`Numbers`] for a struct of numbers and tensors.
macro_rules! numbers {
    ($name:ident { $($field:ident: $kind:ty),* }) => {
        impl<R: Real, const D: usize> Numbers<R> for $name<R, D> {
            const COUNT: usize = 0 $(+ <$kind as Numbers<R>>::COUNT)*;
            #[inline(always)]
            fn from_numbers(numbers: &[R]) -> Self {
                $(let ($field, numbers) = numbers.split_at(<$kind as Numbers<R>>::COUNT);)*
                let _ = numbers;
                Self { $($field: Numbers::from_numbers($field)),* }
            }
            #[inline(always)]
            fn to_numbers(&self, numbers: &mut [R]) {
                $(
                    let (part, numbers) = numbers.split_at_mut(<$kind as Numbers<R>>::COUNT);
                    self.$field.to_numbers(part);
                )*
                let _ = numbers;
            }
        }
    };
}

numbers!(Deformation { displacement_gradient: Tensor<R, D>, transverse: R });
numbers!(Stress { plane: Tensor<R, D>, transverse: R });
numbers!(Kinematics { rate: Tensor<R, D>, hoop_rate: R, hoop_stretch: R, dt: R });

/// Applies a function of one point to each point that `arguments` hold: the way for a law with loops or branches that
/// points cannot take together.
#[inline(always)]
pub fn one_by_one<R, A, B, A1, B1>(arguments: &A, function: impl Fn(A1) -> B1) -> B
where
    R: Real,
    A: Numbers<R>,
    B: Numbers<R>,
    A1: Numbers<f64>,
    B1: Numbers<f64>,
{
    const { assert!(A::COUNT == A1::COUNT && B::COUNT == B1::COUNT) };
    const { assert!(A::COUNT <= MOST && B::COUNT <= MOST) };
    let mut numbers = [R::splat(0.0); MOST];
    let (mut given, mut found) = ([0.0; MOST_LANES * MOST], [0.0; MOST_LANES * MOST]);
    arguments.to_numbers(&mut numbers[..A::COUNT]);
    R::write_rows(&mut given[..R::LANES * A::COUNT], &numbers[..A::COUNT]);
    for k in 0..R::LANES {
        let result = function(A1::from_numbers(&given[k * A::COUNT..][..A::COUNT]));
        result.to_numbers(&mut found[k * B::COUNT..][..B::COUNT]);
    }
    R::read_rows(&found[..R::LANES * B::COUNT], &mut numbers[..B::COUNT]);
    B::from_numbers(&numbers[..B::COUNT])
}
