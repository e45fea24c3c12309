//! Sections 2.3 and 3: Equations 15 to 18, and Figures 5 to 7.

use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::PulsedBlock;
use sprag_shared::math;
use sprag_sim::simulation::DeviceRun;
use sprag_sim::simulation::energy::Shares;
use sprag_studies::similarity::compare::{Departure, Response};
use sprag_tests::relative;
use sprag_tests::shipped::{grid, responses, runs};

use super::say;
use super::spectra::{INERTER, NONE, PAIR, SPECTRA};

/// A slender block with an inerter is one without, of the frequency parameter p/√(1 + 3σ/4).
#[test]
fn an_inerter_lowers_the_frequency_parameter() {
    let lowered: f64 = 1.0 + 0.75 * 0.5;
    for pulse in ["sine", "cosine"] {
        let grid = grid("figure12.toml", &["block.geometry=\"slender\"", &format!("ground.0.motion=\"{pulse}\"")]);
        let (mut with, mut without) = (Vec::new(), Vec::new());
        for (column, row) in
            (0..grid.columns()).step_by(7).flat_map(|column| (0..grid.rows()).step_by(3).map(move |row| (column, row)))
        {
            let block = |device| grid.pulsed(device, column, row).expect("a value within range").expect("a pulse");
            with.push(block(INERTER));
            without.push(PulsedBlock { frequency_ratio: block(NONE).frequency_ratio * lowered.sqrt(), ..block(NONE) });
        }
        let run = |blocks: &[PulsedBlock]| run(blocks, Registers::Widest).expect("blocks that can be followed");
        let mut largest = 0.0_f64;
        for (with, without) in run(&with).iter().zip(&run(&without)) {
            assert_eq!(with.outcome, without.outcome);
            if with.peak_rotation > 0.0 {
                largest = largest
                    .max(relative(with.peak_rotation, without.peak_rotation))
                    .max(relative(with.peak_acceleration * lowered, without.peak_acceleration));
            }
        }
        say(
            "2.2",
            pulse,
            &format!("{} slender blocks with p/√(1 + 3σ/4): same outcomes, peaks within {largest:.0e}", with.len()),
        );
        assert!(largest < 1e-9);
    }
    // Eq. 16 at σ = 0.5, α = 20°.
    let lowering = |rotation: f64| {
        let cosine = math::cos((1.0 - rotation) * 20.0_f64.to_radians());
        1.0 / (1.0 + 0.75 * 0.5 * cosine * cosine).sqrt()
    };
    let at = [0.0, 1.0, 2.0, 3.0].map(lowering);
    say("2.3", "full", &format!("p_σ/p at θ/α = 0, 1, 2, 3: {at:.4?}"));
    assert!(at[1] < at[0] && at[1] < at[2] && at[2] < at[3]);
}

/// More stable in general, but not always.
#[test]
fn a_lower_frequency_parameter_is_more_stable_in_general() {
    for map in SPECTRA.iter() {
        let ratios = map.ratios(INERTER, NONE, |_| true);
        let fallen = map.share(|cell| cell.stands(NONE) && cell.overturns(INERTER));
        say(
            "2.4",
            &map.name,
            &format!(
                "inerter over none: rotation lower in {:.2} % of the cells, {fallen:.1} % of all overturn only with it",
                ratios.rotation.below(1.0)
            ),
        );
        assert!(ratios.rotation.below(1.0) > 99.0 && fallen > 0.5 && fallen < 2.0);
    }
}

fn energy(run: &DeviceRun) -> Shares {
    run.energy.as_ref().expect("a ledger").entries
}

/// Energy lost at impacts and with the flywheels, over that put in.
fn lost(run: &DeviceRun) -> (f64, f64) {
    let shares = energy(run);
    (shares.impact / shares.input, shares.brake / shares.input)
}

