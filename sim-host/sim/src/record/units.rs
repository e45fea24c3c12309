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
    /// mm/s².
    MillimetrePerSecondSquared,
    /// in/s², 0.0254 m/s².
    InchPerSecondSquared,
    /// ft/s², 0.3048 m/s².
    FootPerSecondSquared,
}

impl Units {
    /// The spellings to offer in a message.
    pub const ALLOWED: &'static str = "g, m/s2, cm/s2 (gal), mm/s2, in/s2, ft/s2";

    /// A value of this unit in m/s².
    pub fn to_m_s2(self, value: f64) -> f64 {
        match self {
            Units::StandardGravity => value * STANDARD_GRAVITY_M_S2,
            Units::MetrePerSecondSquared => value,
            // Divided, since 100 is exact in binary and 0.01 is not.
            Units::CentimetrePerSecondSquared => value / 100.0,
            Units::MillimetrePerSecondSquared => value / 1000.0,
            Units::InchPerSecondSquared => value * 0.0254,
            Units::FootPerSecondSquared => value * 0.3048,
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
            "mm_s2" | "mms2" => Some(Units::MillimetrePerSecondSquared),
            "ft_s2" | "fts2" | "foot_s2" | "feet_s2" => Some(Units::FootPerSecondSquared),
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
            Units::MillimetrePerSecondSquared => "mm/s2",
            Units::InchPerSecondSquared => "in/s2",
            Units::FootPerSecondSquared => "ft/s2",
        })
    }
}

/// What a header line says about units.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum StatedUnits {
    /// A unit of acceleration.
    Known(Units),
    /// The line says `units …` or has the name of a unit where units stand, but not of one that is known.
    Unknown(String),
}

/// What one header line says by the word units: `UNITS OF G`, `units: cm/s2`. Where it has the word several times, as in
/// `time units: s, acceleration units: g`, the first unit of acceleration counts.
pub(super) fn said_in(line: &str) -> Option<StatedUnits> {
    let lower = line.to_lowercase();
    let ends = |word: &'static str, length: usize| lower.match_indices(word).map(move |(at, _)| at + length);
    let words = || ends("units", 5).chain(ends("unit:", 4)).map(|at| unit_at(&lower[at..])).filter(|word| !word.is_empty());
    let known = words().find_map(Units::from_spelling).map(StatedUnits::Known);
    known.or_else(|| words().next().map(|word| StatedUnits::Unknown(word.chars().take(40).collect())))
}

/// The word behind `units`: `cm/s2` of `: cm/s2, …`.
fn unit_at(text: &str) -> &str {
    let after = text.trim_start_matches([' ', '\t', ':', '=']);
    let after = ["of ", "in ", "are ", "is "].iter().find_map(|word| after.strip_prefix(word)).unwrap_or(after);
    after.trim_start().split([' ', '\t', ',', ';']).next().unwrap_or("")
}

/// Looks for units in one header line: [by the word](said_in), or `Acceleration (m/s^2)`, `acc_g`, a bare `cm/sec/sec`.
pub(super) fn stated_in(line: &str) -> Option<StatedUnits> {
    said_in(line).or_else(|| hinted_in(line))
}

/// Units that a header line has beside something else.
pub(super) fn hinted_in(line: &str) -> Option<StatedUnits> {
    let lower = line.to_lowercase();
    let bracketed = || lower.split(['(', '[']).skip(1).filter_map(|part| part.split([')', ']']).next());
    let words = || lower.split([' ', '\t', ',', ';', '"']);
    let known = bracketed().find_map(Units::from_spelling).map(StatedUnits::Known);
    known.or_else(|| words().find_map(units_of_word)).or_else(|| bracketed().find_map(other_unit))
}

