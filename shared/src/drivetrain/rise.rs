//! Rise of the plates' capacity from first contact to the full one: linear, or exponential as the torque of a coil is.
//!
//! The current of a coil of resistance r and inductance L approaches its end as 1 − e^(−t/τ), τ = L/r, and the torque that it presses the plates
//! to follows: data sheets of electromagnetic clutches give such a time constant of the torque. The capacity takes that by straight lines, so that
//! a mode's force is linear between two clocks: from knot to knot t = −2τ ln(1 − k/32), between which the square root of what is missing falls
//! by 1/32 each, and over a last 2τ. It is nowhere off by more than [`OFF`] of the full capacity.

use super::scaled_parameters::ScaledParameters;
use crate::math::scalar::Real;

/// Lines of an exponential rise.
const LINES: usize = 32;

/// Bound of what the lines miss of 1 − e^(−t/τ), over the full capacity. Between two knots that is some (2/32)²/8, for the second derivative
/// there is that of (1 − k/32)² and the length 2/(32 − k) of τ.
pub const OFF: f64 = 5e-4;

/// Knots of an exponential rise over τ.
const KNOTS: [f64; LINES + 1] = [
    0.0,
    0.0634973966291606,
    0.12907704227514236,
    0.19688014562650505,
    0.26706278524904525,
    0.33979807359079495,
    0.415278729556489,
    0.49372015586305157,
    0.5753641449035618,
    0.6604833737411537,
    0.7493868988828214,
    0.8424269301526071,
    0.9400072584914712,
    1.0425938472665721,
    1.1507282898071236,
    1.265045117487021,
    1.3862943611198906,
    1.515371403395033,
    1.6533571463689358,
    1.8015730906763796,
    1.9616585060234524,
    2.135681260002712,
    2.3263016196113617,
    2.5370226509270144,
    2.772588722239781,
    3.0396515074888266,
    3.347952867143343,
    3.7125959807312525,
    4.1588830833596715,
    4.734247228263234,
    5.545177444479562,
    6.931471805599453,
    8.931471805599454,
];

/// Line of a rising capacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<S> {
    /// Its start and end after first contact, s.
    pub time: [S; 2],
    /// Share of the full capacity there.
    pub share: [S; 2],
}

/// Time of an exponential rise with the time constant τ (s), s.
pub(super) fn whole<S: Real>(time_constant: S) -> S {
    time_constant * S::of(KNOTS[LINES])
}

impl<S: Real> ScaledParameters<S> {
    /// The line of a capacity `time` (s) after first contact; none once it is full.
    #[inline]
    pub fn line_at(&self, time: S) -> Option<Line<S>> {
        if time >= self.rise_time { None } else { Some(self.rising_line(time)) }
    }

    // Out of line: what is full, and every clutch without plates is, costs no more than the comparison.
    #[inline(never)]
    fn rising_line(&self, time: S) -> Line<S> {
        if self.time_constant == S::ZERO {
            return Line { time: [S::ZERO, self.rise_time], share: [S::ZERO, S::ONE] };
        }
        let knot = |index: usize| self.time_constant * S::of(KNOTS[index]);
        let share = |index: usize| {
            let missing = if index == LINES { 0.0 } else { 1.0 - index as f64 / LINES as f64 };
            S::of(1.0 - missing * missing)
        };
        let end = (1..LINES).find(|&index| time < knot(index)).unwrap_or(LINES);
        Line { time: [knot(end - 1), knot(end)], share: [share(end - 1), share(end)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the exponential itself, for ten time constants; the lines meet.
    #[test]
    fn the_lines_follow_the_exponential() {
        let parameters = ScaledParameters { time_constant: 0.08, rise_time: whole(0.08), ..ScaledParameters::default() };
        let (mut most, mut before) = (0.0_f64, 0.0);
        for step in 0..=100_000 {
            let x = f64::from(step) * 1e-4;
            let share = parameters.line_at(0.08 * x).map_or(1.0, |line| {
                let [from, to] = line.time;
                line.share[0] + (line.share[1] - line.share[0]) * (0.08 * x - from) / (to - from)
            });
            most = most.max((share - (1.0 - Real::exp(-x))).abs());
            assert!(share >= before && share - before < 1.1e-4, "{share} after {before} at {x}");
            before = share;
        }
        assert!(most < OFF && most > 0.9 * OFF, "{most}");
        assert_eq!(before, 1.0);
    }
}
