//! Run-time choice of the body, with the same bits as a body known at compile time.

use super::body::{Body, FullBody, FullConfiguration, SlenderBody};
use crate::math::scalar::Scalar;
use crate::math::value::Value;

/// The linearised block or the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnyBody<S> {
    /// Linearised.
    Slender(SlenderBody<S>),
    /// Exact.
    Full(FullBody<S>),
}

impl<S: Scalar> AnyBody<S> {
    /// p², 1/s².
    pub fn frequency_squared(&self) -> S {
        match self {
            AnyBody::Slender(body) => body.frequency_squared,
            AnyBody::Full(body) => body.block.frequency_squared,
        }
    }
}

/// A configuration of either.
#[derive(Clone, Copy, Debug)]
pub enum AnyConfiguration<V> {
    /// δ.
    Slender(V),
    /// Configuration of the exact block.
    Full(FullConfiguration<V>),
}

/// Dispatch on body and configuration; a configuration of the other one, which is never made, is `otherwise`.
macro_rules! either {
    ($self:ident, $configuration:ident, |$body:ident, $own:ident| $value:expr, $otherwise:expr) => {
        match ($self, $configuration) {
            (AnyBody::Slender($body), AnyConfiguration::Slender($own)) => $value,
            (AnyBody::Full($body), AnyConfiguration::Full($own)) => $value,
            _ => $otherwise,
        }
    };
}

impl<S: Scalar> Body<S> for AnyBody<S> {
    type Configuration<V: Value<S>> = AnyConfiguration<V>;

    fn configuration<V: Value<S>>(&self, side: S, rotation: V) -> AnyConfiguration<V> {
        match self {
            AnyBody::Slender(body) => AnyConfiguration::Slender(body.configuration(side, rotation)),
            AnyBody::Full(body) => AnyConfiguration::Full(body.configuration(side, rotation)),
        }
    }

    fn driving_moment<V: Value<S>>(&self, configuration: &AnyConfiguration<V>, ground: [V; 2]) -> V {
        either!(self, configuration, |body, own| body.driving_moment(own, ground), ground[0])
    }

    fn to_terminal<V: Value<S>>(&self, configuration: &AnyConfiguration<V>, x: V) -> V {
        either!(self, configuration, |body, own| body.to_terminal(own, x), x)
    }

    fn terminal_acceleration<V: Value<S>>(&self, configuration: &AnyConfiguration<V>, velocity: V, acceleration: V) -> V {
        either!(self, configuration, |body, own| body.terminal_acceleration(own, velocity, acceleration), acceleration)
    }

    fn solve_acceleration<V: Value<S>>(&self, configuration: &AnyConfiguration<V>, moment: V, coupling: S, velocity: V) -> V {
        either!(self, configuration, |body, own| body.solve_acceleration(own, moment, coupling, velocity), moment)
    }

    fn switching<V: Value<S>>(&self, configuration: &AnyConfiguration<V>, velocity: V, driving_moment: V) -> V {
        either!(self, configuration, |body, own| body.switching(own, velocity, driving_moment), driving_moment)
    }

    fn paper_power(&self, side: S, configuration: &AnyConfiguration<S>, velocity: S, coupling: S) -> S {
        either!(self, configuration, |body, own| body.paper_power(side, own, velocity, coupling), S::of(0.0))
    }

    fn arm(&self, configuration: &AnyConfiguration<S>) -> S {
        either!(self, configuration, |body, own| body.arm(own), S::of(1.0))
    }

    fn travel(&self, side: S, configuration: &AnyConfiguration<S>) -> S {
        either!(self, configuration, |body, own| body.travel(side, own), S::of(0.0))
    }

    fn factors(&self, configuration: &AnyConfiguration<S>) -> (S, S) {
        either!(self, configuration, |body, own| body.factors(own), (S::of(0.0), S::of(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::FullBlock;
    use crate::equation::lever::TyingPoint;

    /// A grid of sides, rotations, velocities and ground accelerations.
    fn configurations() -> impl Iterator<Item = (f32, f32, f32, [f32; 2])> {
        [-1.0, 1.0].into_iter().flat_map(|side| {
            (0..60).map(move |k| {
                let x = k as f32;
                (side, side * (0.003 * x), 0.05 * x - 1.4, [0.02 * x - 0.5, 0.01 * x - 0.2])
            })
        })
    }

    fn same_bits<B: Body<f32>>(known: &B, any: &AnyBody<f32>) {
        for (side, rotation, velocity, ground) in configurations() {
            let (own, other) = (known.configuration(side, rotation), any.configuration(side, rotation));
            let driving_moment = known.driving_moment(&own, ground);
            let pairs = [
                (driving_moment, any.driving_moment(&other, ground)),
                (known.to_terminal(&own, velocity), any.to_terminal(&other, velocity)),
                (
                    known.terminal_acceleration(&own, velocity, driving_moment),
                    any.terminal_acceleration(&other, velocity, driving_moment),
                ),
                (
                    known.solve_acceleration(&own, driving_moment, 0.375, velocity),
                    any.solve_acceleration(&other, driving_moment, 0.375, velocity),
                ),
                (known.switching(&own, velocity, driving_moment), any.switching(&other, velocity, driving_moment)),
                (known.paper_power(side, &own, velocity, 0.375), any.paper_power(side, &other, velocity, 0.375)),
                (known.arm(&own), any.arm(&other)),
                (known.travel(side, &own), any.travel(side, &other)),
                (known.factors(&own).0, any.factors(&other).0),
                (known.factors(&own).1, any.factors(&other).1),
            ];
            for (at, (known, any)) in pairs.into_iter().enumerate() {
                assert_eq!(known.to_bits(), any.to_bits(), "{at} at {side} {rotation} {velocity}");
            }
        }
    }

    #[test]
    fn any_or_known_the_bits_are_the_same() {
        let slender = SlenderBody { frequency_squared: 3.678_f32, slenderness: 0.1745, lever: 0.9, vertical: true };
        same_bits(&slender, &AnyBody::Slender(slender));
        let block = FullBlock { frequency_squared: 3.678, slenderness: 0.1745 };
        let lever = TyingPoint { along: 0.95, across: 0.2 };
        for consistent in [false, true] {
            let full = FullBody { block, lever, consistent, vertical: true };
            same_bits(&full, &AnyBody::Full(full));
        }
    }
}
