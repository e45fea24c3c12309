//! The loop for devices with a memory, against the loop for ideal ones, closed forms, limits and other methods.

mod actuation;
mod demands;
mod drag;
mod end;
mod energy;
mod ground;
mod limits;
mod load_friction;
mod maxwell;
mod methods;
mod restitution_scatter;
mod standing;
mod support;
mod support_motion;
mod viscous;

use std::vec::Vec;

use super::mode_output::{ModeIntegrator, Shaking};
use super::series::Series;
use super::{HybridState, HybridSystem};
use crate::ground::{AnySegment, Harmonics, Linear};
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::method::fixed::{FixedStep, Scheme};
use crate::method::taylor::Taylor;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::rest::impact_accumulation::Accumulation;
use crate::motion::state::{BlockState, Limits};
use crate::observers::ledger::{Account, Clutching, Ledger};
use crate::observers::peaks::Peaks;
use crate::structure::Structure;
use crate::structure::block::{Block, Geometry};
use crate::structure::device::{Device, DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses, Rack, Support};
use crate::structure::restitution::Restitution;

fn sine(amplitude: f64, frequency: f64) -> AnySegment<f64> {
    AnySegment::Sine(Harmonics::sine(amplitude, frequency))
}

fn constant(level: f64) -> AnySegment<f64> {
    AnySegment::Linear(Linear::constant(level))
}

/// A block under ground segments, then left alone.
#[derive(Clone, Debug)]
pub struct Shake {
    pub structure: Structure,
    /// Each with its duration, s.
    pub pieces: Vec<(AnySegment<f64>, f64)>,
    /// s.
    pub free_time: f64,
}

/// What both loops report.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    pub peak: f64,
    pub acceleration: f64,
    pub impacts: u32,
    pub ended: Option<f64>,
    pub events: Vec<(Event, f64)>,
    pub state: BlockState<f64>,
    pub spins: [f64; 2],
    /// Clutch switches: time, and the state before and after.
    pub switches: Vec<(f64, BlockState<f64>, BlockState<f64>)>,
}

pub fn structure(geometry: Geometry, degrees: f64, kind: DeviceKind, sigma: f64, kinematics: KinematicsKind) -> Structure {
    Structure {
        geometry,
        device: Device { kind, mass_ratio: sigma, kinematics, ..Device::NONE },
        ..Structure::new(Block::new(2.0, degrees.to_radians(), 4.0 / 3.0).unwrap(), Restitution::Constant(0.85))
    }
}

pub fn shake(structure: Structure, amplitude: f64, frequency: f64) -> Shake {
    let p = structure.block.frequency_parameter();
    let amplitude = amplitude * structure.geometry.uplift_threshold(structure.block.slenderness());
    let cycle = (sine(amplitude, frequency * p), core::f64::consts::TAU / (frequency * p));
    Shake { structure, pieces: std::vec![cycle], free_time: 12.0 / p }
}

/// Peaks of a machine, as those of a system, and another observer.
struct Watcher<'o> {
    other: &'o mut dyn Observer<f64>,
    peaks: Peaks<f64>,
    events: Vec<(Event, f64)>,
    last: BlockState<f64>,
    switches: Vec<(f64, BlockState<f64>, BlockState<f64>)>,
}

impl<'o> Watcher<'o> {
    fn new(other: &'o mut dyn Observer<f64>) -> Watcher<'o> {
        let (peaks, last) = (Peaks::default(), BlockState::default());
        Watcher { other, peaks, events: Vec::new(), last, switches: Vec::new() }
    }
}

impl Observer<f64> for Watcher<'_> {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let (rotation, velocity) = (interval.last.rotation, interval.last.velocity);
        self.last = BlockState { rotation, velocity, ..BlockState::default() };
        self.peaks.interval(output.motion(), interval);
        self.other.device_interval(output, interval);
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.other.device_at_rest(output, interval);
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        self.peaks.event(event, time, state);
        self.other.event(event, time, state);
        self.events.push((event, self.peaks.origin + time));
        if event == Event::Switch {
            self.switches.push((self.peaks.origin + time, self.last, *state));
        }
        self.last = *state;
    }

    fn accumulation(&mut self, tail: &Accumulation<f64>) {
        self.peaks.accumulation(tail);
        self.other.accumulation(tail);
    }

    fn device_bounce(&mut self, side: Sign, time: f64, snapshot: &dyn Fn() -> Snapshot<f64>) {
        self.other.device_bounce(side, time, snapshot);
    }
}

