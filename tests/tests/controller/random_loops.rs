//! Closed loops over random structures, devices and motions (those of the second program), with any law, estimator and sensors at any rate:
//! all of them come to an end.

use rayon::prelude::*;
use sprag_reference::generate::scene;
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::controller::{EstimatorName, LawName};
use sprag_tests::dice::Dice;

const SEED: u64 = 304;
const COUNT: u64 = 1_200;

fn one_of<T: Copy>(dice: &mut Dice, of: &[T]) -> T {
    of[dice.below(of.len())]
}

/// `[controller]` of a random loop.
fn controller(number: u64) -> String {
    let dice = &mut Dice::new(number + 1);
    let (law, estimator) = (one_of(dice, &LawName::ALL).name(), one_of(dice, &EstimatorName::ALL).name());
    let suite = one_of(dice, &["ideal", "adis16470", "icm-42688-p", "bmi088", "mpu-6050"]);
    let (rate, substeps, latency) =
        (one_of(dice, &[500, 1000, 2000, 4000]), one_of(dice, &[1, 4]), one_of(dice, &[0.0, 0.001, 0.02]));
    format!(
        "\n[controller]\nlaw = '{law}'\nestimator = '{estimator}'\nrate_hz = {rate}\nsubsteps = {substeps}\nlatency_s = {latency}\n\
         [controller.sensors]\nsuite = '{suite}'\nseed = {number}\n"
    )
}

/// Of loop `number`, what is wrong with it; none where its scene has no loop.
fn wrong(number: u64) -> Option<Result<(), String>> {
    let generated = scene(SEED, number);
    let folder = tempfile::tempdir().unwrap();
    generated.write_records(folder.path()).unwrap();
    let mut scene = Scene::parse(&format!("{}{}", generated.text, controller(number)), "scene").ok()?;
    scene.folder = folder.path().to_owned();
    let desk = LoopScene::new(scene).ok()?;
    let interrupt = Interrupt::default();
    let ended = desk.task(desk.pairs[0], number, &interrupt).answered::<()>();
    Some(match ended {
        Ok((.., looped)) if looped.extremes.peaks.rotation.is_finite() => Ok(()),
        Ok(_) => Err(format!("{number}: not finite")),
        Err(failure) => Err(format!("{number}: {failure}")),
    })
}

#[test]
fn random_loops_come_to_an_end() {
    let ended: Vec<Result<(), String>> = (0..COUNT).into_par_iter().filter_map(wrong).collect();
    let failures: Vec<&String> = ended.iter().filter_map(|ended| ended.as_ref().err()).collect();
    assert!(ended.len() as u64 > COUNT / 2 && failures.is_empty(), "{} loops; {failures:#?}", ended.len());
}
