//! Times of free rocking by the energy integral, without integration: its impacts, and when it ends.
//!
//! The legs of the motion are those of [`super::free_motion`]; [`super::leg_time`] has how long each lasts. When the swings are small
//! enough, the rest of them is summed ([`super::free_decay`]), as the event loop does. What rounding would decide is left to that loop.

use super::free_decay::Decay;
use super::free_motion::FreeMotion;
use super::impact_accumulation::Accumulation;
use super::leg_time::LegTime;
use crate::equation::first_integral::FirstIntegral;
use crate::math;

/// Share of the energy up to the tip within which a motion that comes near the tip is too slow there to time it.
const NEAR_TIP: f64 = 1e-5;

/// How near to the end of its time an event may come, relative to that time, before rounding decides which is first.
const NEAR_END: f64 = 1e-9;

/// Swings that are followed one by one.
const MOST_SWINGS: u32 = 1_000;

/// Free motions of a block on quiet ground, and what counts in them.
#[derive(Clone, Copy, Debug)]
pub struct FreeCourse<'a, I> {
    /// Block and first integrals.
    pub motion: FreeMotion<I>,
    /// How long it takes outward, and back from beyond the tip.
    pub outward: &'a LegTime<I>,
    /// How long it takes inward on this side of the tip; the same one where both are one mode.
    pub inward: &'a LegTime<I>,
    /// |θ| (rad) beyond which an outward motion has overturned: α (slender) or π/2.
    pub no_return: f64,
    /// θ̇ (p rad) of an impact that counts.
    pub counted_speed: f64,
    /// θ̇ (p rad) after an impact below which it may end in rest.
    pub rest_speed: f64,
}

/// Events of a free motion within its time; times in 1/p from its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// Impacts that count.
    pub impacts: u32,
    /// The first of them.
    pub first_impact: Option<f64>,
    /// Rest or overturning; `None` for a block that still rocks.
    pub ended: Option<f64>,
}

