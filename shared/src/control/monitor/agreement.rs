//! Two witnesses of one motion: the gyroscope's rate and the encoder's count over sliding windows.

/// Slots of a window, which moves on by one of them at a time.
pub(super) const SLOTS: u32 = 8;

/// When gyroscope and encoder disagree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AgreementLimits {
    /// s.
    pub period: f32,
    /// Ticks of a slot of the fast and of the slow window.
    pub slots: [u32; 2],
    /// Counts by which they may differ whatever the motion.
    pub counts: f32,
    /// Share of the movement by which they may differ.
    pub share: f32,
    /// s, by which one may be later than the other.
    pub delay: f32,
}

/// Kind of disagreement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Disagreement {
    /// The gyroscope turns and the count stays.
    Standing,
    /// Both move, but not alike, and the gyroscope more.
    GyroscopeAhead,
    /// Both move, but not alike, and the encoder more.
    EncoderAhead,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Slot {
    /// Counts by the gyroscope and the lever.
    expected: f32,
    /// Largest size of their rate, counts/s.
    peak: f32,
    /// Change of the count, and how far it went to and fro, up to [`FARTHEST`].
    counts: i32,
    travel: u32,
}

/// So far that the sum of all slots is within a u32.
const FARTHEST: u32 = u32::MAX / (2 * SLOTS);