#[test]
fn figure_5() {
    let energy = "output.energy=true";
    let whole = runs("figure05.toml", &[energy, "run.free_time_ratio=60"]);
    for run in &whole {
        say(
            "2.5",
            &run.device,
            &format!(
                "peak |θ|/α {:.4}, max |θ̈|/(p²α) {:.3}; at rest after p t = {:.2}; {} switches",
                run.peak_rotation.unwrap_or(f64::NAN),
                run.peak_acceleration.unwrap_or(f64::NAN),
                run.end_time_s,
                run.clutch_switches
            ),
        );
    }
    let samples = &whole[PAIR].history.samples;
    assert!(samples.iter().all(|sample| sample.force_ratio[0] == 0.0 || sample.force_ratio[1] == 0.0), "one at a time");
    let mut engaged: Vec<u8> = samples.iter().map(|sample| sample.engaged).filter(|flywheel| *flywheel > 0).collect();
    engaged.dedup();
    say("2.5", "clutched pair", &format!("flywheels engage in turns, {} times in the samples", engaged.len()));
    assert!(engaged.len() > 10);
    assert!(whole[PAIR].end_time_s < 0.6 * whole[INERTER].end_time_s && whole[PAIR].end_time_s < 0.6 * whole[NONE].end_time_s);
    assert!(whole[PAIR].clutch_switches > 20);
    // π/2 + 2.5/p: a swing after the end of the pulse.
    for until in ["2.5", "5.0", "60"] {
        let runs = runs("figure05.toml", &[energy, &format!("run.free_time_ratio={until}")]);
        let lost = [NONE, INERTER, PAIR].map(|device| lost(&runs[device]));
        say(
            "2.6",
            &format!("{until}/p later"),
            &format!(
                "of the energy put in is lost at impacts, with flywheels: none {:.2?}, inerter {:.2?}, pair {:.2?}",
                lost[0], lost[1], lost[2]
            ),
        );
        let all = lost.map(|(impact, flywheel)| impact + flywheel);
        assert!(lost[INERTER].1 == 0.0 && lost[PAIR].1 > lost[PAIR].0);
        if until == "2.5" {
            assert!(all[PAIR] > 1.2 * all[INERTER] && all[PAIR] > 1.2 * all[NONE], "{all:?}");
        }
    }
}

/// Largest departure over the largest swing of the first block, while p t is in `span`.
fn departure(first: &Response, other: &Response, span: std::ops::Range<f64>) -> f64 {
    let within = |index: usize| span.contains(&(index as f64 * first.step));
    let pairs =
        || first.rotations.iter().zip(&other.rotations).enumerate().filter(|(index, _)| within(*index)).map(|(_, pair)| pair);
    let swing = pairs().map(|(first, _)| first.abs()).fold(0.0, f64::max);
    pairs().map(|(first, other)| (first - other).abs()).fold(0.0, f64::max) / swing
}

#[test]
fn figures_6_and_7() {
    let step = 0.01;
    // The scenes have no bare block; its mass ratio is that of no device.
    let bare = "device.0={ kind = \"none\" }";
    for (figure, scene, second) in [
        ("3.1", "figure06.toml", ["block.size_m=5", "block.slenderness_deg=5"]),
        ("3.2", "figure07.toml", ["block.size_m=5", "block.slenderness_deg=20"]),
    ] {
        let of = |changes: &[&str]| responses(scene, changes, step).1;
        let (first, other) = (of(&[]), of(&second));
        let (bare_first, bare_other) = (of(&[bare]), of(&[&second[..], &[bare]].concat()));
        let relative = |a: &Response, b: &Response| Departure::between(a, b).relative.expect("a motion");
        let (none, inerter, pair) =
            (relative(&bare_first[0], &bare_other[0]), relative(&first[0], &other[0]), relative(&first[1], &other[1]));
        say(figure, "largest", &format!("departure over the peak: none {none:.1e}, inerter {inerter:.1e}, pair {pair:.1e}"));
        if figure == "3.1" {
            assert!([none, inerter, pair].iter().all(|departure| *departure < 1e-9));
            continue;
        }
        assert!(inerter < 0.1 && pair > inerter);
        let mut parted = Vec::new();
        for span in [0.0..2.0, 2.0..4.0, 4.0..6.0, 6.0..8.0] {
            let of = |first: &Response, other: &Response| departure(first, other, span.clone());
            let all = [of(&bare_first[0], &bare_other[0]), of(&first[0], &other[0]), of(&first[1], &other[1])];
            say(
                "3.4",
                "over the swing",
                &format!(
                    "p t from {} to {}: none {:.3}, inerter {:.3}, pair {:.3}",
                    span.start, span.end, all[0], all[1], all[2]
                ),
            );
            parted.push(all);
        }
        assert!(parted[3][2] > 3.0 * parted[3][1] && parted[0][2] < 1.5 * parted[0][1], "{parted:?}");
    }
}
