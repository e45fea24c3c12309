//! The way of the force from the rack to a flywheel: what a real device adds to the paper's ideal one.
//!
//! Parameters only, in SI units per mass of the block, so that they scale with nothing; what each effect does to the
//! motion is in the file of its name.

use super::error::{ParameterError, require};

/// Which forces the rack meets, whatever the clutch does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rack {
    /// Mass of a rack that rides along on guides of the support, over the block's mass; 0 to 10. Its weight rests on the
    /// support; its inertia acts along the terminals' travel.
    pub guided_mass_ratio: f64,
    /// Viscous force over the block's mass and the terminals' velocity, 1/s; 0 to 1000.
    pub viscous: f64,
    /// Dry friction over the block's weight; 0 to 10.
    pub dry_ratio: f64,
    /// Friction of rack and pinion over the force of a locked flywheel in their mesh; 0 to below 1.
    pub load_friction: f64,
}

/// The wall or frame that carries the device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    /// f = ü_s/ü_g, its horizontal acceleration at the device over the ground's; -10 to 10, 1 where it moves with the ground.
    pub amplification: f64,
    /// Its motion is no such factor of the ground's, but given beside it ([`Shaking::support`]).
    ///
    /// [`Shaking::support`]: crate::motion::hybrid::mode_output::Shaking::support
    pub given_apart: bool,
}

impl Support {
    /// One that moves horizontally with `factor` times the ground's acceleration.
    pub fn amplified(factor: f64) -> Support {
        Support { amplification: factor, given_apart: false }
    }

    /// Whether it moves otherwise than the ground.
    pub fn moves(&self) -> bool {
        *self != Support::default()
    }

    /// One whose motion is given beside the ground's.
    pub const MOVING: Support = Support { amplification: 1.0, given_apart: true };
}

impl Default for Support {
    fn default() -> Support {
        Support::amplified(1.0)
    }
}

/// What slows a flywheel down. Speeds and decelerations are those of a rack that moves with it: flywheel radius and gears are
/// in the inertance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlywheelLosses {
    /// Viscous: an idle flywheel slows down as e^(-rate t). 1/s; 0 to 1e6.
    pub viscous_rate: f64,
    /// Dry (Coulomb) friction of the bearings: deceleration of an idle flywheel, m/s²; 0 to 1e6.
    pub dry_deceleration: f64,
    /// Deceleration by a brake that acts while the clutch is open, m/s²; 0 to 1e9, or infinite: stopped at once.
    pub brake_deceleration: f64,
    /// Viscous drag of the open clutch, c over the inertance: a released flywheel nears the speed of a steady rack as e^(-rate t), and the
    /// rack meets c times the difference of the speeds. 1/s; 0 to 1000. Of a rigid clutch or plates with a delay, without an infinite brake.
    pub drag_rate: f64,
}

/// Coupling of a flywheel to the rack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Engagement {
    /// The paper's: a stopped flywheel is engaged at speed without a loss of momentum, and stops at once when released.
    #[default]
    Ideal,
    /// A rigid clutch that obeys Eq. 10: at engagement block and flywheel exchange momentum.
    Rigid,
    /// A one-way (sprag) clutch that obeys nobody: it holds when the block catches up with the flywheel and lets go when
    /// the flywheel would drive the block.
    Overrunning,
    /// A friction clutch that obeys Eq. 10 and slips above its capacity.
    Friction {
        /// Largest force at the rack over the block's weight; above 0, to 1e6.
        capacity_ratio: f64,
    },
    /// A clutch with a torsional spring, a damper and gear play, that obeys Eq. 10.
    Elastic {
        /// Stiffness at the rack over the block's mass, 1/s²; above 0, to 1e12.
        stiffness: f64,
        /// Damping at the rack over the block's mass, 1/s; 0 to 1e6.
        damping: f64,
        /// Backlash at the rack, m, from contact to contact; 0 to 1.
        backlash: f64,
        /// Largest force at the rack over the block's weight; above 0, or infinite.
        capacity_ratio: f64,
    },
    /// Viscous slip between rack and flywheel, of a clutch that obeys Eq. 10 or of a single inerter: its inertance falls with frequency, as
    /// 1/√(1 + (f/f_c)²).
    Viscous {
        /// Corner f_c: the dashpot over 2π times the inertance, Hz; above 0, to 1000.
        corner_frequency: f64,
    },
}

/// What becomes of a command that another one follows before its delay is over; the two delays of hardware description languages
/// (IEEE 1076).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Delay {
    /// It is lost, as with a coil: its current must build up or decay before the armature moves, and one that is cut short never moves it.
    #[default]
    Inertial,
    /// Every command takes effect after its delay, in order, as over a link or by a valve at the far end of a line.
    Transport,
}

/// What lies between a command and a clutch that has obeyed it. Ideal: all zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuation {
    /// From the command to engagement, s; 0 to 10.
    pub engagement_delay: f64,
    /// From the command to release, s; 0 to 10.
    pub release_delay: f64,
    /// Whether these two are inertial.
    pub delay: Delay,
    /// From first contact to full capacity, linearly, s; 0 to 10. Needs a capacity.
    pub rise_time: f64,
    /// Time constant of a capacity that rises as 1 − e^(−t/τ), s; 0 to 10, and 0 beside a linear rise. Needs a capacity.
    pub time_constant: f64,
    /// A clutch that has just moved stays so for this long, s; 0 to 10.
    pub dwell: f64,
    /// Probability that an engagement is missed; 0 to 1.
    pub miss_probability: f64,
    /// Seed of the engagements that miss.
    pub miss_seed: u64,
}

