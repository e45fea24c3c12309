//! All swings that are left of a clutched pair's free decay as functions of the speed v that the next one starts with.
//!
//! With E = ½v² a swing lasts T(v) = v Σ t_j E^j, and the next one starts with ρ v √S(E), S = Σ s_j E^j with s_0 = 1. What is left lasts
//! D(v) = v Σ d_j E^j, where D(v) = T(v) + D(ρ v √S), so
//!
//! d_n (1 − ρ^{2n+1}) = t_n + Σ_{j<n} d_j ρ^{2j+1} [E^{n−j}] S^{j+½}.
//!
//! The same with ρ ψ(v) = ψ(ρ v √S) (Schröder 1870) gives ψ(v) = v Σ c_j E^j, c_0 = 1, of which every swing leaves the share ρ: the
//! logarithm of ψ counts swings.

use core::array::from_fn;

use super::{Decay, HalfCycles, MOST_SWINGS, TERMS};
use crate::math;
use crate::math::power_series::product_coefficient as product;

/// Largest ρ: beyond it swings are too many to sum.
const LARGEST_RATIO: f64 = 0.999;

/// Share of a swing within which rounding decides how many swings count.
const NEAR_COUNT: f64 = 1e-9;

/// The sums of the swings of one block, with one restitution.
#[derive(Clone, Copy, Debug)]
pub struct DecaySums {
    /// η.
    restitution: f64,
    /// ln ρ.
    rate: f64,
    /// d_j.
    duration: [f64; TERMS],
    /// c_j.
    share: [f64; TERMS],
    /// Coefficients of ρ √S.
    next: [f64; TERMS],
}

impl DecaySums {
    /// Those of `swings` with impacts of restitution η, above 0. None for motions that hardly decay.
    pub fn of(swings: &HalfCycles<f64>, restitution: f64) -> Option<DecaySums> {
        let first = swings.gain[0];
        let root = math::square_root(first);
        let ratio = restitution * root;
        if !(ratio > 0.0 && ratio <= LARGEST_RATIO) {
            return None;
        }
        let factor: [f64; TERMS] = from_fn(|n| swings.gain[n] / first);
        // S^{j+½}, of which each j needs the coefficients below TERMS − j.
        let mut power = [0.0; TERMS];
        for (n, of_factor) in factor.iter().enumerate() {
            let others = product(&power, &power, n);
            power[n] = if n == 0 { 1.0 } else { 0.5 * (of_factor - others) };
        }
        let next = power.map(|coefficient| ratio * coefficient);
        let (mut duration, mut share) = (swings.rising, [0.0; TERMS]);
        // √gain^{2j+1} and ρ^{2j+1}.
        let (mut growth, mut decline) = (root, ratio);
        for j in 0..TERMS {
            let fall = swings.falling[j] * growth;
            duration[j] = (duration[j] + fall) / (1.0 - decline);
            share[j] = if j == 0 { 1.0 } else { share[j] / (ratio - decline) };
            let (of_duration, of_share) = (fall + duration[j] * decline, share[j] * decline);
            let later = duration[j + 1..].iter_mut().zip(&mut share[j + 1..]);
            for ((duration, share), power) in later.zip(&power[1..]) {
                *duration += of_duration * power;
                *share += of_share * power;
            }
            power = from_fn(|n| if n + j < TERMS { product(&power, &factor, n) } else { 0.0 });
            growth *= first;
            decline *= ratio * ratio;
        }
        Some(DecaySums { restitution, rate: math::ln(ratio), duration, share, next })
    }

