//! A coil with its two switches: how they are driven, tick by tick, and whether the current is what that makes.
//!
//! A current must flow only while both switches are on. In a test each pulse begins with the high side alone, then the low side alone, so
//! that a switch that has failed closed is found while the other one still guards; then both for the pull-in, whose current is the
//! supply over the resistance, U/R; then the hold, whose current is its share of that. A switch that has failed open, a broken coil and a
//! shorted one show in the last two. A coil that has just been released first waits with both sides off until its own current has died,
//! which the high side alone would keep flowing. Over-current is watched at every tick, and cuts the coil off by itself until the next test.

use super::coil::{FULL_SCALE, Feedback, PeakHold};
use super::pull_in::Dip;
use crate::control::monitor::coil::{CURRENT_TOLERANCE, CoilReading, CoilReport, CoilTrouble};
use crate::settings::wiring::Wiring;

/// Share of the full current, or of the threshold where that is not known, above which a current flows.
const FLOWS: f32 = 0.1;

/// Current over the full one that no whole coil takes: +10 % of supply and a coil at −20 °C make 1.3.
const OVER: f32 = 1.5;

/// Share of the full current above which a coil that shall hold does not, where it shall hold by less.
const CLOSED: f32 = 0.8;

/// Pull-in times after which the current has fallen to the holding one.
const SETTLING: u32 = 2;

/// Coil of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoilDesign {
    /// Drive of the coil.
    pub peak_hold: PeakHold,
    /// Current from which its clutch counts as engaged, A.
    pub threshold: f32,
    /// Supply over resistance, A; 0 where it is not known, and then only what exceeds the converter is too much.
    pub full: f32,
    /// From which current on it is too much, A.
    most: f32,
    /// Above which current the low side of a coil that holds does not let go, A.
    closed: f32,
    /// Ticks after which it holds by the holding current.
    settled: u32,
}

/// What its switches shall do until the next tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Switches {
    /// The high side conducts.
    pub high: bool,
    /// Share of the time in which the low side does, 0 to 1.
    pub low: f32,
}

/// What has been driven, and for how many ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Stage {
    #[default]
    Released,
    /// Both sides off, but a current still flows; 0 where no test waits for its end.
    Dying(u32),
    HighAlone(u32),
    LowAlone(u32),
    Engaged(u32),
}

/// A coil; the default is released.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coil {
    stage: Stage,
    feedback: Feedback,
    dip: Dip,
    /// The present pulse is a test.
    tested: bool,
    /// Over-current has cut it off.
    cut: bool,
}

impl CoilDesign {
    /// Of the coils of this `wiring`, at ticks of `period`, s.
    pub fn of(wiring: &Wiring, period: f32) -> CoilDesign {
        let peak_hold = PeakHold::new(wiring.coil_pull_in_time, wiring.coil_hold_share, period);
        CoilDesign::new(peak_hold, wiring.coil_engaged_current, wiring.coil_full_current)
    }

    /// Of a coil that engages its clutch from `threshold`, A, on, and whose full current is `full`, A.
    pub const fn new(peak_hold: PeakHold, threshold: f32, full: f32) -> CoilDesign {
        let most = if full > 0.0 && OVER * full < FULL_SCALE { OVER * full } else { FULL_SCALE };
        let closed = if full > 0.0 && peak_hold.hold_share < CLOSED - FLOWS { CLOSED * full } else { f32::INFINITY };
        let settled = peak_hold.pull_in_ticks.saturating_mul(1 + SETTLING).saturating_add(1);
        CoilDesign { peak_hold, threshold, full, most, closed, settled }
    }

    /// Ticks for which each switch is tried alone: half of the pull-in.
    fn alone(&self) -> u32 {
        (self.peak_hold.pull_in_ticks / 2).max(1)
    }

    fn flows(&self, current: f32) -> bool {
        current > if self.full > 0.0 { FLOWS * self.full } else { 0.5 * self.threshold }
    }

    /// So little is left of a `current` that noise does not make it [flow](CoilDesign::flows).
    fn has_died(&self, current: f32) -> bool {
        !self.flows(2.0 * current)
    }

    /// `current` is a `share` of the full one, if that is known.
    fn is_right(&self, current: f32, share: f32) -> bool {
        let right = share * self.full;
        self.full <= 0.0 || (current - right).abs() <= CURRENT_TOLERANCE * right
    }
}

