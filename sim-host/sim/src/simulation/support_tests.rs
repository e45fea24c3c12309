//! Supports of their own motion through whole runs.

use std::path::Path;

use sprag_shared::math;

use super::{DeviceRun, RunError, simulate};
use crate::interrupt::Interrupt;
use crate::scene::Scene;

/// A record, its units and a time step; the wall's is 1.2 times the ground's.
fn records(folder: &Path) {
    let ground = |k: u32| 0.35 * math::sin(0.11 * f64::from(k)) * math::sin(0.02 * f64::from(k));
    for (name, factor) in [("ground.csv", 1.0), ("wall.csv", 1.2)] {
        let rows: String = (0..150).map(|k| format!("{:.2},{}\n", 0.02 * f64::from(k), factor * ground(k))).collect();
        std::fs::write(folder.join(name), format!("# time_s,acc_g\n{rows}")).unwrap();
    }
}

fn scene(folder: &Path, device: &str, changes: &[&str]) -> Scene {
    let text = format!(
        "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}\n\
         device = [{{ kind = 'none' }}, {{ mass_ratio = 0.5, {device} }}]\n\
         ground = [{{ motion = 'record', file = 'ground.csv', start_s = 0.4 }}]\n\
         output.energy = true\n"
    );
    let mut scene = Scene::parse_with(&text, "scene", changes).unwrap();
    scene.folder = folder.to_owned();
    scene
}