/// All of it. The default is the paper's ideal device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drivetrain {
    /// Coupling of the flywheels.
    pub engagement: Engagement,
    /// Losses of the flywheels.
    pub flywheel: FlywheelLosses,
    /// Losses and mass of the rack.
    pub rack: Rack,
    /// Delays of the clutch.
    pub actuation: Actuation,
    /// What carries it.
    pub support: Support,
}

impl Drivetrain {
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn check(&self) -> Result<(), ParameterError> {
        let within = |name, value: f64, most: f64, range| require(name, value, (0.0..=most).contains(&value), range).map(|_| ());
        let Drivetrain { flywheel, rack, actuation, support, .. } = self;
        within("guided_mass_ratio", rack.guided_mass_ratio, 10.0, "from 0 to 10")?;
        within("rack viscous", rack.viscous, 1e3, "from 0 to 1000 1/s")?;
        within("rack dry_ratio", rack.dry_ratio, 10.0, "from 0 to 10")?;
        let load = rack.load_friction;
        // From 1 on no flywheel could drive the rack, and its force might have either sign.
        require("load_friction", load, (0.0..1.0).contains(&load), "from 0 to below 1")?;
        let locks = matches!(self.engagement, Engagement::Ideal | Engagement::Rigid);
        require("load_friction", load, load == 0.0 || locks, "0 with a clutch that is neither ideal nor rigid")?;
        within("viscous_rate", flywheel.viscous_rate, 1e6, "from 0 to 1e6 1/s")?;
        within("dry_deceleration", flywheel.dry_deceleration, 1e6, "from 0 to 1e6 m/s²")?;
        if flywheel.brake_deceleration != f64::INFINITY {
            within("brake_deceleration", flywheel.brake_deceleration, 1e9, "from 0 to 1e9 m/s², or infinite")?;
        }
        let drag = flywheel.drag_rate;
        within("drag_rate", drag, 1e3, "from 0 to 1000 1/s")?;
        let opens = matches!(self.engagement, Engagement::Rigid | Engagement::Friction { .. });
        require("drag_rate", drag, drag == 0.0 || opens, "0 1/s with a clutch that is neither rigid nor one of plates")?;
        let brake = flywheel.brake_deceleration;
        require("drag_rate", drag, drag == 0.0 || brake.is_finite(), "0 1/s beside an infinite brake")?;
        require("drag_rate", drag, drag == 0.0 || load == 0.0, "0 1/s beside friction that grows with load")?;
        // At a turn Eq. 10 would engage a flywheel that drag has turned the wrong way, which turns the block about, and release it at the
        // same instant, over and over.
        let late = actuation.engagement_delay > 0.0 || actuation.release_delay > 0.0;
        require("drag_rate", drag, drag == 0.0 || late, "0 1/s with a clutch without a delay")?;
        if self.engagement == Engagement::Overrunning {
            // The block would catch up with a braked flywheel at once and be braked through it.
            within("brake_deceleration", flywheel.brake_deceleration, 0.0, "0 m/s² for an overrunning clutch")?;
        }
        let amplification = support.amplification;
        require("support_amplification", amplification, (-10.0..=10.0).contains(&amplification), "from -10 to 10")?;
        if support.moves() {
            // Only ideal devices without friction know its speed ([`crate::drivetrain::on_support`]).
            let asks = self.engagement != Engagement::Ideal
                || *flywheel != FlywheelLosses::default()
                || rack.viscous != 0.0
                || rack.dry_ratio != 0.0
                || rack.load_friction != 0.0;
            let moves = support.given_apart;
            require(
                "support_amplification",
                amplification,
                moves || !asks,
                "1 with friction or a flywheel that keeps its speed",
            )?;
            require("support_motion", 1.0, !moves || !asks, "none with friction or a flywheel that keeps its speed")?;
            require("support_amplification", amplification, !moves || amplification == 1.0, "1 beside a support's own motion")?;
        }
        let capacity = |ratio: f64| require("capacity_ratio", ratio, ratio > 0.0 && ratio <= 1e6, "above 0, to 1e6").map(|_| ());
        match self.engagement {
            Engagement::Friction { capacity_ratio } => capacity(capacity_ratio)?,
            Engagement::Elastic { stiffness, damping, backlash, capacity_ratio } => {
                require("stiffness", stiffness, stiffness > 0.0 && stiffness <= 1e12, "above 0, to 1e12 1/s²")?;
                within("damping", damping, 1e6, "from 0 to 1e6 1/s")?;
                within("backlash", backlash, 1.0, "from 0 to 1 m")?;
                if capacity_ratio != f64::INFINITY {
                    capacity(capacity_ratio)?;
                }
            }
            Engagement::Viscous { corner_frequency: corner } => {
                require("corner_frequency", corner, corner > 0.0 && corner <= 1e3, "above 0, to 1000 Hz")?;
            }
            Engagement::Ideal | Engagement::Rigid | Engagement::Overrunning => {}
        }
        for (name, value) in [
            ("engagement_delay", actuation.engagement_delay),
            ("release_delay", actuation.release_delay),
            ("rise_time", actuation.rise_time),
            ("time_constant", actuation.time_constant),
            ("dwell", actuation.dwell),
        ] {
            within(name, value, 10.0, "from 0 to 10 s")?;
        }
        let rises_twice = actuation.rise_time > 0.0 && actuation.time_constant > 0.0;
        require("time_constant", actuation.time_constant, !rises_twice, "0 s beside a linear rise")?;
        within("miss_probability", actuation.miss_probability, 1.0, "from 0 to 1")
    }
}
