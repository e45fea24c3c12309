//! A device that has worked for days: its counts continue past their ends, and nothing that it decides or shows depends on them.

use super::*;
use crate::device::light::slot_ticks;

/// An armed device that has counted so many ticks.
fn after(ticks: u32) -> Bench {
    let mut bench = Bench::armed();
    bench.device.ticks = ticks;
    bench
}

#[test]
fn ticks_wrap_and_decisions_do_not_notice() {
    let run = |begin: u32| {
        let mut bench = after(begin);
        bench.rig.shakes = true;
        bench.ask(Request::Stream { every: 1 });
        let course = (0..3000).map(|_| {
            bench.tick();
            let report = bench.device.report(1, 0).unwrap();
            (report.tick.wrapping_sub(begin), report.decision)
        });
        course.collect::<Vec<_>>()
    };
    let expected = run(0);
    assert!(expected.iter().any(|(_, decision)| decision.command != [false; 2] && decision.phase == Phase::Rocking));
    for begin in [u32::MAX - 1500, u32::MAX - 1, u32::MAX / 2, 1 << 24] {
        assert!(run(begin) == expected, "from {begin}");
    }
}

#[test]
fn the_light_keeps_its_time_for_as_long_as_ticks_are_counted() {
    let length = slot_ticks(Bench::new().device.controller.instruments.period);
    assert_eq!(length, 100);
    // Two hours, ten days, twenty days; and the last second before the count begins anew.
    for begin in [0, 14_400_000, 1_728_000_000, 3_456_000_000, u32::MAX - 2 * 2000] {
        let mut bench = after(begin);
        let first = bench.device.light_slot();
        for tick in 1..=2000 {
            bench.tick();
            assert_eq!(bench.device.light_slot() - first, (begin % length + tick) / length, "{tick} ticks after {begin}");
        }
    }
}

#[test]
fn restarts_are_forgotten_after_a_second_of_good_work_which_is_counted_no_further() {
    let mut bench = Bench::armed();
    (bench.device.good, bench.device.restarts) = (0, 3);
    bench.ticks(1990);
    assert_eq!(bench.device.restarts(), 3);
    bench.ticks(20);
    let counted = bench.device.good;
    bench.ticks(100);
    assert_eq!((bench.device.restarts(), bench.device.good), (0, counted));
}

#[test]
fn a_stream_of_the_longest_interval_continues() {
    let mut bench = Bench::armed();
    bench.ask(Request::Stream { every: u16::MAX });
    let mut reports = Vec::new();
    for tick in 1..=3 * u32::from(u16::MAX) {
        if bench.device.report(1, 0).is_some() {
            reports.push(tick);
        }
    }
    assert_eq!(reports, [1, 2, 3].map(|count| count * u32::from(u16::MAX)));
}

#[test]
fn samples_of_the_link_are_numbered_past_the_end() {
    let mut bench = Bench::new();
    bench.ask(Request::Attach { pace: Pace::Sample });
    for number in (u32::MAX - 50..=u32::MAX).chain(0..50) {
        bench.host_tick(number);
        assert_eq!(bench.device.report(1, 0).map(|report| report.sample), Some(number));
    }
}
