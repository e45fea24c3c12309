//! The low-pass filter of an inertial sensor: a Butterworth filter of second order,
//!
//! ÿ + √2 ω ẏ + ω² y = ω² u,  ω = 2π f_c,
//!
//! solved in closed form over every straight piece of its input. It is thus the analogue filter itself at whatever instants it is read:
//! |H(f_c)| = 1/√2 and the delay at low frequency is √2/ω, without the warping of a filter that runs at the sampling rate (a bilinear
//! one with its corner at a quarter of the rate would be a fifth too fast).

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use sprag_shared::math;

/// Value of a filtered signal and its rate over σ = ω/√2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct State {
    /// y.
    pub(super) value: f64,
    /// ẏ/σ.
    pub(super) slope: f64,
}

/// Spans that the filter remembers. Between two calls at regular times there are three: up to the first sample, from sample to sample,
/// and from the last one on.
const REMEMBERED: usize = 4;

/// Spans that differ by less than this fraction are one: those from sample to sample differ by rounding. It is far below what an f32 shows.
const SAME_SPAN: f64 = 1e-9;

/// What is left of a free motion counts as nothing from here down, in the unit of the axis: a filter whose input is constant would go on
/// with numbers so small that a processor takes a hundred times as long for each.
const NOTHING: f64 = 1e-200;

/// `value`, or 0 where that is all that a reading could show of it.
#[inline(always)]
fn settled(value: f64) -> f64 {
    if value.abs() < NOTHING { 0.0 } else { value }
}

/// The factors of a free motion over a span.
#[derive(Clone, Copy, Debug)]
struct Free {
    /// s.
    span: f64,
    /// By rows, of value and slope on value and slope.
    transition: [[f64; 2]; 2],
}

/// The filter.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowPass {
    /// σ, 1/s.
    decay: f64,
    remembered: [Free; REMEMBERED],
    oldest: usize,
}

impl LowPass {
    /// A filter with its −3 dB corner at `bandwidth` (Hz, above 0).
    pub(super) fn new(bandwidth: f64) -> LowPass {
        let at_once = Free { span: 0.0, transition: [[1.0, 0.0], [0.0, 1.0]] };
        LowPass { decay: 2.0 * PI * FRAC_1_SQRT_2 * bandwidth, remembered: [at_once; REMEMBERED], oldest: 0 }
    }

    /// The factors of a free motion over `span` (s): by rows, of value and slope on value and slope.
    pub(super) fn transition(&mut self, span: f64) -> [[f64; 2]; 2] {
        let place = self.place(span);
        self.remembered[place].transition
    }

    /// Where the factors over `span` (s) are remembered. Whoever needs them reads them there: a copy on the stack would be read by other
    /// pairs than it was written by, which a processor waits for.
    #[inline(always)]
    fn place(&mut self, span: f64) -> usize {
        let same = SAME_SPAN * span;
        for (place, free) in self.remembered.iter().enumerate() {
            if (free.span - span).abs() <= same {
                // One that is in use is not the next to go, or irregular calls would drive out the sampling period.
                if place == self.oldest {
                    self.oldest = (self.oldest + 1) % REMEMBERED;
                }
                return place;
            }
        }
        self.work_out(span)
    }

    #[inline(never)]
    fn work_out(&mut self, span: f64) -> usize {
        // exp(−σ span) (cos σ span, sin σ span).
        let (sine, cosine) = math::sin_cos(self.decay * span);
        let factor = math::exp(-self.decay * span);
        let (cosine, sine) = (factor * cosine, factor * sine);
        let place = self.oldest;
        self.remembered[place] = Free { span, transition: [[cosine + sine, sine], [-2.0 * sine, cosine - sine]] };
        self.oldest = (place + 1) % REMEMBERED;
        place
    }

