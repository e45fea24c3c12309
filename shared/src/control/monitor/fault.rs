//! What can go wrong with the controller's sensors, clutches and timing, as numbers that keep their meaning, and how it is recovered from.

use crate::control::sensing::sensor::Sensor;
use core::fmt;
use serde::{Deserialize, Serialize};

/// One of the two clutched flywheels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Wheel {
    /// Index 0 in arrays over clutches.
    First,
    /// Index 1.
    Second,
}

impl Wheel {
    /// Each, in the order of arrays over clutches.
    pub const ALL: [Wheel; 2] = [Wheel::First, Wheel::Second];

    /// The other one.
    pub fn other(self) -> Wheel {
        if self == Wheel::First { Wheel::Second } else { Wheel::First }
    }

    /// The commands that engage this one alone.
    pub fn alone(self) -> [bool; 2] {
        [self == Wheel::First, self == Wheel::Second]
    }
}

impl fmt::Display for Wheel {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(if *self == Wheel::First { "first" } else { "second" })
    }
}

/// Place of an inertial part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Place {
    /// On the block.
    Block,
    /// On the ground.
    Ground,
}

impl Place {
    /// Each, in the order of arrays over inertial parts.
    pub const ALL: [Place; 2] = [Place::Block, Place::Ground];
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(if *self == Place::Block { "block" } else { "ground" })
    }
}

/// A fault, or the occasion of a warning. Two sensors that disagree do not show which of them is wrong: the sensor of a contradiction is the
/// likelier one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "u16", try_from = "u16")]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Fault {
    /// No new reading in time.
    Stale(Sensor),
    /// New readings, all alike, where they cannot be; for the encoder, the same count while the gyroscope says that it must change.
    Stuck(Sensor),
    /// At full scale for longer than an impact lasts; for the encoder, beyond the rack's travel.
    Saturated(Sensor),
    /// NaN or infinite.
    NotFinite(Sensor),
    /// Against another sensor, or against gravity at rest.
    Contradiction(Sensor),
    /// It reports to be engaged and shall be open.
    ClutchEngagedUnbidden(Wheel),
    /// It reports to be open and shall be engaged.
    ClutchRefuses(Wheel),
    /// Both report to be engaged, which the device does not allow; as a warning, the law asked for both.
    BothClutches,
    /// It did not follow its test pulse.
    SelfTestFailed(Wheel),
    /// Its coil takes more current than a whole one.
    OverCurrent(Wheel),
    /// Its coil's high-side switch conducts though it is off.
    HighSideClosed(Wheel),
    /// Its coil's low-side switch conducts though it is off.
    LowSideClosed(Wheel),
    /// Its coil's current is not what supply and resistance make it.
    WrongCurrent(Wheel),
    /// Ticks come too late.
    Overrun,
    /// The estimate is NaN or infinite though the sensors are not.
    EstimateNotFinite,
    /// Nobody has stored settings of its own in the device: it would be guessing which structure it is on.
    NotCommissioned,
    /// Reset after reset, without a second of good work between them: it has given up the settings in flash.
    GivenUp,
    /// The program in flash is not what was sealed.
    ImageDamaged,
    /// A word of memory does not hold what is written to it.
    MemoryDamaged,
    /// The crystal's rate is off.
    ClockWrong,
    /// Settings or controller in memory are not what they were when they came into force.
    SettingsDamaged,
    /// Only a warning: nothing shows whether the program in flash is whole.
    NotSealed,
    /// Only a warning: a newer firmware has run on this board.
    OlderFirmware,
    /// Only a warning: armed with the last biases, for lack of stillness.
    CalibrationAbandoned,
    /// Only a warning: the clutches were not tested, for lack of stillness.
    SelfTestAbandoned,
    /// Only a warning: the clutches are commanded more often than a motion asks for.
    CommandsTooMany,
    /// Only a warning: it closes by a third sooner or later than it should.
    ClosingTimeChanged(Wheel),
    /// Only a warning: the inertial part answered its own self-test otherwise than in the factory.
    AnswersWrongly(Place),
    /// Only a warning: the inertial parts were not tested, for lack of stillness or of time.
    PartsUntested,
    /// Only a warning: the accelerometer at rest is so far from 1 g that its range must be another.
    ScaleWrong(Place),
    /// Only a warning: the coils' supply is lower than the pull-in time was measured with.
    SupplyLow,
    /// Only a warning: it is colder or hotter than where the pull-in time was measured.
    TemperatureUnusual,
}

