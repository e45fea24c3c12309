//! Signs of life of long work, on standard error only: a bar on a terminal, and sparse lines where none can be drawn.

use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, LazyLock};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

use console::Term;
use indicatif::{HumanCount, MultiProgress, ProgressBar, ProgressStyle};

use crate::streams::Errors;

/// What is drawn on standard error.
static DRAWN: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Does `work` while no bar is drawn, so that whatever it writes to the terminal has lines of its own.
pub fn without_bar<R>(work: impl FnOnce() -> R) -> R {
    if DRAWN.is_hidden() { work() } else { DRAWN.suspend(work) }
}

/// Whether nothing is shown of any work.
static HIDDEN: AtomicBool = AtomicBool::new(false);

/// Shows nothing of any work that begins from here on.
pub fn hide() {
    HIDDEN.store(true, Ordering::Relaxed);
}

/// Time between two drawings of a bar, and before work of unknown length is worth one.
const REDRAW: Duration = Duration::from_millis(100);
const WORTH_A_BAR: Duration = Duration::from_millis(500);
/// Time to the first line where no bar can be drawn, and the longest between two.
const FIRST_LINE: Duration = Duration::from_secs(2);
const LONGEST_GAP: Duration = Duration::from_secs(60);
/// Columns of a bar at most, and at least.
const WIDEST: usize = 40;
const NARROWEST: usize = 8;

/// Work that shows how far it is until this is dropped.
#[derive(Debug)]
pub struct Progress {
    work: Arc<Work>,
    shown: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Of countable work that has yet to say how much it is.
    pub fn new(what: &str) -> Progress {
        Progress::shown(what, Extent::Known)
    }

    /// Of countable work whose end is not known beforehand.
    pub fn of_unknown_length(what: &str) -> Progress {
        Progress::shown(what, Extent::Unknown)
    }

    /// Of work without anything to count, such as "drawing".
    pub fn uncounted(what: &str) -> Progress {
        Progress::shown(what, Extent::Uncounted)
    }

    fn shown(what: &str, extent: Extent) -> Progress {
        let [length, done, before] = [0; 3].map(AtomicU64::new);
        let work = Arc::new(Work { what: what.to_owned(), extent, length, done, before, begun: Instant::now() });
        let (end, ended) = channel();
        let seen = work.clone();
        // Without a thread the work is done unseen.
        let show = || Builder::new().spawn(move || seen.show(&ended)).ok().map(|thread| (end, thread));
        let shown = if HIDDEN.load(Ordering::Relaxed) { None } else { show() };
        Progress { work, shown }
    }

    /// `length` more are to come.
    pub fn begin(&self, length: u64) {
        self.work.length.fetch_add(length, Ordering::Relaxed);
    }

    /// `count` were done before: they say nothing of how long the rest takes.
    pub fn resume(&self, count: u64) {
        self.work.before.fetch_add(count, Ordering::Relaxed);
        self.advance(count);
    }

    /// One is done.
    pub fn step(&self) {
        self.advance(1);
    }

    /// `count` are done.
    pub fn advance(&self, count: u64) {
        self.work.done.fetch_add(count, Ordering::Relaxed);
    }

    /// Shows nothing more, as dropping does.
    pub fn finish(self) {}
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.shown.take() {
            drop(end);
            let _ = thread.join();
        }
    }
}

/// What is known of the amount of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extent {
    Known,
    Unknown,
    Uncounted,
}

#[derive(Debug)]
struct Work {
    what: String,
    extent: Extent,
    length: AtomicU64,
    done: AtomicU64,
    before: AtomicU64,
    begun: Instant,
}

impl Work {
    /// Until the other end of `ended` is dropped.
    fn show(&self, ended: &Receiver<()>) {
        if DRAWN.is_hidden() { self.print(ended) } else { self.draw(ended) }
    }

    fn print(&self, ended: &Receiver<()>) {
        let mut gap = FIRST_LINE;
        while ended.recv_timeout(gap) == Err(RecvTimeoutError::Timeout) {
            let elapsed = self.begun.elapsed();
            let _ = writeln!(Errors::default(), "sprag: {}", self.seen().words(elapsed));
            // Twice as long after the start as the line before.
            gap = elapsed.clamp(FIRST_LINE, LONGEST_GAP);
        }
    }

    fn draw(&self, ended: &Receiver<()>) {
        if self.extent == Extent::Uncounted && ended.recv_timeout(WORTH_A_BAR) != Err(RecvTimeoutError::Timeout) {
            return;
        }
        let bar = DRAWN.add(ProgressBar::no_length());
        if let Ok(style) = ProgressStyle::with_template("{wide_msg}") {
            bar.set_style(style);
        }
        loop {
            let columns = usize::from(Term::stderr().size().1);
            bar.set_message(self.seen().line(self.begun.elapsed(), columns));
            if ended.recv_timeout(REDRAW) != Err(RecvTimeoutError::Timeout) {
                break;
            }
        }
        bar.finish_and_clear();
        DRAWN.remove(&bar);
    }

