//! A body that is told at run time which one it is: one piece of code for all where code is scarce, to the same bits.

use crate::body::{Body, FullBody, SlenderBody, Turned};
use crate::equation::Told;
use crate::value::Value;

/// The linearised block or the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ToldBody {
    /// Linearised.
    Slender(SlenderBody<f32>),
    /// Exact.
    Full(FullBody<f32, Told>),
}

/// A posture of either.
#[derive(Clone, Copy, Debug)]
pub enum ToldPosture<V> {
    /// δ.
    Slender(V),
    /// Of the exact block.
    Full(Turned<V>),
}

/// What either body makes of its own posture; a posture of the other one, which is never made, is `otherwise`.
macro_rules! either {
    ($self:ident, $posture:ident, |$body:ident, $own:ident| $value:expr, $otherwise:expr) => {
        match ($self, $posture) {
            (ToldBody::Slender($body), ToldPosture::Slender($own)) => $value,
            (ToldBody::Full($body), ToldPosture::Full($own)) => $value,
            _ => $otherwise,
        }
    };
}

impl Body<f32> for ToldBody {
    type Posture<V: Value<f32>> = ToldPosture<V>;

    #[inline]
    fn posture<V: Value<f32>>(&self, side: f32, rotation: V) -> ToldPosture<V> {
        match self {
            ToldBody::Slender(body) => ToldPosture::Slender(body.posture(side, rotation)),
            ToldBody::Full(body) => ToldPosture::Full(body.posture(side, rotation)),
        }
    }

    #[inline]
    fn drive<V: Value<f32>>(&self, posture: &ToldPosture<V>, ground: [V; 2]) -> V {
        either!(self, posture, |body, own| body.drive(own, ground), ground[0])
    }

    #[inline]
    fn along<V: Value<f32>>(&self, posture: &ToldPosture<V>, x: V) -> V {
        either!(self, posture, |body, own| body.along(own, x), x)
    }

    #[inline]
    fn terminal_acceleration<V: Value<f32>>(&self, posture: &ToldPosture<V>, velocity: V, acceleration: V) -> V {
        either!(self, posture, |body, own| body.terminal_acceleration(own, velocity, acceleration), acceleration)
    }

    #[inline]
    fn over_inertia<V: Value<f32>>(&self, posture: &ToldPosture<V>, moment: V, coupling: f32, velocity: V) -> V {
        either!(self, posture, |body, own| body.over_inertia(own, moment, coupling, velocity), moment)
    }

    #[inline]
    fn switching<V: Value<f32>>(&self, posture: &ToldPosture<V>, velocity: V, drive: V) -> V {
        either!(self, posture, |body, own| body.switching(own, velocity, drive), drive)
    }

    #[inline]
    fn paper_power(&self, side: f32, posture: &ToldPosture<f32>, velocity: f32, coupling: f32) -> f32 {
        either!(self, posture, |body, own| body.paper_power(side, own, velocity, coupling), 0.0)
    }

    #[inline]
    fn arm(&self, posture: &ToldPosture<f32>) -> f32 {
        either!(self, posture, |body, own| body.arm(own), 1.0)
    }

    #[inline]
    fn travel(&self, side: f32, posture: &ToldPosture<f32>) -> f32 {
        either!(self, posture, |body, own| body.travel(side, own), 0.0)
    }

    #[inline]
    fn factors(&self, posture: &ToldPosture<f32>) -> (f32, f32) {
        either!(self, posture, |body, own| body.factors(own), (0.0, 0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::{BodyKinematics, Consistent, FullBlock, Paper};
    use crate::lever::TyingPoint;

    /// A grid of sides, rotations, velocities and ground accelerations.
    fn postures() -> impl Iterator<Item = (f32, f32, f32, [f32; 2])> {
        [-1.0, 1.0].into_iter().flat_map(|side| {
            (0..60).map(move |k| {
                let x = k as f32;
                (side, side * (0.003 * x), 0.05 * x - 1.4, [0.02 * x - 0.5, 0.01 * x - 0.2])
            })
        })
    }

    fn same_bits<B: Body<f32>>(known: &B, told: &ToldBody) {
        for (side, rotation, velocity, ground) in postures() {
            let (own, other) = (known.posture(side, rotation), told.posture(side, rotation));
            let drive = known.drive(&own, ground);
            let pairs = [
                (drive, told.drive(&other, ground)),
                (known.along(&own, velocity), told.along(&other, velocity)),
                (known.terminal_acceleration(&own, velocity, drive), told.terminal_acceleration(&other, velocity, drive)),
                (known.over_inertia(&own, drive, 0.375, velocity), told.over_inertia(&other, drive, 0.375, velocity)),
                (known.switching(&own, velocity, drive), told.switching(&other, velocity, drive)),
                (known.paper_power(side, &own, velocity, 0.375), told.paper_power(side, &other, velocity, 0.375)),
                (known.arm(&own), told.arm(&other)),
                (known.travel(side, &own), told.travel(side, &other)),
                (known.factors(&own).0, told.factors(&other).0),
                (known.factors(&own).1, told.factors(&other).1),
            ];
            for (at, (known, told)) in pairs.into_iter().enumerate() {
                assert_eq!(known.to_bits(), told.to_bits(), "{at} at {side} {rotation} {velocity}");
            }
        }
    }

    #[test]
    fn told_or_known_the_bits_are_the_same() {
        let slender = SlenderBody { frequency_squared: 3.678_f32, slenderness: 0.1745, lever: 0.9, vertical: true };
        same_bits(&slender, &ToldBody::Slender(slender));
        let block = FullBlock { frequency_squared: 3.678, slenderness: 0.1745 };
        let lever = TyingPoint { along: 0.95, across: 0.2 };
        for consistent in [false, true] {
            let told = ToldBody::Full(FullBody { block, lever, kinematics: Told::told(consistent), vertical: true });
            if consistent {
                same_bits(&FullBody { block, lever, kinematics: Consistent, vertical: true }, &told);
            } else {
                same_bits(&FullBody { block, lever, kinematics: Paper, vertical: true }, &told);
            }
        }
    }
}
