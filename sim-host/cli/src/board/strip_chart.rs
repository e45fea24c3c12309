//! A device's last seconds as a picture of characters.

use std::collections::VecDeque;
use std::fmt::Write;

use sprag_shared::link::TickReport;
use textplots::{Chart, LabelBuilder, LabelFormat, Plot, Shape};

/// What is shown at a time, s.
const SPAN: f64 = 10.0;
/// Points across and down; a character has two by four.
const SIZE: (u32, u32) = (140, 32);
/// Least half height, rad and rad/s, so that noise at rest is not blown up to a storm.
const LEAST: f32 = 1e-4;

/// The last reports.
#[derive(Debug)]
pub struct StripChart {
    period: f64,
    reports: VecDeque<(f64, TickReport)>,
    first: Option<u32>,
}

impl StripChart {
    /// Of a device with this time from tick to tick, s.
    pub fn new(period: f32) -> StripChart {
        StripChart { period: period.into(), reports: VecDeque::new(), first: None }
    }

    /// Adds a report; gives its time since the first, s: in double precision, for after two days a single one has steps of 8 ms.
    pub fn add(&mut self, report: TickReport) -> f64 {
        let first = *self.first.get_or_insert(report.tick);
        let time = f64::from(report.tick.wrapping_sub(first)) * self.period;
        self.reports.push_back((time, report));
        while self.reports.front().is_some_and(|(earliest, _)| *earliest < time - SPAN) {
            self.reports.pop_front();
        }
        time
    }

    /// The picture, and nothing where there is nothing to show.
    pub fn draw(&self) -> String {
        let Some((time, last)) = self.reports.back() else { return String::new() };
        let mut text = String::new();
        let decision = &last.decision;
        let fault = decision.fault.map_or_else(String::new, |fault| format!(": {fault}"));
        let _ = writeln!(text, "{time:9.2} s  {:?}{fault}", decision.phase);
        for (name, value) in [("θ rad", 0), ("θ̇ rad/s", 1)] {
            let of = |report: &TickReport| {
                if value == 0 { report.decision.estimate.rotation } else { report.decision.estimate.velocity }
            };
            let (most, curve) = self.curve(of);
            let _ = writeln!(text, "{name} {:+.6}, up to ±{most:.4}, {SPAN} s", of(last));
            text.push_str(&curve);
        }
        for wheel in 0..2 {
            let _ = writeln!(text, "{} {}", self.strip(wheel), if wheel == 0 { "first" } else { "second" });
        }
        text
    }

    fn start(&self) -> f64 {
        self.reports.back().map_or(0.0, |(time, _)| (time - SPAN).max(0.0))
    }

    /// A curve and its half height.
    fn curve(&self, of: impl Fn(&TickReport) -> f32) -> (f32, String) {
        let finite = self.reports.iter().map(|(time, report)| (*time as f32, of(report))).filter(|(_, value)| value.is_finite());
        let points: Vec<(f32, f32)> = finite.collect();
        let most = points.iter().map(|(_, value)| value.abs()).fold(LEAST, f32::max);
        let start = self.start() as f32;
        let shape = Shape::Lines(&points);
        let mut chart = Chart::new_with_y_range(SIZE.0, SIZE.1, start, start + SPAN as f32, -most, most);
        // Its own labels have one decimal.
        let chart = chart.lineplot(&shape).x_label_format(LabelFormat::None).y_label_format(LabelFormat::None);
        chart.axis();
        chart.figures();
        (most, chart.to_string())
    }

    /// When a clutch was to be engaged.
    fn strip(&self, wheel: usize) -> String {
        let columns = SIZE.0 as usize / 2;
        let mut strip = vec!['·'; columns];
        for (time, report) in &self.reports {
            let column = ((time - self.start()) / SPAN * columns as f64) as usize;
            if report.decision.command[wheel] {
                strip[column.min(columns - 1)] = '█';
            }
        }
        strip.into_iter().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::control::controller::Decision;
    use sprag_shared::control::estimation::estimate::Estimate;
    use sprag_shared::control::law::Wish;
    use sprag_shared::control::supervisor::Phase;

    fn report(tick: u32, rotation: f32, command: [bool; 2]) -> TickReport {
        let estimate = Estimate { rotation, velocity: -rotation, ..Estimate::default() };
        let decision = Decision { command, estimate, wish: Wish::Release, phase: Phase::Rocking, fault: None };
        TickReport { tick, sample: 0, decision, cost: 0, lateness: 0 }
    }

    #[test]
    fn any_motion_can_be_drawn() {
        assert_eq!(StripChart::new(0.01).draw(), "");
        for value in [0.0, 1e-30, f32::MAX, -f32::MAX, f32::NAN, f32::INFINITY] {
            let mut chart = StripChart::new(0.01);
            for tick in 0..3 {
                chart.add(report((u32::MAX - 1).wrapping_add(tick), value, [false; 2]));
            }
            assert!(chart.draw().contains("Rocking"), "{value}");
        }
    }

    #[test]
    fn ticks_after_days_have_times_of_their_own() {
        let mut chart = StripChart::new(5e-4);
        chart.add(report(0, 0.0, [false; 2]));
        let [first, second] = [1_000_000_000, 1_000_000_020].map(|tick| chart.add(report(tick, 0.0, [false; 2])));
        assert!((second - first - 0.01).abs() < 1e-6, "{first} {second}");
    }

    #[test]
    fn only_the_last_seconds_are_kept_and_the_height_stays() {
        let mut chart = StripChart::new(0.01);
        let mut heights = std::collections::BTreeSet::new();
        for tick in 0..5000 {
            chart.add(report(tick, (tick as f32 / 50.0).to_bits() as f32 * 1e-12, [tick > 4500, false]));
            if tick % 500 == 0 {
                heights.insert(chart.draw().lines().count());
            }
        }
        assert!(chart.reports.len() <= 1001);
        assert_eq!(heights.len(), 1, "{heights:?}");
        // The second half of the ten seconds.
        assert_eq!(chart.strip(0).chars().filter(|c| *c == '█').count(), SIZE.0 as usize / 4);
        assert!(!chart.strip(1).contains('█'));
    }
}
