//! Blocks that move outward as their runs end, and what may still stop them.

use super::{pair, tight};
use crate::drivetrain::clutch_state::Coupling;
use crate::equation::clutch_rule::wheel_for;
use crate::ground::Harmonics;
use crate::math;
use crate::math::sign::Sign;
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::hybrid::{HybridState, HybridSystem};
use crate::motion::state::{Limits, Phase};
use crate::structure::block::{GRAVITY, Geometry};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};

/// A pair with strong plates on its way out from 1.2 α to `side`, its flywheel engaged, and the friction of its bearings so large in moments
/// of the weight there.
fn falling(geometry: Geometry, side: Sign, friction: f64) -> (HybridSystem<f64>, HybridState<f64>) {
    let structure = pair(geometry, 1.0, 1.0).structure;
    let start = 1.2 * structure.block.slenderness();
    let weight = GRAVITY * math::tan(start - structure.block.slenderness());
    let dry_deceleration = friction * weight / structure.device.mass_ratio;
    let drivetrain = Drivetrain {
        engagement: Engagement::Friction { capacity_ratio: 100.0 },
        flywheel: FlywheelLosses { dry_deceleration, ..FlywheelLosses::default() },
        ..Drivetrain::default()
    };
    let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
    let mut state = machine.released_at(side.times(start), side.times(0.1), [0.0; 3]);
    let limits = Limits { overturned: 1.5, events: 1000 };
    machine.advance(&tight(), &mut state, Shaking::level(&Harmonics::QUIET), 0.01, &limits, &mut ()).unwrap();
    assert_eq!(state.device.wheels[wheel_for(side)].coupling, Coupling::Locked);
    (machine, state)
}

fn phase((machine, mut state): (HybridSystem<f64>, HybridState<f64>)) -> Phase {
    machine.end(&mut state, 0.01, &mut ());
    state.motion.phase
}

/// A flywheel that sticks holds with min(F_c, σd), the one that is engaged alone; with F_c plates may turn a block that falls only where
/// they turn their flywheel first.
#[test]
fn plates_stop_no_fall_but_by_what_their_flywheel_resists() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for side in [Sign::Positive, Sign::Negative] {
            for (friction, ends) in [(0.0, Phase::Overturned), (0.7, Phase::Overturned), (1.5, Phase::Rocking)] {
                assert_eq!(phase(falling(geometry, side, friction)), ends, "{geometry:?} {side:?} {friction}");
            }
            let slipping = |spin: f64| {
                let (machine, mut state) = falling(geometry, side, 0.0);
                let wheel = &mut state.device.wheels[wheel_for(side)];
                (wheel.coupling, wheel.spin) = (Coupling::Slipping(side), side.times(spin));
                phase((machine, state))
            };
            assert_eq!(slipping(0.01), Phase::Overturned, "{geometry:?} {side:?}");
            assert_eq!(slipping(-0.01), Phase::Rocking, "{geometry:?} {side:?}");
        }
    }
}
