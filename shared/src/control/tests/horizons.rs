//! Two delays of a clutch, and the one that counts.

use crate::control::controller::{Controller, Horizons};
use crate::control::estimation::estimate::Estimate;
use crate::control::law::Wish;
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
