//! When a clutch is commanded: two delays and the one that counts, and both only at rest.

use crate::control::controller::{Controller, Horizons};
use crate::control::estimation::estimate::Estimate;
use crate::control::law::Wish;
use crate::control::law::minimum_dwell::Gate;
use crate::settings::Settings;

/// A block that turns back in 11 ms: by then an open clutch that takes 20 ms must be commanded, and one that is engaged, and takes 5 ms,
/// is still to be released.
#[test]
fn each_command_is_asked_for_when_it_takes_effect() {
    let horizons = Horizons { engagement: 0.02, release: 0.005 };
    let controller = Controller { horizons, bands: 0.0, ..Controller::of(&Settings::default()).unwrap() };
    let estimate = Estimate { rotation: 0.1, velocity: 0.003, push: -0.27, ..Estimate::default() };
    let wish = |engaged| {
        let mut state = controller.start();
        // The first tick of a motion has the signs of uplift.
        controller.choose(&mut state, &estimate, engaged);
        controller.choose(&mut state, &estimate, engaged).0
    };
    assert_eq!((wish([false; 2]), wish([true, false])), (Wish::Resist, Wish::Release));
}

/// However long a command must stand, and however soon after the second flywheel has come to rest the block moves.
#[test]
fn in_motion_never_both_are_commanded() {
    for dwell in [0, 1, 10, 200, u16::MAX] {
        let controller = Controller { gate: Gate { dwell }, ..Controller::of(&Settings::default()).unwrap() };
        for rested in 1..30 {
            let mut state = controller.start();
            let at_rest = Estimate { standing: true, ..Estimate::default() };
            let waiting = (0..rested).map(|_| controller.choose(&mut state, &at_rest, [true; 2]).1).last();
            assert_eq!(waiting, Some([true; 2]));
            for tick in 0..30 {
                let moving = Estimate { rotation: 1e-4, velocity: 0.01 + 1e-3 * tick as f32, push: 0.1, ..Estimate::default() };
                let (_, command) = controller.choose(&mut state, &moving, [true; 2]);
                assert_ne!(command, [true; 2], "dwell {dwell}, {rested} ticks of rest, tick {tick} of motion");
            }
        }
    }
}
