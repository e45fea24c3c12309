//! How long free rocking takes from one rotation to another, by the first integral.
//!
//! Let e be ω² at the tip, q = 0 (below 0: the ω² that a motion lacks to reach it), and E(q) what ω² is larger by at q, so that ω² = e + E. With
//! f(E) = √E p²/|θ̈| the time along a motion is dt = dq/ω = f dE/(2√E ω), and with E = |e| cosh² u where the motion turns before the tip, E = e sinh² u where it
//! passes it, dt = f du. Of a slender block f is constant. Of any other it is a power series in E, and W_j = ∫ E^j du has a recurrence,
//!
//! t = Σ f_j W_j,  W_0 = u = ln((ω + √E)/√|e|),  2j W_j = E^{j−½} ω − (2j − 1) e W_{j−1}.

use core::f64::consts::FRAC_PI_2;

use crate::equation::first_integral::{FirstIntegral, PACE_TERMS};
use crate::math;
use crate::math::quadrature::integral;
use crate::math::root::bisection;
use crate::math::scalar::Real;

/// Size of the terms left out, relative to the first.
const TOLERANCE: f64 = 1e-15;

/// The series of one mode of the clutch.
#[derive(Clone, Copy, Debug)]
pub struct LegTime<I> {
    /// The first integral.
    pub integral: I,
    /// f_j.
    pace: [f64; PACE_TERMS],
    /// Largest q (rad, up to π/2) and E for which the terms suffice.
    reach: (f64, f64),
}

/// Longest panel, rad, of the integral over q beyond the reach of the series.
const LONGEST_PANEL: f64 = 0.125;

impl<I: FirstIntegral> LegTime<I> {
    /// That of the motions with this first integral.
    pub fn of(integral: I) -> LegTime<I> {
        let pace = integral.pace();
        let last = math::RECIPROCALS[PACE_TERMS - 1];
        // The coefficients grow like E_b^−j, with E_b the next singular point of f.
        let growth = (pace[PACE_TERMS - 1].abs() / pace[0]).rough_power(last);
        let energy = TOLERANCE.rough_power(math::RECIPROCALS[PACE_TERMS]) / growth;
        let reach = if integral.energy(FRAC_PI_2) <= energy {
            (FRAC_PI_2, f64::INFINITY)
        } else {
            let q = bisection(0.0, FRAC_PI_2, 1e-3, |q| integral.energy(q) > energy) - 1e-3;
            (q, integral.energy(q))
        };
        LegTime { integral, pace, reach }
    }

    /// Time (1/p) between `q` (rad, 0 to π/2), where ω² = `squared`, and the turn of this motion, or the tip if it passes that. `None` where the
    /// series does not reach, or the time has no end.
    pub fn from_middle(&self, q: f64, squared: f64) -> Option<f64> {
        let energy = self.integral.energy(q);
        let tip = squared - energy;
        let (last, reach) = self.reach;
        // A motion that turns near the reach is slow there.
        if tip == 0.0 || tip > reach || (q > last && tip < -0.5 * reach) {
            return None;
        }
        if q <= last {
            return Some(self.by_series(energy, squared, tip));
        }
        let squared_speed = |q: f64| self.integral.energy(q) + tip;
        let [beyond] = integral(last, q, LONGEST_PANEL, |q: f64| [1.0 / math::square_root(squared_speed(q))]);
        Some(self.by_series(reach, squared_speed(last), tip) + beyond)
    }

    fn by_series(&self, energy: f64, squared: f64, tip: f64) -> f64 {
        let speed = math::square_root(squared);
        let root = math::square_root(energy);
        let mut moment = math::ln((speed + root) / math::square_root(tip.abs()));
        let mut time = self.pace[0] * moment;
        // E^{j−½} ω
        let mut product = root * speed;
        for (j, pace) in self.pace.iter().enumerate().skip(1) {
            // One product and one difference from moment to moment: they wait for each other.
            let half = 0.5 * math::RECIPROCALS[j & 63];
            let share = tip * ((2 * j - 1) as f64 * half);
            moment = product * half - share * moment;
            let term = pace * moment;
            time += term;
            if term.abs() <= time * 1e-17 {
                break;
            }
            product *= energy;
        }
        time
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::first_integral::{FullIntegral, SlenderIntegral};

    /// A slender block's motion is hyperbolic: from its turn q = q_t cosh(t/√I), through the tip q = ω₀ √I sinh(t/√I).
    #[test]
    fn the_slender_block_has_its_closed_form() {
        let inertia: f64 = 1.7;
        let leg = LegTime::of(SlenderIntegral { inertia });
        for time in [0.01_f64, 0.5, 3.0] {
            let s = time / math::square_root(inertia);
            let (q, speed) = (0.1 * math::cosh(s), 0.1 * math::sinh(s) / math::square_root(inertia));
            assert!((leg.from_middle(q, speed * speed).unwrap() - time).abs() < 1e-14);
            let (q, speed) = (0.1 * math::square_root(inertia) * math::sinh(s), 0.1 * math::cosh(s));
            assert!((leg.from_middle(q, speed * speed).unwrap() - time).abs() < 1e-14);
        }
    }

    /// Against the integral over many panels, which starts where the motion turns or passes the tip.
    #[test]
    fn a_leg_is_the_integral_over_its_rotation() {
        for coupling in [0.0, 1e-6, 0.375, 3.0, 80.0] {
            let full = FullIntegral { coupling };
            let leg = LegTime::of(full);
            for (from, to) in [(1e-3_f64, 0.35), (0.1, 0.11), (0.2, 0.5), (0.02, 0.9)] {
                // q = from cosh u takes the slow start out.
                let squared = full.squared_speed(from, 0.0, to);
                let end = math::acosh(to / from);
                let [turning] = integral(0.0, end, 0.15, |u: f64| {
                    let q = from * math::cosh(u);
                    [from * math::sinh(u) / math::square_root(full.squared_speed(from, 0.0, q))]
                });
                if let Some(found) = leg.from_middle(to, squared) {
                    assert!((found / turning - 1.0).abs() < 1e-11, "{coupling} {from} {to}: {found} {turning}");
                } else {
                    assert!(coupling > 50.0 && to > 0.4, "{coupling} {from} {to}");
                }
                let squared = full.squared_speed(0.0, from * from, to);
                let scale = from * math::square_root(1.0 + coupling);
                let end = math::ln(to / scale + math::square_root(1.0 + to * to / (scale * scale)));
                let [passing] = integral(0.0, end, 0.15, |u: f64| {
                    [scale * math::cosh(u) / math::square_root(full.squared_speed(0.0, from * from, scale * math::sinh(u)))]
                });
                if let Some(found) = leg.from_middle(to, squared) {
                    assert!((found / passing - 1.0).abs() < 1e-11, "{coupling} {from} {to}: {found} {passing}");
                } else {
                    assert!(coupling > 50.0 && from > 0.05, "{coupling} {from} {to}");
                }
            }
        }
    }
}
