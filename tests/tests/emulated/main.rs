//! Core and firmware in the emulator.

mod accuracy;
mod alone;
mod decisions;
mod emulator;
mod faults;
mod firmware;
mod lockstep;
mod recordings;
mod restarts;
mod stability;
mod storage;
