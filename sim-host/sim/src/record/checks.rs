//! Checks of a record against what recorded and processed ground motions look like.
//!
//! A warning is a hint for a person: nothing is changed. The thresholds were set on the physics below and confirmed on
//! 228 genuine records, of which few raise one.

use std::ops::Range;

use super::intensity::{integral, peak, velocity_m_s};
use super::number::last_digit;
use super::{Record, STANDARD_GRAVITY_M_S2, Warning};

/// A first sample above this share of the peak. Records are cut from continuous noise, but the strong part starts later.
pub const START_FRACTION: f64 = 0.05;
/// A velocity at the end, from rest, above this share of PGV. Processed records end near zero; an uncorrected offset of
/// a thousandth of g drifts by 0.4 m/s in 40 s.
pub const DRIFT_FRACTION: f64 = 0.25;
/// Samples in a row at the same extreme. Two happen by rounding at a smooth top, more at a stop.
pub const CLIPPED_SAMPLES: usize = 3;
/// A run counts as clipped only at a level above this share of the peak: quiet heads hold equal values as well.
pub const CLIPPED_LEVEL: f64 = 0.2;
/// A sample is a spike if it stands out from the line through its neighbours by this share of the peak or more…
pub const SPIKE_FRACTION: f64 = 0.5;
/// …and by this many times what the samples around it do. Ground motion is filtered, so a true peak has slopes.
pub const SPIKE_RATIO: f64 = 8.0;
/// A jump between neighbours is a step from this share of the peak on…
pub const STEP_FRACTION: f64 = 0.5;
/// …if it is this many times larger than the other jumps around it.
pub const STEP_RATIO: f64 = 8.0;
/// Samples on each side with which a spike or a step is compared.
pub const NEIGHBOURHOOD: usize = 8;
/// Relative rounding of a printed time step above which the duration of a record suffers.
pub const STEP_ROUNDING: f64 = 2e-3;
/// Sampling rates that are whole numbers to this relative accuracy are taken as exact: instruments have such rates.
pub const WHOLE_RATE: f64 = 1e-6;
/// Seconds before the shaking begins that are worth a warning: more than instruments keep from before an event, and
/// simulated for nothing.
pub const QUIET_HEAD_S: f64 = 30.0;
/// The shaking begins when |a| first exceeds this share of the peak.
pub const QUIET_FRACTION: f64 = 0.05;
/// PGA in g above which units are doubted; the largest recorded are 2 to 4 g.
pub const LARGEST_PGA_G: f64 = 3.0;
/// PGA in g below which units are doubted; it cannot rock anything.
pub const SMALLEST_PGA_G: f64 = 1e-3;
/// Relative difference from the peak in the header: headers have three or more digits.
pub const PEAK_DIFFERENCE: f64 = 0.01;

/// All warnings for a record, in a fixed order; none for fewer than two samples, which no reader returns.
pub fn check(record: &Record) -> Vec<Warning> {
    let a = record.acceleration_m_s2.as_slice();
    if a.len() < 2 {
        return Vec::new();
    }
    let pga = peak(a);
    let checks = [samples, header_peak, start, spikes, steps, clipped, drift, rounded_step, quiet_head, units];
    checks.into_iter().filter_map(|check| check(record, a, pga)).collect()
}

fn samples(record: &Record, a: &[f64], _pga: f64) -> Option<Warning> {
    let stated = record.header.samples?;
    (stated != a.len() as u64).then_some(Warning::SamplesDisagree { stated, present: a.len() })
}

fn header_peak(record: &Record, a: &[f64], pga: f64) -> Option<Warning> {
    let stated = record.header.peak_m_s2?;
    let largest = a.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let near = |found: f64| (stated.abs() - found.abs()).abs() <= PEAK_DIFFERENCE * found.abs();
    (!near(pga) && !near(largest)).then_some(Warning::PeakDisagrees { stated_m_s2: stated, found_m_s2: pga })
}

fn start(_record: &Record, a: &[f64], pga: f64) -> Option<Warning> {
    let first = *a.first()?;
    let fraction = if pga > 0.0 { first.abs() / pga } else { 0.0 };
    (fraction > START_FRACTION).then_some(Warning::NonZeroStart { first_m_s2: first, fraction })
}

/// Distance of sample `at` from the line through its neighbours, or from 0 beyond the ends.
fn prominence(a: &[f64], at: usize) -> f64 {
    a[at] - 0.5 * (a[at - 1] + a[at + 1])
}

fn spikes(record: &Record, a: &[f64], pga: f64) -> Option<Warning> {
    let candidate = |at: usize| {
        let out = prominence(a, at);
        let both = (a[at] - a[at - 1]) * (a[at] - a[at + 1]) > 0.0;
        both && out.abs() >= SPIKE_FRACTION * pga && pga > 0.0 && {
            let first = at.saturating_sub(NEIGHBOURHOOD).max(1);
            let last = (at + NEIGHBOURHOOD).min(a.len() - 2);
            // The two next samples share in the spike by half of it.
            let around =
                (first..=last).filter(|near| near.abs_diff(at) > 1).map(|near| prominence(a, near).abs()).fold(0.0, f64::max);
            out.abs() >= SPIKE_RATIO * around
        }
    };
    let found: Vec<usize> = (1..a.len().saturating_sub(1)).filter(|at| candidate(*at)).collect();
    let largest = found.iter().copied().max_by(|one, other| prominence(a, *one).abs().total_cmp(&prominence(a, *other).abs()))?;
    Some(Warning::Spike {
        count: found.len(),
        time_s: record.start_time_s + largest as f64 * record.time_step_s,
        value_m_s2: a[largest],
    })
}

