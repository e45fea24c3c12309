//! Random scenes of a block on a compliant foundation.

use std::fmt::Write;

use super::{Generated, INTERVAL, motion};
use crate::random::Random;

/// Scene number `number` of a seed.
pub fn scene(seed: u64, number: u64) -> Generated {
    let mut random = Random::new(seed ^ number.wrapping_mul(0xd6e8_feb8_6659_fd93));
    random.next_u64();
    let mut text = format!("title = \"seed {seed}, number {number}, foundation\"\n\n");
    let size = random.between(0.5, 4.0);
    let degrees = random.between(6.0, 30.0);
    let inertia = if random.chance(0.7) { 4.0 / 3.0 } else { random.between(1.1, 1.7) };
    let _ = writeln!(text, "[block]\nsize_m = {size}\nslenderness_deg = {degrees}\ninertia_ratio = {inertia}");
    let (hertz, damping) = (random.logarithmic(3.0, 40.0), random.logarithmic(0.02, 0.8));
    let _ = writeln!(text, "foundation = {{ vertical_frequency_hz = {hertz}, damping_ratio = {damping} }}");
    if random.chance(0.3) {
        let _ = writeln!(text, "initial_rotation_ratio = {}", random.between(-0.9, 0.9));
    }
    let family = random.pick(&["none", "inerter", "clutched-pair"]);
    let _ = writeln!(text, "\n[[device]]\nkind = \"{family}\"");
    if family != "none" {
        let kinematics = random.pick(&["paper", "consistent"]);
        let _ = writeln!(text, "mass_ratio = {}\nkinematics = \"{kinematics}\"", random.between(0.1, 1.2));
    }
    let mut files = Vec::new();
    let p = (crate::block::GRAVITY / (inertia * size)).sqrt();
    motion::horizontal(&mut text, &mut files, &mut random, crate::block::GRAVITY * degrees.to_radians().tan(), p);
    if random.chance(0.25) {
        motion::vertical(&mut text, &mut random);
    }
    let _ = writeln!(text, "\n[run]\nfree_time_s = {}", random.between(1.0, 2.0));
    let _ = writeln!(text, "\n[accuracy]\nmethod = \"runge-kutta-4\"\nstep_s = 1e-4\n\n[output]\ninterval_s = {INTERVAL}");
    Generated { text, files, family }
}
