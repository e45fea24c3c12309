use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::device::KinematicsKind;
use sprag_shared::structure::mount::Mount;

use super::drivetrain::{ActuationTable, FlywheelLossesTable};
use super::*;

const SCENE: &str = r#"
title = "a test"
[block]
size_m = 2.0
slenderness_deg = 10.0
[[device]]
kind = "none"
[[device]]
kind = "clutched-pair"
mass_ratio = 0.5
[[ground]]
motion = "sine"
amplitude_ratio = 2.0
frequency_ratio = 3.0
"#;

fn refused(overrides: &[&str]) -> String {
    let message = Scene::parse_with(SCENE, "scene.toml", overrides).expect_err("must be refused").to_string();
    assert!(!message.contains('\n'), "one line: {message}");
    assert!(message.starts_with("scene.toml"), "names the file: {message}");
    message
}

#[test]
fn defaults_are_the_papers() {
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    assert_eq!(scene.restitution, Restitution::Constant(0.85));
    assert_eq!(scene.geometry(), Geometry::Full);
    assert!((scene.block.inertia_ratio() - 4.0 / 3.0).abs() < 1e-15);
    let [none, pair] = scene.devices.as_slice() else { panic!("two devices") };
    assert_eq!((none.name.as_str(), pair.name.as_str()), ("none", "clutched pair"));
    assert_eq!((pair.device.mount, pair.device.kinematics), (Mount::CentreOfMass, KinematicsKind::Paper));
    assert!(none.is_ideal() && pair.is_ideal() && none.added_mass == AddedMass::NONE && pair.added_mass == AddedMass::NONE);
}

