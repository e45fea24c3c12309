//! The choice of a device by the library: what is chosen is the best of what was tried, and does what a simulation of it does.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sprag_report::columns::write_csv;
use sprag_report::long_run::origin::Origin;
use sprag_report::long_run::start::Start;
use sprag_report::output::Subject;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::simulation::{DeviceRun, RunError, simulate_for_study};
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::study::Study;
use sprag_studies::optimise::choice_page::{choice_page, choice_picture};
use sprag_studies::optimise::design::Candidate;
use sprag_studies::optimise::figure::trade_off_picture;
use sprag_studies::optimise::findings::{Findings, Row};
use sprag_studies::optimise::page::{choice_table, page};
use sprag_studies::optimise::problem::{Choices, Problem, Solution};
use sprag_studies::optimise::response::Response;
use sprag_studies::optimise::specimen::NOMINAL;
use sprag_studies::optimise::subject::Subject as OneDesign;
use sprag_studies::optimise::tried::{MOST_ROWS, Tried, TriedError};
use sprag_studies::optimise::typed_tables::design_table;
use sprag_studies::statistics::quantile;
use sprag_tests::pulse_records::sine_pulses;
use sprag_tests::scene_text::runs;

/// Pulses of which the bare block of 1 m survives some, and an optimisation over two laws and two mounts.
const SCENE: &str = "[[structure]]\nname = 'small'\nset = { 'block.size_m' = 1.0 }\n";
const SPACE: &str = "mass_ratio = { from = 0.1, to = 1.5, cells = 5 }\nlaws = ['inerter', 'clutched-pair']\n\
                     mounts = ['centre-of-mass', { mount = 'base-corners', pulley_ratio = 3.0 }]\n";

fn pulses() -> tempfile::TempDir {
    sine_pulses(&[0.2, 0.35, 0.5, 0.8], &[0.5, 0.9, 1.4])
}

/// A study of the small block with a table `[optimise]`.
pub fn study(optimise: &str, records: &Path) -> Study {
    let text = format!("{SCENE}[optimise]\n{SPACE}{optimise}");
    Study::parse(&text, "study.toml", Path::new(""), &[], &[PathBuf::from(records)]).unwrap()
}

