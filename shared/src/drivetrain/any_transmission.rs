//! Run-time choice of the transmission.
//!
//! Only the steps of a method, which evaluate the device many times, are compiled for each kind
//! ([`crate::motion::hybrid::mode_output::ModeStart::known`]); the event loop is compiled once.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients, UNKNOWNS};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{Account, AnyPoint, EvaluationPoint, EventContext, Transmission, first};
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Transmission of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnyTransmission<S> {
    /// Kind.
    pub kind: TransmissionKind,
    /// Parameters.
    pub parameters: ScaledParameters<S>,
}

/// Kind of a transmission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransmissionKind {
    /// The block alone.
    Alone,
    /// One inerter, always engaged.
    Single,
    /// One inerter with friction, or on a guided rack.
    SingleWithFriction,
    /// One inerter on a support that moves otherwise than the ground.
    SingleOnSupport,
    /// The ideal clutched pair.
    Ideal,
    /// The ideal clutched pair with friction, or on a guided rack.
    IdealWithFriction,
    /// The ideal clutched pair on a support that moves otherwise than the ground.
    IdealOnSupport,
    /// Rigid clutches.
    Rigid,
    /// Overrunning clutches.
    Overrunning,
    /// Friction clutches.
    Friction,
    /// Elastic clutches.
    Elastic,
    /// One inerter, with friction that grows with load.
    LoadedSingle,
    /// The ideal clutched pair, likewise.
    LoadedIdeal,
    /// Rigid clutches, likewise.
    LoadedRigid,
    /// One inerter with viscous slip between rack and flywheel.
    ViscousSingle,
    /// Clutches with viscous slip.
    Viscous,
    /// Rigid clutches with drag while they are open.
    DraggedRigid,
    /// Friction clutches, likewise.
    DraggedFriction,
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
    /// [`Transmission::THROUGH_IMPACTS`].
    pub through_impacts: bool,
    /// [`Transmission::PERMANENT`].
    pub permanent: bool,
    /// [`Transmission::ON_SUPPORT`].
    pub on_support: bool,
    /// Unknowns of its own, at most [`UNKNOWNS`].
    pub unknowns: usize,
    /// Number of its guards.
    pub guards: usize,
}

/// `$then` for the transmission of `$kind` in its own type, or in the one that is given for it last.
macro_rules! match_transmission {
    ($kind:expr, $transmission:ident => $then:expr; $($($alias:ident)|+ => $type:expr,)+) => {{
        use crate::drivetrain::{any_transmission::TransmissionKind, elastic, ideal, load_friction, overrunning};
        macro_rules! known {
            ($known:expr) => {{
                let $transmission = &$known;
                $then
            }};
        }
        match $kind {
            TransmissionKind::Alone => known!(ideal::Alone),
            TransmissionKind::Single => known!(ideal::Single::<false>),
            TransmissionKind::Ideal => known!(ideal::IdealPair::<false>),
            TransmissionKind::Overrunning => known!(overrunning::OverrunningPair),
            TransmissionKind::Elastic => known!(elastic::ElasticPair),
            TransmissionKind::LoadedRigid => known!(load_friction::Loaded($crate::drivetrain::rigid::RigidPair)),
            $($(TransmissionKind::$alias)|+ => known!($type),)+
        }
    }};
}
pub(crate) use match_transmission;

/// `$then` for the transmission of `$kind` in its own type. At events a drag of zero changes nothing, so that clutches without share them.
macro_rules! each_transmission {
    ($kind:expr, $transmission:ident => $then:expr) => {
        $crate::drivetrain::any_transmission::match_transmission!($kind, $transmission => $then;
            SingleWithFriction => $crate::drivetrain::ideal::Single::<true>,
            IdealWithFriction => $crate::drivetrain::ideal::IdealPair::<true>,
            SingleOnSupport => $crate::drivetrain::on_support::OnSupport::<false>,
            IdealOnSupport => $crate::drivetrain::on_support::OnSupport::<true>,
            LoadedSingle => $crate::drivetrain::load_friction::Loaded($crate::drivetrain::ideal::Single::<true>),
            LoadedIdeal => $crate::drivetrain::load_friction::Loaded($crate::drivetrain::ideal::IdealPair::<true>),
            ViscousSingle => $crate::drivetrain::viscous::DashpotPair::<true, true>,
            Viscous => $crate::drivetrain::viscous::DashpotPair::<true, false>,
            Rigid | DraggedRigid => $crate::drivetrain::viscous::DashpotPair::<false, false>,
            Friction | DraggedFriction => $crate::drivetrain::friction::FrictionPair::<true>,
        )
    };
}