impl Shake {
    fn limits(&self, quiet: bool) -> Limits<f64> {
        let largest = |(ground, duration): &(AnySegment<f64>, f64)| ground.bound(*duration);
        let bound = if quiet { 0.0 } else { self.pieces.iter().map(largest).fold(0.0, f64::max) };
        let block = self.structure.loaded().unwrap().block;
        Limits { overturned: self.structure.geometry.point_of_no_return(block.slenderness(), bound), events: 100_000 }
    }

    /// Under the mirrored pulse.
    pub fn mirrored(&self) -> Shake {
        let mut mirrored = self.clone();
        if let (AnySegment::Sine(sine), _) = &mut mirrored.pieces[0] {
            sine.terms[0].amplitude = -sine.terms[0].amplitude;
        }
        mirrored
    }

    /// The ledger of its device with `drivetrain`.
    pub fn ledger(&self, drivetrain: &Drivetrain) -> Ledger<f64> {
        let account = Account {
            clutching: if drivetrain.engagement == Engagement::Ideal { Clutching::Ideal } else { Clutching::Real },
            mass_ratio: self.structure.device.mass_ratio,
            rack_mass_ratio: drivetrain.rack.guided_mass_ratio,
            on_support: drivetrain.support.moves(),
            ..Account::default()
        };
        Ledger::new(&self.structure.block, self.structure.geometry, &account)
    }

    /// By the loop for ideal devices.
    pub fn ideal(&self) -> Seen {
        struct Every(Peaks<f64>);
        impl Observer<f64> for Every {
            fn interval(&mut self, output: &dyn DenseOutput<f64>, interval: &MonotoneInterval<f64>) {
                self.0.interval(output, interval);
            }
            fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
                self.0.event(event, time, state);
            }
            fn accumulation(&mut self, tail: &Accumulation<f64>) {
                self.0.accumulation(tail);
            }
        }
        let system = self.structure.resolve().unwrap();
        let method = Taylor::<f64, 20>::adaptive(1e-17);
        let (mut state, mut peaks) = (BlockState::default(), Every(Peaks::default()));
        let mut origin = 0.0;
        for (ground, duration) in &self.pieces {
            peaks.0.origin = origin;
            system.advance(&method, &mut state, ground, *duration, &self.limits(false), &mut peaks).unwrap();
            origin += duration;
        }
        peaks.0.origin = origin;
        system.advance(&method, &mut state, &Harmonics::QUIET, self.free_time, &self.limits(true), &mut peaks).unwrap();
        let peaks = peaks.0;
        Seen {
            peak: peaks.rotation,
            acceleration: peaks.acceleration,
            impacts: state.impacts,
            ended: peaks.ended,
            state,
            ..Seen::default()
        }
    }

    /// By the loop for devices with a memory.
    pub fn machine<T: ModeIntegrator<f64>>(&self, drivetrain: &Drivetrain, method: &T) -> Seen {
        self.watched(drivetrain, method, &mut ())
    }

    /// The same, with a `watcher`.
    pub fn watched<T: ModeIntegrator<f64>>(&self, drivetrain: &Drivetrain, method: &T, watcher: &mut dyn Observer<f64>) -> Seen {
        self.follow(&drivetrain.resolve(&self.structure, false).unwrap(), method, watcher)
    }

    /// An elastic clutch by the exponential midpoint method.
    pub fn exponential(&self, drivetrain: &Drivetrain, step: f64) -> Seen {
        let machine = drivetrain.resolve(&self.structure, false).unwrap();
        assert!(machine.transmission.traits().springs, "not an elastic clutch");
        self.follow(&machine, &FixedStep { scheme: Scheme::ExponentialMidpoint, step }, &mut ())
    }

    fn follow<T: ModeIntegrator<f64>>(&self, machine: &HybridSystem<f64>, method: &T, other: &mut dyn Observer<f64>) -> Seen {
        let mut watcher = Watcher::new(other);
        let mut state: HybridState<f64> = machine.at_rest();
        for (ground, duration) in &self.pieces {
            let shaking = Shaking::level(ground);
            machine.advance(method, &mut state, shaking, *duration, &self.limits(false), &mut watcher).unwrap();
            watcher.peaks.origin += duration;
        }
        let shaking = Shaking::level(&Harmonics::QUIET);
        machine.advance(method, &mut state, shaking, self.free_time, &self.limits(true), &mut watcher).unwrap();
        let own = watcher;
        Seen {
            peak: own.peaks.rotation,
            acceleration: own.peaks.acceleration,
            impacts: state.motion.impacts,
            ended: own.peaks.ended,
            events: own.events,
            state: state.motion,
            spins: state.device.wheels.map(|wheel| wheel.spin),
            switches: own.switches,
        }
    }
}

