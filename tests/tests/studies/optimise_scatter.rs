//! The choice of a device under a scatter, under pulses, over settings, with later clutches and with a controller in the loop.

use std::path::{Path, PathBuf};

use sprag_sim::interrupt::Interrupt;
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::study::Study;
use sprag_studies::optimise::findings::Findings;
use sprag_studies::optimise::problem::{Choices, Problem, Solution};
use sprag_tests::pulse_records::sine_pulses;

/// A study of the block of 1 m with these keys of `[optimise]`, under the records of a folder, or none.
fn study(set: &str, optimise: &str, records: Option<&Path>) -> Study {
    let text = format!(
        "[[structure]]\nname = 'small'\nset = {{ 'block.size_m' = 1.0{set} }}\n[optimise]\n\
         mass_ratio = {{ from = 0.2, to = 1.0, cells = 3 }}\n{optimise}"
    );
    let records: Vec<PathBuf> = records.map(PathBuf::from).into_iter().collect();
    Study::parse(&text, "study.toml", Path::new(""), &[], &records).unwrap()
}

fn answered<R>(study: &Study, then: impl FnOnce(&Problem<'_>, &Solution, &Findings) -> R) -> R {
    let records = StudyRecords::read(study).unwrap();
    let problem = Problem::new(Choices::of(study).unwrap(), &records.records);
    let solution = problem.solve(&mut (), &Interrupt::default(), &|_| (), &|_| ()).unwrap();
    assert!(solution.failures.is_empty(), "{:?}", solution.failures);
    let findings = Findings::of(&problem, &solution);
    then(&problem, &solution, &findings)
}

const LAWS: &str = "laws = ['inerter', 'clutched-pair']\n";

#[test]
fn a_scatter_of_nothing_is_the_nominal_choice() {
    let folder = sine_pulses(&[0.35, 0.5, 0.8], &[0.5, 0.9, 1.4]);
    let of = |robust: &str| {
        answered(
            &study("", &format!("{LAWS}largest_force_ratio = 0.3\n{robust}"), Some(folder.path())),
            |problem, solution, findings| {
                let best = findings.best.clone().unwrap();
                let tried: Vec<_> = solution.designs.iter().map(|design| design.candidate).collect();
                (
                    problem.specimens.len(),
                    best.candidate,
                    best.probability,
                    best.probability_band,
                    best.median_peak_rotation,
                    tried,
                )
            },
        )
    };
    let (nominal, still) = (of(""), of("robust = { samples = 3, restitution = 0.0 }"));
    assert_eq!((nominal.0, still.0), (1, 3));
    assert_eq!((nominal.1, nominal.2, nominal.3, nominal.4, nominal.5), (still.1, still.2, still.3, still.4, still.5));
}

/// Every specimen does what a block of its restitution does, and it is the same for every design.
#[test]
fn a_specimen_is_a_block_of_its_own_restitution() {
    let folder = sine_pulses(&[0.35, 0.6], &[0.5, 1.0]);
    let robust = format!("{LAWS}robust = {{ samples = 3, restitution = 0.1, seed = 4 }}");
    answered(&study("", &robust, Some(folder.path())), |problem, solution, findings| {
        let motions = problem.motions.len();
        assert_eq!((motions, findings.specimens.len(), problem.trials()), (4, 3, 12));
        for (index, specimen) in problem.specimens.iter().enumerate() {
            assert!((specimen.restitution - 1.0).abs() <= 0.1);
            let of_it = format!(", 'block.restitution' = {:?}", 0.85 * specimen.restitution);
            answered(&study(&of_it, LAWS, Some(folder.path())), |_, alone, _| {
                assert_eq!(solution.bare.responses[index * motions..][..motions], alone.bare.responses[..]);
                let known = |design: &sprag_studies::optimise::design::Design| {
                    solution.designs.iter().find(|other| other.candidate == design.candidate).cloned()
                };
                let both: Vec<_> = alone.designs.iter().filter_map(|design| Some((known(design)?, design))).collect();
                assert!(both.len() >= 6, "the first grid of both");
                for (robust, alone) in both {
                    assert_eq!(robust.responses[index * motions..][..motions], alone.responses[..]);
                }
            });
        }
        let [first, last] = [0, 2].map(|specimen: usize| solution.bare.responses[specimen * motions].clone());
        assert_ne!(first, last, "the scatter is felt");
    });
}

#[test]
fn pulses_are_the_motions_of_a_scene() {
    let keys = format!(
        "{LAWS}[[optimise.pulse]]\nmotion = 'sine'\nfrequency_ratio = [2.0, 4.0]\namplitude_ratio = [1.5, 3.0, 6.0]\n\
         [[optimise.pulse]]\nmotion = 'ricker'\nfrequency_hz = [1.0]\namplitude_g = [0.5]"
    );
    answered(&study("", &keys, None), |problem, solution, findings| {
        assert_eq!(findings.motions, 7);
        assert_eq!(problem.motions[1].name, "sine frequency_ratio=2 amplitude_ratio=3");
        let ranking = findings.ranking.as_ref().unwrap();
        assert_eq!((ranking.pulses, ranking.groups, ranking.records_without_event), (7, 7, 0));
        let run = |motion: &str| {
            let text = format!(
                "[block]\nsize_m = 1.0\nslenderness_deg = 10.0\nrestitution = 0.85\n[[device]]\nkind = 'none'\n[[ground]]\n{motion}\n\
                 [run]\nfree_time_s = 10.0"
            );
            sprag_tests::scene_text::runs(&text).remove(0)
        };
        for (index, motion) in [
            (0, "motion = 'sine'\nfrequency_ratio = 2.0\namplitude_ratio = 1.5"),
            (4, "motion = 'sine'\nfrequency_ratio = 4.0\namplitude_ratio = 3.0"),
            (6, "motion = 'ricker'\nfrequency_hz = 1.0\namplitude_g = 0.5"),
        ] {
            let (run, response) = (run(motion), solution.bare.responses[index].as_ref().unwrap());
            assert_eq!((response.outcome, response.peak_rotation), (run.outcome, run.peak_rotation), "{motion}");
        }
    });
}

#[test]
fn settings_are_laws_of_their_own() {
    let slipping =
        ", 'device.2' = { kind = 'clutched-pair', name = 'slipping', mass_ratio = 0.3, clutch = { capacity_ratio = 0.1 } }";
    let keys = "laws = ['slipping', 'inerter']\nsetting = [{ key = 'clutch.capacity_ratio', values = [0.05, 0.2] }, \
                { key = 'actuation.engagement_delay_s', values = [0.0, 0.01] }]";
    let folder = sine_pulses(&[0.4], &[0.5, 1.0]);
    answered(&study(slipping, keys, Some(folder.path())), |problem, _, findings| {
        let names: Vec<&str> = problem.choices.curves.iter().map(|curve| curve.law.as_str()).collect();
        assert_eq!((names.len(), names[4]), (5, "inerter"));
        assert_eq!(names[1], "slipping [clutch.capacity_ratio = 0.05] [actuation.engagement_delay_s = 0.01]");
        // Plates slip at their capacity: of both flywheels at most twice that is felt.
        for (index, capacity) in [(0, 0.05), (2, 0.2)] {
            let of_law = findings.rows.iter().filter(|row| row.law == names[index]);
            let largest = of_law.map(|row| row.peak_force_ratio).fold(0.0, f64::max);
            assert!(largest > 0.5 * capacity && largest <= 2.0 * capacity * (1.0 + 1e-9), "{capacity}: {largest}");
        }
    });
}

#[test]
fn a_delay_budget_ends_where_the_advantage_does() {
    let folder = sine_pulses(&[0.3, 0.4, 0.5, 0.6, 0.7, 0.8], &[0.6, 0.8, 1.0, 1.2]);
    let keys = "laws = ['clutched-pair', 'inerter']\ndelays_s = [0.001, 2.0]";
    answered(&study("", keys, Some(folder.path())), |_, solution, findings| {
        let (best, budget) = (findings.best.as_ref().unwrap(), findings.delay_budget.as_ref().unwrap());
        assert_eq!(best.law, "clutched-pair");
        let late = &budget.late;
        assert_eq!((late[0].delay_s, late[0].probability), (0.0, best.probability));
        assert!(
            late.len() >= 3
                && late.windows(2).all(|pair| pair[0].delay_s < pair[1].delay_s)
                && late.len() == solution.late.len() + 1
        );
        // A clutch that is two seconds late is a block without a device, whose motion is over by then.
        assert!(!late.last().unwrap().better, "{late:?}");
        let kept = late.iter().take_while(|late| late.better).last().map(|late| late.delay_s);
        assert_eq!(kept, budget.largest_delay_s);
        assert_eq!(budget.lost_at_s, late.iter().find(|late| !late.better).map(|late| late.delay_s));
        if let (Some(kept), Some(lost)) = (kept, budget.lost_at_s) {
            assert!(kept < lost && lost - kept < 0.2, "bisected: {kept} {lost}");
        }
    });
}

/// A controller that never engages leaves the block alone; one in the loop is beside ideal laws, and its coils hold while the block stands.
#[test]
fn a_controller_is_a_law() {
    let folder = sine_pulses(&[0.3, 0.6], &[0.6, 1.0]);
    let coil = ", 'checks.coil' = { holding_power_w = 10.0 }";
    let keys = "laws = ['clutched-pair', 'controller:passive', 'controller:resisting-predicted']";
    answered(&study(coil, keys, Some(folder.path())), |problem, solution, findings| {
        let of = |law: &str| -> Vec<_> {
            let curve = problem.choices.curves.iter().position(|curve| curve.law == law).unwrap();
            solution.designs.iter().filter(|design| design.candidate.unwrap().curve == curve).collect()
        };
        for design in of("controller:passive") {
            for (response, bare) in design.responses.iter().zip(&solution.bare.responses) {
                let (response, bare) = (response.as_ref().unwrap(), bare.as_ref().unwrap());
                assert_eq!(response.outcome, bare.outcome);
                // Sensors on a falling block read what no rocking explains, and the safe state engages a clutch.
                if let (Some(one), Some(other)) = (response.peak_rotation, bare.peak_rotation) {
                    assert!((one - other).abs() < 1e-6 * other.max(1.0), "{one} {other}");
                    assert_eq!((response.force_ratio, response.coil_energy_j), (0.0, Some(0.0)));
                }
            }
        }
        let energy = |law: &str| of(law)[0].responses[0].as_ref().unwrap().coil_energy_j.unwrap();
        assert!(energy("controller:resisting-predicted") > energy("clutched-pair") && energy("clutched-pair") > 0.0);
        assert_eq!(findings.best_of_each.len(), 3);
    });
}
