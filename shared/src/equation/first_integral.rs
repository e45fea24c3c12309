//! First integral (energy) of free rocking.
//!
//! On quiet ground and between clutch switches, with q = α − |θ| and k = σ/λ while the inerter is engaged (0 while not), in units of 1/p,
//!
//! ½ω² + atan(√k cos q)/√k = constant (full model, paper kinematics, inerter at the centre of mass; k → 0: ½ω² + cos q),
//! ω² − q²/(1 + kℓ²) = constant (slender model),
//!
//! the integrals of θ̈ over θ of Eq. 13-18. The outcome after a pulse and the peaks then need no integration
//! ([`crate::motion::rest::free_motion`]). Differences of cosines and arc tangents are written so that nothing cancels.

use crate::math;
use crate::math::power_series::product_coefficient as product;

/// First integral of one mode of the clutch: ω² as a function of q along a free motion; q in rad, below π/2, ω in p rad.
pub trait FirstIntegral: Copy {
    /// ω² at q = `to` of a motion that has ω² = `squared` at q = `from`; not above 0 where it does not get there.
    fn squared_speed(&self, from: f64, squared: f64, to: f64) -> f64;

    /// q > 0 at which an outward motion with ω² = `squared` at q = `from` > 0 turns, or none if it reaches the tip.
    fn turn(&self, from: f64, squared: f64) -> Option<f64>;

    /// |θ̈|/p² at q.
    fn acceleration(&self, q: f64) -> f64;

    /// E(q), by which ω² is larger at q than at the tip, q = 0.
    fn energy(&self, q: f64) -> f64;

    /// Coefficients of f(E) = √E p²/|θ̈| in E: along a motion dt = dq/ω = f dE/(2√E ω).
    fn pace(&self) -> [f64; PACE_TERMS];
}

/// Coefficients that [`FirstIntegral::pace`] has.
pub const PACE_TERMS: usize = 24;

/// First integral of the slender block: θ̈ = −q p²/(1 + κ k ℓ²) (Eq. 17-18).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlenderIntegral {
    /// 1 + κ k ℓ².
    pub inertia: f64,
}

impl FirstIntegral for SlenderIntegral {
    fn squared_speed(&self, from: f64, squared: f64, to: f64) -> f64 {
        squared + (to - from) * (to + from) / self.inertia
    }

    fn turn(&self, from: f64, squared: f64) -> Option<f64> {
        let speed = math::square_root(squared * self.inertia);
        let square = (from - speed) * (from + speed);
        (square > 0.0).then(|| math::square_root(square))
    }

    fn acceleration(&self, q: f64) -> f64 {
        q.abs() / self.inertia
    }

    #[inline]
    fn energy(&self, q: f64) -> f64 {
        q * q / self.inertia
    }

    fn pace(&self) -> [f64; PACE_TERMS] {
        let mut pace = [0.0; PACE_TERMS];
        pace[0] = math::square_root(self.inertia);
        pace
    }
}

/// First integral of the full block, its inerter at the centre of mass: (1 + κ k cos² q) θ̈ = −p² sin q (Eq. 13-16).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullIntegral {
    /// κ k.
    pub coupling: f64,
}

impl FirstIntegral for FullIntegral {
    fn squared_speed(&self, from: f64, squared: f64, to: f64) -> f64 {
        // cos from − cos to.
        let fall = -2.0 * math::sin(0.5 * (from + to)) * math::sin(0.5 * (from - to));
        if self.coupling == 0.0 {
            return squared + 2.0 * fall;
        }
        let root = math::square_root(self.coupling);
        let product = math::cos(from) * math::cos(to);
        squared + 2.0 * math::atan(root * fall / (1.0 + self.coupling * product)) / root
    }

