//! Samples a motion for histories.

use sprag_shared::drivetrain::transmission::Account;
use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::device_snapshot::{DeviceOutput, Snapshot};
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::counted_swing::{CountedSwing, clutches};
use sprag_shared::structure::block::GRAVITY;

use super::drive::Segmented;
use crate::ground_motion::Segment;
use crate::history::Sample;

/// Samples at a regular interval, and on both sides of every event at which something may jump.
#[derive(Debug)]
pub struct Recorder<'a> {
    /// The samples so far.
    pub samples: Vec<Sample>,
    /// Times of impacts, s.
    pub impacts: Vec<f64>,
    /// Changes of [`Sample::engaged`] in swings that count.
    pub switches: u32,
    /// When the base first slid, s.
    pub first_slip: Option<f64>,
    slides: bool,
    /// Of the base, m.
    displacement: f64,
    force_scale: f64,
    stays_engaged: bool,
    carried: bool,
    /// What was last seen engaged on a block that stands, as [`Sample::engaged`]; 0 while it moves, and where its weight alone holds it.
    holding: u8,
    swing: CountedSwing,
    /// As [`Sample::engaged`], of what counts.
    engaged: u8,
    interval: f64,
    next: u64,
    origin: f64,
    segments: &'a [Segment],
    broken: bool,
    pending: Option<Sample>,
}

impl<'a> Recorder<'a> {
    /// Samples every `interval` s. `force_scale` makes a snapshot's force F/(mg) of the bare block; `stays_engaged` says that the
    /// device has no clutch.
    pub fn new(force_scale: f64, stays_engaged: bool, interval: f64, segments: &'a [Segment]) -> Self {
        Recorder {
            samples: Vec::new(),
            impacts: Vec::new(),
            switches: 0,
            first_slip: None,
            slides: false,
            displacement: 0.0,
            force_scale,
            stays_engaged,
            carried: false,
            holding: 0,
            swing: CountedSwing::default(),
            engaged: 0,
            interval,
            next: 0,
            origin: 0.0,
            segments,
            broken: true,
            pending: None,
        }
    }

    /// With the displacement of the base.
    pub fn sliding(self) -> Self {
        Recorder { slides: true, ..self }
    }

    /// Of a device on a support that moves otherwise than the ground, which works while the block stands.
    pub fn carried(self, carried: bool) -> Self {
        Recorder { carried, ..self }
    }

    /// Of a block whose swings count as `swing` says; all do otherwise.
    pub fn counting(self, swing: CountedSwing) -> Self {
        Recorder { swing, ..self }
    }

    /// Closes the history at `end` (s): what is pending is written, and a block at rest stays so until then.
    pub fn finish(&mut self, end: f64, at_rest: bool) {
        self.flush();
        // A flywheel that spins on has been seen up to there.
        if at_rest && !self.carried && self.samples.last().is_none_or(|last| last.time_s < end) {
            self.stand_to(end);
        }
    }

    /// The ground at any time, for a block that stands over several segments.
    fn ground_anywhere(&self, time: f64) -> f64 {
        let index = self.segments.partition_point(|s| s.start + s.duration < time);
        self.segments.get(index).map_or(0.0, |s| s.shape.acceleration(time - s.start) * GRAVITY)
    }

    /// At `time` from the origin, `local` from the start of the step.
    // Out of line, and without closures over arrays: whether those are called or not differs from program to program.
    #[inline(never)]
    fn sample<S: Real>(&self, time: f64, output: &dyn DeviceOutput<S>, local: S) -> Sample {
        let Snapshot { motion, ground, device: Account { force, engaged, .. }, .. } = output.snapshot(local);
        let scaled = |force: S| force.to_f64() * self.force_scale;
        Sample {
            time_s: time,
            ground_m_s2: ground[0].to_f64() * GRAVITY,
            rotation_rad: motion.rotation.to_f64(),
            velocity_rad_s: motion.velocity.to_f64(),
            acceleration_rad_s2: motion.acceleration.to_f64(),
            force_ratio: [scaled(force[0]), scaled(force[1])],
            engaged: clutches(engaged),
            displacement_m: if self.slides { output.displacement(local).to_f64() } else { 0.0 },
        }
    }

