//! The hardware pages are of the firmware that there is.

use super::{COIL, coil::number};
use std::{fs, path::Path};

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The number that follows the last of `marks`, each looked for after the one before it.
fn after(text: &str, marks: &[&str]) -> f64 {
    let rest = marks.iter().fold(text, |rest, mark| rest.split_once(mark).unwrap_or_else(|| panic!("no {mark}")).1);
    let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '.' && c != '_').unwrap_or(rest.len());
    number(&rest[..end].replace('_', "")).unwrap_or_else(|| panic!("no number: {}", &rest[..end]))
}

#[test]
fn the_simulated_driver_is_driven_as_the_firmware_drives_it() {
    let driver = read(&format!("{COIL}/driver.inc"));
    let settings = read("shared/src/settings/table.rs");
    let coil = read("shared/src/device/coil.rs");
    let board = read("firmware/src/board/f405/coils.rs");
    let param = |name: &str| after(&driver, &[&format!(".param {name}=")]);
    assert_eq!(param("modulation"), after(&board, &["MODULATION", "from_raw("]));
    assert_eq!(param("pull_in_time"), after(&settings, &["CoilPullInTime", "1.0, "]));
    assert_eq!(param("hold_share"), after(&settings, &["CoilHoldShare", "1.0, "]));
    assert_eq!(param("engaged_current"), after(&settings, &["CoilEngagedCurrent", "20.0, "]));
    assert_eq!(after(&driver, &[".param release_current={"]), after(&coil, &["RELEASE_SHARE: f32 = "]));
    // The amplifier reads 50 times 50 milliohms.
    assert_eq!(after(&driver, &["Bamp", "max("]), after(&coil, &["4096.0 / ("]));
    assert_eq!(after(&driver, &["Rsh node top "]), after(&coil, &["4096.0 / (", " * "]));
}
