//! What the firmware says about itself.

use crate::board::{Board, Selected};
use sprag_shared::device::Surroundings;
use sprag_shared::link::reset_cause::Cause;

/// Version, as in `Cargo.toml`.
pub const VERSION: [u8; 3] =
    [number(env!("CARGO_PKG_VERSION_MAJOR")), number(env!("CARGO_PKG_VERSION_MINOR")), number(env!("CARGO_PKG_VERSION_PATCH"))];

/// The commit it was built from.
const BUILD: [u8; 8] = filled(env!("SPRAG_BUILD"));

/// The board it was built for.
const BOARD: [u8; 12] = filled(Selected::NAME);

/// Of a program that started for that `cause`.
pub fn surroundings(cause: Cause) -> Surroundings {
    Surroundings {
        version: VERSION,
        build: BUILD,
        board: BOARD,
        counter_hz: Selected::COUNTER_HZ,
        least_period: Selected::LEAST_PERIOD,
        rehearsal: cfg!(feature = "board-qemu"),
        cause,
        ..Surroundings::default()
    }
}

const fn number(text: &str) -> u8 {
    let (bytes, mut number, mut k) = (text.as_bytes(), 0, 0);
    while k < bytes.len() {
        number = number * 10 + (bytes[k] - b'0');
        k += 1;
    }
    number
}

const fn filled<const N: usize>(text: &str) -> [u8; N] {
    let (bytes, mut filled, mut k) = (text.as_bytes(), [0; N], 0);
    while k < bytes.len() && k < N {
        filled[k] = bytes[k];
        k += 1;
    }
    filled
}
