//! What the study of laws varies beside the law: block and device in the ideal model, and the clutch as it is.

use super::bench::Variant;

/// α of the base, degrees.
pub const SLENDERNESS_DEG: f64 = 20.0;

/// What makes a closed loop the ideal model: ideal sensors, no delay, no hysteresis.
pub const IDEAL: [&str; 3] = ["controller.rate_hz=1000.0", "controller.shock_s=0.0", "controller.hysteresis=0.0"];

/// Key of the brake.
const BRAKE: &str = "device.0.flywheel.brake_deceleration_m_s2";

/// A block with its device, and what a law works with.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// For headings.
    pub name: String,
    /// α, degrees.
    pub slenderness_deg: f64,
    /// Keys of the scene.
    pub overrides: Vec<String>,
}

impl Setting {
    /// The base.
    pub fn base() -> Setting {
        Setting { name: "base".to_owned(), slenderness_deg: SLENDERNESS_DEG, overrides: Vec::new() }
    }

    /// The base with one thing different.
    pub fn others() -> Vec<Setting> {
        let slender = |degrees: f64| Setting { name: format!("α = {degrees}°"), slenderness_deg: degrees, ..Setting::base() };
        let keyed = |symbol: &str, key: &str, value: f64| Setting {
            name: format!("{symbol} = {value}"),
            overrides: vec![format!("{key}={value:?}")],
            ..Setting::base()
        };
        let mut settings: Vec<Setting> = [10.0, 15.0, 28.0].into_iter().map(slender).collect();
        settings.extend([0.25, 1.0, 1.5].map(|ratio| keyed("σ", "device.0.mass_ratio", ratio)));
        settings.extend([0.75, 0.93].map(|restitution| keyed("η", "block.restitution", restitution)));
        settings
    }

    /// The same with clutches as they are: `delay_ms` from sample to clutch, of which 1 ms is the controller's; released flywheels are
    /// braked at 2 m/s² or coast.
    pub(super) fn with_clutch(mut self, delay_ms: f64, braked: bool) -> Setting {
        self.overrides.extend([
            "device.0.engagement=\"rigid\"".to_owned(),
            "device.0.flywheel.viscous_rate_1_s=0.05".to_owned(),
            "controller.rate_hz=1000.0".to_owned(),
            "controller.latency_s=0.001".to_owned(),
            "controller.sensors.suite=\"adis16470\"".to_owned(),
        ]);
        self.overrides.extend(
            ["engagement_delay_s", "release_delay_s"]
                .map(|key| format!("device.0.actuation.{key}={:?}", 1e-3 * (delay_ms - 1.0))),
        );
        self.overrides.extend(braked.then(|| format!("{BRAKE}=2.0")));
        self
    }

    /// The base with such clutches, named by them.
    pub(super) fn clutch(delay_ms: f64, braked: bool) -> Setting {
        let name = format!("{delay_ms} ms, released wheels {}", if braked { "braked" } else { "coast" });
        Setting { name, ..Setting::base().with_clutch(delay_ms, braked) }
    }

    /// Clutches as they are: fast ones, and those that docs/effects.md calls typical.
    pub fn clutches() -> Vec<Setting> {
        [(3.0, true), (20.0, true), (50.0, true), (3.0, false)].map(|(delay, braked)| Setting::clutch(delay, braked)).to_vec()
    }

    /// Released flywheels are braked.
    pub(super) fn braked(&self) -> bool {
        self.overrides.iter().any(|text| text.starts_with(BRAKE))
    }

    /// Which of [`Setting::clutches`] are the typical ones.
    pub const TYPICAL: std::ops::Range<usize> = 1..3;

    /// Variant with these settings.
    pub fn variant(&self) -> Variant {
        let mut variant = Variant::new(&self.name, &[&format!("block.slenderness_deg={:?}", self.slenderness_deg)]);
        variant.overrides.extend_from_slice(&self.overrides);
        variant
    }
}
