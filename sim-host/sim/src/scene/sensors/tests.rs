use super::*;
use crate::scene::Scene;
use crate::sensor::preset::DEGREE;

const SCENE: &str = r#"
block = { size_m = 2.0, slenderness_deg = 10.0, initial_rotation_ratio = 0.5 }
device = [{ kind = "none" }]
"#;

/// The scene with `text` as its sensors.
fn scene(text: &str) -> Result<Scene, String> {
    let mut scene: toml::Table = SCENE.parse().unwrap();
    let controller = toml::Table::from_iter([("sensors".to_owned(), text.parse::<toml::Table>().unwrap().into())]);
    scene.insert("controller".to_owned(), controller.into());
    Scene::of_table(scene, "scene").map_err(|error| error.to_string())
}

fn table(text: &str) -> Result<SensorsTable, String> {
    scene(text).map(|scene| scene.file.controller.unwrap().sensors)
}

fn resolved(text: &str) -> Result<Suite, String> {
    scene(text).map(|scene| scene.file.controller.unwrap().suite("scene").unwrap())
}

#[test]
fn without_a_key_sensors_are_ideal() {
    assert_eq!(resolved(""), Ok(Suite::IDEAL));
    assert_eq!(table("").unwrap().seed(), 1);
    assert_eq!(table("seed = 7").unwrap().seed(), 7);
}

#[test]
fn presets_are_found_by_name_and_single_ones_go_before_the_suite() {
    let suite = resolved("suite = \"icm-42688-p\"\nground_accelerometer = \"adxl355\"\nencoder = \"amt102-v\"").unwrap();
    assert_eq!(suite.gyroscope, preset::ICM_42688_P_GYROSCOPE);
    assert_eq!(suite.block_accelerometer, preset::ICM_42688_P_ACCELEROMETER);
    assert_eq!(suite.ground_accelerometer, preset::ADXL355_ACCELEROMETER);
    assert_eq!(suite.encoder, preset::AMT102_V);
    for name in preset::names(preset::SUITES) {
        assert!(resolved(&format!("suite = \"{name}\"")).is_ok());
    }
    for (place, names) in [
        ("gyroscope", preset::names(preset::GYROSCOPES).collect::<Vec<_>>()),
        ("block_accelerometer", preset::names(preset::ACCELEROMETERS).collect()),
        ("encoder", preset::names(preset::ENCODERS).collect()),
    ] {
        for name in names {
            assert!(resolved(&format!("{place} = \"{name}\"")).is_ok());
            // Every preset lies within the ranges that a table is held to.
            assert!(resolved(&format!("{place} = {{ preset = \"{name}\", latency_s = 0.001 }}")).is_ok());
        }
    }
}

#[test]
fn keys_of_a_table_change_its_preset() {
    let suite = resolved(
        "[gyroscope]\npreset = \"ideal\"\nnoise_density_deg_s_rthz = 0.003\nbandwidth_hz = 200\nrate_hz = 4000\nlatency_s = 0.001\n\
         [block_accelerometer]\npreset = \"bmi088\"\nbias_mg = 0\nmisalignment_deg = 2\n\
         [encoder]\ncounts_per_revolution = 4000\npinion_radius_m = 0.02",
    )
    .unwrap();
    let close = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-12;
    assert!(close(suite.gyroscope.noise_density, 5.235_987_755_982_989e-5));
    assert_eq!((suite.gyroscope.bandwidth, suite.gyroscope.sampling.rate, suite.gyroscope.bias), (200.0, 4000.0, 0.0));
    assert_eq!((suite.gyroscope.sampling.latency, suite.gyroscope.sampling.synchronous), (0.001, true));
    assert_eq!((suite.block_accelerometer.bias, suite.block_accelerometer.bandwidth), (0.0, 280.0));
    assert!(close(suite.block_accelerometer.misalignment, 0.034_906_585_039_886_59));
    assert!(close(suite.encoder.resolution, 3.141_592_653_589_793e-5));
    let smaller = resolved("encoder = { preset = \"amt102-v\", pinion_radius_m = 0.025 }").unwrap();
    assert!(close(smaller.encoder.resolution, 0.5 * preset::AMT102_V.resolution));
    // Without a preset, from the suite's.
    let changed = resolved("suite = \"mpu-6050\"\n[gyroscope]\nbias_deg_s = 1").unwrap();
    assert_eq!(changed.gyroscope, Inertial { bias: DEGREE, ..preset::MPU_6050_GYROSCOPE });
}

