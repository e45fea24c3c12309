//! Settings as text: `NAME=VALUE` on a command line, and TOML files.

use sprag_shared::settings::Settings;
use sprag_shared::settings::assemble::AnyController;
use sprag_shared::settings::kind::{Description, Kind, Use};
use sprag_shared::settings::wiring::Wiring;

/// The parameter called `name`.
///
/// # Errors
/// One line, where there is none.
pub fn find(name: &str) -> Result<(u16, &'static Description), String> {
    Description::find(name).ok_or_else(|| format!("there is no parameter {name}; \"sprag device parameters\" lists them"))
}

/// Gives the parameter called `name` the value `text`.
///
/// # Errors
/// One line that names the parameter, the value and what it may be; then nothing has changed.
pub fn set(settings: &mut Settings, name: &str, text: &str) -> Result<(), String> {
    let (index, description) = find(name)?;
    let word = description.parse(text).ok_or_else(|| format!("{name} is {text}, but must be {}", description.range()))?;
    settings.set(index, word).map_err(|error| error.describe(settings).to_string())
}

/// As [`set`], of `NAME=VALUE`.
///
/// # Errors
/// As [`set`].
pub fn assign(settings: &mut Settings, assignment: &str) -> Result<(), String> {
    let (name, text) = assignment.split_once('=').ok_or_else(|| format!("{assignment}: should be NAME=VALUE"))?;
    set(settings, name.trim(), text.trim())
}

/// Whether a controller and a board can be made of them.
///
/// # Errors
/// One line that names two parameters that contradict each other.
pub fn check(settings: &Settings) -> Result<(), String> {
    let both = AnyController::of(settings).and_then(|_| Wiring::check(settings));
    both.map_err(|error| error.describe(settings).to_string())
}

/// All of them as a TOML file, with unit and range beside each.
pub fn to_toml(settings: &Settings) -> String {
    let mut text = String::from("# Parameters of a device: sprag device parameters --file THIS --port DEV\n");
    for (description, &word) in Description::all().iter().zip(settings.words()) {
        let value = description.show(word);
        let quote = if matches!(description.kind, Kind::Choice(_)) { "\"" } else { "" };
        text.push_str(&format!("\"{}\" = {quote}{value}{quote} # {}\n", description.name, description.range()));
    }
    text
}

/// What such a file says, over `settings`; what it does not name stays.
///
/// # Errors
/// One line that names the file and what is wrong.
pub fn from_toml(settings: &Settings, file: &str, text: &str) -> Result<Settings, String> {
    let table: toml::Table =
        text.parse().map_err(|error: toml::de::Error| format!("{file}: {}", error.to_string().trim_end().replace('\n', " ")))?;
    let mut settings = *settings;
    for (name, value) in &table {
        let text = match value {
            toml::Value::String(text) => text.clone(),
            toml::Value::Integer(_) | toml::Value::Float(_) | toml::Value::Boolean(_) => value.to_string(),
            _ => return Err(format!("{file}: {name}: should be a number, true, false or a name in quotes")),
        };
        set(&mut settings, name, &text).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(settings)
}

/// `settings` with the board's own parameters of `board`: a scene says nothing about how a board is wired.
pub fn with_board_of(settings: &Settings, board: &Settings) -> Settings {
    let mut settings = *settings;
    for (index, _) in (0..).zip(Description::all()).filter(|(_, description)| description.used == Use::Board) {
        if let Some(word) = board.get(index) {
            // In force somewhere, so within its range.
            let _ = settings.set(index, word);
        }
    }
    settings
}

/// A table of all of them: name, value, unit, range, default; a star marks those that the present choice of body, estimator and law does
/// not read.
pub fn table(settings: &Settings) -> String {
    let rows: Vec<[String; 5]> = Description::all()
        .iter()
        .zip(settings.words())
        .map(|(description, &word)| {
            let unread = description.used != Use::Board && !description.applies(settings);
            [
                format!("{}{}", description.name, if unread { " *" } else { "" }),
                description.show(word).to_string(),
                description.unit.to_owned(),
                description.show(description.default).to_string(),
                description.range().to_string(),
            ]
        })
        .collect();
    let heads = ["parameter", "value", "unit", "default", "range"].map(str::to_owned);
    let wide = |column: usize| rows.iter().chain([&heads]).map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3].map(wide);
    let mut text = String::new();
    for row in [&heads].into_iter().chain(&rows) {
        let [name, value, unit, default, range] = row;
        let [a, b, c, d] = widths;
        text.push_str(&format!("{name:a$}  {value:>b$}  {unit:c$}  {default:>d$}  {range}\n"));
    }
    text.push_str("* not read with this body, estimator and law\n");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_restores_every_bit() {
        let mut settings = Settings::default();
        for (index, description) in (0..).zip(Description::all()) {
            for word in [description.least, description.most, description.default] {
                settings.set(index, word).unwrap();
                assert_eq!(from_toml(&Settings::default(), "a.toml", &to_toml(&settings)), Ok(settings), "{}", description.name);
            }
        }
        for bits in [0x3DCC_CCCD_u32, 0x3F80_0001, 0x3E99_999A, 0x3EAA_AAAB, 0x3F7F_FFFF] {
            let (index, _) = find("model.coupling").unwrap();
            settings.set(index, bits).unwrap();
            assert_eq!(from_toml(&Settings::default(), "a.toml", &to_toml(&settings)), Ok(settings), "{bits:x}");
        }
    }

    #[test]
    fn errors_name_parameter_value_and_range() {
        let mut settings = Settings::default();
        let before = settings;
        let said = |settings: &mut Settings, text: &str| assign(settings, text).unwrap_err();
        assert_eq!(said(&mut settings, "model.size=2000"), "model.size is 2000, but must be from 0.001 to 1000 m");
        assert_eq!(said(&mut settings, "model.size=NaN"), "model.size is NaN, but must be from 0.001 to 1000 m");
        assert_eq!(said(&mut settings, "model.size=big"), "model.size is big, but must be from 0.001 to 1000 m");
        assert!(said(&mut settings, "law=best").starts_with("law is best, but must be one of passive, always-engaged"));
        assert!(said(&mut settings, "siz=1").starts_with("there is no parameter siz"));
        assert_eq!(said(&mut settings, "siz"), "siz: should be NAME=VALUE");
        assert_eq!(settings, before);
        assert_eq!(
            from_toml(&before, "a.toml", "law = [1]").unwrap_err(),
            "a.toml: law: should be a number, true, false or a name in quotes"
        );
        for text in ["law = 1", "\"model.size\" = \"a\nb\"", "law", "\"supervisor.both_allowed\" = 1"] {
            let error = from_toml(&before, "a.toml", text).unwrap_err();
            assert!(error.starts_with("a.toml: ") && !error.contains('\n'), "{error}");
        }
        assign(&mut settings, "supervisor.calibration_time = 3.5").unwrap();
        assert!(check(&settings).unwrap_err().contains("supervisor.calibration_patience"));
    }

    #[test]
    fn a_scene_does_not_rewire_a_board() {
        let mut board = Settings::default();
        assign(&mut board, "board.ground_up_axis=-z").unwrap();
        let mut scene = Settings::default();
        assign(&mut scene, "law=passive").unwrap();
        let both = with_board_of(&scene, &board);
        assign(&mut scene, "board.ground_up_axis=-z").unwrap();
        assert_eq!(both, scene);
    }
}
