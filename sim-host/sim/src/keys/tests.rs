use super::list::keys;
use super::*;
use crate::scene::schema::SceneFile;

fn scene_key(path: &str) -> Key {
    keys(SceneFile::schema()).into_iter().find(|key| key.path == path).unwrap_or_else(|| panic!("{path}"))
}

#[test]
fn every_key_has_a_meaning_in_one_line() {
    for key in keys(SceneFile::schema()) {
        assert!(key.meaning.ends_with('.') && !key.range.is_empty(), "{key:?}");
    }
}

#[test]
fn ranges_are_in_words_with_the_unit_of_the_key() {
    for (path, range) in [
        ("block.size_m", "from 0.001 to 10000 m"),
        ("block.slenderness_deg", "above 0 and below 90 degrees"),
        ("block.mass_kg", "above 0 kg"),
        ("block.restitution", "from 0 to 1, \"geometric\" or \"momentum-balance\""),
        ("device.N.kind", "\"none\", \"inerter\" or \"clutched-pair\""),
        ("device.N.clutch.damping_n_s_m", "0 N s/m or more"),
        ("device.N.actuation.miss_seed", "a whole number from 0"),
        ("controller.engaged_at_rest", "true or false"),
        ("controller.sensors.gyroscope", "\"ideal\", \"icm-42688-p\", \"bmi088\", \"adis16470\", \"mpu-6050\" or a table"),
        ("map.x.cells", "from 2 to 100000"),
    ] {
        assert_eq!(scene_key(path).range, range, "{path}");
    }
}

#[test]
fn defaults_are_those_of_the_types() {
    assert_eq!(scene_key("block.restitution").default, Some(0.85.into()));
    assert_eq!(scene_key("controller.substeps").default, Some(4.into()));
    assert_eq!(scene_key("block.size_m").default, None);
    assert!(scene_key("block.slenderness_deg").required && !scene_key("block.inertia_ratio").required);
}

#[test]
fn schemas_have_no_null_which_toml_cannot_write() {
    fn is_free_of_null(schema: &Value) -> bool {
        match schema {
            Value::Null => false,
            Value::String(text) => text != "null",
            Value::Array(values) => values.iter().all(is_free_of_null),
            Value::Object(values) => values.values().all(is_free_of_null),
            _ => true,
        }
    }
    assert!(is_free_of_null(SceneFile::schema()));
}

#[test]
fn both_ends_of_every_range_are_held() {
    use bounds::Bounds;
    let closed = Bounds::from(0.0..=1.0);
    let open = Bounds { low: Some((0.0, false)), high: Some((1.0, false)) };
    assert!(closed.allow(0.0) && closed.allow(1.0) && !closed.allow(-f64::MIN_POSITIVE) && !closed.allow(1.0 + f64::EPSILON));
    assert!(!open.allow(0.0) && !open.allow(1.0) && open.allow(f64::MIN_POSITIVE));
    let none = Bounds { low: None, high: None };
    assert!(none.allow(f64::MAX) && [f64::NAN, f64::INFINITY, -f64::INFINITY].iter().all(|value| !none.allow(*value)));
}