    fn standing(&self, time: f64) -> Sample {
        Sample {
            time_s: time,
            ground_m_s2: self.ground_anywhere(time),
            rotation_rad: 0.0,
            velocity_rad_s: 0.0,
            acceleration_rad_s2: 0.0,
            force_ratio: [0.0; 2],
            engaged: u8::from(self.stays_engaged) | self.holding,
            displacement_m: self.displacement,
        }
    }

    fn push(&mut self, mut sample: Sample) {
        // Where two pieces of ground motion meet, their own times may differ in the last bit.
        sample.time_s = self.samples.last().map_or(sample.time_s, |last| sample.time_s.max(last.time_s));
        let engaged = self.swing.engaged(self.engaged, sample.engaged);
        let last = self.samples.last();
        self.switches += u32::from(last.is_some() && engaged != self.engaged);
        self.engaged = engaged;
        if last != Some(&sample) {
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

    /// The same, and one at `time`.
    fn stand_to(&mut self, time: f64) {
        self.stand_until(time);
        let sample = self.standing(time);
        self.push(sample);
    }
}

impl<S: Real> Observer<S> for Recorder<'_> {
    // Out of line, as [`Recorder::sample`] is.
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.swing.reaches(interval.fastest().to_f64());
        let start = self.origin + interval.start.to_f64();
        // Summed as the core sums them, so that an arc ends on the very instant at which the next one starts.
        let at = |time: S| self.origin + (interval.start + time).to_f64();
        let (from, to) = (at(interval.from), at(interval.to));
        if self.broken {
            let sample = self.sample(from, output, interval.from);
            self.push(sample);
            self.broken = false;
            while self.grid() <= from {
                self.next += 1;
            }
        }
        while self.grid() < to {
            let time = self.grid();
            let sample = self.sample(time, output, S::of(time - start));
            self.push(sample);
            self.next += 1;
        }
        let last = self.sample(to, output, interval.to);
        self.displacement = last.displacement_m;
        self.pending = Some(last);
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let holds = self.holding != 0 || interval.engaged;
        if interval.to <= interval.from || !(self.carried || holds) {
            return;
        }
        if !self.carried && self.holding == 0 {
            // Its weight has held it until now.
            let from = self.origin + (interval.start + interval.from).to_f64();
            if self.pending.take_if(|rest| rest.time_s == from).is_none() {
                self.stand_to(from);
            }
            self.broken = true;
        }
        self.device_interval(output, interval);
        self.holding = self.pending.filter(|_| !self.carried).map_or(0, |last| last.engaged);
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.switches += 2 * tail.closings;
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        let at = self.origin + time.to_f64();
        self.flush();
        self.swing.begins(event, state);
        match event {
            Event::Uplift | Event::Rest if self.carried => self.broken = true,
            Event::Uplift => {
                // What clutches hold has been seen up to here.
                if self.holding == 0 {
                    self.stand_to(at);
                } else {
                    self.stand_until(at);
                }
                (self.holding, self.broken) = (0, true);
            }
            // Clutches hold it where it has fallen.
            Event::Rest if state.phase == Phase::Rocking => {
                self.holding = self.samples.last().map_or(0, |last| last.engaged);
                self.broken = true;
            }
            // Its weight holds it again, and they open.
            Event::Switch if self.holding != 0 && state.phase == Phase::Rest => {
                self.holding = 0;
                self.stand_to(at);
                self.broken = true;
            }
            Event::Rest => {
                self.pending = Some(self.standing(at));
                while self.grid() <= at {
                    self.next += 1;
                }
            }
            Event::Impact => {
                self.impacts.push(at);
                self.broken = true;
            }
            Event::Switch | Event::Coupling => self.broken = true,
            Event::Slip => {
                self.first_slip = self.first_slip.or(Some(at));
                self.stand_until(at);
                self.broken = true;
            }
            Event::Turn | Event::Overturned => {}
        }
    }
}