/// A fault travels as its code.
impl From<Fault> for u16 {
    fn from(fault: Fault) -> u16 {
        fault.code()
    }
}

impl TryFrom<u16> for Fault {
    type Error = NoFault;

    fn try_from(code: u16) -> Result<Fault, NoFault> {
        Fault::from_code(code).ok_or(NoFault)
    }
}

/// A number that is no fault's code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoFault;

impl fmt::Display for NoFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("no fault has this code")
    }
}

/// How the controller comes back from a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// By itself, once every required sensor has been good for the recovery time and the block does not rock, through a new calibration.
    WhenGood,
    /// On request, at rest only, through a new self-test.
    OnRequest,
    /// Once settings have been stored in the device, through a new start.
    ByStoring,
    /// By a new start that does not find it again: the part is broken, or was disturbed.
    ByStart,
    /// It never was more than a warning.
    NotNeeded,
}

/// Makes a list of faults and their codes into [`Fault::ALL`] and both directions of [`Fault::code`]. A fault that is missing from the list
/// does not compile.
macro_rules! codes {
    ($($code:literal $fault:ident $(($part:ident::$which:ident))?;)*) => {
        impl Fault {
            /// Every fault there is.
            pub const ALL: [Fault; [$($code),*].len()] = [$(Fault::$fault $(($part::$which))?),*];

            /// A number for logs and telegrams, of two digits: the sensor (1 to 4) and what it did, 5x a clutch, 6x the controller itself,
            /// 7x and 9x a warning, 8x a clutch's coil. Numbers are never given anew.
            pub fn code(self) -> u16 {
                match self {
                    $(Fault::$fault $(($part::$which))? => $code,)*
                }
            }

            /// The fault of a [`Fault::code`].
            pub fn from_code(code: u16) -> Option<Fault> {
                match code {
                    $($code => Some(Fault::$fault $(($part::$which))?),)*
                    _ => None,
                }
            }
        }
    };
}

codes! {
    11 Stale(Sensor::Gyroscope);
    12 Stuck(Sensor::Gyroscope);
    13 Saturated(Sensor::Gyroscope);
    14 NotFinite(Sensor::Gyroscope);
    15 Contradiction(Sensor::Gyroscope);
    21 Stale(Sensor::BlockAccelerometer);
    22 Stuck(Sensor::BlockAccelerometer);
    23 Saturated(Sensor::BlockAccelerometer);
    24 NotFinite(Sensor::BlockAccelerometer);
    25 Contradiction(Sensor::BlockAccelerometer);
    31 Stale(Sensor::GroundAccelerometer);
    32 Stuck(Sensor::GroundAccelerometer);
    33 Saturated(Sensor::GroundAccelerometer);
    34 NotFinite(Sensor::GroundAccelerometer);
    35 Contradiction(Sensor::GroundAccelerometer);
    41 Stale(Sensor::Encoder);
    42 Stuck(Sensor::Encoder);
    43 Saturated(Sensor::Encoder);
    44 NotFinite(Sensor::Encoder);
    45 Contradiction(Sensor::Encoder);
    51 ClutchEngagedUnbidden(Wheel::First);
    52 ClutchEngagedUnbidden(Wheel::Second);
    53 ClutchRefuses(Wheel::First);
    54 ClutchRefuses(Wheel::Second);
    55 BothClutches;
    56 SelfTestFailed(Wheel::First);
    57 SelfTestFailed(Wheel::Second);
    58 OverCurrent(Wheel::First);
    59 OverCurrent(Wheel::Second);
    61 Overrun;
    62 EstimateNotFinite;
    63 NotCommissioned;
    64 GivenUp;
    65 ImageDamaged;
    66 MemoryDamaged;
    67 ClockWrong;
    68 SettingsDamaged;
    71 CalibrationAbandoned;
    72 SelfTestAbandoned;
    73 CommandsTooMany;
    74 ClosingTimeChanged(Wheel::First);
    75 ClosingTimeChanged(Wheel::Second);
    76 NotSealed;
    77 OlderFirmware;
    81 HighSideClosed(Wheel::First);
    82 HighSideClosed(Wheel::Second);
    83 LowSideClosed(Wheel::First);
    84 LowSideClosed(Wheel::Second);
    85 WrongCurrent(Wheel::First);
    86 WrongCurrent(Wheel::Second);
    91 AnswersWrongly(Place::Block);
    92 AnswersWrongly(Place::Ground);
    93 ScaleWrong(Place::Block);
    94 ScaleWrong(Place::Ground);
    95 SupplyLow;
    96 TemperatureUnusual;
    97 PartsUntested;
}

