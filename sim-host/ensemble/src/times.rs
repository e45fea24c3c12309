//! Impacts of blocks under pulses, and when they come to their ends: what an overturning map does without.

use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::rest::free_course::FreeCourse;
use sprag_shared::motion::rest::free_decay::HalfCycles;
use sprag_shared::motion::rest::free_decay::decay_sums::DecaySums;
use sprag_shared::motion::rest::leg_time::LegTime;
use sprag_shared::structure::{COUNTED_SPEED, REST_SPEED};

use crate::alone::CaseError;
use crate::blocks::Blocks;
use crate::model::Model;
use crate::plain::PlainBlock;
use crate::pulsed::PulsedBlock;
use crate::{Number, WIDTH, number};

/// Impacts and times of a block under a pulse; times in 1/p from the pulse's start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PulseTimes {
    /// Impacts that came in with more than [`COUNTED_SPEED`].
    pub impacts: u32,
    /// The first of them.
    pub first_impact: Option<f64>,
    /// Rest, overturning, or the end of the free time.
    pub end: f64,
}

/// What is known of each block besides its result, and for how long each moves freely after its pulse (1/p).
pub struct Timed<'a> {
    /// Free times.
    pub free_times: &'a [f64],
    /// Impacts and times; `None` for a block that the core is to follow.
    pub times: &'a mut [Option<PulseTimes>],
}

/// How a block has come to its end in the lanes.
#[derive(Clone, Copy, Debug)]
pub enum End {
    /// At rest until the pulse is over, since the last time of the watch.
    Rest,
    /// Overturned at this time.
    Overturned(f64),
    /// It rocks when the pulse is over at this time.
    PulseOver(f64),
}

/// The watch over the impacts of the blocks in the lanes.
pub struct Watch<'a, M: Model> {
    timed: Timed<'a>,
    impacts: Number,
    first_impact: Number,
    rested: [f64; WIDTH],
    legs: Option<Legs<M::Integral>>,
    swings: Option<Swings>,
}

/// The series of free legs of blocks with one coupling.
struct Legs<I> {
    coupling: f64,
    outward: LegTime<I>,
    /// Of a clutched pair.
    inward: Option<LegTime<I>>,
}

/// The series of free swings of blocks with one slenderness and coupling; of clutched pairs, with one restitution, their sums.
struct Swings {
    block: (f64, f64, f64),
    half_cycles: HalfCycles<f64>,
    sums: Option<DecaySums>,
}

impl Swings {
    fn of<const PAIR: bool>(block: &PulsedBlock) -> Result<Swings, CaseError> {
        let IdealSystem { released, engaged, .. } = block.structure()?.resolve::<f64>()?;
        let half_cycles = HalfCycles::of(&released, &engaged, !PAIR);
        let sums = if PAIR { DecaySums::of(&half_cycles, block.plain.restitution) } else { None };
        Ok(Swings { block: Swings::key::<PAIR>(block), half_cycles, sums })
    }

    /// What the series depend on.
    fn key<const PAIR: bool>(block: &PulsedBlock) -> (f64, f64, f64) {
        let PlainBlock { slenderness, coupling, restitution, .. } = block.plain;
        (slenderness, coupling, if PAIR { restitution } else { 0.0 })
    }
}

