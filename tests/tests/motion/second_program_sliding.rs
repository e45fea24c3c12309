//! Random scenes of a block whose base may slide by two programs: Sprag and the second program, which treats it as a free body under forces at
//! its corners.

use rayon::prelude::*;
use sprag_reference::generate::sliding::scene;
use sprag_reference::sliding::{SlidingRun, run};
use sprag_tests::scene_text::run_in;

/// Differences of θ over α and of x over R, and whether outcome and impacts are the same.
#[derive(Clone, Copy, Debug)]
struct Apart {
    rotation: f64,
    displacement: f64,
    same: bool,
}

impl Apart {
    fn within(&self, bound: f64) -> bool {
        self.same && self.rotation <= bound && self.displacement <= bound
    }
}

/// Samples of either program at the same times, up to a fall that nothing brings back.
fn apart(ours: &SlidingRun, theirs: &SlidingRun, [alpha, size]: [f64; 2]) -> Apart {
    let mut apart = Apart { rotation: 0.0, displacement: 0.0, same: ours.outcome == theirs.outcome };
    let mut row = 0;
    for [time, rotation, displacement] in &ours.samples {
        while row < theirs.samples.len() && theirs.samples[row][0] < time - 1e-9 {
            row += 1;
        }
        let falls = ours.outcome != "safe" && ours.outcome != "no-rocking" && rotation.abs() > 1.2 * alpha;
        if let Some([at, other, moved]) = theirs.samples.get(row)
            && (at - time).abs() < 1e-9
            && !falls
        {
            apart.rotation = apart.rotation.max((other - rotation).abs() / alpha);
            apart.displacement = apart.displacement.max((moved - displacement).abs() / size);
        }
    }
    apart
}

/// Sprag's answer in steps of its own, or of `step_ratio` (1/p).
fn sprag(text: &str, folder: &std::path::Path, step_ratio: Option<f64>) -> Result<SlidingRun, String> {
    let steps =
        step_ratio.map(|ratio| format!("\n[accuracy]\nmethod = \"runge-kutta-4\"\nstep_ratio = {ratio}\n")).unwrap_or_default();
    let run = run_in(&(text.to_owned() + &steps), folder)?;
    let samples = run.history.samples.iter().map(|sample| [sample.time_s, sample.rotation_rad, sample.displacement_m]);
    let sliding = run.sliding.ok_or("no report of the base")?;
    Ok(SlidingRun {
        outcome: run.outcome.name(),
        impacts: run.impacts as usize,
        samples: samples.collect(),
        farthest: sliding.peak_slide_m.unwrap_or_default(),
    })
}

#[test]
fn two_programs_agree_on_blocks_that_slide() {
    let count = std::env::var("COUNT").ok().and_then(|text| text.parse().ok()).unwrap_or(300_u64);
    let seed = std::env::var("SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(6_u64);
    let check = |number: u64| {
        let generated = scene(seed, number);
        let folder = tempfile::tempdir().unwrap();
        generated.write_records(folder.path()).unwrap();
        let parsed = sprag_reference::scene::Scene::parse(&generated.text).unwrap();
        let scales = [parsed.block.slenderness_deg.to_radians(), parsed.block.size_m.unwrap()];
        let ours = run(&parsed, folder.path(), 2e-3)?;
        let theirs = sprag(&generated.text, folder.path(), None)?;
        let found = apart(&ours, &theirs, scales);
        // Fifty impacts that slip may make a million of the error of a step: a tenth of it settles what was wrong.
        let at_a_tenth =
            !found.within(1e-6) && apart(&ours, &sprag(&generated.text, folder.path(), Some(1e-4))?, scales).within(1e-6);
        // Such errors decide a motion that this program does not find again at half its step with a block less slender by 1e-12 of it.
        let chaotic = !found.within(1e-6) && !at_a_tenth && {
            let mut near = parsed.clone();
            near.block.slenderness_deg *= 1.0 - 1e-12;
            let finer = run(&near, folder.path(), 1e-3)?;
            !apart(&ours, &finer, scales).within(1e-7)
        };
        Ok::<_, String>((generated.family, found, [at_a_tenth, chaotic], ours, theirs))
    };
    let all: Vec<_> = (0..count).into_par_iter().map(|number| (number, check(number))).collect();
    let (mut agree, mut at_a_tenth, mut chaotic, mut wrong) = (0, 0, 0, Vec::new());
    let (mut largest, mut slid, mut rocked, mut both, mut lifted) = ([0.0_f64; 2], 0, 0, 0, 0);
    for (number, result) in &all {
        match result {
            Ok((_, found, _, ours, _)) if found.within(1e-6) => {
                agree += 1;
                largest = [largest[0].max(found.rotation), largest[1].max(found.displacement)];
                let (slides, rocks) = (ours.farthest > 1e-9, ours.outcome != "no-rocking");
                slid += usize::from(slides && !rocks);
                rocked += usize::from(rocks && !slides);
                both += usize::from(rocks && slides);
                lifted += usize::from(ours.outcome == "lifted-off");
            }
            Ok((_, _, [true, _], ..)) => at_a_tenth += 1,
            Ok((_, _, [_, true], ..)) => chaotic += 1,
            Ok((family, found, _, ours, theirs)) => {
                wrong.push(format!("{number}, {family}: {found:?} {} {} {}", ours.outcome, theirs.outcome, ours.impacts));
            }
            Err(error) => wrong.push(format!("{number}: {error}")),
        }
    }
    println!(
        "{count} scenes of seed {seed}: {agree} agree, {at_a_tenth} at a tenth of the step, {chaotic} chaotic, {} differ; slide only {slid}, rock only {rocked}, both {both} \
         (lift off {lifted}); largest difference {:.1e} α, {:.1e} R",
        wrong.len(),
        largest[0],
        largest[1]
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!((at_a_tenth + chaotic) as u64 <= count / 20 && slid > 10 && both > 10);
}
