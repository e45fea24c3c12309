//! The smallest standard pinion that bears what the clutch behind it passes on, and that clutch.

use serde::Serialize;
use sprag_shared::structure::gear_teeth::Gear;

use super::basis::Basis;
use super::standard::{MODULES_MM, R10, preferred};

/// A pinion on the rack, and the clutch on its shaft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pinion {
    /// Module, mm.
    pub module_mm: f64,
    /// Teeth z.
    pub teeth: u32,
    /// Face width b, mm.
    pub face_width_mm: f64,
    /// Pitch radius ρ = m z/2, m.
    pub radius_m: f64,
    /// Torque that the force at the rack exerts, N m, times the service factor.
    pub torque_needed_n_m: f64,
    /// Torque of the clutch, N m: the next of R10; none of a device without a clutch.
    pub clutch_torque_n_m: Option<f64>,
    /// Tangential force that teeth are sized for, N: that at which the clutch slips, or the largest times the service factor.
    pub load_n: f64,
    /// Lewis's bending stress under it, MPa.
    pub stress_mpa: f64,
}

/// The one of the smallest standard module whose teeth bear `force_n` (N, above 0), the largest of one flywheel at the rack: with a clutch the
/// force at which that slips, so that a tooth is never the weakest part; without one `force_n` times the service factor.
///
/// T ≥ k F ρ with T of the series R10, and F_t/(b m Y) ≤ σ ([`Gear::bending_stress`]) with F_t = T/ρ or k F.
///
/// # Errors
/// The pinion of the largest module, where that is not enough.
pub fn pinion(force_n: f64, has_clutch: bool, basis: &Basis) -> Result<Pinion, Pinion> {
    let of_module = |module_mm: f64| {
        let module_m = 1e-3 * module_mm;
        let radius_m = 0.5 * module_m * f64::from(basis.teeth);
        let gear = Gear {
            module_m,
            face_width_m: basis.face_width_modules * module_m,
            teeth: basis.teeth,
            allowable_stress_pa: 1e6 * basis.allowable_stress_mpa,
        };
        let torque_needed_n_m = basis.service_factor * force_n * radius_m;
        let clutch_torque_n_m = has_clutch.then(|| preferred(&R10, torque_needed_n_m));
        let load_n = clutch_torque_n_m.unwrap_or(torque_needed_n_m) / radius_m;
        Pinion {
            module_mm,
            teeth: basis.teeth,
            face_width_mm: basis.face_width_modules * module_mm,
            radius_m,
            torque_needed_n_m,
            clutch_torque_n_m,
            load_n,
            stress_mpa: 1e-6 * gear.bending_stress(load_n),
        }
    };
    let [.., largest] = MODULES_MM;
    let bears = |pinion: &Pinion| pinion.stress_mpa <= basis.allowable_stress_mpa;
    MODULES_MM.into_iter().map(of_module).find(bears).ok_or_else(|| of_module(largest))
}

/// Teeth of a rack that travels by `travel_m` from end to end: those of the travel, and two beyond each end, where the pinion meshes.
pub fn rack_teeth(travel_m: f64, module_mm: f64) -> f64 {
    let pitch_m = 1e-3 * std::f64::consts::PI * module_mm;
    (travel_m / pitch_m).ceil() + 4.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 kN with k = 1.5, z = 20, b = 10 m, 200 MPa: 15000/(10 m² Y) with Y = 0.484 − 2.87/20 = 0.3405 asks for m ≥ √(15000/(10 · 0.3405 ·
    /// 200)) mm = 4.69 mm, so for 5 mm; ρ = 50 mm and T = 750 N m, of which 800 is the next.
    #[test]
    fn a_pinion_is_that_of_a_calculation_by_hand() {
        let basis = Basis::default();
        let bare = pinion(1e4, false, &basis).unwrap();
        assert_eq!((bare.module_mm, bare.radius_m, bare.face_width_mm), (5.0, 0.05, 50.0));
        assert!((bare.stress_mpa - 15_000.0 / (50.0 * 5.0 * 0.3405)).abs() < 1e-9);
        let clutched = pinion(1e4, true, &basis).unwrap();
        assert!((clutched.torque_needed_n_m - 750.0).abs() < 1e-9);
        assert_eq!((clutched.module_mm, clutched.clutch_torque_n_m), (5.0, Some(800.0)));
        assert!((clutched.load_n - 16_000.0).abs() < 1e-9);
    }

    #[test]
    fn twice_the_force_is_twice_the_torque_at_one_radius_and_more_than_any_gear_bears_is_refused() {
        let basis = Basis { allowable_stress_mpa: 2000.0, ..Basis::default() };
        let [one, two] = [10.0, 20.0].map(|force| pinion(force, false, &basis).unwrap());
        assert_eq!((one.module_mm, two.module_mm), (1.0, 1.0));
        assert!((two.torque_needed_n_m / one.torque_needed_n_m - 2.0).abs() < 1e-12);
        let refused = [false, true].map(|has_clutch| pinion(1e9, has_clutch, &basis).unwrap_err());
        assert!((refused[0].load_n / 1.5e9 - 1.0).abs() < 1e-12 && refused[1].load_n >= 1.5e9, "{refused:?}");
    }

    #[test]
    fn a_rack_covers_its_travel() {
        // 0.2 m over a pitch of 15.7 mm are 12.7 teeth.
        assert_eq!(rack_teeth(0.2, 5.0), 17.0);
    }
}
