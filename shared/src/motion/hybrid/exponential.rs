//! The exponential midpoint step: the spring of a clutch is solved exactly, so that its stiffness does not bound the step.
//!
//! With ℓ, the weight, the ground and all losses frozen at the middle of the step, rack and flywheel are a linear oscillator in
//! the twist y = x − o of the clutch,
//!
//! ÿ + q C ẏ + q K y = ℓA − r,  q = ℓ²/(1 + K_r ℓ²) + 1/k,
//!
//! where A and r are the accelerations of block and flywheel without the clutch. Its solution is known for any step; the momentum
//! that the spring has passed on follows from J = ∫F dt = ((ℓA − r) h − Δẏ)/q. What is frozen makes the step one of order 2, whatever
//! K and C are (Hochbruck and Ostermann 2010, for the frozen-coefficient view).

use super::mode_output::{KnownModeStart, ModeStart, Place};
use crate::drivetrain::clutch_state::ModeCoefficients;
use crate::drivetrain::transmission::Transmission;
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::math::RECIPROCALS;
use crate::math::scalar::Real;

/// ÿ + 2a ẏ + Ω² y = B, from y and ẏ over `h`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator<S> {
    /// a, 1/s; 0 or more.
    pub damping: S,
    /// Ω², 1/s²; above 0.
    pub stiffness: S,
    /// B, 1/s².
    pub push: S,
}

impl<S: Real> Oscillator<S> {
    /// What y and ẏ are `h` (s) later beyond y + ẏh and ẏ. However short the step, their digits are their own: those of y would not resolve the
    /// swings of a block that comes to rest.
    pub fn bend(&self, h: S, (y, rate): (S, S)) -> (S, S) {
        let Oscillator { damping: a, stiffness, push } = *self;
        let (fade, turn) = (S::of(2.0) * a * h, stiffness * h * h);
        // In longer steps the closed form, which is quicker, loses few of them.
        if fade > S::ONE || turn > S::of(0.01) {
            let (later, later_rate) = self.after(h, (y, rate));
            return (later - y - rate * h, later_rate - rate);
        }
        // ẏ after a push of 1 that sets in now, over h, as a power series in h; and its first two integrals.
        let (mut before, mut term) = (S::ZERO, S::ONE);
        let (mut first, mut second, mut third) = (S::ZERO, S::ZERO, S::ZERO);
        for m in 0..2 * S::STUMPFF_TERMS + 2 {
            let [one, two, three] = [1, 2, 3].map(|k| S::of(RECIPROCALS[(m + k) & 63]));
            first = first + term;
            second = second + term * two;
            third = third + term * two * three;
            (before, term) = (term, -(fade * term + turn * before * one) * two);
            if term.abs() + turn * before.abs() < S::EPSILON * S::of(0.01) {
                break;
            }
        }
        let (pushed, growth) = (push - S::of(2.0) * a * rate - stiffness * y, stiffness * rate * h);
        (h * h * (pushed * second - growth * third), h * (pushed * first - growth * second))
    }

    /// y and ẏ after `h` (s), in closed form.
    fn after(&self, h: S, (y, rate): (S, S)) -> (S, S) {
        let Oscillator { damping: a, stiffness, push } = *self;
        let middle = push / stiffness;
        let u = y - middle;
        let discriminant = stiffness - a * a;
        let w = discriminant.abs().square_root();
        let x = w * h;
        if discriminant < S::ZERO && x >= S::of(1e-3) {
            let fast = a + w;
            let slow = stiffness / fast;
            let (slow_left, fast_left) = ((-(slow * h)).exp(), (-(fast * h)).exp());
            let (p, q) = (rate + fast * u, rate + slow * u);
            let scale = S::HALF / w;
            return (middle + (p * slow_left - q * fast_left) * scale, (fast * q * fast_left - slow * p * slow_left) * scale);
        }
        // Critical damping is where both formulas lose their digits: sin x/x and cos x as series there.
        let (cos, sin_over_w) = if x < S::of(1e-3) {
            let squared = if discriminant < S::ZERO { -(x * x) } else { x * x };
            (S::ONE - S::HALF * squared, h * (S::ONE - squared * S::of(1.0 / 6.0)))
        } else {
            let (sin, cos) = x.sin_cos_of_phase();
            (cos, sin / w)
        };
        let left = (-(a * h)).exp();
        (middle + left * (u * cos + (rate + a * u) * sin_over_w), left * (rate * cos - (stiffness * u + a * rate) * sin_over_w))
    }
}

