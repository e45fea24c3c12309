//! Queue of commands under a transport delay.

use crate::math::scalar::Real;

/// Capacity of the queue. Within 50 ms a clutch gets one or two.
pub const MOST_UNDER_WAY: usize = 8;

/// Queue of commands in order, each with its wait after the one before it. In a full queue a new one takes back the newest if that is of
/// the other kind, as with an inertial delay; one of the same kind changes nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnderWay<S> {
    waits: [S; MOST_UNDER_WAY],
    engages: [bool; MOST_UNDER_WAY],
    count: usize,
}

impl<S: Real> UnderWay<S> {
    /// Sends a command that arrives `delay` (s) after now, but not before those sent earlier, of which the first arrives after
    /// `first` (s). Gives what is left until the first arrives; negative if none is under way any more.
    pub fn send(&mut self, engage: bool, delay: S, first: S) -> S {
        let newest = self.count.saturating_sub(1);
        if self.count == MOST_UNDER_WAY {
            let takes_back = self.engages.get(newest).is_some_and(|known| *known != engage);
            self.count = if takes_back { newest } else { self.count };
            return first;
        }
        let before = self.waits.iter().take(self.count).skip(1).fold(first, |sum, &wait| sum + wait);
        let empty = self.count == 0;
        if let (Some(wait), Some(kind)) = (self.waits.get_mut(self.count), self.engages.get_mut(self.count)) {
            *wait = if empty { delay } else { (delay - before).larger(S::ZERO) };
            *kind = engage;
            self.count += 1;
        }
        if empty { delay } else { first }
    }

    /// Whether the first is one to engage.
    pub fn first(&self) -> bool {
        self.engages[0]
    }

    /// The first has arrived, and the clutch does not move again within `dwell` (s). Gives what is left until the next one arrives;
    /// negative if there is none.
    pub fn arrived(&mut self, dwell: S) -> S {
        self.count = self.count.saturating_sub(1);
        self.waits.rotate_left(1);
        self.engages.rotate_left(1);
        if self.count == 0 {
            return -S::ONE;
        }
        // Later ones arrive when they would have, as far as the dwell of this one lets them.
        let next = self.waits[0].larger(dwell);
        let mut late = next - self.waits[0];
        self.waits[0] = next;
        for wait in self.waits.iter_mut().take(self.count).skip(1) {
            let caught_up = wait.smaller(late);
            (*wait, late) = (*wait - caught_up, late - caught_up);
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When each arrives, all sent now with these delays.
    fn arrivals(delays: &[(bool, f64)], dwell: f64) -> std::vec::Vec<(bool, f64)> {
        let (mut under_way, mut left, mut now) = (UnderWay::default(), -1.0, 0.0);
        for &(engage, delay) in delays {
            left = under_way.send(engage, delay, left);
        }
        let mut found = std::vec::Vec::new();
        while left >= 0.0 {
            now += left;
            found.push((under_way.first(), now));
            left = under_way.arrived(dwell);
        }
        found
    }

    #[test]
    fn commands_arrive_in_order() {
        let sent = [(true, 0.5), (false, 0.25), (true, 0.75)];
        assert_eq!(arrivals(&sent, 0.0), [(true, 0.5), (false, 0.5), (true, 0.75)]);
        // A dwell holds one back, and the next is on time again.
        let sent = [(true, 0.25), (false, 0.5), (true, 2.0)];
        assert_eq!(arrivals(&sent, 0.5), [(true, 0.25), (false, 0.75), (true, 2.0)]);
    }

    #[test]
    fn a_command_too_many_takes_back_the_newest() {
        let sent: std::vec::Vec<_> = (0..11).map(|i| (i % 2 == 0, f64::from(i))).collect();
        let expected: std::vec::Vec<_> = (0..8).map(|i| (i % 2 == 0, f64::from(i))).collect();
        // The ninth takes back the eighth, the tenth takes its place, the eleventh takes that back again.
        assert_eq!(arrivals(&sent, 0.0), expected[..7]);
        assert_eq!(arrivals(&sent[..8], 0.0), expected);
    }
}
