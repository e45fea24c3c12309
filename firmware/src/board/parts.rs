//! What boards have in common, without a type of any chip: each part is generic over the few things that a chip does in its own way.
//!
//! | part | the chip's own |
//! | --- | --- |
//! | [`bus`]: of an inertial sensor | [`bus::Frames`], a pin of `embedded-hal` |
//! | [`inertial`]: two inertial sensors and an encoder, mounted in some way | buses of `embedded-hal`, [`inertial::Counter`] |
//! | [`driver`]: two coils between two switches each | [`driver::Stage`] |
//! | [`ring`]: the link, moved without the processor | [`ring::Streams`] |
//! | [`kept_count`]: an encoder's counter that runs on through a reset | registers, as a table |
//! | [`light`] | a pin of `embedded-hal` |
//! | [`mod@crc`]: the unit for checksums | nothing |
//! | [`slow_clock`]: the slow oscillator, captured by TIM5 | a channel, as a table |

pub mod bus;
pub mod crc;
pub mod driver;
pub mod inertial;
pub mod kept_count;
pub mod light;
pub mod ring;
pub mod slow_clock;

/// As [`crate::board::Board::moves_by_itself`]: the word of the encoder's count, and those of the link's rings.
pub fn moves_by_itself(place: u32) -> bool {
    place == kept_count::COUNT.address() as u32 || ring::holds(place)
}