/// Coefficients frozen over a step.
struct Frozen<S, const X: usize> {
    arm: S,
    /// ℓ/(1 + K_r ℓ²).
    leverage: S,
    acceleration: S,
    rates: [S; X],
}

fn freeze<S: Real, B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
    soft: &KnownModeStart<'_, S, B, D, X, G>,
    at: &Place<S, X>,
) -> Frozen<S, X> {
    let (acceleration, rates) = soft.rates(at);
    let ModeStart { law, side, .. } = *soft.start;
    let arm = soft.body.arm(&soft.body.configuration(side.unit(), at.rotation));
    let leverage = if soft.is_held() { S::ZERO } else { arm / (S::ONE + law.coupling * arm * arm) };
    Frozen { arm, leverage, acceleration, rates }
}

/// The frozen system a time `h` after `from`, exactly; `ground` is the ground's acceleration then, in g.
fn solve<S: Real, B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
    known: &KnownModeStart<'_, S, B, D, X, G>,
    from: &Place<S, X>,
    frozen: &Frozen<S, X>,
    (h, ground): (S, Accelerations<S>),
) -> Place<S, X> {
    let law = known.start.law;
    let half_square = S::HALF * h * h;
    let mut velocity = from.velocity + h * frozen.acceleration;
    let mut rotation = from.rotation + h * from.velocity + half_square * frozen.acceleration;
    let mut unknowns = from.unknowns;
    for (value, &rate) in unknowns.iter_mut().zip(&frozen.rates) {
        *value = *value + h * rate;
    }
    let parameters = &known.start.system.transmission.parameters;
    let contact = [0, 1].map(|i| law.stiffness[i] > S::ZERO && !(known.is_held() && law.moves[i] == S::ZERO));
    let both = contact[0] && contact[1];
    let coupled = frozen.arm * frozen.leverage;
    let twist = [0, 1].map(|i| from.unknowns[i + 2] - law.rest_twist[i]);
    let slide = [0, 1].map(|i| frozen.arm * from.velocity - from.unknowns[i]);
    let push = [0, 1].map(|i| frozen.arm * frozen.acceleration - frozen.rates[i]);
    let gain = [0, 1].map(|i| if both { parameters.mobility } else { law.moves[i] * parameters.mobility });
    // Impulse of each spring and its integral. Two springs of one kind part into their mean and their difference.
    let mode = |q: S, push: S, y: S, rate: S| {
        let oscillator = Oscillator { damping: S::HALF * q * parameters.damping, stiffness: q * parameters.stiffness, push };
        let (bend, turned) = oscillator.bend(h, (y, rate));
        ((y + rate * h) + bend, (push * h - turned) / q, (push * half_square - bend) / q)
    };
    let none = (S::ZERO, S::ZERO, S::ZERO);
    let springs = if both {
        let two = S::of(2.0);
        let (sum, sum_j, sum_jj) =
            mode(two * coupled + parameters.mobility, push[0] + push[1], twist[0] + twist[1], slide[0] + slide[1]);
        let (difference, j, jj) = mode(parameters.mobility, push[0] - push[1], twist[0] - twist[1], slide[0] - slide[1]);
        let half = |a: S, b: S| S::HALF * (a + b);
        [(half(sum, difference), half(sum_j, j), half(sum_jj, jj)), (half(sum, -difference), half(sum_j, -j), half(sum_jj, -jj))]
    } else {
        [0, 1].map(|i| if contact[i] { mode(coupled + gain[i], push[i], twist[i], slide[i]) } else { none })
    };
    for i in 0..2 {
        if contact[i] {
            let (y, impulse, integral) = springs[i];
            velocity = velocity - frozen.leverage * impulse;
            rotation = rotation - frozen.leverage * integral;
            unknowns[i] = unknowns[i] + gain[i] * impulse;
            unknowns[i + 2] = law.rest_twist[i] + y;
        } else if law.relaxation[i] > S::ZERO {
            // The twist of a saturated clutch relaxes by K/C: exactly, too.
            let held = law.slip[i] / parameters.stiffness;
            unknowns[i + 2] =
                law.rest_twist[i] + held + (twist[i] - held) * (-(parameters.stiffness * law.relaxation[i] * h)).exp();
        }
    }
    Place { time: h, ground, rotation, velocity, unknowns }
}

