//! Sensors that one can buy, by name.
//!
//! How figures of data sheets become parameters, the same for every part:
//!
//! - what is typical within ± of something is one standard deviation of the turn-on error, what is guaranteed within ± is three. Nothing
//!   is calibrated away: that is the controller's work;
//! - cross-axis sensitivity is a misalignment by that angle;
//! - noise density and bandwidth are those of the data sheet, the bandwidth as the corner of a Butterworth filter of second order;
//! - in-run bias stability is the bottom of the Allan curve, turned into a Gauss-Markov process with [`ALLAN_PEAK_RATIO`]. Where the data
//!   sheet has none, a value usual for the class is taken. The correlation time, [`CORRELATION_TIME`], is a choice everywhere;
//! - full scale, output data rate and filter are configurations, chosen for a controller at 2 kHz. All parts run on their own clock;
//! - latency is the time to read the part out over its bus and to wake the controller, and what the data sheet has of delay beyond that
//!   of the Butterworth filter. It is a choice, too.

use std::f64::consts::PI;

use sprag_shared::structure::block::GRAVITY;

use super::drift::ALLAN_PEAK_RATIO;
use super::{Drift, Encoder, Inertial, Sampling, Suite};

/// Degree, rad; or degree per second, rad/s.
pub const DEGREE: f64 = PI / 180.0;
/// Thousandth of standard gravity, m/s².
pub const MILLI_G: f64 = 1e-3 * GRAVITY;
/// Degree per hour, rad/s.
const DEGREE_PER_HOUR: f64 = DEGREE / 3600.0;
/// Millionth of standard gravity, m/s².
const MICRO_G: f64 = 1e-6 * GRAVITY;
/// Correlation time of bias instability, s: Allan curves of such parts are flat around some minutes.
pub const CORRELATION_TIME: f64 = 100.0;
/// Radius of the pinion that a rotary encoder sits on unless a scene says otherwise, m.
pub const PINION_RADIUS: f64 = 0.05;

/// A part with a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset<T> {
    /// Name in scenes.
    pub name: &'static str,
    /// In one line.
    pub summary: &'static str,
    /// Parameters of the part.
    pub part: T,
}

const fn instability(stability: f64) -> Drift {
    Drift { deviation: stability / ALLAN_PEAK_RATIO, correlation_time: CORRELATION_TIME, random_walk: 0.0 }
}

const fn sampling(rate: f64, latency: f64) -> Sampling {
    Sampling { rate, synchronous: false, jitter: 0.0, latency }
}

/// TDK InvenSense ICM-42688-P, DS-000347 rev. 1.7: a good MEMS part of consumer size.
///
/// Gyroscope (Table 1): 2.8 mdps/√Hz, initial ZRO ±0.5 dps typ., sensitivity ±0.5 % typ., cross-axis ±1.25 % typ. Configured: ±500 dps in
/// 16 bits (65.5 LSB/dps), 8 kHz, anti-alias filter at 536 Hz, user-interface filter left wide open and not modelled. Modelled: bias
/// stability 10 °/h, 50 µs to read out over SPI.
pub const ICM_42688_P_GYROSCOPE: Inertial = Inertial {
    noise_density: 0.0028 * DEGREE,
    bias: 0.5 * DEGREE,
    drift: instability(10.0 * DEGREE_PER_HOUR),
    scale_error: 0.005,
    misalignment: 0.0125,
    bandwidth: 536.0,
    resolution: DEGREE / 65.5,
    full_scale: 500.0 * DEGREE,
    sampling: sampling(8000.0, 50e-6),
};

/// TDK InvenSense ICM-42688-P, DS-000347 rev. 1.7.
///
/// Accelerometer (Table 2): 70 µg/√Hz (65 in x and y), zero-g level ±20 mg typ., sensitivity ±0.5 % typ., cross-axis ±1 % typ. Configured:
/// ±8 g in 16 bits (4096 LSB/g), 8 kHz, anti-alias filter at 536 Hz. Modelled: bias stability 20 µg, 50 µs to read out over SPI.
pub const ICM_42688_P_ACCELEROMETER: Inertial = Inertial {
    noise_density: 70.0 * MICRO_G,
    bias: 20.0 * MILLI_G,
    drift: instability(20.0 * MICRO_G),
    scale_error: 0.005,
    misalignment: 0.01,
    bandwidth: 536.0,
    resolution: GRAVITY / 4096.0,
    full_scale: 8.0 * GRAVITY,
    sampling: sampling(8000.0, 50e-6),
};