    /// As [`HalfCycles::decay`] of `swings`, and as many whole swings as there is time for. None also where rounding decides how many impacts count.
    pub fn decay(&self, swings: &HalfCycles<f64>, speed: f64, counted: f64, time: f64) -> Option<Decay<f64>> {
        let energy = 0.5 * speed * speed;
        if energy > swings.enough[TERMS - 1] || speed <= 0.0 {
            return None;
        }
        let terms = 1 + swings.enough[..TERMS - 1].iter().take_while(|enough| energy > **enough).count();
        let sum_at = |series: &[f64; TERMS], energy: f64| series[..terms].iter().rev().fold(0.0, |sum, c| sum * energy + c);
        let sum = |series: &[f64; TERMS]| sum_at(series, energy);
        let duration = speed * sum(&self.duration);
        let (rotation, acceleration) = (energy * sum(&swings.reach), swings.acceleration);
        if duration > time {
            let (mut left, mut moving, mut impacts, mut swung) = (duration, speed, 0, 0_u32);
            while swung < MOST_SWINGS {
                let next = moving * sum_at(&self.next, 0.5 * moving * moving);
                let after = next * sum_at(&self.duration, 0.5 * next * next);
                if duration - after > time {
                    break;
                }
                (left, moving, swung) = (after, next, swung + 1);
                impacts += u32::from(next >= self.restitution * counted);
            }
            let speed = if swung.is_multiple_of(2) { moving } else { -moving };
            let decay = Decay { duration: duration - left, impacts, rotation, acceleration, speed };
            return (1..MOST_SWINGS).contains(&swung).then_some(decay);
        }
        // The m-th impact from here comes in with the speed of the swing after it over η.
        let swings_left = math::ln(speed * sum(&self.share) / (self.restitution * counted)) / -self.rate;
        let count = swings_left.max(0.0) as u32;
        let doubtful =
            (swings_left - f64::from(count)).abs() < NEAR_COUNT || (swings_left - f64::from(count) - 1.0).abs() < NEAR_COUNT;
        (!doubtful).then_some(Decay { duration, impacts: count, rotation, acceleration, speed: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::body::FullBody;
    use crate::equation::lever::CentreOfMass;
    use crate::equation::{FullBlock, FullInerter};

    /// Against the swings one by one.
    #[test]
    fn sums_are_those_of_the_swings() {
        let mut compared = 0;
        for (slenderness, coupling, restitution) in
            [(0.35, 0.375, 0.85), (0.1, 3.0, 0.6), (0.6, 0.05, 0.99), (0.2, 0.9, 1.0), (0.8, 20.0, 0.9)]
        {
            let block = FullBlock { frequency_squared: 1.0, slenderness };
            let body = FullBody { block, lever: CentreOfMass, consistent: false, vertical: false };
            let swings = HalfCycles::of(&block, &FullInerter { body, coupling }, false);
            let sums = DecaySums::of(&swings, restitution).unwrap();
            for speed in [1e-9, 1e-7, 1e-5, 0.01, 0.1, 0.2, 0.3, 0.4] {
                let counted = 1e-6 * slenderness;
                let (summed, swung) = (sums.decay(&swings, speed, counted, 1e3), swings.decay(speed, restitution, counted, 1e3));
                assert_eq!(summed.is_some(), swung.is_some());
                if let (Some(summed), Some(swung)) = (summed, swung) {
                    assert!(
                        (summed.duration / swung.duration - 1.0).abs() < 1e-12,
                        "{slenderness} {speed}: {summed:?} {swung:?}"
                    );
                    assert_eq!((summed.impacts, summed.speed), (swung.impacts, 0.0), "{slenderness} {speed}");
                    assert!((summed.rotation / swung.rotation - 1.0).abs() < 1e-13 && summed.acceleration == swung.acceleration);
                    compared += 1;
                    // As far as the time goes, and from there on.
                    let cut = (1..60)
                        .filter_map(|n| sums.decay(&swings, speed, 0.0, summed.duration * 0.97 * f64::from(n) / 60.0))
                        .find(|cut| cut.impacts % 2 == 1);
                    if let Some(cut) = cut {
                        let rest = sums.decay(&swings, -cut.speed, 0.0, 1e3).unwrap();
                        assert!((cut.duration + rest.duration - summed.duration).abs() < 1e-12 * summed.duration, "{cut:?}");
                    }
                }
            }
        }
        assert!(compared > 20, "{compared}");
    }

    #[test]
    fn what_hardly_decays_is_not_summed() {
        let block = FullBlock { frequency_squared: 1.0, slenderness: 0.3 };
        let body = FullBody { block, lever: CentreOfMass, consistent: false, vertical: false };
        let swings = |coupling| HalfCycles::of(&block, &FullInerter { body, coupling }, false);
        assert!(DecaySums::of(&swings(1e-4), 1.0).is_none() && DecaySums::of(&swings(1.0), 0.0).is_none());
        assert!(DecaySums::of(&swings(1e-4), 0.99).is_some());
    }
}
