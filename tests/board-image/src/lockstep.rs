//! The board in lockstep with a plant that somebody else simulates: sensors' counts in, coils' currents out, a control period at a time.
//!
//! Lines of text. The first one from the host has the words of the settings in the flash, hexadecimal. Then for each period the host says
//!
//! `TRAVEL AX AY AZ GX GY GZ AX AY AZ GX GY GZ LINK [reset]`
//!
//! the rack's travel, acceleration and rate of the block's sensor and of the ground's, in counts; what it sends over the link, hexadecimal
//! or `-`; and whether the watchdog resets the chip now. The bench answers
//!
//! `CURRENT CURRENT TICKS LINK [BLOCK GROUND COUNTER CONVERTED CONVERTED]`
//!
//! the currents at the end of the period, A; control ticks that ended in it; what came over the link; and what the last of these ticks read:
//! of each inertial sensor `-` or six counts with commas, the encoder's counter, and the converter's results for both coils.

use std::fmt::Write as _;
use std::io::{BufRead, Write};

use sprag_shared::settings::{COUNT, Settings};

use crate::bench::Stop;
use crate::image::Image;
use crate::peripheral::icm42688::Measured;
use crate::peripheral::rcc::Cause;
use crate::rig::Rig;
use crate::time::SECOND;

/// How many times faster than its registers say the line is: what is sent in a period is there in it.
pub const HASTE: u64 = 100_000;

/// Inputs of a period, as the host sends them.
struct Period {
    travel: i64,
    block: Measured,
    ground: Measured,
    link: Vec<u8>,
    reset: bool,
}

impl Period {
    fn of(line: &str) -> Option<Period> {
        let mut words = line.split_ascii_whitespace();
        let travel = words.next()?.parse().ok()?;
        let mut counts = [0; 12];
        for count in &mut counts {
            *count = words.next()?.parse().ok()?;
        }
        let [ax, ay, az, gx, gy, gz, bx, by, bz, hx, hy, hz] = counts;
        let link = bytes(words.next()?)?;
        let reset = words.next() == Some("reset");
        let block = Measured { acceleration: [ax, ay, az], rate: [gx, gy, gz] };
        let ground = Measured { acceleration: [bx, by, bz], rate: [hx, hy, hz] };
        Some(Period { travel, block, ground, link, reset })
    }
}

fn bytes(text: &str) -> Option<Vec<u8>> {
    if text == "-" {
        return Some(Vec::new());
    }
    (0..text.len()).step_by(2).map(|place| u8::from_str_radix(text.get(place..place + 2)?, 16).ok()).collect()
}

fn hexadecimal(bytes: &[u8]) -> String {
    if bytes.is_empty() {
        return "-".to_owned();
    }
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn settings(line: &str) -> Option<Settings> {
    let words: Vec<u32> = line.split_ascii_whitespace().map(|word| u32::from_str_radix(word, 16).ok()).collect::<Option<_>>()?;
    Settings::from_words(&<[u32; COUNT]>::try_from(words).ok()?).ok()
}

/// What a control tick read.
fn read(rig: &mut Rig) -> String {
    let chip = rig.bench.chip_mut();
    let delivered = chip.buses.each_mut().map(|bus| {
        let delivered = bus.sensor.delivered.take().filter(|_| bus.sensor.judged);
        delivered.map_or_else(
            || "-".to_owned(),
            |Measured { acceleration: [a, b, c], rate: [d, e, f] }| format!("{a},{b},{c},{d},{e},{f}"),
        )
    });
    let [first, second] = chip.converted;
    format!(" {} {} {} {first} {second}", delivered[0], delivered[1], chip.encoder.count())
}

/// Runs `image` until the host has nothing more to say.
///
/// # Errors
/// If the host does not keep to the protocol, or is gone while it is answered.
pub fn serve(image: &Image, input: impl BufRead, mut output: impl Write) -> Result<(), String> {
    let mut lines = input.lines().map_while(Result::ok);
    let settings = lines.next().as_deref().and_then(settings).ok_or("the first line has no settings")?;
    let period = (f64::from(settings.period()) * SECOND as f64).round() as u64;
    let mut rig = Rig::new(image, Some(&settings));
    rig.bench.chip_mut().line.haste = HASTE;
    let mut end = rig.bench.now();
    for line in lines {
        let given = Period::of(&line).ok_or_else(|| format!("not a period: {line}"))?;
        end += period;
        let now = rig.bench.now();
        let chip = rig.bench.chip_mut();
        chip.move_rack(given.travel);
        (chip.buses[0].sensor.measured, chip.buses[1].sensor.measured) = (given.block, given.ground);
        let clock = chip.rcc.peripheral_hz()[1];
        chip.line.send(&given.link, clock, now);
        if given.reset {
            rig.bench.reset(Cause::Watchdog);
        }
        let (mut ticks, mut seen) = (0, String::new());
        while rig.bench.now() < end {
            if rig.bench.run(end) == Stop::Tick {
                ticks += 1;
                seen = read(&mut rig);
            }
        }
        let chip = rig.bench.chip_mut();
        chip.advance_coils();
        let [first, second] = chip.coils.each_ref().map(|coil| coil.current);
        let link = hexadecimal(&chip.line.take(u64::MAX));
        writeln!(output, "{first} {second} {ticks} {link}{seen}")
            .and_then(|()| output.flush())
            .map_err(|error| format!("the host has gone: {error}"))?;
    }
    Ok(())
}
