//! What every effect of a real device costs: the mean of a Runge-Kutta step with its events located, over the pulse of the
//! ideal pair's kernel.
//!
//! The loops are those of the cases ([`sprag_case`]), so that they are in flash once: a shape of ground motion is chosen
//! at every look, and the ground moves vertically too, if only by nothing. Devices without a memory have the paper's
//! kinematics unless the name says otherwise, all others the consistent ones.

use super::{Tally, mean};
use core::{f32::consts::TAU, fmt, hint::black_box};
use sprag_case::Shape;
use sprag_shared::{
    drivetrain::{
        any_transmission::{AnyTransmission, TransmissionKind},
        scaled_parameters::ScaledParameters,
    },
    equation::{any_body::AnyBody, body::FullBody, lever::TyingPoint},
    ground::Harmonics,
    method::fixed::{FixedStep, Scheme},
    motion::{
        hybrid::{
            Actuator, HybridSystem,
            mode_output::{ModeIntegrator, Shaking},
        },
        state::{Limits, Stopped},
    },
    structure::{
        RestitutionScatter,
        block::{Block, RECTANGLE_INERTIA_RATIO},
        drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack, Support},
    },
};

/// σ.
const MASS_RATIO: f64 = 0.5;

/// A rack on guides, with friction.
const RACK: Rack = Rack { guided_mass_ratio: 0.02, viscous: 0.05, dry_ratio: 0.004, load_friction: 0.0 };

/// Bearings with friction.
const BEARINGS: FlywheelLosses =
    FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.3, brake_deceleration: 0.0, drag_rate: 0.0 };

/// And a brake.
const BRAKED: FlywheelLosses = FlywheelLosses { brake_deceleration: 5.0, ..BEARINGS };

/// A clutch that is late, and sometimes deaf.
const LATE: Actuation = Actuation {
    engagement_delay: 0.02,
    release_delay: 0.01,
    rise_time: 0.02,
    dwell: 0.03,
    miss_probability: 0.1,
    miss_seed: 1,
    ..PROMPT
};

const IDEAL: Drivetrain = Drivetrain {
    engagement: Engagement::Ideal,
    flywheel: NO_LOSSES,
    rack: NO_RACK,
    actuation: PROMPT,
    support: Support { amplification: 1.0, given_apart: false },
};
const NO_LOSSES: FlywheelLosses =
    FlywheelLosses { viscous_rate: 0.0, dry_deceleration: 0.0, brake_deceleration: 0.0, drag_rate: 0.0 };
const NO_RACK: Rack = Rack { guided_mass_ratio: 0.0, viscous: 0.0, dry_ratio: 0.0, load_friction: 0.0 };
const PROMPT: Actuation = Actuation {
    engagement_delay: 0.0,
    release_delay: 0.0,
    delay: Delay::Inertial,
    rise_time: 0.0,
    time_constant: 0.0,
    dwell: 0.0,
    miss_probability: 0.0,
    miss_seed: 0,
};
const ROUGH: Drivetrain = Drivetrain { flywheel: BEARINGS, rack: RACK, ..IDEAL };
const RIGID: Drivetrain = Drivetrain { engagement: Engagement::Rigid, flywheel: BRAKED, ..IDEAL };
const OVERRUNNING: Drivetrain = Drivetrain { engagement: Engagement::Overrunning, flywheel: BEARINGS, ..IDEAL };
const FRICTION: Drivetrain = Drivetrain { engagement: Engagement::Friction { capacity_ratio: 0.03 }, flywheel: BRAKED, ..IDEAL };
const ELASTIC: Drivetrain = Drivetrain {
    engagement: Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash: 0.0, capacity_ratio: f64::INFINITY },
    flywheel: BRAKED,
    ..IDEAL
};
const SLIP: Drivetrain = Drivetrain { engagement: Engagement::Viscous { corner_frequency: 4.0 }, flywheel: BRAKED, ..IDEAL };
const DRAGGED: Drivetrain = Drivetrain {
    flywheel: FlywheelLosses { drag_rate: 0.1, ..BRAKED },
    actuation: Actuation { engagement_delay: 0.02, ..PROMPT },
    ..RIGID
};
const LOADED: Drivetrain = Drivetrain { rack: Rack { load_friction: 0.05, ..NO_RACK }, ..RIGID };
const ALL: Drivetrain = Drivetrain { rack: RACK, actuation: LATE, ..FRICTION };

