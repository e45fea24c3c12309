//! Runs the image of the board on the host: `sprag-board-image ticks IMAGE.elf` says what a control tick costs, `sprag-board-image profile
//! IMAGE.elf` which part of the program it goes to, `sprag-board-image serve IMAGE.elf` is the board at the other end of its standard streams,
//! for `sprag hil --board-image`.

mod profile;

use std::io::{Read, Write};
use std::path::Path;
use std::process::ExitCode;
use std::rc::Rc;

use sprag_board_image::bench::TickCost;
use sprag_board_image::image::Image;
use sprag_board_image::lockstep;
use sprag_board_image::rig::{Rig, swing};
use sprag_board_image::time::microseconds;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::settings::Settings;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let result = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["ticks", image] => ticks(Path::new(image)),
        ["profile", image] => profile::print(Path::new(image), profile::folder),
        ["profile", image, "files"] => profile::print(Path::new(image), profile::file),
        ["profile", image, "lines"] => profile::print(Path::new(image), profile::line),
        ["serve", image] => serve(Path::new(image)),
        ["lockstep", image] => Image::load(Path::new(image))
            .map_err(|error| error.to_string())
            .and_then(|image| lockstep::serve(&image, std::io::stdin().lock(), std::io::stdout().lock())),
        _ => Err("usage: sprag-board-image ticks|serve|lockstep IMAGE.elf, or profile IMAGE.elf [files|lines]".to_owned()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::from(2)
        }
    }
}

/// Ticks of a phase that are measured.
const MEASURED: usize = 1000;

/// A board that is armed.
fn armed(path: &Path) -> Result<Rig, String> {
    let image = Image::load(path).map_err(|error| error.to_string())?;
    let mut rig = Rig::new(&image, Some(&Settings::default()));
    rig.boot();
    let state = rig.wait(4000, |state| state.phase == Phase::Armed);
    if state.phase == Phase::Armed {
        Ok(rig)
    } else {
        Err(format!("the board does not arm: {:?} {:?}", state.phase, state.fault))
    }
}

/// Has its block rock.
fn rock(rig: &mut Rig) {
    rig.structure = Rc::new(swing(rig.bench.now()));
    rig.ticks(200);
}

/// Prints what a control tick costs at rest and in motion.
fn ticks(path: &Path) -> Result<(), String> {
    let mut rig = armed(path)?;
    println!("phase,median_instructions,worst_instructions,median_cycles,worst_cycles");
    for phase in ["armed", "rocking"] {
        if phase == "rocking" {
            rock(&mut rig);
        }
        rig.costs.clear();
        rig.ticks(MEASURED);
        let of = |quantity: fn(&TickCost) -> u64| {
            let mut numbers: Vec<u64> = rig.costs.iter().map(quantity).collect();
            numbers.sort_unstable();
            (numbers[numbers.len() / 2], numbers[numbers.len() - 1])
        };
        let (instructions, cycles) = (of(|cost| cost.instructions), of(|cost| cost.cycles));
        println!("{phase},{},{},{},{}", instructions.0, instructions.1, cycles.0, cycles.1);
    }
    Ok(())
}

/// Exchanges a chunk for a chunk at the end of every control period: two bytes that say how long it is, least significant first, and the
/// bytes of the link.
fn serve(path: &Path) -> Result<(), String> {
    let image = Image::load(path).map_err(|error| error.to_string())?;
    let mut rig = Rig::new(&image, None);
    rig.bench.chip_mut().line.haste = lockstep::HASTE;
    let (mut input, mut output) = (std::io::stdin().lock(), std::io::stdout().lock());
    loop {
        rig.period();
        let bytes = rig.bench.chip_mut().line.take(u64::MAX);
        let mut chunk = (bytes.len() as u16).to_le_bytes().to_vec();
        chunk.extend(bytes);
        let mut count = [0; 2];
        let exchanged = output.write_all(&chunk).and_then(|()| output.flush()).and_then(|()| input.read_exact(&mut count));
        let mut bytes = vec![0; usize::from(u16::from_le_bytes(count))];
        // The host has gone.
        if exchanged.and_then(|()| input.read_exact(&mut bytes)).is_err() {
            return Ok(());
        }
        let (now, chip) = (rig.bench.now(), rig.bench.chip_mut());
        let clock = chip.rcc.peripheral_hz()[1];
        chip.line.send(&bytes, clock, now);
        // It wakes up here, and may run until the next tick.
        rig.settle(microseconds(100));
    }
}
