//! The choice of a device under a scatter, under pulses, over settings, with later clutches and with a controller in the loop.

use std::path::{Path, PathBuf};

use sprag_studies::cloud::study::Study;
use sprag_studies::optimise::choice_page::{choice_page, choice_picture, delay_picture};
use sprag_studies::optimise::findings::Findings;
use sprag_studies::optimise::problem::{Problem, Solution};
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

/// What `then` makes of the answer to `study`, all of whose runs end.
fn answered<R>(study: &Study, then: impl FnOnce(&Problem<'_>, &Solution, &Findings) -> R) -> R {
    super::optimise::answered(study, |problem, solution, findings| {
        assert!(solution.failures.is_empty(), "{:?}", solution.failures);
        then(problem, solution, findings)
    })
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
            let largest = of_law.filter_map(|row| row.peak_force_ratio).fold(0.0, f64::max);
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

/// What `then` makes of the answer to ideal laws under a sine of ω_g/p = 2 and these amplitudes over the uplift threshold.
fn under_sines<R>(amplitudes: &str, keys: &str, then: impl FnOnce(&Problem<'_>, &Findings) -> R) -> R {
    let sine = format!("[[optimise.pulse]]\nmotion = 'sine'\nfrequency_ratio = [2.0]\namplitude_ratio = {amplitudes}");
    answered(&study("", &format!("{keys}{sine}"), None), |problem, _, findings| then(problem, findings))
}

#[test]
fn notes_say_by_what_the_choice_was_made() {
    let note = |findings: &Findings, text: &str| findings.notes.iter().any(|note| note.contains(text));
    under_sines("[0.5]", "", |_, findings| {
        assert!(note(findings, "No motion rocks the bare block: nothing to choose by."), "{:?}", findings.notes);
        assert!(!note(findings, "by peak rotation"), "{:?}", findings.notes);
    });
    // Every device loses the block, and has no rotation to compare.
    under_sines("[20.0, 30.0]", "", |_, findings| {
        let best = findings.best.as_ref().unwrap();
        assert!(findings.rows.iter().all(|row| row.overturned == 2 && row.peak_force_ratio >= best.peak_force_ratio));
        assert!(note(findings, "overturn under 2 of 2 motions: the choice among them is by force."), "{:?}", findings.notes);
    });
    let robust = "robust = { samples = 3, restitution = 0.1, quantile = 1.0 }\n";
    under_sines("[2.0, 3.0, 4.0, 20.0]", robust, |problem, findings| {
        let best = findings.best.as_ref().unwrap();
        let alike = findings.rows.iter().filter(|row| row.score.objective == best.score.objective).count();
        let text = format!(
            "{alike} of the {} devices tried respect the limits and overturn under as many motions by the",
            findings.designs
        );
        assert!(alike > 1 && note(findings, &text), "{:?}", findings.notes);
        let page = choice_page(problem, findings).unwrap();
        assert!(page.contains("none overturns under fewer by the 100 % quantile over the specimens."), "{page}");
    });
}

/// A block that never stands has no stroke, and not one of 0.
#[test]
fn what_no_motion_shows_has_no_number() {
    let row = |page: &str, name: &str| -> String {
        page.lines().find(|line| line.contains(name)).unwrap().split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let keys = "largest_stroke_m = 0.1\nlargest_force_ratio = 9.0\n";
    under_sines("[20.0, 30.0]", keys, |problem, findings| {
        let page = choice_page(problem, findings).unwrap();
        assert!(row(&page, "stroke of the terminals").ends_with("| - | 0.1 | - |"), "{page}");
        assert!(!row(&page, "force on the support").ends_with("| - | 9 | - |"), "{page}");
    });
    under_sines("[20.0, 30.0]", &format!("{keys}force_of_overturned = false\n"), |problem, findings| {
        let page = choice_page(problem, findings).unwrap();
        assert!(row(&page, "force on the support").ends_with("| - | 9 | - |"), "{page}");
    });
}

/// Two amplitudes are two groups, one is none to draw from.
#[test]
fn one_group_of_motions_has_no_band() {
    under_sines("[2.0]", "laws = ['clutched-pair', 'rigid']\ndelays_s = [0.01]\n", |problem, findings| {
        let ranking = findings.ranking.as_ref().unwrap();
        assert_eq!((ranking.groups, &ranking.chosen_again[..], ranking.probability_left_out), (1, &[][..], None));
        assert!(ranking.rivals.iter().all(|rival| rival.overturning.band.is_none() && !rival.sure));
        let page = choice_page(problem, findings).unwrap();
        assert!(!page.contains("Chosen again") && page.contains("independent group of motions does not give"), "{page}");
        assert_eq!(choice_picture(problem, findings), Ok(None));
        assert!(delay_picture(problem, findings).unwrap().is_some());
    });
    under_sines("[2.0, 2.5]", "", |problem, findings| {
        let ranking = findings.ranking.as_ref().unwrap();
        assert!(!ranking.chosen_again.is_empty() && ranking.rivals.iter().all(|rival| rival.overturning.band.is_some()));
        assert!(choice_picture(problem, findings).unwrap().is_some());
    });
}

/// A device that has to catch a faster block asks for more: later clutches reach the limit while they still save motions.
#[test]
fn a_delay_budget_ends_where_a_limit_is_reached() {
    let keys = "laws = ['rigid']\nlargest_force_ratio = 0.4\ndelays_s = [0.05, 0.2]\n[[optimise.pulse]]\nmotion = 'sine'\n\
                frequency_ratio = [1.5, 2.0, 2.5, 3.0, 3.5, 4.0]\namplitude_ratio = [1.5, 2.0, 3.0, 4.0]";
    answered(&study("", keys, None), |_, solution, findings| {
        let budget = findings.delay_budget.as_ref().unwrap();
        let force = |delay: f64| {
            let late = solution.late.iter().find(|design| design.candidate.unwrap().delay_s == delay);
            late.unwrap().responses.iter().map(|response| response.as_ref().unwrap().force_ratio).fold(0.0, f64::max)
        };
        assert!(budget.late.iter().all(|late| late.better), "{:?}", budget.late);
        let (kept, lost) = (budget.largest_delay_s.unwrap(), budget.lost_at_s.unwrap());
        assert!(0.05 <= kept && kept < lost && lost - kept < 0.2 / 16.0, "bisected: {kept} {lost}");
        assert!(force(kept) <= 0.4 && force(lost) > 0.4, "{} {}", force(kept), force(lost));
        assert!(budget.words().ends_with(&format!("later, beyond the limits at {lost:.4} s")), "{}", budget.words());
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
