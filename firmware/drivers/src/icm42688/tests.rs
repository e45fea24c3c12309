//! The driver on a model of the part: three banks of registers, a reset that takes a millisecond, a gyroscope that starts, a status that
//! reading clears.

use std::cell::RefCell;
use std::rc::Rc;
use std::vec::Vec;

use embedded_hal::spi::{ErrorKind, ErrorType, Operation};

use super::registers::Entry;
use super::*;

/// Ticks that a reset takes, and that the gyroscope takes to start, at 2 kHz.
const RESET_TAKES: u32 = 2;
const START_TAKES: u32 = 60;

/// Ticks from the beginning of a self-test to its response.
const RESPONSE_TAKES: u32 = 300;
/// What the factory has left of accelerometer and gyroscope, and what that stands for, counts.
const CODES: [[u8; 3]; 2] = [[50, 100, 150], [120, 130, 140]];
const RESPONSES: [f64; 6] = [1066.6, 1754.1, 2884.9, 4280.7, 4728.6, 5223.3];

const WORDS: [i16; 6] = [1, -2, 300, -400, 32_767, -32_767];
const READING: Reading = Reading { acceleration: [1, -2, 300], rate: [-400, 32_767, -32_767] };

#[derive(Debug)]
struct Part {
    banks: [[u8; 128]; 3],
    bank: usize,
    now: u32,
    /// No register answers before.
    ready: u32,
    resets: u32,
    /// Since when both sensors are on.
    on: Option<u32>,
    words: [i16; 6],
    status: u8,
    /// What the line is stuck at.
    stuck: Option<u8>,
    /// Transactions until the answer to one has a bit flipped.
    flip: Option<u32>,
    broken: bool,
    /// Since when SELF_TEST_CONFIG is as it is, and by which share of what the factory has found each axis answers.
    tested: u32,
    answers: [f64; 6],
}

#[derive(Clone, Debug)]
struct Line(Rc<RefCell<Part>>);

impl Part {
    fn on_a_line(identity: u8) -> Line {
        let mut part = Part {
            banks: [[0; 128]; 3],
            bank: 0,
            now: 0,
            ready: 0,
            resets: 0,
            on: None,
            words: WORDS,
            status: 0,
            stuck: None,
            flip: None,
            broken: false,
            tested: 0,
            answers: [1.0; 6],
        };
        part.restore();
        part.banks[0][0x75] = identity;
        Line(Rc::new(RefCell::new(part)))
    }

    /// What registers hold after a reset, DS-000347, section 13.
    fn restore(&mut self) {
        let identity = self.banks[0][0x75];
        self.banks = [[0; 128]; 3];
        for (bank, address, value) in [
            (0, 0x75, identity),
            (0, 0x4C, 0x30),
            (0, 0x4D, 0x91),
            (0, 0x4F, 0x06),
            (0, 0x50, 0x06),
            (0, 0x52, 0x11),
            (0, 0x64, 0x10),
            (0, 0x65, 0x10),
            (1, 0x0B, 0xA0),
            (1, 0x0C, 0x0D),
            (1, 0x0D, 0xAA),
            (1, 0x0E, 0x80),
            (2, 0x03, 0x18),
            (2, 0x04, 0x40),
            (2, 0x05, 0x62),
        ] {
            self.banks[bank][address] = value;
        }
        for (bank, address, codes) in [(2, 0x3B, CODES[0]), (1, 0x5F, CODES[1])] {
            self.banks[bank][address..address + 3].copy_from_slice(&codes);
        }
        (self.bank, self.on, self.status) = (0, None, 0);
    }

    fn write(&mut self, address: u8, value: u8) {
        match (self.bank, address) {
            (_, 0x76) => self.bank = usize::from(value),
            (0, 0x11) if value & 1 == 1 => {
                self.restore();
                (self.resets, self.ready) = (self.resets + 1, self.now + RESET_TAKES);
            }
            (bank, address) => {
                self.banks[bank][usize::from(address)] = value;
                if (bank, address) == (0, 0x70) {
                    self.tested = self.now;
                }
                if (bank, address) == (0, 0x4E) {
                    self.on = (value & 0x0F == 0x0F).then_some(self.now);
                }
            }
        }
    }

    /// From an address on.
    fn read(&mut self, address: u8, into: &mut [u8]) {
        for (address, into) in (address..).zip(into) {
            *into = self.banks[self.bank][usize::from(address)];
            if self.bank == 0 {
                if (0x1F..0x2B).contains(&address) {
                    let place = usize::from(address - 0x1F);
                    *into = self.word(place / 2).to_be_bytes()[place % 2];
                } else if address == 0x2D {
                    *into = core::mem::take(&mut self.status);
                }
            }
        }
    }

