//! Impact accumulation: the infinitely many impacts that follow a weak one, in closed form.
//!
//! θ is too small to change the rates: on each side the block decelerates at a₁ and falls back at a₂, so a swing that starts at
//! θ̇ = v lasts v/a₁ + v/√(a₁a₂) and the next one starts at v η √(a₂/a₁).

use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Pairs of swings that are followed in one segment of the ground when their impacts do not end them.
const MOST_IDLE_SWINGS: f64 = 1e3;

/// Relative difference up to which a quantity of the impacts that accumulate has been seen in swings before them.
const SHOWN: f64 = 1e-4;

/// The ways of two bounces, the first to `side`: signs of θ and θ̇, out and back on each side.
pub fn ways(side: Sign) -> [(Sign, Sign); 4] {
    let other = side.opposite();
    [(side, side), (side, other), (other, other), (other, side)]
}

/// Whether `value` of a quantity of the impacts that accumulate is above its `record`, by more than what swings before them have shown.
pub fn is_new<S: Real>(value: S, record: S) -> bool {
    value > record + record.abs() * S::of(SHOWN)
}

/// Sums over an impact accumulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accumulation<S> {
    /// Duration, s; 1e30 where the impacts take nothing.
    pub duration: S,
    /// Duration of the first two swings, s.
    pub swing: S,
    /// Largest speed at which one of them leaves the block over that of the one before.
    pub gain: S,
    /// Impacts that still count.
    pub impacts: u32,
    /// Closings of a clutch that follows the swings, in those that start faster than impacts count.
    pub closings: u32,
    /// Time for which such clutches are engaged, of all swings, s.
    pub engaged: S,
    /// Largest |θ̈|, rad/s²; 0 where the block does not bounce at all.
    pub acceleration: S,
}

impl<S: Real> Accumulation<S> {
    /// After an impact that leaves the block with `speed` (rad/s) towards the side whose rates (rising a₁, above 0, and falling a₂, 0 where
    /// friction holds the block at the top of a swing; rad/s²) are `here`, with restitution η; impacts count down to an incoming speed
    /// `counted` (rad/s).
    pub fn of(here: (S, S), there: (S, S), restitution: S, speed: S, counted: S) -> Accumulation<S> {
        let [largest_here, largest_there] = [here, there].map(|(rising, falling)| rising.larger(falling));
        let swing = |(rising, falling): (S, S)| {
            let fall = (falling / rising).square_root();
            let back = if falling > S::ZERO { fall / falling } else { S::ZERO };
            (S::ONE / rising + back, fall, back)
        };
        let (here, fall_here, back_here) = swing(here);
        let (there, fall_there, back_there) = swing(there);
        let ratio_here = restitution * fall_here;
        let ratio_there = restitution * fall_there;
        let (both, gain) = (ratio_here * ratio_there, ratio_here.larger(ratio_there));
        // A block that friction holds at the top of its swing never comes to the other side.
        let largest = if ratio_here > S::ZERO { largest_here.larger(largest_there) } else { largest_here };
        let acceleration = if speed == S::ZERO { S::ZERO } else { largest };
        if both >= S::ONE - S::EPSILON * S::of(64.0) {
            let (duration, swing) = (S::of(1e30), speed * (here + there));
            return Accumulation { duration, swing, gain, impacts: 0, closings: 0, engaged: S::ZERO, acceleration };
        }
        let sum = |here: S, there: S| speed * (here + ratio_here * there) / (S::ONE - both);
        let (duration, engaged) = (sum(here, there), sum(back_here, back_there));
        let (mut impacts, mut closings) = (0, 0);
        let (mut outgoing, mut falls) = (speed, [fall_here, fall_there]);
        while impacts < 100_000 {
            let incoming = outgoing * falls[0];
            closings += u32::from(outgoing > counted && incoming > S::ZERO);
            if incoming < counted {
                break;
            }
            impacts += 1;
            outgoing = incoming * restitution;
            falls = [falls[1], falls[0]];
        }
        Accumulation { duration, swing: speed * (here + there), gain, impacts, closings, engaged, acceleration }
    }