impl Coil {
    /// What the `current`, A, says that flows at the end of a tick.
    #[inline]
    pub fn see(&mut self, design: &CoilDesign, current: f32) -> CoilReading {
        let engaged = self.feedback.engaged(current, design.threshold);
        let well = match self.stage {
            Stage::Released => design.has_died(current),
            Stage::Engaged(ticks) => ticks > design.settled && current <= design.closed,
            Stage::Dying(_) | Stage::HighAlone(_) | Stage::LowAlone(_) => false,
        };
        if well && current < design.most && !self.cut {
            return CoilReading { engaged, report: CoilReport::Well, closed: None };
        }
        self.look_closer(design, current, engaged)
    }

    /// The same of one that is tried or pulls in, or that may be in trouble.
    #[inline(never)]
    fn look_closer(&mut self, design: &CoilDesign, current: f32, engaged: bool) -> CoilReading {
        let trouble = self.trouble(design, current);
        self.cut |= trouble == Some(CoilTrouble::OverCurrent);
        let report = match (trouble, self.stage) {
            (Some(trouble), _) => CoilReport::Trouble(trouble),
            (None, Stage::Dying(_) | Stage::HighAlone(_) | Stage::LowAlone(_)) => CoilReport::Testing,
            (None, Stage::Engaged(ticks)) if self.tested && ticks < design.settled => CoilReport::Testing,
            (None, Stage::Engaged(_) | Stage::Released) => CoilReport::Well,
        };
        let closed = match self.stage {
            Stage::Engaged(ticks) if ticks <= design.peak_hold.pull_in_ticks => self.dip.step(ticks, current, design.full),
            _ => None,
        };
        self.stage = match self.stage {
            Stage::Released if !design.has_died(current) => Stage::Dying(0),
            Stage::Dying(_) if design.has_died(current) => Stage::Released,
            stage => stage,
        };
        CoilReading { engaged, report, closed }
    }

    fn trouble(&self, design: &CoilDesign, current: f32) -> Option<CoilTrouble> {
        if self.cut || current >= design.most {
            return Some(CoilTrouble::OverCurrent);
        }
        let PeakHold { pull_in_ticks, hold_share } = design.peak_hold;
        match self.stage {
            Stage::HighAlone(_) if design.flows(current) => Some(CoilTrouble::LowSideClosed),
            Stage::LowAlone(_) if design.flows(current) => Some(CoilTrouble::HighSideClosed),
            Stage::Engaged(ticks) if self.tested && ticks == pull_in_ticks && !design.is_right(current, 1.0) => {
                Some(CoilTrouble::WrongCurrent)
            }
            Stage::Engaged(ticks) if ticks >= design.settled => {
                let closed = current > design.closed;
                let wrong = self.tested && ticks == design.settled && !design.is_right(current, hold_share);
                if closed { Some(CoilTrouble::LowSideClosed) } else { wrong.then_some(CoilTrouble::WrongCurrent) }
            }
            _ => None,
        }
    }

    /// What its switches shall do for a `command` to engage; its pulses try the switches first while it is `tested`.
    #[inline]
    pub fn drive(&mut self, design: &CoilDesign, command: bool, tested: bool) -> Switches {
        if !command || self.cut {
            // A new test begins with a coil that is off.
            self.cut &= !tested || command;
            self.stage = Stage::Released;
            return Switches::default();
        }
        if let Stage::Engaged(ticks) = self.stage {
            let ticks = ticks.saturating_add(1);
            self.stage = Stage::Engaged(ticks);
            return Switches { high: true, low: design.peak_hold.duty(ticks) };
        }
        self.begin(design, tested)
    }

