//! The drivetrain of a case in words.

use crate::CaseError;
use crate::codec::{Reader, Writer};
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack, Support};

pub(super) fn encode(drivetrain: &Drivetrain, out: &mut Writer<'_>) -> Result<(), CaseError> {
    let Drivetrain { engagement, flywheel, rack, actuation, support } = drivetrain;
    let (kind, numbers) = match *engagement {
        Engagement::Ideal => (0, [0.0; 4]),
        Engagement::Rigid => (1, [0.0; 4]),
        Engagement::Overrunning => (2, [0.0; 4]),
        Engagement::Friction { capacity_ratio } => (3, [0.0, 0.0, 0.0, capacity_ratio]),
        Engagement::Elastic { stiffness, damping, backlash, capacity_ratio } => {
            (4, [stiffness, damping, backlash, capacity_ratio])
        }
        Engagement::Viscous { corner_frequency } => (5, [0.0, corner_frequency, 0.0, 0.0]),
    };
    out.word(kind)?;
    out.numbers(&numbers)?;
    out.numbers(&[flywheel.viscous_rate, flywheel.dry_deceleration, flywheel.brake_deceleration])?;
    out.numbers(&[rack.guided_mass_ratio, rack.viscous, rack.dry_ratio])?;
    let Actuation { engagement_delay, release_delay, delay, rise_time, time_constant, dwell, miss_probability, miss_seed } =
        *actuation;
    out.numbers(&[engagement_delay, release_delay, rise_time, dwell, miss_probability])?;
    out.word(miss_seed as u32)?;
    out.word((miss_seed >> 32) as u32)?;
    out.word(u32::from(delay == Delay::Transport))?;
    out.numbers(&[support.amplification, time_constant, rack.load_friction, flywheel.drag_rate])
}

pub(super) fn decode(input: &mut Reader<'_>) -> Result<Drivetrain, CaseError> {
    let kind = input.kind("engagement", &[0, 1, 2, 3, 4, 5])?;
    let (stiffness, damping) = (input.number("stiffness")?, input.number("damping")?);
    let (backlash, capacity_ratio) = (input.number("backlash")?, input.number("capacity_ratio")?);
    let engagement = match kind {
        0 => Engagement::Ideal,
        1 => Engagement::Rigid,
        2 => Engagement::Overrunning,
        3 => Engagement::Friction { capacity_ratio },
        5 => Engagement::Viscous { corner_frequency: damping },
        _ => Engagement::Elastic { stiffness, damping, backlash, capacity_ratio },
    };
    let flywheel = FlywheelLosses {
        viscous_rate: input.number("viscous_rate")?,
        dry_deceleration: input.number("dry_deceleration")?,
        brake_deceleration: input.number("brake_deceleration")?,
        drag_rate: 0.0,
    };
    let rack = Rack {
        guided_mass_ratio: input.number("guided_mass_ratio")?,
        viscous: input.number("rack viscous")?,
        dry_ratio: input.number("rack dry_ratio")?,
        load_friction: 0.0,
    };
    let actuation = Actuation {
        engagement_delay: input.number("engagement_delay")?,
        release_delay: input.number("release_delay")?,
        delay: Delay::Inertial,
        rise_time: input.number("rise_time")?,
        time_constant: 0.0,
        dwell: input.number("dwell")?,
        miss_probability: input.number("miss_probability")?,
        miss_seed: u64::from(input.word("miss_seed")?) | u64::from(input.word("the upper half of miss_seed")?) << 32,
    };
    let delay = input.kind("delay", &[Delay::Inertial, Delay::Transport])?;
    let support = Support::amplified(input.number("support_amplification")?);
    let time_constant = input.number("time_constant")?;
    let rack = Rack { load_friction: input.number("load_friction")?, ..rack };
    let flywheel = FlywheelLosses { drag_rate: input.number("drag_rate")?, ..flywheel };
    Ok(Drivetrain { engagement, flywheel, rack, actuation: Actuation { delay, time_constant, ..actuation }, support })
}
