//! The core and the controller in the emulator: one program, two worlds. Built for the STM32F405 it is a `no_std` program that talks to its
//! host through semihosting; built for the host it is an ordinary program that prints the same lines.
//!
//! Given the path of a case file it runs the case; without one it checks itself.
//! Exit codes: 0 done, 1 the self check failed, 2 bad case, 101 panic or fault.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod case;
mod case_file;
mod failure;
mod instruction_counter;
mod kernels;
mod self_check;
mod watcher;

#[cfg_attr(target_os = "none", path = "board.rs")]
#[cfg_attr(not(target_os = "none"), path = "host.rs")]
mod world;

// The board's entry point is a symbol that the reset vector names.
#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    world::main()
}