    /// Acceleration and rate, and what the self-test adds.
    fn word(&self, place: usize) -> i16 {
        let config = self.banks[0][0x70];
        // The accelerometer's axes answer with the supply of their test only.
        let on = if place < 3 { config >> 6 & config >> (3 + place) & 1 } else { config >> (place - 3) & 1 };
        // Full scale halves with each step of FS_SEL, and the response doubles.
        let range = if place < 3 { self.banks[0][0x50] >> 5 } else { self.banks[0][0x4F] >> 5 };
        let doubled = f64::from(1_u8 << range) / if place < 3 { 2.0 } else { 4.0 };
        let answers = on == 1 && self.now >= self.tested + if place < 3 { 40 } else { RESPONSE_TAKES };
        if !answers {
            return self.words[place];
        }
        let response = self.answers[place] * RESPONSES[place] * doubled;
        (f64::from(self.words[place]) + response).clamp(-32_767.0, 32_767.0) as i16
    }

    fn tick(&mut self) {
        self.now += 1;
        if self.on.is_some_and(|since| self.now >= since + START_TAKES) {
            self.status |= STATUS_DATA_READY;
        }
    }
}

impl ErrorType for Line {
    type Error = ErrorKind;
}

impl SpiDevice<u16> for Line {
    fn transaction(&mut self, operations: &mut [Operation<'_, u16>]) -> Result<(), ErrorKind> {
        let mut part = self.0.borrow_mut();
        if part.broken {
            return Err(ErrorKind::ModeFault);
        }
        let asleep = part.now < part.ready;
        for operation in operations {
            match operation {
                Operation::Write([word]) if !asleep => {
                    let [address, value] = word.to_be_bytes();
                    part.write(address, value);
                }
                Operation::TransferInPlace(words) => {
                    let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_be_bytes()).collect();
                    let [address, answer @ ..] = &mut bytes[..] else { panic!("an empty transfer") };
                    assert!(*address & READ != 0);
                    if !asleep {
                        part.read(*address & !READ, answer);
                    }
                    if let Some(stuck) = part.stuck {
                        answer.fill(stuck);
                    }
                    match part.flip {
                        Some(0) => (answer[0], part.flip) = (answer[0] ^ 1, None),
                        left => part.flip = left.map(|left| left - 1),
                    }
                    for (word, bytes) in words.iter_mut().zip(bytes.chunks_exact(2)) {
                        *word = u16::from_be_bytes([bytes[0], bytes[1]]);
                    }
                }
                Operation::Write(_) if asleep => {}
                other => panic!("{other:?}"),
            }
        }
        Ok(())
    }
}

/// Ticks driver and part.
fn ticks(driver: &mut Icm42688<Line>, line: &Line, count: u32) -> Vec<Reading> {
    (0..count)
        .filter_map(|_| {
            line.0.borrow_mut().tick();
            driver.tick()
        })
        .collect()
}

/// Ticks until a reading comes.
fn ticks_to_a_reading(driver: &mut Icm42688<Line>, line: &Line) -> u32 {
    (1..5000).find(|_| ticks(driver, line, 1) == [READING]).expect("a reading")
}

/// A part that is read.
fn running() -> (Icm42688<Line>, Line) {
    let line = Part::on_a_line(0x47);
    let mut driver = Icm42688::new(line.clone());
    ticks_to_a_reading(&mut driver, &line);
    (driver, line)
}

fn is_configured(line: &Line) -> bool {
    CONFIGURATION.iter().all(|entry| line.0.borrow().banks[usize::from(entry.bank)][usize::from(entry.address)] == entry.value)
}

#[test]
fn a_part_after_power_on_is_configured_and_read() {
    let line = Part::on_a_line(0x47);
    let mut driver = Icm42688::new(line.clone());
    let took = ticks_to_a_reading(&mut driver, &line);
    assert!(took > START_TAKES && took < 100, "{took}");
    assert!(is_configured(&line) && line.0.borrow().resets == 1);
    assert_eq!(ticks(&mut driver, &line, 10_000).len(), 10_000, "comparing costs no reading");
    assert_eq!(line.0.borrow().resets, 1);
    // Nothing new is no reading; other bits of the status do not matter.
    line.0.borrow_mut().on = None;
    assert_eq!(ticks(&mut driver, &line, 3), []);
    line.0.borrow_mut().status = STATUS_DATA_READY | 0x10;
    assert_eq!(ticks(&mut driver, &line, 3), [READING]);
}

/// The processor was reset, the part was not.
#[test]
fn a_part_that_is_configured_is_read_within_six_ticks() {
    for bank in 0..3 {
        let (_, line) = running();
        line.0.borrow_mut().bank = bank;
        let mut driver = Icm42688::new(line.clone());
        let took = ticks_to_a_reading(&mut driver, &line);
        assert!(took <= 6, "{took}");
        assert_eq!(line.0.borrow().resets, 1, "it was not reset");
    }
}