/// What `then` makes of the answer to `study`.
pub fn answered<R>(study: &Study, then: impl FnOnce(&Problem<'_>, &Solution, &Findings) -> R) -> R {
    let records = StudyRecords::read(study).unwrap();
    let problem = Problem::new(Choices::of(study).unwrap(), &records.records);
    let solution = problem.solve(&mut (), &Interrupt::default(), &|_| (), &|_| ()).unwrap();
    let findings = Findings::of(&problem, &solution);
    then(&problem, &solution, &findings)
}

/// The table of designs as numbers, by column.
struct Designs {
    titles: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Designs {
    fn of(findings: &Findings) -> Designs {
        let mut bytes = Vec::new();
        write_csv(&design_table(findings), &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        // Names of mounts with a pulley hold a comma.
        let fields = |line: &str| -> Vec<String> {
            let mut quoted = false;
            let split = line.split(|c: char| {
                quoted ^= c == '"';
                c == ',' && !quoted
            });
            split.map(|field| field.trim_matches('"').to_owned()).collect()
        };
        let mut lines = text.lines().map(fields);
        Designs { titles: lines.next().unwrap(), rows: lines.collect() }
    }

    fn text(&self, row: &[String], title: &str) -> String {
        row[self.titles.iter().position(|other| other == title).unwrap_or_else(|| panic!("{title}"))].clone()
    }

    /// The number in a cell; an empty one is infinite.
    fn number(&self, row: &[String], title: &str) -> f64 {
        let text = self.text(row, title);
        if text.is_empty() { f64::INFINITY } else { text.parse().unwrap() }
    }

    /// In the order of preference.
    fn merit(&self, row: &[String]) -> [f64; 3] {
        ["overturned", "median_peak_rotation", "peak_force_ratio"].map(|title| self.number(row, title))
    }
}

fn less(one: [f64; 3], other: [f64; 3]) -> bool {
    one.partial_cmp(&other) == Some(std::cmp::Ordering::Less)
}

#[test]
fn the_best_is_the_least_of_the_table_and_respects_the_limits() {
    let folder = pulses();
    for (limits, asked) in [
        ("largest_force_ratio = 0.15", [0.15, f64::INFINITY]),
        ("largest_stroke_m = 0.12", [f64::INFINITY, 0.12]),
        ("largest_force_ratio = 0.3\nlargest_stroke_m = 0.2", [0.3, 0.2]),
        ("largest_force_ratio = 0.15\nlimit_quantile = 0.8", [0.15, f64::INFINITY]),
        ("", [f64::INFINITY; 2]),
    ] {
        answered(&study(limits, folder.path()), |_, _, findings| {
            let table = Designs::of(findings);
            let best = findings.best.as_ref().unwrap();
            let [bare, rows @ ..] = &table.rows[..] else { panic!() };
            assert_eq!((table.text(bare, "law"), rows.len()), ("none".to_owned(), findings.designs));
            let chosen: Vec<&Vec<String>> = rows.iter().filter(|row| is(&table, row, best)).collect();
            let [chosen] = chosen[..] else { panic!("{limits}: {} rows are the best", chosen.len()) };
            let respects = |row: &[String]| {
                let stroke = table.number(row, "stroke_m");
                // A stroke of a block that never stands is none.
                table.number(row, "peak_force_ratio") <= asked[0] && (stroke <= asked[1] || stroke == f64::INFINITY)
            };
            assert!(respects(chosen), "{limits}: {chosen:?}");
            for row in rows {
                assert_eq!(table.text(row, "feasible") == "true", respects(row), "{limits}: {row:?}");
                assert!(!respects(row) || !less(table.merit(row), table.merit(chosen)), "{limits}: {row:?} before {chosen:?}");
            }
            // The limits are felt, or the test would show nothing.
            let refused = rows.iter().filter(|row| !respects(row)).count();
            assert_eq!(refused > 0, !limits.is_empty(), "{limits}");
        });
    }
}

/// Whether `row` of the table is this one.
fn is(table: &Designs, row: &[String], this: &Row) -> bool {
    let [law, mount] = ["law", "mount"].map(|title| table.text(row, title));
    law == this.law && Some(mount) == this.mount && this.mass_ratio == Some(table.number(row, "mass_ratio"))
}

#[test]
fn rivals_are_compared_motion_by_motion() {
    let folder = pulses();
    answered(&study("largest_force_ratio = 0.3", folder.path()), |problem, solution, findings| {
        let (best, ranking) = (findings.best.as_ref().unwrap(), findings.ranking.as_ref().unwrap());
        // Every pulse is a record without an earthquake; the rivals are the bare block and the best of the other laws and mounts.
        assert_eq!((ranking.groups, ranking.records_without_event, ranking.rivals.len()), (12, 12, findings.best_of_each.len()));
        let responses = |row: &Row| {
            let all = || std::iter::once(&solution.bare).chain(&solution.designs);
            &all().find(|design| design.candidate == row.candidate).unwrap().responses
        };
        let overturned = |row: &Row| -> Vec<bool> {
            responses(row).iter().map(|response| response.as_ref().unwrap().outcome.overturned()).collect()
        };
        let page = choice_page(problem, findings).unwrap();
        for rival in &ranking.rivals {
            let pairs: Vec<(bool, bool)> = overturned(best).into_iter().zip(overturned(&rival.row)).collect();
            let [saved, lost] = [(false, true), (true, false)].map(|kind| pairs.iter().filter(|pair| **pair == kind).count());
            let paired = rival.overturning;
            assert_eq!((paired.pairs, paired.groups_above, paired.groups_below), (12, saved, lost));
            assert!((paired.difference - (saved as f64 - lost as f64) / 12.0).abs() < 1e-12);
            assert_eq!(rival.alike, (saved, lost) == (0, 0));
            let band = paired.band.unwrap();
            assert!(band.low <= paired.difference && paired.difference <= band.high);
            assert!(!rival.sure || paired.chance <= 0.05 && band.low > 0.0);
            let rotation = rival.log_rotation.unwrap();
            assert!(rotation.pairs <= pairs.iter().filter(|pair| **pair == (false, false)).count());
        }
        assert_eq!(
            (ranking.rivals[0].overturning.groups_above, ranking.rivals[0].overturning.groups_below),
            (best.saved, best.newly_overturned)
        );
        assert!(page.contains(" no device") && page.contains("## What was not looked at"), "{page}");
        let shares: f64 = ranking.chosen_again.iter().map(|again| again.share).sum();
        assert!((shares - 1.0).abs() < 1e-12 && ranking.probability_left_out.is_some());
        assert!(choice_picture(problem, findings).unwrap().unwrap().contains("no device"));
    });
}

#[test]
fn nothing_tried_betters_a_member_of_a_front() {
    let folder = pulses();
    answered(&study("largest_stroke_m = 0.15", folder.path()), |problem, _, findings| {
        let table = Designs::of(findings);
        let within = |row: &[String], quantity: &str| quantity == "stroke_m" || table.text(row, "feasible") == "true";
        for (front, quantity, rows) in [
            ("on_force_front", "peak_force_ratio", &findings.fronts.force),
            ("on_stroke_front", "stroke_m", &findings.fronts.stroke),
        ] {
            // The bare block has no device, and asks for nothing.
            let asks = |row: &[String]| if table.text(row, "law") == "none" { 0.0 } else { table.number(row, quantity) };
            let points: Vec<(f64, f64, bool)> = table
                .rows
                .iter()
                .filter(|row| within(row, quantity))
                .map(|row| (asks(row), table.number(row, "overturned"), table.text(row, front) == "true"))
                .collect();
            let betters = |a: &(f64, f64, bool), b: &(f64, f64, bool)| a.0 <= b.0 && a.1 <= b.1 && (a.0, a.1) != (b.0, b.1);
            for point in &points {
                assert_eq!(point.2, !points.iter().any(|other| betters(other, point)), "{front}: {point:?}");
            }
            let members = points.iter().filter(|point| point.2).count();
            assert!(members == rows.len() && members >= 2, "{members} members");
            assert!(rows.windows(2).all(|pair| pair[0].overturned >= pair[1].overturned));
        }
        assert!(trade_off_picture(problem, findings).unwrap().contains("stroke, max |"));
    });
}

#[test]
fn a_tighter_limit_never_overturns_less() {
    let folder = pulses();
    let mut before: Option<(f64, f64, usize)> = None;
    let mut counts = Vec::new();
    for limit in [0.6, 0.4, 0.3, 0.2, 0.08] {
        answered(&study(&format!("largest_force_ratio = {limit}"), folder.path()), |_, _, findings| {
            let best = findings.best.as_ref().unwrap();
            if let Some((looser, low, overturned)) = before {
                assert!(best.overturned >= overturned && best.probability_band.low >= low, "{limit} and {looser}");
            }
            assert!(best.peak_force_ratio.unwrap() <= limit && best.probability == best.overturned as f64 / 12.0);
            before = Some((limit, best.probability_band.low, best.overturned));
            counts.push(best.overturned);
        });
    }
    assert!(counts[0] < counts[4], "the limit is felt: {counts:?}");
}

#[test]
fn no_design_within_the_limits_is_said_with_the_nearest() {
    let folder = pulses();
    answered(&study("largest_force_ratio = 0.001", folder.path()), |problem, _, findings| {
        assert!(findings.best.is_none() && findings.best_of_each.is_empty() && findings.neighbours.is_empty());
        let nearest = findings.nearest.as_ref().unwrap();
        let least = findings.rows.iter().map(|row| row.peak_force_ratio.unwrap()).fold(f64::INFINITY, f64::min);
        assert_eq!(nearest.design.peak_force_ratio, Some(least));
        assert!((nearest.demand_over_limit - least / 0.001).abs() < 1e-9 && nearest.demand_over_limit > 1.0);
        assert!(page(problem, findings).unwrap().contains("No device respects the limits."));
        assert!(choice_page(problem, findings).is_none() && choice_picture(problem, findings).unwrap().is_none());
        trade_off_picture(problem, findings).unwrap();
    });
}

#[test]
fn without_overturning_the_choice_is_by_rotation() {
    let folder = sine_pulses(&[0.2, 0.25], &[0.3, 0.4]);
    answered(&study("", folder.path()), |_, solution, findings| {
        let best = findings.best.as_ref().unwrap();
        assert_eq!((best.overturned, findings.reference.overturned), (0, 0));
        assert!(findings.notes.iter().any(|note| note.contains("the choice is by peak rotation only")), "{:?}", findings.notes);
        let least = solution.designs.iter().map(|design| design.score.median_rotation).fold(f64::INFINITY, f64::min);
        assert_eq!(best.median_peak_rotation, Some(least));
        assert!(best.median_peak_rotation < findings.reference.median_peak_rotation);
    });
}

/// Interrupted twice and resumed, a search makes no run again that it counted as done, and comes to the same.
#[test]
fn an_interrupted_search_resumes() {
    let records = sine_pulses(&[0.3, 0.5], &[0.5, 1.0]);
    let study = study("", records.path());
    let records = StudyRecords::read(&study).unwrap();
    let problem = Problem::new(Choices::of(&study).unwrap(), &records.records);
    let whole = problem.solve(&mut (), &Interrupt::default(), &|_| (), &|_| ()).unwrap();

    let folder = tempfile::tempdir().unwrap();
    let origin = || Origin::new(Subject::new("optimise", BTreeMap::new()), MOST_ROWS);
    let mut made = 0;
    let mut part = |start: Start, most: u64| {
        let mut tried = Tried::begin(folder.path(), origin(), start, problem.trials()).unwrap();
        let (interrupt, runs) = (Interrupt::default(), Cell::new(0));
        let solution = problem.solve(&mut tried, &interrupt, &|_| (), &|more| {
            runs.set(runs.get() + more);
            if runs.get() >= most {
                interrupt.set();
            }
        });
        made += runs.get();
        (solution, tried)
    };
    for start in [Start::New, Start::Resume] {
        assert!(matches!(part(start, 60), (Err(TriedError::Run(RunError::Interrupted)), _)));
    }
    let (solution, tried) = part(Start::Resume, u64::MAX);
    let solution = solution.unwrap();
    assert_eq!((solution.bare, solution.designs), (whole.bare, whole.designs));
    assert!(made == whole.runs as u64 && made > 200, "{made} of {}", whole.runs);
    tried.discard().unwrap();
}

/// The device of `best` under one record, as a scene of its own says it: by `sprag simulate`.
fn simulated(best: &Row, record: &Path, size_m: f64) -> DeviceRun {
    let mount = match best.mount.as_deref() {
        Some("centre-of-mass") => "mount = 'centre-of-mass'",
        Some("base-corners, pulley 3") => "mount = 'base-corners'\npulley_ratio = 3.0",
        other => panic!("{other:?}"),
    };
    let text = format!(
        "[block]\nsize_m = {size_m:?}\nslenderness_deg = 10.0\nrestitution = 0.85\n[[device]]\nkind = '{}'\nmass_ratio = {:?}\n{mount}\n\
         [[ground]]\nmotion = 'record'\nfile = '{}'\n[run]\nfree_time_s = 10.0\n[checks]\n",
        best.law,
        best.mass_ratio.unwrap(),
        record.display()
    );
    runs(&text).remove(0)
}

fn near(one: f64, other: f64, tolerance: f64) -> bool {
    (one - other).abs() <= tolerance * other.abs().max(1e-3)
}

/// Lanes and core follow one motion to rounding, which long records of many impacts magnify.
fn assert_alike(found: &Response, alone: &Response, tolerance: f64, what: &str) {
    let what = format!("{what}: {found:?} {alone:?}");
    assert_eq!(found.outcome, alone.outcome, "{what}");
    let maybe_near = |one: Option<f64>, other: Option<f64>| match (one, other) {
        (Some(one), Some(other)) => near(one, other, tolerance),
        (one, other) => one == other,
    };
    assert!(maybe_near(found.peak_rotation, alone.peak_rotation), "{what}");
    assert!(near(found.force_ratio, alone.force_ratio, tolerance), "{what}");
    assert!(near(found.stroke_m, alone.stroke_m, tolerance), "{what}");
    assert!(maybe_near(found.tooth_stress_mpa, alone.tooth_stress_mpa), "{what}");
    assert!(maybe_near(found.coil_energy_j, alone.coil_energy_j), "{what}");
}

/// Outcomes, forces and strokes of the best design, again, to `tolerance`.
pub fn simulated_again(study: &Study, tolerance: f64, path_of: impl Fn(&str) -> PathBuf) {
    answered(study, |problem, solution, findings| {
        let best = findings.best.as_ref().unwrap();
        let design = solution.designs.iter().find(|design| design.candidate == best.candidate).unwrap();
        let runs: Vec<DeviceRun> = problem.motions.iter().map(|motion| simulated(best, &path_of(&motion.name), 1.0)).collect();
        for ((motion, response), run) in problem.motions.iter().zip(&design.responses).zip(&runs) {
            let (response, alone) = (response.as_ref().unwrap(), Response::of(run));
            assert_alike(response, &alone, tolerance, &motion.scaled_name());
            // What a history samples is never above the largest, and not far below.
            let sampled = run.history.peak_force_ratio();
            assert!(sampled <= response.force_ratio * (1.0 + 1e-9) && sampled >= 0.9 * response.force_ratio);
        }
        assert_eq!(best.overturned, runs.iter().filter(|run| run.outcome.overturned()).count());
        let forces: Vec<f64> = runs.iter().filter_map(|run| run.peak_force_ratio).collect();
        assert!(near(best.peak_force_ratio.unwrap(), quantile(&forces, 1.0).unwrap(), tolerance));
        let standing = runs.iter().filter(|run| !run.outcome.overturned());
        let stroke = standing.map(|run| run.checks.as_ref().unwrap().stroke_m.unwrap_or(0.0)).fold(0.0, f64::max);
        assert!(near(best.stroke_m.unwrap(), stroke, tolerance));
        assert!(runs.iter().any(|run| run.outcome == Outcome::Safe));
        eprintln!("{}", choice_table(findings).unwrap().markdown());
    });
}

#[test]
fn the_best_device_does_the_same_in_a_scene_of_its_own() {
    let folder = pulses();
    simulated_again(&study("largest_force_ratio = 0.2", folder.path()), 1e-10, |name| folder.path().join(name));
}

#[test]
fn devices_do_in_lanes_what_they_do_alone() {
    let folder = pulses();
    let text = "scene = 'scene.toml'\n[[structure]]\nname = 'small'\nset = { 'block.size_m' = 1.0 }\n[optimise]\nmass_ratio = { from = 0.1, to = 1.5, cells = 3 }\nlaws = ['inerter', 'clutched-pair', 'coasting', 'with capacity']\nmounts = ['centre-of-mass', { mount = 'tying-point', mount_height_m = 1.8 }]\n";
    let scene = "[block]\nsize_m = 1.0\nslenderness_deg = 10.0\nrestitution = 0.85\nmass_kg = 2e3\n[checks]\nlargest_stroke_m = 0.5\n\
                 gear = { module_mm = 4.0, face_width_mm = 40.0, teeth = 20, allowable_stress_mpa = 200.0 }\n\
                 coil = { holding_power_w = 24.0, closing_energy_j = 2.0 }\n\
                 [[device]]\nname = 'coasting'\nkind = 'clutched-pair'\nmass_ratio = 0.5\nengagement = 'rigid'\n\
                 flywheel = { dry_deceleration_m_s2 = 0.05 }\nactuation = { engagement_delay_s = 0.02, release_delay_s = 0.01 }\n\
                 [[device]]\nname = 'with capacity'\nkind = 'clutched-pair'\nmass_ratio = 0.5\nclutch = { capacity_ratio = 0.1 }\n\
                 weight = { flywheels_ratio = 0.05, flywheels_on = 'block' }\n\
                 [[ground]]\nmotion = 'record'\n[run]\nfree_time_s = 5.0\n";
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let study = Study::parse(text, "study.toml", folder.path(), &[], &[folder.path().to_owned()]).unwrap();
    answered(&study, |problem, solution, _| {
        let (mut safe, mut held) = (0, 0);
        for design in &solution.designs {
            let Candidate { curve, mass_ratio, delay_s } = design.candidate.unwrap();
            let curve = &problem.choices.curves[curve];
            let scene = curve.scene(&problem.choices.structure.scene, mass_ratio, delay_s).unwrap();
            let in_lanes = OneDesign::new(scene.clone(), false, &NOMINAL).unwrap().in_lanes(&problem.motions);
            for ((motion, response), in_lanes) in problem.motions.iter().zip(&design.responses).zip(in_lanes) {
                let run = simulate_for_study(&scene, &motion.ground(), &Interrupt::default()).unwrap().remove(0);
                let (found, alone) = (in_lanes.unwrap(), Response::of(&run));
                assert_eq!(response, &Ok(found));
                let what = format!("{}, {mass_ratio}, {}", curve.name(), motion.scaled_name());
                assert_alike(&found, &alone, 1e-8, &what);
                safe += usize::from(alone.outcome == Outcome::Safe);
                held += usize::from(alone.coil_energy_j.is_some_and(|energy| energy > 0.0));
                assert_eq!(alone.tooth_stress_mpa.is_some_and(|stress| stress > 0.0), alone.force_ratio > 0.0, "{what}");
            }
        }
        assert!(safe > 20 && held > 20, "{safe} {held}");
    });
}
