//! No panic in the firmware's control tick, and proof that the check would see one.

use crate::{
    firmware::{BOARD, BOARD_G474, Built, PANICKING},
    reach,
    stop::Stop,
};
use std::path::Path;

/// The functions from which no panic may be reached.
const ROOTS: &[&str] = &["control_tick"];

/// The functions that may call by an address in a register. The tick, most of which the linker's optimiser makes one function, calls what it calls
/// often so, and picks one of two patterns of the light: every address that it takes is an edge of the graph, so that what can be called
/// is looked at. It is given no address from outside.
const ALLOWED_INDIRECT: &[&str] = &["sprag_firmware::control::tick"];

/// The function that the feature `deliberate-panic` adds below a root.
const DELIBERATE: &str = "deliberate_panic";

/// Checks the firmware for each board, then one with a panic added.
///
/// # Errors
/// If a panic can be reached in one of the first, or none through the added function in the second.
pub fn run(root: &Path, built: &Built) -> Result<(), Stop> {
    for board in [&BOARD, &BOARD_G474] {
        reach::check(built.elf(board)?, ROOTS, ALLOWED_INDIRECT)?;
    }
    let found = reach::examine(&PANICKING.build(root)?, ROOTS, ALLOWED_INDIRECT)?;
    let seen = found.panics.iter().find(|way| way.iter().any(|name| name.rsplit("::").next() == Some(DELIBERATE)));
    match seen {
        Some(way) => println!("the deliberate panic is seen:\n  {}", way.join("\n  ")),
        None => {
            return Err(Stop::failed(format!("the panic check sees nothing of {DELIBERATE} in the image {}", PANICKING.name)));
        }
    }
    Ok(())
}
