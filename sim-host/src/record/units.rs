//! Units of acceleration in record files.

use std::fmt;
use std::str::FromStr;

/// Standard acceleration of gravity, 9.80665 m/s² exactly (3rd CGPM, 1901).
pub const STANDARD_GRAVITY_M_S2: f64 = 9.80665;

/// Unit of the samples in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// Standard gravity, 9.80665 m/s².
    StandardGravity,
    /// m/s².
    MetrePerSecondSquared,
    /// cm/s², also called gal.
    CentimetrePerSecondSquared,
    /// in/s², 0.0254 m/s².
    InchPerSecondSquared,
}

impl Units {
    /// The spellings to offer in a message.
    pub const ALLOWED: &'static str = "g, m/s2, cm/s2 (gal), in/s2";

    /// A value of this unit in m/s².
    pub fn to_m_s2(self, value: f64) -> f64 {
        match self {
            Units::StandardGravity => value * STANDARD_GRAVITY_M_S2,
            Units::MetrePerSecondSquared => value,
            // Divided, since 100 is exact in binary and 0.01 is not.
            Units::CentimetrePerSecondSquared => value / 100.0,
            Units::InchPerSecondSquared => value * 0.0254,
        }
    }

    /// Reads one spelling: `g`, `m/s2`, `m/s^2`, `m/s**2`, `M/SEC/SEC`, `m_s2`, `m/s²`, `gal`, and so on.
    /// Case, blanks and enclosing brackets do not matter.
    pub fn from_spelling(text: &str) -> Option<Units> {
        let plain: String = text
            .chars()
            .filter(|c| !c.is_whitespace() && !matches!(c, '^' | '*' | '(' | ')' | '[' | ']' | '"' | '\'' | '.'))
            .flat_map(char::to_lowercase)
            .map(|c| if c == '²' { '2' } else { c })
            .collect();
        let plain = plain.replace("sec", "s").replace("s/s", "s2").replace("s-2", "_s2").replace('/', "_").replace("__", "_");
        match plain.as_str() {
            "g" | "g's" | "gs" => Some(Units::StandardGravity),
            "m_s2" | "ms2" | "mps2" => Some(Units::MetrePerSecondSquared),
            "cm_s2" | "cms2" | "gal" | "gals" => Some(Units::CentimetrePerSecondSquared),
            "in_s2" | "ins2" | "inch_s2" | "inches_s2" => Some(Units::InchPerSecondSquared),
            _ => None,
        }
    }
}

impl FromStr for Units {
    type Err = String;

    fn from_str(text: &str) -> Result<Units, String> {
        Units::from_spelling(text).ok_or_else(|| format!("units `{text}`; allowed are {}", Units::ALLOWED))
    }
}

impl fmt::Display for Units {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Units::StandardGravity => "g",
            Units::MetrePerSecondSquared => "m/s2",
            Units::CentimetrePerSecondSquared => "cm/s2",
            Units::InchPerSecondSquared => "in/s2",
        })
    }
}

/// What a header line says about units.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum StatedUnits {
    /// A unit of acceleration.
    Known(Units),
    /// The line says `units …`, but not one of acceleration.
    Unknown(String),
}

/// Looks for units in one header line: `UNITS OF G`, `units: cm/s2`, `Acceleration (m/s^2)`, `acc_g`, a bare `cm/sec/sec`.
pub(super) fn stated_in(line: &str) -> Option<StatedUnits> {
    let lower = line.to_lowercase();
    if let Some(at) = lower.find("units").map(|at| at + 5).or_else(|| lower.find("unit:").map(|at| at + 4)) {
        let after = lower[at..].trim_start_matches([' ', '\t', ':', '=']);
        let after = ["of ", "in ", "are ", "is "].iter().find_map(|word| after.strip_prefix(word)).unwrap_or(after);
        let word = after.trim_start().split([' ', '\t', ',', ';']).next().unwrap_or("");
        if let Some(units) = Units::from_spelling(word) {
            return Some(StatedUnits::Known(units));
        }
        if !word.is_empty() {
            return Some(StatedUnits::Unknown(word.chars().take(40).collect()));
        }
    }
    let bracketed = lower.split(['(', '[']).skip(1).filter_map(|part| part.split([')', ']']).next());
    bracketed
        .filter_map(Units::from_spelling)
        .next()
        .or_else(|| lower.split([' ', '\t', ',', ';']).find_map(units_of_word))
        .map(StatedUnits::Known)
}

/// Units in a column name such as `acc_g` or `acceleration_m_s2`, or in a bare word such as `cm/sec/sec` or `gal`.
/// A bare `g` does not count: it is too common a letter.
fn units_of_word(word: &str) -> Option<Units> {
    if word.starts_with("acc") {
        return word.split_once('_').and_then(|(_, unit)| Units::from_spelling(unit));
    }
    Units::from_spelling(word).filter(|units| *units != Units::StandardGravity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_seen_in_files_are_understood() {
        for (text, units) in [
            ("G", Units::StandardGravity),
            ("(g)", Units::StandardGravity),
            ("m/s^2", Units::MetrePerSecondSquared),
            ("m/s**2", Units::MetrePerSecondSquared),
            ("M/SEC/SEC", Units::MetrePerSecondSquared),
            ("m_s2", Units::MetrePerSecondSquared),
            ("m s-2", Units::MetrePerSecondSquared),
            ("cm/sec2", Units::CentimetrePerSecondSquared),
            ("cm/s/s", Units::CentimetrePerSecondSquared),
            ("Gal", Units::CentimetrePerSecondSquared),
            ("in/s²", Units::InchPerSecondSquared),
        ] {
            assert_eq!(Units::from_spelling(text), Some(units), "{text}");
        }
        for text in ["", "cm/s", "cm", "m", "%g", "s", "furlong"] {
            assert_eq!(Units::from_spelling(text), None, "{text}");
        }
    }

    #[test]
    fn header_lines_state_units() {
        let known = |units| Some(StatedUnits::Known(units));
        assert_eq!(stated_in("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.13"), known(Units::StandardGravity));
        assert_eq!(stated_in("# time_s,acc_g"), known(Units::StandardGravity));
        assert_eq!(stated_in("Time (s), Acceleration (cm/s^2)"), known(Units::CentimetrePerSecondSquared));
        assert_eq!(stated_in("t a_total in m/s2"), known(Units::MetrePerSecondSquared));
        assert_eq!(stated_in("units: furlong"), Some(StatedUnits::Unknown("furlong".into())));
        assert_eq!(stated_in("LOMA PRIETA 1989, station g"), None);
    }

    #[test]
    fn conversion_to_si() {
        assert_eq!(Units::StandardGravity.to_m_s2(1.0), 9.80665);
        assert_eq!(Units::CentimetrePerSecondSquared.to_m_s2(250.0), 2.5);
        assert!((Units::InchPerSecondSquared.to_m_s2(386.0886) - 9.80665).abs() < 1e-5);
    }
}
