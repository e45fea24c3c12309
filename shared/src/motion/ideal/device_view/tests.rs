use super::*;
use crate::drivetrain::transmission::Spent;
use crate::ground::{Harmonics, Linear};
use crate::math::sign::Sign;
use crate::method::taylor::Taylor;
use crate::motion::ideal::IdealSystem;
use crate::motion::state::Limits;
use crate::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use crate::structure::device::{Device, DeviceKind, KinematicsKind};
use crate::structure::mount::Mount;
use crate::structure::{Restitution, Structure};
use std::vec::Vec;

/// A ground segment of a test.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shake {
    Sine(Harmonics<f64, 1>),
    Line(Linear<f64>),
}

impl GroundSegment<f64> for Shake {
    fn acceleration(&self, time: f64) -> f64 {
        match self {
            Shake::Sine(sine) => sine.acceleration(time),
            Shake::Line(line) => line.acceleration(time),
        }
    }

    fn slope(&self, time: f64) -> f64 {
        match self {
            Shake::Sine(sine) => sine.slope(time),
            Shake::Line(line) => line.slope(time),
        }
    }

    fn gain(&self, time: f64) -> f64 {
        match self {
            Shake::Sine(sine) => sine.gain(time),
            Shake::Line(line) => GroundSegment::gain(line, time),
        }
    }

    fn curvature_bound(&self) -> f64 {
        match self {
            Shake::Sine(sine) => sine.curvature_bound(),
            Shake::Line(line) => GroundSegment::<f64>::curvature_bound(line),
        }
    }

    fn series(&self, time: f64, coefficients: &mut [f64]) {
        match self {
            Shake::Sine(sine) => sine.series(time, coefficients),
            Shake::Line(line) => line.series(time, coefficients),
        }
    }
}

/// A cycle of sine of `amplitude` times g α at ω/p = `ratio`, then quiet for `free` (1/p).
pub(crate) fn pulse(block: &Block, amplitude: f64, ratio: f64, free: f64) -> Vec<(Shake, f64)> {
    let p = block.frequency_parameter();
    let sine = Harmonics::sine(amplitude * block.slenderness(), ratio * p);
    let cycle = core::f64::consts::TAU / (ratio * p);
    [(Shake::Sine(sine), cycle), (Shake::Line(Linear::constant(0.0)), free / p)].into()
}

/// Noise between straight lines, 0.02 s apart, growing and fading over 12 s to a largest sample of `peak` g, then quiet.
pub(crate) fn pseudo_record(peak: f64) -> Vec<(Shake, f64)> {
    let mut seed = 20_190_u32;
    let mut colour = 0.0;
    let samples: Vec<f64> = (0..600)
        .map(|i| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            colour = 0.9 * colour + (f64::from(seed) / f64::from(u32::MAX) - 0.5);
            let x = i as f64 / 599.0;
            colour * 6.75 * x * (1.0 - x) * (1.0 - x)
        })
        .collect();
    let scale = peak / samples.iter().fold(0.0_f64, |most, sample| most.max(sample.abs()));
    let lines = samples.windows(2).map(|pair| (Shake::Line(Linear::between(scale * pair[0], scale * pair[1], 0.02)), 0.02));
    lines.chain([(Shake::Line(Linear::constant(0.0)), 5.0)]).collect()
}

/// A rectangle of R = 2 m with `degrees` of slenderness and σ = 0.5 on `mount`.
pub(crate) fn structure(
    degrees: f64,
    geometry: Geometry,
    kind: DeviceKind,
    kinematics: KinematicsKind,
    mount: Mount,
) -> Structure {
    Structure {
        geometry,
        device: Device { kind, mass_ratio: 0.5, mount, kinematics },
        ..Structure::new(Block::new(2.0, degrees.to_radians(), RECTANGLE_INERTIA_RATIO).unwrap(), Restitution::Constant(0.85))
    }
}

/// An observer that may want to know when a ground segment starts.
pub(crate) trait Placed: Observer<f64> {
    fn place(&mut self, _origin: f64) {}
}

/// Runs a structure over ground segments, from rest or from θ and θ̇.
pub(crate) struct Run<'a, O> {
    pub structure: &'a Structure,
    pub ground: &'a [(Shake, f64)],
    pub from: Option<(f64, f64)>,
    pub observer: O,
}