impl Fault {
    /// The sensor that is at fault; none of a warning.
    pub fn sensor(self) -> Option<Sensor> {
        match self {
            Fault::Stale(sensor)
            | Fault::Stuck(sensor)
            | Fault::Saturated(sensor)
            | Fault::NotFinite(sensor)
            | Fault::Contradiction(sensor) => Some(sensor),
            Fault::ClutchEngagedUnbidden(_)
            | Fault::ClutchRefuses(_)
            | Fault::BothClutches
            | Fault::SelfTestFailed(_)
            | Fault::OverCurrent(_)
            | Fault::HighSideClosed(_)
            | Fault::LowSideClosed(_)
            | Fault::WrongCurrent(_)
            | Fault::Overrun
            | Fault::EstimateNotFinite
            | Fault::NotCommissioned
            | Fault::GivenUp
            | Fault::ImageDamaged
            | Fault::MemoryDamaged
            | Fault::ClockWrong
            | Fault::SettingsDamaged
            | Fault::NotSealed
            | Fault::OlderFirmware
            | Fault::CalibrationAbandoned
            | Fault::ClosingTimeChanged(_)
            | Fault::SelfTestAbandoned
            | Fault::CommandsTooMany
            | Fault::AnswersWrongly(_)
            | Fault::PartsUntested
            | Fault::ScaleWrong(_)
            | Fault::SupplyLow
            | Fault::TemperatureUnusual => None,
        }
    }

    /// An engaged clutch is what is wrong, so that none may be left engaged.
    pub fn is_of_an_engaged_clutch(self) -> bool {
        matches!(
            self,
            Fault::ClutchEngagedUnbidden(_)
                | Fault::BothClutches
                | Fault::OverCurrent(_)
                | Fault::HighSideClosed(_)
                | Fault::LowSideClosed(_)
        )
    }

    /// The clutch that cannot be engaged.
    pub fn missing_clutch(self) -> Option<Wheel> {
        match self {
            Fault::ClutchRefuses(wheel) | Fault::SelfTestFailed(wheel) | Fault::WrongCurrent(wheel) => Some(wheel),
            _ => None,
        }
    }

