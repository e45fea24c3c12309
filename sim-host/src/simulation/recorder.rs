//! Samples a motion for histories.

use sprag_shared::arc::{Arc, Motion};
use sprag_shared::block::GRAVITY;
use sprag_shared::clutch::{Clutch, Flywheel, flywheel};
use sprag_shared::equation::Equation;
use sprag_shared::observer::{Event, Observer, Stretch};
use sprag_shared::rocking::State;
use sprag_shared::scalar::Real;

use super::drive::GroundObserver;
use crate::ground_motion::Segment;
use crate::history::Sample;

/// Samples at a regular interval, and on both sides of every impact and clutch switch.
#[derive(Debug)]
pub struct Recorder<'a, S, E, C> {
    /// The samples so far.
    pub samples: Vec<Sample>,
    /// Times of impacts, s.
    pub impacts: Vec<f64>,
    /// Clutch switches.
    pub switches: u32,
    /// Largest |F|/(mg) at samples and at the ends of stretches.
    pub peak_force: f64,
    engaged: &'a E,
    force_scale: f64,
    interval: f64,
    next: u64,
    origin: f64,
    segment: Option<&'a Segment>,
    segments: &'a [Segment],
    broken: bool,
    pending: Option<Sample>,
    precision: core::marker::PhantomData<(S, C)>,
}

impl<'a, S: Real, E: Equation<S>, C: Clutch> Recorder<'a, S, E, C> {
    /// Samples every `interval` s. Forces are those of the equation `engaged`, which gives the terminals' acceleration
    /// per R; `force_scale` = σR/g makes it F/(mg).
    pub fn new(engaged: &'a E, force_scale: f64, interval: f64, segments: &'a [Segment]) -> Self {
        Recorder {
            samples: Vec::new(),
            impacts: Vec::new(),
            switches: 0,
            peak_force: 0.0,
            engaged,
            force_scale,
            interval,
            next: 0,
            origin: 0.0,
            segment: None,
            segments,
            broken: true,
            pending: None,
            precision: core::marker::PhantomData,
        }
    }

    /// Closes the history at `end` (s): what is pending is written, and a block at rest stays so until then.
    pub fn finish(&mut self, end: f64, at_rest: bool) {
        if at_rest {
            self.stand_until(end);
            let sample = self.standing(end);
            self.push(sample);
        } else {
            self.flush();
        }
    }

    fn ground(&self, time: f64) -> f64 {
        self.segment.map_or(0.0, |segment| segment.shape.acceleration(time - segment.start) * GRAVITY)
    }

    /// The ground at any time, for a block that stands over several segments.
    fn ground_anywhere(&self, time: f64) -> f64 {
        let index = self.segments.partition_point(|s| s.start + s.duration < time);
        self.segments.get(index).map_or(0.0, |s| s.shape.acceleration(time - s.start) * GRAVITY)
    }

    fn sample(&mut self, time: f64, motion: &Motion<S>, stretch: &Stretch<S>) -> Sample {
        let wheel = flywheel::<C>(stretch.engaged, stretch.direction);
        let mut force = 0.0;
        if C::INERTER && stretch.engaged {
            let side: S = stretch.side.unit();
            let terminal = self.engaged.terminal_acceleration(side, motion.rotation, motion.velocity, motion.acceleration);
            force = terminal.to_f64() * self.force_scale;
            self.peak_force = self.peak_force.max(force.abs());
        }
        Sample {
            time_s: time,
            ground_m_s2: self.ground(time),
            rotation_rad: motion.rotation.to_f64(),
            velocity_rad_s: motion.velocity.to_f64(),
            acceleration_rad_s2: motion.acceleration.to_f64(),
            force_ratio: match wheel {
                Flywheel::Second => [0.0, force],
                _ => [force, 0.0],
            },
            engaged: match wheel {
                Flywheel::Idle => 0,
                Flywheel::First => 1,
                Flywheel::Second => 2,
            },
        }
    }

    fn standing(&self, time: f64) -> Sample {
        let ground_m_s2 = self.ground_anywhere(time);
        let engaged = u8::from(C::INERTER && !C::FOLLOWS_SIGNS);
        Sample {
            time_s: time,
            ground_m_s2,
            rotation_rad: 0.0,
            velocity_rad_s: 0.0,
            acceleration_rad_s2: 0.0,
            force_ratio: [0.0; 2],
            engaged,
        }
    }

    fn push(&mut self, mut sample: Sample) {
        // Where two pieces of ground motion meet, their own times may differ in the last bit.
        sample.time_s = self.samples.last().map_or(sample.time_s, |last| sample.time_s.max(last.time_s));
        if self.samples.last() != Some(&sample) {
            self.samples.push(sample);
        }
    }

    fn flush(&mut self) {
        if let Some(sample) = self.pending.take() {
            self.push(sample);
        }
    }

    fn grid(&self) -> f64 {
        self.next as f64 * self.interval
    }

    /// Samples of a block at rest at the grid times before `time`.
    fn stand_until(&mut self, time: f64) {
        self.flush();
        while self.grid() < time {
            let sample = self.standing(self.grid());
            self.push(sample);
            self.next += 1;
        }
    }
}

impl<S: Real, E: Equation<S>, C: Clutch> Observer<S> for Recorder<'_, S, E, C> {
    fn stretch<A: Arc<S>>(&mut self, arc: &A, stretch: &Stretch<S>) {
        let start = self.origin + stretch.start.to_f64();
        // Summed as the core sums them, so that an arc ends on the very instant at which the next one starts.
        let at = |time: S| self.origin + (stretch.start + time).to_f64();
        let (from, to) = (at(stretch.from), at(stretch.to));
        if self.broken {
            let sample = self.sample(from, &stretch.first, stretch);
            self.push(sample);
            self.broken = false;
            while self.grid() <= from {
                self.next += 1;
            }
        }
        while self.grid() < to {
            let time = self.grid();
            let motion = arc.at(S::of(time - start));
            let sample = self.sample(time, &motion, stretch);
            self.push(sample);
            self.next += 1;
        }
        self.pending = Some(self.sample(to, &stretch.last, stretch));
    }

    fn event(&mut self, event: Event, time: S, _state: &State<S>) {
        let at = self.origin + time.to_f64();
        match event {
            Event::Uplift => {
                self.stand_until(at);
                let sample = self.standing(at);
                self.push(sample);
                self.broken = true;
            }
            Event::Rest => {
                self.flush();
                let sample = self.standing(at);
                self.push(sample);
                while self.grid() <= at {
                    self.next += 1;
                }
            }
            Event::Impact => {
                self.flush();
                self.impacts.push(at);
                self.broken = true;
            }
            Event::Switch => {
                self.flush();
                self.switches += 1;
                self.broken = true;
            }
            Event::Turn | Event::Overturned => self.flush(),
        }
    }
}

impl<'a, S: Real, E: Equation<S>, C: Clutch> GroundObserver<S> for Recorder<'a, S, E, C> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.origin = start;
        self.segment = segment.and_then(|segment| {
            let index = self.segments.partition_point(|s| s.start < segment.start);
            self.segments.get(index)
        });
        // The ground may jump here.
        if segment.is_none() {
            self.flush();
            self.broken = true;
        }
    }
}

/// A recorder and peaks, told of the same segments.
impl<S: Real, A: GroundObserver<S>, B: GroundObserver<S>> GroundObserver<S> for (A, B) {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.0.segment(start, segment);
        self.1.segment(start, segment);
    }
}
