//! The words of a case, in order: 52 for the scene, then its ground motion. Numbers are the bits of an f32 in SI units;
//! kinds count from 0 in the order in which their types list them. What a kind does not need is written as 0 and not looked
//! at.
//!
//! | words | what |
//! | --- | --- |
//! | 0, 1 | [`MAGIC`], [`VERSION`] |
//! | 2-5 | size R, slenderness α, inertia ratio λ, geometry (kind) |
//! | 6-11 | device (kind), mass ratio σ, mount (kind), height, pulley ratio, kinematics (kind) |
//! | 12, 13 | carried mass ratio μ, its height |
//! | 14-18 | engagement (kind), stiffness, damping (viscous slip: corner frequency), backlash, capacity ratio |
//! | 19-21 | flywheels: viscous rate, dry deceleration, brake deceleration |
//! | 22-24 | rack: guided mass ratio, viscous, dry ratio |
//! | 25-29 | actuation: engagement delay, release delay, rise time, dwell, miss probability |
//! | 30, 31 | its miss seed, lower and upper half |
//! | 32 | its delay (kind) |
//! | 33-36 | support: amplification; actuation: time constant; rack: load friction; flywheels: drag rate |
//! | 37-39 | restitution (0 given, 1 geometric, 2 momentum balance), η, rest speed |
//! | 40-42 | its scatter: deviation, and seed, lower and upper half |
//! | 43-45 | initially (0 rest, 1 released), θ, θ̇ |
//! | 46-48 | method (kind), step, free time |
//! | 49-51 | ground (0 pieces, 1 record); number of pieces or of samples; vertical motion (0 none, 1 there) |
//! | 52- | pieces: 11 words each, shape (kind), duration, and nine numbers of the shape; record: interval, samples |
//! | then | the vertical motion: 10 words for each piece, shape and nine numbers; or as many samples |

use crate::codec::{Reader, Writer};
use crate::{Case, CaseError, FixedMethod, Initially, drivetrain_words, ground_words};
use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::restitution::Restitution;
use sprag_shared::structure::{Base, RestitutionScatter, Structure};

/// "CASE", to be distinguished from other files.
pub const MAGIC: u32 = u32::from_le_bytes(*b"CASE");

/// Of the words' meaning.
pub const VERSION: u32 = 9;

impl<'a> Case<'a> {
    /// Writes the case to the front of `words` and gives the number of words. Numbers are rounded to single precision.
    ///
    /// # Errors
    /// [`CaseError::Full`].
    pub fn encode(&self, words: &mut [u32]) -> Result<usize, CaseError> {
        let mut out = Writer { words, count: 0 };
        out.word(MAGIC)?;
        out.word(VERSION)?;
        let Structure { block, geometry, device, added_mass, restitution, restitution_scatter, base, rest_speed } =
            &self.structure;
        base.is_rigid()?;
        out.numbers(&[block.size(), block.slenderness(), block.inertia_ratio()])?;
        out.word(*geometry as u32)?;
        out.word(device.kind as u32)?;
        out.number(device.mass_ratio)?;
        let (mount, height, pulley_ratio) = match device.mount {
            Mount::CentreOfMass => (0, 0.0, 0.0),
            Mount::TyingPoint { height, pulley_ratio } => (1, height, pulley_ratio),
            Mount::BaseCorners { pulley_ratio } => (2, 0.0, pulley_ratio),
        };
        out.word(mount)?;
        out.numbers(&[height, pulley_ratio])?;
        out.word(device.kinematics as u32)?;
        out.numbers(&[added_mass.mass_ratio, added_mass.height])?;
        drivetrain_words::encode(&self.drivetrain, &mut out)?;
        let (rule, eta) = match *restitution {
            Restitution::Constant(eta) => (0, eta),
            Restitution::Geometric => (1, 0.0),
            Restitution::MomentumBalance => (2, 0.0),
        };
        out.word(rule)?;
        out.numbers(&[eta, *rest_speed, restitution_scatter.deviation])?;
        out.word(restitution_scatter.seed as u32)?;
        out.word((restitution_scatter.seed >> 32) as u32)?;
        let (released, rotation, velocity) = match self.initially {
            Initially::Rest => (0, 0.0, 0.0),
            Initially::Released { rotation, velocity } => (1, rotation, velocity),
        };
        out.word(released)?;
        out.single(rotation)?;
        out.single(velocity)?;
        out.word(self.method as u32)?;
        out.single(self.step)?;
        out.single(self.free_time)?;
        ground_words::encode(&self.ground, &mut out)?;
        Ok(out.count)
    }

    /// The case that `words` hold, all of them and no more. Whether its numbers make sense is found by [`Case::run`].
    ///
    /// # Errors
    /// [`CaseError`] names the first word that is wrong or missing.
    pub fn decode(words: &'a [u32]) -> Result<Case<'a>, CaseError> {
        let mut input = Reader(words);
        let magic = input.word("the first word")?;
        if magic != MAGIC {
            return Err(CaseError::Magic(magic));
        }
        let version = input.word("the version")?;
        if version != VERSION {
            return Err(CaseError::Version(version));
        }
        let block = Block::new(input.number("size")?, input.number("slenderness")?, input.number("inertia_ratio")?)?;
        let geometry = input.kind("geometry", &[Geometry::Full, Geometry::Slender])?;
        let kind = input.kind("device", &DeviceKind::ALL)?;
        let mass_ratio = input.number("mass_ratio")?;
        let mount = input.kind("mount", &[0, 1, 2])?;
        let (height, pulley_ratio) = (input.number("height")?, input.number("pulley_ratio")?);
        let mount = match mount {
            0 => Mount::CentreOfMass,
            1 => Mount::TyingPoint { height, pulley_ratio },
            _ => Mount::BaseCorners { pulley_ratio },
        };
        let kinematics = input.kind("kinematics", &[KinematicsKind::Paper, KinematicsKind::Consistent])?;
        let added_mass = AddedMass { mass_ratio: input.number("carried mass_ratio")?, height: input.number("carried height")? };
        let drivetrain = drivetrain_words::decode(&mut input)?;
        let rule = input.kind("restitution", &[0, 1, 2])?;
        let eta = input.number("restitution")?;
        let restitution = match rule {
            0 => Restitution::Constant(eta),
            1 => Restitution::Geometric,
            _ => Restitution::MomentumBalance,
        };
        let rest_speed = input.number("rest_speed")?;
        let restitution_scatter = RestitutionScatter {
            deviation: input.number("restitution_scatter")?,
            seed: u64::from(input.word("restitution_seed")?) | u64::from(input.word("the upper half of restitution_seed")?) << 32,
        };
        let released = input.kind("start", &[false, true])?;
        let (rotation, velocity) = (input.single("rotation")?, input.single("velocity")?);
        let methods =
            [FixedMethod::SemiImplicitEuler, FixedMethod::RungeKutta4, FixedMethod::Taylor, FixedMethod::ExponentialMidpoint];
        let method = input.kind("method", &methods)?;
        let (step, free_time) = (input.single("step")?, input.single("free_time")?);
        let ground = ground_words::decode(&mut input)?;
        if !input.0.is_empty() {
            return Err(CaseError::Trailing(input.0.len() as u32));
        }
        let device = Device { kind, mass_ratio, mount, kinematics };
        let structure =
            Structure { block, geometry, device, added_mass, restitution, restitution_scatter, base: Base::Rigid, rest_speed };
        let initially = if released { Initially::Released { rotation, velocity } } else { Initially::Rest };
        Ok(Case { structure, drivetrain, initially, method, step, ground, free_time })
    }
}
