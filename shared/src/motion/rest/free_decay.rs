//! Free decay: the remaining swings of a free motion, summed in closed form.
//!
//! On quiet ground every swing of a block follows from the speed it starts with, because between clutch switches the
//! motion has a first integral: with θ̈ = a(θ), ½θ̇² falls by x = −∫a dθ. Along a swing take x for the variable; then
//! dθ/dx = 1/|a|, and a swing that starts with ½v² = E rises for
//!
//! T = ∫₀^v dθ̇/|a| = v Σ_j r_j B_j E^j,  1/|a| = Σ r_j x^j,  B_j = ∫₀¹ (1−y²)^j dy = B_{j−1} 2j/(2j+1).
//!
//! It falls back, under the equation a' that is in force then, with E' = ∫₀^E |a'|/|a| dx, again a series in E. The series
//! come from the equations of motion themselves, by the tape. With one equation both ways E' = E, so each swing starts
//! with η times the speed of the last and the durations sum to geometric series; for a clutched pair the few dozen swings
//! until rest are a map of one number.

pub mod decay_sums;

use core::cell::Cell;

use crate::equation::Equation;
use crate::math::power_series::Tape;
use crate::math::scalar::Real;
use crate::math::{self, RECIPROCALS};

/// Terms of the series.
const TERMS: usize = 20;

/// Size of the terms left out, relative to the first.
const TOLERANCE: f64 = 1e-13;

/// Swings that are summed one by one before giving up.
const MOST_SWINGS: u32 = 20_000;

/// Free decay summed to its end, or to the last impact within its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decay<S> {
    /// Time summed, s.
    pub duration: S,
    /// Impacts in it that count.
    pub impacts: u32,
    /// Largest |θ| still to come, rad: that of the first swing.
    pub rotation: S,
    /// Largest |θ̈| still to come, rad/s².
    pub acceleration: S,
    /// θ̇ after the last impact summed, rad/s, along the direction of the start (negative after an odd number of swings): 0 at
    /// rest, not 0 when the time ran out first.
    pub speed: S,
}

/// The series of a structure's free swings.
#[derive(Clone, Copy, Debug)]
pub struct HalfCycles<S> {
    /// r_j B_j of the rising part.
    rising: [S; TERMS],
    /// r_j B_j of the falling part.
    falling: [S; TERMS],
    /// r_j/(j+1): the rotation reached is θ = E Σ r_j/(j+1) E^j.
    reach: [S; TERMS],
    /// E'/E = Σ gain_j E^j.
    gain: [S; TERMS],
    /// Largest E for which the first `index + 1` terms suffice.
    enough: [S; TERMS],
    /// |θ̈| at θ = 0, rising; the largest of a swing.
    acceleration: S,
    /// One equation both ways.
    same: bool,
}

impl<S: Real> HalfCycles<S> {
    /// The swings of a block that rises under `rising` and falls back under `falling`; `same` when those are one.
    pub fn of<R: Equation<S>, F: Equation<S>>(rising: &R, falling: &F, same: bool) -> HalfCycles<S> {
        let tape = Tape::<S, TERMS>::default();
        let mut gain = [S::ZERO; TERMS];
        let up = swing(&tape, rising, falling, if same { None } else { Some(&mut gain) });
        let down = if same { up } else { swing(&tape, falling, rising, None) };
        // The coefficients grow like 1/E_b^j, where E_b is the energy of the unstable equilibrium.
        let last = S::of(RECIPROCALS[TERMS - 1]);
        let growth = |series: &[S; TERMS]| (series[TERMS - 1].abs() / series[0]).larger(S::EPSILON).rough_power(last);
        let inverse = S::ONE / growth(&up).larger(growth(&down));
        let mut enough = [S::ZERO; TERMS];
        for (k, bound) in enough.iter_mut().enumerate() {
            *bound = inverse * S::of(TOLERANCE).rough_power(S::of(RECIPROCALS[k + 1]));
        }
        let mut weight = S::ONE;
        let (mut rises, mut falls, mut reach) = (up, down, up);
        for k in 0..TERMS {
            if k > 0 {
                weight = weight * S::of((2 * k) as f64 / (2 * k + 1) as f64);
            }
            rises[k] = rises[k] * weight;
            falls[k] = falls[k] * weight;
            reach[k] = reach[k] * S::of(RECIPROCALS[k + 1]);
            gain[k] = gain[k] * S::of(RECIPROCALS[k + 1]);
        }
        HalfCycles { rising: rises, falling: falls, reach, gain, enough, acceleration: S::ONE / up[0], same }
    }

