//! The slow internal oscillator as a second measure of time: TIM5, which counts time on both chips, captures every eighth of its edges.

use sprag_shared::device::clock_check::ClockCheck;

use crate::board::Edge;

/// First address of TIM5, and offsets of registers.
const TIMER: u32 = 0x4000_0C00;
const SR: u32 = 0x10;
const CCER: u32 = 0x20;

/// Of the internal oscillator by which the slow one is measured at the start, 1/s.
const INTERNAL_HZ: f32 = 16e6;

/// Looks for an edge at the start, each at least 8 cycles of 16 MHz: some 5 ms, where two edges take 1 ms at most.
const PATIENCE: u32 = 10_000;

/// How a channel captures, by offsets of registers of TIM5 and what they hold, and by bits of SR.
pub struct Channel {
    /// Its input is the slow oscillator.
    pub source: (u32, u32),
    /// Every eighth edge.
    pub mode: (u32, u32),
    /// It is on.
    pub on: u32,
    /// The register with the time of the last edge.
    pub edge: u32,
    /// An edge has come, …
    pub came: u32,
    /// … and another one before it was read.
    pub missed: u32,
}

fn register(offset: u32) -> *mut u32 {
    (TIMER + offset) as *mut u32
}

impl Channel {
    /// Captures from now on, where the timer and the oscillator run.
    pub fn begin(&self) {
        for (offset, value) in [self.source, self.mode, (CCER, self.on)] {
            // SAFETY: registers of a timer whose channels nobody else uses.
            unsafe { register(offset).write_volatile(value) };
        }
    }

    /// The last edge since it was asked for one.
    pub fn take(&self) -> Edge {
        // SAFETY: as above; reading the time clears the flag that it came, and writing 0 that one was missed.
        unsafe {
            let state = register(SR).read_volatile();
            if state & self.came == 0 {
                return Edge::None;
            }
            let at = register(self.edge).read_volatile();
            if state & self.missed == 0 {
                return Edge::At(at);
            }
            register(SR).write_volatile(!(self.came | self.missed));
            Edge::Missed
        }
    }

    /// Measures the slow oscillator while the processor still runs from the fast internal one; what the counter's clock, 1/s, will then be
    /// held against.
    #[inline(never)]
    pub fn check(&self, counter_hz: u32) -> ClockCheck {
        let mut edges = (0..PATIENCE).filter_map(|_| if let Edge::At(at) = self.take() { Some(at) } else { None });
        // The first period may have begun before the channel was on.
        let counts = match (edges.next(), edges.next()) {
            (Some(first), Some(second)) => second.wrapping_sub(first),
            _ => 0,
        };
        ClockCheck::new(counts as f32 * (counter_hz as f32 / INTERNAL_HZ))
    }
}
