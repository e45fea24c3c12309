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

#[test]
fn the_divider_of_the_coils_supply_is_the_one_that_the_firmware_converts_by() {
    let board = read("docs/hardware/schematic/board.py");
    let code = read("shared/src/device/conditions.rs");
    let kiloohms = |part: &str| after(&board.replace("K\")", "\")"), &[&format!("\"{part}\", p.resistor(\"")]);
    let divider = |marks: &[&str]| after(&code, marks);
    assert_eq!(kiloohms("R4"), divider(&["DIVIDER: f32 = ("]));
    assert_eq!(kiloohms("R5"), divider(&["DIVIDER: f32 = (", " + "]));
    assert_eq!(kiloohms("R5"), divider(&["DIVIDER: f32 = (", " / "]));
}

/// Where the firmware names pins, and the nets of the pins that follow there.
const NAMED: [(&str, &[&str]); 10] = [
    ("sensors::block(", &["BLOCK_SCK", "BLOCK_MISO", "BLOCK_MOSI", "BLOCK_CS"]),
    ("sensors::ground(", &["GROUND_SCK", "GROUND_MISO", "GROUND_MOSI", "GROUND_CS"]),
    ("encoder::Encoder::new(", &["ENCODER_A", "ENCODER_B"]),
    ("low: (", &["LOW1", "LOW2"]),
    ("high: (", &["HIGH1", "HIGH2"]),
    ("trip: ", &["BREAK"]),
    ("coils::Currents::new(", &["CURRENT1", "CURRENT2", "SUPPLY"]),
    ("line::DmaLine::at(", &["LINK_TX", "LINK_RX"]),
    ("let lamp = ", &["LIGHT"]),
    // Not the application's: the probe, the oscillator, and the jumper.
    ("", &["SWDIO", "SWCLK", "CRYSTAL_IN", "CRYSTAL_OUT", "COMMISSION"]),
];

/// Pins such as `a.pa5` in a text, as PA5.
fn pins(text: &str) -> impl Iterator<Item = String> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '.').filter_map(|word| {
        let (port, pin) = word.split_once(".p")?;
        (port.len() == 1 && pin.starts_with(port) && pin[1..].parse::<u8>().is_ok()).then(|| format!("P{}", pin.to_uppercase()))
    })
}

/// Pin and net of each line of the table of pins.
fn table() -> Vec<(String, String)> {
    let text = read("docs/hardware/schematic/pins.csv");
    let lines = text.lines().skip(1).map(|line| {
        let plain: String = line.split('"').step_by(2).collect::<Vec<_>>().join("x");
        let cells: Vec<&str> = plain.split(',').collect();
        (cells[0].to_owned(), cells[3].to_owned())
    });
    lines.collect()
}

#[test]
fn the_firmware_the_schematic_and_the_page_have_the_same_pins() {
    let table = table();
    let board = read("firmware/src/board/f405.rs");
    let mut seen = 0;
    for (mark, nets) in NAMED.iter().filter(|(mark, _)| !mark.is_empty()) {
        let rest = board.split_once(mark).unwrap_or_else(|| panic!("no {mark}")).1;
        let line = rest.split(';').next().unwrap_or_default();
        for (net, pin) in nets.iter().zip(pins(line)) {
            assert!(table.contains(&(pin.clone(), (*net).to_owned())), "{net} is at {pin} in the firmware");
            seen += 1;
        }
    }
    // The jumper is in the table before the firmware has it or after.
    assert_eq!(seen, 21);
    assert_eq!(table.len(), NAMED.iter().map(|(_, nets)| nets.len()).sum::<usize>());
    let mut all: Vec<String> = pins(&board).filter(|pin| pin != "PC13").collect();
    all.sort();
    all.dedup();
    assert_eq!(all.len(), seen, "{all:?}");
    let netlist = read("docs/hardware/schematic/netlist.csv");
    let page = read("docs/board.md");
    for (pin, net) in &table {
        let drawn = netlist.lines().any(|line| line.starts_with("U1,") && line.ends_with(&format!(",{pin},{net}")));
        assert!(drawn, "{pin} is not {net} in the netlist");
        let listed = page
            .lines()
            .filter(|line| line.starts_with("| P"))
            .any(|line| line.split('|').nth(1).unwrap_or_default().split(',').any(|listed| listed.trim() == pin));
        assert!(listed, "{pin} is not in docs/board.md");
    }
}
