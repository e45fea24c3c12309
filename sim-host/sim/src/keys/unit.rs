//! Units of keys.

/// Endings of keys, of two that end alike the longer one first, and their units.
const UNITS: [(&str, &str); 22] = [
    ("_deg_s_rthz", "°/s/√Hz"),
    ("_deg_s_rts", "°/s/√s"),
    ("_deg_s", "°/s"),
    ("_deg", "degrees"),
    ("_ug_rthz", "µg/√Hz"),
    ("_mg_rts", "mg/√s"),
    ("_mg", "mg"),
    ("_mm", "mm"),
    ("_mpa", "MPa"),
    ("_m_s2", "m/s²"),
    ("_m_s", "m/s"),
    ("_n_s_m", "N s/m"),
    ("_n_m", "N/m"),
    ("_n", "N"),
    ("_kg", "kg"),
    ("_1_s", "1/s"),
    ("_hz", "Hz"),
    ("_w", "W"),
    ("_j", "J"),
    ("_s", "s"),
    ("_m", "m"),
    ("_g", "g"),
];

/// The unit that the name of `key` ends in; none where the value has none.
pub fn unit(key: &str) -> Option<&'static str> {
    UNITS.into_iter().find_map(|(ending, unit)| key.ends_with(ending).then_some(unit))
}
