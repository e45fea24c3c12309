//! Days and years: counts of ticks that wrap, and those that stop at their ends.

use super::*;

/// What happens to an armed rig that rocks and comes to rest again, and when, in ticks of its own.
fn course(rig: &mut Rig) -> Vec<(u32, Kind)> {
    let (begin, before) = (rig.state.tick, rig.state.log.iter().count());
    rig.velocity = 0.28;
    rig.until(Phase::Rocking, 10);
    rig.until(Phase::Armed, 100_000);
    rig.state.log.iter().skip(before).map(|entry| (entry.tick.wrapping_sub(begin), entry.kind)).collect()
}

#[test]
fn the_count_of_ticks_wraps_in_mid_motion() {
    let expected = course(&mut Rig::armed(&parameters()));
    assert!(expected.len() >= 2);
    for before in [0, 1, 5, 3000, u32::MAX / 2] {
        let mut rig = Rig::armed(&parameters());
        rig.state.tick = u32::MAX - before;
        assert_eq!(course(&mut rig), expected, "{before} ticks before its end");
    }
}

#[test]
fn a_rest_of_years_ends_with_the_first_motion() {
    let expected = course(&mut Rig::armed(&parameters()));
    let mut rig = Rig::armed(&parameters());
    let Motion { block_still, ground_still, quiet, .. } = &mut rig.state.motion;
    (*block_still, *ground_still, *quiet) = (u32::MAX - 100, u32::MAX - 50, u32::MAX - 1);
    rig.quietly(200);
    assert!(rig.state.motion.block_still > u32::MAX - 256 && rig.state.motion.ground_still == u32::MAX);
    assert_eq!(rig.state.phase, Phase::Armed);
    let kinds = |course: &[(u32, Kind)]| course.iter().map(|(_, kind)| *kind).collect::<Vec<_>>();
    let mut travels = rig.clone();
    assert_eq!(kinds(&course(&mut rig)), kinds(&expected));
    // A rack that travels a count a tick is a motion, though the gyroscope does not feel it.
    for after in 0..300 {
        let mut rig = travels.clone();
        let begun = rig.tick;
        for _ in 0..8 {
            let travelled = (rig.tick - begun) as i32;
            rig.spoilt(|sample, _| sample.encoder.counts += travelled);
        }
        assert_eq!(rig.state.phase, Phase::Rocking, "{after}");
        travels.quietly(1);
    }
}

#[test]
fn a_fault_of_years_is_left_as_any_other() {
    let mut rig = Rig::armed(&parameters());
    rig.spoilt(|sample, _| sample.gyroscope.value = f32::NAN);
    assert_eq!(rig.state.phase, Phase::Fault);
    for _ in 0..3 {
        // It may wait for as long as it likes: nothing comes around.
        (rig.state.waiting, rig.state.motion.quiet) = (u32::MAX - 10, u32::MAX - 10);
        for _ in 0..100 {
            assert_eq!(rig.spoilt(|sample, _| sample.gyroscope.value = f32::NAN).phase, Phase::Fault);
        }
    }
    rig.until(Phase::Armed, 10_000);
}
