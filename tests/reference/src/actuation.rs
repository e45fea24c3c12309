//! From Eq. 10 to a clutch that has moved: commands, delays, dwell, missed engagements.

use crate::device::Device;
use crate::mode::{Link, State};
use crate::random::Random;

/// Commands that are under way to one clutch at most, by a transport delay.
const MOST_UNDER_WAY: usize = 8;

/// Command and clocks of one clutch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Command {
    /// It shall be engaged.
    pub wanted: bool,
    /// When the command takes effect, s.
    pub due: Option<f64>,
    /// By a transport delay: all that are under way, with when they are due, s. The first is the one above.
    under_way: [(f64, bool); MOST_UNDER_WAY],
    count: usize,
    /// It does not move before this time, s.
    pub stays_until: f64,
    /// When it engaged, s.
    pub engaged_at: f64,
}

impl Command {
    /// What is due at `time` wants.
    pub fn arrives(&self, device: &Device, time: f64) -> Option<bool> {
        let due = self.due.is_some_and(|due| due <= time);
        due.then_some(if device.transport { self.under_way[0].1 } else { self.wanted })
    }

    /// It has been carried out, and whether the clutch `moved` for it.
    pub fn done(&mut self, device: &Device, time: f64, moved: bool) {
        if moved {
            (self.stays_until, self.engaged_at) = (time + device.dwell, time);
        }
        if self.count > 0 {
            self.under_way.copy_within(1.., 0);
            self.count -= 1;
        }
        // None comes within the dwell.
        self.due = (self.count > 0).then(|| self.under_way[0].0.max(self.stays_until));
    }

    /// Nothing is wanted, and nothing under way.
    pub fn withdraw(&mut self) {
        (self.wanted, self.due, self.count) = (false, None, 0);
    }

    /// Sends a command that is due at `due`, not before those under way. If all places are taken, it cancels the last that says the opposite.
    fn send(&mut self, engage: bool, due: f64) {
        if self.count == MOST_UNDER_WAY {
            if self.under_way[self.count - 1].1 != engage {
                self.count -= 1;
            }
            return;
        }
        let after = if self.count > 0 { self.under_way[self.count - 1].0.max(self.due.unwrap_or(0.0)) } else { self.stays_until };
        self.under_way[self.count] = (due.max(after), engage);
        self.count += 1;
        self.due = self.due.or(Some(self.under_way[0].0));
    }

    /// When the line ends by which its capacity rises at `time`.
    pub fn line_ends(&self, device: &Device, time: f64) -> Option<f64> {
        device.line(time - self.engaged_at).map(|[_, (end, _)]| self.engaged_at + end)
    }
}

/// Gives a command, if it is new. A command to a clutch that is already as it shall be only takes an older one back.
pub fn give(device: &Device, state: &mut State, wheel: usize, engage: bool) {
    if state.wheels[wheel].command.wanted == engage {
        return;
    }
    let mut obeys = true;
    if engage && !state.weak {
        state.engagements += 1;
        obeys = !misses(device, state.engagements);
    }
    let time = state.time;
    let wheel = &mut state.wheels[wheel];
    let open = wheel.link == Link::Open;
    wheel.command.wanted = engage;
    if device.transport {
        if obeys || !engage {
            let delay = if engage { device.engagement_delay } else { device.release_delay };
            wheel.command.send(engage, time + delay);
        }
        return;
    }
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
