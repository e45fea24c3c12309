//! Which part of the program the instructions of a control tick are from, by its debug information.

use std::collections::BTreeMap;
use std::path::Path;

use addr2line::Context;
use addr2line::gimli::{Dwarf, EndianSlice, Error, LittleEndian};
use object::{Object, ObjectSection};

use crate::{MEASURED, armed, rock};

/// Folders of the program's own sources, as they are called below its root.
const OWN: [&str; 3] = ["shared/src/", "firmware/src/", "firmware/drivers/src/"];

/// Instructions a tick of which a part is worth a row.
const LEAST: f64 = 0.5;

/// Prints the mean instructions of a tick, armed and rocking, by what `part` makes of a place in the sources.
pub fn print(path: &Path, part: fn(&str, u32) -> String) -> Result<(), String> {
    let mut rig = armed(path)?;
    let bytes = std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let places = places(&bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut rows: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    for phase in 0..2 {
        if phase == 1 {
            rock(&mut rig);
        }
        rig.bench.chip_mut().profile = Some(Default::default());
        rig.ticks(MEASURED);
        let profile = rig.bench.chip_mut().profile.take().unwrap_or_default();
        for ((address, size), times) in profile {
            for address in rig.bench.chip().instructions_of(address, size) {
                let row = rows.entry(owner(&places, address, part)).or_default();
                row[phase] += times as f64 / MEASURED as f64;
            }
        }
    }
    let mut rows: Vec<_> = rows.into_iter().collect();
    rows.sort_by(|(_, one), (_, other)| other[0].total_cmp(&one[0]));
    println!("part,armed,rocking");
    for (part, [armed, rocking]) in rows.iter().filter(|(_, costs)| costs.iter().any(|cost| *cost >= LEAST)) {
        println!("{part},{armed:.1},{rocking:.1}");
    }
    let sum = |phase: usize| rows.iter().map(|(_, costs)| costs[phase]).sum::<f64>();
    println!("sum,{:.1},{:.1}", sum(0), sum(1));
    Ok(())
}

/// The folder of a place, …
pub fn folder(file: &str, _line: u32) -> String {
    file.rsplit_once('/').map_or(file, |(folder, _)| folder).to_owned()
}

/// … its file, …
pub fn file(file: &str, _line: u32) -> String {
    file.to_owned()
}

/// … and its line.
pub fn line(file: &str, line: u32) -> String {
    format!("{file}:{line}")
}

type Places<'a> = Context<EndianSlice<'a, LittleEndian>>;

/// The debug information of an ELF file. Its sections are taken as they are: the linker has left the relocations that it has applied.
fn places(bytes: &[u8]) -> Result<Places<'_>, String> {
    let file = object::File::parse(bytes).map_err(|error| error.to_string())?;
    let section = |name: &str| file.section_by_name(name).and_then(|section| section.data().ok()).unwrap_or_default();
    let dwarf = Dwarf::load(|id| Ok::<_, Error>(EndianSlice::new(section(id.name()), LittleEndian)));
    dwarf.and_then(Context::from_dwarf).map_err(|error| error.to_string())
}

/// The innermost of the program's own places that an instruction is from, or what else is known of it.
fn owner(places: &Places<'_>, address: u32, part: fn(&str, u32) -> String) -> String {
    let Ok(mut frames) = places.find_frames(address.into()).skip_all_loads() else { return "unknown".to_owned() };
    let mut last = None;
    while let Ok(Some(frame)) = frames.next() {
        let Some(place) = frame.location else { continue };
        let (file, line) = (place.file.unwrap_or_default().replace("/./", "/"), place.line.unwrap_or(0));
        if let Some(start) = OWN.iter().filter_map(|folder| file.find(folder)).min() {
            return part(&file[start..], line);
        }
        last = Some(file);
    }
    let crates =
        |file: String| file.rsplit_once("/src/").map(|(before, _)| before.rsplit('/').next().unwrap_or(before).to_owned());
    last.and_then(crates).unwrap_or_else(|| "unknown".to_owned())
}
