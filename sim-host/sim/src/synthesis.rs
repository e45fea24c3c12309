//! Synthetic near-fault ground motion: a velocity pulse and band-limited noise.
//!
//! Both parts are written as velocities that begin and end at rest, and differentiated analytically, so the ground
//! has no velocity left at the end without any correction. The same parameters give the same bytes on every machine.

use std::f64::consts::PI;
use std::fmt::Write as _;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sprag_shared::math;

use crate::record::STANDARD_GRAVITY_M_S2;

/// Cosines in the noise, one in each of as many equal parts of the band.
const NOISE_TERMS: usize = 200;
/// Share of the duration at the end over which the noise is faded out.
const FADE: f64 = 0.2;

/// Parameters of a synthetic near-fault motion. Valid ranges are those that [`NearFaultMotion::check`] enforces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearFaultMotion {
    /// Seed of the noise.
    pub seed: u64,
    /// Duration (s), 5 to 120.
    pub duration_s: f64,
    /// Samples per second (1/s), 50 to 1000.
    pub rate_hz: f64,
    /// Velocity amplitude A of the pulse (m/s), 0 to 5.
    pub pulse_velocity_m_s: f64,
    /// Pulse period 1/f_p (s), 0.3 to 15.
    pub pulse_period_s: f64,
    /// γ, the number of cycles under the pulse's envelope, more than 1 and up to 10.
    pub pulse_cycles: f64,
    /// ν, the phase of the pulse (degrees), −360 to 360.
    pub pulse_phase_deg: f64,
    /// t₀, the middle of the pulse (s); the pulse must lie within the duration.
    pub pulse_time_s: f64,
    /// Peak acceleration of the noise (g), 0 to 2.
    pub noise_peak_g: f64,
    /// Lower end of the noise band (Hz), 0.1 or more.
    pub lowest_frequency_hz: f64,
    /// Upper end of the noise band (Hz), above the lower end and up to a quarter of the sampling rate.
    pub highest_frequency_hz: f64,
}

impl NearFaultMotion {
    /// A motion of some 0.5 g and 1 m/s with a pulse of two seconds: what stations near a rupture of magnitude 6.5 to 7
    /// have recorded.
    pub const DEFAULT: NearFaultMotion = NearFaultMotion {
        seed: 2,
        duration_s: 25.0,
        rate_hz: 200.0,
        pulse_velocity_m_s: 1.0,
        pulse_period_s: 2.0,
        pulse_cycles: 2.0,
        pulse_phase_deg: -30.0,
        pulse_time_s: 7.0,
        noise_peak_g: 0.3,
        lowest_frequency_hz: 0.5,
        highest_frequency_hz: 10.0,
    };
}

/// A parameter outside its range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SynthesisError {
    /// One parameter is outside fixed limits.
    #[error("--{flag} {value}: allowed are {lowest} to {highest}")]
    Range {
        /// Flag of the parameter.
        flag: &'static str,
        /// Value that was given.
        value: f64,
        /// Smallest value allowed.
        lowest: f64,
        /// Largest value allowed.
        highest: f64,
    },
    /// The pulse is longer than the motion.
    #[error("--duration {duration}: a pulse of {length} s (--pulse-cycles times --pulse-period) needs at least as many")]
    PulseTooLong {
        /// Duration of the motion (s).
        duration: f64,
        /// Length of the pulse (s).
        length: f64,
    },
    /// The pulse begins before the motion or ends after it.
    #[error(
        "--pulse-time {value}: a pulse of {length} s around it does not lie within 0 to {duration} s; allowed are {lowest} to {highest}"
    )]
    PulseOutside {
        /// Middle of the pulse (s).
        value: f64,
        /// Length of the pulse (s).
        length: f64,
        /// Duration of the motion (s).
        duration: f64,
        /// Smallest middle allowed (s).
        lowest: f64,
        /// Largest middle allowed (s).
        highest: f64,
    },
}