    /// The motion that starts from θ = 0 with `speed` (rad/s), with impacts of restitution `eta` that count down to an
    /// incoming `counted` speed, over at most `time` (s). None if the first swing is too large for the series, or not even one
    /// swing can be summed.
    pub fn decay(&self, speed: S, eta: S, counted: S, time: S) -> Option<Decay<S>> {
        let energy = S::HALF * speed * speed;
        if energy > self.enough[TERMS - 1] || speed <= S::ZERO {
            return None;
        }
        let (duration, impacts, last) = if self.same {
            self.geometric(speed, energy, eta, counted, time)?
        } else {
            let (duration, impacts) = self.mapped(speed, eta, counted)?;
            (duration, impacts, S::ZERO)
        };
        if duration > time {
            return None;
        }
        let rotation = energy * self.reach.iter().rev().fold(S::ZERO, |sum, &c| sum * energy + c);
        Some(Decay { duration, impacts, rotation, acceleration: self.acceleration, speed: last })
    }

    /// Σ_n 2 v_n Σ_j r_j B_j (v_n²/2)^j with v_n = v ηⁿ: to the end, or as many whole swings as there is time for. Duration,
    /// counted impacts and the speed after the last.
    fn geometric(&self, speed: S, energy: S, eta: S, counted: S, time: S) -> Option<(S, u32, S)> {
        let loss = S::ONE - eta;
        let mut duration = S::ZERO;
        let mut power = speed + speed;
        // (1 − η^{2j+1})/(1 − η), which has no cancellation near η = 1, and η^{2j+1}.
        let (mut sum, mut decline) = (S::ONE, eta);
        for &coefficient in &self.rising {
            duration = duration + coefficient * power / (loss * sum);
            power = power * energy;
            sum = sum + decline + decline * eta;
            decline = decline * eta * eta;
        }
        if loss > S::ZERO && duration <= time {
            return Some((duration, counted_impacts(speed, eta, counted), S::ZERO));
        }
        // Not over in time: bisect for the number of swings, in f64 because there may be very many.
        let rate = math::log1p(-loss.to_f64());
        let after = |swings: f64| {
            let mut power = 2.0 * speed.to_f64();
            let mut duration = 0.0;
            for (j, coefficient) in self.rising.iter().enumerate() {
                let m = (2 * j + 1) as f64;
                let share = if rate == 0.0 { swings } else { math::expm1(m * swings * rate) / math::expm1(m * rate) };
                duration += coefficient.to_f64() * power * share;
                power *= energy.to_f64();
            }
            duration
        };
        let (mut low, mut high) = (0.0, 1.0);
        while after(high) <= time.to_f64() && high < 1e15 {
            high *= 2.0;
        }
        while high - low > 0.5 {
            let middle = 0.5 * (low + high);
            if after(middle) <= time.to_f64() { low = middle } else { high = middle }
        }
        // Below 2⁵² a float as an integer is its floor.
        let swings = (low as u64) as f64;
        if swings < 1.0 {
            return None;
        }
        let most = swings.min(f64::from(u32::MAX)) as u32;
        let last = speed * S::of(math::exp(swings * rate));
        let last = if (low as u64).is_multiple_of(2) { last } else { -last };
        Some((S::of(after(swings)), most.min(counted_impacts(speed, eta, counted)), last))
    }

    /// Swing by swing until impacts no longer count; what is left then has constant rates, and is geometric.
    fn mapped(&self, speed: S, eta: S, counted: S) -> Option<(S, u32)> {
        let (mut speed, mut duration, mut impacts) = (speed, S::ZERO, 0);
        let mut terms = TERMS;
        for _ in 0..MOST_SWINGS {
            let energy = S::HALF * speed * speed;
            while terms > 1 && energy <= self.enough[terms - 2] {
                terms -= 1;
            }
            let (mut gain, mut rise) = (S::ZERO, S::ZERO);
            for k in (0..terms).rev() {
                gain = gain * energy + self.gain[k];
                rise = rise * energy + self.rising[k];
            }
            let back = gain * energy;
            let mut fall = S::ZERO;
            for k in (0..terms).rev() {
                fall = fall * back + self.falling[k];
            }
            let incoming = (back + back).square_root();
            duration = duration + speed * rise + incoming * fall;
            speed = eta * incoming;
            if incoming < counted {
                let ratio = eta * self.gain[0].square_root();
                let swing = self.rising[0] + self.gain[0].square_root() * self.falling[0];
                return Some((duration + speed * swing / (S::ONE - ratio), impacts));
            }
            impacts += 1;
        }
        None
    }
}

/// Impacts of incoming speeds v, vη, vη², … that are not below `counted`.
fn counted_impacts<S: Real>(speed: S, eta: S, counted: S) -> u32 {
    if speed < counted {
        return 0;
    }
    if eta <= S::ZERO {
        return 1;
    }
    let rate = math::log1p(-(S::ONE - eta).to_f64());
    let more = math::ln(speed.to_f64() / counted.to_f64()) / -rate;
    if more < f64::from(u32::MAX - 1) { 1 + more as u32 } else { u32::MAX }
}

