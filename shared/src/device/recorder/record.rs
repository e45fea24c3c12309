//! One control tick in eight bytes: three signed numbers of 16 bits and a word of flags, least significant byte first.

use crate::control::controller::Decision;
use crate::control::monitor::fault::Fault;
use crate::control::supervisor::Phase;

/// Bytes of a record.
pub const RECORD_BYTES: usize = 8;

/// Step of θ, rad: ±1 rad.
pub const ROTATION_STEP: f32 = 1.0 / 32_768.0;

/// Step of θ̇, rad/s: ±4 rad/s.
pub const VELOCITY_STEP: f32 = 1.0 / 8192.0;

/// Step of the ground's acceleration, g: ±4 g.
pub const GROUND_STEP: f32 = 1.0 / 8192.0;

/// A tick as it is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Estimated θ, rad, to within [`ROTATION_STEP`].
    pub rotation: f32,
    /// Estimated θ̇, rad/s, to within [`VELOCITY_STEP`].
    pub velocity: f32,
    /// Horizontal acceleration of the ground, g, to within [`GROUND_STEP`].
    pub ground: f32,
    /// Clutches that were commanded to engage.
    pub command: [bool; 2],
    /// Clutches that said that they were engaged.
    pub engaged: [bool; 2],
    /// Phase of the controller.
    pub phase: Phase,
    /// The block stood on both toes.
    pub standing: bool,
    /// [`Fault::code`], if there was one.
    pub fault: Option<u16>,
}

/// Cut towards 0, and at the ends of the range: no number is further off than one step, but those beyond the range. What is no number is 0.
#[inline]
fn scaled(value: f32, step: f32) -> u32 {
    let steps = (value * (1.0 / step)) as i32;
    u32::from(steps.clamp(i16::MIN.into(), i16::MAX.into()) as i16 as u16)
}

/// The words of a record. Bit 31 of the second is never set, so no record reads as blank flash.
#[inline]
pub fn pack(decision: &Decision, engaged: [bool; 2]) -> [u32; 2] {
    let Decision { command, estimate, phase, fault, .. } = decision;
    let pair = |[first, second]: [bool; 2]| u32::from(first) | u32::from(second) << 1;
    let code = fault.map_or(0, |fault| u32::from(fault.code()) & 0x7F);
    let flags = pair(*command) | pair(engaged) << 2 | (*phase as u32) << 4 | u32::from(estimate.standing) << 7 | code << 8;
    let [ground, _] = estimate.ground;
    [
        scaled(estimate.rotation, ROTATION_STEP) | scaled(estimate.velocity, VELOCITY_STEP) << 16,
        scaled(ground, GROUND_STEP) | flags << 16,
    ]
}

impl Moment {
    /// What the words of a record say; `None` for words that are none.
    pub fn of([motion, rest]: [u32; 2]) -> Option<Moment> {
        let number = |bits: u32, step: f32| f32::from(bits as u16 as i16) * step;
        let flags = rest >> 16;
        let pair = |shift: u32| [flags >> shift & 1 != 0, flags >> (shift + 1) & 1 != 0];
        let code = (flags >> 8) as u16;
        let fault = if code == 0 { None } else { Some(Fault::from_code(code)?.code()) };
        Some(Moment {
            rotation: number(motion, ROTATION_STEP),
            velocity: number(motion >> 16, VELOCITY_STEP),
            ground: number(rest, GROUND_STEP),
            command: pair(0),
            engaged: pair(2),
            phase: *Phase::ALL.get((flags >> 4 & 7) as usize)?,
            standing: flags >> 7 & 1 != 0,
            fault,
        })
    }
}
