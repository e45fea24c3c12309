//! Settings as text: `NAME=VALUE` on a command line, and TOML files.

use serde::Serialize;
use serde_json::Value;
use sprag_shared::control::controller::Controller;
use sprag_shared::settings::Settings;
use sprag_shared::settings::kind::{Description, Kind, Use};
use sprag_shared::settings::wiring::Wiring;

use super::derived::{self, Given};

/// The parameter called `name`.
///
/// # Errors
/// One line, where there is none.
pub fn find(name: &str) -> Result<(u16, &'static Description), String> {
    Description::find(name).ok_or_else(|| format!("there is no parameter {name}; \"sprag board parameters\" lists them"))
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

/// Gives every parameter of `assignments` (name and value) its value, and lets those follow that depend on them ([`derived`]).
///
/// # Errors
/// As [`set`], and one line for values that contradict each other; then nothing has changed.
pub fn assign<'a>(settings: &mut Settings, assignments: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<(), String> {
    let (mut after, mut given) = (*settings, Given::default());
    for (name, text) in assignments {
        match name {
            derived::INERTIA_RATIO => given.inertia_ratio = Some(derived::parse(name, text)?),
            derived::MASS_RATIO => given.mass_ratio = Some(derived::parse(name, text)?),
            _ => {
                set(&mut after, name, text)?;
                given.words.push(find(name)?.0);
            }
        }
    }
    derived::follow(settings, &given, &mut after)?;
    *settings = after;
    Ok(())
}

/// Name and value of `NAME=VALUE`, each as it can be by itself.
///
/// # Errors
/// One line for what is no such assignment, or a value outside its range.
pub fn assignment(text: &str) -> Result<(&str, &str), String> {
    let (name, value) = text.split_once('=').ok_or_else(|| format!("{text}: should be NAME=VALUE"))?;
    let (name, value) = (name.trim(), value.trim());
    alone(name, value)?;
    Ok((name, value))
}

/// Whether `name` may be `value`, whatever the others are.
fn alone(name: &str, value: &str) -> Result<(), String> {
    if [derived::INERTIA_RATIO, derived::MASS_RATIO].contains(&name) {
        derived::parse(name, value).map(|_| ())
    } else {
        set(&mut Settings::default(), name, value)
    }
}

/// A parameter, for JSON.
#[derive(Debug, Serialize)]
pub struct ParameterRow {
    name: &'static str,
    value: Value,
    unit: &'static str,
    default: Value,
    range: String,
}

/// Parameters, for JSON.
#[derive(Debug, Serialize)]
pub struct ParameterDocument {
    parameters: Vec<ParameterRow>,
}

/// The parameters of these `names`, for JSON; without any every one.
pub fn described(settings: &Settings, names: &[String]) -> ParameterDocument {
    // A number where it is one, otherwise a word.
    let json = |text: String| serde_json::from_str(&text).unwrap_or(Value::String(text));
    let asked = |name: &str| names.iter().any(|asked| asked == name);
    let row = |(description, &word): (&'static Description, &u32)| ParameterRow {
        name: description.name,
        value: json(description.show(word).to_string()),
        unit: description.unit,
        default: json(description.show(description.default).to_string()),
        range: description.range().to_string(),
    };
    let words = Description::all().iter().zip(settings.words()).filter(|(it, _)| names.is_empty() || asked(it.name)).map(row);
    let following = |name: &'static str| {
        let of = |settings: &Settings| value(settings, name).ok().map(json);
        let (value, default) = (of(settings)?, of(&Settings::default())?);
        Some(ParameterRow { name, value, unit: "", default, range: derived::range(name).to_owned() })
    };
    let followed = [derived::INERTIA_RATIO, derived::MASS_RATIO].into_iter().filter(|name| asked(name)).filter_map(following);
    ParameterDocument { parameters: words.chain(followed).collect() }
}

/// The value of the parameter called `name`, or of a quantity that follows from several.
///
/// # Errors
/// One line, where there is none.
pub fn value(settings: &Settings, name: &str) -> Result<String, String> {
    if let Some(quantity) = derived::quantity(settings, name) {
        return Ok((quantity as f32).to_string());
    }
    let (index, description) = find(name)?;
    Ok(description.show(settings.get(index).unwrap_or(description.default)).to_string())
}

