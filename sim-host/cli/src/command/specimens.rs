//! Specimens of one scene that differ by their seed (`--monte-carlo`): run in parallel, written as they come.

use std::num::NonZeroUsize;
use std::ops::{Range, RangeInclusive};

use rayon::ThreadPool;
use serde::Serialize;
use sprag_report::columns::{Column, Value};
use sprag_report::long_run::in_order::in_order;
use sprag_report::output::RowTaker;
use sprag_report::progress::Progress;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::simulation::scatter::Scatter;
use sprag_studies::statistics::quantile;

/// The most specimens of a run.
const MOST_SPECIMENS: NonZeroUsize = NonZeroUsize::new(1_000_000_000).unwrap();

/// Specimens that a run may have.
pub const SPECIMENS: RangeInclusive<NonZeroUsize> = NonZeroUsize::MIN..=MOST_SPECIMENS;

/// How the specimens of a device scatter.
#[derive(Clone, Debug, Serialize)]
pub struct Scattered {
    device: String,
    /// What they come to.
    #[serde(flatten)]
    pub scatter: Scatter,
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

/// A specimen that was run, with more of its row than outcome and peak.
pub struct Specimen<const MORE: usize> {
    /// Its seed.
    pub seed: u64,
    /// How it ended.
    pub outcome: Outcome,
    /// max |θ|/α, where it is known.
    pub peak: Option<f64>,
    /// Values of the further columns.
    pub more: [Value<'static>; MORE],
}

/// Columns of a table of specimens, of which `more` are the last.
pub fn columns<const MORE: usize>(more: [Column; MORE]) -> Vec<Column> {
    let first = [Column::text("device"), Column::count("seed"), Column::text("outcome")];
    first.into_iter().chain([Column::number("peak_rotation").or_nothing()]).chain(more).collect()
}

/// Runs `some` for the numbers from 0 up to `count`, `together` at a time, on the threads of `pool`, and takes what comes out in order.
///
/// # Errors
/// The first error of `some` or `take`.
pub fn in_turn<R: Send>(
    pool: &ThreadPool,
    (count, together): (usize, usize),
    some: impl Fn(Range<u64>) -> anyhow::Result<R> + Sync,
    take: impl FnMut(R) -> anyhow::Result<()> + Send,
) -> anyhow::Result<()> {
    let some = |Range { start, end }: Range<usize>| some(start as u64..end as u64).map(Some);
    pool.install(|| in_order(0..count, together, some, take)).map(drop)
}

/// Runs `some` for `count` specimens of each device, `together` at a time; it is given the index of the device, whose name is beside it, and
/// numbers of specimens. Gives their rows to `row` as they come. What the specimens of each device come to; those that overturn have no peak.
///
/// # Errors
/// The first error of `some` or `row`.
pub fn monte_carlo<const MORE: usize>(
    pool: &ThreadPool,
    devices: &[(usize, &str)],
    (count, together): (NonZeroUsize, usize),
    some: impl Fn(usize, Range<u64>) -> anyhow::Result<Vec<Specimen<MORE>>> + Sync,
    row: &mut RowTaker<'_>,
) -> anyhow::Result<Vec<Scattered>> {
    let progress = Progress::new("specimens");
    progress.begin((count.get() * devices.len()) as u64);
    let mut scattered = Vec::new();
    for &(index, device) in devices {
        let mut peaks = Vec::new();
        let run = |numbers| some(index, numbers).inspect(|specimens| progress.advance(specimens.len() as u64));
        in_turn(pool, (count.get(), together), run, |specimens| {
            for Specimen { seed, outcome, peak, more } in specimens {
                peaks.extend(peak.filter(|_| !outcome.overturned()));
                let outcome = outcome.to_string();
                let first = [device.into(), seed.into(), outcome.as_str().into(), peak.map_or(Value::Nothing, Value::Number)];
                row(&[&first[..], &more].concat())?;
            }
            Ok(())
        })?;
        let at = |share: f64| quantile(&peaks, share).filter(|value| value.is_finite());
        let scatter = Scatter {
            specimens: count.get(),
            overturned: count.get() - peaks.len(),
            peak_rotation_05: at(0.05),
            peak_rotation_median: at(0.5),
            peak_rotation_95: at(0.95),
        };
        scattered.push(Scattered { device: device.to_owned(), scatter });
    }
    Ok(scattered)
}