#[test]
fn a_part_that_is_configured_otherwise_is_configured_anew() {
    for Entry { bank, address, kept, .. } in CONFIGURATION.into_iter().filter(|entry| entry.kept != 0) {
        for bit in (0..8).map(|bit| 1 << bit).filter(|bit| kept & bit != 0) {
            let (_, line) = running();
            line.0.borrow_mut().banks[usize::from(bank)][usize::from(address)] ^= bit;
            let mut driver = Icm42688::new(line.clone());
            assert_eq!(ticks(&mut driver, &line, 40), [], "register {address:#x} of bank {bank}, bit {bit:#x}");
            ticks_to_a_reading(&mut driver, &line);
            assert!(is_configured(&line) && line.0.borrow().resets == 2);
        }
    }
}

#[test]
fn a_part_found_configured_that_gives_nothing_is_configured_anew_at_once() {
    let (_, line) = running();
    line.0.borrow_mut().on = None;
    let mut driver = Icm42688::new(line.clone());
    let took = ticks_to_a_reading(&mut driver, &line);
    assert!(took < 130 && line.0.borrow().resets == 2, "{took}");
}

#[test]
fn a_configuration_that_is_lost_while_it_is_read_is_noticed() {
    for Entry { bank, address, kept, .. } in CONFIGURATION.into_iter().filter(|entry| entry.kept != 0) {
        let (mut driver, line) = running();
        line.0.borrow_mut().banks[usize::from(bank)][usize::from(address)] ^= kept & kept.wrapping_neg();
        let all = CONFIGURATION.len() as u32 * (u32::from(COMPARED_EVERY) + 1) + 2;
        ticks(&mut driver, &line, all);
        assert_eq!(line.0.borrow().resets, 2, "register {address:#x} of bank {bank}");
        ticks_to_a_reading(&mut driver, &line);
        assert!(is_configured(&line));
    }
}

#[test]
fn a_bit_lost_on_the_wires_is_no_lost_configuration() {
    for transaction in 0..4 * u32::from(COMPARED_EVERY) {
        let (mut driver, line) = running();
        line.0.borrow_mut().flip = Some(transaction);
        ticks(&mut driver, &line, 400);
        assert_eq!((line.0.borrow().resets, line.0.borrow().flip), (1, None));
    }
}

#[test]
fn a_line_stuck_high_or_low_gives_nothing_until_it_is_free() {
    for stuck in [0x00, 0xFF] {
        let (mut driver, line) = running();
        line.0.borrow_mut().stuck = Some(stuck);
        assert_eq!(ticks(&mut driver, &line, 3000), []);
        line.0.borrow_mut().stuck = None;
        ticks_to_a_reading(&mut driver, &line);
        assert!(is_configured(&line));
    }
}

#[test]
fn the_value_of_no_reading_is_none() {
    let (mut driver, line) = running();
    for words in [[1, 2, 3, 4, 5, i16::MIN], [i16::MIN, 2, 3, 4, 5, 6]] {
        line.0.borrow_mut().words = words;
        assert_eq!(ticks(&mut driver, &line, 5), []);
    }
}

#[test]
fn another_part_is_never_configured() {
    for identity in [0x00, 0x42, 0xFF] {
        let line = Part::on_a_line(identity);
        let mut driver = Icm42688::new(line.clone());
        assert_eq!(ticks(&mut driver, &line, 3000), []);
        assert!(!is_configured(&line));
    }
}

#[test]
fn a_broken_bus_gives_nothing_and_is_tried_again_whenever_it_breaks() {
    for ticks_before in 0..200 {
        let line = Part::on_a_line(0x47);
        let mut driver = Icm42688::new(line.clone());
        ticks(&mut driver, &line, ticks_before);
        line.0.borrow_mut().broken = true;
        assert_eq!(ticks(&mut driver, &line, 1100), []);
        // It comes back as after power-on.
        line.0.borrow_mut().broken = false;
        line.0.borrow_mut().restore();
        ticks_to_a_reading(&mut driver, &line);
        assert!(is_configured(&line));
    }
}

#[test]
fn filters_are_those_of_the_data_sheet() {
    // DS-000347, section 5.2: at 536 Hz DELT 12, DELTSQR 144, BITSHIFT 8.
    let at = |bank: u8, address: u8| {
        CONFIGURATION.iter().find(|entry| (entry.bank, entry.address) == (bank, address)).map(|entry| entry.value)
    };
    assert_eq!([0x0C, 0x0D, 0x0E].map(|address| at(1, address)), [Some(12), Some(144), Some(0x80)]);
    assert_eq!([0x03, 0x04, 0x05].map(|address| at(2, address)), [Some(24), Some(144), Some(0x80)]);
    let last = CONFIGURATION.last().map(|entry| (entry.bank, entry.address, entry.value));
    assert_eq!(last, Some((0, 0x4E, 0x0F)));
}

