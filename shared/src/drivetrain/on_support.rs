//! Ideal devices on a support that moves otherwise than the ground.
//!
//! A flywheel turns with the rack on its support, at v = ℓθ̇ − z where z is the speed that the support has gained on the ground, as that
//! of the terminals over R: ż = n (ü_s − ü_g)/R through a pulley n. So Eq. 10 reads v̇ v > 0 here, also while the block stands.

use super::clutch_state::{DeviceState, Guard, ModeCoefficients, Push};
use super::scaled_parameters::ScaledParameters;
use super::transmission::{EventContext, PointOf, Transmission, driving_moment};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// The clutched pair, or with `PAIR` false one inerter that is always engaged.
pub struct OnSupport<const PAIR: bool>;

/// ż.
#[inline(always)]
fn support_acceleration<S: Real, V: Value<S>, B: Body<S>>(at: &PointOf<'_, S, B, V, 1>) -> V {
    let [ground, support] = at.parameters.support_rates();
    at.ground[0].scale(ground) + at.ground[2].scale(support)
}

impl<S: Real, const PAIR: bool> Transmission<S, 1, 2> for OnSupport<PAIR> {
    const COMMANDED: bool = PAIR;
    const HOLDS: bool = false;
    const THROUGH_IMPACTS: bool = !PAIR;
    const PERMANENT: bool = !PAIR;
    const ON_SUPPORT: bool = true;

    fn extend(&self, law: &mut ModeCoefficients<S>, _parameters: &ScaledParameters<S>, device: &DeviceState<S>) {
        if let (true, Some(terminals)) = (PAIR, device.terminals) {
            law.watch[1] = Guard::Terminals(terminals.direction.unit());
        }
    }

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 1>) -> (V, [V; 1]) {
        let moment = driving_moment(at, Some(at.law.push));
        let acceleration = at.body.solve_acceleration(&at.configuration, moment, at.law.coupling, at.velocity);
        (acceleration, [support_acceleration(at)])
    }

    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 1>, acceleration: V, watch: Guard<S>) -> V {
        match watch {
            Guard::Command(sign) => {
                // Of open clutches: engaged, it is as much smaller as the inertia is larger, and has the same sign.
                let parameters = at.parameters;
                let rack = Push { ground: parameters.rack_push, support: None };
                let moment = driving_moment(at, Some(rack));
                let open = at.body.solve_acceleration(&at.configuration, moment, parameters.rack_coupling, at.velocity);
                let terminals = at.body.terminal_acceleration(&at.configuration, at.velocity, open);
                (terminals - support_acceleration(at)).scale(sign)
            }
            Guard::Terminals(sign) => {
                let [support] = at.unknowns;
                (at.body.to_terminal(&at.configuration, at.velocity) - support).scale(sign)
            }
            _ => acceleration,
        }
    }

    fn reached(&self, at: &mut EventContext<'_, S>, watch: Guard<S>) {
        if let (Guard::Terminals(_), Some(terminals)) = (watch, &mut at.device.terminals) {
            terminals.direction = terminals.direction.opposite();
        }
    }

    fn impact(&self, at: &mut EventContext<'_, S>, _before: S) {
        let rack = at.rack_speed();
        if let Some(terminals) = &mut at.device.terminals {
            terminals.direction = Sign::of(rack - terminals.support, terminals.direction);
        }
    }
}
