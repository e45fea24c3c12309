//! How good a controller's decisions are: against the same law on the plant as it truly is.

use serde::Serialize;
use sprag_shared::motion::state::Phase;

use super::run::{Looks, Tick, TickObserver, follow_fall};

/// One instant of a closed loop, as decisions are judged.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// s.
    pub time: f64,
    /// The block rocks.
    pub rocks: bool,
    /// |θ| is α or more: a block that overturns has begun to fall.
    pub beyond: bool,
    /// θ̇, rad/s.
    pub velocity: f64,
    /// The law, on the true motion, would engage.
    pub ideal: bool,
    /// One is.
    pub engaged: bool,
}

impl From<&Tick> for Moment {
    fn from(tick: &Tick) -> Moment {
        let plant = &tick.plant;
        let [first, second] = plant.engaged;
        let (rocks, velocity) = (plant.motion.phase == Phase::Rocking, plant.motion.velocity);
        Moment { time: plant.time, rocks, beyond: tick.beyond, velocity, ideal: tick.ideal, engaged: first || second }
    }
}

/// Collects moments at a regular interval.
#[derive(Clone, Debug, Default)]
pub struct Decisions {
    wrong: f64,
    whole: f64,
    last: Option<Moment>,
    ideal: Vec<(f64, bool)>,
    moved: Vec<(f64, bool)>,
    /// `wrong`, `whole`, and the lengths of `ideal` and `moved` before a fall.
    fall: Option<(f64, f64, usize, usize)>,
}

/// What they come to.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DecisionReport {
    /// Share of the rocking time, weighted by |θ̇|, in which the clutches are not as the same law on the true motion has them. The clutches
    /// and not the command: a law that predicts gives commands early on purpose. A fall counts in nothing here.
    pub wrong_share: f64,
    /// From the instant at which the law on the true motion changes to the clutch's movement, s: median, …
    pub delay_median_s: Option<f64>,
    /// … and 95th percentile.
    pub delay_95_s: Option<f64>,
    /// Movements of the clutches.
    pub switches: u32,
    /// Those of the law on the true motion.
    pub ideal_switches: u32,
    /// Movements beyond those.
    pub chatter: u32,
}

/// Longest delay of a movement that still belongs to a change of the law, s.
const LONGEST: f64 = 0.1;

impl TickObserver for Decisions {
    fn tick(&mut self, tick: &Tick) {
        self.add(Moment::from(tick));
    }

    fn looks(&self) -> Looks {
        Looks::Rocking
    }

    fn overturned(&mut self) {
        let Some((wrong, whole, ideal, moved)) = self.fall.take() else { return };
        (self.wrong, self.whole) = (wrong, whole);
        self.ideal.truncate(ideal);
        self.moved.truncate(moved);
    }
}

impl Decisions {
    /// Those of all `ticks` of a loop, without the fall of a block that has `overturned`.
    pub fn of(ticks: &[Tick], overturned: bool) -> Decisions {
        let mut decisions = Decisions::default();
        ticks.iter().for_each(|tick| decisions.tick(tick));
        if overturned {
            decisions.overturned();
        }
        decisions
    }

    /// Adds a moment.
    pub fn add(&mut self, now: Moment) {
        if let Some(last) = self.last {
            let weight = last.velocity.abs() * (now.time - last.time);
            if last.rocks {
                self.whole += weight;
                if last.ideal != last.engaged {
                    self.wrong += weight;
                }
            }
        }
        follow_fall(&mut self.fall, now.beyond, || (self.wrong, self.whole, self.ideal.len(), self.moved.len()));
        let before = self.last.unwrap_or(Moment { ideal: false, engaged: false, ..now });
        // A standing block has no law to follow.
        let ideal = if now.rocks { now.ideal } else { before.ideal };
        if ideal != before.ideal {
            self.ideal.push((now.time, ideal));
        }
        if now.engaged != before.engaged {
            self.moved.push((now.time, now.engaged));
        }
        self.last = Some(Moment { ideal, ..now });
    }

