//! Swings in which what clutches do counts: as with impacts, those of a dying motion are infinitely many, and the rest threshold decides how many
//! of them are followed.

use crate::math::scalar::Real;
use crate::motion::observer::Event;
use crate::motion::state::BlockState;
use crate::structure::COUNTED_SPEED;
use crate::structure::block::Block;

/// Which clutches are engaged, as a number: 0 none, 1 the first, 2 the second, 3 both.
pub fn clutches(engaged: [bool; 2]) -> u8 {
    u8::from(engaged[0]) + 2 * u8::from(engaged[1])
}

/// Whether the present swing counts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CountedSwing {
    /// θ̇ with which an impact counts, rad/s.
    speed: f64,
    weak: bool,
}

impl CountedSwing {
    /// Of `block` with what it carries.
    pub fn of(block: &Block) -> CountedSwing {
        CountedSwing { speed: COUNTED_SPEED * block.frequency_parameter() * block.slenderness(), weak: false }
    }

    /// The block moves as fast as `velocity` (rad/s, not negative).
    pub fn reaches(&mut self, velocity: f64) {
        self.weak &= velocity <= self.speed;
    }

    /// A swing that an impact leaves too slow does not count unless it gets faster.
    pub fn begins<S: Real>(&mut self, event: Event, state: &BlockState<S>) {
        match event {
            Event::Impact => self.weak = state.velocity.to_f64().abs() <= self.speed,
            Event::Uplift | Event::Rest => self.weak = false,
            Event::Turn | Event::Switch | Event::Coupling | Event::Slip | Event::Overturned => {}
        }
    }

    /// Whether it does not count.
    pub fn is_weak(&self) -> bool {
        self.weak
    }

    /// The flywheels (a bit each) that count as engaged from now on, where `before` did until now and `engaged` are: a swing that does not count
    /// only lets go.
    pub fn engaged(&self, before: u8, engaged: u8) -> u8 {
        if self.weak { before & engaged } else { engaged }
    }
}