    /// Takes `states` on by `span` (s, not negative) while their inputs go straight from `from` to `to`.
    #[inline(always)]
    pub(super) fn follow<const AXES: usize>(
        &mut self,
        states: &mut [State; AXES],
        span: f64,
        from: &[f64; AXES],
        to: &[f64; AXES],
    ) {
        if span <= 0.0 {
            return;
        }
        let place = self.place(span);
        let [[own, across], [back, slope_own]] = &self.remembered[place].transition;
        let steepness = 1.0 / (self.decay * span);
        for axis in 0..AXES {
            // A ramp is followed at its own slope and √2/ω = 1/σ behind; what differs from that dies away.
            let ramp = (to[axis] - from[axis]) * steepness;
            let state = &mut states[axis];
            let (value, slope) = (state.value - from[axis] + ramp, state.slope - ramp);
            state.value = settled(to[axis] - ramp + own * value + across * slope);
            state.slope = settled(ramp + back * value + slope_own * slope);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Amplitude ratio and delay (s) of a sine of `frequency`, given to the filter in straight pieces.
    fn response(bandwidth: f64, frequency: f64) -> (f64, f64) {
        let pieces = 2000;
        let mut filter = LowPass::new(bandwidth);
        let mut state = [State::default()];
        let angle = |piece: i32| 2.0 * PI * f64::from(piece) / f64::from(pieces);
        let (mut along, mut across) = (0.0, 0.0);
        // The first periods are left to what dies away.
        let settled = (10.0 * frequency / bandwidth).ceil() as i32 + 3;
        for piece in 0..pieces * (settled + 1) {
            let (from, to) = (math::sin(angle(piece)), math::sin(angle(piece + 1)));
            filter.follow(&mut state, 1.0 / (frequency * f64::from(pieces)), &[from], &[to]);
            if piece >= pieces * settled {
                along += state[0].value * to * 2.0 / f64::from(pieces);
                across += state[0].value * math::cos(angle(piece + 1)) * 2.0 / f64::from(pieces);
            }
        }
        (math::hypot(along, across), -math::atan2(across, along) / (2.0 * PI * frequency))
    }

    #[test]
    fn the_corner_is_3_db_down_and_low_frequencies_are_delayed_as_they_should() {
        for bandwidth in [42.0, 536.0, 3000.0] {
            let (ratio, delay) = response(bandwidth, bandwidth);
            assert!((ratio - FRAC_1_SQRT_2).abs() < 1e-5, "{ratio}");
            // A quarter of a period at the corner.
            assert!((delay * bandwidth - 0.25).abs() < 1e-5, "{delay}");
            let (ratio, delay) = response(bandwidth, 0.02 * bandwidth);
            assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
            assert!((delay * 2.0 * PI * bandwidth / 2.0_f64.sqrt() - 1.0).abs() < 1e-3, "{delay}");
            let (ratio, _) = response(bandwidth, 10.0 * bandwidth);
            assert!((ratio * 100.0 - 1.0).abs() < 1e-3, "{ratio}");
        }
    }

    #[test]
    fn pieces_of_a_straight_line_add_up() {
        let start = [State { value: 0.3, slope: -0.2 }];
        let (mut whole, mut parts) = (start, start);
        LowPass::new(100.0).follow(&mut whole, 3e-3, &[1.0], &[4.0]);
        let mut filter = LowPass::new(100.0);
        for (span, from, to) in [(1e-3, 1.0, 2.0), (0.0, 2.0, 2.0), (0.5e-3, 2.0, 2.5), (1.5e-3, 2.5, 4.0)] {
            filter.follow(&mut parts, span, &[from], &[to]);
        }
        assert!((whole[0].value - parts[0].value).abs() < 1e-13 && (whole[0].slope - parts[0].slope).abs() < 1e-13);
    }

    #[test]
    fn a_step_overshoots_by_4_3_percent_and_what_is_settled_stays() {
        let mut filter = LowPass::new(50.0);
        let mut state = [State::default()];
        let mut peak: f64 = 0.0;
        for _ in 0..1000 {
            filter.follow(&mut state, 5e-5, &[1.0], &[1.0]);
            peak = peak.max(state[0].value);
        }
        // exp(−π) for a damping of 1/√2.
        assert!((peak - 1.0 - math::exp(-PI)).abs() < 1e-5, "{peak}");
        let mut state = [State { value: 0.7, slope: 0.0 }];
        filter.follow(&mut state, 1e-3, &[0.7], &[0.7]);
        assert_eq!(state[0], State { value: 0.7, slope: 0.0 });
    }

    #[test]
    fn what_dies_away_ends_in_nothing_and_not_in_subnormal_numbers() {
        let mut filter = LowPass::new(550.0);
        let mut state = [State { value: 0.7, slope: -0.3 }];
        let mut subnormal = 0;
        for _ in 0..10_000 {
            filter.follow(&mut state, 1.25e-4, &[0.0], &[0.0]);
            subnormal += u32::from(state[0].value.is_subnormal() || state[0].slope.is_subnormal());
        }
        assert_eq!((subnormal, state[0]), (0, State::default()));
    }
}