    fn seen(&self) -> Seen<'_> {
        let [length, done, before] = [&self.length, &self.done, &self.before].map(|count| count.load(Ordering::Relaxed));
        // Counts are not read at one instant.
        Seen { what: &self.what, extent: self.extent, length: length.max(done), done, before }
    }
}

/// Work as it is at one instant.
struct Seen<'a> {
    what: &'a str,
    extent: Extent,
    length: u64,
    done: u64,
    before: u64,
}

impl Seen<'_> {
    /// How far the work is after `elapsed`, in words.
    fn words(&self, elapsed: Duration) -> String {
        let Seen { what, done, length, .. } = *self;
        match self.extent {
            Extent::Known => {
                let left = self.left(elapsed).map_or_else(String::new, |left| format!(", {} left", in_words(left, 2)));
                format!("{} of {} {what}{left}", HumanCount(done), HumanCount(length))
            }
            Extent::Unknown => format!("{} {what} so far, {}", HumanCount(done), in_words(elapsed, 2)),
            Extent::Uncounted => format!("{what}, {} so far", in_words(elapsed, 2)),
        }
    }

    /// A line of fewer than `columns`, with a bar where there is room for one.
    fn line(&self, elapsed: Duration, columns: usize) -> String {
        let words = self.words(elapsed);
        // The last column is left free: some terminals begin a new line once it is written.
        let room = columns.saturating_sub(1);
        if self.extent != Extent::Known {
            return words.chars().take(room).collect();
        }
        let bar = room.saturating_sub(words.chars().count() + 1).min(WIDEST);
        let share = self.done as f64 / self.length.max(1) as f64;
        if bar >= NARROWEST {
            let full = (share * bar as f64) as usize;
            return format!("{}{} {words}", "█".repeat(full), "░".repeat(bar - full));
        }
        if words.chars().count() <= room {
            return words;
        }
        let left = self.left(elapsed).map_or_else(String::new, |left| format!(", {} left", in_words(left, 1)));
        format!("{:.0} %{left}", (100.0 * share).floor()).chars().take(room).collect()
    }

    /// How long the rest takes, if it continues as it did.
    fn left(&self, elapsed: Duration) -> Option<Duration> {
        let here = self.done.saturating_sub(self.before);
        let seconds = elapsed.as_secs_f64() * self.length.saturating_sub(self.done) as f64 / here as f64;
        Duration::try_from_secs_f64(seconds.ceil()).ok().filter(|_| here > 0)
    }
}

/// A time in the largest `units` (1 or 2) that it has.
fn in_words(time: Duration, units: usize) -> String {
    let seconds = time.as_secs();
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86_400);
    let parts = match () {
        () if days > 0 => [format!("{} d", HumanCount(days)), format!("{} h", hours % 24)],
        () if hours > 0 => [format!("{hours} h"), format!("{} min", minutes % 60)],
        () if minutes > 0 => [format!("{minutes} min"), format!("{} s", seconds % 60)],
        () => return format!("{seconds} s"),
    };
    parts[..units].join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const LARGE: Seen<'_> = Seen { what: "cells", extent: Extent::Known, length: 262_144, done: 131_072, before: 0 };

    #[test]
    fn time_left_follows_from_what_was_done_here() {
        let minute = Duration::from_secs(60);
        assert_eq!(LARGE.words(minute), "131,072 of 262,144 cells, 1 min 0 s left");
        let resumed = Seen { before: 131_072 - 65_536, ..LARGE };
        assert_eq!(resumed.left(minute), Some(2 * minute));
        // Nothing done here says nothing of the rest.
        let begun = Seen { before: 131_072, ..LARGE };
        assert_eq!((begun.left(minute), begun.words(minute)), (None, "131,072 of 262,144 cells".to_owned()));
    }

    #[test]
    fn a_line_fits_into_any_window() {
        for extent in [Extent::Known, Extent::Unknown, Extent::Uncounted] {
            for columns in 0..200 {
                let line = Seen { extent, ..LARGE }.line(Duration::from_secs(3600), columns);
                assert!(line.chars().count() < columns.max(1), "{columns}: {line}");
            }
        }
        for (seconds, ends) in
            [(25, ", 25 s left"), (824, "13 min left"), (824, "13 min 44 s left"), (7205, "2 h left"), (90_000, "1 d left")]
        {
            let columns = if ends.contains("44 s") { 60..200 } else { 20..25 };
            for columns in columns {
                let line = LARGE.line(Duration::from_secs(seconds), columns);
                assert!(line.ends_with(ends) && (line.contains("131,072") || line.contains("50 %")), "{columns}: {line}");
            }
        }
        assert!(LARGE.line(Duration::from_secs(25), 80).starts_with("████"));
    }

    #[test]
    fn work_without_an_end_in_sight_says_how_long_it_has_taken() {
        let traced = Seen { what: "blocks", extent: Extent::Unknown, ..LARGE };
        assert_eq!(traced.words(Duration::from_secs(7205)), "131,072 blocks so far, 2 h 0 min");
        let drawn = Seen { what: "drawing", extent: Extent::Uncounted, ..LARGE };
        assert_eq!(drawn.words(Duration::from_secs(12)), "drawing, 12 s so far");
    }
}
