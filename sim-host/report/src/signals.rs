//! Ctrl-C and termination of a command.

use std::io::Write;
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGINT, SIGTERM};
use sprag_sim::interrupt::Interrupt;

use crate::output::{remove_empty_folders, remove_unfinished};
use crate::progress::without_bar;

/// How long interrupted work may take to end by itself.
pub const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two looks at whether there was a signal.
const LOOK: Duration = Duration::from_millis(20);

/// An interrupt that Ctrl-C and termination set. Work that has not looked within [`PATIENCE`] is ended where it is, with a line that says what is
/// kept; results are renamed into place only when whole, so even that leaves none half-written. Where signals cannot be waited for
/// the process just ends. A terminal that is closed ends it at once, unless it was started by `nohup`.
pub fn interrupt() -> Interrupt {
    let interrupt = Interrupt::default();
    let seen = interrupt.clone();
    let watch = move || {
        while !seen.is_set() {
            thread::sleep(LOOK);
        }
        thread::sleep(PATIENCE);
        // Nothing is drawn any more after the last line.
        without_bar(|| {
            if seen.report(&mut std::io::stderr()) {
                remove_unfinished();
                remove_empty_folders();
                std::process::exit(seen.exit_code());
            }
        });
    };
    if thread::Builder::new().spawn(watch).is_ok() {
        for signal in [SIGINT, SIGTERM] {
            let number = usize::try_from(signal).unwrap_or(1);
            let _ = signal_hook::flag::register_usize(signal, interrupt.signal().clone(), number);
        }
    }
    interrupt
}

/// Writes to `err`, in one line and once, that the work was interrupted and what is kept of it.
pub fn report(interrupt: &Interrupt, err: &mut impl Write) {
    if !interrupt.report(err) {
        // The other thread is about to write it and to end the process.
        thread::sleep(5 * LOOK);
    }
}