fn steps(record: &Record, a: &[f64], pga: f64) -> Option<Warning> {
    let jump = |at: usize| a[at + 1] - a[at];
    let jumps = a.len() - 1;
    let candidate = |at: usize| {
        jump(at).abs() >= STEP_FRACTION * pga && pga > 0.0 && {
            let (first, last) = (at.saturating_sub(NEIGHBOURHOOD), (at + NEIGHBOURHOOD).min(jumps - 1));
            let around = (first..=last).filter(|near| *near != at).map(|near| jump(near).abs()).fold(0.0, f64::max);
            last > first && jump(at).abs() >= STEP_RATIO * around
        }
    };
    let found: Vec<usize> = (0..jumps).filter(|at| candidate(*at)).collect();
    let largest = found.iter().copied().max_by(|one, other| jump(*one).abs().total_cmp(&jump(*other).abs()))?;
    let time_s = record.start_time_s + (largest + 1) as f64 * record.time_step_s;
    Some(Warning::Step { count: found.len(), time_s, height_m_s2: jump(largest) })
}

fn clipped(record: &Record, a: &[f64], pga: f64) -> Option<Warning> {
    let largest = a.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let smallest = a.iter().copied().fold(f64::INFINITY, f64::min);
    let extreme = |value: f64| (value == largest || value == smallest) && value.abs() > CLIPPED_LEVEL * pga;
    let (mut longest, mut start) = (0..0, 0);
    for run in a.chunk_by(|one, next| one == next) {
        let at = start..start + run.len();
        start = at.end;
        // A record that never moves from its extreme is constant, not clipped.
        let long = run.len() >= CLIPPED_SAMPLES.max(longest.len() + 1) && run.len() < a.len();
        if long && extreme(run[0]) && !is_rounded_top(record, a, &at) {
            longest = at;
        }
    }
    (!longest.is_empty()).then(|| Warning::Clipped {
        samples: longest.len(),
        time_s: record.start_time_s + longest.start as f64 * record.time_step_s,
        value_m_s2: a[longest.start],
    })
}

/// Whether the equal samples in `run` may be a smooth top in few digits. A parabola of which n samples round to one number, with q
/// for the last digit, falls from it to the next sample by no more than ((n + 1)/(n − 1))² q.
fn is_rounded_top(record: &Record, a: &[f64], run: &Range<usize>) -> bool {
    let n = run.len() as f64;
    let widening = (n + 1.0) / (n - 1.0);
    let before = run.start.checked_sub(1).map(|at| (a[at] - a[run.start]).abs());
    let after = a.get(run.end).map(|value| (value - a[run.start]).abs());
    let step = before.unwrap_or(0.0).max(after.unwrap_or(0.0));
    // Half a digit more for the rounding of the conversion to SI.
    let digits = (widening * widening).floor() + 0.5;
    step <= digits * printed_digit_m_s2(record, a, run)
}

/// Value of the last printed digit (m/s²) of the samples around `run`, by the most decimals among them in the units of the file.
/// Far smaller ones may have more in print with exponents, and say nothing.
fn printed_digit_m_s2(record: &Record, a: &[f64], run: &Range<usize>) -> f64 {
    let unit_m_s2 = record.units.to_m_s2(1.0);
    let level = a[run.start].abs();
    let around = &a[run.start.saturating_sub(NEIGHBOURHOOD)..(run.end + NEIGHBOURHOOD).min(a.len())];
    let near = around.iter().filter(|value| value.abs() >= 0.1 * level);
    let digits = near.map(|value| {
        // Twelve digits are without the rounding of the conversion.
        let text = format!("{:.11e}", value / unit_m_s2);
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        last_digit(&format!("{}e{exponent}", mantissa.trim_end_matches('0')))
    });
    digits.fold(f64::INFINITY, f64::min) * unit_m_s2
}

fn drift(record: &Record, a: &[f64], _pga: f64) -> Option<Warning> {
    let final_m_s = *integral(a, record.time_step_s).last()?;
    let pgv = peak(&velocity_m_s(a, record.time_step_s));
    let fraction = final_m_s.abs() / pgv.max(f64::MIN_POSITIVE);
    (final_m_s != 0.0 && fraction > DRIFT_FRACTION).then_some(Warning::VelocityDrift { final_m_s, fraction: fraction.min(1e6) })
}

fn rounded_step(record: &Record, _a: &[f64], _pga: f64) -> Option<Warning> {
    let stated = record.header.time_step.filter(|stated| stated.value_s == record.time_step_s)?;
    let relative = 0.5 * stated.resolution_s / stated.value_s;
    let rate = 1.0 / stated.value_s;
    let whole = (rate - rate.round()).abs() <= WHOLE_RATE * rate;
    (relative > STEP_ROUNDING && !whole).then_some(Warning::TimeStepRounded { printed_s: stated.value_s, relative })
}

fn quiet_head(record: &Record, a: &[f64], pga: f64) -> Option<Warning> {
    let seconds = a.iter().position(|value| value.abs() > QUIET_FRACTION * pga)? as f64 * record.time_step_s;
    (seconds > QUIET_HEAD_S).then_some(Warning::QuietHead { seconds })
}

fn units(_record: &Record, _a: &[f64], pga: f64) -> Option<Warning> {
    let pga_g = pga / STANDARD_GRAVITY_M_S2;
    if pga_g > LARGEST_PGA_G {
        Some(Warning::LargePeak { pga_g })
    } else {
        (pga_g < SMALLEST_PGA_G).then_some(Warning::SmallPeak { pga_g })
    }
}

#[cfg(test)]
#[path = "checks_tests.rs"]
mod tests;
