//! The day of the earthquake that a record is of, by what its file says.

use std::fmt;

use super::Record;

/// A day.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct EventDate {
    /// Year, of four digits.
    pub year: u16,
    /// Month, 1 to 12.
    pub month: u8,
    /// Day, 1 to 31.
    pub day: u8,
}

impl fmt::Display for EventDate {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

/// Years of two digits below this are of this century.
const FIRST_OF_LAST_CENTURY: u16 = 30;

impl Record {
    /// The day in the title of the file, as PEER files have it: month/day/year, the year of two or four digits. Records of one day are taken
    /// to be of one earthquake: `KOBE 01/16/95 2046` and `Kobe, 01/16/1995` are.
    pub fn event_date(&self) -> Option<EventDate> {
        self.header.title.split(|c: char| !c.is_ascii_digit() && c != '/').find_map(date)
    }
}

/// `word`, if it is a day.
fn date(word: &str) -> Option<EventDate> {
    let mut parts = word.split('/');
    let (month, day, year) = (parts.next()?, parts.next()?, parts.next()?);
    let date = EventDate { year: year.parse().ok()?, month: month.parse().ok()?, day: day.parse().ok()? };
    let full = match (year.len(), date.year) {
        (2, year) if year < FIRST_OF_LAST_CENTURY => year + 2000,
        (2, year) => year + 1900,
        (4, year) => year,
        _ => return None,
    };
    let is_day = parts.next().is_none() && (1..=12).contains(&date.month) && (1..=31).contains(&date.day);
    is_day.then_some(EventDate { year: full, ..date })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_of_every_era_have_their_day() {
        let of = |title: &str| title.split(|c: char| !c.is_ascii_digit() && c != '/').find_map(date).map(|day| day.to_string());
        for (title, expected) in [
            ("PEER NGA STRONG MOTION DATABASE RECORD; Kobe, 01/16/1995, Takatori, 000", Some("1995-01-16")),
            ("KOBE 01/16/95 2046, NISHI-AKASHI, 000 (CUE)", Some("1995-01-16")),
            ("NORTHRIDGE, 1/17/94 12:31, RINALDI RECEIVING STA, 228", Some("1994-01-17")),
            ("Parkfield-02, 9/28/2004; Parkfield 12/20", Some("2004-09-28")),
            ("Christchurch 2/22/11", Some("2011-02-22")),
            ("component N/E, 13/1/1999, 1/0/1999, 1/1/1/1999, 1/1/199", None),
            ("", None),
        ] {
            assert_eq!(of(title).as_deref(), expected, "{title}");
        }
    }
}
