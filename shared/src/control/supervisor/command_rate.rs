//! Commands that change more often than any motion asks for.

/// Changes of the command within a second that no motion needs: two a half-cycle, of a block of a few centimetres.
const MOST: u32 = 50;

/// Changes within the second under way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct CommandRate {
    changes: u32,
    began: u32,
}

impl CommandRate {
    /// The command has `changed` at `tick`, of which a second has so many. Whether this is one too many, said once a second.
    pub fn changed(&mut self, tick: u32, second: u32) -> bool {
        if tick.wrapping_sub(self.began) >= second {
            *self = CommandRate { changes: 0, began: tick };
        }
        self.changes = self.changes.saturating_add(1);
        self.changes == MOST + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_too_many_within_a_second_is_said_once_a_second() {
        let said = |every: u32| {
            let mut rate = CommandRate::default();
            let ticks = (0..10_000 / every).map(|number| (u32::MAX - 5000).wrapping_add(number * every));
            ticks.filter(|tick| rate.changed(*tick, 2000)).count()
        };
        assert_eq!((said(40), said(39), said(10)), (0, 4, 5));
    }
}