/// Value and derivative of a function at one instant.
#[derive(Clone, Copy)]
struct Jet {
    value: f64,
    rate: f64,
}

impl std::ops::Mul for Jet {
    type Output = Jet;
    fn mul(self, other: Jet) -> Jet {
        Jet { value: self.value * other.value, rate: self.rate * other.value + self.value * other.rate }
    }
}

impl NearFaultMotion {
    /// Compares every parameter with its range.
    ///
    /// # Errors
    ///
    /// [`SynthesisError`] for the first parameter outside.
    pub fn check(&self) -> Result<(), SynthesisError> {
        for (flag, value, lowest, highest) in [
            ("duration", self.duration_s, 5.0, 120.0),
            ("rate", self.rate_hz, 50.0, 1000.0),
            ("pulse-velocity", self.pulse_velocity_m_s, 0.0, 5.0),
            ("pulse-period", self.pulse_period_s, 0.3, 15.0),
            ("pulse-cycles", self.pulse_cycles, 1.0 + 1e-6, 10.0),
            ("pulse-phase-deg", self.pulse_phase_deg, -360.0, 360.0),
            ("noise-peak", self.noise_peak_g, 0.0, 2.0),
            ("highest-frequency", self.highest_frequency_hz, 0.2, 0.25 * self.rate_hz),
            ("lowest-frequency", self.lowest_frequency_hz, 0.1, 0.95 * self.highest_frequency_hz),
        ] {
            if !(lowest..=highest).contains(&value) {
                return Err(SynthesisError::Range { flag, value, lowest, highest });
            }
        }
        let length = self.pulse_cycles * self.pulse_period_s;
        if length > self.duration_s {
            return Err(SynthesisError::PulseTooLong { duration: self.duration_s, length });
        }
        let (lowest, highest) = (0.5 * length, self.duration_s - 0.5 * length);
        if !(lowest..=highest).contains(&self.pulse_time_s) {
            let (value, duration) = (self.pulse_time_s, self.duration_s);
            return Err(SynthesisError::PulseOutside { value, length, duration, lowest, highest });
        }
        Ok(())
    }

    /// Velocity (m/s) and acceleration (m/s²) of the pulse, Mavroeidis and Papageorgiou (2003):
    ///
    /// v(t) = A/2 [1 + cos(2πf_p/γ (t − t₀))] cos(2πf_p (t − t₀) + ν) for |t − t₀| ≤ γ/(2f_p), else 0.
    pub fn pulse(&self, time_s: f64) -> (f64, f64) {
        let since = time_s - self.pulse_time_s;
        if since.abs() > 0.5 * self.pulse_cycles * self.pulse_period_s {
            return (0.0, 0.0);
        }
        let carrier = 2.0 * PI / self.pulse_period_s;
        let envelope = carrier / self.pulse_cycles;
        let half = 0.5 * self.pulse_velocity_m_s;
        let phase = carrier * since + self.pulse_phase_deg * (PI / 180.0);
        let jet = Jet { value: half * (1.0 + math::cos(envelope * since)), rate: -half * envelope * math::sin(envelope * since) }
            * Jet { value: math::cos(phase), rate: -carrier * math::sin(phase) };
        (jet.value, jet.rate)
    }

    /// Shape of the noise in time, x² exp(2 − 2x) with x = t/t₀ (1 at the pulse), faded out with a squared cosine.
    fn noise_shape(&self, time_s: f64) -> Jet {
        let x = time_s / self.pulse_time_s;
        let decay = math::exp(2.0 - 2.0 * x);
        let rise = Jet { value: x * x * decay, rate: 2.0 * x * (1.0 - x) * decay / self.pulse_time_s };
        let fade_s = FADE * self.duration_s;
        let angle = 0.5 * PI * ((time_s - (self.duration_s - fade_s)) / fade_s).clamp(0.0, 1.0);
        let fade = Jet { value: math::cos(angle) * math::cos(angle), rate: -math::sin(2.0 * angle) * 0.5 * PI / fade_s };
        rise * fade
    }

