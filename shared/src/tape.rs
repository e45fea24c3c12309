//! A tape of power series under construction: automatic differentiation for the equations of motion.
//!
//! A [`Node`] is a quantity of which the coefficients below some order are known. Evaluating an equation over nodes once
//! more, at the next order, extends every one of them by a coefficient (Jorba and Zou 2005).

use core::cell::Cell;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::math::RECIPROCALS;
use crate::scalar::Real;
use crate::value::Value;

/// Largest number of coefficients that a tape may hold.
pub const MAXIMUM_ORDER: usize = 32;

/// Nodes that an equation may use.
const SLOTS: usize = 48;

/// Room for the series of one evaluation. Scratch space, not state: nothing is read before it is written.
pub struct Tape<S, const N: usize> {
    slots: [[Cell<S>; N]; SLOTS],
}

impl<S: Real, const N: usize> Default for Tape<S, N> {
    fn default() -> Self {
        Tape { slots: core::array::from_fn(|_| core::array::from_fn(|_| Cell::new(S::ZERO))) }
    }
}

impl<S: Real, const N: usize> Tape<S, N> {
    /// Sets coefficient `order` of the given quantity `slot`.
    #[inline(always)]
    pub fn set(&self, slot: usize, order: usize, coefficient: S) {
        self.slots[slot][order].set(coefficient);
    }

    /// The given quantity `slot` at `order`; new nodes are counted in `next`, which the caller sets to the number of given
    /// quantities before each order.
    #[inline(always)]
    pub fn given<'t>(&'t self, next: &'t Cell<usize>, order: usize, slot: usize) -> Node<'t, S, N> {
        Node { tape: &self.slots, next, order, slot }
    }
}

/// One quantity of the equation on the tape.
pub struct Node<'t, S, const N: usize> {
    tape: &'t [[Cell<S>; N]; SLOTS],
    next: &'t Cell<usize>,
    order: usize,
    slot: usize,
}

impl<S, const N: usize> Clone for Node<'_, S, N> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, const N: usize> Copy for Node<'_, S, N> {}

impl<'t, S: Real, const N: usize> Node<'t, S, N> {
    /// Coefficients 0..=order.
    #[inline(always)]
    fn known(&self) -> &'t [Cell<S>] {
        &self.tape[self.slot][..=self.order]
    }

    /// The coefficient of this order.
    #[inline(always)]
    pub fn last(&self) -> S {
        self.tape[self.slot][self.order].get()
    }

    /// Replaces the coefficient of this order.
    #[inline(always)]
    pub fn set_last(&self, coefficient: S) {
        self.tape[self.slot][self.order].set(coefficient);
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
        node.tape[node.slot][node.order].set(coefficient);
        node
    }
}

/// Σ a_j b_{n−1−j} over two runs of the same length n: one coefficient of a product.
#[inline(always)]
fn convolve<S: Real>(a: &[Cell<S>], b: &[Cell<S>]) -> S {
    // Short steps need only the first few orders, where a loop costs more than its work.
    match (a, b) {
        ([a0], [b0]) => return a0.get() * b0.get(),
        ([a0, a1], [b0, b1]) => return a0.get() * b1.get() + a1.get() * b0.get(),
        ([a0, a1, a2], [b0, b1, b2]) => return a0.get() * b2.get() + a1.get() * b1.get() + a2.get() * b0.get(),
        ([a0, a1, a2, a3], [b0, b1, b2, b3]) => {
            return (a0.get() * b3.get() + a1.get() * b2.get()) + (a2.get() * b1.get() + a3.get() * b0.get());
        }
        _ => {}
    }
    let mut sums = [S::ZERO; 4];
    let (quads, rest) = a.as_chunks::<4>();
    let (rest_b, quads_b) = b.as_rchunks::<4>();
    for (x, y) in quads.iter().zip(quads_b.iter().rev()) {
        for lane in 0..4 {
            sums[lane] = sums[lane] + x[lane].get() * y[3 - lane].get();
        }
    }
    let mut sum = (sums[0] + sums[2]) + (sums[1] + sums[3]);
    for (x, y) in rest.iter().zip(rest_b.iter().rev()) {
        sum = sum + x.get() * y.get();
    }
    sum
}

