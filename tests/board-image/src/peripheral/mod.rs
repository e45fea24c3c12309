//! The parts of the STM32F405, by RM0090 rev. 21, those of the STM32G474 where they differ, by RM0440, and those of the board that are
//! connected to them.

pub mod backup;
pub mod capture;
pub mod coil;
pub mod comparators;
pub mod converter;
pub mod copier;
pub mod counter;
pub mod crc;
pub mod encoder;

pub mod flash;
pub mod icm42688;
pub mod line;
pub mod modulation;
pub mod port;
pub mod processor;
pub mod rcc;
pub mod registers;
pub mod spi;
pub mod supply;
pub mod watchdog;
