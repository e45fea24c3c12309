//! Everyone who watches a run: the history, the peaks, the checks, and what the scene asks for beyond them.

use sprag_shared::math::scalar::Real;
use sprag_shared::math::sign::Sign;
use sprag_shared::motion::device_snapshot::{DeviceOutput, Snapshot};
use sprag_shared::motion::ideal::device_view::Watched;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::peaks::Peaks;

use super::asked::Asked;
use super::drive::Segmented;
use super::recorder::Recorder;
use crate::ground_motion::{Segment, SumSegment};

/// What a scene wants to know of a run.
#[derive(Debug)]
pub struct Watchers<'a, S> {
    /// The history.
    pub recorder: Recorder<'a>,
    /// Largest values.
    pub peaks: Peaks<S>,
    /// Forces and impulses where they are reported; all of the checks where the scene asks for them.
    pub checks: Option<Checks<S>>,
    /// What the scene asks for beyond them.
    pub asked: Asked<S>,
}

impl<S: Real> Observer<S> for Watchers<'_, S> {
    // Every loop calls this: inlined where there is but one, it would look cheaper there.
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.recorder.device_interval(output, interval);
        self.peaks.interval(output.motion(), interval);
        self.checks.device_interval(output, interval);
        self.asked.device_interval(output, interval);
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.recorder.device_at_rest(output, interval);
        self.checks.device_at_rest(output, interval);
        self.asked.device_at_rest(output, interval);
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        Observer::<S>::event(&mut self.recorder, event, time, state);
        self.peaks.event(event, time, state);
        self.checks.event(event, time, state);
        self.asked.event(event, time, state);
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.recorder.accumulation(tail);
        self.peaks.accumulation(tail);
        self.asked.accumulation(tail);
    }

    fn device_bounce(&mut self, side: Sign, time: S, snapshot: &dyn Fn() -> Snapshot<S>) {
        self.checks.device_bounce(side, time, snapshot);
    }
}

impl<S: Real> Segmented for Watchers<'_, S> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.recorder.segment(start, segment);
        self.peaks.segment(start, segment);
        if let Some(checks) = &mut self.checks {
            checks.origin = S::of(start);
        }
        self.asked.segment(start, segment);
    }
}

/// An ideal device as its watchers see it.
impl<S: Real, O: Observer<S> + Segmented> Segmented for Watched<'_, S, SumSegment<S>, O> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.segment = match segment {
            Some(segment) => segment.shape.to(),
            None => SumSegment::QUIET,
        };
        self.observer.segment(start, segment);
    }
}