/// Coefficients of 1/|a| in the energy given up, and those of |a'|/|a| where wanted.
fn swing<S: Real, E: Equation<S>, F: Equation<S>>(
    tape: &Tape<S, TERMS>,
    equation: &E,
    other: &F,
    mut gain: Option<&mut [S; TERMS]>,
) -> [S; TERMS] {
    // θ, a quantity that is zero, and 1.
    const GIVEN: usize = 3;
    let next = Cell::new(GIVEN);
    let mut series = [S::ZERO; TERMS];
    tape.set(0, 0, S::ZERO);
    for (k, coefficient) in series.iter_mut().enumerate() {
        tape.set(1, k, S::ZERO);
        tape.set(2, k, if k == 0 { S::ONE } else { S::ZERO });
        next.set(GIVEN);
        let (theta, still, one) = (tape.given(&next, k, 0), tape.given(&next, k, 1), tape.given(&next, k, 2));
        let inverse = one / -equation.acceleration(S::ONE, theta, still, still);
        if let Some(gain) = gain.as_deref_mut() {
            gain[k] = (-other.acceleration(S::ONE, theta, still, still) * inverse).last();
        }
        *coefficient = inverse.last();
        if k + 1 < TERMS {
            tape.set(0, k + 1, inverse.last() * S::of(RECIPROCALS[k + 1]));
        }
    }
    series
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::SlenderBlock;
    use crate::math::{atanh, square_root};

    fn slender(frequency_squared: f64) -> SlenderBlock<f64> {
        SlenderBlock { frequency_squared, slenderness: 0.1, inertia: 1.0 / frequency_squared, lever: 1.0 }
    }

    /// A slender block's swing from speed v lasts (2/p) atanh(v/(pα)).
    #[test]
    fn the_slender_block_rocks_for_its_closed_form() {
        let swings = HalfCycles::of(&slender(1.0), &slender(1.0), true);
        let decay = swings.decay(0.04, 0.85, 1e-7, 1e3).unwrap();
        let exact: f64 = (0..400).map(|n| 2.0 * atanh(0.4 * crate::math::pow(0.85, f64::from(n)))).sum();
        assert!((decay.duration / exact - 1.0).abs() < 1e-12, "{} {exact}", decay.duration);
        assert_eq!(decay.impacts, 80, "ln(1e-7/0.04)/ln 0.85 = 79.4");
        assert!((decay.acceleration - 0.1).abs() < 1e-16);
        // ½v² = ½(α² − (α − θ)²).
        assert!((decay.rotation - (0.1 - square_root(0.01 - 0.0016))).abs() < 1e-14);
    }

    /// Of a slender clutched pair the speed back is v/√(1+k), and rise and fall have their own frequency parameters.
    #[test]
    fn the_slender_pair_too() {
        let k = 0.375;
        let swings = HalfCycles::of(&slender(1.0), &slender(1.0 / (1.0 + k)), false);
        let decay = swings.decay(0.03, 0.85, 1e-7, 1e3).unwrap();
        let (mut speed, mut exact) = (0.3_f64, 0.0);
        while speed > 1e-13 {
            exact += atanh(speed) * (1.0 + square_root(1.0 + k));
            speed *= 0.85 / square_root(1.0 + k);
        }
        assert!((decay.duration / exact - 1.0).abs() < 1e-12, "{} {exact}", decay.duration);
    }

    #[test]
    fn too_large_motions_are_left_to_the_method() {
        let swings = HalfCycles::of(&slender(1.0), &slender(1.0), true);
        assert!(swings.decay(0.099, 0.85, 1e-7, 1e3).is_none());
    }

    /// Without loss the block rocks on with the period (4/p) atanh(v/(pα)); with little, almost so.
    #[test]
    fn undying_motions_are_summed_as_far_as_their_time_goes() {
        let swings = HalfCycles::of(&slender(1.0), &slender(1.0), true);
        let swing: f64 = 2.0 * atanh(0.01);
        let decay = swings.decay(0.001, 1.0, 1e-7, 60.0).unwrap();
        assert_eq!(f64::from(decay.impacts), (60.0 / swing).floor());
        assert!(60.0 - decay.duration < swing && decay.duration <= 60.0 && decay.speed.abs() == 0.001);
        assert_eq!(decay.speed > 0.0, decay.impacts % 2 == 0);
        let tiny = swings.decay(1e-10, 1.0 - 1e-13, 1e-7, 60.0).unwrap();
        assert!(tiny.impacts == 0 && 60.0 - tiny.duration < 1e-7 && tiny.speed.abs() > 0.9e-10);
    }
}
