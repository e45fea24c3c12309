//! A kind of device chosen at run time.
//!
//! The event loop asks a device one thing at an event and need not know which kind it is; only the steps of a method, which evaluate it
//! many times, are compiled for each ([`crate::motion::hybrid::path::PathStart::known`]). So there is one event loop, not one for each device.

use super::clutch_state::{Device, Law, Watch};
use super::drive::{Account, AnyMoment, Drive, Instant, Moment, UNKNOWNS};
use super::elastic::ElasticPair;
use super::friction::FrictionPair;
use super::gears::Gears;
use super::ideal::{Alone, IdealPair, Single};
use super::overrunning::OverrunningPair;
use super::rigid::RigidPair;
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// One of the kinds of device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyDrive<S> {
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

/// What the event loop needs to know of a kind ([`Drive`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traits {
    /// [`Drive::COMMANDED`].
    pub commanded: bool,
    /// [`Drive::HOLDS`].
    pub holds: bool,
    /// [`Drive::SPRINGS`].
    pub springs: bool,
    /// Unknowns of its own, at most [`UNKNOWNS`].
    pub unknowns: usize,
    /// Functions that it watches.
    pub guards: usize,
}

/// `$then` for the `$drive` in its own type.
macro_rules! each_drive {
    ($any:expr, $drive:ident => $then:expr) => {
        match $any {
            AnyDrive::Alone($drive) => $then,
            AnyDrive::Single($drive) => $then,
            AnyDrive::SingleWithFriction($drive) => $then,
            AnyDrive::Ideal($drive) => $then,
            AnyDrive::IdealWithFriction($drive) => $then,
            AnyDrive::Rigid($drive) => $then,
            AnyDrive::Overrunning($drive) => $then,
            AnyDrive::Friction($drive) => $then,
            AnyDrive::Elastic($drive) => $then,
        }
    };
}
pub(crate) use each_drive;

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
fn of_kind<'a, S: Real, const X: usize>(at: &AnyMoment<'a, S, UNKNOWNS>) -> AnyMoment<'a, S, X> {
    let Moment { body, law, posture, velocity, ref extra, ground, clock } = *at;
    Moment { body, law, posture, velocity, extra: first(extra), ground, clock }
}

impl<S: Real> AnyDrive<S> {
    /// What kind of device it is.
    #[inline]
    pub fn traits(&self) -> Traits {
        fn of<S: Real, D: Drive<S, X, G>, const X: usize, const G: usize>(_: &D) -> Traits {
            Traits { commanded: D::COMMANDED, holds: D::HOLDS, springs: D::SPRINGS, unknowns: X, guards: G }
        }
        each_drive!(self, drive => of::<S, _, _, _>(drive))
    }

    /// [`Drive::law`].
    pub fn law(&self, direction: Sign, drive: Sign, device: &Device<S>) -> Law<S> {
        each_drive!(self, kind => kind.law(direction, drive, device))
    }

    /// [`Drive::flow`], θ̈ alone.
    pub fn acceleration(&self, at: &AnyMoment<'_, S, UNKNOWNS>) -> S {
        each_drive!(self, drive => drive.flow(&of_kind(at)).0)
    }

    /// [`Drive::guard`].
    pub fn guard(&self, at: &AnyMoment<'_, S, UNKNOWNS>, acceleration: S, watch: Watch<S>) -> S {
        each_drive!(self, drive => drive.guard(&of_kind(at), acceleration, watch))
    }

    /// [`Drive::gears`].
    #[inline]
    pub fn gears(&self) -> Option<&Gears<S>> {
        each_drive!(self, drive => drive.gears())
    }

    /// [`Drive::load`], and zeros.
    #[inline]
    pub fn load(&self, device: &Device<S>) -> [S; UNKNOWNS] {
        each_drive!(self, drive => padded(&drive.load(device)))
    }

    /// [`Drive::store`].
    #[inline]
    pub fn store(&self, device: &mut Device<S>, unknowns: &[S; UNKNOWNS], rack: S) {
        each_drive!(self, drive => drive.store(device, &first(unknowns), rack));
    }

    /// [`Drive::engage`].
    pub fn engage(&self, at: &mut Instant<'_, S>, wheel: usize) {
        each_drive!(self, drive => drive.engage(at, wheel));
    }

    /// [`Drive::release`].
    pub fn release(&self, at: &mut Instant<'_, S>, wheel: usize) {
        each_drive!(self, drive => drive.release(at, wheel));
    }

    /// [`Drive::reached`].
    pub fn reached(&self, at: &mut Instant<'_, S>, watch: Watch<S>) {
        each_drive!(self, drive => drive.reached(at, watch));
    }

    /// [`Drive::settle`].
    pub fn settle(&self, at: &mut Instant<'_, S>) {
        each_drive!(self, drive => drive.settle(at));
    }

    /// [`Drive::impact`].
    pub fn impact(&self, at: &mut Instant<'_, S>, before: S) {
        each_drive!(self, drive => drive.impact(at, before));
    }

    /// [`Drive::engaged_at_impact`].
    pub fn engaged_at_impact(&self, device: &Device<S>) -> usize {
        each_drive!(self, drive => drive.engaged_at_impact(device))
    }

    /// [`Drive::swing_coupling`].
    pub fn swing_coupling(&self, inward: bool) -> S {
        each_drive!(self, drive => drive.swing_coupling(inward))
    }

    /// [`Drive::account`].
    pub fn account(&self, at: &AnyMoment<'_, S, UNKNOWNS>, acceleration: S, device: &Device<S>) -> Account<S> {
        each_drive!(self, drive => drive.account(&of_kind(at), acceleration, device))
    }
}