/// A part that is asked to test itself, and so many ticks later: its verdict, and after how many ticks it gave a reading.
fn tested(line: &Line) -> (Option<Verdict>, u32) {
    line.0.borrow_mut().words = [10, -20, 4096, 3, 4, -5];
    let mut driver = Icm42688::new(line.clone());
    driver.test(0.0005);
    let took = (1..5000).find(|_| !ticks(&mut driver, line, 1).is_empty()).expect("a reading");
    assert!(is_configured(line), "as without a test");
    assert_eq!(ticks(&mut driver, line, 3), [Reading { acceleration: [10, -20, 4096], rate: [3, 4, -5] }; 3]);
    let verdict = driver.verdict();
    assert_eq!(driver.verdict(), None, "reported once");
    (verdict, took)
}

#[test]
fn a_whole_part_passes_its_self_test_in_time() {
    let line = Part::on_a_line(0x47);
    let (verdict, took) = tested(&line);
    assert_eq!(verdict, Some(Verdict::Passed));
    let most = test_duration(0.0005) / 0.0005;
    assert!(took > 600 && (took as f32) < most && most < 1000.0, "{took} {most}");
}

#[test]
fn an_axis_that_answers_by_half_or_twice_fails_the_self_test() {
    for axis in 0..6 {
        for (answer, passes) in [(0.0, false), (0.45, false), (0.6, true), (1.4, true), (2.0, false)] {
            let line = Part::on_a_line(0x47);
            line.0.borrow_mut().answers[axis] = answer;
            let failed = Verdict::Failed { gyroscope: axis >= 3, accelerometer: axis < 3 };
            assert_eq!(tested(&line).0, Some(if passes { Verdict::Passed } else { failed }), "axis {axis}: {answer}");
        }
    }
}

#[test]
fn a_part_that_moves_is_not_judged_and_read_the_sooner() {
    for (axis, swing) in [(0, 500), (4, 400)] {
        let line = Part::on_a_line(0x47);
        let mut driver = Icm42688::new(line.clone());
        driver.test(0.0005);
        let mut took = 0;
        while driver.verdict().is_none() {
            took += 1;
            line.0.borrow_mut().words = [0; 6];
            line.0.borrow_mut().words[axis] = if took % 8 < 4 { swing } else { -swing };
            assert_eq!(ticks(&mut driver, &line, 1), []);
        }
        assert!(took < 350, "axis {axis}: {took}");
        assert_eq!(ticks(&mut driver, &line, 3).len(), 3);
        assert_eq!(line.0.borrow().resets, 1);
    }
}

/// Nor is one that comes when its readings may be needed.
#[test]
fn a_part_that_is_absent_at_first_is_not_tested() {
    let line = Part::on_a_line(0x00);
    let mut driver = Icm42688::new(line.clone());
    driver.test(0.0005);
    assert_eq!(ticks(&mut driver, &line, 100), []);
    assert_eq!(driver.verdict(), Some(Verdict::Undecided));
    line.0.borrow_mut().banks[0][0x75] = 0x47;
    assert!(ticks_to_a_reading(&mut driver, &line) < 100);
    assert_eq!(driver.verdict(), None);
}

/// The processor is reset while the part is pushed: what it says then is no reading.
#[test]
fn a_self_test_that_was_left_on_is_found() {
    for axes in [0x07, 0x78] {
        let (_, line) = running();
        line.0.borrow_mut().write(0x70, axes);
        let mut driver = Icm42688::new(line.clone());
        assert_eq!(ticks(&mut driver, &line, 40), []);
        ticks_to_a_reading(&mut driver, &line);
        assert!(is_configured(&line) && line.0.borrow().resets == 2);
    }
}

#[test]
fn the_temperature_is_read_within_a_second() {
    let (mut driver, line) = running();
    assert_eq!(driver.temperature(), None);
    for (counts, celsius) in [(0_i16, 25.0), (-5961, -20.0), (5961, 70.0)] {
        line.0.borrow_mut().banks[0][0x1D..0x1F].copy_from_slice(&counts.to_be_bytes());
        assert_eq!(ticks(&mut driver, &line, 1400).len(), 1400, "and costs no reading");
        assert!(driver.temperature().is_some_and(|found| (found - celsius).abs() < 0.01), "{:?}", driver.temperature());
    }
    line.0.borrow_mut().banks[0][0x1D..0x1F].copy_from_slice(&i16::MIN.to_be_bytes());
    ticks(&mut driver, &line, 1400);
    assert_eq!(driver.temperature(), None);
}
