//! Readings on their way from the sensor to the controller.

use super::sampling::SAME_INSTANT;

/// Most readings on their way at once. A continuous sensor that is asked more often than that within its latency delivers fewer.
pub const MOST_UNDER_WAY: usize = 32;

/// A ring of readings that are taken but cannot be read yet, and the one that can.
#[derive(Clone, Debug)]
pub(super) struct Delivery<T> {
    latency: f64,
    readable: T,
    due: [f64; MOST_UNDER_WAY],
    pending: [T; MOST_UNDER_WAY],
    oldest: usize,
    count: usize,
}

impl<T: Copy> Delivery<T> {
    /// `first` can be read from the start; others `latency` (s) after they were taken.
    pub(super) fn new(latency: f64, first: T) -> Delivery<T> {
        let (due, pending) = ([0.0; MOST_UNDER_WAY], [first; MOST_UNDER_WAY]);
        Delivery { latency, readable: first, due, pending, oldest: 0, count: 0 }
    }

    /// Whether one taken at `instant` (s) can be read at `time` (s).
    #[inline]
    pub(super) fn arrives(&self, instant: f64, time: f64) -> bool {
        instant + self.latency <= time + SAME_INSTANT
    }

    /// A reading taken at `instant` (s), not before the last one.
    #[inline]
    pub(super) fn send(&mut self, instant: f64, reading: T) {
        if self.latency <= 0.0 {
            self.readable = reading;
            return;
        }
        // Between two calls more can be taken than the ring holds.
        if self.count == MOST_UNDER_WAY {
            self.deliver(instant);
        }
        // A full ring gives up the newest: the others then still arrive in time.
        self.count = (self.count + 1).min(MOST_UNDER_WAY);
        let place = (self.oldest + self.count - 1) % MOST_UNDER_WAY;
        self.due[place] = instant + self.latency;
        self.pending[place] = reading;
    }

    /// Delivers what is due at `time` (s).
    #[inline]
    pub(super) fn deliver(&mut self, time: f64) {
        while self.count > 0 && self.due[self.oldest] <= time + SAME_INSTANT {
            self.readable = self.pending[self.oldest];
            self.oldest = (self.oldest + 1) % MOST_UNDER_WAY;
            self.count -= 1;
        }
    }

    /// The last one delivered.
    pub(super) fn readable(&self) -> T {
        self.readable
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_arrive_in_order_and_after_the_latency() {
        let mut delivery = Delivery::new(2.5e-3, 0);
        for tick in 1..1000 {
            let time = f64::from(tick) * 1e-3;
            delivery.send(time, tick);
            delivery.deliver(time);
            assert_eq!(delivery.readable(), (tick - 3).max(0));
            delivery.deliver(time + 0.5e-3);
            assert_eq!(delivery.readable(), (tick - 2).max(0));
        }
    }

    #[test]
    fn without_latency_a_reading_is_there_at_once() {
        let mut delivery = Delivery::new(0.0, 0);
        delivery.send(1.0, 7);
        assert_eq!(delivery.readable(), 7);
    }

    #[test]
    fn more_readings_than_it_holds_come_more_rarely_but_never_late_or_early() {
        let mut delivery = Delivery::new(0.1, 0);
        let mut distinct = 0;
        let mut last = 0;
        for tick in 0..10_000 {
            let time = f64::from(tick) * 1e-4;
            delivery.send(time, tick);
            delivery.deliver(time);
            let age = tick - delivery.readable();
            assert!(tick < 1100 || (1000..=1000 + 1000).contains(&age), "{tick}: {age}");
            distinct += i32::from(delivery.readable() != last);
            last = delivery.readable();
        }
        assert!(distinct > 200, "{distinct}");
    }
}
