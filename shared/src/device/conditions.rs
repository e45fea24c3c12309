//! What the clutches' pull-in time was measured under: the coils' supply and the temperature. Both change it, so leaving them is a warning.
//!
//! The supply is seen through a divider of 100 kΩ over 10 kΩ, of 1 % each, by a converter whose reference is the 3.3 V of the board's
//! regulator (±1.5 %): what is read is within 3.5 % of what there is, 0.8 V of 24.

use crate::settings::wiring::Wiring;

/// The supply over what the converter sees of it.
pub const DIVIDER: f32 = (100.0 + 10.0) / 10.0;

/// Volts of the supply to a count: 3.3 V over 4096 counts, behind the divider.
pub const VOLTS_PER_COUNT: f32 = 3.3 / 4096.0 * DIVIDER;

/// Looks in a row that must find something wrong.
const WRONG_LOOKS: u16 = 4;

/// Looks in a row that must find the supply right before it is reported anew: a minute, a look every fourth tick at 2 kHz.
const RIGHT_SUPPLY: u16 = 30_000;
/// The same of the temperature: a minute, a look every 256th tick.
const RIGHT_TEMPERATURE: u16 = 470;

/// The coils' supply, V, of the converter's counts.
#[inline]
pub fn supply(counts: u16) -> f32 {
    f32::from(counts) * VOLTS_PER_COUNT
}

/// Within which conditions a device is to be, and whether it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    supply_least: f32,
    temperatures: [f32; 2],
    supply: Alarm,
    temperature: Alarm,
}

impl Conditions {
    /// As a device is wired: nothing is known yet.
    pub fn new(wiring: &Wiring) -> Conditions {
        let Wiring { coil_supply_least, temperatures, .. } = *wiring;
        Conditions { supply_least: coil_supply_least, temperatures, supply: Alarm::default(), temperature: Alarm::default() }
    }

    /// A look at the coils' supply, V: whether it has just been found to be too low.
    #[inline]
    pub fn see_supply(&mut self, volts: f32) -> bool {
        self.supply.step(volts < self.supply_least, RIGHT_SUPPLY)
    }

    /// A look at the temperature, °C: whether it has just been found to be beyond its range.
    pub fn see_temperature(&mut self, celsius: f32) -> bool {
        let [least, most] = self.temperatures;
        self.temperature.step(celsius < least || celsius > most, RIGHT_TEMPERATURE)
    }
}

/// Something that is wrong or right at a look.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Alarm {
    /// Looks in a row that have found it wrong.
    wrong: u16,
    /// Looks that must find it right before it is reported anew.
    until_reported: u16,
}

impl Alarm {
    /// Whether this is to be reported now; `anew` is for how many looks it must be right before the next time.
    #[inline]
    fn step(&mut self, wrong: bool, anew: u16) -> bool {
        if !wrong {
            self.wrong = 0;
            self.until_reported = self.until_reported.saturating_sub(1);
            return false;
        }
        self.wrong = self.wrong.saturating_add(1);
        if self.wrong < WRONG_LOOKS {
            return false;
        }
        core::mem::replace(&mut self.until_reported, anew) == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;

    fn conditions() -> Conditions {
        Conditions::new(&Wiring::of(&Settings::default()))
    }

    #[test]
    fn counts_are_volts_behind_the_divider() {
        // 24 V over 11 are 2.1818 V, of 3.3 V in 4096 counts.
        assert!((supply(2708) - 24.0).abs() < 0.01, "{}", supply(2708));
        assert!((supply(4095) - 36.29).abs() < 0.01);
    }

    #[test]
    fn a_sag_of_several_looks_is_reported_once_a_minute() {
        let mut conditions = conditions();
        let mut reported = 0;
        for minute in 0..3 {
            for look in 0..30_100 {
                let sags = look % 1000 < 10 && (minute != 1 || look < 100);
                reported += u32::from(conditions.see_supply(if sags { 21.4 } else { 21.8 }));
            }
        }
        assert_eq!(reported, 2, "at first, and after a minute that was right");
    }

    #[test]
    fn a_spike_or_what_is_not_watched_is_not_reported() {
        let mut spikes = conditions();
        assert!((0..1000).all(|look| !spikes.see_supply(if look % 4 == 3 { 24.0 } else { 0.0 })));
        let mut unwatched = Conditions { supply_least: 0.0, ..conditions() };
        assert!((0..1000).all(|_| !unwatched.see_supply(0.0)));
    }

    #[test]
    fn cold_and_heat_are_reported_and_what_lies_between_is_not() {
        for (celsius, expected) in [(-20.5, 1), (-19.5, 0), (25.0, 0), (69.5, 0), (70.5, 1)] {
            let mut conditions = conditions();
            let reported = (0..100).filter(|_| conditions.see_temperature(celsius)).count();
            assert_eq!(reported, expected, "{celsius} °C");
        }
    }
}
