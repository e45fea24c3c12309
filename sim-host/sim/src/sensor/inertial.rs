//! Gyroscopes and accelerometers.

use sprag_shared::control::sensing::sample::Reading;
use sprag_shared::math;

use super::delivery::Delivery;
use super::drift::{Drift, Wander};
use super::low_pass::{LowPass, State};
use super::noise::Noise;
use super::random::{Purpose, Random};
use super::sampling::{Clock, SAME_INSTANT, Sampling};

/// An inertial sensor in the unit of its axes (rad/s, or m/s²). Every imperfection is off, and costs nothing, at 0. Of a truth x the
/// sensor reads
///
/// Q(sat(h ∗ (M x + n) + b + d)),
///
/// with M scale and misalignment, h the low-pass filter, n white noise, b the turn-on bias, d the bias drift, sat the full scale and Q
/// the quantisation. M and b are drawn once: a seed is one specimen at one turn-on, and many seeds are a batch of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// Density of the white noise, one-sided, unit/√Hz; not negative. See [`super::noise::output_deviation`] for what comes out.
    pub noise_density: f64,
    /// Standard deviation of the turn-on bias, normal, unit; not negative.
    pub bias: f64,
    /// Bias drift.
    pub drift: Drift,
    /// Standard deviation of the scale error of each axis, normal, as a fraction; not negative.
    pub scale_error: f64,
    /// Standard deviation of the angle by which each axis is off within the plane of motion, normal, rad; not negative. Of ψ, an
    /// accelerometer's axes read x₁ cos ψ₁ + x₂ sin ψ₁ and x₂ cos ψ₂ − x₁ sin ψ₂: ψ₁ = ψ₂ is a rotated case, the difference is cross-axis
    /// sensitivity. A gyroscope reads x cos ψ, and nothing else: a plane motion has no other rate that it could pick up.
    pub misalignment: f64,
    /// −3 dB corner of the Butterworth low-pass of second order, Hz; 0 for none.
    pub bandwidth: f64,
    /// Step of the output, unit; 0 for none.
    pub resolution: f64,
    /// Largest output either way, unit; 0 for no limit. Only the output is limited: what happens ahead of the filter is not modelled.
    pub full_scale: f64,
    /// When it samples, and when that can be read.
    pub sampling: Sampling,
}

impl Inertial {
    /// Reads the truth.
    pub const IDEAL: Inertial = Inertial {
        noise_density: 0.0,
        bias: 0.0,
        drift: Drift::NONE,
        scale_error: 0.0,
        misalignment: 0.0,
        bandwidth: 0.0,
        resolution: 0.0,
        full_scale: 0.0,
        sampling: Sampling::CONTINUOUS,
    };
}

/// `f64::round`, inline: without SSE4.1 that is a call.
#[inline(always)]
fn whole(value: f64) -> f64 {
    // From 2⁵² on every number is whole, so a sum there is rounded to one; by even neighbours where two are as near.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    let nearest = ((value.abs() + WHOLE) - WHOLE).copysign(value);
    if (value - nearest).abs() < 0.5 { nearest } else { rounded(value) }
}

// Out of the way: a compiler that knows what `round` does calls it before it knows whether that is needed.
#[cold]
#[inline(never)]
fn rounded(value: f64) -> f64 {
    value.round()
}

/// What one axis adds.
#[derive(Clone, Debug)]
struct Axis {
    bias: f64,
    noise: Noise,
    drift: Wander,
}

/// All axes at one instant, before the conversion: of several between two ticks only the last is converted.
#[derive(Clone, Copy, Debug)]
struct Outputs<const AXES: usize> {
    values: [f64; AXES],
    number: u32,
}

/// One specimen of an inertial sensor at work.
#[derive(Clone, Debug)]
pub(super) struct InertialSensor<const AXES: usize> {
    ideal: bool,
    full_scale: f64,
    resolution: f64,
    mixing: [[f64; AXES]; AXES],
    axes: [Axis; AXES],
    low_pass: Option<LowPass>,
    filtered: [State; AXES],
    clock: Option<Clock>,
    /// Of the truth last given, s.
    time: f64,
    /// That truth, with scale and misalignment.
    input: [f64; AXES],
    number: u32,
    delivery: Delivery<Outputs<AXES>>,
}