fn body(consistent: bool, vertical: bool) -> FullBody<f32> {
    let lever = TyingPoint { along: 1.0, across: 0.0 };
    FullBody { block: super::BLOCK, lever, consistent, vertical }
}

/// A block on its device, with the numbers of the ideal pair's kernel.
fn machine(body: FullBody<f32>, kind: TransmissionKind, block: &Block, drivetrain: &Drivetrain) -> HybridSystem<f32> {
    let parameters = match kind {
        TransmissionKind::Alone => ScaledParameters::default(),
        _ => ScaledParameters::of(drivetrain, block, MASS_RATIO, 1.0),
    };
    HybridSystem {
        body: AnyBody::Full(body),
        transmission: AnyTransmission { kind, parameters: black_box(parameters) },
        restitution: [super::RESTITUTION; 3],
        scatter: RestitutionScatter::NONE,
        slenderness: super::SLENDERNESS,
        speed: 0.33,
        rest_speed: 3e-7,
        counted_speed: 3e-7,
        actuator: Actuator::of(&drivetrain.actuation),
    }
}

/// One cycle of a sine pulse and every event in it, located.
#[inline(never)]
fn passage<T: ModeIntegrator<f32>>(
    machine: &HybridSystem<f32>,
    integrator: &T,
    shaking: Shaking<'_, f32>,
    tally: &mut Tally,
) -> Result<(), Stopped> {
    let limits = Limits { overturned: core::f32::consts::FRAC_PI_2, events: 10_000 };
    machine.advance(integrator, &mut machine.at_rest(), shaking, 1.0, &limits, tally)
}

/// Prints a line for every effect; all zeros on the host.
///
/// # Errors
/// If `out` refuses a line.
pub fn report(counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> fmt::Result {
    let Ok(block) = Block::new(2.0, f64::from(super::SLENDERNESS), RECTANGLE_INERTIA_RATIO) else { return Err(fmt::Error) };
    let pulse = black_box(Shape::Sine(Harmonics::sine(0.5, TAU)));
    let up = black_box(Shape::Sine(Harmonics::sine(0.2, 4.0 * TAU)));
    let (level, both) = (Shaking::level(&pulse), Shaking { vertical: Some(&up), ..Shaking::level(&pulse) });
    let integrator = FixedStep { scheme: Scheme::RungeKutta4, step: super::STEP };
    let midpoint = FixedStep { scheme: Scheme::ExponentialMidpoint, step: super::STEP };
    let (paper, consistent) = (body(false, false), body(true, false));

    macro_rules! line {
        ($name:literal, $body:expr, $kind:ident, $drivetrain:expr, $integrator:expr, $shaking:expr) => {{
            let machine = black_box(machine($body, TransmissionKind::$kind, &block, &$drivetrain));
            mean($name, |tally| passage(&machine, $integrator, $shaking, tally), counter, out)?;
        }};
    }
    line!("machine-alone", paper, Alone, IDEAL, &integrator, level);
    line!("machine-alone-vertical", body(false, true), Alone, IDEAL, &integrator, both);
    line!("machine-single-friction", paper, SingleWithFriction, ROUGH, &integrator, level);
    line!("machine-ideal-pair", paper, Ideal, IDEAL, &integrator, level);
    line!("machine-ideal-pair-friction", paper, IdealWithFriction, ROUGH, &integrator, level);
    line!("machine-ideal-pair-consistent", consistent, Ideal, IDEAL, &integrator, level);
    line!("machine-rigid", consistent, Rigid, RIGID, &integrator, level);
    line!("machine-overrunning", consistent, Overrunning, OVERRUNNING, &integrator, level);
    line!("machine-friction-clutch", consistent, Friction, FRICTION, &integrator, level);
    line!("machine-elastic-rk4", consistent, Elastic, ELASTIC, &integrator, level);
    line!("machine-elastic-exponential", consistent, Elastic, ELASTIC, &midpoint, level);
    line!("machine-viscous-slip", consistent, Viscous, SLIP, &integrator, level);
    line!("machine-drag", consistent, DraggedRigid, DRAGGED, &integrator, level);
    line!("machine-load-friction", consistent, LoadedRigid, LOADED, &integrator, level);
    line!("machine-all-together", body(true, true), Friction, ALL, &integrator, both);
    Ok(())
}