    fn turn(&self, from: f64, squared: f64) -> Option<f64> {
        let half_sine = math::sin(0.5 * from);
        let half_square = half_sine * half_sine;
        // sin²(q/2) at the turn; with T = tan(√k ω²/2), cos q = (cos from + T/√k)/(1 − √k T cos from).
        let square = if self.coupling == 0.0 {
            half_square - 0.25 * squared
        } else {
            let root = math::square_root(self.coupling);
            let angle = 0.5 * root * squared;
            if angle >= math::atan(root) {
                return None;
            }
            let cosine = 1.0 - 2.0 * half_square;
            let tangent = math::tan(angle);
            (half_square - 0.5 * tangent * (root * cosine + 1.0 / root)) / (1.0 - root * cosine * tangent)
        };
        (square > 0.0).then(|| 2.0 * math::asin(math::square_root(square)))
    }

    fn acceleration(&self, q: f64) -> f64 {
        let (sine, cosine) = math::sin_cos(q);
        sine.abs() / (1.0 + self.coupling * cosine * cosine)
    }

    #[inline]
    fn energy(&self, q: f64) -> f64 {
        let half_sine = math::sin(0.5 * q);
        let fall = 2.0 * half_sine * half_sine;
        if self.coupling == 0.0 {
            return 2.0 * fall;
        }
        let root = math::square_root(self.coupling);
        2.0 * math::atan(root * fall / (1.0 + self.coupling * (1.0 - fall))) / root
    }