    /// A pulse, up to its pull-in.
    #[inline(never)]
    fn begin(&mut self, design: &CoilDesign, tested: bool) -> Switches {
        let alone = design.alone();
        self.stage = match self.stage {
            // One that is ended by a motion engages at once.
            _ if !tested => Stage::Engaged(1),
            Stage::Dying(ticks) if ticks < alone => Stage::Dying(ticks + 1),
            Stage::Released | Stage::Dying(_) => Stage::HighAlone(1),
            Stage::HighAlone(ticks) if ticks < alone => Stage::HighAlone(ticks + 1),
            Stage::HighAlone(_) => Stage::LowAlone(1),
            Stage::LowAlone(ticks) if ticks < alone => Stage::LowAlone(ticks + 1),
            Stage::LowAlone(_) | Stage::Engaged(_) => Stage::Engaged(1),
        };
        match self.stage {
            Stage::Released | Stage::Dying(_) => Switches::default(),
            Stage::HighAlone(ticks) => {
                self.tested |= ticks == 1;
                Switches { high: true, low: 0.0 }
            }
            Stage::LowAlone(_) => Switches { high: false, low: 1.0 },
            Stage::Engaged(tick) => {
                self.tested &= tested;
                self.dip = Dip::default();
                Switches { high: true, low: design.peak_hold.duty(tick) }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::coil::current as converted;
    use crate::settings::Settings;

    /// 24 V over 30 Ω, L/R of 5 ms, 2 kHz, pull-in of 20 ms.
    const PEAK_HOLD: PeakHold = PeakHold { pull_in_ticks: 40, hold_share: 0.35 };
    const DESIGN: CoilDesign = CoilDesign::new(PEAK_HOLD, 0.2, 0.8);

    /// A coil on a bench, and what is broken about it.
    #[derive(Clone, Copy)]
    struct Bench {
        coil: Coil,
        current: f32,
        /// Full current, A, of the coil as it is.
        full: f32,
        high: Option<bool>,
        low: Option<f32>,
    }

    impl Bench {
        fn new() -> Bench {
            Bench { coil: Coil::default(), current: 0.0, full: 0.8, high: None, low: None }
        }

        /// One tick: what is seen of the last one, and then driven.
        fn tick(&mut self, command: bool, tested: bool) -> (bool, CoilReport) {
            let CoilReading { engaged, report, .. } = self.read(command, tested);
            (engaged, report)
        }

        fn read(&mut self, command: bool, tested: bool) -> CoilReading {
            let counts = (self.current / converted(1)).clamp(0.0, 4095.0) as u16;
            let seen = self.coil.see(&DESIGN, converted(counts));
            let Switches { high, low } = self.coil.drive(&DESIGN, command, tested);
            let (high, low) = (self.high.unwrap_or(high), self.low.unwrap_or(low));
            let target = if high { low * self.full } else { 0.0 };
            // Against the supply it dies fast; round the diode slowly.
            let share = if high || low > 0.0 { 0.1 } else { 0.4 };
            self.current += share * (target - self.current);
            seen
        }

        /// The tick of a pulse in which the first trouble is seen, and which.
        fn found(mut self, tested: bool) -> Option<(u32, CoilTrouble)> {
            self.tick(false, tested);
            (1..400).find_map(|tick| match self.tick(true, tested).1 {
                CoilReport::Trouble(trouble) => Some((tick, trouble)),
                CoilReport::Well | CoilReport::Testing => None,
            })
        }
    }

    #[test]
    fn a_whole_coil_passes_in_four_steps_and_holds() {
        let mut bench = Bench::new();
        let mut reports = std::vec::Vec::new();
        for _ in 0..400 {
            let (engaged, report) = bench.tick(true, true);
            reports.push(report);
            if report == CoilReport::Well && reports.len() > 1 {
                assert!(engaged);
            }
        }
        let testing = reports.iter().filter(|report| **report == CoilReport::Testing).count();
        assert_eq!(testing as u32, 2 * DESIGN.alone() + DESIGN.settled - 1, "{reports:?}");
        assert_eq!(reports.last(), Some(&CoilReport::Well));
        assert!((bench.current / 0.28 - 1.0).abs() < 0.01);
        // In operation it pulls in at once.
        let mut bench = Bench::new();
        assert!((0..400).all(|_| bench.tick(true, false).1 == CoilReport::Well));
    }

    /// Its feedback says released from 0.14 A on, and a current flows from 0.08 A on.
    #[test]
    fn what_is_left_of_a_hold_is_no_closed_switch() {
        for step in 1..=14 {
            let mut bench = Bench { current: 0.01 * step as f32, ..Bench::new() };
            let reports: std::vec::Vec<CoilReport> = (0..400).map(|_| bench.tick(true, true).1).collect();
            assert!(!reports.iter().any(|report| matches!(report, CoilReport::Trouble(_))), "{step}: {reports:?}");
            assert!(reports[1..100].iter().all(|report| *report == CoilReport::Testing), "{step}: its feedback is not judged");
            assert_eq!(reports.last(), Some(&CoilReport::Well));
        }
        // One that does not die is a closed switch, found while the guard is still open.
        for broken in [Bench { low: Some(1.0), ..Bench::new() }, Bench { low: Some(1.0), high: Some(true), ..Bench::new() }] {
            let (tick, trouble) = Bench { current: 0.28, ..broken }.found(true).expect("found");
            assert!(trouble == CoilTrouble::LowSideClosed && tick <= 2 + 2 * DESIGN.alone(), "{tick} {trouble:?}");
        }
    }

    #[test]
    fn each_single_failure_is_found_by_the_test() {
        let whole = Bench::new();
        let found = |bench: Bench| bench.found(true).expect("found");
        // The guard is still open when a closed switch shows.
        let (tick, trouble) = found(Bench { low: Some(1.0), ..whole });
        assert!(trouble == CoilTrouble::LowSideClosed && tick <= 1 + DESIGN.alone(), "{tick} {trouble:?}");
        let (tick, trouble) = found(Bench { high: Some(true), ..whole });
        assert!(trouble == CoilTrouble::HighSideClosed && tick <= 1 + 2 * DESIGN.alone(), "{tick} {trouble:?}");
        for broken in [Bench { low: Some(0.0), ..whole }, Bench { high: Some(false), ..whole }, Bench { full: 0.0, ..whole }] {
            assert_eq!(found(broken).1, CoilTrouble::WrongCurrent);
        }
        assert_eq!(found(Bench { full: 0.5, ..whole }).1, CoilTrouble::WrongCurrent);
        assert_eq!(found(Bench { full: 1.1, ..whole }).1, CoilTrouble::WrongCurrent);
        assert_eq!(found(Bench { full: 48.0, ..whole }).1, CoilTrouble::OverCurrent);
    }

    #[test]
    fn too_much_is_found_within_a_tick_and_cuts_the_coil_off_until_a_test() {
        let mut bench = Bench::new();
        for _ in 0..200 {
            assert_eq!(bench.tick(true, false).1, CoilReport::Well);
        }
        bench.current = 48.0;
        assert_eq!(bench.tick(true, false).1, CoilReport::Trouble(CoilTrouble::OverCurrent));
        assert_eq!(bench.coil.drive(&DESIGN, true, false), Switches::default(), "by itself");
        for _ in 0..100 {
            let (engaged, report) = bench.tick(false, false);
            assert_eq!(report, CoilReport::Trouble(CoilTrouble::OverCurrent));
            assert!(!engaged || bench.current > 0.1);
        }
        bench.tick(false, true);
        assert_eq!(bench.tick(false, true).1, CoilReport::Well);
        assert_eq!(bench.found(true), None);
    }

    #[test]
    fn a_low_side_that_fails_closed_while_it_holds_is_found() {
        let mut bench = Bench::new();
        for _ in 0..200 {
            bench.tick(true, false);
        }
        bench.low = Some(1.0);
        let found = (1..400).find(|_| bench.tick(true, false).1 == CoilReport::Trouble(CoilTrouble::LowSideClosed));
        assert!(found.is_some_and(|tick| tick < 60), "{found:?}");
    }

    #[test]
    fn a_coil_pulls_in_for_as_long_at_any_period() {
        let wiring = Wiring::of(&Settings::default());
        for (period, ticks) in [(5e-4, 40), (2.5e-4, 80), (1e-3, 20)] {
            let design = CoilDesign::of(&wiring, period);
            assert_eq!((design.peak_hold.pull_in_ticks, design.alone(), design.settled), (ticks, ticks / 2, 3 * ticks + 1));
        }
    }

    #[test]
    fn without_a_known_current_the_switches_and_the_full_scale_are_watched() {
        let design = CoilDesign::new(PEAK_HOLD, 0.2, 0.0);
        assert_eq!(design.most, FULL_SCALE);
        assert!(design.is_right(0.01, 1.0) && design.flows(0.11) && !design.flows(0.09));
        assert_eq!(DESIGN.most, 1.2);
        let mut coil = Coil::default();
        assert_eq!(coil.see(&design, FULL_SCALE).report, CoilReport::Trouble(CoilTrouble::OverCurrent));
    }
}