/// Whether a controller and a board can be made of them, and whether the block is one.
///
/// # Errors
/// One line that names two parameters that contradict each other.
pub fn check(settings: &Settings) -> Result<(), String> {
    let both = Controller::of(settings).and_then(|_| Wiring::check(settings));
    both.map_err(|error| error.describe(settings).to_string())?;
    derived::check(settings)
}

/// All of them as a TOML file, with unit and range beside each.
pub fn to_toml(settings: &Settings) -> String {
    let mut text = String::from("# Parameters of a device: sprag board parameters --file THIS --port DEV\n");
    for (description, &word) in Description::all().iter().zip(settings.words()) {
        let value = match description.show(word).to_string() {
            // Without a point it would be an integer, which has no sign at zero.
            zero if zero == "-0" => "-0.0".to_owned(),
            value => value,
        };
        let quote = if matches!(description.kind, Kind::Choice(_)) { "\"" } else { "" };
        text.push_str(&format!("\"{}\" = {quote}{value}{quote} # {}\n", description.name, description.range()));
    }
    text
}

/// The assignments of such a file, each as it can be by itself.
///
/// # Errors
/// One line that names the file and what is wrong.
pub fn of_toml(file: &str, text: &str) -> Result<Vec<(String, String)>, String> {
    let table: toml::Table =
        text.parse().map_err(|error: toml::de::Error| format!("{file}: {}", error.to_string().trim_end().replace('\n', " ")))?;
    let each = |(name, value): (&String, &toml::Value)| {
        let text = match value {
            toml::Value::String(text) => text.clone(),
            toml::Value::Integer(_) | toml::Value::Float(_) | toml::Value::Boolean(_) => value.to_string(),
            _ => return Err(format!("{file}: {name}: should be a number, true, false or a name in quotes")),
        };
        alone(name, &text).map_err(|error| format!("{file}: {error}"))?;
        Ok((name.clone(), text))
    };
    table.iter().map(each).collect()
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

/// How many parameters differ and from when to when they are in force, also from flash where they are `stored`; a board's own are taken over
/// when it starts.
pub fn changed(before: &Settings, now: &Settings, stored: bool) -> String {
    let differing = |by_board: bool| {
        let words = before.words().iter().zip(now.words());
        let differ = |(description, (before, now)): &(&'static Description, (&u32, &u32))| {
            before != now && (description.used == Use::Board) == by_board
        };
        Description::all().iter().zip(words).filter(differ).count()
    };
    let counted = |count: usize| if count == 1 { "1 parameter".to_owned() } else { format!("{count} parameters") };
    let (controllers, boards) = (differing(false), differing(true));
    let mut text = String::new();
    if controllers > 0 || boards == 0 {
        let until = if stored { "and kept in flash" } else { "until the next start; --store keeps them" };
        text.push_str(&format!("{} changed; in force {until}\n", counted(controllers)));
    }
    if boards > 0 {
        let when = if stored {
            "kept in flash, in force from the next start on"
        } else {
            "without effect: only a start takes them over, and only from flash (--store)"
        };
        text.push_str(&format!("{} of board.* changed; {when}\n", counted(boards)));
    }
    text
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
    for name in [derived::INERTIA_RATIO, derived::MASS_RATIO] {
        if let Ok(value) = value(settings, name) {
            text.push_str(&format!("{name} {value} follows from them, and can be set, too\n"));
        }
    }
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
        for bits in [0x8000_0000, 0x3DCC_CCCD_u32, 0x3F80_0001, 0x3E99_999A, 0x3EAA_AAAB, 0x3F7F_FFFF] {
            let (index, _) = find("model.coupling").unwrap();
            settings.set(index, bits).unwrap();
            assert_eq!(from_toml(&Settings::default(), "a.toml", &to_toml(&settings)), Ok(settings), "{bits:x}");
        }
    }

    fn from_toml(settings: &Settings, file: &str, text: &str) -> Result<Settings, String> {
        let (mut settings, assignments) = (*settings, of_toml(file, text)?);
        assign(&mut settings, assignments.iter().map(|(name, text)| (name.as_str(), text.as_str())))?;
        Ok(settings)
    }

    fn assigned(settings: &mut Settings, text: &str) -> Result<(), String> {
        assign(settings, text.split(", ").map(assignment).collect::<Result<Vec<_>, _>>()?)
    }

    /// The settings of the desk's scene with other values.
    fn of_scene(changes: &[&str]) -> Settings {
        let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/controller.toml"));
        let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
        let desk =
            crate::command::loop_scene::load(path, &changes, &crate::command::record_arguments::SceneRecordArguments::default())
                .unwrap();
        desk.task(0, 1, &sprag_sim::interrupt::Interrupt::default()).settings().unwrap()
    }

    #[test]
    fn dependent_parameters_follow_as_in_a_scene_of_that_block() {
        let brake =
            "device.0={kind=\"clutched-pair\",mass_ratio=0.5,engagement=\"rigid\",flywheel={brake_deceleration_m_s2=5.0}}";
        for (set, changes) in [
            ("model.size=2.5", &["block.size_m=2.5"][..]),
            ("model.slenderness=0.2617993877991494", &["block.slenderness_deg=15"]),
            ("model.inertia_ratio=1.5", &["block.inertia_ratio=1.5"]),
            ("model.mass_ratio=0.8", &["device.0.mass_ratio=0.8"]),
            ("model.restitution=0.7", &["block.restitution=0.7"]),
            (
                "model.size=1, model.slenderness=0.2617993877991494, model.inertia_ratio=1.5, model.mass_ratio=0.2",
                &["block.size_m=1", "block.slenderness_deg=15", "block.inertia_ratio=1.5", "device.0.mass_ratio=0.2"],
            ),
        ] {
            // A brake is a deceleration over R.
            let with: Vec<&str> = [&[brake], changes].concat();
            let (mut settings, expected) = (of_scene(&[brake]), of_scene(&with));
            assigned(&mut settings, set).unwrap();
            assert_eq!(check(&settings), Ok(()), "{set}");
            for (index, description) in (0..).zip(Description::all()) {
                let own = description.name.starts_with("model.")
                    || ["instruments.travel_per_count", "monitor.encoder.counts_per_radian"].contains(&description.name);
                if let (true, Some(is), Some(should)) = (own, settings.get(index), expected.get(index)) {
                    let (is, should) = (f32::from_bits(is), f32::from_bits(should));
                    assert!((is - should).abs() <= 1e-6 * should.abs(), "{set}: {} is {is}, not {should}", description.name);
                }
            }
        }
    }

    #[test]
    fn contradictions_are_refused_with_both_names_and_what_was_expected() {
        for (set, words) in [
            (
                "model.size=2.5, model.frequency=1.9176793",
                &["model.frequency is 1.9176793", "1.7152", "model.size = 2.5 m", "1.3333"][..],
            ),
            ("model.frequency=3", &["model.frequency is 3 1/s", "1.91767", "model.size = 2 m", "model.inertia_ratio"]),
            ("model.frequency_squared=3", &["model.frequency_squared is 3 1/s²", "3.67749", "model.size = 2 m"]),
            (
                "model.slenderness=0.3, model.uplift=0.1763",
                &["model.uplift is 0.1763 g", "0.3093", "model.slenderness = 0.3 rad"],
            ),
            ("model.uplift=0.9", &["model.uplift is 0.9 g", "0.1763", "model.slenderness = 0.17453292 rad"]),
            ("model.mass_ratio=0.8, model.coupling=0.375", &["model.coupling is 0.375", "0.6", "model.mass_ratio = 0.8"]),
            (
                "model.size=50, model.frequency=1.9176793, model.frequency_squared=3.677494",
                &["model.size = 50 m", "model.frequency = 1.91", "0.0533"],
            ),
            ("model.inertia_ratio=0.5", &["model.inertia_ratio is 0.5, but must be from 1 to 4"]),
            ("body.lever_along=1.2, model.restitution=0.5, body.lever_across=0.1, model.size=NaN", &["model.size is NaN"]),
        ] {
            let mut settings = Settings::default();
            let error = assigned(&mut settings, set).and_then(|()| check(&settings)).expect_err(set);
            assert!(words.iter().all(|word| error.contains(word)) && !error.contains('\n'), "{set}: {error}");
        }
        // Levers of a mount that is elsewhere are not known from size and slenderness.
        let mut settings = Settings::default();
        assigned(&mut settings, "body.lever_along=1.2").unwrap();
        let error = assigned(&mut settings, "model.size=3").unwrap_err();
        assert!(error.contains("body.lever_along = 1.2") && error.contains("--scene"), "{error}");
        assert_eq!(value(&settings, "model.size").as_deref(), Ok("2"), "nothing has changed");
    }

    #[test]
    fn inertia_and_mass_ratio_are_read_from_the_words() {
        let mut settings = Settings::default();
        let near =
            |settings: &Settings, name: &str, to: f32| (value(settings, name).unwrap().parse::<f32>().unwrap() - to).abs() < 1e-5;
        assert!(near(&settings, "model.inertia_ratio", 4.0 / 3.0) && near(&settings, "model.mass_ratio", 0.5));
        assigned(&mut settings, "model.inertia_ratio=1.6, model.mass_ratio=0.9").unwrap();
        assert!(near(&settings, "model.inertia_ratio", 1.6) && near(&settings, "model.mass_ratio", 0.9));
        assert!(value(&settings, "model.width").is_err());
    }

    #[test]
    fn errors_name_parameter_value_and_range() {
        let mut settings = Settings::default();
        let before = settings;
        let said = |settings: &mut Settings, text: &str| assigned(settings, text).unwrap_err();
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
        assigned(&mut settings, "supervisor.calibration_time = 3.5").unwrap();
        assert!(check(&settings).unwrap_err().contains("supervisor.calibration_patience"));
    }

    #[test]
    fn json_has_the_parameters_that_were_asked_for() {
        let names = |asked: &[&str]| {
            let asked: Vec<String> = asked.iter().map(|name| (*name).to_owned()).collect();
            let rows = described(&Settings::default(), &asked).parameters;
            rows.into_iter().map(|row| (row.name, row.value)).collect::<Vec<_>>()
        };
        assert_eq!(names(&[]).len(), Description::all().len());
        assert_eq!(names(&["law"]), [("law", Value::from("resisting-predicted"))]);
        let both = names(&["model.inertia_ratio", "model.size"]);
        assert_eq!(both[0], ("model.size", Value::from(2)));
        assert!(both.len() == 2 && both[1].0 == "model.inertia_ratio" && both[1].1.is_f64(), "{both:?}");
    }

    #[test]
    fn what_a_board_takes_over_at_a_start_is_said_so() {
        let before = Settings::default();
        let said = |text: &str, stored| {
            let mut now = before;
            assigned(&mut now, text).unwrap();
            changed(&before, &now, stored)
        };
        for (text, stored, line) in [
            ("law=passive", false, "1 parameter changed; in force until the next start; --store keeps them\n"),
            ("law=passive", true, "1 parameter changed; in force and kept in flash\n"),
            ("law=resisting-predicted", true, "0 parameters changed; in force and kept in flash\n"),
            (
                "board.encoder_reversed=true",
                true,
                "1 parameter of board.* changed; kept in flash, in force from the next start on\n",
            ),
        ] {
            assert_eq!(said(text, stored), line, "{text}");
        }
        let both = said("law=passive, board.encoder_reversed=true, board.coil_hold_share=0.5", false);
        assert!(
            both.starts_with("1 parameter changed; in force until")
                && both.contains("\n2 parameters of board.* changed; without effect"),
            "{both}"
        );
    }

    #[test]
    fn a_scene_does_not_rewire_a_board() {
        let mut board = Settings::default();
        assigned(&mut board, "board.ground_up_axis=-z").unwrap();
        let mut scene = Settings::default();
        assigned(&mut scene, "law=passive").unwrap();
        let both = with_board_of(&scene, &board);
        assigned(&mut scene, "board.ground_up_axis=-z").unwrap();
        assert_eq!(both, scene);
    }
}
