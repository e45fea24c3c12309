//! The steel disc of an inertance.

use std::f64::consts::PI;

use serde::Serialize;

use super::basis::{DISC_THICKNESS_RATIO, STEEL_KG_M3};
use super::standard::{R20, preferred_where};

/// A flywheel on the shaft of its pinion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Disc {
    /// Moment of inertia J, kg m².
    pub inertia_kg_m2: f64,
    /// Diameter, m, of R20.
    pub diameter_m: f64,
    /// Thickness, m.
    pub thickness_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
    /// Largest speed, rev/min.
    pub speed_rev_min: f64,
    /// Largest speed at the rim, m/s.
    pub rim_speed_m_s: f64,
    /// ρ v² at the rim, the hoop stress of a thin ring, MPa: more than anywhere in a disc.
    pub rim_stress_mpa: f64,
    /// Largest kinetic energy, J.
    pub energy_j: f64,
}

impl Disc {
    /// Of the inertance `inertance_kg` behind a pinion of `pinion_radius_m`, which turns as fast as a rack of `speed_m_s` turns it.
    ///
    /// m_r = ½ m_w R²/ρ² (Eq. 9 of Thiers-Moggia and Málaga-Chuquitaype 2019, one flywheel), so J = ½ m_w R² = m_r ρ². The
    /// diameter is the smallest of R20 at which m_w = ρ_s π R² t is no thicker than t = 0.2 R; the thickness makes J exact.
    pub fn new(inertance_kg: f64, pinion_radius_m: f64, speed_m_s: f64) -> Disc {
        let inertia = inertance_kg * pinion_radius_m * pinion_radius_m;
        let mass_of = |radius: f64| 2.0 * inertia / (radius * radius);
        let thickness = |radius: f64| mass_of(radius) / (STEEL_KG_M3 * PI * radius * radius);
        let diameter = preferred_where(&R20, |diameter| thickness(0.5 * diameter) <= DISC_THICKNESS_RATIO * 0.5 * diameter);
        let radius = 0.5 * diameter;
        let spin = speed_m_s / pinion_radius_m;
        let rim_speed = spin * radius;
        Disc {
            inertia_kg_m2: inertia,
            diameter_m: diameter,
            thickness_m: thickness(radius),
            mass_kg: mass_of(radius),
            speed_rev_min: 30.0 * spin / PI,
            rim_speed_m_s: rim_speed,
            rim_stress_mpa: 1e-6 * STEEL_KG_M3 * rim_speed * rim_speed,
            energy_j: 0.5 * inertia * spin * spin,
        }
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::structure::inertance::{Flywheel, inertance_of_train};

    use super::*;

    #[test]
    fn the_disc_has_the_inertance_that_it_is_for() {
        for (inertance, pinion) in [(5000.0, 0.05), (12.0, 0.01), (2e6, 0.2)] {
            let disc = Disc::new(inertance, pinion, 0.4);
            let wheel = Flywheel { mass: disc.mass_kg, radius: 0.5 * disc.diameter_m, pinion_radius: pinion };
            assert!((inertance_of_train(&[wheel]).unwrap() / inertance - 1.0).abs() < 1e-12);
            assert!((disc.energy_j / (0.5 * inertance * 0.16) - 1.0).abs() < 1e-12, "½ m_r u̇² of the rack");
            let ratio = disc.thickness_m / (0.5 * disc.diameter_m);
            assert!(ratio <= DISC_THICKNESS_RATIO * (1.0 + 1e-9) && ratio > 0.1, "{ratio}");
        }
    }

    /// 5 t behind 50 mm: J = 12.5 kg m²; a rack at 0.3 m/s turns it by 6 rad/s, 57.3 rev/min.
    #[test]
    fn numbers_by_hand() {
        let disc = Disc::new(5000.0, 0.05, 0.3);
        assert!((disc.inertia_kg_m2 - 12.5).abs() < 1e-12 && (disc.speed_rev_min - 57.296).abs() < 1e-3);
        // R = (25/(0.2 π 7850))^0.2 = 0.3475 m: the next diameter is 710 mm, 198 kg, 63.8 mm thick, and its rim runs at 2.13 m/s.
        assert!((disc.diameter_m - 0.71).abs() < 1e-12 && (disc.mass_kg - 198.37).abs() < 0.01, "{disc:?}");
        assert!((disc.thickness_m - 0.06383).abs() < 1e-4 && (disc.rim_stress_mpa - 0.03561).abs() < 1e-4, "{disc:?}");
    }
}
