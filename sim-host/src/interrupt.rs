//! Ctrl-C: long work looks here, and ends without leaving anything half-written.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Set once the user has asked to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<AtomicBool>);

/// Exit code of a command ended by Ctrl-C, as shells have it.
pub const EXIT_CODE: i32 = 130;

impl Interrupt {
    /// One that Ctrl-C and termination set. Where the handler cannot be installed the process just ends on them.
    pub fn installed() -> Interrupt {
        let interrupt = Interrupt::default();
        let flag = interrupt.clone();
        let _ = ctrlc::set_handler(move || flag.set());
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
