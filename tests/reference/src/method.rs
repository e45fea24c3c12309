//! Sprag's methods, and how close each has to come.

use crate::compare::{CLOSES, Tolerance};

/// One of Sprag's methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Taylor series in steps of their own choice.
    Series,
    /// Order 4 in fixed steps, events located in them.
    RungeKutta,
}

/// Steps of this program that one of Sprag's Runge-Kutta method may take.
const LONGER: f64 = 2.0;

impl Method {
    /// Both.
    pub const ALL: [Method; 2] = [Method::Series, Method::RungeKutta];

    /// As scenes spell it.
    pub fn name(self) -> &'static str {
        match self {
            Method::Series => "taylor",
            Method::RungeKutta => "runge-kutta-4",
        }
    }

    /// Its keys and their values for a scene of which this program takes steps of `step` (s).
    pub fn keys(self, step: f64) -> Vec<(&'static str, String)> {
        let mut keys = vec![("method", format!("\"{}\"", self.name()))];
        if self == Method::RungeKutta {
            keys.push(("step_s", format!("{:e}", LONGER * step)));
        }
        keys
    }

    /// Differences beyond these are reported.
    pub fn tolerance(self) -> Tolerance {
        match self {
            Method::Series => Tolerance { history: 1e-6, residuals: [CLOSES, 1e-10] },
            Method::RungeKutta => Tolerance { history: 1e-5, residuals: [CLOSES, 1e-7] },
        }
    }
}
