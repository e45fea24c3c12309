//! Core and firmware in the emulator.

mod accuracy;
mod alone;
mod decisions;
mod emulator;
mod faults;
mod firmware;
mod lockstep;
mod restarts;
mod stability;
mod storage;