/// Units in a column name such as `acc_g`, `acc_x_g` or `acceleration_m_s2`, or in a bare word such as `cm/sec/sec` or `gal`.
/// A bare `g` does not count: it is too common a letter.
fn units_of_word(word: &str) -> Option<StatedUnits> {
    if !word.starts_with("acc") {
        return Units::from_spelling(word).filter(|units| *units != Units::StandardGravity).map(StatedUnits::Known);
    }
    // What follows any `_` may be the unit; before it stands the direction.
    let ends = || word.match_indices('_').map(|(at, _)| &word[at + 1..]);
    let scaled = |end: &str| scaled_unit(end).then(|| StatedUnits::Unknown(end.to_owned()));
    let first = ends().find_map(|end| scaled(end).or_else(|| Units::from_spelling(end).map(StatedUnits::Known)));
    first.or_else(|| other_unit(ends().next()?))
}

/// A unit of acceleration that is not known: `mg`, `%g`, `yd/s2`.
fn other_unit(text: &str) -> Option<StatedUnits> {
    let squared =
        ["/s2", "/s^2", "/s²", "_s2", "/s/s", "/sec2", "/sec^2", "/sec²", "/sec/sec"].iter().any(|end| text.ends_with(end));
    (scaled_unit(text) || (squared && !text.contains(' '))).then(|| StatedUnits::Unknown(text.chars().take(40).collect()))
}

/// g or gal with a prefix: `mg`, `%g`, `milli_g`.
fn scaled_unit(text: &str) -> bool {
    let prefix = text.strip_suffix("gal").or_else(|| text.strip_suffix('g'));
    let prefix = prefix.map(|prefix| prefix.trim_end_matches(['_', '-', ' ']));
    prefix.is_some_and(|prefix| {
        matches!(prefix, "%" | "m" | "u" | "µ" | "μ" | "k" | "milli" | "micro" | "kilo" | "pct" | "percent")
    })
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
            ("mm/s^2", Units::MillimetrePerSecondSquared),
            ("ft/sec2", Units::FootPerSecondSquared),
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
        assert_eq!(stated_in("time units: s, acceleration units: g"), known(Units::StandardGravity));
        assert_eq!(stated_in("Unit: cm/s2 (time unit: s)"), known(Units::CentimetrePerSecondSquared));
        assert_eq!(stated_in("time units: s, displacement units: cm"), Some(StatedUnits::Unknown("s".into())));
        assert_eq!(stated_in("units: furlong"), Some(StatedUnits::Unknown("furlong".into())));
        assert_eq!(stated_in("LOMA PRIETA 1989, station g"), None);
        assert_eq!(stated_in("acc_mm_s2"), known(Units::MillimetrePerSecondSquared));
        assert_eq!(stated_in("acc_ft_s2"), known(Units::FootPerSecondSquared));
        for name in ["acc_x_g", "acc_h1_g", "accel_north_g"] {
            assert_eq!(stated_in(name), known(Units::StandardGravity), "{name}");
        }
        assert_eq!(stated_in("acc_x_m_s2"), known(Units::MetrePerSecondSquared));
        for (name, unit) in [
            ("acc_mg", "mg"),
            ("acc_%g", "%g"),
            ("acc_x_milli_g", "milli_g"),
            ("acc_yd_s2", "yd_s2"),
            ("Acceleration (mg)", "mg"),
        ] {
            assert_eq!(stated_in(name), Some(StatedUnits::Unknown(unit.into())), "{name}");
        }
        for name in ["acc_ns", "acc_x", "acc", "Sta. (34.0 N), 12 km (WNW)"] {
            assert_eq!(stated_in(name), None, "{name}");
        }
    }

    #[test]
    fn conversion_to_si() {
        assert_eq!(Units::StandardGravity.to_m_s2(1.0), 9.80665);
        assert_eq!(Units::CentimetrePerSecondSquared.to_m_s2(250.0), 2.5);
        assert_eq!(Units::MillimetrePerSecondSquared.to_m_s2(250.0), 0.25);
        assert_eq!(Units::FootPerSecondSquared.to_m_s2(10.0), 3.048);
        assert!((Units::InchPerSecondSquared.to_m_s2(386.0886) - 9.80665).abs() < 1e-5);
    }
}
