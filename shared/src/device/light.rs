//! What the status light shows.
//!
//! | phase | pattern |
//! | --- | --- |
//! | Boot, SelfTest | one short flash a second |
//! | Calibrate | two short flashes a second |
//! | Armed | steady |
//! | Rocking | five flashes a second |
//! | attached to a host, whatever its phase | three short flashes a second |
//! | Fault | so many blinks as the tens digit of the code, a pause, as the ones digit, a long pause; a digit 0 is one long blink |

use crate::control::supervisor::Phase;

/// Time is counted in slots of 50 ms, so many a second: whole numbers, because seconds in f32 no longer distinguish two slots after ten days.
const SLOTS_PER_SECOND: u32 = 20;

/// Slots of a short flash.
const FLASH: u32 = 2;
/// Slots of a blink of a code, …
const BLINK: u32 = 5;
/// … and of the dark after it.
const DARK: u32 = 6;
/// Slots of the blink that means 0.
const LONG_BLINK: u32 = 20;
/// Slots of dark between the digits, and …
const PAUSE: u32 = 20;
/// … before the code begins anew.
const LONG_PAUSE: u32 = 50;

/// For how long, s, the light flickers after a start without the crystal.
const FLICKER: u32 = 3;

/// Condition that the light shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Phase of the controller.
    pub phase: Phase,
    /// Code of its fault, if there is one.
    pub fault: Option<u16>,
    /// A host says what the sensors read: the structure is not protected.
    pub attached: bool,
}

/// Ticks of a slot where a tick lasts `period` s; at least 1.
pub fn slot_ticks(period: f32) -> u32 {
    ((1.0 / (SLOTS_PER_SECOND as f32 * period) + 0.5) as u32).max(1)
}

/// Whether the light is lit in a slot.
pub fn lit(shown: Shown, slot: u32) -> bool {
    let in_second = slot % SLOTS_PER_SECOND;
    match shown.phase {
        _ if shown.attached => in_second < 6 * FLASH && in_second % (2 * FLASH) < FLASH,
        Phase::Boot | Phase::SelfTest => in_second < FLASH,
        Phase::Calibrate => in_second < FLASH || (2 * FLASH..3 * FLASH).contains(&in_second),
        Phase::Armed => true,
        Phase::Rocking => slot % (2 * FLASH) < FLASH,
        Phase::Fault => code_lit(shown.fault.unwrap_or(0), slot),
    }
}

/// As [`lit`], for a controller that runs without its crystal: flickers for the first seconds, ten times a second.
pub fn lit_without_crystal(shown: Shown, slot: u32) -> bool {
    if slot < FLICKER * SLOTS_PER_SECOND { slot.is_multiple_of(2) } else { lit(shown, slot) }
}

/// Slots of a digit, with the dark after its last blink.
fn digit_slots(digit: u32) -> u32 {
    if digit == 0 { LONG_BLINK + DARK } else { digit * (BLINK + DARK) }
}

fn digit_lit(digit: u32, slot: u32) -> bool {
    slot < digit_slots(digit) && if digit == 0 { slot < LONG_BLINK } else { slot % (BLINK + DARK) < BLINK }
}

fn code_lit(code: u16, slot: u32) -> bool {
    let (tens, ones) = (u32::from(code) / 10 % 10, u32::from(code) % 10);
    let second = digit_slots(tens) + PAUSE;
    let slot = slot % (second + digit_slots(ones) + LONG_PAUSE);
    if slot < second { digit_lit(tens, slot) } else { digit_lit(ones, slot - second) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::String;

    /// A letter a slot.
    fn pattern(shown: Shown, slots: usize) -> String {
        (0..slots as u32).map(|slot| if lit(shown, slot) { '#' } else { '.' }).collect()
    }

    fn shown(phase: Phase, fault: Option<u16>, slots: usize) -> String {
        pattern(Shown { phase, fault, attached: false }, slots)
    }

    #[test]
    fn attached_is_three_flashes_a_second_in_every_phase() {
        for phase in Phase::ALL {
            let shown = Shown { phase, fault: Some(11), attached: true };
            assert_eq!(pattern(shown, 40), "##..##..##..........".repeat(2), "{phase:?}");
        }
    }

    #[test]
    fn waiting_flashes_once_and_calibrating_twice_a_second() {
        let second = "##..................";
        assert_eq!(shown(Phase::Boot, None, 40), second.repeat(2));
        assert_eq!(shown(Phase::SelfTest, None, 40), second.repeat(2));
        assert_eq!(shown(Phase::Calibrate, None, 40), "##..##..............".repeat(2));
    }

    #[test]
    fn armed_is_steady_and_rocking_is_five_hertz() {
        assert_eq!(shown(Phase::Armed, None, 40), "#".repeat(40));
        assert_eq!(shown(Phase::Rocking, None, 20), "##..".repeat(5));
    }

    #[test]
    fn a_fault_is_two_digits() {
        let expected = ["#####......".repeat(2), ".".repeat(20), "#####......".into(), ".".repeat(50)].concat();
        assert_eq!(shown(Phase::Fault, Some(21), 2 * expected.len()), expected.repeat(2));
    }

    #[test]
    fn a_zero_is_one_long_blink_and_no_code_is_two() {
        let zero = ["#".repeat(20), ".".repeat(6)].concat();
        let expected = [zero.clone(), ".".repeat(20), zero, ".".repeat(50)].concat();
        assert_eq!(shown(Phase::Fault, None, expected.len()), expected);
        assert_eq!(shown(Phase::Fault, Some(0), expected.len()), expected);
    }

    #[test]
    fn without_the_crystal_it_flickers_first() {
        let armed = Shown { phase: Phase::Armed, fault: None, attached: false };
        let flicker: String = (0..64).map(|slot| if lit_without_crystal(armed, slot) { '#' } else { '.' }).collect();
        assert_eq!(flicker, ["#.".repeat(30), "####".into()].concat());
    }

    #[test]
    fn any_time_and_any_code_is_shown() {
        for slot in [0, 1 << 24, u32::MAX] {
            for fault in [None, Some(99), Some(u16::MAX)] {
                lit(Shown { phase: Phase::Fault, fault, attached: false }, slot);
            }
        }
    }

    #[test]
    fn a_slot_is_50_ms_at_every_rate_of_ticks() {
        for (period, ticks) in [(0.0005, 100), (1e-5, 5000), (0.01, 5), (0.001, 50), (0.1, 1), (f32::NAN, 1)] {
            assert_eq!(slot_ticks(period), ticks, "{period} s");
        }
    }
}