impl Segmented for Recorder<'_> {
    fn segment(&mut self, start: f64, segment: Option<&Segment>) {
        self.origin = start;
        // The ground may jump here.
        if segment.is_none() {
            self.flush();
            self.broken = true;
        }
    }
}

#[cfg(all(test, feature = "effects"))]
mod tests {
    use std::f64::consts::TAU;

    use sprag_shared::math;

    use super::super::runs_of;

    /// Slip that is viscous lets the flywheel spin on: its force on a block that stands dies away by the corner frequency.
    #[test]
    fn a_history_shows_the_force_of_a_flywheel_that_slips_while_the_block_stands() {
        let run = runs_of(
            "block = { size_m = 2.0, slenderness_deg = 10.0, restitution = 0.0 }
            device = [{ kind = 'inerter', mass_ratio = 0.5, inertance_corner_hz = 4.0 }]
            ground = [
                { motion = 'sine', amplitude_ratio = 1.5, frequency_ratio = 6.0 },
                { motion = 'sine', amplitude_ratio = 0.5, frequency_ratio = 6.0, start_s = 1.0 },
            ]
            run = { free_time_s = 0.0 }",
        )
        .remove(0);
        let standing = run.history.samples.iter().skip_while(|sample| Some(&sample.time_s) != run.history.impacts_s.last());
        let force: Vec<_> = standing.skip(1).map(|sample| (sample.time_s, sample.force_ratio[0])).collect();
        let [first, second] = [force[0], force[5]];
        assert!(first.1.abs() > 0.01, "{first:?}");
        let expected = math::exp(-TAU * 4.0 * (second.0 - first.0));
        assert!((second.1 / first.1 - expected).abs() < 1e-9, "{first:?} {second:?} {expected}");
        assert!(run.history.samples.iter().all(|sample| sample.engaged == 1));
        let [.., before, last] = &force[..] else { panic!("{force:?}") };
        assert!(last.0 > before.0 && last.1 != 0.0, "{before:?} {last:?}");
    }

    /// Releases that come late, so that the next flywheel is engaged before the last one is let go.
    #[test]
    fn both_flywheels_are_engaged_where_both_push_and_a_mirrored_motion_swaps_them() {
        let [one, other] = [3.0, -3.0].map(|amplitude| {
            runs_of(&format!(
                "block = {{ size_m = 2.0, slenderness_deg = 10.0, restitution = 0.85 }}
                device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid', actuation = {{ release_delay_s = 0.2 }} }}]
                ground = [{{ motion = 'sine', amplitude_ratio = {amplitude}, frequency_ratio = 9.0 }}]
                run = {{ free_time_s = 2.0 }}"
            ))
            .remove(0)
        });
        let samples = &one.history.samples;
        let both = |force: [f64; 2]| force[0] != 0.0 && force[1] != 0.0;
        assert!(samples.iter().filter(|sample| both(sample.force_ratio)).count() > 100);
        assert!(samples.iter().all(|sample| !both(sample.force_ratio) || sample.engaged == 3));
        let swapped = |engaged: u8| [0, 2, 1, 3][usize::from(engaged)];
        assert!(
            samples.iter().map(|sample| swapped(sample.engaged)).eq(other.history.samples.iter().map(|sample| sample.engaged))
        );
        assert_eq!(one.clutch_switches, other.clutch_switches);
        let codes: Vec<u8> = one.history.engagements().into_iter().map(|(.., engaged)| engaged).collect();
        assert!(codes.windows(3).any(|codes| matches!(codes, [1, 3, 2] | [2, 3, 1])), "{codes:?}");
    }
}