/// Bosch BMI088, BST-BMI088-DS001: robust against vibration.
///
/// Gyroscope: 0.014 °/s/√Hz, zero-rate offset ±1 °/s typ., sensitivity ±1 % typ., cross-axis ±1 % typ. Configured: ±500 °/s in 16 bits
/// (65.536 LSB/°/s), 2 kHz with a bandwidth of 532 Hz (register GYRO_BANDWIDTH at 0). Modelled: bias stability 2 °/h, as in the maker's
/// flyer; 50 µs to read out over SPI.
pub const BMI088_GYROSCOPE: Inertial = Inertial {
    noise_density: 0.014 * DEGREE,
    bias: DEGREE,
    drift: instability(2.0 * DEGREE_PER_HOUR),
    scale_error: 0.01,
    misalignment: 0.01,
    bandwidth: 532.0,
    resolution: DEGREE / 65.536,
    full_scale: 500.0 * DEGREE,
    sampling: sampling(2000.0, 50e-6),
};

/// Bosch BMI088, BST-BMI088-DS001.
///
/// Accelerometer: 160 µg/√Hz in x and y, which are taken to lie in the plane of motion (190 in z), zero-g offset ±20 mg typ., cross-axis
/// 0.5 % typ. Configured: ±12 g in 16 bits, 1.6 kHz in normal mode with a bandwidth of 280 Hz. Modelled: scale error 0.5 %, bias stability
/// 30 µg, 50 µs to read out over SPI.
pub const BMI088_ACCELEROMETER: Inertial = Inertial {
    noise_density: 160.0 * MICRO_G,
    bias: 20.0 * MILLI_G,
    drift: instability(30.0 * MICRO_G),
    scale_error: 0.005,
    misalignment: 0.005,
    bandwidth: 280.0,
    resolution: 12.0 * GRAVITY / 32768.0,
    full_scale: 12.0 * GRAVITY,
    sampling: sampling(1600.0, 50e-6),
};

/// Analog Devices ADIS16470, data sheet rev. C: calibrated at the factory.
///
/// Gyroscope (Table 1): 0.008 °/s/√Hz, in-run bias stability 8 °/h, −3 dB at 550 Hz, ±2000 °/s at 10 LSB/°/s in 16 bits, 2000 readings a
/// second. Modelled: turn-on bias 0.2 °/s, scale error 0.1 %, misalignment 0.1°, 0.2 ms for a burst of 176 bits at 1 MHz.
pub const ADIS16470_GYROSCOPE: Inertial = Inertial {
    noise_density: 0.008 * DEGREE,
    bias: 0.2 * DEGREE,
    drift: instability(8.0 * DEGREE_PER_HOUR),
    scale_error: 0.001,
    misalignment: 0.1 * DEGREE,
    bandwidth: 550.0,
    resolution: 0.1 * DEGREE,
    full_scale: 2000.0 * DEGREE,
    sampling: sampling(2000.0, 0.2e-3),
};

/// Analog Devices ADIS16470, data sheet rev. C.
///
/// Accelerometer (Table 1): 100 µg/√Hz, in-run bias stability 13 µg, −3 dB at 600 Hz, ±40 g at 800 LSB/g in 16 bits, 2000 readings a
/// second. Modelled: turn-on bias 2 mg, scale error 0.1 %, misalignment 0.1°, 0.2 ms for a burst of 176 bits at 1 MHz.
pub const ADIS16470_ACCELEROMETER: Inertial = Inertial {
    noise_density: 100.0 * MICRO_G,
    bias: 2.0 * MILLI_G,
    drift: instability(13.0 * MICRO_G),
    scale_error: 0.001,
    misalignment: 0.1 * DEGREE,
    bandwidth: 600.0,
    resolution: GRAVITY / 800.0,
    full_scale: 40.0 * GRAVITY,
    sampling: sampling(2000.0, 0.2e-3),
};

/// Analog Devices ADXL355, ADXL354/ADXL355 data sheet: a low-noise accelerometer as used in seismographs.
///
/// 25 µg/√Hz typ., 0 g offset ±25 mg typ. (±75 mg max.), sensitivity ±8 % max., cross-axis 1 % typ. Configured: ±4.096 g in 20 bits
/// (128,000 LSB/g), 4 kHz with the low-pass at a quarter of that. Modelled: bias stability 3 µg; 0.4 ms of latency, because its decimation
/// filter delays by some 0.63 ms and a Butterworth filter of 1 kHz by 0.23 ms only.
pub const ADXL355_ACCELEROMETER: Inertial = Inertial {
    noise_density: 25.0 * MICRO_G,
    bias: 25.0 * MILLI_G,
    drift: instability(3.0 * MICRO_G),
    scale_error: 0.08 / 3.0,
    misalignment: 0.01,
    bandwidth: 1000.0,
    resolution: GRAVITY / 128_000.0,
    full_scale: 4.096 * GRAVITY,
    sampling: sampling(4000.0, 0.4e-3),
};

