//! Random scenes of a block whose base may slide.

use std::fmt::Write;

use super::{Generated, INTERVAL, motion};
use crate::random::Random;

/// Scene number `number` of a seed.
pub fn scene(seed: u64, number: u64) -> Generated {
    let mut random = Random::new(seed ^ number.wrapping_mul(0xd6e8_feb8_6659_fd93));
    random.next_u64();
    let mut text = format!("title = \"seed {seed}, number {number}, sliding\"\n\n");
    let size = random.between(0.4, 3.0);
    let degrees = random.between(6.0, 36.0);
    let inertia = if random.chance(0.7) { 4.0 / 3.0 } else { random.between(1.2, 1.6) };
    let tangent = degrees.to_radians().tan();
    let most = 1.9 * (inertia * (inertia - 1.0_f64)).sqrt();
    let friction = (tangent * random.logarithmic(0.2, 4.0)).min(most);
    let _ = writeln!(text, "[block]\nsize_m = {size}\nslenderness_deg = {degrees}\ninertia_ratio = {inertia}");
    let _ = writeln!(text, "friction_coefficient = {friction}");
    let own = 1.0 - 2.0 * degrees.to_radians().sin().powi(2) / inertia;
    if random.chance(0.5) {
        text.push_str("restitution = \"geometric\"\n");
    } else {
        let _ = writeln!(text, "restitution = {}", own * random.between(0.6, 1.0));
    }
    if random.chance(0.3) {
        let _ = writeln!(text, "initial_rotation_ratio = {}", random.between(-0.9, 0.9));
    }
    text.push_str("\n[[device]]\nkind = \"none\"\n");
    let mut files = Vec::new();
    let p = (crate::block::GRAVITY / (inertia * size)).sqrt();
    let threshold = crate::block::GRAVITY * tangent.min(friction);
    motion::horizontal(&mut text, &mut files, &mut random, threshold, p);
    if random.chance(0.25) {
        motion::vertical(&mut text, &mut random);
    }
    let _ = writeln!(text, "\n[run]\nfree_time_s = {}\nrest_speed_ratio = 1e-9", random.between(1.0, 3.0));
    let _ = writeln!(text, "\n[output]\ninterval_s = {INTERVAL}");
    let family = if friction < tangent { "slides first" } else { "tips first" };
    Generated { text, files, family }
}
