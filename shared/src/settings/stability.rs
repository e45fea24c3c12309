//! Whether an estimator with fixed gains forgets an error of its own.
//!
//! Between impacts the error of (θ, θ̇ T, θ̈ T², b T) is multiplied at every tick of T by F = (I − K H) A, where A moves the state on, H is what
//! encoder, gyroscope and accelerometers see of it and K are the gains. The estimator forgets if a power of F has all its entries below 1/4 (for
//! four states; then every eigenvalue is inside of the unit circle), and what takes longer than 2²⁶ ticks counts as never.

use crate::control::estimation::Estimator;
use crate::control::sensing::instruments::Instruments;

const STATES: usize = 4;

/// Squarings of F.
const SQUARINGS: u32 = 26;

type Matrix = [[f32; STATES]; STATES];

/// Of the `estimator`, for a block whose frequency squared is `square`, 1/s².
pub(super) fn forgets(estimator: &Estimator, instruments: &Instruments, square: f32) -> bool {
    decays(deviation_from_one(estimator, instruments, square))
}

/// F − I: an error that lasts long has an eigenvalue so near to 1 that single precision would not show it.
fn deviation_from_one(estimator: &Estimator, instruments: &Instruments, square: f32) -> Matrix {
    let period = instruments.period;
    let [encoder_delay, gyroscope_delay] = [instruments.encoder_delay, instruments.gyroscope_delay].map(|delay| delay / period);
    let zero = [0.0; 3];
    // Rows are states, columns sensors.
    let (gains, kinematic, biased) = match estimator {
        Estimator::ModelAided(estimator) => {
            let [[a, b], [c, d]] = estimator.gains;
            ([[a, b, 0.0], [c, d, 0.0], zero, zero], false, false)
        }
        Estimator::Kalman(estimator) => (estimator.gains, true, estimator.gains.last() != Some(&zero)),
        Estimator::Complementary(estimator) => {
            let [rotation, velocity] = estimator.gains;
            ([[rotation, 0.0, 0.0], [velocity, 0.0, 0.0], zero, zero], false, false)
        }
    };
    let model_aided = matches!(estimator, Estimator::ModelAided(_));
    let of_bias = if biased { 1.0 } else { 0.0 };
    let sees = if kinematic {
        [
            [1.0, -encoder_delay, 0.5 * encoder_delay * encoder_delay, 0.0],
            [0.0, 1.0, -gyroscope_delay, of_bias],
            [0.0, 0.0, 1.0, 0.0],
        ]
    } else {
        [[1.0, -encoder_delay, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0; STATES]]
    };
    // A − I. A state that is none is forgotten at once.
    let falls = if model_aided { square * period * period } else { 0.0 };
    let moves = if kinematic {
        [[0.0, 1.0, 0.5, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0; STATES], [0.0, 0.0, 0.0, of_bias - 1.0]]
    } else {
        [[0.0, 1.0, 0.0, 0.0], [falls, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, -1.0]]
    };
    let scales = [1.0, period, period * period, period];
    let of_sensors = [1.0, period, period * period];
    let mut deviation = moves;
    for ((row, gains), scale) in deviation.iter_mut().zip(&gains).zip(scales) {
        for ((gain, of_sensor), seen) in gains.iter().zip(of_sensors).zip(&sees) {
            let gain = gain * scale / of_sensor;
            // H A = H + H (A − I).
            let mut ahead = *seen;
            for (share, moves) in seen.iter().zip(&moves) {
                for (place, moves) in ahead.iter_mut().zip(moves) {
                    *place += share * moves;
                }
            }
            for (place, ahead) in row.iter_mut().zip(ahead) {
                *place -= gain * ahead;
            }
        }
    }
    deviation
}

/// Whether a power of I + D is small: (I + D)² = I + (2 D + D²).
fn decays(mut deviation: Matrix) -> bool {
    for _ in 0..SQUARINGS {
        if small(&deviation) {
            return true;
        }
        let mut next = deviation.map(|row| row.map(|entry| 2.0 * entry));
        for (place, row) in next.iter_mut().zip(&deviation) {
            for (entry, other) in row.iter().zip(&deviation) {
                for (place, other) in place.iter_mut().zip(other) {
                    *place += entry * other;
                }
            }
        }
        deviation = next;
    }
    small(&deviation)
}

fn small(deviation: &Matrix) -> bool {
    deviation.iter().enumerate().all(|(number, row)| {
        row.iter().enumerate().all(|(column, entry)| {
            let one = if number == column { 1.0 } else { 0.0 };
            (one + entry).abs() < 1.0 / STATES as f32
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diagonal(poles: [f32; STATES]) -> Matrix {
        core::array::from_fn(|row| core::array::from_fn(|column| if row == column { poles[row] - 1.0 } else { 0.0 }))
    }

    #[test]
    fn poles_inside_of_the_unit_circle_decay_and_no_others() {
        for pole in [0.0, 0.5, 0.99, 0.999_99, -0.99] {
            assert!(decays(diagonal([0.0, pole, 0.3, 0.9])), "{pole}");
        }
        for pole in [1.0, 1.000_01, 1.5, -1.0, -1.01, 1e12, f32::NAN] {
            assert!(!decays(diagonal([0.0, pole, 0.3, 0.9])), "{pole}");
        }
        // A pair of poles at r exp(±i): a turn with a shrinking.
        for (radius, stable) in [(0.999_f32, true), (1.001, false)] {
            let (sine, cosine) = crate::math::sine32::sin_cos(1.0);
            let mut turn = diagonal([0.0; STATES]);
            (turn[0][0], turn[0][1]) = (radius * cosine - 1.0, -radius * sine);
            (turn[1][0], turn[1][1]) = (radius * sine, radius * cosine - 1.0);
            assert_eq!(decays(turn), stable, "{radius}");
        }
    }
}
