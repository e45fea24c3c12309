//! Settings of a board besides its controller: how its sensors are turned, and how its coils are driven. Taken over when it starts.

use super::{Item, SettingError, Settings};

/// An axis of a sensor, with its direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    word: u8,
}

impl Axis {
    fn read(settings: &Settings, item: Item) -> Axis {
        Axis { word: settings.whole(item) as u8 }
    }

    /// 0, 1 or 2 for x, y or z.
    pub fn index(self) -> u8 {
        self.word >> 1
    }

    /// Whether the axis points the other way.
    pub fn reversed(self) -> bool {
        self.word & 1 == 1
    }
}

/// How sensors and coils of one device are mounted: what the controller cannot find out by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wiring {
    /// For which a coil gets its full voltage, s; 0 to 1.
    pub coil_pull_in_time: f32,
    /// Share of the voltage that holds it after that; 0.05 to 1.
    pub coil_hold_share: f32,
    /// Current from which a clutch counts as engaged, A; 0 to 20.
    pub coil_engaged_current: f32,
    /// Supply over resistance, A; 0 to 20, 0 where it is not known.
    pub coil_full_current: f32,
    /// Supply from which the pull-in time holds, V; 0 to 36, 0 where the supply is not watched.
    pub coil_supply_least: f32,
    /// Least and most of the block's sensor at which the pull-in time holds, °C; -40 to 125.
    pub temperatures: [f32; 2],
    /// Of the block's gyroscope: about it θ is positive.
    pub block_gyroscope: Axis,
    /// Of the block's accelerometer, horizontal and vertical at rest.
    pub block: [Axis; 2],
    /// Axes of the ground's accelerometer.
    pub ground: [Axis; 2],
    /// Counts fall when θ grows.
    pub encoder_reversed: bool,
}

impl Wiring {
    /// Whether `settings` have a wiring that can be.
    ///
    /// # Errors
    /// [`SettingError::Contradiction`] where two axes of one sensor that must be across each other are not, or no temperature is allowed.
    pub fn check(settings: &Settings) -> Result<(), SettingError> {
        for (item, other) in [
            (Item::BlockUpAxis, Item::BlockAlongAxis),
            (Item::GroundUpAxis, Item::GroundAlongAxis),
            (Item::BlockGyroscopeAxis, Item::BlockAlongAxis),
            (Item::BlockGyroscopeAxis, Item::BlockUpAxis),
        ] {
            if Axis::read(settings, item).index() == Axis::read(settings, other).index() {
                return Err(SettingError::contradiction(item, other));
            }
        }
        if settings.real(Item::TemperatureLeast) > settings.real(Item::TemperatureMost) {
            return Err(SettingError::contradiction(Item::TemperatureLeast, Item::TemperatureMost));
        }
        Ok(())
    }

    /// Wiring of `settings`.
    pub fn of(settings: &Settings) -> Wiring {
        let axis = |item| Axis::read(settings, item);
        Wiring {
            coil_pull_in_time: settings.real(Item::CoilPullInTime),
            coil_hold_share: settings.real(Item::CoilHoldShare),
            coil_engaged_current: settings.real(Item::CoilEngagedCurrent),
            coil_full_current: settings.real(Item::CoilFullCurrent),
            coil_supply_least: settings.real(Item::CoilSupplyLeast),
            temperatures: [Item::TemperatureLeast, Item::TemperatureMost].map(|item| settings.real(item)),
            block_gyroscope: axis(Item::BlockGyroscopeAxis),
            block: [axis(Item::BlockAlongAxis), axis(Item::BlockUpAxis)],
            ground: [axis(Item::GroundAlongAxis), axis(Item::GroundUpAxis)],
            encoder_reversed: settings.switch(Item::EncoderReversed),
        }
    }

    /// Travel of so many counts, with the sign of θ.
    pub fn travel(&self, counts: i32) -> i32 {
        if self.encoder_reversed { counts.wrapping_neg() } else { counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_must_be_across_each_other() {
        let mut settings = Settings::default();
        assert!(Wiring::check(&settings).is_ok());
        settings.set(Item::BlockUpAxis.index(), 1).unwrap();
        assert_eq!(Wiring::check(&settings), Err(SettingError::contradiction(Item::BlockUpAxis, Item::BlockAlongAxis)));
        settings.set(Item::BlockUpAxis.index(), 3).unwrap();
        assert_eq!(Wiring::check(&settings), Err(SettingError::contradiction(Item::BlockGyroscopeAxis, Item::BlockUpAxis)));
    }
    #[test]
    fn a_range_of_temperatures_holds_one() {
        let mut settings = Settings::default();
        settings.set(Item::TemperatureLeast.index(), 70.5_f32.to_bits()).unwrap();
        let error = SettingError::contradiction(Item::TemperatureLeast, Item::TemperatureMost);
        assert_eq!(Wiring::check(&settings), Err(error));
    }
}