    /// Noise acceleration at each time, before scaling: the derivative of shape(t) Σ sin(ω_k t + φ_k)/ω_k, so that the
    /// acceleration has a flat spectrum over the band.
    fn noise(&self, times_s: &[f64]) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let band = self.highest_frequency_hz - self.lowest_frequency_hz;
        let terms: Vec<(f64, f64)> = (0..NOISE_TERMS)
            .map(|term| {
                let frequency = self.lowest_frequency_hz + band * (term as f64 + uniform()) / NOISE_TERMS as f64;
                (2.0 * PI * frequency, 2.0 * PI * uniform())
            })
            .collect();
        times_s
            .iter()
            .map(|time| {
                let sum = terms.iter().fold(Jet { value: 0.0, rate: 0.0 }, |sum, (omega, phase)| {
                    let angle = omega * time + phase;
                    Jet { value: sum.value + math::sin(angle) / omega, rate: sum.rate + math::cos(angle) }
                });
                (self.noise_shape(*time) * sum).rate
            })
            .collect()
    }

    /// Ground acceleration (m/s²) at i/rate for every i within the duration.
    ///
    /// # Errors
    ///
    /// Those of [`NearFaultMotion::check`].
    pub fn acceleration_m_s2(&self) -> Result<Vec<f64>, SynthesisError> {
        self.check()?;
        let samples = (self.duration_s * self.rate_hz + 1e-6).floor() as usize;
        let times: Vec<f64> = (0..=samples).map(|index| index as f64 / self.rate_hz).collect();
        let noise = self.noise(&times);
        let peak = crate::record::intensity::peak(&noise);
        let scale = if peak > 0.0 { self.noise_peak_g * STANDARD_GRAVITY_M_S2 / peak } else { 0.0 };
        Ok(times.iter().zip(noise).map(|(time, noise)| self.pulse(*time).1 + scale * noise).collect())
    }

    /// The command that makes this motion, without the file to write.
    pub fn command(&self) -> String {
        format!(
            "sprag synthesize --seed {} --duration {} --rate {} --pulse-velocity {} --pulse-period {} --pulse-cycles {} \
             --pulse-phase-deg {} --pulse-time {} --noise-peak {} --lowest-frequency {} --highest-frequency {}",
            self.seed,
            self.duration_s,
            self.rate_hz,
            self.pulse_velocity_m_s,
            self.pulse_period_s,
            self.pulse_cycles,
            self.pulse_phase_deg,
            self.pulse_time_s,
            self.noise_peak_g,
            self.lowest_frequency_hz,
            self.highest_frequency_hz
        )
    }

    /// The motion as CSV: two comment lines that say what made it, `# time_s,acc_g`, and a row per sample with the
    /// acceleration in units of 1e-5 g.
    ///
    /// # Errors
    ///
    /// Those of [`NearFaultMotion::check`].
    pub fn csv(&self) -> Result<String, SynthesisError> {
        let acceleration = self.acceleration_m_s2()?;
        let exact_in_milliseconds = |value: f64| (value * 1e3 - (value * 1e3).round()).abs() < 1e-9;
        let decimals = if exact_in_milliseconds(1.0 / self.rate_hz) { 3 } else { 6 };
        let mut text = format!(
            "# {}\n# synthetic near-fault motion, a Mavroeidis-Papageorgiou pulse with band-limited noise; no recording\n# time_s,acc_g\n",
            self.command()
        );
        for (index, value) in acceleration.iter().enumerate() {
            // Adding 0.0 turns a rounded −0 into 0.
            let in_g = (value / STANDARD_GRAVITY_M_S2 * 1e5).round() / 1e5 + 0.0;
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{:.decimals$},{in_g:.5}", index as f64 / self.rate_hz);
        }
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::intensity::{integral, peak};
    use crate::record::{Intensity, ReadOptions, Record};

    const MOTION: NearFaultMotion = NearFaultMotion::DEFAULT;

    #[test]
    fn the_pulse_accelerates_as_its_velocity_changes() {
        let h = 1e-5;
        for step in 0..400 {
            let time = MOTION.pulse_time_s + (f64::from(step) - 200.0) * 0.012;
            let slope = (MOTION.pulse(time + h).0 - MOTION.pulse(time - h).0) / (2.0 * h);
            assert!((slope - MOTION.pulse(time).1).abs() < 1e-4, "{time}");
        }
        let even = NearFaultMotion { pulse_phase_deg: 0.0, ..MOTION };
        assert!((even.pulse(even.pulse_time_s).0 - even.pulse_velocity_m_s).abs() < 1e-15);
        assert_eq!(MOTION.pulse(MOTION.pulse_time_s + 2.001), (0.0, 0.0));
    }

    #[test]
    fn the_ground_ends_at_rest_and_noise_has_its_peak() {
        for seed in 0..5 {
            let motion = NearFaultMotion { seed, ..MOTION };
            let acceleration = motion.acceleration_m_s2().unwrap();
            assert_eq!(acceleration.len(), 5001);
            assert!(integral(&acceleration, 0.005).last().unwrap().abs() < 1e-3);
            assert!(acceleration[0].abs() < 1e-9 && acceleration[5000].abs() < 1e-6);
            let noise = NearFaultMotion { pulse_velocity_m_s: 0.0, ..motion }.acceleration_m_s2().unwrap();
            assert!((peak(&noise) - 0.3 * 9.80665).abs() < 1e-9);
        }
    }

    #[test]
    fn the_default_is_a_near_fault_motion_that_the_reader_reads_without_options() {
        let csv = MOTION.csv().unwrap();
        assert!(csv.len() < 200_000);
        let record = Record::parse("near_fault.csv", csv.as_bytes(), &ReadOptions::default()).unwrap();
        assert_eq!((record.time_step_s, record.acceleration_m_s2.len(), &record.warnings[..]), (0.005, 5001, &[][..]));
        let intensity = Intensity::of(&record);
        let pga_g = intensity.pga_m_s2 / 9.80665;

        assert!((0.45..0.55).contains(&pga_g), "PGA {pga_g} g");
        assert!((0.9..1.1).contains(&intensity.pgv_m_s), "PGV {} m/s", intensity.pgv_m_s);
    }

    #[test]
    fn parameters_outside_their_range_are_named() {
        let message = |motion: NearFaultMotion| motion.csv().unwrap_err().to_string();
        assert_eq!(message(NearFaultMotion { pulse_period_s: f64::NAN, ..MOTION }), "--pulse-period NaN: allowed are 0.3 to 15");
        assert_eq!(
            message(NearFaultMotion { highest_frequency_hz: 60.0, ..MOTION }),
            "--highest-frequency 60: allowed are 0.2 to 50"
        );
        assert_eq!(
            message(NearFaultMotion { pulse_time_s: 1.0, ..MOTION }),
            "--pulse-time 1: a pulse of 4 s around it does not lie within 0 to 25 s; allowed are 2 to 23"
        );
        assert_eq!(
            message(NearFaultMotion { pulse_period_s: 15.0, ..MOTION }),
            "--duration 25: a pulse of 30 s (--pulse-cycles times --pulse-period) needs at least as many"
        );
    }

    #[test]
    fn the_scene_file_is_what_the_defaults_make() {
        let scene = include_str!("../../../scenes/near_fault.csv");
        assert!(
            scene == MOTION.csv().unwrap(),
            "scenes/near_fault.csv is not what `sprag synthesize --out scenes/near_fault.csv` writes now: either the \
             synthesis or its math changed by accident, which breaks \"same input, same bytes\", or it changed on purpose; \
             then write the file anew, and with it every expected number of the scenes that use it"
        );
    }
}