impl<O: Placed> Run<'_, O> {
    pub(crate) fn go(self) -> (BlockState<f64>, O) {
        let system: IdealSystem<f64> = self.structure.resolve().unwrap();
        let Run { structure, ground, from, mut observer } = self;
        let coupling = structure.device.mass_ratio / structure.block.inertia_ratio();
        let overturned = match structure.geometry {
            Geometry::Full => core::f64::consts::FRAC_PI_2,
            Geometry::Slender => 4.0 * structure.block.slenderness(),
        };
        let limits = Limits { overturned, events: 1_000_000 };
        let mut state = match from {
            Some((rotation, velocity)) => system.released_at(rotation, velocity, ground[0].0.acceleration(0.0)),
            None => BlockState::default(),
        };
        let method = Taylor::<f64, 20>::adaptive(1e-17);
        let mut origin = 0.0;
        for (segment, duration) in ground {
            observer.place(origin);
            let mut watched =
                Watched { engaged: system.engaged, clutch: system.clutch, coupling, segment: *segment, observer: &mut observer };
            system.advance(&method, &mut state, segment, *duration, &limits, &mut watched).unwrap();
            origin += duration;
        }
        (state, observer)
    }
}

/// Looks at the middle of every interval.
#[derive(Default)]
struct Looks(Vec<(MonotoneInterval<f64>, Snapshot<f64>, f64)>);

impl Placed for Looks {}

impl Observer<f64> for Looks {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let time = 0.5 * (interval.from + interval.to);
        let step = 1e-5_f64.min(0.4 * (interval.to - interval.from));
        let energy = |t: f64| {
            let snapshot = output.snapshot(t);
            0.5 * snapshot.motion.velocity * snapshot.motion.velocity + snapshot.device.stored
        };
        let rate = (energy(time + step) - energy(time - step)) / (2.0 * step);
        self.0.push((*interval, output.snapshot(time), rate));
    }
}

const MOUNTS: [Mount; 3] =
    [Mount::CentreOfMass, Mount::TyingPoint { height: 3.0, pulley_ratio: 1.5 }, Mount::BaseCorners { pulley_ratio: 4.0 }];

/// θ̈ with the block's own equation and the force on the rack must be that of the dense output, and block and flywheel must gain what
/// weight and ground do to them plus what the kinematics give.
#[test]
fn force_energy_and_what_the_kinematics_take_fit_the_motion() {
    for geometry in [Geometry::Full, Geometry::Slender] {
        for kind in DeviceKind::ALL {
            for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
                for mount in MOUNTS {
                    let structure = structure(12.0, geometry, kind, kinematics, mount);
                    let ground = pulse(&structure.block, 2.5, 4.0, 6.0);
                    let (_, looks) = Run { structure: &structure, ground: &ground, from: None, observer: Looks::default() }.go();
                    check(&structure, &looks.0);
                }
            }
        }
    }
}

fn check(structure: &Structure, looks: &[(MonotoneInterval<f64>, Snapshot<f64>, f64)]) {
    let (p2, alpha) = (structure.block.frequency_parameter_squared(), structure.block.slenderness());
    let Structure { geometry, device, .. } = structure;
    let mut worked = 0;
    for (interval, snapshot, rate) in looks.iter().filter(|(interval, ..)| interval.to - interval.from > 1e-3) {
        let side: f64 = interval.side.unit();
        let delta = alpha * side - snapshot.motion.rotation;
        let (sin, cos) = if *geometry == Geometry::Full { crate::math::sin_cos(delta) } else { (delta, 1.0) };
        let moment = -p2 * (sin + snapshot.ground[0] * cos);
        let lever = device.mount.lever_at(&structure.block, *geometry, snapshot.motion.rotation).unwrap();
        let force = snapshot.device.force[0] + snapshot.device.force[1];
        assert!((moment - lever * force - snapshot.motion.acceleration).abs() < 1e-12 * p2, "{structure:?} {interval:?}");
        let power = moment * snapshot.motion.velocity - snapshot.device.spent.kinematics;
        assert!((rate - power).abs() < 1e-7 * p2, "{structure:?} {interval:?}: {rate} {power}");
        let wheel = usize::from(device.kind == DeviceKind::ClutchedPair && interval.direction == Sign::Negative);
        assert!(force == snapshot.device.force[wheel] && !snapshot.device.engaged[1 - wheel]);
        assert_eq!(snapshot.device.engaged[wheel], interval.engaged && device.kind != DeviceKind::None);
        if snapshot.device.engaged[wheel] {
            worked += 1;
            assert!((snapshot.device.spin[wheel] - lever * snapshot.motion.velocity).abs() < 1e-14);
            // A working flywheel of the pair resists.
            assert!(device.kind == DeviceKind::Inerter || force * snapshot.device.spin[wheel] >= 0.0);
            let gives = *geometry == Geometry::Full && device.kinematics == KinematicsKind::Paper;
            assert_eq!(snapshot.device.spent.kinematics != 0.0, gives);
        } else {
            assert!(snapshot.device.stored == 0.0 && snapshot.device.spent == Spent::default());
        }
    }
    assert_eq!(worked > 0, device.kind != DeviceKind::None);
}
