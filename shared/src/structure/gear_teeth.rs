//! Teeth of a flywheel train: what each mesh carries, and the bending stress there.

use super::error::{ParameterError, require};
use super::inertance::{Flywheel, inertance_of_train};

/// Tangential force at each mesh of `train` over that at the first, which is the force on the rack.
///
/// Wheel i turns with its pinion, on which the mesh before it exerts F_i at ρ_i; it passes F_{i+1} on at its own rim:
///
/// F_i ρ_i − F_{i+1} R_i = I_i ω̇_i,  I_i = ½ m_wi R_i².
///
/// What lies behind a mesh acts on it with its inertance M_i (Eq. 9 of the rest of the train), F_i = M_i a_i, and
/// a_{i+1} = a_i R_i/ρ_i, so that F_{i+1}/F_i = (R_i/ρ_i) M_{i+1}/M_i. Bearings are without friction. A mesh with nothing
/// but massless wheels behind it carries nothing.
///
/// # Errors
/// The errors of [`inertance_of_train`].
pub fn tooth_load_ratios(train: &[Flywheel]) -> Result<impl Iterator<Item = f64> + '_, ParameterError> {
    inertance_of_train(train)?;
    let behind = |mesh: usize| inertance_of_train(&train[mesh..]).unwrap_or(0.0);
    let whole = behind(0);
    let mut amplification = 1.0;
    Ok(train.iter().enumerate().map(move |(mesh, wheel)| {
        let ratio = if whole > 0.0 { amplification * behind(mesh) / whole } else { 0.0 };
        amplification *= wheel.radius / wheel.pinion_radius;
        ratio
    }))
}

/// The smaller gear of a mesh: full-depth involute teeth with a pressure angle of 20 degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// Module (m): pitch diameter over number of teeth; above 0.
    pub module_m: f64,
    /// Face width b, m; above 0.
    pub face_width_m: f64,
    /// Number of teeth z; 12 to 10,000. Below 17 the teeth are undercut unless they are shifted.
    pub teeth: u32,
    /// Bending stress that a tooth may bear at its root, Pa; above 0.
    pub allowable_stress_pa: f64,
}

impl Gear {
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn check(&self) -> Result<(), ParameterError> {
        require("module_m", self.module_m, self.module_m > 0.0, "above 0 m")?;
        require("face_width_m", self.face_width_m, self.face_width_m > 0.0, "above 0 m")?;
        require("teeth", f64::from(self.teeth), (12..=10_000).contains(&self.teeth), "from 12 to 10000")?;
        require("allowable_stress_pa", self.allowable_stress_pa, self.allowable_stress_pa > 0.0, "above 0 Pa").map(|_| ())
    }

    /// Y = 0.484 − 2.87/z, Lewis's form factor (Lewis 1893, with π: Y = π (0.154 − 0.912/z)). Some per cent above the values
    /// tabulated for a load at the tip between 15 and 60 teeth.
    pub fn form_factor(&self) -> f64 {
        0.484 - 2.87 / f64::from(self.teeth)
    }

    /// Lewis's bending stress at the root of a tooth (Pa) that carries the tangential force `load` (N) alone:
    /// σ = F/(b m Y). Without factors for speed, overload and load distribution.
    pub fn bending_stress(&self, load: f64) -> f64 {
        load.abs() / (self.face_width_m * self.module_m * self.form_factor())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    const PINION: Gear = Gear { module_m: 4e-3, face_width_m: 40e-3, teeth: 20, allowable_stress_pa: 200e6 };

    fn train() -> [Flywheel; 3] {
        [
            Flywheel { mass: 3.0, radius: 0.4, pinion_radius: 0.1 },
            Flywheel { mass: 7.0, radius: 0.3, pinion_radius: 0.2 },
            Flywheel { mass: 2.0, radius: 0.5, pinion_radius: 0.05 },
        ]
    }

    #[test]
    fn every_wheels_moment_of_momentum_balances() {
        let train = train();
        let ratios: Vec<f64> = tooth_load_ratios(&train).unwrap().collect();
        // The rack accelerates by 1 m/s²; behind the last wheel there is no mesh.
        let force = inertance_of_train(&train).unwrap();
        let mut rim = 1.0;
        for (i, wheel) in train.iter().enumerate() {
            let spin = rim / wheel.pinion_radius;
            let inertia = 0.5 * wheel.mass * wheel.radius * wheel.radius;
            let next = ratios.get(i + 1).copied().unwrap_or(0.0);
            let excess = force * (ratios[i] * wheel.pinion_radius - next * wheel.radius) - inertia * spin;
            assert!(excess.abs() < 1e-10 * inertia * spin, "wheel {i}: {excess}");
            rim = spin * wheel.radius;
        }
        assert_eq!(ratios[0], 1.0);
    }

    #[test]
    fn a_massless_first_wheel_is_a_gearbox() {
        let mut train = train();
        train[0].mass = 0.0;
        let ratios: Vec<f64> = tooth_load_ratios(&train[..2]).unwrap().collect();
        assert!((ratios[1] - 0.25).abs() < 1e-15, "4 times the speed, a quarter of the force");
        train.iter_mut().for_each(|wheel| wheel.mass = 0.0);
        assert_eq!(tooth_load_ratios(&train).unwrap().collect::<Vec<f64>>(), [0.0; 3]);
        assert!(tooth_load_ratios(&[]).is_err());
    }

    #[test]
    fn the_form_factor_has_the_ends_of_the_tables() {
        let factor = |teeth| Gear { teeth, ..PINION }.form_factor();
        // Tabulated for 20 degrees, full depth: 0.245 for 12 teeth, 0.322 for 20, 0.409 for 50, 0.485 for a rack.
        assert!((factor(12) - 0.245).abs() < 1e-3 && (factor(10_000) - 0.485).abs() < 2e-3);
        assert!((factor(20) / 0.322 - 1.0).abs() < 0.08 && (factor(50) / 0.409 - 1.0).abs() < 0.08);
    }

    #[test]
    fn a_tooth_bends_under_its_load() {
        // 4 kN on 40 mm of module 4: 4000/(0.04 · 0.004 · 0.3405) = 73.4 MPa.
        assert!((PINION.bending_stress(-4000.0) / 73.42e6 - 1.0).abs() < 1e-3);
        let refused = |gear: Gear| gear.check().unwrap_err().parameter;
        assert_eq!(refused(Gear { module_m: 0.0, ..PINION }), "module_m");
        assert_eq!(refused(Gear { face_width_m: f64::NAN, ..PINION }), "face_width_m");
        assert_eq!(refused(Gear { teeth: 11, ..PINION }), "teeth");
        assert_eq!(refused(Gear { allowable_stress_pa: -1.0, ..PINION }), "allowable_stress_pa");
        assert!(PINION.check().is_ok());
    }
}
