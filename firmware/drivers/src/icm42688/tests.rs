use std::vec;
use std::vec::Vec;

use embedded_hal::spi::{ErrorKind, ErrorType, Operation};
use embedded_hal_mock::eh1::spi::{Mock, Transaction};

use super::*;

fn write(bytes: &[u8]) -> Vec<Transaction<u8>> {
    vec![Transaction::transaction_start(), Transaction::write_vec(bytes.to_vec()), Transaction::transaction_end()]
}

fn transfer(sent: Vec<u8>, received: Vec<u8>) -> Vec<Transaction<u8>> {
    vec![Transaction::transaction_start(), Transaction::transfer_in_place(sent, received), Transaction::transaction_end()]
}

fn reset() -> Vec<Transaction<u8>> {
    RESET.iter().flat_map(|bytes| write(bytes)).collect()
}

fn identify(answer: u8) -> Vec<Transaction<u8>> {
    transfer(vec![0xF5, 0], vec![0, answer])
}

fn set_up() -> Vec<Transaction<u8>> {
    SETUP.iter().flat_map(|bytes| write(bytes)).collect()
}

fn reading(status: u8, words: [i16; 6]) -> Vec<Transaction<u8>> {
    let mut sent = vec![0; LENGTH];
    sent[0] = 0x9F;
    let mut received = vec![0xAA];
    received.extend(words.iter().flat_map(|word| word.to_be_bytes()));
    received.extend([3, 4, status]);
    transfer(sent, received)
}

/// Ticks from the start to the first one that reads.
const START: usize = 1 + RESET_TICKS as usize + 1 + 1 + SETUP.len() + 1;

/// Ticks so often, with exactly these transactions, and gives what came.
fn ticks(count: usize, transactions: Vec<Vec<Transaction<u8>>>) -> Vec<Reading> {
    let mut mock = Mock::new(&transactions.concat());
    let mut part = Icm42688::new(mock.clone());
    let readings = (0..count).filter_map(|_| part.tick()).collect();
    mock.done();
    readings
}

#[test]
fn starts_and_reads_what_is_new() {
    let words = [1, -2, 300, -400, 32_767, -32_767];
    let readings = ticks(
        START + 4,
        vec![
            reset(),
            identify(0x47),
            set_up(),
            reading(0x08, words),
            reading(0x00, words),
            reading(0x18, [7; 6]),
            reading(0x10, [8; 6]),
        ],
    );
    assert_eq!(
        readings,
        [Reading { acceleration: [1, -2, 300], rate: [-400, 32_767, -32_767] }, Reading { acceleration: [7; 3], rate: [7; 3] }]
    );
}

#[test]
fn a_line_stuck_high_or_low_and_a_part_that_starts_give_nothing() {
    let readings = ticks(
        START + 4,
        vec![
            reset(),
            identify(0x47),
            set_up(),
            reading(0xFF, [-1; 6]),
            reading(0x00, [0; 6]),
            reading(0x08, [1, 2, 3, 4, 5, i16::MIN]),
            reading(0x08, [i16::MIN, 2, 3, 4, 5, 6]),
        ],
    );
    assert_eq!(readings, []);
}

#[test]
fn another_part_or_none_is_asked_again() {
    let round = 1 + RESET_TICKS as usize + 1 + 1;
    let readings = ticks(3 * round, vec![reset(), identify(0xFF), reset(), identify(0x00), reset(), identify(0x47)]);
    assert_eq!(readings, []);
}

#[test]
fn silence_starts_it_anew() {
    let silent = (0..=SILENT_TICKS).flat_map(|_| reading(0, [0; 6])).collect();
    let readings = ticks(
        START + usize::from(SILENT_TICKS) + 1 + START + 1,
        vec![reset(), identify(0x47), set_up(), silent, reset(), identify(0x47), set_up(), reading(0x08, [5; 6])],
    );
    assert_eq!(readings, [Reading { acceleration: [5; 3], rate: [5; 3] }]);
}

struct Broken;

impl ErrorType for Broken {
    type Error = ErrorKind;
}

impl SpiDevice for Broken {
    fn transaction(&mut self, _: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        Err(ErrorKind::ModeFault)
    }
}

#[test]
fn a_broken_bus_gives_nothing_and_is_tried_again_from_any_stage() {
    for stage in [Stage::Reset, Stage::Identify, Stage::Setup(0), Stage::Setup(19)] {
        let mut part = Icm42688 { device: Broken, stage };
        assert_eq!(part.tick(), None);
        assert_eq!(part.stage, Stage::Reset);
    }
    let mut part = Icm42688 { device: Broken, stage: Stage::Run(SILENT_TICKS - 1) };
    assert_eq!([part.tick(), part.tick()], [None; 2]);
    assert_eq!(part.stage, Stage::Reset);
}

#[test]
fn filters_are_those_of_the_data_sheet() {
    // DS-000347, section 5.2: at 536 Hz DELT 12, DELTSQR 144, BITSHIFT 8.
    let at = |bank: u8, address: u8| {
        let mut selected = 0;
        let mut found = None;
        for [register, value] in SETUP {
            if register == 0x76 {
                selected = value;
            } else if (selected, register) == (bank, address) {
                found = Some(value);
            }
        }
        found
    };
    assert_eq!([0x0C, 0x0D, 0x0E].map(|address| at(1, address)), [Some(12), Some(144), Some(0x80)]);
    assert_eq!([0x03, 0x04, 0x05].map(|address| at(2, address)), [Some(24), Some(144), Some(0x80)]);
    assert_eq!(SETUP.last(), Some(&[0x4E, 0x0F]));
}
