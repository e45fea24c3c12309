//! A tape of power series under construction: automatic differentiation for the equations of motion.
//!
//! A [`Node`] is a quantity of which the coefficients below some order are known. Evaluating an equation over nodes once
//! more, at the next order, extends every one of them by a coefficient (Jorba and Zou 2005).

use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::RECIPROCALS;
use super::scalar::Scalar;
use super::value::Value;

/// Largest number of coefficients that a tape may hold.
pub const MAXIMUM_ORDER: usize = 32;

/// Nodes that an equation of [`crate::equation`] may use.
pub const SLOTS: usize = 48;

/// Nodes that the largest device may use. A device has many equations, and each is a program of its own: on a tape this large the sums of
/// products are called, on others they are copied into the equation.
pub const DEVICE_SLOTS: usize = 136;

/// The coefficients of one order, of every quantity. Neighbouring orders of one quantity are kept apart on purpose: side by
/// side, compilers load two of them as one vector just after they were stored one by one, and the processor stalls.
type Order<S, const SLOTS: usize> = [Cell<S>; SLOTS];

/// Room for the series of one evaluation. Scratch space, not state: nothing is read before it is written.
pub struct Tape<S, const N: usize, const SLOTS: usize = { self::SLOTS }> {
    orders: [Order<S, SLOTS>; N],
}

impl<S: Scalar, const N: usize, const SLOTS: usize> Default for Tape<S, N, SLOTS> {
    fn default() -> Self {
        Tape { orders: core::array::from_fn(|_| core::array::from_fn(|_| Cell::new(S::of(0.0)))) }
    }
}

impl<S: Scalar, const N: usize, const SLOTS: usize> Tape<S, N, SLOTS> {
    /// Sets coefficient `order` of the given quantity `slot`.
    #[inline(always)]
    pub fn set(&self, slot: usize, order: usize, coefficient: S) {
        self.orders[order][slot].set(coefficient);
    }

    /// The given quantity `slot` at `order`; new nodes are counted in `next`, which the caller sets to the number of given
    /// quantities before each order.
    #[inline(always)]
    pub fn given<'t>(&'t self, next: &'t Cell<usize>, order: usize, slot: usize) -> Node<'t, S, N, SLOTS> {
        Node { tape: &self.orders, next, order, slot }
    }
}

/// One quantity of the equation on the tape.
#[derive(Clone, Copy)]
pub struct Node<'t, S, const N: usize, const SLOTS: usize = { self::SLOTS }> {
    tape: &'t [Order<S, SLOTS>; N],
    next: &'t Cell<usize>,
    order: usize,
    slot: usize,
}

impl<'t, S: Scalar, const N: usize, const SLOTS: usize> Node<'t, S, N, SLOTS> {
    /// Coefficients `from` up to and without `to`; `to` at most order + 1.
    #[inline(always)]
    fn run(&self, from: usize, to: usize) -> Run<'t, S, SLOTS> {
        Run { orders: &self.tape[from..to], slot: self.slot }
    }

    /// The coefficient of this order.
    #[inline(always)]
    pub fn last(&self) -> S {
        self.tape[self.order][self.slot].get()
    }

    /// Replaces the coefficient of this order.
    #[inline(always)]
    pub fn set_last(&self, coefficient: S) {
        self.tape[self.order][self.slot].set(coefficient);
    }

    /// The next free slot of the tape.
    #[inline(always)]
    fn fresh(&self) -> Self {
        let slot = self.next.get();
        self.next.set(slot + 1);
        Node { slot, ..*self }
    }

    /// A new node whose coefficient of this order is `coefficient`.
    #[inline(always)]
    fn node(&self, coefficient: S) -> Self {
        let node = self.fresh();
        node.tape[node.order][node.slot].set(coefficient);
        node
    }
}

/// Neighbouring coefficients of one quantity.
#[derive(Clone, Copy)]
struct Run<'t, S, const SLOTS: usize> {
    orders: &'t [Order<S, SLOTS>],
    slot: usize,
}

/// Σ a_j b_{n−1−j} over two runs of the same length n: one coefficient of a product. Called on tapes of [`DEVICE_SLOTS`], else inlined.
#[inline(always)]
fn convolve<S: Scalar, const SLOTS: usize>(a: Run<'_, S, SLOTS>, b: Run<'_, S, SLOTS>) -> S {
    if SLOTS == DEVICE_SLOTS { called_convolution(a, b) } else { convolution(a, b) }
}

#[inline(never)]
fn called_convolution<S: Scalar, const SLOTS: usize>(a: Run<'_, S, SLOTS>, b: Run<'_, S, SLOTS>) -> S {
    convolution(a, b)
}

#[inline(always)]
fn convolution<S: Scalar, const SLOTS: usize>(a: Run<'_, S, SLOTS>, b: Run<'_, S, SLOTS>) -> S {
    let mut sums = [S::of(0.0); 4];
    let (quads, rest) = a.orders.as_chunks::<4>();
    let (rest_b, quads_b) = b.orders.as_rchunks::<4>();
    for (x, y) in quads.iter().zip(quads_b.iter().rev()) {
        for lane in 0..4 {
            sums[lane] = sums[lane] + x[lane][a.slot].get() * y[3 - lane][b.slot].get();
        }
    }
    let mut sum = (sums[0] + sums[2]) + (sums[1] + sums[3]);
    for (x, y) in rest.iter().zip(rest_b.iter().rev()) {
        sum = sum + x[a.slot].get() * y[b.slot].get();
    }
    sum
}

