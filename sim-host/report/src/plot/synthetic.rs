//! For the tests of the figures: responses that are half waves of growing or shrinking height.

use sprag_sim::history::{History, Sample};

const ALPHA_RAD: f64 = 0.15;
const P_1_S: f64 = 2.1;
const HALF_WAVE_S: f64 = 0.6;
const DURATION_S: f64 = 12.0;

/// Height, slope and number of the half wave of a parabola train at `time_s`.
fn half_wave(time_s: f64) -> (f64, f64, usize) {
    let number = (time_s / HALF_WAVE_S).floor();
    let part = time_s / HALF_WAVE_S - number;
    let sign = if number % 2.0 == 0.0 { 1.0 } else { -1.0 };
    (sign * 4.0 * part * (1.0 - part), sign * 4.0 * (1.0 - 2.0 * part) / HALF_WAVE_S, number as usize)
}

fn train(device: &str, outcome: &str, count: usize, height: impl Fn(f64) -> f64) -> History {
    let mut samples = Vec::with_capacity(count);
    let mut impacts_s = Vec::new();
    let mut half_waves = 0;
    for index in 0..count {
        let time_s = DURATION_S * index as f64 / (count.max(2) - 1) as f64;
        let (wave, slope, number) = half_wave(time_s);
        let (ground, ..) = half_wave(1.7 * time_s);
        let sample = Sample {
            time_s,
            ground_m_s2: 3.0 * ground * (1.0 - time_s / DURATION_S),
            rotation_rad: ALPHA_RAD * height(time_s) * wave,
            velocity_rad_s: ALPHA_RAD * height(time_s) * slope,
            acceleration_rad_s2: -8.0 * ALPHA_RAD * height(time_s) * wave,
            force_ratio: [0.0; 2],
            engaged: 0,
            displacement_m: 0.0,
        };
        if number != half_waves {
            // Left and right limit of the velocity at the impact.
            half_waves = number;
            impacts_s.push(time_s);
            let before = Sample { velocity_rad_s: 1.3 * sample.velocity_rad_s, ..sample };
            samples.push(before);
        }
        samples.push(sample);
    }
    History {
        device: device.into(),
        outcome: outcome.into(),
        slenderness_rad: ALPHA_RAD,
        frequency_parameter_1_s: P_1_S,
        samples,
        impacts_s,
        slides: false,
    }
}

/// A block that rocks with `height` as its first peak θ/α and comes to rest.
pub fn safe(device: &str, height: f64, count: usize) -> History {
    train(device, "safe", count, |time| {
        let left = (1.0 - time / 9.0).max(0.0);
        height * left * left
    })
}

/// A block whose swings grow until it overturns.
pub fn overturning(device: &str, count: usize) -> History {
    let mut history = train(device, "overturned", count, |time| if time < 8.0 * HALF_WAVE_S { 0.25 + 0.15 * time } else { 4.0 });
    let end = history.samples.iter().position(|sample| sample.rotation_rad.abs() > 3.0 * ALPHA_RAD);
    history.samples.truncate(end.map_or(count, |end| end + 1));
    let last = history.samples.last().map_or(0.0, |sample| sample.time_s);
    history.impacts_s.retain(|&time| time <= last);
    history
}

/// `history` with one inerter that always moves with the block.
pub fn with_inerter(mut history: History) -> History {
    for sample in &mut history.samples {
        sample.force_ratio = [0.05 * sample.acceleration_rad_s2, 0.0];
        sample.engaged = 1;
    }
    history
}

/// `history` with a clutched pair: each flywheel drives in one direction of rotation and only while it speeds up.
pub fn with_clutched_pair(mut history: History) -> History {
    let mut before: Option<Sample> = None;
    let mut samples = Vec::with_capacity(history.samples.len());
    for mut sample in history.samples {
        let speed = sample.velocity_rad_s;
        let speeds_up = speed * sample.acceleration_rad_s2 > 0.0;
        let flywheel = if speed > 0.0 { 0 } else { 1 };
        if speeds_up && speed.abs() > 1e-9 {
            sample.engaged = flywheel as u8 + 1;
            sample.force_ratio[flywheel] = 0.05 * sample.acceleration_rad_s2;
        }
        if let Some(before) = before
            && before.engaged != sample.engaged
        {
            samples.push(Sample { engaged: before.engaged, force_ratio: before.force_ratio, ..sample });
        }
        samples.push(sample);
        before = Some(sample);
    }
    history.samples = samples;
    history
}

/// A block that never rocks.
pub fn at_rest(device: &str, count: usize) -> History {
    let mut history = safe(device, 0.0, count);
    history.outcome = "never rocks".into();
    history.impacts_s.clear();
    for sample in &mut history.samples {
        sample.ground_m_s2 *= 0.1;
    }
    history
}