    /// The same of a device whose clutches, if it has any, do not follow the swings.
    #[must_use]
    pub fn without_closings(self) -> Accumulation<S> {
        Accumulation { closings: 0, engaged: S::ZERO, ..self }
    }

    /// The largest |θ̈| of a motion that had `peak` before them (rad/s²). Swings before them have shown theirs already, but for what the ground
    /// changes in so short a time.
    pub fn raise(&self, peak: S) -> S {
        if is_new(self.acceleration, peak) { self.acceleration } else { peak }
    }

    /// When a block whose impact at `time` they follow is at rest, in a segment of the ground that lasts until `duration` (local times,
    /// s): at the end of the impacts, if the ground does not lift a block that stands then (`stands`); at once, if the impact was
    /// `negligible`. `None` where the block rocks on.
    pub fn rest(&self, time: S, duration: S, negligible: bool, stands: impl FnOnce(S) -> bool) -> Option<S> {
        let ends = time + self.duration;
        if ends <= duration && stands(ends) {
            return Some(ends);
        }
        // Impacts that hardly take anything would continue through the segment, thousands of them too weak to matter.
        let lingers = duration - time > self.swing * S::of(MOST_IDLE_SWINGS);
        (lingers || negligible).then_some(time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With one rate for all, swing n lasts 2 v ηⁿ/a: the sum is 2v/(a(1−η)).
    #[test]
    fn a_geometric_series() {
        let tail = Accumulation::of((3.0_f64, 3.0), (3.0, 3.0), 0.8, 0.5, 0.1);
        assert!((tail.duration - 2.0 * 0.5 / (3.0 * 0.2)).abs() < 1e-15);
        let incoming = core::iter::successors(Some(0.5_f64), |speed| Some(speed * 0.8));
        assert_eq!(tail.impacts, incoming.take_while(|speed| *speed >= 0.1).count() as u32);
        assert_eq!((tail.closings, tail.without_closings().closings), (tail.impacts, 0));
        assert!((tail.engaged / tail.duration - 0.5).abs() < 1e-15 && tail.without_closings().engaged == 0.0);
        assert!((tail.gain - 0.8).abs() < 1e-15);
        assert!(Accumulation::of((3.0_f64, 3.0), (3.0, 3.0), 1.0, 0.5, 0.1).duration > 1e29);
    }

    /// Unequal sides, against the swings one by one.
    #[test]
    fn swings_one_by_one() {
        let (sides, eta) = ([(2.0_f64, 1.5), (2.6, 2.1)], 0.7);
        let (mut speed, mut time, mut engaged) = (0.4, 0.0, 0.0);
        for n in 0..200 {
            let (rising, falling) = sides[n % 2];
            let height = speed * speed / (2.0 * rising);
            let incoming = (2.0 * falling * height).sqrt();
            time += speed / rising + incoming / falling;
            engaged += incoming / falling;
            speed = eta * incoming;
        }
        let tail = Accumulation::of(sides[0], sides[1], eta, 0.4, 1e-3);
        assert!((tail.duration - time).abs() < 1e-14 * time && (tail.engaged - engaged).abs() < 1e-14 * time);
    }

    /// Held at the top of the first swing, the block has no other: v/a₁, without an impact. Held at the top of the second one, it has had both.
    #[test]
    fn a_swing_that_friction_holds_at_its_top_is_the_last() {
        let held = Accumulation::of((2.0_f64, 0.0), (5.0, 4.0), 0.7, 0.1, 1e-3);
        assert_eq!((held.acceleration, held.impacts, held.closings, held.duration), (2.0, 0, 0, 0.05));
        let later = Accumulation::of((2.0_f64, 1.5), (5.0, 0.0), 0.7, 0.1, 1e-3);
        assert_eq!((later.acceleration, later.impacts, later.closings), (5.0, 1, 1));
    }
}