impl<const AXES: usize> InertialSensor<AXES> {
    /// A specimen whose axes have the numbers from `first_axis` on, settled on `truth`, with a reading of it at time 0.
    pub(super) fn new(inertial: &Inertial, seed: u64, first_axis: u64, truth: &[f64; AXES]) -> InertialSensor<AXES> {
        let mut mixing = [[0.0; AXES]; AXES];
        let mut number = first_axis;
        let axes = std::array::from_fn(|axis| {
            // All drawn whether or not they are used, so that each stays the same when another is switched.
            let mut turn_on = Random::new(seed, number, Purpose::TurnOn);
            let bias = inertial.bias * turn_on.normal();
            let scale = 1.0 + inertial.scale_error * turn_on.normal();
            let (sine, cosine) = math::sin_cos(inertial.misalignment * turn_on.normal());
            for (other, factor) in mixing[axis].iter_mut().enumerate() {
                *factor = scale
                    * match other.cmp(&axis) {
                        std::cmp::Ordering::Less => -sine,
                        std::cmp::Ordering::Equal => cosine,
                        std::cmp::Ordering::Greater => sine,
                    };
            }
            let noise = Random::new(seed, number, Purpose::Noise);
            let drift = Random::new(seed, number, Purpose::Drift);
            number += 1;
            Axis {
                bias,
                noise: Noise::new(inertial.noise_density, inertial.bandwidth, inertial.sampling.rate, noise),
                drift: Wander::new(inertial.drift, drift),
            }
        });
        let mut sensor = InertialSensor {
            ideal: *inertial == Inertial::IDEAL,
            full_scale: if inertial.full_scale > 0.0 { inertial.full_scale } else { f64::INFINITY },
            resolution: inertial.resolution,
            mixing,
            axes,
            low_pass: (inertial.bandwidth > 0.0).then(|| LowPass::new(inertial.bandwidth)),
            filtered: [State::default(); AXES],
            clock: Clock::new(&inertial.sampling, Random::new(seed, first_axis, Purpose::Clock)),
            time: 0.0,
            input: [0.0; AXES],
            number: 0,
            delivery: Delivery::new(inertial.sampling.latency, Outputs { values: [0.0; AXES], number: 0 }),
        };
        sensor.input = sensor.mix(truth);
        sensor.filtered = sensor.input.map(|value| State { value, slope: 0.0 });
        let first = sensor.output(&sensor.input.clone(), 0.0);
        sensor.delivery = Delivery::new(inertial.sampling.latency, first);
        sensor
    }

    // Not by `zip` and `map`, which are calls where they land in another unit of code generation.
    #[inline(always)]
    fn mix(&self, truth: &[f64; AXES]) -> [f64; AXES] {
        let mut mixed = [-0.0; AXES];
        for (axis, sum) in mixed.iter_mut().enumerate() {
            for (other, value) in truth.iter().enumerate() {
                *sum += self.mixing[axis][other] * value;
            }
        }
        mixed
    }

    /// Outputs `span` (s) after the last ones: what the filter holds, or else `input`, with its errors.
    #[inline(always)]
    fn output(&mut self, input: &[f64; AXES], span: f64) -> Outputs<AXES> {
        self.number = self.number.wrapping_add(1);
        let filtered = self.low_pass.is_some();
        let mut values = [0.0; AXES];
        for axis in 0..AXES {
            let parts = &mut self.axes[axis];
            let signal = if filtered { self.filtered[axis].value } else { input[axis] };
            values[axis] = signal + parts.bias + parts.drift.next(span) + parts.noise.next(span);
        }
        Outputs { values, number: self.number }
    }

