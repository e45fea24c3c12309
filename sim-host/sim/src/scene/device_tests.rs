//! What goes beyond the ideal device: every table, and every refusal.

use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::device::KinematicsKind;
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack};

use super::*;

/// Device 0 is none, 1 an inerter, 2 a clutched pair; p² = 1 and mg = 1000 g N.
const SCENE: &str = r#"
[block]
size_m = 7.3549875
slenderness_deg = 10.0
mass_kg = 1000.0
[[device]]
kind = "none"
[[device]]
kind = "inerter"
mass_ratio = 0.25
[[device]]
kind = "clutched-pair"
mass_ratio = 0.25
[[ground]]
motion = "sine"
amplitude_ratio = 2.0
frequency_ratio = 3.0
"#;

fn parsed(overrides: &[&str]) -> Result<Scene, String> {
    Scene::parse_with(SCENE, "scene.toml", overrides).map_err(|error| error.to_string())
}

fn device(index: usize, item: &str) -> SceneDevice {
    let scene = parsed(&[&format!("device.{index}.{item}")]).unwrap_or_else(|error| panic!("{error}"));
    scene.devices[index].clone()
}

fn refused(items: &[&str], words: &[&str]) {
    let message = parsed(items).expect_err("must be refused");
    assert!(!message.contains('\n') && message.starts_with("scene.toml"), "one line with the file: {message}");
    for word in words {
        assert!(message.contains(word), "{items:?} must say `{word}`: {message}");
    }
}

fn close(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 1e-12 * expected.abs(), "{value} and {expected}");
}

#[test]
fn an_empty_table_is_the_ideal_device() {
    for table in ["flywheel={}", "rack={}", "actuation={}", "weight={}", "engagement=\"ideal\"", "actuation={miss_seed=9}"] {
        let pair = device(2, table);
        assert!(pair.is_ideal() && pair.added_mass == AddedMass::NONE, "{table}");
    }
    assert_eq!(parsed(&["device.1.flywheel={}"]).unwrap().devices[1].drivetrain, Drivetrain::default());
}

#[test]
fn impacts_that_differ_go_beyond_the_ideal_device() {
    let scene = |items: &[&str]| parsed(items).unwrap_or_else(|error| panic!("{error}"));
    for items in [&[][..], &["block.restitution_seed=9"], &["block.restitution_scatter=0", "block.restitution_seed=9"]] {
        let scene = scene(items);
        assert!(scene.is_ideal(2) && scene.plain_block(2).is_some() && scene.first_beyond_ideal().is_none(), "{items:?}");
        assert_eq!(scene.structure(2).restitution_scatter, RestitutionScatter::NONE);
    }
    let scattered = scene(&["block.restitution_scatter=0.02", "block.restitution_seed=9"]);
    assert!(!scattered.is_ideal(2) && scattered.plain_block(2).is_none());
    assert_eq!(scattered.structure(2).restitution_scatter, RestitutionScatter { deviation: 0.02, seed: 9 });
    for of_ideal in [
        "accuracy={ method = 'semi-implicit-euler', step_ratio = 1e-3 }",
        "accuracy={ method = 'runge-kutta-4', step_ratio = 1e-3, events = 'step-end' }",
    ] {
        refused(&["block.restitution_scatter=0.02", of_ideal], &["ideal devices only", "block.restitution_scatter goes beyond"]);
    }
}

