//! A progress bar for long work, on a terminal only.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of runs, or nothing where errors do not go to a terminal.
#[derive(Clone, Debug)]
pub struct Progress(ProgressBar);

impl Progress {
    /// Of work that has yet to say how long it is.
    pub fn new(what: &str) -> Progress {
        if !std::io::stderr().is_terminal() {
            return Progress(ProgressBar::hidden());
        }
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template(&format!("{{bar:40}} {{pos}}/{{len}} {what}, {{eta}} left")) {
            bar.set_style(style);
        }
        Progress(bar)
    }

    /// `length` more runs are to come.
    pub fn begin(&self, length: u64) {
        self.0.inc_length(length);
    }

    /// `count` were done before: they tell nothing of how long the rest takes.
    pub fn resume(&self, count: u64) {
        self.0.inc(count);
        self.0.reset_eta();
    }

    /// One is done.
    pub fn step(&self) {
        self.advance(1);
    }

    /// `count` are done.
    pub fn advance(&self, count: u64) {
        self.0.inc(count);
    }

    /// The bar goes away.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