#[test]
fn a_value_outside_its_range_is_named_with_its_line() {
    let restitution = "restitution = \"bouncy\"\nslenderness_deg = 10.0";
    let record = "motion = \"record\"\nfile = \"a.csv\"\nunits = \"furlongs\"";
    for (written, wrong, message) in [
        ("size_m = 2.0", "size_m = 0", "scene.toml:4: block.size_m is 0, but must be from 0.001 to 10000 m"),
        ("slenderness_deg = 10.0", restitution, "scene.toml:5: block.restitution is \"bouncy\""),
        ("mass_ratio = 0.5", "mass_ratio = -0.5", "scene.toml:10: device.1.mass_ratio is -0.5"),
        (&SCENE[SCENE.find("motion").unwrap()..], record, "scene.toml:14: ground.0.units is \"furlongs\""),
    ] {
        let error = Scene::parse(&SCENE.replace(written, wrong), "scene.toml").unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    // One that no number of TOML can be is not yet that of a key.
    let error = Scene::parse(&SCENE.replace("size_m = 2.0", "size_m = 99999999999999999999999"), "scene.toml").unwrap_err();
    assert_eq!(error.to_string(), "scene.toml:4: integer number overflowed");
    // A value of the command line has none.
    assert!(refused(&["block.size_m=0"]).starts_with("scene.toml: block.size_m is 0"));
}

#[test]
fn each_device_needs_a_name_of_its_own() {
    for names in [&["device.0.name=a", "device.1.name=a"] as &[&str], &["device.0.name=clutched pair"]] {
        let message = refused(names);
        assert!(message.contains("device.1.name: ") && message.contains("is another device's"), "{message}");
    }
    Scene::parse_with(SCENE, "scene.toml", &["device.0.name=a"]).unwrap();
}

#[test]
fn a_key_with_a_line_break_is_named_on_one_line() {
    let error =
        Scene::parse(&SCENE.replace("size_m = 2.0", "size_m = 2.0\n\"a\\nb\" = 1"), "scene.toml").unwrap_err().to_string();
    assert!(error.starts_with(r"scene.toml:5: block.a\nb: unknown") && !error.contains('\n'), "{error}");
}

#[test]
fn an_error_names_the_key_the_value_and_what_it_may_be() {
    for (item, key, range) in [
        ("block.slenderness_deg=90", "block.slenderness_deg is 90", "below 90 degrees"),
        ("block.slenderness_deg=nan", "block.slenderness_deg is NaN", "below 90 degrees"),
        ("block.restitution=1.1", "block.restitution is 1.1", "from 0 to 1"),
        ("block.restitution_scatter=0.6", "block.restitution_scatter is 0.6", "from 0 to 0.5"),
        ("block.restitution_scatter=-0.01", "block.restitution_scatter is -0.01", "from 0 to 0.5"),
        ("block.restitution_scatter=nan", "block.restitution_scatter is NaN", "from 0 to 0.5"),
        ("block.restitution_seed=-1", "block.restitution_seed is -1", "a whole number from 0"),
        ("block.restitution_seed=1.5", "block.restitution_seed", "a whole number"),
        ("block.restitution_seed=18446744073709551615", "block.restitution_seed", "a whole number below 2^63"),
        ("block.restitution=bouncy", "block.restitution is \"bouncy\"", "geometric"),
        ("block.mass_kg=-3", "block.mass_kg is -3", "above 0 kg"),
        ("block.size_m=0", "block.size_m is 0", "from 0.001"),
        ("device.1.mass_ratio=-0.5", "mass_ratio is -0.5", "from 0 to 10000"),
        ("ground.0.frequency_ratio=0", "ground.0.frequency_ratio is 0", "from 0.001"),
        ("accuracy.tolerance=1", "accuracy.tolerance is 1", "from 1e-20"),
        ("run.rest_speed_ratio=0.5", "run.rest_speed_ratio is 0.5", "from 1e-12"),
    ] {
        let message = refused(&[item]);
        assert!(message.contains(key) && message.contains(range), "{item}: {message}");
    }
}

#[test]
fn unknown_keys_and_wrong_kinds_are_refused() {
    for item in ["block.weight=3", "colour=red", "block.size_m=long", "device.0.kind=damper", "ground.0.motion=square"] {
        refused(&[item]);
    }
    let message =
        Scene::parse(&SCENE.replace("size_m = 2.0", "size_m = 2.0\nsize_ft = 6"), "scene.toml").unwrap_err().to_string();
    assert!(
        message.starts_with("scene.toml:5: block") && message.contains("block.size_ft is not a key; did you mean `size_m`?"),
        "{message}"
    );
}

#[test]
fn the_key_or_the_word_that_was_probably_meant_is_named() {
    for (item, words) in [
        ("blok.size_m=3", "scene.toml: blok is not a key; did you mean `block`?"),
        ("device.1.mas_ratio=3", "device.1.mas_ratio is not a key; did you mean `mass_ratio`?"),
        ("device.1.clutch={capacity_ration=1}", "device.1.clutch.capacity_ration is not a key; did you mean `capacity_ratio`?"),
        ("checks={gear={modul_mm=1}}", "checks.gear.modul_mm is not a key; did you mean `module_mm`?"),
        (
            "controller.sensors.gyroscope={bias_degs=1}",
            "controller.sensors.gyroscope.bias_degs is not a key; did you mean `bias_deg_s`?",
        ),
        ("device.1.kind=inertr", "device.1.kind is \"inertr\"; did you mean \"inerter\"?"),
        ("ground.0.motion=sinus", "ground.0.motion is \"sinus\"; did you mean \"sine\"?"),
        ("device.1.kind=damper", "device.1.kind: unknown variant `damper`, expected one of `none`"),
        ("device.1.kind={}", "device.1.kind is a table, but must be a text in quotes"),
        ("device.1.kind={a=1, b=2}", "device.1.kind is a table, but must be a text in quotes"),
        ("block.colour=3", "unknown field `colour`, expected one of `size_m`"),
        ("accuracy.level=true", "accuracy.level: must be fast, normal, tight, or a relative error of the peak rotation"),
        ("accuracy.level=[1e-6]", "accuracy.level: must be fast, normal, tight, or a relative error of the peak rotation"),
    ] {
        let message = refused(&[item]);
        assert!(message.contains(words), "{item}: {message}");
    }
}

/// The core holds the ranges of devices too, for whoever calls it without a scene.
#[test]
fn ranges_of_a_device_are_those_of_the_core() {
    use crate::keys::Described;
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    let schema = &SceneFile::schema()["properties"]["device"]["items"]["properties"];
    let of_device = |change: &dyn Fn(&mut DeviceTable)| {
        let mut table = scene.file.device[1].clone();
        change(&mut table);
        scene.with_device(table).map(|_| ()).map_err(|error| error.to_string())
    };
    let of_actuation =
        |change: &dyn Fn(&mut ActuationTable)| of_device(&|device| change(device.actuation.insert(ActuationTable::default())));
    let of_flywheel = |change: &dyn Fn(&mut FlywheelLossesTable)| {
        of_device(&|device| change(device.flywheel.insert(FlywheelLossesTable::default())))
    };
    type Try<'a> = &'a dyn Fn(f64) -> Result<(), String>;
    let tries: [(&serde_json::Value, Try<'_>); 6] = [
        (&schema["mass_ratio"], &|value| of_device(&|device| device.mass_ratio = Some(value))),
        (&schema["actuation"]["properties"]["engagement_delay_s"], &|value| {
            of_actuation(&|actuation| actuation.engagement_delay_s = value)
        }),
        (&schema["actuation"]["properties"]["release_delay_s"], &|value| {
            of_actuation(&|actuation| actuation.release_delay_s = value)
        }),
        (&schema["actuation"]["properties"]["dwell_s"], &|value| of_actuation(&|actuation| actuation.dwell_s = value)),
        (&schema["actuation"]["properties"]["miss_probability"], &|value| {
            of_actuation(&|actuation| actuation.miss_probability = value)
        }),
        (&schema["flywheel"]["properties"]["viscous_rate_1_s"], &|value| of_flywheel(&|losses| losses.viscous_rate_1_s = value)),
    ];
    for (schema, within) in tries {
        let [low, high] = ["minimum", "maximum"].map(|name| schema[name].as_f64().unwrap());
        for (value, allowed) in [(low, true), (high, true), (low - 0.1, false), (high * 1.01, false)] {
            assert_eq!(within(value).is_ok(), allowed, "{value} of {schema}: {:?}", within(value));
        }
    }
}

#[test]
fn contradictions_are_refused_with_the_reason() {
    for (items, reason) in [
        (&["device.0.mass_ratio=0.5"][..], "has no inerter"),
        (&["block.frequency_parameter_1_s=2"], "only one of"),
        (&["device.1.inertance_kg=100"], "only one of"),
        (&["ground.0.amplitude_g=0.3"], "only one of"),
        (&["ground.0.duration_s=1"], "no such key"),
        (&["device.1.mount=tying-point"], "height"),
        (&["device.1.mount_height_m=2"], "tying-point"),
        (&["accuracy.method=runge-kutta-4"], "step"),
        (&["accuracy.precision=f32"], "fixed step"),
        (&["accuracy.events=step-end"], "step-end"),
        (&["run.free_time_s=1", "run.free_time_ratio=1"], "only one of"),
        (&["ground=[]"], "free rocking"),
        (&["device=[]"], "a list of 1 to 16"),
    ] {
        let message = refused(items);
        assert!(message.contains(reason), "{items:?}: {message}");
    }
}

#[test]
fn a_flywheel_train_gives_the_mass_ratio_of_equation_8() {
    let text = SCENE.replace("mass_ratio = 0.5", "flywheels = [{ mass_kg = 3.0, radius_m = 0.4, pinion_radius_m = 0.1 }]");
    let message = Scene::parse(&text, "scene.toml").unwrap_err().to_string();
    assert!(message.contains("needs block.mass_kg"), "{message}");
    let scene = Scene::parse_with(&text, "scene.toml", &["block.mass_kg=48"]).unwrap();
    // ½ · 3 · (0.4/0.1)² / 48 = 0.5.
    assert!((scene.devices[1].device.mass_ratio - 0.5).abs() < 1e-15);
}

#[test]
fn every_scene_of_the_repository_is_read() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        // Studies are not scenes.
        let is_study = path.ends_with("cloud.toml") || path.ends_with("optimise.toml");
        if !is_study && path.extension().is_some_and(|extension| extension == "toml") {
            let scene = Scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
            assert!(!scene.file.title.is_empty(), "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 8, "{count} scenes");
}