impl<'a, M: Model> Watch<'a, M> {
    pub(crate) fn new(timed: Timed<'a>) -> Watch<'a, M> {
        let none = number(f64::INFINITY);
        Watch { timed, impacts: number(0.0), first_impact: none, rested: [0.0; WIDTH], legs: None, swings: None }
    }

    /// A new block in `lane`.
    pub(crate) fn renew(&mut self, lane: usize) {
        (self.impacts.0[lane], self.first_impact.0[lane]) = (0.0, f64::INFINITY);
    }

    /// Counts the impacts that the blocks have come to at `time`.
    #[inline(always)]
    pub(crate) fn step(&mut self, blocks: &Blocks, time: Number) {
        self.impacts = self.impacts + blocks.counted.choose(number(1.0), number(0.0));
        self.first_impact = blocks.counted.choose(self.first_impact.smaller(time), self.first_impact);
    }

    /// The block in `lane` rests at `time` after so many more `impacts`.
    pub(crate) fn rests(&mut self, lane: usize, time: f64, impacts: u32) {
        self.impacts.0[lane] += f64::from(impacts);
        self.rested[lane] = time;
    }

    /// The block `index` does not rock under its pulse.
    pub(crate) fn stays(&mut self, index: usize, duration: f64) {
        self.timed.times[index] = Some(PulseTimes { end: duration, ..PulseTimes::default() });
    }

    /// The core is to follow the block `index`.
    pub(crate) fn leave(&mut self, index: usize) {
        self.timed.times[index] = None;
    }

    /// The block `index` has come to its end in `lane`.
    pub(crate) fn ends<const PAIR: bool>(
        &mut self,
        (index, block): (usize, &PulsedBlock),
        lane: usize,
        end: End,
        blocks: &Blocks,
    ) {
        let first_impact = Some(self.first_impact.0[lane]).filter(|time| time.is_finite());
        let times = PulseTimes { impacts: self.impacts.0[lane] as u32, first_impact, end: 0.0 };
        self.timed.times[index] = match end {
            End::Rest => Some(PulseTimes { end: self.rested[lane], ..times }),
            End::Overturned(time) => Some(PulseTimes { end: time, ..times }),
            End::PulseOver(time) => {
                let free =
                    self.free::<PAIR>(block, (blocks.rotation.0[lane], blocks.velocity.0[lane]), self.timed.free_times[index]);
                free.map(|free| PulseTimes {
                    impacts: times.impacts.saturating_add(free.impacts),
                    first_impact: first_impact.or(free.first_impact.map(|first| time + first)),
                    end: time + free.end,
                })
            }
        };
    }

    /// The free motion of `block` from |θ| = `rotation` with the outward `velocity`, for `free_time`; times from its start.
    fn free<const PAIR: bool>(
        &mut self,
        block: &PulsedBlock,
        (rotation, velocity): (f64, f64),
        free_time: f64,
    ) -> Option<PulseTimes> {
        let motion = block.free_motion::<M, PAIR>();
        let (slenderness, coupling) = (block.plain.slenderness, block.plain.coupling);
        if self.legs.as_ref().is_none_or(|legs| legs.coupling != coupling) {
            let (outward, inward) = (LegTime::of(motion.outward), PAIR.then(|| LegTime::of(motion.inward)));
            self.legs = Some(Legs { coupling, outward, inward });
        }
        let legs = self.legs.as_ref()?;
        let course = FreeCourse {
            motion,
            outward: &legs.outward,
            inward: legs.inward.as_ref().unwrap_or(&legs.outward),
            no_return: M::GEOMETRY.point_of_no_return(slenderness, 0.0),
            counted_speed: COUNTED_SPEED * slenderness,
            rest_speed: REST_SPEED * slenderness,
        };
        let swings = &mut self.swings;
        let followed = course.follow(rotation, velocity, free_time, |speed, time| {
            if swings.as_ref().is_none_or(|swings| swings.block != Swings::key::<PAIR>(block)) {
                *swings = Swings::of::<PAIR>(block).ok();
            }
            let Swings { half_cycles, sums, .. } = swings.as_ref()?;
            match sums {
                Some(sums) => sums.decay(half_cycles, speed, course.counted_speed, time),
                None => half_cycles.decay(speed, block.plain.restitution, course.counted_speed, time),
            }
        })?;
        Some(PulseTimes {
            impacts: followed.impacts,
            first_impact: followed.first_impact,
            end: followed.ended.unwrap_or(free_time),
        })
    }
}