impl<I: FirstIntegral> FreeCourse<'_, I> {
    /// The motion from |θ| = `rotation` (rad, not negative) with the outward `velocity` (p rad) for the time `horizon` (1/p), in which it
    /// reaches its peaks ([`FreeMotion::settle`]). `decay` sums the swings that follow an impact with this speed after it, within a time, if it can.
    ///
    /// `None` where that time is too short, or rounding decides.
    pub fn follow(
        &self,
        rotation: f64,
        velocity: f64,
        horizon: f64,
        mut decay: impl FnMut(f64, f64) -> Option<Decay<f64>>,
    ) -> Option<Course> {
        let FreeMotion { slenderness: alpha, restitution, outward, inward } = self.motion;
        let margin = NEAR_END * (1.0 + horizon);
        let near_tip = NEAR_TIP * outward.energy(alpha);
        let mut course = Course::default();
        let (mut q, mut velocity, mut time) = (alpha - rotation, velocity, 0.0);
        // Whether nothing that is still to come has a larger peak.
        let mut peaked = false;
        let one_mode = core::ptr::eq(self.outward, self.inward);
        for _ in 0..MOST_SWINGS {
            // A motion of one mode from an impact to its turn, which comes back as it went.
            let mut rise = None;
            let mut turned = velocity == 0.0;
            let mut squared = velocity * velocity;
            if velocity > 0.0 || q <= 0.0 {
                let tip = squared - outward.energy(q);
                if tip.abs() <= near_tip {
                    return None;
                }
                let leg = self.outward.from_middle(q.abs(), squared)?;
                if tip > 0.0 && q <= 0.0 && velocity <= 0.0 {
                    // Back from beyond the tip.
                    time += leg;
                    (q, squared) = (0.0, tip);
                } else if tip > 0.0 || q <= 0.0 {
                    let ended = time + self.fall(q, velocity, tip, leg)?;
                    course.ended = Some(ended);
                    return (ended < horizon - margin).then_some(course);
                } else {
                    time += leg;
                    rise = Some(leg).filter(|_| one_mode && q == alpha);
                    (q, squared, turned) = (outward.turn(q, squared)?, 0.0, true);
                }
            }
            let incoming = inward.squared_speed(q, squared, alpha);
            if incoming <= 0.0 {
                return None;
            }
            let leg = match rise {
                Some(rise) => rise,
                None => self.inward.from_middle(alpha, incoming)?,
            };
            time += if squared > 0.0 { leg - self.inward.from_middle(q, squared)? } else { leg };
            if time >= horizon - margin {
                return (peaked && time > horizon + margin).then_some(course);
            }
            peaked |= turned;
            let incoming = math::square_root(incoming);
            if incoming >= self.counted_speed {
                course.impacts += 1;
                course.first_impact = course.first_impact.or(Some(time));
            }
            velocity = restitution * incoming;
            q = alpha;
            if velocity <= self.rest_speed {
                return self.rest(course, time, velocity, horizon, margin);
            }
            if let Some(sum) = decay(velocity, horizon - time - margin) {
                course.impacts = course.impacts.saturating_add(sum.impacts);
                if sum.speed == 0.0 {
                    course.ended = Some(time + sum.duration);
                    return Some(course);
                }
                // There may be time for another swing.
                (time, velocity, peaked) = (time + sum.duration, sum.speed.abs(), true);
            }
        }
        None
    }

    /// Time of the fall of a motion that is `leg` from the tip or its turn, and has ω² = `tip` at the tip.
    fn fall(&self, q: f64, velocity: f64, tip: f64, leg: f64) -> Option<f64> {
        let end = self.no_return - self.motion.slenderness;
        if q <= -end {
            // Beyond the end it has overturned when it moves outward.
            return Some(if velocity > 0.0 { 0.0 } else { leg });
        }
        let outside = if end > 0.0 { self.outward.from_middle(end, tip + self.outward.integral.energy(end))? } else { 0.0 };
        Some(if (q > 0.0) == (velocity > 0.0) { outside + leg } else { outside - leg })
    }

    /// The end of `course` after an impact at `time` that leaves the block with a `velocity` too small to matter.
    fn rest(&self, mut course: Course, time: f64, velocity: f64, horizon: f64, margin: f64) -> Option<Course> {
        let FreeMotion { slenderness: alpha, restitution, outward, inward } = self.motion;
        let rates = (outward.acceleration(alpha), inward.acceleration(alpha));
        let tail = Accumulation::of(rates, rates, restitution, velocity, self.counted_speed);
        if time + tail.duration > horizon - margin {
            return None;
        }
        course.impacts += tail.impacts;
        course.ended = Some(time + tail.duration);
        Some(course)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::SlenderBlock;
    use crate::equation::first_integral::{FullIntegral, SlenderIntegral};
    use crate::math::{acosh, atanh, square_root};
    use crate::motion::rest::free_decay::HalfCycles;
    use crate::motion::rest::free_decay::decay_sums::DecaySums;

    const ALPHA: f64 = 0.2;
    const COUPLING: f64 = 0.6;

    /// A slender block with a clutched pair, followed for `horizon` with and without its swings summed; they are the same.
    fn pair(rotation: f64, velocity: f64, restitution: f64, horizon: f64) -> Option<Course> {
        let (outward, inward) = (SlenderIntegral { inertia: 1.0 }, SlenderIntegral { inertia: 1.0 + COUPLING });
        let motion = FreeMotion { slenderness: ALPHA, restitution, outward, inward };
        let legs = (LegTime::of(outward), LegTime::of(inward));
        let course = FreeCourse {
            motion,
            outward: &legs.0,
            inward: &legs.1,
            no_return: ALPHA,
            counted_speed: 1e-6 * ALPHA,
            rest_speed: 1e-6 * ALPHA,
        };
        let equation = |inertia: f64| SlenderBlock { frequency_squared: 1.0 / inertia, slenderness: ALPHA, inertia, lever: 1.0 };
        let swings = HalfCycles::of(&equation(1.0), &equation(1.0 + COUPLING), false);
        let sums = DecaySums::of(&swings, restitution).unwrap();
        let summed =
            course.follow(rotation, velocity, horizon, |speed, time| sums.decay(&swings, speed, course.counted_speed, time));
        let swung = course.follow(rotation, velocity, horizon, |_, _| None);
        match (summed, swung) {
            (Some(summed), Some(swung)) => {
                assert_eq!((summed.impacts, summed.ended.is_some()), (swung.impacts, swung.ended.is_some()));
                let ends = summed.ended.zip(swung.ended).unwrap_or_default();
                // Swing by swing the speed of the slowest is known to a thousandth.
                assert!((ends.0 - ends.1).abs() < 1e-8, "{summed:?} {swung:?}");
                assert_eq!(summed.first_impact, swung.first_impact);
            }
            (summed, swung) => assert_eq!(summed, swung),
        }
        summed
    }

    /// From rest at θ = q − α it falls back in √(1 + k) acosh(α/q); a swing from the speed v α lasts (1 + √(1 + k)) atanh v, and comes back
    /// with v/√(1 + k).
    #[test]
    fn a_slender_pair_has_its_closed_form() {
        let (q, restitution, root) = (0.3 * ALPHA, 0.9, square_root(1.0 + COUPLING));
        let first = root * acosh(ALPHA / q);
        let incoming = square_root(1.0 - 0.3 * 0.3) / root;
        let (mut speed, mut end) = (restitution * incoming, first);
        while speed > 1e-12 {
            end += (1.0 + root) * atanh(speed);
            speed *= restitution / root;
        }
        let course = pair(ALPHA - q, 0.0, restitution, 60.0).unwrap();
        assert!((course.first_impact.unwrap() - first).abs() < 1e-14 && (course.ended.unwrap() - end).abs() < 1e-11);
        assert_eq!(f64::from(course.impacts), 1.0 + (math::ln(incoming / 1e-6) / math::ln(root / restitution)).floor());
        // Cut between the third impact and the fourth.
        let swings =
            [0, 1, 2].map(|n| (1.0 + root) * atanh(restitution * incoming * math::pow(restitution / root, f64::from(n))));
        let horizon = first + swings[0] + swings[1] + 0.5 * swings[2];
        assert_eq!(
            pair(ALPHA - q, 0.0, restitution, horizon),
            Some(Course { impacts: 3, first_impact: course.first_impact, ended: None })
        );
        // At the fourth rounding decides, and before the first the peaks are still to come.
        assert_eq!(pair(ALPHA - q, 0.0, restitution, horizon + 0.5 * swings[2]), None);
        assert_eq!(pair(ALPHA - q, 0.0, restitution, 0.9 * first), None);
    }

    /// Without a clutch the way back from a turn takes as long as that there, and is timed with it.
    #[test]
    fn a_motion_of_one_mode_comes_back_as_it_went() {
        let integral = FullIntegral { coupling: COUPLING };
        let legs = (LegTime::of(integral), LegTime::of(integral));
        let motion = FreeMotion { slenderness: ALPHA, restitution: 0.9, outward: integral, inward: integral };
        let follow = |inward| {
            let (counted_speed, rest_speed) = (1e-6 * ALPHA, 1e-6 * ALPHA);
            let course = FreeCourse { motion, outward: &legs.0, inward, no_return: ALPHA, counted_speed, rest_speed };
            course.follow(0.6 * ALPHA, -0.2 * ALPHA, 200.0, |_, _| None).unwrap()
        };
        let (once, twice) = (follow(&legs.0), follow(&legs.1));
        assert!(once.impacts > 100 && (once.impacts, once.first_impact) == (twice.impacts, twice.first_impact));
        assert!((once.ended.unwrap() / twice.ended.unwrap() - 1.0).abs() < 1e-9, "{once:?} {twice:?}");
    }

    /// It passes the tip with ω₀ where it starts from θ = 0 with ω² = ω₀² + α², after a time asinh(α/ω₀); beyond the tip it comes back or does not.
    #[test]
    fn falls_and_returns() {
        let over = 0.5 * ALPHA;
        let start = square_root(ALPHA * ALPHA + over * over);
        let ended = pair(0.0, start, 0.9, 60.0).unwrap().ended.unwrap();
        assert!((ended - atanh(ALPHA / start)).abs() < 1e-14, "tanh t = α/ω of the start");
        assert_eq!(pair(1.1 * ALPHA, 0.1, 0.9, 60.0).unwrap(), Course { impacts: 0, first_impact: None, ended: Some(0.0) });
        // Back to the tip with q = −b cosh t + v sinh t, and from there inward with the inerter: q = ω √(1 + k) sinh.
        let (beyond, back, root) = (0.1 * ALPHA, 0.4 * ALPHA, square_root(1.0 + COUPLING));
        let tip = square_root(back * back - beyond * beyond);
        let inward = root * math::ln(ALPHA / (tip * root) + square_root(1.0 + (ALPHA / (tip * root)) * (ALPHA / (tip * root))));
        let course = pair(ALPHA + beyond, -back, 0.9, 60.0).unwrap();
        assert!((course.first_impact.unwrap() - (atanh(beyond / back) + inward)).abs() < 1e-14);
        // It has overturned when it turns beyond the tip, q = −b cosh t + v sinh t; too near to it rounding decides.
        let course = pair(ALPHA + back, -beyond, 0.9, 60.0).unwrap();
        assert!((course.ended.unwrap() - atanh(beyond / back)).abs() < 1e-14 && course.impacts == 0);
        assert_eq!(pair(0.0, ALPHA * (1.0 + 1e-9), 0.9, 60.0), None);
    }
}
