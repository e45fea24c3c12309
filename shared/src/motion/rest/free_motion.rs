//! Outcome of free rocking by the energy integral, without integration.
//!
//! After the ground has stopped, every turn, every impact speed and the fall beyond the tip follow from the first integral
//! ([`crate::equation::first_integral`]) of the legs of the motion: outward, from beyond the tip back to it, and inward. Each impact takes
//! energy (η ≤ 1) and a clutched pair takes more, so only the first two legs outward can hold a peak or an overturning.

use crate::equation::first_integral::FirstIntegral;
use crate::math;

/// Free motion of a block on quiet ground: its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMotion<I> {
    /// α, rad.
    pub slenderness: f64,
    /// η, 0 to 1.
    pub restitution: f64,
    /// First integral in force while it moves outward, and back from beyond the tip.
    pub outward: I,
    /// First integral in force while it moves inward on this side of the tip: by Eq. 10 a clutched pair is engaged where acceleration and
    /// velocity have one sign.
    pub inward: I,
}

/// Outcome of a free motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// It passes the tip outward, or stops beyond it.
    pub overturned: bool,
    /// Whether it passes θ = 0 before that.
    pub impact: bool,
    /// Largest |θ| of the free motion, rad; until it overturns.
    pub rotation: f64,
    /// Largest |θ̈|/p² of the free motion, both sides of every impact; until it overturns.
    pub acceleration: f64,
}

