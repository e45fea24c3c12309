//! A sequence of named steps with the time each took.

use crate::stop::Stop;
use std::time::{Duration, Instant};

/// The steps so far; prints their table when it goes, however the sequence ended.
#[derive(Debug, Default)]
pub struct Steps {
    done: Vec<(&'static str, Duration, bool)>,
}

impl Steps {
    /// Announces a step, does it and keeps its time.
    ///
    /// # Errors
    /// The errors of the step.
    pub fn step<T>(&mut self, name: &'static str, work: impl FnOnce() -> Result<T, Stop>) -> Result<T, Stop> {
        println!("\n== {name}");
        let start = Instant::now();
        let result = work();
        self.done.push((name, start.elapsed(), result.is_ok()));
        result
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        println!("\n{:<44} {:>8}", "step", "seconds");
        for (name, time, well) in &self.done {
            println!("{name:<44} {:>8.1}{}", time.as_secs_f64(), if *well { "" } else { "  failed" });
        }
        let total: Duration = self.done.iter().map(|(_, time, _)| *time).sum();
        println!("{:<44} {:>8.1}", "total", total.as_secs_f64());
    }
}
