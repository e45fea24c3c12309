//! Ctrl-C and termination: long work looks here, and ends without leaving anything half-written.

use std::fmt::Display;
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Set once the user has asked to stop.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<State>);

#[derive(Debug, Default)]
struct State {
    /// The signal that asks to stop, or 0.
    signal: Arc<AtomicUsize>,
    /// What is kept of the work, if anything is.
    kept: Mutex<Option<String>>,
    /// It has been reported.
    reported: AtomicBool,
}

/// Number of the signal by which Ctrl-C asks to stop.
const SIGINT: usize = 2;

impl Interrupt {
    /// Asks to stop, as Ctrl-C does.
    pub fn set(&self) {
        self.0.signal.store(SIGINT, Ordering::Relaxed);
    }

    /// Whether to stop.
    pub fn is_set(&self) -> bool {
        self.0.signal.load(Ordering::Relaxed) != 0
    }

    /// From here on `what` would be kept of the work, and this is how to resume it.
    pub fn keep(&self, what: impl Display) {
        *self.0.kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(what.to_string());
    }

    /// The same interrupt for a step of the work: what is kept of the step alone is not said.
    #[must_use]
    pub fn of_step(&self) -> Interrupt {
        Interrupt(Arc::new(State { signal: self.0.signal.clone(), ..State::default() }))
    }

    /// Exit code of a command that was interrupted, as shells have it: 128 and the number of the signal.
    pub fn exit_code(&self) -> i32 {
        128 + i32::try_from(self.0.signal.load(Ordering::Relaxed)).unwrap_or(0)
    }

    /// Where the number of the signal is written that asks to stop.
    pub fn signal(&self) -> &Arc<AtomicUsize> {
        &self.0.signal
    }

    /// Writes to `err`, in one line and once, that the work was interrupted and what is kept of it. Whether it was this call that wrote it.
    pub fn report(&self, err: &mut impl Write) -> bool {
        let first = !self.0.reported.swap(true, Ordering::SeqCst);
        if first {
            let kept = self.0.kept.lock().unwrap_or_else(PoisonError::into_inner);
            let _ = writeln!(err, "sprag: interrupted; {}", kept.as_deref().unwrap_or("nothing was written"));
            let _ = err.flush();
        }
        first
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_is_reported_once() {
        let interrupt = Interrupt::default();
        interrupt.set();
        interrupt.keep("3 of 9 rows are kept");
        let mut lines = Vec::new();
        interrupt.report(&mut lines);
        interrupt.report(&mut lines);
        assert_eq!(String::from_utf8(lines).unwrap(), "sprag: interrupted; 3 of 9 rows are kept\n");
        assert_eq!(interrupt.exit_code(), 130);
    }

    #[test]
    fn a_step_is_interrupted_and_says_nothing() {
        let interrupt = Interrupt::default();
        interrupt.keep("the parts are kept");
        let step = interrupt.of_step();
        step.keep("3 of 9 rows are kept");
        interrupt.set();
        assert!(step.is_set());
        let mut lines = Vec::new();
        interrupt.report(&mut lines);
        assert_eq!(String::from_utf8(lines).unwrap(), "sprag: interrupted; the parts are kept\n");
    }
}