    /// The whole table of recovery.
    ///
    /// | fault | recovery | because |
    /// | --- | --- | --- |
    /// | of a sensor | when good | good readings show it, and the new calibration tries bias and gravity afresh |
    /// | of a clutch or its coil, failed self-test | on request | a part that may be broken shows nothing until it is used: somebody must look |
    /// | overrun, estimate not finite | on request | the program or its parameters are wrong, which time does not mend |
    /// | not commissioned, settings given up | by storing | only somebody who knows the structure can say what the settings must be |
    /// | image, memory, clock, settings in memory | by a new start | the board itself is not to be relied upon; a new start reads and tests all anew |
    /// | abandoned calibration or self-test, too many commands, changed closing time, no seal, older firmware | not needed | a warning only |
    /// | a part's self-test, its scale, supply, temperature | not needed | a warning only |
    pub fn recovery(self) -> Recovery {
        match self {
            Fault::Stale(_) | Fault::Stuck(_) | Fault::Saturated(_) | Fault::NotFinite(_) | Fault::Contradiction(_) => {
                Recovery::WhenGood
            }
            Fault::ClutchEngagedUnbidden(_) | Fault::ClutchRefuses(_) | Fault::BothClutches | Fault::SelfTestFailed(_) => {
                Recovery::OnRequest
            }
            Fault::OverCurrent(_) | Fault::HighSideClosed(_) | Fault::LowSideClosed(_) | Fault::WrongCurrent(_) => {
                Recovery::OnRequest
            }
            Fault::Overrun | Fault::EstimateNotFinite => Recovery::OnRequest,
            Fault::NotCommissioned | Fault::GivenUp => Recovery::ByStoring,
            Fault::ImageDamaged | Fault::MemoryDamaged | Fault::ClockWrong | Fault::SettingsDamaged => Recovery::ByStart,
            Fault::CalibrationAbandoned | Fault::SelfTestAbandoned | Fault::CommandsTooMany | Fault::ClosingTimeChanged(_) => {
                Recovery::NotNeeded
            }
            Fault::NotSealed | Fault::OlderFirmware | Fault::AnswersWrongly(_) | Fault::ScaleWrong(_) => Recovery::NotNeeded,
            Fault::SupplyLow | Fault::TemperatureUnusual | Fault::PartsUntested => Recovery::NotNeeded,
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fault::Stale(sensor) => write!(formatter, "{sensor}: no new reading in time"),
            Fault::Stuck(Sensor::Encoder) => write!(formatter, "encoder: its count stays while the gyroscope turns"),
            Fault::Stuck(sensor) => write!(formatter, "{sensor}: new readings are bit for bit the same for too long"),
            Fault::Saturated(Sensor::Encoder) => write!(formatter, "encoder: its count is beyond the rack's travel"),
            Fault::Saturated(sensor) => write!(formatter, "{sensor}: at full scale for longer than an impact lasts"),
            Fault::NotFinite(sensor) => write!(formatter, "{sensor}: its reading is not a finite number"),
            Fault::Contradiction(Sensor::Gyroscope) => write!(formatter, "gyroscope: it turns while the block is at rest"),
            Fault::Contradiction(Sensor::Encoder) => write!(formatter, "encoder: its rate contradicts the gyroscope's"),
            Fault::Contradiction(sensor) => {
                write!(formatter, "{sensor}: at rest it contradicts gravity and the other accelerometer")
            }
            Fault::ClutchEngagedUnbidden(wheel) => write!(formatter, "{wheel} clutch: engaged, but its command is to be open"),
            Fault::ClutchRefuses(wheel) => write!(formatter, "{wheel} clutch: open, but its command is to be engaged"),
            Fault::BothClutches => write!(formatter, "both clutches engaged at once, which is not allowed"),
            Fault::SelfTestFailed(wheel) => {
                write!(formatter, "{wheel} clutch: its feedback did not follow the self-test's pulse")
            }
            Fault::OverCurrent(wheel) => write!(formatter, "{wheel} clutch: its coil takes more current than a whole one"),
            Fault::HighSideClosed(wheel) => write!(formatter, "{wheel} clutch: its coil's high-side switch conducts while off"),
            Fault::LowSideClosed(wheel) => write!(formatter, "{wheel} clutch: its coil's low-side switch conducts while off"),
            Fault::WrongCurrent(wheel) => {
                write!(formatter, "{wheel} clutch: its coil's current is not what supply and resistance make it")
            }
            Fault::Overrun => write!(formatter, "controller: ticks come too late"),
            Fault::EstimateNotFinite => write!(formatter, "estimate: rotation or velocity is not a finite number"),
            Fault::NotCommissioned => write!(formatter, "not commissioned: no settings of its own are stored in it"),
            Fault::GivenUp => {
                write!(formatter, "stored settings given up: reset after reset with them, until they are stored anew")
            }
            Fault::ImageDamaged => write!(formatter, "board: the program in its flash is damaged"),
            Fault::MemoryDamaged => write!(formatter, "board: a word of its memory does not hold what is written to it"),
            Fault::ClockWrong => write!(formatter, "board: the rate of its crystal is off by more than 5 %"),
            Fault::SettingsDamaged => write!(formatter, "board: its settings have changed in memory, by themselves"),
            Fault::NotSealed => write!(formatter, "board: its program has no seal, so damage to it would not be found"),
            Fault::OlderFirmware => write!(formatter, "board: a newer firmware than this one has run on it"),
            Fault::CalibrationAbandoned => {
                write!(formatter, "calibration abandoned for lack of stillness: armed with the last biases")
            }
            Fault::ClosingTimeChanged(wheel) => {
                write!(formatter, "{wheel} clutch: it closes by a third sooner or later than it should: wear, cold, a low supply")
            }
            Fault::SelfTestAbandoned => write!(formatter, "self-test abandoned for lack of stillness: the clutches are untested"),
            Fault::CommandsTooMany => write!(formatter, "controller: it commands the clutches more often than a motion asks for"),
            Fault::AnswersWrongly(place) => {
                write!(formatter, "inertial part on the {place}: it answers its self-test otherwise than in the factory")
            }
            Fault::PartsUntested => write!(formatter, "inertial parts: untested, for lack of stillness or of time"),
            Fault::ScaleWrong(place) => {
                write!(
                    formatter,
                    "accelerometer on the {place}: at rest it is more than a fifth off 1 g, as if its range were another"
                )
            }
            Fault::SupplyLow => write!(formatter, "coils' supply: lower than the clutches' pull-in time was measured with"),
            Fault::TemperatureUnusual => {
                write!(formatter, "temperature: beyond the range in which the clutches' pull-in time was measured")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::string::ToString;

    #[test]
    fn codes_are_stable_and_unambiguous() {
        let codes: BTreeSet<u16> = Fault::ALL.iter().map(|fault| fault.code()).collect();
        assert_eq!(codes.len(), Fault::ALL.len());
        assert!((0..=u16::MAX).all(|code| Fault::from_code(code).is_some() == codes.contains(&code)));
        assert!(Fault::ALL.iter().all(|fault| Fault::from_code(fault.code()) == Some(*fault)));
        assert_eq!(Fault::Stale(Sensor::Gyroscope).code(), 11);
        assert_eq!(Fault::Contradiction(Sensor::Encoder).code(), 45);
        assert_eq!(Fault::ClutchRefuses(Wheel::Second).code(), 54);
        assert_eq!(Fault::SelfTestAbandoned.code(), 72);
    }

    #[test]
    fn each_is_one_line_of_its_own_that_names_the_sensor() {
        let lines: BTreeSet<_> = Fault::ALL.iter().map(|fault| fault.to_string()).collect();
        assert_eq!(lines.len(), Fault::ALL.len());
        for fault in Fault::ALL {
            let line = fault.to_string();
            assert!(!line.contains('\n'));
            assert!(fault.sensor().is_none_or(|sensor| line.starts_with(&sensor.to_string())), "{line}");
        }
    }

    #[test]
    fn sensors_recover_and_the_rest_waits_for_somebody() {
        for fault in Fault::ALL {
            let expected = match fault.code() {
                ..50 => Recovery::WhenGood,
                63 | 64 => Recovery::ByStoring,
                65..=68 => Recovery::ByStart,
                50..70 | 80..90 => Recovery::OnRequest,
                _ => Recovery::NotNeeded,
            };
            assert_eq!(fault.recovery(), expected, "{fault}");
            assert_eq!(fault.sensor().is_some(), expected == Recovery::WhenGood);
        }
    }
}
