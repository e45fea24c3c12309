//! From Eq. 10 to a clutch that has moved: commands, delays, dwell, missed engagements.

use crate::device::Device;
use crate::mode::{Link, State};
use crate::random::Random;

/// Command and clocks of one clutch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Command {
    /// It shall be engaged.
    pub wanted: bool,
    /// When the command takes effect, s.
    pub due: Option<f64>,
    /// It does not move before this time, s.
    pub stays_until: f64,
    /// When it engaged, s.
    pub engaged_at: f64,
}

impl Command {
    /// When its capacity is full, if it rises at `time`.
    pub fn full_at(&self, device: &Device) -> f64 {
        self.engaged_at + device.rise
    }
}

/// Gives a command, if it is new. A command to a clutch that is already as it shall be only takes an older one back.
pub fn give(device: &Device, state: &mut State, wheel: usize, engage: bool) {
    if state.wheels[wheel].command.wanted == engage {
        return;
    }
    let mut obeys = true;
    if engage {
        state.engagements += 1;
        obeys = !misses(device, state.engagements);
    }
    let time = state.time;
    let wheel = &mut state.wheels[wheel];
    let open = wheel.link == Link::Open;
    wheel.command.wanted = engage;
    let moves = if engage { open && obeys } else { !open };
    let delay = if engage { device.engagement_delay } else { device.release_delay };
    wheel.command.due = moves.then(|| (time + delay).max(wheel.command.stays_until));
}

/// Whether engagement number `count` is missed. Each number has its own draw, so that it depends on nothing else.
pub fn misses(device: &Device, count: u32) -> bool {
    let before = device.miss_seed.wrapping_add(u64::from(count).wrapping_sub(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let draw = Random::new(before).next_u64() >> 32;
    draw < (device.miss_probability * 4_294_967_296.0) as u64
}