/// Every kind of drivetrain, with losses where they belong.
pub fn drivetrains() -> [(&'static str, Drivetrain); 14] {
    let flywheel = FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.3, brake_deceleration: 5.0, drag_rate: 0.0 };
    let bearings = FlywheelLosses { brake_deceleration: 0.0, ..flywheel };
    let rack = Rack { guided_mass_ratio: 0.02, viscous: 0.05, dry_ratio: 0.004, ..Rack::default() };
    let guided = Rack { guided_mass_ratio: 0.02, ..Rack::default() };
    let of = |engagement, flywheel, rack| Drivetrain { engagement, flywheel, rack, ..Drivetrain::default() };
    let elastic = |backlash, capacity_ratio| Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash, capacity_ratio };
    let late = Actuation { engagement_delay: 0.02, ..Actuation::default() };
    [
        ("ideal with friction", of(Engagement::Ideal, bearings, rack)),
        ("rigid", of(Engagement::Rigid, flywheel, rack)),
        ("overrunning", of(Engagement::Overrunning, bearings, rack)),
        ("friction clutch", of(Engagement::Friction { capacity_ratio: 0.03 }, flywheel, rack)),
        (
            "elastic",
            of(
                Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash: 0.0, capacity_ratio: f64::INFINITY },
                flywheel,
                rack,
            ),
        ),
        ("elastic with play", of(elastic(2e-3, f64::INFINITY), flywheel, rack)),
        ("elastic with play and plates", of(elastic(2e-3, 0.03), flywheel, rack)),
        (
            "friction clutch of a coil",
            Drivetrain {
                actuation: Actuation { time_constant: 0.05, ..Actuation::default() },
                ..of(Engagement::Friction { capacity_ratio: 0.03 }, flywheel, rack)
            },
        ),
        ("ideal with load friction", of(Engagement::Ideal, bearings, Rack { load_friction: 0.1, ..rack })),
        ("rigid with load friction", of(Engagement::Rigid, flywheel, Rack { load_friction: 0.1, ..rack })),
        ("viscous slip", of(Engagement::Viscous { corner_frequency: 3.0 }, flywheel, rack)),
        (
            "rigid with drag",
            Drivetrain { actuation: late, ..of(Engagement::Rigid, FlywheelLosses { drag_rate: 0.4, ..flywheel }, rack) },
        ),
        (
            "friction clutch with drag",
            Drivetrain {
                actuation: late,
                ..of(Engagement::Friction { capacity_ratio: 0.03 }, FlywheelLosses { drag_rate: 1.0, ..bearings }, rack)
            },
        ),
        ("ideal on a moving support", Drivetrain { support: Support::amplified(1.3), rack: guided, ..Drivetrain::default() }),
    ]
}

pub fn pair(geometry: Geometry, amplitude: f64, frequency: f64) -> Shake {
    shake(structure(geometry, 15.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent), amplitude, frequency)
}

pub fn tight() -> Series<f64, 20> {
    Series::adaptive(1e-17)
}

/// With an ideal drivetrain it is a second program for the same model.
#[test]
fn ideal_devices_move_as_in_their_own_loop() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for kind in DeviceKind::ALL {
            for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
                for (amplitude, frequency) in [(1.5, 4.0), (3.0, 5.0), (6.0, 6.0), (1.2, 1.0)] {
                    let shake = shake(structure(geometry, 15.0, kind, 0.5, kinematics), amplitude, frequency);
                    let (own, other) = (shake.ideal(), shake.machine(&Drivetrain::default(), &tight()));
                    let what = std::format!("{geometry:?} {kind:?} {kinematics:?} a = {amplitude}, ω/p = {frequency}");
                    assert!((own.peak / other.peak - 1.0).abs() < 1e-11, "{what}: {} and {}", own.peak, other.peak);
                    assert!((own.acceleration / other.acceleration - 1.0).abs() < 1e-10, "{what}: θ̈");
                    assert_eq!(own.impacts, other.impacts, "{what}");
                    assert_eq!(own.state.phase, other.state.phase, "{what}");
                    match (own.ended, other.ended) {
                        (Some(a), Some(b)) => assert!((a / b - 1.0).abs() < 1e-9, "{what}: ends at {a} and {b}"),
                        (a, b) => assert_eq!(a.is_some(), b.is_some(), "{what}"),
                    }
                }
            }
        }
    }
}