impl Slot {
    #[inline]
    fn add(&mut self, news: Slot) {
        self.expected += news.expected;
        if news.peak > self.peak {
            self.peak = news.peak;
        }
        if news.travel > 0 {
            self.counts = self.counts.wrapping_add(news.counts);
            let travel = self.travel + news.travel;
            self.travel = if travel > FARTHEST { FARTHEST } else { travel };
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Window {
    /// In a ring.
    slots: [Slot; SLOTS as usize],
    /// What each expects, twice over, so that they can be read in a row from any of them.
    expected: [f32; 2 * SLOTS as usize],
    /// Which of them is the newest.
    newest: usize,
    /// Sums over the slots; whole numbers, so that nothing is lost when they are kept up.
    counts: i32,
    travel: u32,
    open: Slot,
    ticks: u32,
    found: Option<Disagreement>,
}

impl Window {
    /// One tick of a window with slots of several.
    #[inline]
    fn gather(&mut self, limits: &AgreementLimits, rate_tolerance: f32, length: u32, news: Slot) {
        self.open.add(news);
        self.ticks += 1;
        if self.ticks >= length {
            self.close_open(limits, rate_tolerance, length);
        }
    }

    #[inline(never)]
    fn close_open(&mut self, limits: &AgreementLimits, rate_tolerance: f32, length: u32) {
        self.ticks = 0;
        let closed = core::mem::take(&mut self.open);
        self.close(limits, rate_tolerance, length, closed);
    }

    /// Moves on by a slot.
    #[inline(always)]
    fn close(&mut self, limits: &AgreementLimits, rate_tolerance: f32, length: u32, closed: Slot) {
        self.newest = (self.newest + 1) & LAST;
        let slot = &mut self.slots[self.newest & LAST];
        self.counts = self.counts.wrapping_add(closed.counts).wrapping_sub(slot.counts);
        self.travel = (self.travel + closed.travel).wrapping_sub(slot.travel);
        *slot = closed;
        self.expected[self.newest & LAST] = closed.expected;
        self.expected[(self.newest & LAST) + SLOTS as usize] = closed.expected;
        self.found = limits.judge(self, rate_tolerance, length);
    }

    /// From the oldest to the newest.
    #[inline]
    fn oldest_first(&self) -> impl Iterator<Item = &Slot> {
        (1..=SLOTS as usize).map(|age| &self.slots[(self.newest + age) & LAST])
    }
}

const LAST: usize = SLOTS as usize - 1;
const _: () = assert!(SLOTS.is_power_of_two());

impl AgreementLimits {
    /// What a window with slots of `length` ticks shows; the gyroscope is known to `rate_tolerance` (counts/s), which is
    /// infinite where nothing is to be judged.
    #[inline(always)]
    fn judge(&self, window: &Window, rate_tolerance: f32, length: u32) -> Option<Disagreement> {
        let first = (window.newest & LAST) + 1;
        let in_a_row = window.expected.get(first..first + SLOTS as usize).unwrap_or_default();
        let expected = in_a_row.iter().copied().reduce(|sum, slot| sum + slot).unwrap_or(0.0);
        let counted = window.counts as f32;
        if (expected - counted).abs() <= self.counts {
            return None;
        }
        self.judge_apart(window, rate_tolerance, length, expected, counted)
    }

    /// The same where the two differ by more than [`AgreementLimits::counts`].
    #[inline(never)]
    fn judge_apart(
        &self,
        window: &Window,
        rate_tolerance: f32,
        length: u32,
        expected: f32,
        counted: f32,
    ) -> Option<Disagreement> {
        let duration = self.period * SLOTS as f32 * length as f32;
        let (ahead, off) = (expected.abs() > counted.abs(), (expected - counted).abs());
        // Where nothing at all is counted it is no matter of the lever.
        let share = if window.travel == 0 { 0.0 } else { self.share * if ahead { expected.abs() } else { counted.abs() } };
        // A reading that is late by a delay lacks what moved meanwhile. This is what lets an impact and a single bad reading pass.
        let allowed = |peak: f32| self.counts + rate_tolerance * duration + self.delay * peak + share;
        // Most of the time nobody needs to know the peak.
        if off <= allowed(0.0) {
            return None;
        }
        let peak = window.slots.iter().fold(0.0, |peak, slot| if slot.peak > peak { slot.peak } else { peak });
        // A count that has just begun to stay shows in the newer half only.
        let stays = || window.oldest_first().skip(SLOTS as usize / 2).all(|slot| slot.travel == 0);
        if off <= allowed(peak) {
            None
        } else if ahead && stays() {
            Some(Disagreement::Standing)
        } else if ahead {
            Some(Disagreement::GyroscopeAhead)
        } else {
            Some(Disagreement::EncoderAhead)
        }
    }
}

/// What both said lately.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Agreement {
    windows: [Window; 2],
    counts: Option<i32>,
}

impl Agreement {
    /// One tick of `rate` (rad/s, finite, less its bias), known to `rate_tolerance`, and `counts`, with so many counts per rad of the block
    /// now as `scale` says; 0 for no comparison.
    #[inline(always)]
    pub fn step(&mut self, limits: &AgreementLimits, rate_tolerance: f32, rate: f32, scale: f32, counts: i32) {
        let change = counts.wrapping_sub(self.counts.unwrap_or(counts));
        self.counts = Some(counts);
        let speed = scale * rate;
        // What cannot be compared must not look like a difference, now or later.
        let compared = if scale == 0.0 { 0 } else { change };
        let travel = change.unsigned_abs().min(FARTHEST);
        let news = Slot { expected: speed * limits.period, peak: speed.abs(), counts: compared, travel };
        // What is left of a known lever in the windows has had its own tolerance, which nobody knows any more.
        let rate_tolerance = if scale == 0.0 { f32::INFINITY } else { rate_tolerance * scale.abs() };
        let ([fast, slow], [fast_length, slow_length]) = (&mut self.windows, limits.slots);
        // Nothing needs to be gathered where a slot is a tick.
        if fast_length <= 1 {
            fast.close(limits, rate_tolerance, fast_length, news);
        } else {
            fast.gather(limits, rate_tolerance, fast_length, news);
        }
        slow.gather(limits, rate_tolerance, slow_length, news);
    }

    /// What was found when a window last moved on.
    pub fn found(&self) -> Option<Disagreement> {
        let [fast, slow] = &self.windows;
        fast.found.or(slow.found)
    }

    /// By how many counts the encoder has moved within the fast window.
    pub fn travel(&self) -> u32 {
        let [fast, _] = &self.windows;
        fast.travel + fast.open.travel
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: AgreementLimits = AgreementLimits { period: 0.0005, slots: [1, 16], counts: 4.0, share: 0.25, delay: 0.002 };

    /// Counts per rad of the block.
    const SCALE: f32 = 1e5;

    /// Ticks until they disagree, and how.
    fn found(rate: impl Fn(u32) -> f32, counts: impl Fn(u32) -> i32) -> Option<(u32, Disagreement)> {
        let mut agreement = Agreement::default();
        (0..2000).find_map(|tick| {
            agreement.step(&LIMITS, 0.02, rate(tick), SCALE, counts(tick));
            agreement.found().map(|found| (tick, found))
        })
    }

    fn travelled(rate: f32, tick: u32) -> i32 {
        (rate * 0.0005 * SCALE * tick as f32) as i32
    }

    #[test]
    fn they_agree_across_a_wrap_at_any_rate() {
        for rate in [0.0, 0.03, 0.5, -2.0, 8.0] {
            for start in [0, i32::MAX - 7, i32::MIN + 3] {
                assert_eq!(found(|_| rate, |tick| start.wrapping_add(travelled(rate, tick))), None, "{rate}");
                // As well where the lever differs by a fifth and the encoder is read every other tick.
                let coarse = |tick: u32| start.wrapping_add(travelled(1.2 * rate, tick / 2 * 2));
                assert_eq!(found(|_| rate + 0.01, coarse), None, "{rate}");
            }
        }
    }

    #[test]
    fn an_impact_and_a_single_bad_reading_pass() {
        let before =
            |tick: u32| if tick < 1000 { travelled(1.0, tick) } else { travelled(1.0, 1000) + travelled(0.8, tick - 1000) };
        assert_eq!(found(|tick| if tick < 1003 { 1.0 } else { 0.8 }, before), None);
        assert_eq!(found(|tick| if tick == 1000 || tick == 1001 { 30.0 } else { 0.5 }, |tick| travelled(0.5, tick)), None);
    }

    #[test]
    fn a_count_that_stays_is_found_in_a_window() {
        let (tick, how) = found(|_| 0.3, |tick| travelled(0.3, tick.min(1000))).unwrap();
        assert_eq!(how, Disagreement::Standing);
        assert!(tick <= 1009, "{tick}");
        // Slower than the fast window can see.
        let (tick, how) = found(|_| 0.04, |tick| travelled(0.04, tick.min(1000))).unwrap();
        assert_eq!(how, Disagreement::Standing);
        assert!((1009..1000 + 144 + 16).contains(&tick), "{tick}");
    }

    #[test]
    fn a_wrong_rate_is_found_in_a_window() {
        let (tick, how) = found(|tick| if tick < 1000 { 0.3 } else { 3.0 }, |tick| travelled(0.3, tick)).unwrap();
        assert_eq!(how, Disagreement::GyroscopeAhead);
        assert!(tick <= 1009, "{tick}");
        let (tick, how) = found(|tick| if tick < 1000 { 0.6 } else { 0.0 }, |tick| travelled(0.6, tick)).unwrap();
        assert_eq!(how, Disagreement::EncoderAhead);
        assert!(tick <= 1009, "{tick}");
        // A count that jumps is wrong at once.
        let jump = |tick: u32| travelled(0.3, tick) + if tick < 1000 { 0 } else { 5000 };
        assert_eq!(found(|_| 0.3, jump), Some((1000, Disagreement::EncoderAhead)));
    }

    #[test]
    fn without_counts_to_a_radian_nothing_is_compared() {
        let mut agreement = Agreement::default();
        for tick in 0..2000 {
            agreement.step(&LIMITS, 0.02, 0.0, 0.0, 1000 * tick);
            assert_eq!(agreement.found(), None);
        }
        // Nor is what has moved until then held against what comes when they are known.
        for _ in 0..2000 {
            agreement.step(&LIMITS, 0.02, 0.0, SCALE, 1_999_000);
            assert_eq!(agreement.found(), None);
        }
    }

    /// A bias within what is allowed goes on turning beside a count that stays, as of a block that lifts off before it is calibrated.
    #[test]
    fn what_was_allowed_by_a_lever_is_no_difference_once_it_is_unknown() {
        let mut agreement = Agreement::default();
        for tick in 0..4000_u32 {
            let known = tick < 1000 || (tick >= 1500 && tick % 7 != 0);
            agreement.step(&LIMITS, 0.02, 0.018, if known { SCALE } else { 0.0 }, 0);
            assert_eq!(agreement.found(), None, "{tick}");
        }
        // One beyond it is found again.
        let found = (0..200).any(|_| {
            agreement.step(&LIMITS, 0.02, 0.06, SCALE, 0);
            agreement.found() == Some(Disagreement::Standing)
        });
        assert!(found);
    }

    /// A rack whose lever grows to eight times itself within a second, as that of a low tying point does; and one that does not, though it
    /// should.
    #[test]
    fn the_lever_may_change_as_the_geometry_says_and_not_otherwise() {
        let lever = |tick: u32| SCALE * (0.25 + 0.000_875 * tick as f32);
        let rack = |tick: u32| (0..tick).map(|k| 0.0005 * f64::from(lever(k))).sum::<f64>() as i32;
        let (mut right, mut wrong) = (Agreement::default(), Agreement::default());
        let mut found = false;
        for tick in 0..2000 {
            right.step(&LIMITS, 0.02, 1.0, lever(tick), rack(tick));
            assert_eq!(right.found(), None, "{tick}");
            wrong.step(&LIMITS, 0.02, 1.0, SCALE, rack(tick));
            found |= wrong.found().is_some();
        }
        assert!(found);
    }

    #[test]
    fn travel_is_that_of_the_fast_window() {
        let mut agreement = Agreement::default();
        for (tick, expected) in [0, 1, 2, 2, 2, 2, 2, 2, 2, 1, 0].into_iter().enumerate() {
            agreement.step(&LIMITS, 0.02, 0.0, SCALE, [0, 1, 0][tick.min(2)]);
            assert_eq!(agreement.travel(), expected, "{tick}");
        }
    }
}
