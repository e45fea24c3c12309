//! A method that counts its work.

use std::cell::Cell;

use sprag_shared::equation::motion::Motion;
use sprag_shared::math::scalar::Real;
use sprag_shared::math::sign::Sign;
use sprag_shared::method::dense_output::{DenseOutput, Integrator, StepStart};

/// Another method, counted: work is bounded by numbers of arcs and of looks at them, never by a clock.
#[derive(Debug, Default)]
pub struct Counted<M> {
    method: M,
    arcs: Cell<u64>,
    looks: Cell<u64>,
}

impl<M> Counted<M> {
    /// `method`, nothing counted yet.
    pub fn new(method: M) -> Counted<M> {
        Counted { method, arcs: Cell::new(0), looks: Cell::new(0) }
    }

    /// Arcs begun so far.
    pub fn arcs(&self) -> u64 {
        self.arcs.get()
    }

    /// Motions and switching functions asked for so far; of a fixed-step method each is a step taken.
    pub fn looks(&self) -> u64 {
        self.looks.get()
    }
}

/// The arc of a [`Counted`] method.
#[derive(Debug)]
pub struct CountedOutput<'c, A> {
    output: A,
    looks: &'c Cell<u64>,
}

impl<S: Real, A: DenseOutput<S>> DenseOutput<S> for CountedOutput<'_, A> {
    fn length(&self) -> S {
        self.output.length()
    }

    fn at(&self, time: S) -> Motion<S> {
        self.looks.set(self.looks.get() + 1);
        self.output.at(time)
    }

    fn switching(&self, time: S) -> S {
        self.looks.set(self.looks.get() + 1);
        self.output.switching(time)
    }

    fn acceleration_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        self.output.acceleration_zero(from, to, sign, from_zero)
    }

    fn switching_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        self.output.switching_zero(from, to, sign, from_zero)
    }

    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        self.output.largest_acceleration(from, to, floor)
    }
}

impl<S: Real, M: Integrator<S>> Integrator<S> for Counted<M> {
    type Output<'a>
        = CountedOutput<'a, M::Output<'a>>
    where
        Self: 'a;

    fn integrate<'a>(&'a self, start: &'a StepStart<'a, S>) -> Self::Output<'a> {
        self.arcs.set(self.arcs.get() + 1);
        CountedOutput { output: self.method.integrate(start), looks: &self.looks }
    }

    fn step(&self) -> Option<S> {
        self.method.step()
    }
}
