//! Devices with a memory, against the second program (`tests/reference`).

mod error_estimates_of_devices;
mod second_program;