/// InvenSense MPU-6050, PS-MPU-6000A-00 rev. 3.4: old, cheap, a bad example.
///
/// Gyroscope (section 6.1): 0.005 °/s/√Hz, initial ZRO ±20 °/s typ., sensitivity ±3 % max., cross-axis ±2 % typ. Configured: ±500 °/s
/// (65.5 LSB/°/s), 1 kHz, DLPF_CFG 2: 98 Hz with a delay of 2.8 ms, 0.5 ms more than the Butterworth filter's. Modelled: bias stability
/// 40 °/h, jitter 10 µs, another 0.4 ms to read 14 bytes over I²C at 400 kHz.
pub const MPU_6050_GYROSCOPE: Inertial = Inertial {
    noise_density: 0.005 * DEGREE,
    bias: 20.0 * DEGREE,
    drift: instability(40.0 * DEGREE_PER_HOUR),
    scale_error: 0.01,
    misalignment: 0.02,
    bandwidth: 98.0,
    resolution: DEGREE / 65.5,
    full_scale: 500.0 * DEGREE,
    sampling: Sampling { rate: 1000.0, synchronous: false, jitter: 10e-6, latency: 0.9e-3 },
};

/// InvenSense MPU-6050, PS-MPU-6000A-00 rev. 3.4.
///
/// Accelerometer (section 6.2): 400 µg/√Hz, zero-g level ±50 mg typ. in x and y, calibration ±3 % typ., cross-axis ±2 % typ. Configured:
/// ±4 g (8192 LSB/g), 1 kHz, DLPF_CFG 2: 94 Hz with a delay of 3.0 ms, 0.6 ms more than the Butterworth filter's. Modelled: bias
/// stability 100 µg, jitter 10 µs, another 0.4 ms to read 14 bytes over I²C at 400 kHz.
pub const MPU_6050_ACCELEROMETER: Inertial = Inertial {
    noise_density: 400.0 * MICRO_G,
    bias: 50.0 * MILLI_G,
    drift: instability(100.0 * MICRO_G),
    scale_error: 0.03,
    misalignment: 0.02,
    bandwidth: 94.0,
    resolution: GRAVITY / 8192.0,
    full_scale: 4.0 * GRAVITY,
    sampling: Sampling { rate: 1000.0, synchronous: false, jitter: 10e-6, latency: 1.0e-3 },
};

/// CUI Devices AMT102-V, data sheet of 08/2021: capacitive, 2048 pulses a revolution (the finest of its switch settings), so 8192 counts,
/// here on a pinion of [`PINION_RADIUS`]. Its accuracy of ±0.25° is a slow error that is not modelled. The controller counts in hardware:
/// no latency.
pub const AMT102_V: Encoder = Encoder {
    resolution: Encoder::rotary_resolution(8192.0, PINION_RADIUS),
    miss_probability: 0.0,
    sampling: Sampling::CONTINUOUS,
};

/// Renishaw/RLS LM10: an incremental magnetic encoder on the rack itself. Its readheads come with resolutions from below 1 µm up; the
/// presets take 1, 5 and 10 µm. Hysteresis and the error of the scale are not modelled, nor is the delay of its interpolator.
const fn lm10(resolution: f64) -> Encoder {
    Encoder { resolution, miss_probability: 0.0, sampling: Sampling::CONTINUOUS }
}

const fn preset<T: Copy>(name: &'static str, summary: &'static str, part: T) -> Preset<T> {
    Preset { name, summary, part }
}

/// Gyroscopes.
pub const GYROSCOPES: &[Preset<Inertial>] = &[
    preset("ideal", "reads the truth", Inertial::IDEAL),
    preset("icm-42688-p", "TDK InvenSense ICM-42688-P: 2.8 mdps/√Hz, 8 kHz, 536 Hz", ICM_42688_P_GYROSCOPE),
    preset("bmi088", "Bosch BMI088: 14 mdps/√Hz, 2 kHz, 532 Hz", BMI088_GYROSCOPE),
    preset("adis16470", "Analog Devices ADIS16470: 8 mdps/√Hz, 8 °/h, 2 kHz, 550 Hz", ADIS16470_GYROSCOPE),
    preset("mpu-6050", "InvenSense MPU-6050: 5 mdps/√Hz, ±20 dps bias, 1 kHz, 98 Hz", MPU_6050_GYROSCOPE),
];