/// The same for what flow and guards alone decide, as in steps: kinds with dashpots ([`super::dashpot`]) have them in common, and so have a
/// single inerter and a pair whose clutches only lock.
macro_rules! each_flow {
    ($kind:expr, $transmission:ident => $then:expr) => {
        $crate::drivetrain::any_transmission::match_transmission!($kind, $transmission => $then;
            SingleWithFriction | IdealWithFriction => $crate::drivetrain::ideal::IdealPair::<true>,
            SingleOnSupport | IdealOnSupport => $crate::drivetrain::on_support::OnSupport::<true>,
            LoadedSingle | LoadedIdeal => $crate::drivetrain::load_friction::Loaded($crate::drivetrain::ideal::IdealPair::<true>),
            Rigid => $crate::drivetrain::rigid::RigidPair,
            Friction => $crate::drivetrain::friction::FrictionPair::<false>,
            ViscousSingle | Viscous | DraggedRigid | DraggedFriction => $crate::drivetrain::viscous::DashpotPair::<true, false>,
        )
    };
}
pub(crate) use each_flow;

/// `at` with the unknowns of one kind.
fn of_kind<'a, S: Real, const X: usize>(at: &AnyPoint<'a, S, UNKNOWNS>) -> AnyPoint<'a, S, X> {
    let EvaluationPoint { body, parameters, law, configuration, velocity, ref unknowns, ground, clock } = *at;
    EvaluationPoint { body, parameters, law, configuration, velocity, unknowns: first(unknowns), ground, clock }
}

impl<S: Real> AnyTransmission<S> {
    /// Traits of the kind.
    pub fn traits(&self) -> Traits {
        fn of<S: Real, D: Transmission<S, X, G>, const X: usize, const G: usize>(_: &D) -> Traits {
            Traits {
                commanded: D::COMMANDED,
                holds: D::HOLDS,
                springs: D::SPRINGS,
                through_impacts: D::THROUGH_IMPACTS,
                permanent: D::PERMANENT,
                on_support: D::ON_SUPPORT,
                unknowns: X,
                guards: G,
            }
        }
        each_transmission!(self.kind, transmission => of::<S, _, _, _>(transmission))
    }

    /// Engaged flywheels slip viscously.
    pub fn slips_viscously(&self) -> bool {
        matches!(self.kind, TransmissionKind::ViscousSingle | TransmissionKind::Viscous)
    }

    /// How the flywheel of a device without a clutch hangs on the rack.
    pub fn permanent_link(&self) -> Coupling {
        if self.slips_viscously() { Coupling::Viscous } else { Coupling::Locked }
    }

    /// [`Transmission::law`].
    pub fn law(&self, direction: Sign, terminal_acceleration_sign: Sign, device: &DeviceState<S>) -> ModeCoefficients<S> {
        let mut law = ModeCoefficients::of(direction);
        self.complete(&mut law, terminal_acceleration_sign, device);
        law
    }

    /// [`Transmission::complete`].
    pub fn complete(&self, law: &mut ModeCoefficients<S>, terminal_acceleration_sign: Sign, device: &DeviceState<S>) {
        let parameters = &self.parameters;
        each_transmission!(self.kind, kind => kind.complete(law, parameters, terminal_acceleration_sign, device));
    }

    /// [`Transmission::flow`], θ̈ alone.
    pub fn acceleration(&self, at: &AnyPoint<'_, S, UNKNOWNS>) -> S {
        each_flow!(self.kind, transmission => transmission.flow(&of_kind(at)).0)
    }

    /// [`Transmission::guard`].
    pub fn guard(&self, at: &AnyPoint<'_, S, UNKNOWNS>, acceleration: S, watch: Guard<S>) -> S {
        each_flow!(self.kind, transmission => transmission.guard(&of_kind(at), acceleration, watch))
    }

    /// [`Transmission::engage`].
    pub fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        each_transmission!(self.kind, transmission => transmission.engage(at, wheel));
    }

    /// [`Transmission::reached`].
    pub fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        each_transmission!(self.kind, transmission => transmission.reached(at, watch));
    }

    /// [`Transmission::settle`].
    pub fn settle(&self, at: &mut EventContext<'_, S>) {
        each_transmission!(self.kind, transmission => transmission.settle(at));
    }

    /// [`Transmission::impact`].
    pub fn impact(&self, at: &mut EventContext<'_, S>, before: S) {
        each_transmission!(self.kind, transmission => transmission.impact(at, before));
    }

    /// [`Transmission::account`].
    pub fn account(&self, at: &AnyPoint<'_, S, UNKNOWNS>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        each_transmission!(self.kind, transmission => transmission.account(&of_kind(at), acceleration, device))
    }
}
