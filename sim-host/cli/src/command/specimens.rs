//! Specimens of a block whose impacts differ: a scene with one seed after the other (`sprag simulate --monte-carlo`).

use std::num::NonZeroUsize;
use std::ops::RangeInclusive;

use rayon::ThreadPool;
use rayon::prelude::*;
use serde::Serialize;
use sprag_report::progress::Progress;
use sprag_report::text_table::TextTable;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::simulation::scatter::Scatter;
use sprag_sim::simulation::simulate;
use sprag_studies::statistics::quantile;

/// The most specimens of a run.
const MOST_SPECIMENS: NonZeroUsize = NonZeroUsize::new(1_000_000_000).unwrap();

/// Specimens that a run may have.
pub const SPECIMENS: RangeInclusive<NonZeroUsize> = NonZeroUsize::MIN..=MOST_SPECIMENS;

/// How the specimens of a device scatter.
#[derive(Clone, Debug, Serialize)]
pub struct Scattered {
    device: String,
    #[serde(flatten)]
    scatter: Scatter,
}

impl Scattered {
    /// A line for the terminal.
    pub fn line(&self) -> String {
        let Scatter { specimens, overturned, peak_rotation_05, peak_rotation_median, peak_rotation_95 } = &self.scatter;
        let number = |value: &Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"));
        let peaks = [peak_rotation_05, peak_rotation_median, peak_rotation_95].map(number).join(" / ");
        format!("{}: {specimens} specimens, {overturned} overturned, peak θ/α {peaks} (5, 50, 95 %)", self.device)
    }
}

/// Outcomes and quantiles of specimens; those that overturn have no peak.
pub fn scatter(specimens: NonZeroUsize, peaks: &[f64]) -> Scatter {
    let at = |share: f64| quantile(peaks, share).filter(|value| value.is_finite());
    Scatter {
        specimens: specimens.get(),
        overturned: specimens.get() - peaks.len(),
        peak_rotation_05: at(0.05),
        peak_rotation_median: at(0.5),
        peak_rotation_95: at(0.95),
    }
}

/// Says that specimens of `scene` would differ.
///
/// # Errors
/// A scene whose impacts are all alike.
pub fn check(scene: &Scene) -> anyhow::Result<()> {
    if !scene.file.block.scatter().is_on() {
        anyhow::bail!("--monte-carlo: every specimen would be the same; block.restitution_scatter lets impacts differ");
    }
    Ok(())
}

/// Runs every device of `scene` with `count` seeds of its impacts, from that of the scene on, and returns the table of all and what those of
/// each device come to.
///
/// # Errors
/// Those of [`simulate`].
pub fn monte_carlo(
    pool: &ThreadPool,
    (scene, ground): (&Scene, &GroundMotions),
    count: NonZeroUsize,
    interrupt: &Interrupt,
) -> anyhow::Result<(TextTable, Vec<Scattered>)> {
    let first = scene.file.block.scatter();
    let progress = Progress::new("specimens");
    progress.begin((count.get() * scene.devices.len()) as u64);
    let mut table = TextTable::new(1, ["device", "seed", "outcome", "peak_rotation", "impacts"]);
    let mut scattered = Vec::new();
    for index in 0..scene.devices.len() {
        let alone = scene.only(index);
        let one = |number: u64| {
            let mut specimen = alone.clone();
            let seed = first.seed.wrapping_add(number);
            specimen.file.block.restitution_seed = Some(seed);
            let run = simulate(&specimen, ground, interrupt).map(|mut runs| runs.swap_remove(0));
            progress.step();
            // Not the run: with its history it would be kept until all are done.
            run.map(|run| (seed, run.outcome, run.peak_rotation, run.impacts))
        };
        let runs: Vec<_> = pool.install(|| (0..count.get() as u64).into_par_iter().map(one).collect::<Result<_, _>>())?;
        let device = scene.devices[index].name.clone();
        let mut peaks = Vec::new();
        for (seed, outcome, peak, impacts) in runs {
            peaks.extend(peak);
            let peak = peak.map(|peak| peak.to_string()).unwrap_or_default();
            table.row(vec![device.clone(), seed.to_string(), outcome.to_string(), peak, impacts.to_string()]);
        }
        scattered.push(Scattered { device, scatter: scatter(count, &peaks) });
    }
    progress.finish();
    Ok((table, scattered))
}
