//! Ctrl-C and termination: long work looks here, and ends without leaving anything half-written.

use std::fmt::Display;
use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};

use crate::progress::without_bar;

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

/// How long interrupted work may take to end by itself.
pub const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two looks at whether there was a signal.
const LOOK: Duration = Duration::from_millis(20);

impl Interrupt {
    /// One that Ctrl-C and termination set. Work that has not looked within [`PATIENCE`] is ended where it is, with a line that says what is
    /// kept; results are renamed into place only when whole, so even that leaves none half-written. Where signals cannot be waited for
    /// the process just ends. A terminal that is closed ends it at once, unless it was started by `nohup`.
    pub fn installed() -> Interrupt {
        let interrupt = Interrupt::default();
        let seen = interrupt.clone();
        let watch = move || {
            while !seen.is_set() {
                thread::sleep(LOOK);
            }
            thread::sleep(PATIENCE);
            if seen.reports_first() {
                // Nothing is drawn any more after the last line.
                without_bar(|| {
                    seen.write(&mut std::io::stderr());
                    crate::output::remove_empty_folders();
                    std::process::exit(seen.exit_code());
                });
            }
        };
        if thread::Builder::new().spawn(watch).is_ok() {
            for signal in [SIGINT, SIGTERM] {
                let number = usize::try_from(signal).unwrap_or(1);
                let _ = signal_hook::flag::register_usize(signal, interrupt.0.signal.clone(), number);
            }
        }
        interrupt
    }

    /// Asks to stop, as Ctrl-C does.
    pub fn set(&self) {
        self.0.signal.store(usize::try_from(SIGINT).unwrap_or(1), Ordering::Relaxed);
    }

    /// Whether to stop.
    pub fn is_set(&self) -> bool {
        self.0.signal.load(Ordering::Relaxed) != 0
    }

    /// From here on `what` would be kept of the work, and this is how to go on with it.
    pub fn keep(&self, what: impl Display) {
        *self.0.kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(what.to_string());
    }

    /// Exit code of a command that was interrupted, as shells have it: 128 and the number of the signal.
    pub fn exit_code(&self) -> i32 {
        128 + i32::try_from(self.0.signal.load(Ordering::Relaxed)).unwrap_or(0)
    }

    /// Writes to `err`, in one line and once, that the work was interrupted and what is kept of it.
    pub fn report(&self, err: &mut impl Write) {
        if self.reports_first() {
            self.write(err);
        } else {
            // The other thread is about to write it and to end the process.
            thread::sleep(5 * LOOK);
        }
    }

    fn reports_first(&self) -> bool {
        !self.0.reported.swap(true, Ordering::SeqCst)
    }

    fn write(&self, err: &mut impl Write) {
        let kept = self.0.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let _ = writeln!(err, "sprag: interrupted; {}", kept.as_deref().unwrap_or("nothing was written"));
        let _ = err.flush();
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
}
