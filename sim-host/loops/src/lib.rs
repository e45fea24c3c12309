//! The event loops of the core, compiled once for each integrator and precision.
//!
//! A package of its own: its code is what a run spends its time in and is optimised most, while whatever calls it is built quickly and
//! anew with each change.

use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::method::closed_form::ClosedForm;
use sprag_shared::method::dense_output::Integrator;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::method::taylor::{TERMS, Taylor};
use sprag_shared::motion::hybrid::mode_output::{ModeIntegrator, Shaking};
use sprag_shared::motion::hybrid::series::Series;
use sprag_shared::motion::hybrid::{HybridState, HybridSystem, Progress};
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::observer::Observer;
use sprag_shared::motion::state::{BlockState, Limits, Stopped};

/// Terms of the power series in f32: more would only add rounding.
const TERMS_F32: usize = 12;

/// The event loop of ideal devices with its integrator.
pub trait IdealLoop<S: Real> {
    /// [`IdealSystem::advance`].
    ///
    /// # Errors
    /// Why the motion cannot be followed further.
    fn advance(
        &self,
        system: &IdealSystem<S>,
        state: &mut BlockState<S>,
        segment: &dyn GroundSegment<S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped>;
}

impl<S: Real, M: Integrator<S>> IdealLoop<S> for M {
    fn advance(
        &self,
        system: &IdealSystem<S>,
        state: &mut BlockState<S>,
        segment: &dyn GroundSegment<S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        system.advance(self, state, segment, duration, limits, observer)
    }
}

/// The event loop of devices with a memory with its integrator.
pub trait HybridLoop<S: Real> {
    /// [`HybridSystem::advance`].
    ///
    /// # Errors
    /// Why the motion cannot be followed further.
    fn advance(
        &self,
        system: &HybridSystem<S>,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped>;

    /// [`HybridSystem::step`].
    ///
    /// # Errors
    /// Why the motion cannot be followed further.
    fn step(
        &self,
        system: &HybridSystem<S>,
        state: &mut HybridState<S>,
        segment: (Shaking<'_, S>, S),
        progress: &mut Progress<S>,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped>;
}

impl<S: Real, T: ModeIntegrator<S>> HybridLoop<S> for T {
    fn step(
        &self,
        system: &HybridSystem<S>,
        state: &mut HybridState<S>,
        segment: (Shaking<'_, S>, S),
        progress: &mut Progress<S>,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        system.step(self, state, segment, progress, limits, observer)
    }

    fn advance(
        &self,
        system: &HybridSystem<S>,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        system.advance(self, state, shaking, duration, limits, observer)
    }
}

/// An integrator and its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method<S> {
    /// Power series in steps of their own choice: the last terms over the rotation that matters stay below this.
    Adaptive(S),
    /// Power series in steps of this length, s.
    Series(S),
    /// Fixed steps.
    Fixed(FixedStep<S>),
    /// Closed form of the slender block, with its step, s. Devices with a memory have none: Runge-Kutta steps in its place.
    ClosedForm(S),
}

/// The event loop of devices with a memory in f32, which has fixed steps only.
pub fn hybrid_f32(method: FixedStep<f32>) -> Box<dyn HybridLoop<f32>> {
    Box::new(method)
}

/// A precision for which the event loop of ideal devices is compiled: f64 and f32.
pub trait Precision: Real {
    /// The event loop of ideal devices by `method`.
    fn ideal(method: Method<Self>) -> Box<dyn IdealLoop<Self>>;
}

// Not generic, so that the loops are compiled here and not by whoever calls.
impl Precision for f64 {
    fn ideal(method: Method<f64>) -> Box<dyn IdealLoop<f64>> {
        ideal::<f64, TERMS>(method)
    }
}

impl Precision for f32 {
    fn ideal(method: Method<f32>) -> Box<dyn IdealLoop<f32>> {
        ideal::<f32, TERMS_F32>(method)
    }
}

fn ideal<S: Real, const N: usize>(method: Method<S>) -> Box<dyn IdealLoop<S>> {
    match method {
        Method::Adaptive(tolerance) => Box::new(Taylor::<S, N>::adaptive(tolerance)),
        Method::Series(step) => Box::new(Taylor::<S, N>::fixed(step)),
        Method::Fixed(method) => Box::new(method),
        Method::ClosedForm(step) => Box::new(ClosedForm { step }),
    }
}

/// The event loop of devices with a memory by `method`.
pub fn hybrid(method: Method<f64>) -> Box<dyn HybridLoop<f64>> {
    match method {
        Method::Adaptive(tolerance) => Box::new(Series::<f64, TERMS>::adaptive(tolerance)),
        Method::Series(step) => Box::new(Series::<f64, TERMS>::fixed(step)),
        Method::Fixed(method) => Box::new(method),
        Method::ClosedForm(step) => Box::new(FixedStep { scheme: Scheme::RungeKutta4, step }),
    }
}
