//! Random scenes: a seed and a number decide each, so that one that fails can be made again.
//!
//! Every effect has its chance, alone and together; what Sprag refuses (`docs/effects.md`, Limits) is not asked for.

mod device;
pub mod foundation;
mod motion;
pub mod sliding;

use std::fmt::Write;
use std::path::Path;

use crate::random::Random;

/// A scene, and the records that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// Its text, TOML.
    pub text: String,
    /// Names and contents of files that belong beside it.
    pub files: Vec<(String, String)>,
    /// How its flywheels are coupled, for tables.
    pub family: &'static str,
}

impl Generated {
    /// Writes its records into `folder`.
    ///
    /// # Errors
    /// In words.
    pub fn write_records(&self, folder: &Path) -> Result<(), String> {
        self.files.iter().try_for_each(|(name, text)| {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
        })
    }
}

/// Seconds between samples of the history.
pub const INTERVAL: f64 = 0.01;

/// Scene number `number` of a seed.
pub fn scene(seed: u64, number: u64) -> Generated {
    let mut random = Random::new(seed ^ number.wrapping_mul(0xd6e8_feb8_6659_fd93));
    // The first draws of neighbouring seeds are alike.
    random.next_u64();
    let mut text = format!("title = \"seed {seed}, number {number}\"\n\n");
    let slender = random.chance(0.3);
    let size = random.between(0.8, 4.0);
    let slenderness = random.between(6.0, 22.0);
    let inertia = if random.chance(0.6) { 4.0 / 3.0 } else { random.between(1.1, 1.7) };
    let _ = writeln!(text, "[block]\nsize_m = {size}\nslenderness_deg = {slenderness}\ninertia_ratio = {inertia}");
    let _ = writeln!(text, "geometry = \"{}\"", if slender { "slender" } else { "full" });
    match random.next_u64() % 6 {
        0 => text.push_str("restitution = \"geometric\"\n"),
        1 => text.push_str("restitution = \"momentum-balance\"\n"),
        _ => drop(writeln!(text, "restitution = {}", random.between(0.6, 0.95))),
    }
    // Draws of its own, so that all others stay what they were.
    let mut own = random;
    own = Random::new(own.next_u64());
    if own.chance(0.15) {
        let (scatter, seed) = (own.logarithmic(0.005, 0.3), own.next_u64() >> 1);
        let _ = writeln!(text, "restitution_scatter = {scatter}\nrestitution_seed = {seed}");
    }
    if random.chance(0.15) {
        let _ = writeln!(text, "initial_rotation_ratio = {}", random.between(-0.8, 0.8));
    } else if random.chance(0.1) {
        let _ = writeln!(text, "initial_velocity_ratio = {}", random.between(-0.6, 0.6));
    }
    let p = (crate::block::GRAVITY / (inertia * size)).sqrt();
    let mass = random.chance(0.2).then(|| random.logarithmic(500.0, 5e4));
    if let Some(mass) = mass {
        let _ = writeln!(text, "mass_kg = {mass}");
    }
    let site = device::Site { height: size * slenderness.to_radians().cos(), mass };
    let family = device::write(&mut text, &mut random, site);
    let mut files = Vec::new();
    let threshold = crate::block::GRAVITY * slenderness.to_radians().tan();
    motion::horizontal(&mut text, &mut files, &mut random, threshold, p);
    if random.chance(0.2) {
        motion::vertical(&mut text, &mut random);
    }
    motion::support(&mut text, &mut files, &random, threshold);
    let free = random.between(2.0, 4.0);
    // With flywheels that spin while the block stands, what it was like to come to rest matters by about this ratio.
    let _ = writeln!(text, "\n[run]\nfree_time_s = {free}\nrest_speed_ratio = 1e-9");
    let _ = writeln!(text, "\n[output]\ninterval_s = {INTERVAL}\nenergy = true");
    Generated { text, files, family }
}