    /// What they come to so far.
    pub fn report(&self) -> DecisionReport {
        let mut delays = self.delays();
        delays.sort_by(f64::total_cmp);
        let quantile = |share: f64| delays.get(((delays.len() as f64 - 1.0).max(0.0) * share).round() as usize).copied();
        let (switches, ideal_switches) = (self.moved.len() as u32, self.ideal.len() as u32);
        DecisionReport {
            wrong_share: if self.whole > 0.0 { self.wrong / self.whole } else { 0.0 },
            delay_median_s: quantile(0.5),
            delay_95_s: quantile(0.95),
            switches,
            ideal_switches,
            chatter: switches.saturating_sub(ideal_switches),
        }
    }

    /// For every change of the law the nearest movement of the clutches in the same direction.
    pub fn delays(&self) -> Vec<f64> {
        let nearest = |&(at, to): &(f64, bool)| {
            let near = &self.moved[self.moved.partition_point(|moved| moved.0 - at <= -LONGEST)..];
            let near = near.iter().take_while(|moved| moved.0 - at < LONGEST);
            let same = near.filter(|moved| moved.1 == to).map(|moved| moved.0 - at);
            same.min_by(|a, b| a.abs().total_cmp(&b.abs()))
        };
        self.ideal.iter().filter_map(nearest).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A law that changes every 0.2 s, and a clutch that follows 3 ms later.
    #[test]
    fn a_late_clutch_is_late_and_wrong_for_as_long_as_it_is_late() {
        let mut decisions = Decisions::default();
        for k in 0..20_000 {
            let time = f64::from(k) * 1e-4;
            let on = |t: f64| t >= 0.0 && (t / 0.2) as u32 % 2 == 1;
            decisions.add(Moment {
                time,
                rocks: true,
                beyond: false,
                velocity: -2.0,
                ideal: on(time),
                engaged: on(time - 0.003),
            });
        }
        let report = decisions.report();
        assert!((report.delay_median_s.unwrap() - 0.003).abs() < 2e-4, "{report:?}");
        assert!((report.wrong_share - 0.0135).abs() < 5e-4);
        assert_eq!((report.switches, report.ideal_switches, report.chatter), (9, 9, 0));
    }

    #[test]
    fn chatter_is_what_goes_beyond_the_law() {
        let mut decisions = Decisions::default();
        for k in 0..100_u32 {
            let time = f64::from(k) * 1e-2;
            decisions.add(Moment { time, rocks: true, beyond: false, velocity: 1.0, ideal: k > 50, engaged: k % 2 == 1 });
        }
        let report = decisions.report();
        assert_eq!(report.ideal_switches, 1);
        assert_eq!(report.chatter, 98);
        assert!((report.wrong_share - 0.5).abs() < 0.02);
    }

    #[test]
    fn a_standing_block_has_no_wrong_decisions() {
        let mut decisions = Decisions::default();
        for k in 0..10 {
            let (time, ideal) = (f64::from(k), k % 2 == 0);
            decisions.add(Moment { time, rocks: false, beyond: false, velocity: 0.0, ideal, engaged: true });
        }
        assert_eq!(decisions.report().wrong_share, 0.0);
        assert_eq!(decisions.report().ideal_switches, 0);
    }

    /// Right up to the fall and wrong in it, faster and faster. One that comes back has fallen from nowhere.
    #[test]
    fn nobody_decides_on_a_block_that_falls() {
        let moment = |k: u32| {
            let (time, falls) = (f64::from(k) * 1e-2, k > 100);
            let velocity = if falls { 10.0 } else { 1.0 };
            Moment { time, rocks: true, beyond: falls, velocity, ideal: k % 10 < 5, engaged: (k % 10 < 5) != falls }
        };
        let mut decisions = Decisions::default();
        (0..=100).for_each(|k| decisions.add(moment(k)));
        let before = decisions.report();
        assert_eq!(before.wrong_share, 0.0);
        (101..200).for_each(|k| decisions.add(moment(k)));
        let mut fallen = decisions.clone();
        fallen.overturned();
        assert_eq!(fallen.report(), before);
        assert_eq!(fallen.delays().len(), before.ideal_switches as usize);
        assert!(decisions.report().wrong_share > 0.8);
        let back = Moment { time: 2.0, beyond: false, ..moment(100) };
        decisions.add(back);
        let returned = decisions.report();
        decisions.overturned();
        assert_eq!(decisions.report(), returned);
    }
}
