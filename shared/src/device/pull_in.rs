//! When a clutch closes, by the current through its coil: the armature's motion induces a voltage against the supply, so the current of a pulse
//! rises, dips and rises again, and is least when the armature arrives.

/// Depth of a dip over the full current, and where that is not known, A: several counts of the converter.
const DEPTH: f32 = 0.02;
const LEAST_DEPTH: f32 = 0.004;

/// What a pulse has shown; the default is before one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dip {
    /// Largest current so far.
    peak: f32,
    /// Least since then, …
    least: f32,
    /// … and in which tick.
    at: u32,
    found: bool,
}

impl Dip {
    /// The `current` (A) at the end of the `tick`th of a pulse at full voltage, of a coil whose `full` current is this. In which tick the clutch
    /// has closed, once that shows.
    pub fn step(&mut self, tick: u32, current: f32, full: f32) -> Option<u32> {
        let depth = if DEPTH * full > LEAST_DEPTH { DEPTH * full } else { LEAST_DEPTH };
        if self.found {
            return None;
        }
        if current < self.least {
            (self.least, self.at) = (current, tick);
        } else if self.peak - self.least >= depth && current - self.least >= depth {
            self.found = true;
            return Some(self.at);
        }
        if current > self.peak {
            (self.peak, self.least, self.at) = (current, current, tick);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::coil::current as converted;

    /// Current, A, of a coil of 0.8 A and 5 ms whose armature moves from tick `begin` to tick `end` and takes a third of the voltage meanwhile.
    fn pulse(begin: u32, end: u32) -> impl FnMut(u32) -> f32 {
        let mut current = 0.0_f32;
        move |tick| {
            let against = if (begin..end).contains(&tick) { (tick - begin) as f32 / (end - begin) as f32 } else { 0.0 };
            current += 0.1 * (0.8 * (1.0 - 0.6 * against) - current);
            converted((current / converted(1)) as u16)
        }
    }

    fn closed(begin: u32, end: u32) -> Option<u32> {
        let (mut dip, mut pulse) = (Dip::default(), pulse(begin, end));
        (1..=80).find_map(|tick| dip.step(tick, pulse(tick), 0.8))
    }

    #[test]
    fn the_end_of_the_armatures_motion_is_found_to_a_tick() {
        for (begin, end) in [(12, 24), (16, 40), (20, 32), (24, 60)] {
            let found = closed(begin, end).unwrap();
            assert!(found.abs_diff(end) <= 1, "{begin} {end}: {found}");
        }
    }

    #[test]
    fn an_armature_that_does_not_move_makes_no_dip() {
        assert_eq!(closed(100, 101), None);
    }
}