#[test]
fn what_is_wrong_is_named_with_what_is_allowed() {
    for (text, message) in [
        (
            "gyroscope = \"icm\"",
            "scene: controller.sensors.gyroscope is \"icm\", but must be one of \"ideal\", \"icm-42688-p\", \"bmi088\", \
             \"adis16470\", \"mpu-6050\"",
        ),
        (
            "suite = \"adxl355\"",
            "scene: controller.sensors.suite is \"adxl355\", but must be one of \"ideal\", \"icm-42688-p\", \"bmi088\", \
             \"adis16470\", \"mpu-6050\"",
        ),
        (
            "encoder = { preset = \"lm11\" }",
            "scene: controller.sensors.encoder.preset is \"lm11\", but must be one of \"ideal\", \"lm10\", \"lm10-1um\", \
             \"lm10-10um\", \"amt102-v\"",
        ),
        (
            "gyroscope = { bias_deg_s = -1 }",
            "scene: controller.sensors.gyroscope.bias_deg_s is -1, but must be from 0 to 100 °/s",
        ),
        (
            "gyroscope = { bias_deg_s = nan }",
            "scene: controller.sensors.gyroscope.bias_deg_s is NaN, but must be from 0 to 100 °/s",
        ),
        (
            "ground_accelerometer = { bandwidth_hz = 0.01 }",
            "scene: controller.sensors.ground_accelerometer.bandwidth_hz is 0.01, but must be 0 (none), or from 0.1 to 100000",
        ),
        (
            "gyroscope = { rate_hz = 0.5 }",
            "scene: controller.sensors.gyroscope.rate_hz is 0.5, but must be 0 (continuous), or from 1 to 100000",
        ),
        (
            "gyroscope = { noise_density_deg_s_rthz = 0.01 }",
            "scene: controller.sensors.gyroscope.noise_density_deg_s_rthz: white noise needs a band: give bandwidth_hz or rate_hz",
        ),
        (
            "block_accelerometer = { drift_mg = 1 }",
            "scene: controller.sensors.block_accelerometer.drift_correlation_time_s is missing: the correlation time of drift_mg",
        ),
        (
            "gyroscope = { jitter_s = 1e-5 }",
            "scene: controller.sensors.gyroscope.jitter_s: a sensor that is read continuously has no instants to move: give rate_hz",
        ),
        (
            "gyroscope = { rate_hz = 1000, jitter_s = 2e-4 }",
            "scene: controller.sensors.gyroscope.jitter_s is 0.0002, but must be from 0 to a tenth of the period, 0.0001 s",
        ),
        (
            "gyroscope = { preset = \"icm-42688-p\", latency_s = 0.01 }",
            "scene: controller.sensors.gyroscope.latency_s is 0.01, but must be at most 32 periods, 0.004 s",
        ),
        (
            "gyroscope = { full_scale_deg_s = 1, resolution_deg_s = 2 }",
            "scene: controller.sensors.gyroscope.resolution_deg_s: one step is more than the full scale",
        ),
        (
            "encoder = { resolution_m = 0 }",
            "scene: controller.sensors.encoder.resolution_m is 0, but must be from 1e-9 to 0.01 m",
        ),
        (
            "encoder = { resolution_m = 1e-5, pinion_radius_m = 0.1 }",
            "scene: controller.sensors.encoder.resolution_m: counts_per_revolution and pinion_radius_m already say it: give one or the \
             other",
        ),
        (
            "encoder = { counts_per_revolution = 4000 }",
            "scene: controller.sensors.encoder.pinion_radius_m is missing: the pinion that the encoder is on",
        ),
        (
            "encoder = { preset = \"lm10\", pinion_radius_m = 0.1 }",
            "scene: controller.sensors.encoder.counts_per_revolution is missing: the encoder is not one that a pinion turns",
        ),
    ] {
        assert_eq!(resolved(text).unwrap_err(), message);
    }
}

#[test]
fn keys_that_do_not_exist_are_refused_by_name() {
    let message = table("gyroscope = { bias_mg = 1 }").unwrap_err();
    assert!(
        message.contains("gyroscope") && message.contains("gyroscope.bias_mg is not a key; did you mean `bias_deg_s`?"),
        "{message}"
    );
    let message = table("gyroscope = 3").unwrap_err();
    assert!(message.contains("gyroscope is 3, but must be \"ideal\"") && message.contains("or a table"), "{message}");
    assert!(table("seed = -1").is_err());
    assert!(table("thermometer = \"ideal\"").unwrap_err().contains("unknown field `thermometer`"));
}

#[test]
fn tables_are_written_as_they_are_read() {
    for text in
        ["", "suite = \"ideal\"\nencoder = \"lm10\"\n", "seed = 4\n\n[gyroscope]\npreset = \"bmi088\"\nrate_hz = 1000.0\n"]
    {
        let once = table(text).unwrap();
        assert_eq!(table(&toml::to_string(&once).unwrap()).unwrap(), once);
    }
}
