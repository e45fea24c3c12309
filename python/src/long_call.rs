//! Work without the interpreter's lock, stopped by Ctrl-C.

use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

use pyo3::prelude::*;
use sprag_report::progress;
use sprag_sim::interrupt::Interrupt;

/// Time between two looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(50);

/// Whether the work has ended, as reported to the thread that waits for it.
#[derive(Default)]
struct Ended(Mutex<bool>, Condvar);

impl Ended {
    /// Waits for the end or for [`LOOK`]; whether it has ended.
    fn wait(&self) -> bool {
        let ended = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        *self.1.wait_timeout_while(ended, LOOK, |ended| !*ended).unwrap_or_else(PoisonError::into_inner).0
    }
}

/// Reports the end of the work when it goes, however that ended.
struct Guard<'a>(&'a Ended);

impl Drop for Guard<'_> {
    fn drop(&mut self) {
        *self.0.0.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.0.1.notify_one();
    }
}

/// Does `work` on a thread of its own while other threads of Python run. Ctrl-C sets its interrupt, and is raised when it has ended.
///
/// # Errors
/// What a signal raises.
pub fn long_call<T: Send>(py: Python<'_>, work: impl FnOnce(&Interrupt) -> T + Send) -> PyResult<T> {
    progress::hide();
    let (interrupt, ended) = (Interrupt::default(), Ended::default());
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| {
            let _guard = Guard(&ended);
            work(&interrupt)
        });
        let mut asked = Ok(());
        while !py.detach(|| ended.wait()) {
            if asked.is_ok() {
                asked = py.check_signals();
                if asked.is_err() {
                    interrupt.set();
                }
            }
        }
        let result = py.detach(|| worker.join());
        asked?;
        result.map_err(|panic| std::panic::resume_unwind(panic))
    })
}
