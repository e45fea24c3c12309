//! Everyone who watches a run: the history, the peaks, and what the scene asks for beyond them.

use sprag_shared::checks::Checks;
use sprag_shared::clutch::Clutch;
use sprag_shared::equation::Equation;
use sprag_shared::ground::Linear;
use sprag_shared::ledger::{Entries, Ledger};
use sprag_shared::observer::{Event, Observer, Peaks, Stretch};
use sprag_shared::rocking::State;
use sprag_shared::scalar::Real;
use sprag_shared::snapshot::{DeviceArc, DeviceObserver};
use sprag_shared::watched::Watched;

use super::drive::Segmented;
use super::recorder::Recorder;
use crate::ground_motion::{Segment, ShapePiece};

/// What a scene wants to know of a run.
#[derive(Debug)]
pub struct Watchers<'a, S> {
    /// The history.
    pub recorder: Recorder<'a>,
    /// Largest values.
    pub peaks: Peaks<S>,
    /// The energy ledger, if the scene keeps one.
    pub energy: Option<EnergyHistory<S>>,
    /// Checks of the assumptions, if the scene asks for them.
    pub checks: Option<Checks<S>>,
}

/// A ledger, written down at a regular interval.
#[derive(Debug)]
pub struct EnergyHistory<S> {
    /// The ledger.
    pub ledger: Ledger<S>,
    /// Time (s) and entries, 1/s².
    pub samples: Vec<(f64, Entries<f64>)>,
    origin: f64,
    interval: f64,
}

impl<S: Real> EnergyHistory<S> {
    /// Writes `ledger` down at least every `interval` (s) in which the block moves.
    pub fn new(ledger: Ledger<S>, interval: f64) -> EnergyHistory<S> {
        EnergyHistory { ledger, samples: Vec::new(), origin: 0.0, interval }
    }

    /// Writes down the entries at `time` (s).
    pub fn write(&mut self, time: f64) {
        let entries = self.ledger.entries();
        self.samples.push((time, entries.each(Real::to_f64)));
    }
}

impl<S: Real> DeviceObserver<S> for EnergyHistory<S> {
    fn device_stretch(&mut self, arc: &dyn DeviceArc<S>, stretch: &Stretch<S>) {
        self.ledger.device_stretch(arc, stretch);
        let time = self.origin + (stretch.start + stretch.to).to_f64();
        if self.samples.last().is_none_or(|last| time >= last.0 + self.interval) {
            self.write(time);
        }
    }

    fn device_event(&mut self, event: Event, time: S, state: &State<S>) {
        let at = self.origin + time.to_f64();
        // Both sides of a jump.
        if event == Event::Impact || event == Event::Switch {
            self.write(at);
        }
        self.ledger.device_event(event, time, state);
        if event != Event::Turn {
            self.write(at);
        }
    }
}

impl<S: Real> DeviceObserver<S> for Watchers<'_, S> {
    fn device_stretch(&mut self, arc: &dyn DeviceArc<S>, stretch: &Stretch<S>) {
        self.recorder.device_stretch(arc, stretch);
        self.peaks.stretch(&arc, stretch);
        self.energy.device_stretch(arc, stretch);
        self.checks.device_stretch(arc, stretch);
    }

    fn device_event(&mut self, event: Event, time: S, state: &State<S>) {
        DeviceObserver::<S>::device_event(&mut self.recorder, event, time, state);
        self.peaks.event(event, time, state);
        self.energy.device_event(event, time, state);
        self.checks.device_event(event, time, state);
    }
}

impl<S: Real> Segmented for Watchers<'_, S> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.recorder.segment(start, segment);
        self.peaks.segment(start, segment);
        if let Some(energy) = &mut self.energy {
            energy.origin = start;
        }
        if let Some(checks) = &mut self.checks {
            checks.origin = S::of(start);
        }
    }
}

/// An ideal device as its watchers see it.
impl<S: Real, E: Equation<S>, C: Clutch, O: DeviceObserver<S> + Segmented> Segmented for Watched<S, E, C, ShapePiece<S>, O> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.piece = match segment {
            Some(segment) => ShapePiece::of(&segment.shape),
            None => ShapePiece::Linear(Linear::constant(S::ZERO)),
        };
        self.observer.segment(start, segment);
    }
}

impl<O: Segmented> Segmented for &mut O {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        (**self).segment(start, segment);
    }
}