    /// With Y = sin²(q/2) and g = 1 + κ k cos² q = 1 + κ k (1 − 2Y)², dY/dE = g/4, and f² = g² E/(4 Y (1 − Y)).
    fn pace(&self) -> [f64; PACE_TERMS] {
        const N: usize = PACE_TERMS;
        // 4Y/E, cos q, g, 1 − Y, √(4Y(1 − Y)/E) and f.
        let (mut steep, mut cosine, mut inertia, mut rest) = ([0.0; N], [0.0; N], [0.0; N], [0.0; N]);
        let (mut root, mut pace) = ([0.0; N], [0.0; N]);
        (cosine[0], rest[0]) = (1.0, 1.0);
        for n in 0..N {
            if n > 0 {
                let y = 0.25 * steep[n - 1];
                (cosine[n], rest[n]) = (-2.0 * y, -y);
            }
            inertia[n] = f64::from(u8::from(n == 0)) + self.coupling * product(&cosine, &cosine, n);
            steep[n] = inertia[n] * math::RECIPROCALS[n + 1];
            let square = product(&steep, &rest, n);
            // Of a root r with r² = Σ d_n Eⁿ, 2 r_0 r_n is what the other products leave of d_n.
            root[n] = if n == 0 { math::square_root(square) } else { 0.5 * (square - product(&root, &root, n)) / root[0] };
            pace[n] = (inertia[n] - product(&root, &pace, n)) / root[0];
        }
        pace
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::FRAC_PI_2;

    /// θ̈ of every integral, against d(ω²/2)/dq = θ̈'s magnitude where q grows along the motion.
    #[test]
    fn the_derivative_of_half_the_squared_speed_is_the_acceleration() {
        let check = |integral: &dyn Fn(f64, f64) -> (f64, f64)| {
            for q in [-0.3, -0.02, 0.05, 0.2, 0.5, 0.9] {
                let step = 1e-5;
                let (change, rate) = integral(q - step, q + step);
                assert!((0.5 * change / (2.0 * step) - rate * q.signum()).abs() < 1e-9, "{q}: {change} {rate}");
            }
        };
        for coupling in [0.0, 1e-9, 0.375, 40.0, 750.0] {
            let full = FullIntegral { coupling };
            check(&|from, to| (full.squared_speed(from, 0.0, to), full.acceleration(0.5 * (from + to))));
            let slender = SlenderIntegral { inertia: 1.0 + coupling };
            check(&|from, to| (slender.squared_speed(from, 0.0, to), slender.acceleration(0.5 * (from + to))));
        }
    }

    /// VERIFICATION's closed form, as it is written there.
    #[test]
    fn the_integral_is_constant() {
        let constant = |k: f64, q: f64, squared: f64| {
            let root = math::square_root(k);
            0.5 * squared + if k == 0.0 { math::cos(q) } else { math::atan(root * math::cos(q)) / root }
        };
        for coupling in [0.0, 0.375, 7.5] {
            let integral = FullIntegral { coupling };
            let start = constant(coupling, 0.1, 0.4);
            for q in [-0.2, 0.0, 0.3, 1.1] {
                assert!((constant(coupling, q, integral.squared_speed(0.1, 0.4, q)) - start).abs() < 1e-15);
            }
        }
    }

    /// A motion let go at the turn it found gets back the speed it came with; one beyond the tip's energy does not turn.
    #[test]
    fn turns_are_where_the_speed_is_zero() {
        let check = |turn: Option<f64>, back: &dyn Fn(f64) -> f64, squared: f64| {
            let q = turn.unwrap();
            assert!(q > 0.0 && (back(q) - squared).abs() < 4e-16, "{q} {squared}");
        };
        for coupling in [0.0, 1e-6, 0.375, 75.0] {
            let full = FullIntegral { coupling };
            let slender = SlenderIntegral { inertia: 1.0 + coupling };
            for from in [1e-3, 0.17, 0.6] {
                // ω² of a motion that just reaches the tip.
                let most = -full.squared_speed(from, 0.0, 0.0);
                for share in [1e-9, 0.3, 0.999_999] {
                    check(full.turn(from, share * most), &|q| full.squared_speed(q, 0.0, from), share * most);
                }
                assert_eq!(full.turn(from, most * (1.0 + 1e-12)), None);
                assert_eq!(full.turn(from, 1e3), None);
                let most = -slender.squared_speed(from, 0.0, 0.0);
                check(slender.turn(from, 0.4 * most), &|q| slender.squared_speed(q, 0.0, from), 0.4 * most);
                assert_eq!(slender.turn(from, most * (1.0 + 1e-12)), None);
            }
        }
    }

    /// Of the bare block E = 4 sin²(q/2), so f = (1 − E/4)^(-1/2); of any, f is what the definition says.
    #[test]
    fn the_pace_is_that_of_the_motion() {
        let sum = |pace: &[f64; PACE_TERMS], energy: f64| pace.iter().rev().fold(0.0, |sum, c| sum * energy + c);
        let bare = FullIntegral { coupling: 0.0 };
        assert!((sum(&bare.pace(), 0.7) * math::square_root(1.0 - 0.7 / 4.0) - 1.0).abs() < 1e-15);
        let check = |integral: &dyn Fn(f64) -> (f64, f64), pace: &[f64; PACE_TERMS], q: f64| {
            let (energy, acceleration) = integral(q);
            assert!((sum(pace, energy) * acceleration / math::square_root(energy) - 1.0).abs() < 1e-13, "{q}");
        };
        for coupling in [0.0, 1e-9, 0.375, 2.0, 100.0] {
            let full = FullIntegral { coupling };
            let slender = SlenderIntegral { inertia: 1.0 + coupling };
            for q in [1e-6, 0.1, 0.3] {
                check(&|q| (full.energy(q), full.acceleration(q)), &full.pace(), q);
                check(&|q| (slender.energy(q), slender.acceleration(q)), &slender.pace(), q);
                assert!((full.energy(q) / full.squared_speed(0.0, 0.0, q) - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn small_angles_of_the_full_block_are_the_slender_one() {
        let (full, slender) = (FullIntegral { coupling: 0.5 }, SlenderIntegral { inertia: 1.5 });
        let (from, squared, to) = (1e-4, 2e-9, 5e-5);
        assert!((full.squared_speed(from, squared, to) / slender.squared_speed(from, squared, to) - 1.0).abs() < 1e-8);
        assert!((full.acceleration(from) / slender.acceleration(from) - 1.0).abs() < 1e-8);
        assert!((full.turn(from, squared).unwrap() / slender.turn(from, squared).unwrap() - 1.0).abs() < 1e-8);
        assert!(full.acceleration(FRAC_PI_2) > 0.99);
    }
}
