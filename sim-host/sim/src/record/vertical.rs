//! Which records are vertical components, by their names and headers.

use super::{Format, Record, Warning};

/// Last words of the names of vertical components: PEER's UP, VER, V and DWN, Japanese UD, and Z.
const WORDS: [&str; 12] = ["UP", "UD", "UD1", "UD2", "V", "VER", "VERT", "VERTICAL", "DWN", "DOWN", "UPDOWN", "Z"];
/// Those that also end a longer word after a digit, as in `E06UP`.
const ENDS: [&str; 5] = ["UP", "UD", "VER", "VERT", "DWN"];
/// Those that end the name of a PEER file behind the three letters of a station, as in `HECVER.AT2`.
const ENDS_OF_STATIONS: [&str; 2] = ["VER", "DWN"];
/// Letters of a station in such a name.
const STATION_LETTERS: usize = 3;
/// Those that are endings of file names, as of K-NET.
const FILE_ENDINGS: [&str; 6] = ["UP", "UD", "UD1", "UD2", "VER", "VERT"];

impl Record {
    /// Adds [`Warning::VerticalComponent`] to the warnings if name or header say that the record is a vertical component: for
    /// records that shall be horizontal motions.
    #[must_use]
    pub fn as_horizontal(mut self) -> Record {
        if let Some(sign) = self.vertical_sign() {
            self.warnings.push(Warning::VerticalComponent { sign });
        }
        self
    }

    /// What says that this is a vertical component.
    fn vertical_sign(&self) -> Option<String> {
        if let Some(component) = &self.component {
            // The file has several, and its name is that of all.
            return words(component).any(|word| WORDS.contains(&word.as_str())).then(|| format!("component {component}"));
        }
        let file = self.name.split('#').next().unwrap_or_default();
        let file = file.rsplit(['/', '\\']).next().unwrap_or_default();
        let of_title = || self.header.title.split(';').find_map(|line| of_header(line, self.format == Format::PeerAt2));
        of_name(file).map(|word| format!("{word} in its name")).or_else(|| of_title().map(|word| format!("{word} in its header")))
    }
}

fn words(text: &str) -> impl Iterator<Item = String> {
    text.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_ascii_uppercase)
}

/// The word at the end of a file's name, with or without its ending, that names a vertical component.
fn of_name(file: &str) -> Option<String> {
    let (stem, ending) = file.rsplit_once('.').unwrap_or((file, ""));
    let ending = ending.to_ascii_uppercase();
    if FILE_ENDINGS.contains(&ending.as_str()) {
        return Some(ending);
    }
    // Endings upon endings: `CHY101-V.AT2.g3`.
    let peer = file.to_ascii_uppercase().contains(".AT2");
    let stem = stem.rsplit_once('.').filter(|(_, inner)| inner.eq_ignore_ascii_case("AT2")).map_or(stem, |(stem, _)| stem);
    let last = words(stem).last()?;
    let single = words(stem).count() == 1;
    let after_digit = |end: &&&str| last.strip_suffix(**end).is_some_and(|rest| rest.ends_with(|c: char| c.is_ascii_digit()));
    let of_station = |end: &&&str| {
        let station = last.strip_suffix(**end);
        station.is_some_and(|station| station.len() == STATION_LETTERS && station.chars().all(|c| c.is_ascii_alphabetic()))
    };
    let of_channel = || last.len() == 3 && last.ends_with('Z') && matches!(last.as_bytes()[1], b'H' | b'L' | b'N' | b'G');
    // A whole name such as `z.csv` or `v.txt` is anything.
    let whole = WORDS.contains(&last.as_str()) && !(single && last.len() == 1);
    let station = || ENDS_OF_STATIONS.iter().filter(|_| peer).find(of_station);
    let end = || ENDS.iter().find(after_digit).or_else(station).map(|end| (*end).to_owned());
    if whole { Some(last) } else { end().or_else(|| of_channel().then(|| last.clone())) }
}

/// The last part of a header line such as `Northridge-01, 1/17/1994, Rinaldi Receiving Sta, UP`; of a PEER file, where components stand
/// there, also a letter alone or before the agency: `TCU065, V (CWB)`.
fn of_header(line: &str, of_peer: bool) -> Option<String> {
    let (_, last) = line.rsplit_once(',')?;
    let whole = last.split('(').next().unwrap_or(last).trim();
    let word = words(last).next().filter(|word| WORDS.contains(&word.as_str()))?;
    (word.len() > 1 || (of_peer && whole.len() == 1)).then_some(word)
}

#[cfg(test)]
mod tests {
    use crate::record::{ReadOptions, Record, Warning};

    fn is_vertical(name: &str, text: &str) -> bool {
        let record = Record::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        record.as_horizontal().warnings.iter().any(|warning| matches!(warning, Warning::VerticalComponent { .. }))
    }

    const TABLE: &str = "time_s,acc_g\n0,0\n0.01,0.1\n0.02,0\n";

    #[test]
    fn names_of_vertical_components_are_recognised() {
        for name in [
            "RSN1063_NORTHR_RRS-UP.AT2",
            "folder/RSN1503_CHICHI_TCU065-V.AT2.g3",
            "PUL--UP.csv",
            "gil_v.csv",
            "NIG0180410231756.UD",
            "CI.PAS.HNZ.txt",
            "H-E06UP.csv",
            "kobe-vert.dat",
            "site12_z.csv",
            "G02DWN.csv",
            "LOMAP/G02DWN.AT2",
            "RSN1787_HECTOR_HECVER.AT2",
            "HECVER.AT2",
            "H-CPEDWN.at2",
        ] {
            assert!(is_vertical(name, TABLE), "{name}");
        }
        for name in [
            "RSN181_IMPVALL.H_H-E06230.AT2",
            "group.csv",
            "cloud.csv",
            "RIVER.txt",
            "RIVER.AT2",
            "DENVER.csv",
            "VANCOUVER.AT2",
            "CHY101-N.AT2",
            "v.csv",
            "Z/kobe.csv",
            "A-TMZ270.AT2",
            "cloud",
        ] {
            assert!(!is_vertical(name, TABLE), "{name}");
        }
    }

    #[test]
    fn headers_and_components_say_it_too() {
        let header = |component: &str| {
            format!("PEER\nNorthridge, 1/17/1994, Rinaldi, {component}\nACCELERATION IN UNITS OF G\nNPTS= 3, DT= .01\n0 .1 0\n")
        };
        assert!(
            is_vertical("1.AT2", &header("UP")) && is_vertical("1.AT2", &header("VERT")) && !is_vertical("1.AT2", &header("228"))
        );
        for component in ["V", "Z", "v", "V (CWB)", "DWN"] {
            assert!(is_vertical("1.AT2", &header(component)), "{component}");
        }
        for component in ["V Sta", "Z 090", "N", "Sta. V 12", "(V)"] {
            assert!(!is_vertical("1.AT2", &header(component)), "{component}");
        }
        // Elsewhere the last part may be anything.
        assert!(!is_vertical("1.csv", &format!("# Site 4, V\n{TABLE}")));
        let table = "t,acc_ew_g,acc_up_g\n0,0,0\n0.01,0.1,0.2\n0.02,0,0\n";
        let of = |component: &str| {
            let options = ReadOptions { component: Some(component.into()), ..ReadOptions::default() };
            Record::parse("all-UP.csv", table.as_bytes(), &options).unwrap().as_horizontal().warnings.len()
        };
        let plain = Record::parse("1.csv", TABLE.as_bytes(), &ReadOptions::default()).unwrap().warnings.len();
        assert_eq!(of("up"), of("ew") + 1, "{plain}");
    }
}