/// Accelerometers.
pub const ACCELEROMETERS: &[Preset<Inertial>] = &[
    preset("ideal", "reads the truth", Inertial::IDEAL),
    preset("icm-42688-p", "TDK InvenSense ICM-42688-P: 70 µg/√Hz, 8 kHz, 536 Hz", ICM_42688_P_ACCELEROMETER),
    preset("bmi088", "Bosch BMI088: 160 µg/√Hz, 1.6 kHz, 280 Hz", BMI088_ACCELEROMETER),
    preset("adis16470", "Analog Devices ADIS16470: 100 µg/√Hz, 13 µg, 2 kHz, 600 Hz", ADIS16470_ACCELEROMETER),
    preset("adxl355", "Analog Devices ADXL355: 25 µg/√Hz, 4 kHz, 1 kHz", ADXL355_ACCELEROMETER),
    preset("mpu-6050", "InvenSense MPU-6050: 400 µg/√Hz, 1 kHz, 94 Hz", MPU_6050_ACCELEROMETER),
];

/// Encoders.
pub const ENCODERS: &[Preset<Encoder>] = &[
    preset("ideal", "10 nm", Encoder::IDEAL),
    preset("lm10", "RLS LM10, linear magnetic: 5 µm", lm10(5e-6)),
    preset("lm10-1um", "RLS LM10, linear magnetic: 1 µm", lm10(1e-6)),
    preset("lm10-10um", "RLS LM10, linear magnetic: 10 µm", lm10(10e-6)),
    preset("amt102-v", "CUI AMT102-V, rotary: 8192 counts a revolution, 38 µm on a pinion of 50 mm", AMT102_V),
];

const fn measuring(gyroscope: Inertial, accelerometer: Inertial, encoder: Encoder) -> Suite {
    Suite { gyroscope, block_accelerometer: accelerometer, ground_accelerometer: accelerometer, encoder }
}

/// Whole suites: the same part on the block and on the ground, and an encoder to match.
pub const SUITES: &[Preset<Suite>] = &[
    preset("ideal", "reads the truth", Suite::IDEAL),
    preset(
        "icm-42688-p",
        "ICM-42688-P on block and ground, LM10 of 5 µm",
        measuring(ICM_42688_P_GYROSCOPE, ICM_42688_P_ACCELEROMETER, lm10(5e-6)),
    ),
    preset("bmi088", "BMI088 on block and ground, LM10 of 5 µm", measuring(BMI088_GYROSCOPE, BMI088_ACCELEROMETER, lm10(5e-6))),
    preset(
        "adis16470",
        "ADIS16470 on block and ground, LM10 of 1 µm",
        measuring(ADIS16470_GYROSCOPE, ADIS16470_ACCELEROMETER, lm10(1e-6)),
    ),
    preset("mpu-6050", "MPU-6050 on block and ground, AMT102-V", measuring(MPU_6050_GYROSCOPE, MPU_6050_ACCELEROMETER, AMT102_V)),
];

/// The preset `name` of a list.
pub fn find<T: Copy>(presets: &[Preset<T>], name: &str) -> Option<T> {
    presets.iter().find(|preset| preset.name == name).map(|preset| preset.part)
}

/// Names in a list, in its order.
pub fn names<T>(presets: &'static [Preset<T>]) -> impl Iterator<Item = &'static str> {
    presets.iter().map(|preset| preset.name)
}

#[cfg(test)]
mod tests {
    use super::super::noise::output_deviation;
    use super::*;

    #[test]
    fn densities_and_bandwidths_give_the_total_noise_of_the_data_sheet() {
        // MPU-6050, section 6.1: 0.05 °/s rms with DLPF_CFG 2.
        let Inertial { noise_density, bandwidth, sampling, .. } = MPU_6050_GYROSCOPE;
        let total = output_deviation(noise_density, bandwidth, sampling.rate) / DEGREE;
        assert!((total / 0.05 - 1.0).abs() < 0.1, "{total}");
    }

    #[test]
    fn names_are_unique_and_ideal_is_ideal() {
        let lists: [Vec<&str>; 4] =
            [names(GYROSCOPES).collect(), names(ACCELEROMETERS).collect(), names(ENCODERS).collect(), names(SUITES).collect()];
        for list in lists {
            assert!(list.iter().enumerate().all(|(index, name)| !list[..index].contains(name)));
            assert_eq!(list[0], "ideal");
        }
        assert_eq!(find(SUITES, "ideal"), Some(Suite::IDEAL));
        assert_eq!(find(SUITES, "Ideal"), None);
    }
}
