//! What a controller can count and how long it can wait: scenes beyond that are refused by key.

use std::f64::consts::FRAC_PI_2;

use sprag_shared::math::sign::Sign;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::ledger::Account;
use sprag_shared::structure::Structure;

use super::supervision::longest_actuation;
use crate::scene::controller::ControllerTable;
use crate::scene::{Scene, SceneError};
use crate::sensor::Suite;

/// Counts to either side that a register of 32 bits holds.
const MOST_COUNTS: f64 = (1_u32 << 31) as f64;

/// |θ| over α up to which they are held: hardly a block that is further out comes back.
const FARTHEST: f64 = 2.0;

/// Places at which the rack's travel is looked at.
const PARTS: u32 = 256;

/// Above what rounding to the digits of a message takes away.
const ROOM: f64 = 1.005;

/// What a sum and a message may be off by, s.
const ROUNDING: f64 = 1e-9;

impl Scene {
    /// Sensors of `controller` in loops over the devices of these indices, each a clutched pair.
    ///
    /// # Errors
    /// Those of [`ControllerTable::suite`], and [`SceneError`] for an encoder whose count would wrap, and for a clutch that takes longer than
    /// a supervisor waits for it.
    pub fn loop_sensors(&self, controller: &ControllerTable, pairs: &[usize]) -> Result<Suite, SceneError> {
        let suite = controller.suite(&self.origin)?;
        for &index in pairs {
            self.check_counts(index, suite.encoder.resolution)?;
            self.check_delays(index, controller)?;
        }
        Ok(suite)
    }

    fn check_counts(&self, index: usize, resolution: f64) -> Result<(), SceneError> {
        let least = farthest_travel(&self.structure(index)) / MOST_COUNTS;
        let range = format!("at least {:.2e} m, with which a count of 32 bits holds the rack's travel at θ = 2α", ROOM * least);
        self.key("controller.sensors.encoder.resolution_m").require(resolution, resolution >= least, &range)?;
        Ok(())
    }

    fn check_delays(&self, index: usize, controller: &ControllerTable) -> Result<(), SceneError> {
        let most = longest_actuation(1.0 / controller.rate_hz) - controller.latency_s;
        let range =
            format!("at most {} s in a closed loop, which waits for a clutch for 10 s", (1e6 * (most + ROUNDING)).floor() / 1e6);
        let actuation = self.devices[index].drivetrain.actuation;
        for (name, delay) in [("engagement_delay_s", actuation.engagement_delay), ("release_delay_s", actuation.release_delay)] {
            let key = self.key(&format!("device.{index}.actuation.{name}"));
            key.require(delay, delay <= most + ROUNDING, &range)?;
        }
        Ok(())
    }
}

/// Farthest that the rack travels from θ = 0 up to [`FARTHEST`] α or where the block lies on its side, m; 0 on a mount without a lever.
fn farthest_travel(structure: &Structure) -> f64 {
    let Structure { block, geometry, device, .. } = structure;
    let Ok(terminals) = Checks::<f64>::new(block, *geometry, &device.mount, &Account::default()) else { return 0.0 };
    let part = (FARTHEST * block.slenderness()).min(FRAC_PI_2) / f64::from(PARTS);
    let travel = |number: u32| terminals.travel(Sign::Positive, f64::from(number) * part).abs();
    (1..=PARTS).map(travel).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::LoopScene;
    use super::*;
    use crate::interrupt::Interrupt;

    fn desk(change: &str) -> Result<LoopScene, String> {
        let text = "block = { size_m = 20.0, slenderness_deg = 20.0 }
            device = [{ kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid' }]
            ground = [{ motion = 'sine', amplitude_g = 0.3, frequency_hz = 1.0 }]
            controller = { latency_s = 0.001 }";
        LoopScene::new(Scene::parse_with(text, "scene", &[change]).unwrap()).map_err(|error| error.to_string())
    }

    /// A rack at the centre of mass travels 2 R sin α = 13.68 m until θ = 2α, and 2³¹ counts of 6.37 nm are as much.
    #[test]
    fn an_encoder_whose_count_would_wrap_is_refused() {
        assert!(desk("controller.sensors.encoder.resolution_m=6.4e-9").is_ok());
        let error = desk("controller.sensors.encoder.resolution_m=6.3e-9").unwrap_err();
        let refusal = "scene: controller.sensors.encoder.resolution_m is 6.3e-9, but must be at least 6.40e-9 m, ";
        assert!(error.starts_with(refusal), "{error}");
        // Through a pulley it is three times as far, which an ideal encoder cannot count.
        let pulley = "mount = 'tying-point', mount_height_m = 18.79, pulley_ratio = 3.0";
        let error = desk(&format!("device.0={{ kind = 'clutched-pair', mass_ratio = 0.5, {pulley} }}")).unwrap_err();
        assert!(error.contains("encoder.resolution_m is 1e-8, but must be at least 1.92e-8 m"), "{error}");
    }

    /// Twice the delay and the latency, and four ticks, are to be within 10 s.
    #[test]
    fn a_clutch_that_takes_longer_than_a_supervisor_waits_is_refused_by_the_key_of_its_delay() {
        for name in ["engagement_delay_s", "release_delay_s"] {
            let slowest = desk(&format!("device.0.actuation.{name}=4.998")).unwrap();
            assert!(slowest.task(0, 1, &Interrupt::default()).driver().is_ok(), "{name}");
            let error = desk(&format!("device.0.actuation.{name}=6")).err();
            let refusal = format!(
                "scene: device.0.actuation.{name} is 6, but must be at most 4.998 s in a closed loop, which waits for a clutch for 10 s"
            );
            assert_eq!(error, Some(refusal));
        }
    }
}
