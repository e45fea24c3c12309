//! The design basis: what is assumed of material, service and margins.

use std::ops::RangeInclusive;

use serde::Serialize;
use sprag_sim::scene::Scene;

use super::error::DesignError;

/// Density of steel, kg/m³.
pub const STEEL_KG_M3: f64 = 7850.0;

/// Thickness over radius of a flywheel before its diameter is rounded up: a disc that is easily cut from plate.
pub const DISC_THICKNESS_RATIO: f64 = 0.2;

/// Teeth below which a pinion with a pressure angle of 20 degrees is undercut unless its teeth are shifted.
pub const UNDERCUT_TEETH: u32 = 17;

/// Teeth that a pinion may have.
pub const TEETH: RangeInclusive<u32> = 12..=200;

/// What is assumed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Basis {
    /// Factor on forces on the support, travel and what sensors read; 1 to 10.
    pub margin: f64,
    /// Service factor on the torque of a clutch, and on the load of teeth where no clutch limits it; 1 to 10.
    pub service_factor: f64,
    /// Teeth of the pinion; 12 to 200.
    pub teeth: u32,
    /// Face width over module; 4 to 20.
    pub face_width_modules: f64,
    /// Bending stress that a tooth may bear by Lewis's formula, and a flywheel at its rim, MPa; above 0, to 2000.
    pub allowable_stress_mpa: f64,
    /// By how much the largest rotation may grow through a delay of the clutches, relative; above 0, to 1.
    pub tolerance: f64,
}

/// - Stress: 200 MPa is a third of the tensile strength of a steel of 600 MPa, since Lewis's formula knows neither the notch at the root nor
///   shock.
/// - Teeth: 20 are not undercut. Face width: the usual 8 to 12 modules.
/// - Margins: 1.25 on what is computed, and 1.5 on a torque that friction must give.
impl Default for Basis {
    fn default() -> Self {
        Basis {
            margin: 1.25,
            service_factor: 1.5,
            teeth: 20,
            face_width_modules: 10.0,
            allowable_stress_mpa: 200.0,
            tolerance: 0.05,
        }
    }
}

impl Basis {
    /// Bending stress that teeth of `scene` may bear, MPa: that of its checks, or else the default.
    pub fn allowable_stress_of(scene: &Scene) -> f64 {
        let of_checks = || Some(scene.file.checks.as_ref()?.gear?.allowable_stress_mpa);
        of_checks().unwrap_or(Basis::default().allowable_stress_mpa)
    }

    /// # Errors
    /// [`DesignError::Range`] names the first option outside its range.
    pub fn check(&self) -> Result<(), DesignError> {
        let within = |option: &'static str, value: f64, allowed: bool, range: &'static str| {
            if allowed { Ok(()) } else { Err(DesignError::Range { option, value, range }) }
        };
        within("margin", self.margin, (1.0..=10.0).contains(&self.margin), "from 1 to 10")?;
        within("service-factor", self.service_factor, (1.0..=10.0).contains(&self.service_factor), "from 1 to 10")?;
        within("teeth", self.teeth.into(), TEETH.contains(&self.teeth), "a whole number from 12 to 200")?;
        let width = self.face_width_modules;
        within("face-width", width, (4.0..=20.0).contains(&width), "from 4 to 20 modules")?;
        let stress = self.allowable_stress_mpa;
        within("allowable-stress", stress, stress > 0.0 && stress <= 2000.0, "above 0, to 2000 MPa")?;
        within("tolerance", self.tolerance, self.tolerance > 0.0 && self.tolerance <= 1.0, "above 0, to 1")
    }
}
