//! A share of a run's rows.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Most shards of a run.
pub const MOST_SHARDS: u32 = 1_000_000;

/// One of the parts that a run is split into: neighbouring rows, as many in each as in any other, or one more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u32,
    of: u32,
}

impl Shard {
    /// The only shard: all rows.
    pub const WHOLE: Shard = Shard { index: 1, of: 1 };

    /// All shards of a run of `of`.
    pub fn all(of: u32) -> impl Iterator<Item = Shard> {
        (1..=of).map(move |index| Shard { index, of })
    }

    /// Its rows of `rows`, of which every `together` are never parted.
    pub fn rows(self, rows: usize, together: usize) -> Range<usize> {
        let groups = (rows / together.max(1)) as u128;
        let up_to = |index: u32| (groups * u128::from(index) / u128::from(self.of)) as usize * together;
        up_to(self.index - 1)..if self.index == self.of { rows } else { up_to(self.index) }
    }

    /// Name of a file of its rows, without an ending: `name` of the whole run, name-2-of-8 of a shard.
    pub fn file_stem(self, name: &str) -> String {
        if self == Shard::WHOLE { name.to_owned() } else { format!("{name}-{}-of-{}", self.index, self.of) }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}/{}", self.index, self.of)
    }
}

/// I/N, as the command line has it.
impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let refuse = || format!("must be I/N with I from 1 to N and N from 1 to {MOST_SHARDS}, such as 2/8");
        let (index, of) = text.split_once('/').ok_or_else(refuse)?;
        let number = |text: &str| text.parse::<u32>().map_err(|_| refuse());
        let shard = Shard { index: number(index)?, of: number(of)? };
        let known = (1..=MOST_SHARDS).contains(&shard.of) && (1..=shard.of).contains(&shard.index);
        known.then_some(shard).ok_or_else(refuse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_all_rows_once() {
        for (rows, together) in [(0, 1), (1, 1), (17, 1), (12_288, 1), (30, 3), (33, 3)] {
            for of in [1, 2, 3, 7, 40] {
                let mut next = 0;
                let mut lengths = Vec::new();
                for shard in Shard::all(of) {
                    let range = shard.rows(rows, together);
                    assert!(range.start == next && range.start % together == 0, "{rows} {shard}");
                    next = range.end;
                    lengths.push(range.len() / together);
                }
                assert_eq!(next, rows);
                assert!(lengths.iter().max().unwrap() - lengths.iter().min().unwrap() <= 1, "{rows} {of}: {lengths:?}");
            }
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        assert_eq!("3/4".parse::<Shard>().unwrap().to_string(), "3/4");
        assert_eq!("3/4".parse::<Shard>().unwrap().file_stem("map"), "map-3-of-4");
        assert_eq!("1/1".parse::<Shard>().unwrap(), Shard::WHOLE);
        for text in ["", "2", "0/4", "5/4", "1/0", "-1/2", "1/2/3", "a/b", "1/1000001"] {
            assert!(text.parse::<Shard>().unwrap_err().contains("I/N"), "{text}");
        }
    }
}