/// [`convolve`] of one run with two others at once.
#[inline(always)]
fn convolve_both<S: Scalar, const SLOTS: usize>(a: Run<'_, S, SLOTS>, b: Run<'_, S, SLOTS>, c: Run<'_, S, SLOTS>) -> (S, S) {
    let (mut first, mut second) = ([S::of(0.0); 2], [S::of(0.0); 2]);
    let (pairs, rest) = a.orders.as_chunks::<2>();
    let (rest_b, pairs_b) = b.orders.as_rchunks::<2>();
    let (rest_c, pairs_c) = c.orders.as_rchunks::<2>();
    for ((x, y), z) in pairs.iter().zip(pairs_b.iter().rev()).zip(pairs_c.iter().rev()) {
        for lane in 0..2 {
            first[lane] = first[lane] + x[lane][a.slot].get() * y[1 - lane][b.slot].get();
            second[lane] = second[lane] + x[lane][a.slot].get() * z[1 - lane][c.slot].get();
        }
    }
    let (mut first, mut second) = (first[0] + first[1], second[0] + second[1]);
    for ((x, y), z) in rest.iter().zip(rest_b).zip(rest_c) {
        first = first + x[a.slot].get() * y[b.slot].get();
        second = second + x[a.slot].get() * z[c.slot].get();
    }
    (first, second)
}

/// Coefficient `n`, below the length of both, of the product of two power series.
pub fn product_coefficient(a: &[f64], b: &[f64], n: usize) -> f64 {
    a.iter().zip(b[..=n].iter().rev()).fold(0.0, |sum, (a, b)| sum + a * b)
}

macro_rules! termwise {
    ($operator:ident, $method:ident) => {
        impl<S: Scalar, const N: usize, const SLOTS: usize> $operator for Node<'_, S, N, SLOTS> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.node(self.last().$method(other.last()))
            }
        }
    };
}

termwise!(Add, add);
termwise!(Sub, sub);

impl<S: Scalar, const N: usize, const SLOTS: usize> Neg for Node<'_, S, N, SLOTS> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.node(-self.last())
    }
}

impl<S: Scalar, const N: usize, const SLOTS: usize> Mul for Node<'_, S, N, SLOTS> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.node(convolve(self.run(0, self.order + 1), other.run(0, self.order + 1)))
    }
}

impl<S: Scalar, const N: usize, const SLOTS: usize> Div for Node<'_, S, N, SLOTS> {
    type Output = Self;

    /// q_k = (a_k − Σ_{j=1..k} b_j q_{k−j}) / b_0.
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.fresh();
        let reciprocal = self.fresh();
        let k = self.order;
        if k == 0 {
            reciprocal.tape[0][reciprocal.slot].set(S::of(1.0) / other.last());
            quotient.tape[0][quotient.slot].set(self.last() / other.last());
        } else {
            let done = convolve(other.run(1, k + 1), quotient.run(0, k));
            let inverse = reciprocal.tape[0][reciprocal.slot].get();
            quotient.tape[k][quotient.slot].set((self.last() - done) * inverse);
        }
        quotient
    }
}

impl<S: Scalar, const N: usize, const SLOTS: usize> Value<S> for Node<'_, S, N, SLOTS> {
    #[inline(always)]
    fn scale(self, factor: S) -> Self {
        self.node(self.last() * factor)
    }

    #[inline(always)]
    fn offset(self, term: S) -> Self {
        self.node(if self.order == 0 { self.last() + term } else { self.last() })
    }

    #[inline(always)]
    fn square(self) -> Self {
        let k = self.order;
        let pairs = k.div_ceil(2);
        let twice = convolve(self.run(0, pairs), self.run(k + 1 - pairs, k + 1));
        let both = twice + twice;
        let middle = self.tape[k / 2][self.slot].get();
        self.node(if k.is_multiple_of(2) { both + middle * middle } else { both })
    }

    /// s' = x' c, c' = −x' s: k s_k = Σ j x_j c_{k−j}, k c_k = −Σ j x_j s_{k−j}.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine, rate) = (self.fresh(), self.fresh(), self.fresh());
        let k = self.order;
        if k == 0 {
            let (s, c) = self.last().sin_cos();
            sine.tape[0][sine.slot].set(s);
            cosine.tape[0][cosine.slot].set(c);
        } else {
            rate.tape[k][rate.slot].set(self.last() * S::of(k as f64));
            let reciprocal = S::of(RECIPROCALS[k & 63]);
            let (s, c) = convolve_both(rate.run(1, k + 1), cosine.run(0, k), sine.run(0, k));
            sine.tape[k][sine.slot].set(s * reciprocal);
            cosine.tape[k][cosine.slot].set(-(c * reciprocal));
        }
        (sine, cosine)
    }
}
