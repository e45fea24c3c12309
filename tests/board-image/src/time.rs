//! Time of the bench: counts of 16.8 GHz, of which every clock of the chip in use takes a whole number, and one that is off nearly so.

/// Counts of a second.
pub const SECOND: u64 = 16_800_000_000;

/// Counts of so many microseconds.
pub const fn microseconds(count: u64) -> u64 {
    count * (SECOND / 1_000_000)
}

/// Counts of so many milliseconds.
pub const fn milliseconds(count: u64) -> u64 {
    count * (SECOND / 1_000)
}

/// Counts of so many seconds.
pub fn counts(seconds: f64) -> u64 {
    (seconds * SECOND as f64).round() as u64
}

/// Seconds of so many counts.
pub fn seconds(counts: u64) -> f64 {
    counts as f64 / SECOND as f64
}

/// Milliseconds of so many counts.
pub fn in_milliseconds(counts: u64) -> f64 {
    1e3 * seconds(counts)
}