fn run(folder: &Path, device: &str, changes: &[&str]) -> DeviceRun {
    let scene = scene(folder, device, changes);
    simulate(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap().remove(1)
}

const KINDS: [&str; 2] = ["kind = 'inerter'", "kind = 'clutched-pair'"];

#[test]
fn a_record_in_proportion_to_the_ground_is_the_factor() {
    let folder = tempfile::tempdir().unwrap();
    records(folder.path());
    let lifts = "vertical = [{ motion = 'sine', amplitude_g = 0.1, frequency_hz = 1.3, start_s = 0.21 }]".replace(' ', "");
    for changes in [&[][..], &[lifts.as_str()]] {
        for kind in KINDS {
            let recorded = run(folder.path(), &format!("{kind}, support_record = {{ file = 'wall.csv' }}"), changes);
            let scaled = "support_record = { file = 'ground.csv', scale = 1.2 }";
            let scaled = run(folder.path(), &format!("{kind}, {scaled}"), changes);
            let factor = run(folder.path(), &format!("{kind}, support_amplification = 1.2"), changes);
            let plain = run(folder.path(), kind, changes);
            let peak = |run: &DeviceRun| run.peak_rotation.unwrap();
            for one in [&recorded, &scaled] {
                assert!((peak(one) / peak(&factor) - 1.0).abs() < 1e-9, "{kind}: {} and {}", peak(one), peak(&factor));
                assert_eq!((one.impacts, one.outcome), (factor.impacts, factor.outcome));
            }
            assert!((peak(&factor) / peak(&plain) - 1.0).abs() > 1e-3, "{kind}: the support does not matter");
        }
    }
}

/// As (ω_g/ω_s)², which is a quarter with each doubling of the wall's frequency.
#[test]
fn a_stiff_wall_is_the_ground() {
    let folder = tempfile::tempdir().unwrap();
    for kind in KINDS {
        let ground = ["ground=[{motion='ricker',amplitude_g=0.4,frequency_hz=1}]"];
        let consistent = format!("{kind}, kinematics = 'consistent'");
        let peak = |support: &str| run(folder.path(), &format!("{consistent}{support}"), &ground).peak_rotation.unwrap();
        let plain = peak("");
        let differences = [80.0, 160.0, 320.0]
            .map(|hertz| peak(&format!(", support_frequency_hz = {hertz:?}, support_damping_ratio = 0.7")) / plain - 1.0);
        for pair in differences.windows(2) {
            assert!((pair[0] / pair[1] - 4.0).abs() < 0.4, "{kind}: {differences:?}");
        }
        assert!(differences[2].abs() < 1e-3, "{kind}: {differences:?}");
    }
}

#[test]
fn the_ledger_closes_on_a_wall_that_swings_and_rings_on() {
    let folder = tempfile::tempdir().unwrap();
    records(folder.path());
    for kind in KINDS {
        for wall in ["5.0, support_damping_ratio = 0.05", "1.0, support_damping_ratio = 0.2"] {
            let device = format!("{kind}, support_frequency_hz = {wall}");
            let moved = run(folder.path(), &device, &[]);
            let entries = moved.energy.as_ref().unwrap().entries;
            assert!(entries.residual.abs() < 1e-9 * entries.input.abs(), "{device}: {entries:?}");
            let mirrored = run(folder.path(), &device, &["ground.0.scale=-1"]);
            assert_eq!(mirrored.peak_rotation, moved.peak_rotation, "{device}");
            let samples = |run: &DeviceRun| run.history.samples.iter().map(|s| s.rotation_rad.abs()).collect::<Vec<_>>();
            assert_eq!(samples(&mirrored), samples(&moved));
            // The free time begins once the wall has come to rest.
            let plain = run(folder.path(), kind, &[]);
            let last = |run: &DeviceRun| run.history.samples.last().unwrap().time_s;
            assert!(last(&moved) > last(&plain) + 3.0, "{} {}", last(&moved), last(&plain));
        }
    }
}

#[test]
fn another_ground_has_no_record_of_the_support() {
    let folder = tempfile::tempdir().unwrap();
    records(folder.path());
    let mut own = scene(folder.path(), "kind = 'inerter', support_record = { file = 'wall.csv' }", &[]);
    let ground = own.ground_motions().unwrap();
    assert_eq!((ground.records.len(), own.records().unwrap().len()), (2, 2));
    let other = scene(folder.path(), "kind = 'inerter'", &[]).ground_motions().unwrap();
    let error = simulate(&own, &other, &Interrupt::default()).unwrap_err();
    assert!(matches!(&error, RunError::OtherGround { device } if device == "inerter"), "{error}");
    let error = own.use_record(Path::new("other.csv")).unwrap_err().to_string();
    assert!(error.starts_with("scene: device.1.support_record: another record"), "{error}");
    // An oscillator goes with every ground.
    let wall = "kind = 'inerter', support_frequency_hz = 5.0, support_damping_ratio = 0.05";
    assert!(simulate(&scene(folder.path(), wall, &[]), &other, &Interrupt::default()).is_ok());
}

const WALL: &str = "support_frequency_hz = 5.0, support_damping_ratio = 0.05";

#[test]
fn single_precision_knows_a_wall_that_rings() {
    let folder = tempfile::tempdir().unwrap();
    for kind in KINDS {
        for amplitude in [0.05, 0.3] {
            let ground = format!("ground=[{{motion='sine',amplitude_g={amplitude},frequency_hz=1}}]");
            let steps = [
                "accuracy={method='runge-kutta-4',step_s=0.001}",
                "accuracy={method='runge-kutta-4',step_s=0.001,precision='f32'}",
            ];
            let [double, single] = steps.map(|step| run(folder.path(), &format!("{kind}, {WALL}"), &[&ground, step]));
            assert_eq!(double.outcome, single.outcome, "{kind} at {amplitude} g");
            let force = |run: &DeviceRun| run.peak_force_ratio.unwrap();
            assert!((force(&single) / force(&double) - 1.0).abs() < 1e-3, "{} and {}", force(&single), force(&double));
        }
    }
}

/// n F/(mg) beside a ground that hardly moves.
#[test]
fn a_block_that_stands_needs_friction_against_its_device() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..100).map(|k| format!("{:.2},{}\n", 0.02 * f64::from(k), math::sin(0.25 * f64::from(k)))).collect();
    std::fs::write(folder.path().join("wall.csv"), format!("# time_s,acc_g\n{rows}")).unwrap();
    let ground = "ground=[{motion='sine',amplitude_g=1e-7,frequency_hz=1}]";
    for kind in KINDS {
        for scale in [0.3, -0.3] {
            let device = format!("{kind}, support_record = {{ file = 'wall.csv', scale = {scale:?} }}");
            let stands = run(folder.path(), &device, &[ground, "checks={friction_coefficient=0.05}"]);
            assert_eq!((stands.outcome.name(), stands.impacts), ("no-rocking", 0));
            let checks = stands.checks.unwrap();
            let (friction, force) = (checks.friction_needed.unwrap(), checks.force_ratio.unwrap());
            assert!(force > 0.14 && (friction - force).abs() < 1e-6, "{kind}: {friction} under a force of {force}");
            assert!(checks.warnings.iter().any(|warning| warning.starts_with("the toe would slide:")), "{:?}", checks.warnings);
        }
    }
}

