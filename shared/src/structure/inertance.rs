//! Inertance of a rack, pinions and flywheels (Figure 2).

use super::error::{ParameterError, require};

/// One flywheel of a train and the pinion that drives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flywheel {
    /// m_w, kg; 0 or more (a massless gear transmits).
    pub mass: f64,
    /// R_i, m; above 0.
    pub radius: f64,
    /// ρ_i, m; above 0.
    pub pinion_radius: f64,
}

/// Apparent mass m_r (kg) of flywheels in series, the first on the rack (Eq. 9, and Eq. 8 for two):
///
/// m_r = ½ m_w1 R₁²/ρ₁² + ½ m_w2 R₁²R₂²/(ρ₁²ρ₂²) + … + ½ m_wn R₁²…R_n²/(ρ₁²…ρ_n²)
///
/// # Errors
/// [`ParameterError`] for a negative mass, a radius not above 0, or a train without a flywheel.
pub fn inertance_of_train(train: &[Flywheel]) -> Result<f64, ParameterError> {
    require("number of flywheels", train.len() as f64, !train.is_empty(), "1 or more")?;
    let mut amplification = 1.0;
    let mut inertance = 0.0;
    for wheel in train {
        require("flywheel mass", wheel.mass, wheel.mass >= 0.0, "0 kg or more")?;
        require("flywheel radius", wheel.radius, wheel.radius > 0.0, "above 0 m")?;
        require("pinion radius", wheel.pinion_radius, wheel.pinion_radius > 0.0, "above 0 m")?;
        let ratio = wheel.radius / wheel.pinion_radius;
        amplification *= ratio * ratio;
        inertance += 0.5 * wheel.mass * amplification;
    }
    require("inertance", inertance, true, "finite")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Section 2.2: with two flywheels of R/ρ = 10, one ten-thousandth of the block's mass gives a mass ratio of 0.5.
    #[test]
    fn the_papers_example() {
        let mass = 5000.0;
        let massless = Flywheel { mass: 0.0, radius: 0.5, pinion_radius: 0.05 };
        let wheel = Flywheel { mass: mass * 1e-4, ..massless };
        assert!((inertance_of_train(&[massless, wheel]).unwrap() / mass - 0.5).abs() < 1e-12);
    }

    #[test]
    fn equation_8_term_by_term() {
        let first = Flywheel { mass: 3.0, radius: 0.4, pinion_radius: 0.1 };
        let second = Flywheel { mass: 7.0, radius: 0.3, pinion_radius: 0.2 };
        let expected = 0.5 * 3.0 * 0.16 / 0.01 + 0.5 * 7.0 * (0.16 * 0.09) / (0.01 * 0.04);
        assert!((inertance_of_train(&[first, second]).unwrap() / expected - 1.0).abs() < 1e-14);
    }

    #[test]
    fn bad_trains_are_refused() {
        assert_eq!(inertance_of_train(&[]).unwrap_err().parameter, "number of flywheels");
        let wheel = Flywheel { mass: -1.0, radius: 0.4, pinion_radius: 0.1 };
        assert_eq!(inertance_of_train(&[wheel]).unwrap_err().parameter, "flywheel mass");
        let wheel = Flywheel { mass: 1.0, radius: 0.4, pinion_radius: 0.0 };
        assert_eq!(inertance_of_train(&[wheel]).unwrap_err().parameter, "pinion radius");
    }
}