impl<I: FirstIntegral> FreeMotion<I> {
    /// The end of the motion from |θ| = `rotation` (rad, not negative) with the outward `velocity` (p rad).
    ///
    /// A block that just reaches the tip counts as overturned.
    pub fn settle(&self, rotation: f64, velocity: f64) -> Settled {
        let FreeMotion { slenderness: alpha, outward, inward, .. } = *self;
        let (mut q, mut velocity) = (alpha - rotation, velocity);
        let mut settled = Settled { overturned: false, impact: false, rotation, acceleration: 0.0 };
        loop {
            let mut turned = velocity == 0.0;
            if velocity > 0.0 {
                // Rates grow with the distance from the tip: the largest of a leg is at one of its ends.
                settled.acceleration = settled.acceleration.max(outward.acceleration(q));
                let turn = if q > 0.0 { outward.turn(q, velocity * velocity) } else { None };
                let Some(turn) = turn else { return Settled { overturned: true, ..settled } };
                settled.rotation = settled.rotation.max(alpha - turn);
                (q, velocity, turned) = (turn, 0.0, true);
            }
            let mut squared = velocity * velocity;
            if q <= 0.0 {
                settled.acceleration = settled.acceleration.max(outward.acceleration(q));
                squared = outward.squared_speed(q, squared, 0.0);
                if squared <= 0.0 {
                    return Settled { overturned: true, ..settled };
                }
                q = 0.0;
                turned = false;
            }
            // Just before the impact and just after it.
            settled.acceleration = settled.acceleration.max(inward.acceleration(alpha));
            if self.restitution > 0.0 {
                settled.acceleration = settled.acceleration.max(outward.acceleration(alpha));
            }
            let after_another = settled.impact;
            settled.impact = true;
            if turned || after_another {
                // What follows starts with no more than it had here: nothing of it is larger.
                return settled;
            }
            velocity = self.restitution * math::square_root(inward.squared_speed(q, squared, alpha).max(0.0));
            q = alpha;
            if velocity == 0.0 {
                return settled;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};

    use crate::equation::first_integral::{FullIntegral, SlenderIntegral};
    use crate::ground::Harmonics;
    use crate::method::taylor::Taylor;
    use crate::motion::state::{Limits, Phase};
    use crate::observers::peaks::Peaks;
    use crate::structure::device::{Device, DeviceKind};
    use crate::structure::{Restitution, Structure};

    const MASS_RATIO: f64 = 0.9;
    const COUPLING: f64 = MASS_RATIO / RECTANGLE_INERTIA_RATIO;

    /// The same motion, integrated for long enough, and its impacts.
    fn followed(structure: &Structure, rotation: f64, velocity: f64) -> (Settled, u32) {
        let system = structure.resolve().unwrap();
        let mut state = system.released_at(rotation, velocity, 0.0);
        let mut peaks = Peaks { rocked: true, ..Peaks::default() };
        let limits = Limits { overturned: 3.0 * structure.block.slenderness(), events: 100_000 };
        system.advance(&Taylor::<f64, 20>::adaptive(1e-17), &mut state, &Harmonics::QUIET, 40.0, &limits, &mut peaks).unwrap();
        let overturned = state.phase == Phase::Overturned;
        let impact = peaks.first_impact.is_some();
        (Settled { overturned, impact, rotation: peaks.rotation, acceleration: peaks.acceleration }, state.impacts)
    }

    fn compare<I: FirstIntegral>(geometry: Geometry, kind: DeviceKind, integral: impl Fn(f64) -> I) {
        let (mut safe, mut fallen) = ([0, 0], [0, 0]);
        let alpha = 0.3;
        let (out, back) = match kind {
            DeviceKind::None => (0.0, 0.0),
            DeviceKind::Inerter => (COUPLING, COUPLING),
            DeviceKind::ClutchedPair => (0.0, COUPLING),
        };
        let motion = FreeMotion { slenderness: alpha, restitution: 0.93, outward: integral(out), inward: integral(back) };
        for step in 0..40 {
            let rotation = alpha * (0.03 + 0.043 * f64::from(step));
            for speed in -30..30 {
                let velocity = alpha * (f64::from(speed) + 0.37) * 0.06;
                let settled = motion.settle(rotation, velocity);
                let block = Block::of_unit_frequency(alpha, RECTANGLE_INERTIA_RATIO).unwrap();
                let structure = Structure {
                    geometry,
                    device: Device { kind, mass_ratio: MASS_RATIO, ..Device::NONE },
                    ..Structure::new(block, Restitution::Constant(0.93))
                };
                let (followed, _) = followed(&structure, rotation, velocity);
                let at = (kind, rotation / alpha, velocity / alpha);
                assert_eq!((settled.overturned, settled.impact), (followed.overturned, followed.impact), "{at:?}");
                let count = if settled.overturned { &mut fallen } else { &mut safe };
                count[usize::from(rotation > alpha)] += 1;
                if !settled.overturned {
                    assert!((settled.rotation - followed.rotation).abs() < 1e-11, "{at:?}: {settled:?} {followed:?}");
                    assert!((settled.acceleration - followed.acceleration).abs() < 1e-12, "{at:?}: {settled:?} {followed:?}");
                }
            }
        }
        // From this side of the tip and from beyond it.
        assert!(safe.iter().chain(&fallen).all(|&count| count > 20), "{safe:?} {fallen:?}");
    }

    #[test]
    fn a_motion_settles_as_it_does_when_followed() {
        for kind in DeviceKind::ALL {
            compare(Geometry::Full, kind, |coupling| FullIntegral { coupling });
            compare(Geometry::Slender, kind, |coupling| SlenderIntegral { inertia: 1.0 + coupling });
        }
    }

    #[test]
    fn the_tip_itself_and_rest() {
        let integral = SlenderIntegral { inertia: 1.0 };
        let motion = FreeMotion { slenderness: 0.2, restitution: 0.9, outward: integral, inward: integral };
        // From θ = 0 with v = α (in p rad) the slender block just reaches the tip.
        assert!(motion.settle(0.0, 0.2).overturned);
        assert!(!motion.settle(0.0, 0.2 - 1e-12).overturned);
        assert!(motion.settle(0.2, 0.0).overturned);
        assert!(!motion.settle(0.2 - 1e-12, 0.0).overturned);
        let settled = motion.settle(0.1, 0.0);
        assert_eq!((settled.overturned, settled.rotation, settled.acceleration), (false, 0.1, 0.2));
    }
}