#[test]
fn time_in_which_nothing_happens_has_no_events() {
    let folder = tempfile::tempdir().unwrap();
    for support in ["support_amplification = 1.2", WALL, "support_frequency_hz = 0.1, support_damping_ratio = 0.005"] {
        let ground = "ground=[{motion='sine',amplitude_g=0.05,frequency_hz=1}]";
        let device = format!("kind = 'clutched-pair', {support}");
        let still = run(folder.path(), &device, &[ground, "run.free_time_s=100000", "block.size_m=0.05", "output.energy=false"]);
        assert_eq!(still.outcome.name(), "no-rocking");
    }
}

/// What an impact takes is lost, whatever the support does: ½(1 − η²)(1 + κℓ²)θ̇² of block and flywheel.
#[test]
fn impacts_give_no_energy() {
    let folder = tempfile::tempdir().unwrap();
    for kind in KINDS {
        for factor in [4.0, 10.0, -10.0] {
            for scale in [1.0, -1.0] {
                let ground = format!("ground=[{{motion='half-sine',amplitude_g=0.05,frequency_hz=1,scale={scale:?}}}]");
                let device = format!("{kind}, kinematics = 'consistent', support_amplification = {factor:?}");
                let changes = [&ground, "block.initial_rotation_ratio=0.3", "block.restitution=0.85", "output.interval_s=0.01"];
                let run = run(folder.path(), &device, &changes);
                let energy = run.energy.unwrap();
                assert!(energy.entries.residual.abs() < 1e-9, "{device}: {:?}", energy.entries);
                let lost: Vec<f64> = energy.history.iter().map(|(_, shares)| shares.impact).collect();
                assert!(lost.last().unwrap() > &0.0 && run.impacts > 0);
                assert!(lost.windows(2).all(|pair| pair[1] >= pair[0] - 1e-12), "{device}, {scale}");
            }
        }
    }
}

/// A clutch on a support that moves does not follow the last bounces of the block.
#[test]
fn impacts_that_accumulate_are_those_that_are_followed() {
    let folder = tempfile::tempdir().unwrap();
    for kind in KINDS {
        let ground = "ground=[{motion='sine',amplitude_g=0.3,frequency_hz=1}]";
        let ends = [1e-12, 1e-4].map(|speed| {
            let rest = format!("run.rest_speed_ratio={speed:e}");
            run(folder.path(), &format!("{kind}, {WALL}"), &[ground, "block.restitution=0.85", &rest])
        });
        assert_eq!(ends[0].impacts, ends[1].impacts, "{kind}");
    }
}

