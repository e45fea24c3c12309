//! Errors, wrong outcomes and times of every way to follow the motions of a scene.

use std::ops::{Range, RangeInclusive};
use std::time::{Duration, Instant};

use sprag_report::long_run::in_order::{all_in_order, in_order};
use sprag_report::progress::Progress;
use sprag_shared::structure::error::ParameterError;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::accuracy::EventTreatment;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::scene::{Scene, SceneError};

use super::board::Board;
use super::probe::{Reading, read};
use super::row::{Row, mark_front};
use super::subject::Subject;
use super::variant::{Family, Method, Number, Setting, Variant, variants};

/// Instants at which histories are compared.
const INSTANTS: usize = 1000;

/// A run is timed until it has taken so long, and at least this often; the fastest counts.
const TIMED: (Duration, u32) = (Duration::from_millis(20), 3);

/// The smallest step (in 1/p) that cells are followed with: smaller ones would take most of the time.
const SMALLEST_STEP_OF_CELLS: f64 = 1e-3;

/// Cells that a thread follows without a look at Ctrl-C.
const CELLS_AT_ONCE: usize = 8;

/// The reference: the series, as tight as f64 allows.
const REFERENCE: Variant = Variant {
    family: Family { method: Method::Taylor, events: EventTreatment::Located, number: Number::F64Libm },
    setting: Setting::Tolerance(1e-17),
};

/// What [`Extent::cells`] may be.
pub const CELLS: RangeInclusive<u8> = 0..=64;

/// What [`Extent::smallest_step`] may be.
pub const SMALLEST_STEPS: RangeInclusive<f64> = 3e-5..=0.1;

/// What is studied.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Cells along each side of the grid of outcomes; 0 for none.
    pub cells: usize,
    /// Smallest step, in 1/p.
    pub smallest_step: f64,
}

/// One device of the scene: the reference of its motion, and of every cell.
struct Device {
    subject: Subject,
    reference: Reading,
    grid: Vec<(Subject, Reading)>,
}

/// Reasons why there are no results.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// A parameter that the core refuses.
    #[error("{0}")]
    Parameter(#[from] ParameterError),
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// Refuses a scene that no study can be made of.
///
/// # Errors
/// [`SceneError`] names the key of what is not ideal.
pub fn check(scene: &Scene) -> Result<(), SceneError> {
    let refused = |key: String| Err(scene.key(&key).conflict("accuracy is studied for ideal devices over horizontal ground"));
    scene.first_beyond_ideal().map_or(Ok(()), refused)
}

/// Runs the study of a scene that [`check`] allows. The times depend on the machine, all else only on the scene.
pub fn study(
    scene: &Scene,
    ground: &GroundMotions,
    extent: Extent,
    board: Option<&Board>,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Vec<Row>, StudyError> {
    let unless_interrupted = || if interrupt.is_set() { Err(StudyError::Interrupted) } else { Ok(()) };
    let device = |index: usize| -> Result<Device, StudyError> {
        let subject = Subject::of_scene(scene, ground, index)?;
        let reference = read(&subject, &REFERENCE, &[]);
        let exact = |cell: &Subject| unless_interrupted().map(|()| (cell.clone(), read(cell, &REFERENCE, &[])));
        let grid = all_in_order(&subject.grid(extent.cells), progress, exact)?;
        Ok(Device { subject, reference, grid })
    };
    let devices = (0..scene.devices.len()).map(device).collect::<Result<Vec<_>, _>>()?;
    let closed_form = devices.iter().all(|device| device.subject.has_closed_form());
    let variants = variants(closed_form, extent.smallest_step);
    let work: Vec<(usize, Variant)> =
        (0..devices.len()).flat_map(|device| variants.iter().map(move |&variant| (device, variant))).collect();
    let row = |&(index, variant): &(usize, Variant)| devices[index].row(index, variant, interrupt);
    // Those that are timed below.
    progress.begin(work.len() as u64);
    let mut rows = all_in_order(&work, progress, row)?;
    // One after the other, so that they do not take each other's time.
    for row in &mut rows {
        unless_interrupted()?;
        let device = &devices[row.device];
        row.nanoseconds = device.nanoseconds(&row.variant);
        let structure = &device.subject.structure;
        row.board = board.and_then(|board| board.cost(row.variant.family, structure.geometry, structure.device.kind));
        progress.step();
    }
    mark_front(&mut rows);
    Ok(rows)
}

impl Device {
    fn row(&self, index: usize, variant: Variant, interrupt: &Interrupt) -> Result<Row, StudyError> {
        let end = self.subject.end();
        let times: Vec<f64> = (1..INSTANTS).map(|instant| end * instant as f64 / INSTANTS as f64).collect();
        let found = read(&self.subject, &variant, &times);
        let outcome_right = found.outcome == self.reference.outcome;
        let stands = outcome_right && found.outcome.is_some_and(|outcome| !outcome.overturned());
        let counted = !self.grid.is_empty() && !matches!(variant.setting, Setting::Step(step) if step < SMALLEST_STEP_OF_CELLS);
        let wrong = counted.then(|| self.wrong(&variant, interrupt)).transpose()?;
        Ok(Row {
            device: index,
            variant,
            outcome_right,
            peak_error: stands.then(|| relative(found.peak, self.reference.peak)),
            history_error: stands.then(|| self.history_error(&found)),
            wrong_share: wrong.map(|wrong| wrong as f64 / self.grid.len() as f64),
            steps_per_second: found.steps as f64 / end,
            nanoseconds: 0.0,
            board: None,
            on_front: false,
        })
    }

    /// Cells of which `variant` gives another outcome.
    fn wrong(&self, variant: &Variant, interrupt: &Interrupt) -> Result<usize, StudyError> {
        let mut wrong = 0;
        let of = |cells: Range<usize>| -> Result<Option<usize>, StudyError> {
            let differs = |(cell, exact): &&(Subject, Reading)| read(cell, variant, &[]).outcome != exact.outcome;
            Ok((!interrupt.is_set()).then(|| self.grid[cells].iter().filter(differs).count()))
        };
        let whole = in_order(0..self.grid.len(), CELLS_AT_ONCE, of, |count| {
            wrong += count;
            Ok(())
        })?;
        if whole { Ok(wrong) } else { Err(StudyError::Interrupted) }
    }

    /// max |Δθ|/α at the instants that `found` has.
    fn history_error(&self, found: &Reading) -> f64 {
        let times: Vec<f64> = found.samples.iter().map(|sample| sample.0).collect();
        let exact = read(&self.subject, &REFERENCE, &times);
        found.samples.iter().zip(&exact.samples).fold(0.0, |largest, (own, exact)| (own.1 - exact.1).abs().max(largest))
    }

    /// Nanoseconds to a simulated second.
    fn nanoseconds(&self, variant: &Variant) -> f64 {
        let (mut best, mut runs) = (Duration::MAX, 0);
        let begun = Instant::now();
        while runs < TIMED.1 || begun.elapsed() < TIMED.0 {
            let start = Instant::now();
            std::hint::black_box(read(std::hint::black_box(&self.subject), variant, &[]));
            best = best.min(start.elapsed());
            runs += 1;
        }
        best.as_secs_f64() * 1e9 / self.subject.end()
    }
}

/// |found/exact − 1|; without a motion the absolute error.
fn relative(found: f64, exact: f64) -> f64 {
    if exact == 0.0 { found.abs() } else { (found / exact - 1.0).abs() }
}
