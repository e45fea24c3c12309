//! A clutch coil between its two switches and two diodes, and its shunt.
//!
//! L i′ = u − R i: with the high side on the mean of u is the low side's duty times the supply (the current goes round through the upper
//! diode while the low side is off), with the high side off and the low side modulated it is 0, and with both off the current flows back
//! into the supply: u = −U − 2 V_d, until there is none.

use crate::time::seconds;

/// A switch that obeys, or not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Switch {
    /// It does.
    #[default]
    Whole,
    /// It conducts for good.
    Closed,
    /// It never conducts.
    Open,
}

impl Switch {
    fn duty(self, duty: f64) -> f64 {
        match self {
            Switch::Whole => duty,
            Switch::Closed => 1.0,
            Switch::Open => 0.0,
        }
    }
}

/// Of the supply, V.
const SUPPLY: f64 = 24.0;
/// Of a diode, V.
const DIODE: f64 = 0.4;
/// Of a whole coil, Ω and H: 1.2 A after 3 ms.
const RESISTANCE: f64 = 20.0;
const INDUCTANCE: f64 = 0.06;

/// A coil.
#[derive(Clone, Debug)]
pub struct Coil {
    /// A.
    pub current: f64,
    /// Largest so far, A.
    pub peak: f64,
    /// Ω; infinite where the wire is broken.
    pub resistance: f64,
    /// H.
    pub inductance: f64,
    /// Of the supply, V.
    pub supply: f64,
    /// The high side.
    pub high: Switch,
    /// The low side.
    pub low: Switch,
    at: u64,
}

impl Default for Coil {
    fn default() -> Coil {
        Coil {
            current: 0.0,
            peak: 0.0,
            resistance: RESISTANCE,
            inductance: INDUCTANCE,
            supply: SUPPLY,
            high: Switch::Whole,
            low: Switch::Whole,
            at: 0,
        }
    }
}

impl Coil {
    /// Lets time pass with the high side commanded on or off and the low side on for a share of the time.
    pub fn advance(&mut self, high: bool, duty: f64, now: u64) {
        let time = seconds(now - self.at);
        self.at = now;
        if self.resistance.is_infinite() {
            self.current = 0.0;
            return;
        }
        let (high, low) = (self.high.duty(f64::from(u8::from(high))) > 0.0, self.low.duty(duty));
        let voltage = match (high, low > 0.0) {
            (true, true) => self.supply * low,
            (true, false) | (false, true) => -DIODE,
            (false, false) => -self.supply - 2.0 * DIODE,
        };
        let last = voltage / self.resistance;
        self.current = (last + (self.current - last) * (-time * self.resistance / self.inductance).exp()).max(0.0);
        self.peak = self.peak.max(self.current);
    }
}
