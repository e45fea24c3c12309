//! The steady swing of a slender block about its unstable balance with dashpots in series with inertances.

use crate::math::{sin_cos, square_root};
use crate::structure::block::Block;

/// Phasors (real, imaginary) of quantities that swing with ω under the ground a = A sin ωt.
pub struct Swing {
    omega: f64,
    /// X of θ = α + Im X e^(iωt).
    pub rotation: (f64, f64),
    /// Of θ̇.
    pub velocity: (f64, f64),
    /// Of the flywheels' speeds, w = ẋ/(1 + iω/c).
    pub spin: (f64, f64),
}

impl Swing {
    /// From θ̈ + k θ̈/(1 + iω/c) = p²(θ − α) − p² a, linear for a slender `block`, with ω/c = `ratio` and the `amplitude` A in g.
    pub fn of(block: &Block, k: f64, (omega, amplitude): (f64, f64), ratio: f64) -> Swing {
        let p = block.frequency_parameter();
        let share = 1.0 / (1.0 + ratio * ratio);
        let (real, imaginary) = (p * p + omega * omega * (1.0 + k * share), -omega * omega * k * share * ratio);
        let square = real * real + imaginary * imaginary;
        let x = (p * p * amplitude * real / square, -p * p * amplitude * imaginary / square);
        let velocity = (-omega * x.1, omega * x.0);
        let spin = ((velocity.0 + ratio * velocity.1) * share, (velocity.1 - ratio * velocity.0) * share);
        Swing { omega, rotation: x, velocity, spin }
    }

    /// The quantity of a phasor at a time, s.
    pub fn at(&self, time: f64, (re, im): (f64, f64)) -> f64 {
        let (sin, cos) = sin_cos(self.omega * time);
        re * sin + im * cos
    }

    /// |X|, rad.
    pub fn size(&self) -> f64 {
        square_root(self.rotation.0 * self.rotation.0 + self.rotation.1 * self.rotation.1)
    }
}
