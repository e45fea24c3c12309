//! What the comparison with a rival comes to, in words.

use sprag_shared::math::exp;
use sprag_sim::effect::number::true_minus;

use super::findings::Row;
use super::notes::device;
use super::ranking::Rival;
use crate::statistics::{Band, Level, Paired};

/// Why there is no band.
const NO_BAND: &str = "one independent group of motions: no band can be given";

/// The name of a rival in a sentence.
pub(super) fn rival_name(row: &Row) -> String {
    if row.mount.is_none() { "no device".to_owned() } else { device(row) }
}

impl Rival {
    /// In a line: "better than no device: 13.8 % fewer of the motions overturn it [5.7 %, 21.8 %]".
    pub fn verdict(&self, level: Level) -> String {
        let name = rival_name(&self.row);
        let by = amount(self);
        let sure = self.log_rotation.filter(|rotation| rotation.is_sure(level));
        let rotations = sure
            .and_then(|rotation| Some((rotation.difference, rotation.band?)))
            .map(|(difference, band)| format!("where both rock and stand, its peak rotations are {}", change(difference, band)));
        match (self.sure, self.overturning.difference > 0.0, rotations) {
            (true, true, _) => format!("better than {name}: {by}"),
            (true, false, _) => format!("worse than {name}: {by}"),
            (false, _, None) => format!("not distinguishable from {name}: {by}"),
            (false, _, Some(rotations)) => format!("not distinguishable from {name} by overturning: {by}; {rotations}"),
        }
    }

    /// In a word or two.
    pub(super) fn short_verdict(&self) -> &'static str {
        match (self.sure, self.overturning.difference > 0.0) {
            (true, true) => "better",
            (true, false) => "worse",
            (false, _) => "not distinguishable",
        }
    }
}

fn amount(rival: &Rival) -> String {
    if rival.alike {
        return "under every motion both overturn or both stand".to_owned();
    }
    let Paired { difference, band, .. } = rival.overturning;
    let motions = match difference {
        0.0 => "as many motions overturn both".to_owned(),
        more if more < 0.0 => format!("{} more of the motions overturn it", points(-more)),
        fewer => format!("{} fewer of the motions overturn it", points(fewer)),
    };
    let Some(band) = band else { return format!("{motions} ({NO_BAND})") };
    let [low, high] = if difference < 0.0 { [-band.high, -band.low] } else { [band.low, band.high] };
    let doubt = if rival.sure || low <= 0.0 {
        String::new()
    } else {
        let Paired { groups_above, groups_below, chance, .. } = rival.overturning;
        let chance = points(chance);
        format!(
            " (better in {groups_above} groups and worse in {groups_below}, which has a probability of {chance} between equals)"
        )
    };
    format!("{motions} [{}, {}]{doubt}", points(low), points(high))
}

/// A share of the motions in percent, with a decimal.
pub(super) fn points(share: f64) -> String {
    // −0.0 would read as less than nothing.
    true_minus(&format!("{:.1} %", 100.0 * share + 0.0).replace("-0.0 %", "0.0 %"))
}

/// Rotations of the chosen device beside those of a rival, whose logarithms differ by `log`.
fn change(log: f64, band: Band) -> String {
    let relative = |log: f64| 100.0 * (1.0 - exp(-log));
    let [size, low, high] = [log, band.low, band.high].map(relative);
    true_minus(&if log > 0.0 {
        format!("{size:.0} % smaller [{low:.0} %, {high:.0} %]")
    } else {
        format!("{:.0} % larger [{:.0} %, {:.0} %]", -size, -high, -low)
    })
}

/// "0.62", the other device's rotations over the chosen one's turned round: what the chosen makes of them.
pub(super) fn rotation_ratio(rival: &Rival) -> String {
    rival.log_rotation.map_or_else(|| "-".to_owned(), |rotation| format!("{:.3}", exp(-rotation.difference)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optimise::design::Score;

    fn rival(difference: f64, half: f64, sure: bool, log: Option<f64>) -> Rival {
        let paired = |difference: f64, half: f64| Paired {
            pairs: 87,
            difference,
            band: Some(Band { low: difference - half, high: difference + half }),
            groups_above: 12,
            groups_below: 1,
            chance: 0.004,
        };
        Rival {
            row: Row::of_score(&Score::default()),
            overturning: paired(difference, half),
            alike: false,
            log_rotation: log.map(|log| paired(log, 0.1)),
            sure,
        }
    }

    #[test]
    fn verdicts_say_how_much_and_how_sure() {
        let of = |rival: Rival| rival.verdict(Level::COMMON);
        assert_eq!(
            of(rival(0.138, 0.08, true, None)),
            "better than no device: 13.8 % fewer of the motions overturn it [5.8 %, 21.8 %]"
        );
        assert_eq!(
            of(rival(-0.1, 0.02, true, None)),
            "worse than no device: 10.0 % more of the motions overturn it [8.0 %, 12.0 %]"
        );
        assert_eq!(
            of(rival(0.01, 0.02, false, Some(0.5))),
            "not distinguishable from no device by overturning: 1.0 % fewer of the motions overturn it [\u{2212}1.0 %, 3.0 %]; where both rock \
             and stand, its peak rotations are 39 % smaller [33 %, 45 %]"
        );
        assert_eq!(
            of(rival(0.1, 0.02, false, None)),
            "not distinguishable from no device: 10.0 % fewer of the motions overturn it [8.0 %, 12.0 %] (better in 12 groups and worse \
             in 1, which has a probability of 0.4 % between equals)"
        );
    }

    #[test]
    fn as_many_motions_are_not_the_same_motions() {
        let equal = rival(0.0, 0.0, false, Some(0.01));
        let words = "not distinguishable from no device: as many motions overturn both [0.0 %, 0.0 %]";
        assert_eq!(equal.verdict(Level::COMMON), words);
        let same = Rival { alike: true, ..equal };
        let words = "not distinguishable from no device: under every motion both overturn or both stand";
        assert_eq!(same.verdict(Level::COMMON), words);
    }

    #[test]
    fn one_group_of_motions_is_said_instead_of_a_band() {
        let mut one = rival(0.25, 0.0, false, None);
        one.overturning.band = None;
        let words = one.verdict(Level::COMMON);
        assert_eq!(
            words,
            "not distinguishable from no device: 25.0 % fewer of the motions overturn it (one independent group of motions: no band can \
             be given)"
        );
    }
}