/// [`convolve`] of one run with two others at once.
#[inline(always)]
fn convolve_both<S: Real>(a: &[Cell<S>], b: &[Cell<S>], c: &[Cell<S>]) -> (S, S) {
    if a.len() <= 4 {
        return (convolve(a, b), convolve(a, c));
    }
    let (mut first, mut second) = ([S::ZERO; 2], [S::ZERO; 2]);
    let (pairs, rest) = a.as_chunks::<2>();
    let (rest_b, pairs_b) = b.as_rchunks::<2>();
    let (rest_c, pairs_c) = c.as_rchunks::<2>();
    for ((x, y), z) in pairs.iter().zip(pairs_b.iter().rev()).zip(pairs_c.iter().rev()) {
        for lane in 0..2 {
            first[lane] = first[lane] + x[lane].get() * y[1 - lane].get();
            second[lane] = second[lane] + x[lane].get() * z[1 - lane].get();
        }
    }
    let (mut first, mut second) = (first[0] + first[1], second[0] + second[1]);
    for ((x, y), z) in rest.iter().zip(rest_b).zip(rest_c) {
        first = first + x.get() * y.get();
        second = second + x.get() * z.get();
    }
    (first, second)
}

macro_rules! termwise {
    ($operator:ident, $method:ident) => {
        impl<S: Real, const N: usize> $operator for Node<'_, S, N> {
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

impl<S: Real, const N: usize> Neg for Node<'_, S, N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.node(-self.last())
    }
}

impl<S: Real, const N: usize> Mul for Node<'_, S, N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.node(convolve(self.known(), other.known()))
    }
}

impl<S: Real, const N: usize> Div for Node<'_, S, N> {
    type Output = Self;

    /// q_k = (a_k − Σ_{j=1..k} b_j q_{k−j}) / b_0.
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let quotient = self.fresh();
        let reciprocal = self.fresh();
        let k = self.order;
        if k == 0 {
            reciprocal.tape[reciprocal.slot][0].set(S::ONE / other.last());
            quotient.tape[quotient.slot][0].set(self.last() / other.last());
        } else {
            let done = convolve(&other.known()[1..], &quotient.known()[..k]);
            let inverse = reciprocal.tape[reciprocal.slot][0].get();
            quotient.tape[quotient.slot][k].set((self.last() - done) * inverse);
        }
        quotient
    }
}

impl<S: Real, const N: usize> Value<S> for Node<'_, S, N> {
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
        let known = self.known();
        let pairs = k.div_ceil(2);
        let twice = convolve(&known[..pairs], &known[k + 1 - pairs..]);
        let both = twice + twice;
        self.node(if k.is_multiple_of(2) { both + known[k / 2].get() * known[k / 2].get() } else { both })
    }

    /// s' = x' c, c' = −x' s: k s_k = Σ j x_j c_{k−j}, k c_k = −Σ j x_j s_{k−j}.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine, rate) = (self.fresh(), self.fresh(), self.fresh());
        let k = self.order;
        if k == 0 {
            let (s, c) = self.last().sin_cos();
            sine.tape[sine.slot][0].set(s);
            cosine.tape[cosine.slot][0].set(c);
        } else {
            rate.tape[rate.slot][k].set(self.last() * S::count(k as u32));
            let reciprocal = S::of(RECIPROCALS[k & 63]);
            let rates = &rate.known()[1..];
            let (s, c) = convolve_both(rates, &cosine.known()[..k], &sine.known()[..k]);
            sine.tape[sine.slot][k].set(s * reciprocal);
            cosine.tape[cosine.slot][k].set(-(c * reciprocal));
        }
        (sine, cosine)
    }
}
