//! Run-time choice of the transmission.
//!
//! Only the steps of a method, which evaluate the device many times, are compiled for each kind
//! ([`crate::motion::hybrid::mode_output::ModeStart::known`]); the event loop is compiled once.

use super::clutch_state::{DeviceState, Guard, ModeCoefficients};
use super::elastic::ElasticPair;
use super::friction::FrictionPair;
use super::ideal::{Alone, IdealPair, Single};
use super::overrunning::OverrunningPair;
use super::rigid::RigidPair;
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EvaluationPoint, EventContext, Transmission, UNKNOWNS};
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Transmission of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyTransmission<S> {
    /// The block alone.
    Alone(Alone),
    /// One inerter, always engaged.
    Single(Single<S, false>),
    /// One inerter with friction, or on a guided rack.
    SingleWithFriction(Single<S, true>),
    /// The ideal clutched pair.
    Ideal(IdealPair<S, false>),
    /// The ideal clutched pair with friction, or on a guided rack.
    IdealWithFriction(IdealPair<S, true>),
    /// Rigid clutches.
    Rigid(RigidPair<S>),
    /// Overrunning clutches.
    Overrunning(OverrunningPair<S>),
    /// Friction clutches.
    Friction(FrictionPair<S>),
    /// Elastic clutches.
    Elastic(ElasticPair<S>),
}

/// Traits of a kind for the event loop ([`Transmission`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traits {
    /// [`Transmission::COMMANDED`].
    pub commanded: bool,
    /// [`Transmission::HOLDS`].
    pub holds: bool,
    /// [`Transmission::SPRINGS`].
    pub springs: bool,
    /// Unknowns of its own, at most [`UNKNOWNS`].
    pub unknowns: usize,
    /// Number of its guards.
    pub guards: usize,
}

/// `$then` for the `$transmission` in its own type.
macro_rules! each_transmission {
    ($any:expr, $transmission:ident => $then:expr) => {
        match $any {
            AnyTransmission::Alone($transmission) => $then,
            AnyTransmission::Single($transmission) => $then,
            AnyTransmission::SingleWithFriction($transmission) => $then,
            AnyTransmission::Ideal($transmission) => $then,
            AnyTransmission::IdealWithFriction($transmission) => $then,
            AnyTransmission::Rigid($transmission) => $then,
            AnyTransmission::Overrunning($transmission) => $then,
            AnyTransmission::Friction($transmission) => $then,
            AnyTransmission::Elastic($transmission) => $then,
        }
    };
}
pub(crate) use each_transmission;

/// The first `X` of the unknowns.
#[inline(always)]
pub fn first<S: Copy, const X: usize>(unknowns: &[S; UNKNOWNS]) -> [S; X] {
    core::array::from_fn(|i| unknowns[i % UNKNOWNS])
}

/// `X` unknowns, and zeros.
#[inline(always)]
pub fn padded<S: Real, const X: usize>(unknowns: &[S; X]) -> [S; UNKNOWNS] {
    core::array::from_fn(|i| unknowns.get(i).copied().unwrap_or(S::ZERO))
}

/// `at` with the unknowns of one kind.
fn of_kind<'a, S: Real, const X: usize>(at: &AnyPoint<'a, S, UNKNOWNS>) -> AnyPoint<'a, S, X> {
    let EvaluationPoint { body, law, configuration, velocity, ref unknowns, ground, clock } = *at;
    EvaluationPoint { body, law, configuration, velocity, unknowns: first(unknowns), ground, clock }
}

impl<S: Real> AnyTransmission<S> {
    /// Traits of the kind.
    #[inline]
    pub fn traits(&self) -> Traits {
        fn of<S: Real, D: Transmission<S, X, G>, const X: usize, const G: usize>(_: &D) -> Traits {
            Traits { commanded: D::COMMANDED, holds: D::HOLDS, springs: D::SPRINGS, unknowns: X, guards: G }
        }
        each_transmission!(self, transmission => of::<S, _, _, _>(transmission))
    }

    /// [`Transmission::law`].
    pub fn law(&self, direction: Sign, terminal_acceleration_sign: Sign, device: &DeviceState<S>) -> ModeCoefficients<S> {
        each_transmission!(self, kind => kind.law(direction, terminal_acceleration_sign, device))
    }

    /// [`Transmission::flow`], θ̈ alone.
    pub fn acceleration(&self, at: &AnyPoint<'_, S, UNKNOWNS>) -> S {
        each_transmission!(self, transmission => transmission.flow(&of_kind(at)).0)
    }

    /// [`Transmission::guard`].
    pub fn guard(&self, at: &AnyPoint<'_, S, UNKNOWNS>, acceleration: S, watch: Guard<S>) -> S {
        each_transmission!(self, transmission => transmission.guard(&of_kind(at), acceleration, watch))
    }

    /// [`Transmission::parameters`].
    #[inline]
    pub fn parameters(&self) -> Option<&ScaledParameters<S>> {
        each_transmission!(self, transmission => transmission.parameters())
    }

    /// [`Transmission::load`], and zeros.
    #[inline]
    pub fn load(&self, device: &DeviceState<S>) -> [S; UNKNOWNS] {
        each_transmission!(self, transmission => padded(&transmission.load(device)))
    }

    /// [`Transmission::store`].
    #[inline]
    pub fn store(&self, device: &mut DeviceState<S>, unknowns: &[S; UNKNOWNS], rack: S) {
        each_transmission!(self, transmission => transmission.store(device, &first(unknowns), rack));
    }

    /// [`Transmission::engage`].
    pub fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        each_transmission!(self, transmission => transmission.engage(at, wheel));
    }

    /// [`Transmission::release`].
    pub fn release(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        each_transmission!(self, transmission => transmission.release(at, wheel));
    }

    /// [`Transmission::reached`].
    pub fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        each_transmission!(self, transmission => transmission.reached(at, watch));
    }

    /// [`Transmission::settle`].
    pub fn settle(&self, at: &mut EventContext<'_, S>) {
        each_transmission!(self, transmission => transmission.settle(at));
    }

    /// [`Transmission::impact`].
    pub fn impact(&self, at: &mut EventContext<'_, S>, before: S) {
        each_transmission!(self, transmission => transmission.impact(at, before));
    }

    /// [`Transmission::engaged_at_impact`].
    pub fn engaged_at_impact(&self, device: &DeviceState<S>) -> usize {
        each_transmission!(self, transmission => transmission.engaged_at_impact(device))
    }

    /// [`Transmission::swing_coupling`].
    pub fn swing_coupling(&self, inward: bool) -> S {
        each_transmission!(self, transmission => transmission.swing_coupling(inward))
    }

    /// [`Transmission::account`].
    pub fn account(&self, at: &AnyPoint<'_, S, UNKNOWNS>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        each_transmission!(self, transmission => transmission.account(&of_kind(at), acceleration, device))
    }
}
