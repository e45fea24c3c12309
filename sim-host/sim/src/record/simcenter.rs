//! SimCenter JSON records: an object with `dT` (s) and two horizontal components `data_x`, `data_y` in g.
//!
//! The fields `PGA_x` and `PGA_y` are not read: in known files they are neither the largest magnitude nor always the
//! largest value of the component.

use serde::Deserialize;

use super::Component;
use super::contents::{Contents, Format, Header, StatedStep};
use super::error::RecordError;
use super::units::Units;
use super::warning::Warning;

#[derive(Deserialize)]
struct Document {
    #[serde(default)]
    name: String,
    #[serde(rename = "dT", alias = "dt")]
    time_step_s: Option<f64>,
    data_x: Option<Vec<f64>>,
    data_y: Option<Vec<f64>>,
    units: Option<String>,
}

/// Reads the text of a SimCenter file. Without a choice of component the one with the larger peak is taken and a
/// warning says so.
pub(super) fn read(name: &str, text: &str, component: Option<&Component>) -> Result<Contents, RecordError> {
    let document: Document = serde_json::from_str(text).map_err(|error| RecordError::Malformed {
        file: name.to_owned(),
        line: error.line().max(1),
        problem: format!("no SimCenter JSON record: {}", error.to_string().replace('\n', " ")),
    })?;
    let mut contents = Contents::new(Format::SimCenterJson);
    contents.units = Some(match &document.units {
        None => Units::StandardGravity,
        Some(text) => Units::from_spelling(text).ok_or_else(|| RecordError::UnknownUnits {
            file: name.to_owned(),
            line: 1,
            value: text.chars().take(40).collect(),
        })?,
    });
    let present: Vec<(&str, Vec<f64>)> = [("x", document.data_x), ("y", document.data_y)]
        .into_iter()
        .filter_map(|(label, values)| values.map(|values| (label, values)))
        .collect();
    if present.is_empty() {
        return Err(RecordError::Malformed {
            file: name.to_owned(),
            line: 1,
            problem: "no `data_x` and no `data_y` in this JSON; at least one is due".to_owned(),
        });
    }
    let labels: Vec<&str> = present.iter().map(|(label, _)| *label).collect();
    let chosen = match component {
        Some(component) => component.position_in(&labels).ok_or_else(|| RecordError::Component {
            file: name.to_owned(),
            asked: format!("`{component}`"),
            available: labels.join(", "),
        })?,
        None => {
            let peak = |values: &[f64]| values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
            let larger = usize::from(present.len() > 1 && peak(&present[1].1) > peak(&present[0].1));
            if present.len() > 1 {
                contents
                    .warnings
                    .push(Warning::ComponentTaken { taken: labels[larger].to_owned(), available: labels.join(", ") });
            }
            larger
        }
    };
    let (label, values) = present.into_iter().nth(chosen).unwrap_or_default();
    contents.values = values;
    contents.component = Some(label.to_owned());
    contents.header = Header {
        title: document.name.chars().take(200).collect(),
        samples: None,
        peak_m_s2: None,
        time_step: document.time_step_s.map(|value_s| StatedStep { value_s, resolution_s: value_s.abs() * 1e-9 }),
    };
    Ok(contents)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{ReadOptions, Record};

    const TEXT: &str =
        r#"{"name": "R1", "dT": 0.01, "PGA_x": 0.2, "PGA_y": 0.1, "data_x": [0.0, 0.2, 0.0], "data_y": [0, 0.1, -0.3, 0.0]}"#;

    fn read_component(component: Option<&str>) -> Result<Record, RecordError> {
        let options = ReadOptions { component: component.map(Component::from), ..ReadOptions::default() };
        Record::parse("r.json", TEXT.as_bytes(), &options)
    }

    #[test]
    fn components_are_chosen_by_name_or_by_peak() {
        assert_eq!(read_component(Some("x")).unwrap().acceleration_m_s2.len(), 3);
        assert_eq!(read_component(Some("Y")).unwrap().acceleration_m_s2.len(), 4);
        let larger = read_component(None).unwrap();
        assert_eq!(larger.component.as_deref(), Some("y"));
        assert!(larger.warnings.iter().any(|warning| matches!(warning, Warning::ComponentTaken { taken, .. } if taken == "y")));
        let message = read_component(Some("z")).unwrap_err().to_string();
        assert_eq!(message, "r.json: component `z`: choose with --component, or write FILE#NAME; the file has x, y");
    }

    #[test]
    fn other_json_is_refused() {
        for text in ["{}", "{", "{\"dT\": 0.1, \"data_x\": [1, 1e999]}", "{\"data_x\": [null, 1]}"] {
            assert!(
                matches!(Record::parse("r.json", text.as_bytes(), &ReadOptions::default()), Err(RecordError::Malformed { .. })),
                "{text}"
            );
        }
    }
}
