//! Accelerometers whose range is another than they are read with.

use super::*;
use crate::control::monitor::fault::Place;

fn scaled(factors: [f32; 2]) -> impl Fn(&mut Sample, &Sample) {
    move |sample, _| {
        for (axes, factor) in [&mut sample.block_accelerometer, &mut sample.ground_accelerometer].into_iter().zip(factors) {
            axes.iter_mut().for_each(|axis| axis.value *= factor);
        }
    }
}

/// Ticks in which it must be found: 64 looks, one every 256 ticks, and those of a rest that has just begun.
const FOUND_WITHIN: u32 = 65 * 256;

fn warned(rig: &Rig) -> [bool; 2] {
    Place::ALL.map(|place| rig.complaints().contains(&Kind::Warning(Fault::ScaleWrong(place).code())))
}

/// Both at once look like a ground that shakes, and contradict neither each other nor anything else.
#[test]
fn a_wrong_range_of_both_accelerometers_is_a_warning_and_nothing_more() {
    for factor in [0.5, 2.0] {
        let mut rig = Rig::armed(&parameters());
        for _ in 0..FOUND_WITHIN {
            let verdict = rig.spoilt(scaled([factor; 2]));
            assert!(verdict.fault.is_none() && matches!(verdict.phase, Phase::Armed | Phase::Rocking), "{factor}: {verdict:?}");
        }
        assert_eq!(warned(&rig), [true; 2], "{factor}");
    }
}

/// A range that was wrong from the start: it is not required, so nothing else but a refused bias shows it.
#[test]
fn a_wrong_range_from_the_start_is_a_warning() {
    let mut rig = Rig::new(&parameters());
    for _ in 0..FOUND_WITHIN + 8000 {
        rig.spoilt(scaled([2.0, 1.0]));
    }
    assert_eq!(warned(&rig), [true, false]);
}

#[test]
fn a_tenth_off_or_a_block_that_rocks_is_no_warning() {
    let mut rig = Rig::armed(&parameters());
    for _ in 0..2 * FOUND_WITHIN {
        rig.spoilt(scaled([0.9, 1.1]));
    }
    assert_eq!(warned(&rig), [false; 2]);
    let mut rig = Rig::armed(&parameters());
    for tick in 0..2 * FOUND_WITHIN {
        if tick % 4000 == 0 {
            rig.velocity = 0.28;
        }
        rig.spoilt(scaled([2.0, 2.0]));
    }
    assert_eq!(warned(&rig), [false; 2]);
}
