//! Random scenes of a block on a compliant foundation by two programs: Sprag, by Lagrange's equations, and the second program, by forces at the
//! corners of a free body.

use rayon::prelude::*;
use sprag_reference::foundation::{FoundationRun, run};
use sprag_reference::generate::foundation::scene;
use sprag_tests::scene_text::run_in;

/// Largest |Δθ|/α at common samples, up to a fall that nothing brings back.
fn apart(ours: &FoundationRun, theirs: &FoundationRun, alpha: f64) -> f64 {
    let pairs = ours.samples.iter().zip(&theirs.samples);
    pairs.take_while(|([_, own], _)| own.abs() < 1.2 * alpha).fold(0.0, |most, ([time, own], [at, other])| {
        assert!((time - at).abs() < 1e-9, "{time} {at}");
        most.max((own - other).abs() / alpha)
    })
}

fn sprag(text: &str, folder: &std::path::Path) -> Result<FoundationRun, String> {
    let run = run_in(text, folder)?;
    let mut samples: Vec<[f64; 2]> = run.history.samples.iter().map(|sample| [sample.time_s, sample.rotation_rad]).collect();
    samples.retain(|[time, _]| (time / 0.01 - (time / 0.01).round()).abs() < 1e-6);
    samples.dedup_by(|later, sooner| later[0] - sooner[0] < 1e-9);
    Ok(FoundationRun { outcome: run.outcome.name(), impacts: run.impacts as usize, samples })
}

#[test]
fn two_programs_agree_on_blocks_on_feet() {
    let count = std::env::var("COUNT").ok().and_then(|text| text.parse().ok()).unwrap_or(120_u64);
    let seed = std::env::var("SEED").ok().and_then(|text| text.parse().ok()).unwrap_or(11_u64);
    let check = |number: u64| {
        let generated = scene(seed, number);
        let folder = tempfile::tempdir().unwrap();
        generated.write_records(folder.path()).unwrap();
        let parsed = sprag_reference::scene::Scene::parse(&generated.text).unwrap();
        let alpha = parsed.block.slenderness_deg.to_radians();
        let ours = run(&parsed, folder.path(), 2e-3)?;
        let theirs = sprag(&generated.text, folder.path())?;
        let close = |one: &FoundationRun, other: &FoundationRun, bound: f64| {
            let found = apart(one, other, alpha);
            (found, found <= bound && one.outcome == other.outcome && one.impacts == other.impacts)
        };
        let (found, agrees) = close(&ours, &theirs, 1e-6);
        // Rounding decides a motion that this program does not find again at half its step.
        let chaotic = !agrees && !close(&ours, &run(&parsed.nudged(), folder.path(), 1e-3)?, 1e-7).1;
        Ok::<_, String>((generated.family, found, agrees, chaotic, ours, theirs))
    };
    let all: Vec<_> = (0..count).into_par_iter().map(|number| (number, check(number))).collect();
    let (mut agree, mut chaotic, mut wrong, mut largest, mut rocked, mut fell) = (0, 0, Vec::new(), 0.0_f64, 0, 0);
    for (number, result) in &all {
        match result {
            Ok((_, found, true, _, ours, _)) => {
                agree += 1;
                largest = largest.max(*found);
                rocked += usize::from(ours.outcome == "safe" && ours.impacts > 0);
                fell += usize::from(ours.outcome.starts_with("overturned"));
            }
            Ok((_, _, _, true, ..)) => chaotic += 1,
            Ok((family, found, _, _, ours, theirs)) => wrong.push(format!(
                "{number}, {family}: {found:.1e} {} {} {} {}",
                ours.outcome, theirs.outcome, ours.impacts, theirs.impacts
            )),
            Err(error) => wrong.push(format!("{number}: {error}")),
        }
    }
    println!(
        "{count} scenes of seed {seed}: {agree} agree, {chaotic} chaotic, {} differ; {rocked} rock and stand, {fell} overturn; largest \
         difference {largest:.1e} α",
        wrong.len()
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(chaotic as u64 <= count / 20 && rocked > 10 && fell > 5);
}