/// The state a time `h` after `from`, where the ground's acceleration (in g) is `ground`. Order 2; stable for every stiffness.
pub(super) fn midpoint<S: Real, B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
    known: &KnownModeStart<'_, S, B, D, X, G>,
    from: &Place<S, X>,
    (h, ground): (S, Accelerations<S>),
) -> Place<S, X> {
    let law = ModeCoefficients { stiffness: [S::ZERO; 2], damping: [S::ZERO; 2], ..*known.start.law };
    let soft = ModeStart { law: &law, ..*known.start };
    let soft = KnownModeStart { start: &soft, ..*known };
    let half = S::HALF * h;
    let middle = solve(known, from, &freeze(&soft, from), (half, known.start.ground_at(half)));
    solve(known, from, &freeze(&soft, &middle), (h, ground))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two half steps are one step, and the derivative at 0 is the equation.
    #[test]
    fn the_oscillator_is_a_flow_of_its_equation() {
        for (damping, stiffness) in
            [(0.0, 9.0), (0.3, 9.0), (3.0, 9.0), (3.0 + 1e-9, 9.0), (2.9999, 9.0), (40.0, 9.0), (5.0, 1e6)]
        {
            let oscillator = Oscillator { damping, stiffness, push: 0.7 };
            let start = (0.2_f64, -1.1);
            let half = oscillator.after(0.5, oscillator.after(0.5, start));
            let whole = oscillator.after(1.0, start);
            let size = 1.0 + stiffness.sqrt();
            assert!((half.0 - whole.0).abs() < 1e-9 && (half.1 - whole.1).abs() < 1e-9 * size, "a = {damping}, Ω² = {stiffness}");
            let h = 1e-5;
            let (ahead, behind) = (oscillator.after(h, start), oscillator.after(-h, start));
            let curvature = (ahead.1 - behind.1) / (2.0 * h);
            let expected = 0.7 - 2.0 * damping * start.1 - stiffness * start.0;
            assert!((curvature - expected).abs() < 1e-4 * (1.0 + expected.abs()), "a = {damping}: {curvature} and {expected}");
        }
    }

    /// In short steps it is the same motion, to digits of its own.
    #[test]
    fn a_short_step_bends_by_half_its_square() {
        for (damping, stiffness) in [(0.0, 1e4), (3.0, 1e4), (100.0, 1e4), (180.0, 1e4), (5e3, 1e4), (1e-3, 1e-6)] {
            let oscillator = Oscillator { damping, stiffness, push: 0.7 };
            let (y, rate) = (0.2_f64, -1.1);
            let pushed = 0.7 - 2.0 * damping * rate - stiffness * y;
            for h in [1e-9, 1e-12, 1e-15] {
                let (bend, turned) = oscillator.bend(h, (y, rate));
                let size = 1.0 + 2.0 * damping + stiffness.sqrt();
                assert!((bend / (0.5 * h * h * pushed) - 1.0).abs() < 1e-14 + size * h, "a = {damping}, Ω² = {stiffness}, {h}");
                assert!((turned / (h * pushed) - 1.0).abs() < 1e-14 + size * h, "a = {damping}, Ω² = {stiffness}, {h}");
            }
            // Where the formula changes.
            let h = (0.1 / stiffness.sqrt()).min(0.5 / damping);
            let (below, above) = (oscillator.bend(h * (1.0 - 1e-14), (y, rate)), oscillator.bend(h * (1.0 + 1e-14), (y, rate)));
            let lost = 3e-15 / (stiffness * h * h);
            assert!((below.0 / above.0 - 1.0).abs() < lost && (below.1 / above.1 - 1.0).abs() < lost, "{below:?} {above:?}");
        }
    }

    /// Any stiffness and any step: the amplitude never grows.
    #[test]
    fn no_stiffness_makes_it_grow() {
        for stiffness in [1.0, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12, 1e13] {
            let stiffness: f64 = stiffness;
            let oscillator = Oscillator { damping: 0.05 * stiffness.sqrt(), stiffness, push: 0.0 };
            let (mut y, mut rate) = (1.0, 0.0);
            let energy = |y: f64, rate: f64| 0.5 * (stiffness * y * y + rate * rate);
            let first = energy(y, rate);
            for _ in 0..100 {
                (y, rate) = oscillator.after(0.01, (y, rate));
                assert!(energy(y, rate) <= first * (1.0 + 1e-9));
            }
        }
    }
}