    /// `count` outputs that nobody sees, each `span` (s) after the last one: only their errors go on.
    #[inline(always)]
    fn pass(&mut self, count: u32, span: f64) {
        self.number = self.number.wrapping_add(count);
        for Axis { drift, noise, .. } in &mut self.axes {
            for _ in 0..count {
                drift.next(span);
                noise.next(span);
            }
        }
    }

    /// `value` within the full scale, in whole steps.
    #[inline(always)]
    fn converted(&self, value: f64) -> f32 {
        let limited = value.clamp(-self.full_scale, self.full_scale);
        let steps = self.resolution;
        (if steps > 0.0 { whole(limited / steps) * steps } else { limited }) as f32
    }

    #[inline(always)]
    fn follow(&mut self, span: f64, from: &[f64; AXES], to: &[f64; AXES]) {
        if let Some(low_pass) = &mut self.low_pass {
            low_pass.follow(&mut self.filtered, span, from, to);
        }
    }

    /// As [`super::Sensors::advance`].
    pub(super) fn advance(&mut self, time: f64, truth: &[f64; AXES]) {
        if self.ideal {
            self.number = self.number.wrapping_add(1);
            self.delivery.send(time, Outputs { values: *truth, number: self.number });
            return;
        }
        let input = self.mix(truth);
        let (start, before) = (self.time, self.input);
        let end = time.max(start);
        let span = end - start;
        let Some(mut next) = self.clock.as_ref().map(|clock| clock.next) else {
            self.follow(span, &before, &input);
            let outputs = self.output(&input, span);
            self.delivery.send(end, outputs);
            self.delivery.deliver(end);
            (self.time, self.input) = (end, input);
            return;
        };
        let (mut from, mut held, mut unseen) = (start, before, 0);
        while next <= end + SAME_INSTANT {
            let Some(clock) = &mut self.clock else { break };
            let (due, period) = (next, clock.period);
            clock.step();
            next = clock.next;
            // Nobody can look before the next one is there.
            if self.delivery.arrives(next, end) {
                unseen += 1;
                continue;
            }
            self.pass(std::mem::take(&mut unseen), period);
            let instant = due.clamp(from, end);
            let part = if span > 0.0 { (instant - start) / span } else { 1.0 };
            let mut at = before;
            for axis in 0..AXES {
                at[axis] += part * (input[axis] - before[axis]);
            }
            self.follow(instant - from, &held, &at);
            let outputs = self.output(&at, period);
            self.delivery.send(instant, outputs);
            (from, held) = (instant, at);
        }
        self.follow(end - from, &held, &input);
        self.delivery.deliver(end);
        (self.time, self.input) = (end, input);
    }

    /// What can be read.
    #[inline(always)]
    pub(super) fn readings(&self) -> [Reading; AXES] {
        let Outputs { values, number } = self.delivery.readable();
        let mut readings = [Reading { value: 0.0, number }; AXES];
        for axis in 0..AXES {
            readings[axis].value = self.converted(values[axis]);
        }
        readings
    }
}

#[cfg(test)]
mod tests {
    use super::whole;

    #[test]
    fn whole_is_round() {
        let ties = (-9..9).map(|k| f64::from(k) + 0.5);
        let near = ties.clone().flat_map(|tie: f64| [tie, tie.next_up(), tie.next_down()]);
        let powers = (0..70).map(|exponent| 1.5 * (1_u128 << exponent) as f64);
        let large = [51, 52, 53].map(|exponent| (1_u64 << exponent) as f64);
        let large = large.into_iter().flat_map(|power| [power - 0.5, power + 1.0]).chain([f64::MAX, f64::INFINITY]);
        let values: Vec<f64> = near.chain(powers).chain(large).chain([0.0, 5e-324, 0.2, 0.499_999_999_999_999_94]).collect();
        for value in values.iter().flat_map(|&value| [value, -value]) {
            assert_eq!(whole(value).to_bits(), value.round().to_bits(), "{value}");
        }
        assert!(whole(f64::NAN).is_nan());
    }
}
