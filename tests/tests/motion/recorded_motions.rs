//! The block of the paper's section 6.2 (α = 10°, R = 2 m, σ = 0.5) under every recorded motion, with all three devices.
//!
//! `cargo test -p sprag-tests --test motion recorded_motions -- --nocapture` prints the reductions of peak rotation under the
//! pulse-like motions beside the paper's. The folder of records is not part of the repository.

use std::collections::BTreeSet;
use std::path::Path;

use sprag_sim_host::interrupt::Interrupt;
use sprag_sim_host::outcome::Outcome;
use sprag_sim_host::scene::Scene;
use sprag_sim_host::simulation::{DeviceRun, simulate};

const RECORDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/records");
const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/record.toml");

/// One row of the index: its file, whether it is an unscaled pulse-like motion of an earthquake of the paper's Table 1,
/// what names the motion (to count it once), and what the file does not say itself.
struct Motion {
    file: String,
    pulse_like: bool,
    identity: String,
    overrides: Vec<String>,
}

fn motions(index: &str) -> Vec<Motion> {
    let mut lines = index.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split('\t').collect();
    let column = |name: &str| header.iter().position(|title| *title == name).unwrap_or_else(|| panic!("column {name}"));
    let (file, rsn, component, step) = (column("file"), column("RSN"), column("component"), column("dt_s"));
    let (table1, baker, fema) = (column("table1_event"), column("pulse_baker2007"), column("fema_p695"));
    let (shahi, format, scaled) = (column("pulse_shahi_baker_unverified"), column("format"), column("scaled"));
    lines
        .map(|line| {
            let field: Vec<&str> = line.split('\t').collect();
            let pulse = field[baker] == "yes" || field[shahi] == "yes" || field[fema] == "NF-pulse";
            let horizontal = !field[component].to_ascii_uppercase().contains(['U', 'V']);
            let mut overrides = Vec::new();
            if let Some(units) = match field[format] {
                "g3" => Some("g"),
                "6col" => Some("cm/s2"),
                _ => None,
            } {
                overrides.push(format!("ground.0.units={units}"));
                overrides.push(format!("ground.0.time_step_s={}", field[step]));
            }
            Motion {
                file: field[file].to_owned(),
                pulse_like: pulse && horizontal && field[table1] == "yes" && field[scaled] == "no",
                identity: if field[rsn].is_empty() {
                    field[file].to_owned()
                } else {
                    format!("{} {}", field[rsn], field[component])
                },
                overrides,
            }
        })
        .collect()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn every_recorded_motion_is_simulated_with_all_three_devices() {
    let Ok(index) = std::fs::read_to_string(Path::new(RECORDS).join("INDEX.tsv")) else {
        eprintln!("SKIPPED: the folder of recorded motions is absent; no block was shaken by them");
        return;
    };
    let motions = motions(&index);
    assert_eq!(motions.len(), 228);
    let mut counted = BTreeSet::new();
    let mut ratios: [[Vec<f64>; 2]; 2] = Default::default();
    let mut overturned = [0; 3];
    for motion in &motions {
        let mut scene = Scene::load(Path::new(SCENE), &motion.overrides).unwrap_or_else(|error| panic!("{error}"));
        scene.use_record(&Path::new(RECORDS).join(&motion.file)).unwrap();
        let ground = scene.ground_motions().unwrap_or_else(|error| panic!("{error}"));
        let runs = simulate(&scene, &ground, &Interrupt::default()).unwrap_or_else(|error| panic!("{}: {error}", motion.file));
        let [none, single, pair] = runs.as_slice() else { panic!("three devices") };
        check(motion, &runs, ground.horizontal.peak_m_s2() / 9.806_65 > scene.uplift_threshold());
        if motion.pulse_like && counted.insert(motion.identity.clone()) {
            for (count, run) in overturned.iter_mut().zip(&runs) {
                *count += usize::from(run.outcome.overturned());
            }
            for (index, run) in [single, pair].into_iter().enumerate() {
                if let (Some(bare), Some(protected)) = (none.peak_rotation, run.peak_rotation)
                    && none.outcome == Outcome::Safe
                {
                    ratios[0][index].push(protected / bare);
                }
                if let (Some(bare), Some(protected)) = (none.peak_acceleration, run.peak_acceleration)
                    && none.outcome == Outcome::Safe
                {
                    ratios[1][index].push(protected / bare);
                }
            }
        }
    }
    println!(
        "{} pulse-like motions; overturned: none {}, single {}, pair {}",
        counted.len(),
        overturned[0],
        overturned[1],
        overturned[2]
    );
    let papers = [("peak rotation", "30 % and 55 % lower"), ("peak angular acceleration", "25 % lower and no gain")];
    for ((quantity, paper), [single, pair]) in papers.into_iter().zip(&mut ratios) {
        println!(
            "{quantity}, median over {} that stay up: single {:.0} % lower, pair {:.0} % lower (the paper: {paper})",
            single.len(),
            100.0 * (1.0 - median(single)),
            100.0 * (1.0 - median(pair)),
        );
    }
    assert!(counted.len() > 60, "{} pulse-like motions", counted.len());
    // What the paper concludes, as directions: an inerter lowers the rotation, a clutched pair lowers it further.
    assert!(median(&mut ratios[0][0]) < 0.9 && median(&mut ratios[0][1]) < median(&mut ratios[0][0]));
}

/// What holds for any motion: the block uplifts exactly when the peak exceeds the threshold, and every sample is finite.
fn check(motion: &Motion, runs: &[DeviceRun], uplifts: bool) {
    for run in runs {
        assert_eq!(run.outcome != Outcome::NoRocking, uplifts, "{}: {} {}", motion.file, run.device, run.outcome);
        assert!(
            run.history.samples.iter().all(|s| s.rotation_rad.is_finite() && s.velocity_rad_s.is_finite()),
            "{}",
            motion.file
        );
        assert!(run.history.samples.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s), "{}", motion.file);
        assert!(run.outcome.overturned() || run.peak_rotation.is_some_and(|peak| peak < 1.5), "{}", motion.file);
    }
}
