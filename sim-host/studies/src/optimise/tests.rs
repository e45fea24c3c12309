//! `[optimise]` tables: what they resolve to, what they are refused for, and what is said of scores.

use std::path::Path;

use sprag_report::columns::write_csv;
use sprag_shared::math::ln;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::device::{Kind, MountName};
use sprag_sim::scene::drivetrain::EngagementName;

use super::choice_page::not_looked_at;
use super::design::{Candidate, Score};
use super::findings::{Findings, Fronts, Row};
use super::problem::{Choices, Problem, Solution};
use super::typed_tables::design_table;
use crate::cloud::study::{Study, StudyError};
use crate::statistics::Level;

fn parsed(text: &str) -> Result<Study, StudyError> {
    Study::parse(&format!("records = ['a.csv']\n{text}"), "study.toml", Path::new(""), &[], &[])
}

fn study(text: &str) -> Study {
    parsed(text).unwrap()
}

/// What `look` finds in the study `text` of pulses alone, once it is solved.
fn solved<R>(text: &str, look: impl FnOnce(&Problem<'_>, &Solution) -> R) -> R {
    let study = Study::parse(text, "study.toml", Path::new(""), &[], &[]).unwrap();
    let problem = Problem::new(Choices::of(&study).unwrap(), &[]);
    let solution = problem.solve(&mut (), &Interrupt::default(), &|_| (), &|_| ()).unwrap();
    look(&problem, &solution)
}

fn refusal(text: &str) -> String {
    match parsed(text) {
        Err(error) => error.to_string(),
        Ok(study) => Choices::of(&study).map(|_| ()).expect_err(text).to_string(),
    }
}

#[test]
fn a_study_without_the_table_has_the_devices_of_its_scene() {
    let study = study("");
    let choices = Choices::of(&study).unwrap();
    let names: Vec<String> = choices.curves.iter().map(super::curve::Curve::name).collect();
    assert_eq!(names, ["inerter, centre-of-mass", "clutched pair, centre-of-mass"]);
    assert!(!choices.limits.any() && choices.limits.quantile == 1.0 && choices.limits.force_of_overturned);
    let grid = choices.table.mass_ratio.grid();
    assert_eq!((grid.len(), grid[0], grid[11]), (12, 0.05, 2.0));
    assert!(grid.windows(3).all(|three| (three[1] * three[1] / (three[0] * three[2]) - 1.0).abs() < 1e-14));
}

/// The top of the block of 2 m is at 3.94 m.
#[test]
fn a_mount_above_the_block_is_warned_of() {
    let point = |height: f64| format!("{{ mount = 'tying-point', mount_height_m = {height} }}");
    let study = study(&format!("[optimise]\nmounts = ['centre-of-mass', {}, {}]", point(3.9), point(39.0)));
    let line = "study.toml: optimise.mounts.2.mount_height_m is 39: above the block, whose top is at 2R cos α = 3.9392 m";
    assert_eq!(Choices::of(&study).unwrap().warnings(), [line]);
}

#[test]
fn laws_are_devices_of_the_scene_or_ideal_ones() {
    let study = study(
        "[optimise]\nlaws = ['slipping', 'overrunning', 'inerter']\nmounts = ['base-corners', { mount = 'tying-point', \
         mount_height_m = 1.5, pulley_ratio = 2.0 }]\n[[structure]]\nname = 'a'\nset = { 'device.2' = { kind = 'clutched-pair', \
         name = 'slipping', mass_ratio = 0.3, clutch = { capacity_ratio = 0.1 } } }",
    );
    let choices = Choices::of(&study).unwrap();
    let names: Vec<String> = choices.curves.iter().map(super::curve::Curve::name).collect();
    // A flywheel of its own speed cannot be at the base corners; the others stay.
    let point = "tying-point 1.5 m, pulley 2";
    assert_eq!(
        names,
        ["slipping, ", "overrunning, ", "inerter, base-corners+", "inerter, "].map(|name| match name.strip_suffix('+') {
            Some(whole) => whole.to_owned(),
            None => format!("{name}{point}"),
        })
    );
    assert_eq!(choices.left_out.len(), 2);
    assert!(
        choices.left_out[0].starts_with("slipping, base-corners: ") && choices.left_out[0].contains("needs a horizontal mount")
    );
    assert!(choices.left_out.iter().all(|line| !line.contains("device.0")), "{:?}", choices.left_out);
    let [slipping, overrunning, ..] = &choices.curves[..] else { panic!() };
    assert_eq!(slipping.device.clutch.as_ref().and_then(|clutch| clutch.capacity_ratio), Some(0.1));
    assert_eq!((overrunning.device.kind, overrunning.device.engagement), (Kind::ClutchedPair, Some(EngagementName::Overrunning)));
    assert_eq!((slipping.device.mount, slipping.device.mass_ratio), (Some(MountName::TyingPoint), None));
    let scene = slipping.scene(&choices.structure.scene, 0.7, 0.0).unwrap();
    assert_eq!((scene.devices.len(), scene.devices[0].device.mass_ratio), (1, 0.7));
    assert!(scene.file.checks.is_some());
}

#[test]
fn limits_of_the_scene_stand_where_the_study_sets_none() {
    let checked = "[[structure]]\nname = 'a'\nset = { checks = { largest_force_ratio = 0.4, largest_stroke_m = 0.3 } }\n";
    let limits = |optimise: &str| {
        let study = study(&format!("{checked}{optimise}"));
        let limits = Choices::of(&study).unwrap().limits;
        (limits.force, limits.stroke)
    };
    assert_eq!(limits(""), (Some(0.4), Some(0.3)));
    assert_eq!(limits("[optimise]\nlargest_force_ratio = 0.1"), (Some(0.1), Some(0.3)));
    let parts = "[[structure]]\nname = 'a'\nset = { 'block.mass_kg' = 1e4, 'checks.gear' = { module_mm = 4, face_width_mm = 40, teeth = 20, \
                 allowable_stress_mpa = 200 }, 'checks.coil' = { holding_power_w = 24, largest_energy_j = 90 } }\n";
    let limits = |optimise: &str| {
        let study = study(&format!("{parts}{optimise}"));
        let limits = Choices::of(&study).unwrap().limits;
        (limits.tooth_stress, limits.coil_energy)
    };
    assert_eq!(limits(""), (Some(200.0), Some(90.0)));
    assert_eq!(limits("[optimise]\nlargest_tooth_stress_mpa = 150\nlargest_coil_energy_j = 20"), (Some(150.0), Some(20.0)));
}

/// A stroke is that of a standing block, whatever forces count.
#[test]
fn limits_say_in_which_motions_they_hold() {
    let words = |optimise: &str| super::page::limits(&Choices::of(&study(&format!("[optimise]\n{optimise}"))).unwrap());
    let [force, stroke] = ["largest_force_ratio = 0.3\n", "largest_stroke_m = 0.2\n"];
    let standing = "force_of_overturned = false\n";
    let both = words(&format!("{force}{stroke}"));
    assert_eq!(both, "max |F|/(mg) ≤ 0.3 in every motion and stroke ≤ 0.2 m in every motion in which the block stands");
    assert_eq!(words(force), "max |F|/(mg) ≤ 0.3 in every motion");
    assert_eq!(words(&format!("{force}{standing}")), "max |F|/(mg) ≤ 0.3 in every motion in which the block stands");
    let quantile = words(&format!("{stroke}limit_quantile = 0.9"));
    assert_eq!(quantile, "stroke ≤ 0.2 m as the 90 % quantile of the motions in which the block stands");
    assert_eq!(words(standing), "no limit");
}

/// Findings with a choice of this score, and of another one without limits, under ten motions.
fn findings([best, without]: [Score; 2]) -> Findings {
    let row = |score: Score| Row {
        law: "inerter".to_owned(),
        mount: Some("base-corners".to_owned()),
        mass_ratio: Some(0.5),
        probability: score.objective / 10.0,
        ..Row::of_score(&score)
    };
    Findings {
        motions: 10,
        specimens: Vec::new(),
        designs: 2,
        runs: 0,
        level: Level::COMMON,
        reference: Row::of_score(&Score::default()),
        best: Some(row(best)),
        nearest: None,
        best_without_limits: Some(row(without)),
        best_of_each: Vec::new(),
        delay_budget: None,
        ranking: None,
        neighbours: Vec::new(),
        limits_reached: Vec::new(),
        fronts: Fronts::default(),
        notes: Vec::new(),
        rows: vec![row(best), row(without)],
    }
}

/// Two specimens are counted together, or the worse of them alone.
#[test]
fn the_price_of_a_limit_is_in_the_measure_of_the_choice() {
    let price = |robust: &str, scores: [(usize, f64); 2]| {
        let study = study(&format!("[optimise]\nlargest_force_ratio = 0.3\nrobust = {{ samples = 2{robust} }}"));
        let score = |(overturned, objective)| Score { motions: 20, overturned, objective, ..Score::default() };
        let page = super::page::price(&Choices::of(&study).unwrap(), &findings(scores.map(score))).unwrap();
        page.lines().nth(3).unwrap().to_owned()
    };
    let (mean, worst) = ("", ", quantile = 1.0");
    let device = "inerter, base-corners, σ = 0.5000";
    // 3 and 0 beside 2 and 2; 2 and 2 beside 2 and 0.
    let dearer = price(worst, [(3, 3.0), (4, 2.0)]);
    let by = "of the motions by the 100 % quantile over the specimens";
    assert_eq!(dearer, format!("Without a limit {device} would overturn under 20 % {by} instead of 30 %."));
    let alike = price(worst, [(4, 2.0), (2, 2.0)]);
    assert_eq!(alike, format!("Nothing in overturning: without a limit the best device overturns under 20 % {by} too."));
    let in_the_mean = price(mean, [(4, 2.0), (2, 1.0)]);
    assert_eq!(in_the_mean, format!("Without a limit {device} would overturn under 2 of 20 motions instead of 4."));
}

/// A quantile of the forces is no bound of them.
#[test]
fn the_price_of_a_limit_names_the_quantile_of_its_force() {
    let price = |quantile: &str| {
        let study = study(&format!("[optimise]\nlargest_force_ratio = 0.3\n{quantile}"));
        let score = |overturned: usize, force| Score {
            motions: 10,
            overturned,
            objective: overturned as f64,
            force_ratio: Some(force),
            ..Score::default()
        };
        let page = super::page::price(&Choices::of(&study).unwrap(), &findings([score(4, 0.2), score(2, 0.5)])).unwrap();
        page.lines().nth(3).unwrap().to_owned()
    };
    assert!(price("").ends_with("instead of 4, with F/(mg) up to 0.5000."), "{}", price(""));
    let quantile = price("limit_quantile = 0.9");
    assert!(quantile.ends_with("instead of 4, with an F/(mg) whose 90 % quantile is 0.5000."), "{quantile}");
}

/// A robust study of pulses that is made small by its worst specimen.
const WORST: &str = "[optimise]\nlaws = ['inerter', 'clutched-pair']\nmass_ratio = { from = 0.2, to = 1.0, cells = 2 }\ndelays_s = [0.05]\n\
                     robust = { samples = 4, restitution = 0.3, quantile = 1.0 }\n\
                     [[optimise.pulse]]\nmotion = 'sine'\nfrequency_ratio = [2.0, 4.0]\namplitude_ratio = [1.2, 2.0, 3.0, 4.0]";

/// A quantile over the specimens stands beside no mean over them.
#[test]
fn means_are_shown_beside_means() {
    solved(WORST, |problem, solution| {
        let found = Findings::of(problem, solution);
        let best = found.best.as_ref().unwrap();
        let mean = best.overturned as f64 / best.motions as f64;
        assert_eq!(best.motions, 4 * 8);
        assert!(best.probability > mean, "the worst of specimens that differ: {} and {mean}", best.probability);
        // The band is of the share itself.
        assert!(
            found
                .rows
                .iter()
                .all(|row| row.probability_band.low <= row.probability && row.probability <= row.probability_band.high)
        );
        assert_eq!(found.delay_budget.as_ref().unwrap().late[0].probability, mean);
        let page = super::choice_page::choice_page(problem, &found).unwrap();
        let beside = format!("of the cases, beside {:.1} % above.", 100.0 * mean);
        assert!(page.contains(&beside), "{beside}\n{page}");
        let page = super::page::page(problem, &found).unwrap();
        assert!(page.contains("Share, from, to: the 100 % quantile over the specimens."), "{page}");
    });
}

/// What a page shows as a quantile of the motions is not their largest.
#[test]
fn the_page_says_of_which_quantile_its_forces_are() {
    let legend = |quantile: &str| {
        let text = WORST.replace("[optimise]", &format!("[optimise]\n{quantile}"));
        let page = solved(&text, |problem, solution| super::page::page(problem, &Findings::of(problem, solution)).unwrap());
        page.lines().skip_while(|line| !line.starts_with("F/(mg): ")).take(2).collect::<Vec<_>>().join(" ")
    };
    assert!(legend("").starts_with("F/(mg): over all motions, until"), "{}", legend(""));
    let words = legend("limit_quantile = 0.5\nforce_of_overturned = false");
    let of = "the 50 % quantile over the motions in which the block stands";
    assert!(words.starts_with(&format!("F/(mg): {of}; stroke: {of}.")), "{words}");
}

/// A motion counts once for each specimen that it shakes, in rotations as in overturning.
#[test]
fn rotations_are_compared_over_all_specimens() {
    solved(WORST, |problem, solution| {
        let found = Findings::of(problem, solution);
        let design = |row: &Row| {
            let all = || std::iter::once(&solution.bare).chain(&solution.designs);
            all().find(|design| design.candidate == row.candidate).unwrap()
        };
        let best = design(found.best.as_ref().unwrap());
        for rival in &found.ranking.as_ref().unwrap().rivals {
            let pairs = best.responses.iter().zip(&design(&rival.row).responses);
            let peaks =
                pairs.filter_map(|(best, other)| Some((best.as_ref().ok()?.peak_rotation?, other.as_ref().ok()?.peak_rotation?)));
            let logs: Vec<f64> =
                peaks.filter(|(best, other)| best.min(*other) > 0.0).map(|(best, other)| ln(other / best)).collect();
            let [mean, difference] = [logs.iter().sum::<f64>() / logs.len() as f64, rival.log_rotation.unwrap().difference];
            assert!((difference - mean).abs() < 1e-12, "{}: {difference} {mean}", rival.row.law);
        }
    });
}

/// At the base corners no clutch can be late: nothing is run for it, and one note says so.
#[test]
fn a_device_that_cannot_be_late_has_no_delay_budget() {
    let at_the_corners =
        WORST.replace("laws = ['inerter', 'clutched-pair']", "laws = ['clutched-pair']\nmounts = ['base-corners']");
    solved(&at_the_corners, |problem, solution| {
        let found = Findings::of(problem, solution);
        assert!(found.best.is_some() && found.delay_budget.is_none() && solution.failures.is_empty(), "{:?}", solution.failures);
        assert_eq!(found.runs, (1 + found.designs) * problem.trials());
        let notes: Vec<&String> = found.notes.iter().filter(|note| note.contains("delay budget")).collect();
        assert!(
            notes.len() == 1 && notes[0].contains("cannot be late: actuation: ") && notes[0].contains("base corners"),
            "{notes:?}"
        );
    });
}

/// Nobody knows what a run that failed would say, be it one of many or all of a delay.
#[test]
fn a_delay_budget_ends_where_a_run_fails() {
    let text = "[optimise]\nlaws = ['clutched-pair']\nmass_ratio = { from = 0.5, to = 1.0, cells = 2 }\ndelays_s = [0.001, 0.002]\n\
                [[optimise.pulse]]\nmotion = 'sine'\nfrequency_ratio = [1.5, 2.0, 2.5, 3.0, 3.5, 4.0]\namplitude_ratio = [1.5, 2.0, 3.0, 4.0]";
    solved(text, |problem, done| {
        let budget = Findings::of(problem, done).delay_budget.unwrap();
        assert_eq!((budget.largest_delay_s, budget.lost_at_s, budget.late.len()), (Some(0.002), None, 3));
        for (from, kept, lost) in [(0, 0.0, 0.001), (1, 0.001, 0.002)] {
            for failed in [1, problem.trials()] {
                let mut solution = done.clone();
                for design in &mut solution.late[from..] {
                    design.responses[..failed].fill(Err("stopped".to_owned()));
                    design.score =
                        Score::of(&design.responses, &done.bare.responses, &problem.choices.limits, problem.objective());
                }
                let budget = Findings::of(problem, &solution).delay_budget.unwrap();
                assert_eq!((budget.largest_delay_s, budget.lost_at_s, budget.late.len()), (Some(kept), Some(lost), 1 + from));
                let words =
                    format!("delay budget: better than no device for sure up to {kept:.4} s later, runs fail at {lost:.4} s");
                assert_eq!(budget.words(), words);
            }
        }
    });
}

/// What the scene of a study has was looked at.
#[test]
fn the_choice_denies_nothing_that_its_scene_has() {
    let lines = |set: &str| {
        let study = study(&format!("[optimise]\nlaws = ['clutched pair']\n[[structure]]\nname = 'a'\nset = {{ {set} }}"));
        let at = Candidate { curve: 0, mass_ratio: 0.5, delay_s: 0.0 };
        let best = Row { candidate: Some(at), ..Row::of_score(&Score::default()) };
        not_looked_at(&Choices::of(&study).unwrap(), &best).join("\n")
    };
    let denied = ["scatter of restitution, size or slenderness", "or move its foundation", "The clutch is the paper's"];
    let plain = lines("'block.size_m' = 2.0");
    assert!(denied.iter().all(|words| plain.contains(words)), "{plain}");
    for (set, words, instead) in [
        ("'block.restitution_scatter' = 0.02", denied[0], "no scatter of size or slenderness."),
        ("'block.foundation' = { vertical_frequency_hz = 10.0, damping_ratio = 0.3 }", denied[1], "does not slide or twist."),
        ("'device.2.inertance_corner_hz' = 4.0", denied[2], "obeys at once"),
    ] {
        let found = lines(set);
        assert!(!found.contains(words) && found.contains(instead) && !found.contains("rigid"), "{set}: {found}");
        assert!(denied.iter().filter(|other| **other != words).all(|other| found.contains(other)), "{set}: {found}");
    }
    let of_support = "Strokes are travels of the block against the ground";
    assert!(lines("'device.2.support_amplification' = 1.2").contains(of_support) && !plain.contains(of_support), "{plain}");
}

#[test]
fn a_force_that_no_motion_shows_is_no_number() {
    let forces = |force_ratio: [Option<f64>; 2]| {
        let score = |force_ratio| Score { motions: 10, force_ratio, ..Score::default() };
        let mut csv = Vec::new();
        write_csv(&design_table(&findings(force_ratio.map(score))), &mut csv).unwrap();
        let text = String::from_utf8(csv).unwrap();
        let mut rows = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let column = rows.next().unwrap().iter().position(|title| title == "peak_force_ratio").unwrap();
        rows.map(|row| row[column].clone()).collect::<Vec<_>>()
    };
    assert_eq!(forces([None, Some(0.25)]), ["", "", "0.25"]);
}

#[test]
fn one_of_several_structures_is_named() {
    let two = "[[structure]]\nname = 'a'\n[[structure]]\nname = 'b'\nset = { 'block.size_m' = 1 }\n";
    assert_eq!(refusal(two), "study.toml: optimise.structure is missing: which of the structures \"a\", \"b\" gets the device");
    let study = study(&format!("{two}[optimise]\nstructure = 'b'"));
    assert_eq!(Choices::of(&study).unwrap().structure.name, "b");
}

#[test]
fn what_is_wrong_is_named_with_its_key_its_value_and_its_range() {
    for (keys, expected) in [
        ("mass_ratio = { from = 0, to = 1 }", "optimise.mass_ratio.from is 0, but must be above 0, to 10000"),
        ("mass_ratio = { from = 1, to = 1 }", "optimise.mass_ratio.to is 1, but must be above `from`, to 10000"),
        ("mass_ratio = { from = 1, to = nan }", "optimise.mass_ratio.to is NaN, but must be above 0, to 10000"),
        ("mass_ratio = { from = 1, to = 2, cells = 1 }", "optimise.mass_ratio.cells is 1, but must be from 2 to 1000"),
        ("largest_force_ratio = 0", "optimise.largest_force_ratio is 0, but must be above 0, to 1e6"),
        ("largest_stroke_m = -1", "optimise.largest_stroke_m is -1, but must be above 0, to 10000 m"),
        ("largest_tooth_stress_mpa = 0", "optimise.largest_tooth_stress_mpa is 0, but must be above 0, to 100000 MPa"),
        ("largest_tooth_stress_mpa = 200", "optimise.largest_tooth_stress_mpa: it needs checks.gear of the scene"),
        ("largest_coil_energy_j = -1", "optimise.largest_coil_energy_j is -1, but must be above 0, to 1e9 J"),
        ("largest_coil_energy_j = 100", "optimise.largest_coil_energy_j: it needs checks.coil of the scene"),
        ("laws = ['controller:magic']", "optimise.laws.0 is \"controller:magic\", but must be among \"controller:passive\""),
        ("setting = [{ key = 'clutch.magic', values = [1] }]", "optimise.setting.0.values: "),
        (
            "setting = [{ key = 'clutch.capacity_ratio', values = [-1] }]",
            "optimise.setting.0.values: clutch.capacity_ratio is -1",
        ),
        ("setting = [{ key = 'controller.hysteresis', values = [1] }]", "optimise.setting.0.key: no law has a controller"),
        ("setting = [{ key = 'mount_height_m', values = [1], laws = ['magic'] }]", "optimise.setting.0.laws is \"magic\""),
        ("delays_s = [0.1, 0.1]", "optimise.delays_s.1 is 0.1, but must be above the delay before it"),
        ("delays_s = [0]", "optimise.delays_s.0 is 0, but must be above 0, to 10 s"),
        ("pulse = [{ motion = 'record' }]", "optimise.pulse.0.motion: records are `records` of the study"),
        ("pulse = [{ motion = 'sine', amplitude_g = [0.3] }]", "optimise.pulse.0.frequency_ratio is missing"),
        (
            "pulse = [{ motion = 'sine', frequency_hz = [0] }]",
            "optimise.pulse.0.frequency_hz.0 is 0, but must be from 0.001 to 1000",
        ),
        (
            "pulse = [{ motion = 'mavroeidis-papageorgiou', oscillations = [1] }]",
            "optimise.pulse.0.oscillations.0 is 1, but must be above 1, to 100",
        ),
        (
            "pulse = [{ motion = 'sine', duration_s = [1] }]",
            "optimise.pulse.0.duration_s: a motion of kind \"sine\" has no such key",
        ),
        ("robust = { samples = 0 }", "optimise.robust.samples is 0, but must be from 1 to 1000"),
        ("robust = { restitution = 0.6 }", "optimise.robust.restitution is 0.6, but must be from 0 to 0.5"),
        ("robust = { size_belief = -0.1 }", "optimise.robust.size_belief is -0.1, but must be from 0 to 0.5"),
        ("robust = { quantile = 2 }", "optimise.robust.quantile is 2, but must be from 0 to 1"),
        ("limit_quantile = 1.5", "optimise.limit_quantile is 1.5, but must be from 0 to 1"),
        ("structure = 'tall'", "optimise.structure is \"tall\", but must be among the structures"),
        ("laws = ['magic']", "optimise.laws.0 is \"magic\", but must be among \"inerter\", \"clutched-pair\", \"rigid\""),
        ("laws = ['none']", "optimise.laws.0: the device \"none\" of the scene has no inerter"),
        (
            "pulse = [{ motion = 'sine', amplitude_ratio = [2, 2], frequency_ratio = [3] }]",
            "optimise.pulse.0.amplitude_ratio.1: this value is there already",
        ),
        (
            "setting = [{ key = 'clutch.capacity_ratio', values = [0.1, 0.1] }]",
            "optimise.setting.0.values.1: this value is there already",
        ),
        ("laws = ['rigid', 'rigid']", "optimise.laws.1: \"rigid\" is there twice"),
        ("mounts = ['tying-point']", "optimise.mounts.0.mount_height_m is missing: the height of the tying point"),
        ("mounts = ['base-corners', 'base-corners']", "optimise.mounts.1: \"base-corners\" is there twice"),
        ("mounts = [{ mount = 'base-corners', pulley_ratio = -1 }]", "optimise.mounts.0.pulley_ratio is -1, but must be above 0"),
        (
            "mounts = [{ mount = 'tying-point', mount_height_m = 0 }]",
            "optimise.mounts.0.mount_height_m is 0, but must be above 0 m",
        ),
        ("laws = ['rigid']\nmounts = ['base-corners']", "optimise.laws: none of them can be; rigid, base-corners: "),
    ] {
        let message = refusal(&format!("[optimise]\n{keys}"));
        assert!(message.starts_with("study.toml:") && message.contains(expected), "{keys}: {message}");
        assert!(!message.contains('\n'), "{message}");
    }
    let syntax = |keys: &str| parsed(&format!("[optimise]\n{keys}")).unwrap_err().to_string();
    for (keys, expected) in [
        ("mounts = ['roof']", "optimise.mounts.0: a mount is \"centre-of-mass\", \"base-corners\", or"),
        ("mass_ratio = 1", "optimise.mass_ratio"),
        ("limits = 1", "unknown field `limits`"),
        ("law = 1", "optimise.law is not a key; did you mean `laws`?"),
    ] {
        let message = syntax(keys);
        assert!(message.starts_with("study.toml") && message.contains(expected), "{message}");
    }
}

#[test]
fn a_controller_over_a_block_on_a_foundation_is_refused_before_the_first_run() {
    let soft = "[[structure]]\nname = 'a'\nset = { 'block.foundation' = { vertical_frequency_hz = 8, damping_ratio = 0.3 } }\n";
    let refused = refusal(&format!("{soft}[optimise]\nlaws = ['inerter', 'controller:resisting-predicted']"));
    assert!(refused.ends_with("block.foundation: a controller follows a block on rigid ground"), "{refused}");
}
