//! Ctrl-C: long work looks here, and ends without leaving anything half-written.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set once the user has asked to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

/// How long interrupted work may take to end by itself.
pub const PATIENCE: std::time::Duration = std::time::Duration::from_secs(1);

/// Exit code of a command ended by Ctrl-C, as shells have it.
pub const EXIT_CODE: i32 = 130;

impl Interrupt {
    /// One that Ctrl-C and termination set. Work that has not looked within [`PATIENCE`] is ended where it is; results
    /// are renamed into place only when whole, so even that leaves none half-written. Where the handler cannot be
    /// installed the process just ends.
    pub fn installed() -> Interrupt {
        let interrupt = Interrupt::default();
        let flag = interrupt.clone();
        let _ = ctrlc::set_handler(move || {
            flag.set();
            std::thread::sleep(PATIENCE);
            std::process::exit(EXIT_CODE);
        });
        interrupt
    }

    /// Asks to stop.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether to stop.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