/// Where the ground has stopped, the terminals of every device turn with its block: one command a swing, and one draw for its miss, whatever
/// rounding has left of the support's speed.
#[test]
fn terminals_on_a_support_that_has_stopped_turn_once_a_swing() {
    let folder = tempfile::tempdir().unwrap();
    for (amplification, amplitude, frequency) in
        [(0.65, 1.3, 3.0), (0.65, 1.6, 5.0), (1.5, 1.6, 3.0), (1.5, 1.3, 4.0), (1.5, 1.3, 6.0)]
    {
        let device = format!(
            "kind = 'clutched-pair', support_amplification = {amplification}, actuation = {{ \
             engagement_delay_s = 0.04, delay = 'transport', miss_probability = 0.3, miss_seed = 2 }}"
        );
        let ground = format!("ground=[{{motion='sine',amplitude_ratio={amplitude},frequency_ratio={frequency}}}]");
        let [series, steps] = ["method='taylor'", "method='runge-kutta-4',step_s=0.001"].map(|method| {
            let accuracy = format!("accuracy={{{method}}}");
            let run = run(folder.path(), &device, &[&ground, &accuracy, "block.restitution=0.85", "run.free_time_s=4"]);
            (run.impacts, run.clutch_switches, run.missed_engagements)
        });
        assert!(series.2 > 2, "{series:?}");
        assert_eq!(series, steps, "{device} {ground}");
    }
}

/// Every bounce of a block that dies away on a support that moves engages a flywheel at the speed of the support, and releases it.
#[test]
fn the_rest_threshold_does_not_show_in_what_clutches_create() {
    let folder = tempfile::tempdir().unwrap();
    let coil = "checks={coil={holding_power_w=24}}";
    for (support, amplitude) in
        [("support_amplification = 2.5", 1.3), ("support_frequency_hz = 1.0, support_damping_ratio = 0.02", -1.3)]
    {
        for misses in ["", ", actuation = { miss_probability = 0.3, miss_seed = 3 }"] {
            let device = format!("kind = 'clutched-pair', {support}{misses}");
            let pulse = format!("{{motion='sine',amplitude_ratio={amplitude},frequency_hz=2}}");
            let ground = format!("ground=[{pulse},{{motion='half-sine',amplitude_ratio=0.3,frequency_hz=0.1}}]");
            let [usual, others @ ..] = ["1e-6", "1e-7", "1e-8", "1e-9"].map(|speed| {
                let rest = format!("run.rest_speed_ratio={speed}");
                run(folder.path(), &device, &[&ground, "block.restitution=0.9", coil, &rest])
            });
            let counts =
                |run: &DeviceRun| (run.impacts, run.checks.as_ref().unwrap().coils.unwrap().closings, run.missed_engagements);
            let books = |run: &DeviceRun| {
                let entries = run.energy.as_ref().unwrap().entries;
                [entries.created, entries.brake, entries.input, entries.impact, entries.residual]
            };
            // What some dozens of engagements create.
            let exact = books(&usual);
            assert!(exact[0] > 0.2, "{device}: {exact:?}");
            for other in &others {
                let found = books(other);
                assert_eq!(counts(other), counts(&usual), "{device}");
                assert!(
                    found[..4].iter().zip(exact).all(|(found, exact)| (found / exact - 1.0).abs() < 2e-5),
                    "{device}: {found:?} and {exact:?}"
                );
                assert!(found[4].abs() < 1e-12 * found[1], "{device}: {found:?}");
            }
        }
    }
}

/// Below the rest threshold a support that swings on lets a block bounce on; hundreds of such bounces are within 1e-9/p where each takes hardly
/// anything.
#[test]
fn bounces_on_a_support_that_swings_come_to_an_end() {
    let folder = tempfile::tempdir().unwrap();
    let device = "kind = 'clutched-pair', support_frequency_hz = 1.09, support_damping_ratio = 0.5";
    let grounds = "ground=[{motion='half-sine',amplitude_ratio=1.65,frequency_ratio=6.92},{motion='sine',amplitude_g=0.24,frequency_hz=4.69}]";
    let block = ["block.size_m=3.0", "block.slenderness_deg=8.0", "block.restitution=0.99", "run.free_time_ratio=3.0"];
    let changes = [&block[..], &["device.1.mass_ratio=2.0", grounds]].concat();
    let peak = |threshold: &str| run(folder.path(), device, &[&changes[..], &[threshold]].concat()).peak_rotation.unwrap();
    let (usual, finer) = (peak("run.rest_speed_ratio=1e-6"), peak("run.rest_speed_ratio=1e-8"));
    assert!((finer / usual - 1.0).abs() < 1e-6, "{usual} and {finer}");
}