#[test]
fn a_base_slides_only_under_a_block_alone() {
    let alone = ["device=[{ kind = 'none' }]", "block.friction_coefficient=0.4", "block.geometry=full"];
    let with = |more: &[&'static str]| [&alone[..], more].concat();
    let scene = parsed(&alone).unwrap_or_else(|error| panic!("{error}"));
    assert!(!scene.is_ideal(0) && scene.plain_block(0).is_none() && scene.hybrid_system(0).is_none());
    assert_eq!(scene.first_beyond_ideal().as_deref(), Some("block.friction_coefficient"));
    refused(
        &["block.friction_coefficient=0.4", "block.geometry=full"],
        &["block.friction_coefficient", "the support of device.1 does not slide"],
    );
    for (more, words) in [
        (&["block.friction_coefficient=0"][..], &["block.friction_coefficient is 0", "above 0"][..]),
        (&["block.friction_coefficient=1.4"], &["block.friction_coefficient is 1.4", "1.333 for a rectangle"]),
        (&["block.friction_coefficient=11"], &["block.friction_coefficient is 11", "above 0, to 10"]),
        (&["block.restitution=0.99"], &["block.restitution is 0.99", "at most that of the block's momentum"]),
        (&["block.geometry=slender"], &["block.friction_coefficient", "exact geometry"]),
        (&["block.restitution_scatter=0.02"], &["block.friction_coefficient", "scatter"]),
        (&["checks={ friction_coefficient = 0.4 }"], &["checks", "block.friction_coefficient lets it"]),
        (&["output.energy=true"], &["output.energy", "block.friction_coefficient"]),
        (&["accuracy.level=fast"], &["accuracy.level", "Runge-Kutta", "accuracy.step_ratio"]),
        (&["accuracy.step_ratio=1e-3"], &["accuracy.method", "runge-kutta-4"]),
        (&["accuracy={ method = 'semi-implicit-euler', step_ratio = 1e-3 }"], &["ideal devices only"]),
    ] {
        refused(&with(more), words);
    }
    assert!(parsed(&with(&["accuracy={ method = 'runge-kutta-4', step_ratio = 1e-3, precision = 'f32' }"])).is_ok());
}

#[test]
fn engagements_and_losses_are_the_drivetrains() {
    assert_eq!(device(2, "engagement=rigid").drivetrain.engagement, Engagement::Rigid);
    assert_eq!(device(2, "engagement=overrunning").drivetrain.engagement, Engagement::Overrunning);
    let losses = device(1, "flywheel={ viscous_rate_1_s = 0.5, dry_deceleration_m_s2 = 0.2 }").drivetrain.flywheel;
    assert_eq!(losses, FlywheelLosses { viscous_rate: 0.5, dry_deceleration: 0.2, brake_deceleration: 0.0, drag_rate: 0.0 });
    let rigid = |brake: &str| {
        let brake = format!("device.2.flywheel.brake_deceleration_m_s2={brake}");
        parsed(&["device.2.engagement=rigid", &brake]).unwrap().devices[2].drivetrain.flywheel.brake_deceleration
    };
    assert_eq!((rigid("3.5"), rigid("instant")), (3.5, f64::INFINITY));
    let late = "device.2.actuation={ engagement_delay_s = 0.02 }";
    for clutch in ["engagement=\"rigid\"", "clutch={ capacity_ratio = 0.1 }"] {
        let items =
            [late, &format!("device.2.{clutch}"), "device.2.flywheel={ drag_rate_1_s = 0.2, brake_deceleration_m_s2 = 5 }"];
        assert_eq!(parsed(&items).unwrap().devices[2].drivetrain.flywheel.drag_rate, 0.2);
    }
}

#[test]
fn a_clutch_is_in_the_cores_units() {
    let friction = |item: &str| match device(2, item).drivetrain.engagement {
        Engagement::Friction { capacity_ratio } => capacity_ratio,
        other => panic!("{item}: {other:?}"),
    };
    assert_eq!(friction("clutch.capacity_ratio=0.3"), 0.3);
    close(friction("clutch.capacity_n=2941.995"), 0.3);
    let elastic = |item: &str| match device(2, item).drivetrain.engagement {
        Engagement::Elastic { stiffness, damping, backlash, capacity_ratio } => [stiffness, damping, backlash, capacity_ratio],
        other => panic!("{item}: {other:?}"),
    };
    // K = 400 m p² and ζ = 0.1: C = 0.2 √(400 · 0.25) m p.
    let [stiffness, damping, backlash, capacity] = elastic("clutch={ stiffness_ratio = 400, damping_ratio = 0.1 }");
    close(stiffness, 400.0);
    close(damping, 2.0);
    assert_eq!((backlash, capacity), (0.0, f64::INFINITY));
    let [stiffness, damping, backlash, capacity] =
        elastic("clutch={ stiffness_n_m = 4e5, damping_n_s_m = 2000, backlash_m = 0.002, capacity_ratio = 0.1 }");
    assert_eq!([stiffness, damping, backlash, capacity], [400.0, 2.0, 0.002, 0.1]);
}

#[test]
fn rack_and_actuation_are_the_drivetrains() {
    let rack = |item: &str| device(1, item).drivetrain.rack;
    let expected = Rack { viscous: 0.05, dry_ratio: 0.002, ..Rack::default() };
    assert_eq!(rack("rack={ load_friction = 0.05 }"), Rack { load_friction: 0.05, ..Rack::default() });
    assert_eq!(rack("rack={ viscous_1_s = 0.05, dry_friction_ratio = 0.002 }"), expected);
    let absolute = rack("rack={ viscous_n_s_m = 50, dry_friction_n = 19.6133 }");
    close(absolute.viscous, 0.05);
    close(absolute.dry_ratio, 0.002);
    let scene = parsed(&[
        "device.2.clutch.capacity_ratio=0.3",
        "device.2.actuation={ engagement_delay_s = 0.01, release_delay_s = 0.02, delay = 'transport', rise_time_s = 0.03, dwell_s = 0.04 }",
        "device.2.actuation.miss_probability=0.5",
        "device.2.actuation.miss_seed=7",
    ]);
    let expected = Actuation {
        engagement_delay: 0.01,
        release_delay: 0.02,
        delay: Delay::Transport,
        rise_time: 0.03,
        time_constant: 0.0,
        dwell: 0.04,
        miss_probability: 0.5,
        miss_seed: 7,
    };
    assert_eq!(scene.unwrap().devices[2].drivetrain.actuation, expected);
}

#[test]
fn inertance_with_a_corner_slips_viscously_with_and_without_a_clutch() {
    for index in [1, 2] {
        let found = device(index, "inertance_corner_hz=4");
        assert_eq!(found.drivetrain.engagement, Engagement::Viscous { corner_frequency: 4.0 });
        assert_eq!(found.device.kinematics, KinematicsKind::Consistent);
    }
}

#[test]
fn a_mass_adds_to_what_it_rides_on() {
    let height = 7.354_987_5 * sprag_shared::math::cos(10.0_f64.to_radians());
    let result = |item: &str| {
        let device = device(1, item);
        (device.added_mass, device.drivetrain.rack.guided_mass_ratio)
    };
    let added_mass = |mass_ratio| AddedMass { mass_ratio, height };
    assert_eq!(result("weight={ flywheels_ratio = 0.1 }"), (AddedMass::NONE, 0.0));
    assert_eq!(result("weight={ flywheels_ratio = 0.1, flywheels_on = \"block\" }"), (added_mass(0.1), 0.0));
    assert_eq!(result("weight={ flywheels_kg = 100, flywheels_on = \"block\", rack_ratio = 0.2 }"), (added_mass(0.1), 0.0));
    assert_eq!(result("weight={ rack_kg = 200 }"), (AddedMass::NONE, 0.2));
    assert_eq!(result("weight={ flywheels_ratio = 0.1, rack_ratio = 0.2, rack_on = \"block\" }"), (added_mass(0.2), 0.0));
    let mounted = |mount: &[&str]| {
        let weight = "device.1.weight={ flywheels_ratio = 0.1, flywheels_on = \"block\" }";
        parsed(&[mount, &[weight]].concat()).unwrap().devices[1].added_mass
    };
    let tied = ["device.1.mount=tying-point", "device.1.mount_height_m=3"];
    assert_eq!(mounted(&tied), AddedMass { mass_ratio: 0.1, height: 3.0 });
    assert_eq!(mounted(&["device.1.mount=base-corners"]), AddedMass { mass_ratio: 0.1, height: 0.0 });
    let scene = parsed(&["device.1.weight={ rack_ratio = 0.2, rack_on = \"block\" }"]).unwrap();
    assert_eq!(scene.structure(1).added_mass, added_mass(0.2));
}

#[test]
fn a_device_without_an_inerter_has_none_of_it() {
    for item in
        ["engagement=ideal", "flywheel={}", "clutch={}", "rack={}", "actuation={}", "weight={}", "support_amplification=1"]
    {
        let name = item.split('=').next().unwrap();
        refused(&[&format!("device.0.{item}")], &[&format!("device.0.{name}"), "has no inerter"]);
    }
}

#[test]
fn a_device_without_a_clutch_has_nothing_of_a_clutch() {
    refused(&["device.1.engagement=rigid"], &["device.1.engagement", "no clutch"]);
    refused(&["device.1.clutch.capacity_ratio=1"], &["device.1.clutch:", "a clutch's properties without a clutch"]);
    refused(&["device.1.actuation.dwell_s=1"], &["device.1.actuation:", "commanded"]);
    refused(&["device.1.flywheel.brake_deceleration_m_s2=1"], &["device.1.flywheel.brake", "never is"]);
}

#[test]
fn contradictory_effects_are_refused_with_the_reason() {
    let brake = "device.2.flywheel.brake_deceleration_m_s2=instant";
    refused(&[brake], &["device.2.flywheel.brake_deceleration_m_s2", "ideal clutch stops a released flywheel at once"]);
    let capacity = "device.2.clutch.capacity_ratio=1";
    refused(&["device.2.engagement=rigid", capacity], &["device.2.engagement", "only one of both"]);
    refused(&["device.2.clutch={}"], &["device.2.clutch is missing", "capacity"]);
    for stray in ["damping_ratio", "damping_n_s_m", "backlash_m"] {
        let stray = format!("device.2.clutch.{stray}");
        refused(&[capacity, &format!("{stray}=0.1")], &[&stray, "only an elastic clutch"]);
    }
    for [first, second] in [["capacity_ratio", "capacity_n"], ["stiffness_ratio", "stiffness_n_m"]] {
        let items = [first, second].map(|name| format!("device.2.clutch.{name}=10"));
        refused(&[&items[0], &items[1]], &[first, second, "only one of"]);
    }
    refused(&["device.1.rack={ viscous_1_s = 1, viscous_n_s_m = 1 }"], &["device.1.rack.viscous_1_s", "only one of"]);
    refused(
        &["device.2.engagement=overrunning", "device.2.actuation.dwell_s=1"],
        &["device.2.actuation", "nobody commands an overrunning clutch"],
    );
    for engagement in ["engagement=rigid", "clutch.stiffness_ratio=10"] {
        let items = [&format!("device.2.{engagement}"), "device.2.actuation.rise_time_s=0.1"];
        refused(&items, &["device.2.actuation.rise_time_s", "only a capacity can rise"]);
        let items = [&format!("device.2.{engagement}"), "device.2.actuation.time_constant_s=0.1"];
        refused(&items, &["device.2.actuation.time_constant_s", "only a capacity can rise"]);
    }
    let (drag, rigid) = ("device.2.flywheel.drag_rate_1_s=0.1", "device.2.engagement=rigid");
    refused(&["device.1.flywheel.drag_rate_1_s=0.1"], &["device.1.flywheel.drag_rate_1_s", "a single inerter has none"]);
    for other in ["engagement=ideal", "engagement=overrunning", "clutch.stiffness_ratio=10", "inertance_corner_hz=4"] {
        refused(&[drag, &format!("device.2.{other}")], &["device.2.flywheel.drag_rate_1_s", "a rigid one and for plates"]);
    }
    for clutch in [rigid, "device.2.clutch.capacity_ratio=0.1"] {
        refused(&[drag, clutch], &["device.2.flywheel.drag_rate_1_s", "engagement_delay_s"]);
    }
    let late = "device.2.actuation.release_delay_s=0.01";
    let stopped = "device.2.flywheel={ drag_rate_1_s = 0.1, brake_deceleration_m_s2 = \"instant\" }";
    refused(&[rigid, late, stopped], &["device.2.flywheel.drag_rate_1_s", "stopped at once"]);
    refused(&[rigid, drag, late, "device.2.rack.load_friction=0.1"], &["device.2.flywheel.drag_rate_1_s", "rack.load_friction"]);
    refused(&[rigid, late, "device.2.flywheel.drag_rate_1_s=1001"], &["device.2.flywheel.drag_rate_1_s is 1001", "to 1000 1/s"]);
    let load = "device.2.rack={ load_friction = 0.1 }";
    for other in ["engagement=overrunning", "clutch.capacity_ratio=0.1", "clutch.stiffness_ratio=10", "inertance_corner_hz=4"] {
        refused(&[load, &format!("device.2.{other}")], &["device.2.rack.load_friction", "locked to the rack"]);
    }
    refused(&["device.2.rack.load_friction=1"], &["device.2.rack.load_friction is 1", "below 1"]);
    refused(&["device.2.inertance_corner_hz=0"], &["device.2.inertance_corner_hz is 0", "to 1000 Hz"]);
    for (name, value) in [("engagement", "engagement=rigid"), ("clutch", "clutch.capacity_ratio=0.1")] {
        let items = ["device.2.inertance_corner_hz=4", &format!("device.2.{value}")];
        refused(&items, &[&format!("device.2.{name}"), "only one of both"]);
    }
    let corners = ["device.1.inertance_corner_hz=4", "device.1.mount=base-corners"];
    refused(&corners, &["device.1.inertance_corner_hz", "horizontal mount"]);
    let twice = "device.2.actuation={ rise_time_s = 0.1, time_constant_s = 0.1 }";
    refused(&[capacity, twice], &["device.2.actuation.time_constant_s", "linearly or exponentially"]);
    refused(&["device.1.weight={ flywheels_on = \"block\" }"], &["device.1.weight.flywheels_ratio is missing"]);
    let both = "device.1.weight={ flywheels_ratio = 0.1, flywheels_on = \"block\", rack_ratio = 0.1, rack_on = \"block\" }";
    refused(&[both], &["device.1.weight.rack_on", "nothing turns the flywheels"]);
    refused(&["device.1.mount=base-corners", "device.1.weight.rack_ratio=0.1"], &["device.1.weight.rack_ratio", "vertical rack"]);
}

/// A wall of 5 Hz that carries the pair.
const WALL: [&str; 2] = ["device.2.support_frequency_hz=5", "device.2.support_damping_ratio=0.05"];

#[test]
fn supports_that_move_are_refused_where_their_velocity_counts() {
    let recorded = ["device.2.support_record={ file = \"wall.csv\" }"];
    for (key, moves) in [
        ("device.2.support_amplification", &["device.2.support_amplification=1.2"][..]),
        ("device.2.support_frequency_hz", &WALL),
        ("device.2.support_record", &recorded),
    ] {
        assert!(parsed(moves).is_ok(), "{key}");
        refused(&[&["device.2.mount=base-corners"], moves].concat(), &[key, "vertical devices"]);
        refused(&[&["device.2.kinematics=paper"], moves].concat(), &["device.2.kinematics", "not the integral"]);
        for (item, name) in [
            ("engagement=rigid", "engagement"),
            ("clutch.capacity_ratio=1", "clutch"),
            ("flywheel.viscous_rate_1_s=1", "flywheel"),
            ("rack.dry_friction_ratio=0.1", "rack"),
        ] {
            let item = format!("device.2.{item}");
            refused(&[moves, &[&item]].concat(), &[key, name, "only ideal devices without friction"]);
        }
    }
}

#[test]
fn a_support_moves_in_one_way() {
    refused(&WALL[..1], &["device.2.support_damping_ratio is missing"]);
    refused(&WALL[1..], &["device.2.support_frequency_hz is missing"]);
    for other in ["device.2.support_amplification=1", "device.2.support_record={ file = \"wall.csv\" }"] {
        refused(&[WALL[0], WALL[1], other], &["give only one of", "support_frequency_hz"]);
    }
    refused(&["device.0.support_frequency_hz=5"], &["device.0.support_frequency_hz", "no inerter"]);
    refused(&["device.2.support_frequency_hz=0.01", WALL[1]], &["device.2.support_frequency_hz is 0.01", "from 0.1 to 1000"]);
    refused(&[WALL[0], "device.2.support_damping_ratio=1"], &["device.2.support_damping_ratio is 1", "from 0.005 to 0.9"]);
    let second = "ground.1={ motion = \"sine\", amplitude_g = 0.1, frequency_hz = 2 }";
    let recorded = "device.2.support_record={ file = \"wall.csv\" }";
    refused(&[recorded, second], &["device.2.support_record", "one [[ground]] table"]);
    let odd = "device.2.support_record={ file = \"wall.csv\", units = \"furlongs\" }";
    refused(&[odd], &["device.2.support_record.units is \"furlongs\""]);
    assert!(parsed(&[WALL[0], WALL[1], "device.2.actuation.dwell_s=1"]).is_ok());
}

#[test]
fn a_support_that_moves_with_the_ground_is_none_of_it() {
    let on = |item: &str| parsed(&[&format!("device.2.{item}")]).unwrap().devices[2].clone();
    assert!(on("support_amplification=1").is_ideal());
    let moved = on("support_amplification=0");
    assert!(!moved.is_ideal() && moved.drivetrain.support.amplification == 0.0);
    assert!(parsed(&["device.2.actuation.dwell_s=1", "device.2.support_amplification=1.2"]).is_ok());
    assert!(parsed(&["device.2.weight.rack_ratio=0.1", "device.2.support_amplification=1.2"]).is_ok());
}

#[test]
fn flywheels_with_a_memory_need_a_horizontal_mount_and_an_inertance() {
    let keeping = "flywheels of its own";
    for (item, reason) in [
        ("engagement=rigid", keeping),
        ("engagement=overrunning", keeping),
        ("clutch.capacity_ratio=1", keeping),
        // Released, the flywheels of an ideal clutch stop at once, however late it obeys.
        ("actuation.dwell_s=1", "clutches of its own"),
    ] {
        let (name, item) = (item.split(['=', '.']).next().unwrap(), format!("device.2.{item}"));
        let key = format!("device.2.{name}");
        refused(&["device.2.mount=base-corners", &item], &[&key, reason]);
        refused(&["device.2.mass_ratio=0", &item], &[&key, "mass ratio is 0"]);
    }
    refused(&["device.1.mass_ratio=0", "device.1.flywheel.viscous_rate_1_s=1"], &["device.1.flywheel", "mass ratio is 0"]);
    refused(
        &["device.1.mass_ratio=0", "device.1.support_amplification=2"],
        &["device.1.support_amplification", "mass ratio is 0"],
    );
    assert!(parsed(&["device.1.mass_ratio=0", "device.1.rack.viscous_1_s=1"]).is_ok());
    assert!(parsed(&["device.1.mount=base-corners", "device.1.flywheel.viscous_rate_1_s=1"]).is_ok());
}

#[test]
fn absolute_values_need_a_mass() {
    let without = SCENE.replace("mass_kg = 1000.0\n", "");
    for item in [
        "device.2.clutch.capacity_n",
        "device.2.clutch.stiffness_n_m",
        "device.1.rack.viscous_n_s_m",
        "device.1.rack.dry_friction_n",
        "device.1.weight.rack_kg",
        "device.1.weight.flywheels_kg",
    ] {
        let message = Scene::parse_with(&without, "scene.toml", &[format!("{item}=1")]).unwrap_err().to_string();
        assert!(message.contains(item) && message.contains("block.mass_kg"), "{message}");
    }
}

#[test]
fn a_value_outside_its_range_is_named_by_its_key() {
    for (item, key, range) in [
        ("device.2.flywheel.viscous_rate_1_s=-1", "device.2.flywheel.viscous_rate_1_s is -1", "from 0 to 1e6"),
        ("device.2.flywheel.dry_deceleration_m_s2=nan", "device.2.flywheel.dry_deceleration_m_s2 is NaN", "from 0 to 1e6"),
        ("device.2.flywheel.brake_deceleration_m_s2=fast", "brake_deceleration_m_s2", "\"instant\""),
        ("device.2.clutch.capacity_ratio=0", "device.2.clutch.capacity_ratio is 0", "above 0, to 1e6"),
        ("device.2.flywheel.brake_deceleration_m_s2=inf", "is inf", "from 0 to 1e9 m/s² or \"instant\""),
        ("device.2.clutch.capacity_n=-1", "device.2.clutch.capacity_n is -1", "above 0 N"),
        ("device.2.clutch.capacity_n=9806.65e7", "device.2.clutch.capacity_n as capacity_ratio is 10000000", "above 0, to 1e6"),
        ("device.2.clutch.stiffness_ratio=1e13", "device.2.clutch.stiffness_ratio as stiffness is ", "above 0, to 1e12"),
        ("device.2.clutch={ stiffness_ratio = 1, damping_ratio = 1e9 }", "device.2.clutch.damping_ratio as damping", "from 0"),
        ("device.2.clutch={ stiffness_ratio = 1, backlash_m = 2 }", "device.2.clutch.backlash_m is 2", "from 0 to 1 m"),
        ("device.1.rack.viscous_1_s=1e4", "device.1.rack.viscous_1_s is 10000", "from 0 to 1000"),
        ("device.1.rack.dry_friction_n=1e6", "device.1.rack.dry_friction_n as rack dry_ratio", "from 0 to 10"),
        ("device.2.actuation.engagement_delay_s=11", "device.2.actuation.engagement_delay_s is 11", "from 0 to 10 s"),
        ("device.2.actuation.miss_probability=2", "device.2.actuation.miss_probability is 2", "from 0 to 1"),
        ("device.2.actuation.miss_seed=-1", "miss_seed is -1", "a whole number from 0"),
        ("device.1.support_amplification=11", "device.1.support_amplification is 11", "from -10 to 10"),
        ("device.1.weight.rack_ratio=11", "device.1.weight.rack_ratio is 11", "from 0 to 10"),
        ("device.1.weight.rack_kg=1e5", "device.1.weight.rack_kg over block.mass_kg is 100", "from 0 to 10"),
        ("device.1.weight.rack_kg=-1", "device.1.weight.rack_kg is -1", "0 kg or more"),
        ("device.2.engagement=magnetic", "device.2.engagement", "overrunning"),
        ("checks.friction_coefficient=0", "checks.friction_coefficient is 0", "above 0, to 10"),
        ("checks.largest_force_ratio=-1", "checks.largest_force_ratio is -1", "above 0"),
        ("checks.largest_stroke_m=0", "checks.largest_stroke_m is 0", "above 0"),
        ("checks.gear={ module_mm = 4, face_width_mm = 40, teeth = 20 }", "allowable_stress_mpa", "missing"),
    ] {
        refused(&[item], &[key, range]);
    }
    let gear = |teeth: u32, module: f64| {
        format!("checks.gear={{ module_mm = {module}, face_width_mm = 40, teeth = {teeth}, allowable_stress_mpa = 100 }}")
    };
    refused(&[&gear(11, 4.0)], &["checks.gear.teeth is 11", "from 12 to 10000"]);
    refused(&[&gear(20, 0.0)], &["checks.gear.module_mm is 0", "above 0, to 100 mm"]);
    let without = SCENE.replace("mass_kg = 1000.0\n", "");
    let message = Scene::parse_with(&without, "scene.toml", &[gear(20, 4.0)]).unwrap_err().to_string();
    assert!(message.contains("checks.gear") && message.contains("block.mass_kg"), "{message}");
    assert!(parsed(&[&gear(20, 4.0), "checks.friction_coefficient=0.5"]).unwrap().file.checks.is_some());
}

#[test]
fn methods_for_ideal_devices_are_refused_beyond_them() {
    let euler = ["accuracy.method=semi-implicit-euler", "accuracy.step_ratio=1e-3"];
    let step_end = ["accuracy.method=runge-kutta-4", "accuracy.step_ratio=1e-3", "accuracy.events=step-end"];
    let taylor = ["accuracy.precision=f32", "accuracy.step_ratio=1e-3"];
    assert!(parsed(&euler).is_ok() && parsed(&step_end).is_ok() && parsed(&taylor).is_ok());
    let vertical = "vertical=[{ motion = \"sine\", amplitude_g = 0.1, frequency_hz = 2 }]";
    for (item, key) in [
        ("device.2.engagement=rigid", "device.2.engagement"),
        ("device.2.clutch.capacity_ratio=1", "device.2.clutch"),
        ("device.1.rack.viscous_1_s=1", "device.1.rack"),
        ("device.1.weight.rack_ratio=0.1", "device.1.weight"),
        ("device.1.flywheel.viscous_rate_1_s=1", "device.1.flywheel"),
        ("device.2.actuation.dwell_s=1", "device.2.actuation"),
        ("device.1.support_amplification=1.2", "device.1.support_amplification"),
        ("device.1.support_record={ file = \"wall.csv\" }", "device.1.support_record"),
        (vertical, "vertical"),
    ] {
        refused(&[taylor[0], taylor[1], item], &["accuracy.method", "taylor in f32", "ideal devices only", key]);
        refused(&[euler[0], euler[1], item], &["accuracy.method", "ideal devices only", key]);
        refused(&[step_end[0], step_end[1], step_end[2], item], &["accuracy.events", "ideal devices only", key]);
    }
    let exponential = ["accuracy.method=exponential-midpoint", "accuracy.step_ratio=1e-3"];
    refused(&exponential, &["accuracy.method", "elastic clutches"]);
    refused(&["device.2.clutch.stiffness_ratio=10", exponential[0]], &["accuracy.step_s", "fixed-step"]);
    assert!(parsed(&["device.2.clutch.stiffness_ratio=10", exponential[0], exponential[1]]).is_ok());
}

#[test]
fn what_is_watched_between_steps_needs_located_events() {
    let step_end = ["accuracy.method=semi-implicit-euler", "accuracy.step_ratio=1e-3", "accuracy.events=step-end"];
    for (item, key) in [("output.energy=true", "output.energy"), ("checks={ friction_coefficient = 0.4 }", "checks")] {
        refused(&[step_end[0], step_end[1], step_end[2], item], &[&format!("{key}: "), "accuracy.events = \"located\""]);
        assert!(parsed(&[step_end[0], step_end[1], item]).is_ok(), "{item}");
    }
    assert!(parsed(&[step_end[0], step_end[1], step_end[2], "output.energy=false"]).is_ok());
}

#[test]
fn impacts_may_balance_momentum() {
    let scene = parsed(&["block.restitution=momentum-balance"]).unwrap();
    assert_eq!(scene.restitution, Restitution::MomentumBalance);
    let stocky = ["block.restitution=momentum-balance", "block.slenderness_deg=70"];
    refused(&stocky, &["block.restitution: the geometric restitution of device.0", "less stocky"]);
}
