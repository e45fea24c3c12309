//! Bytes of any kind on the line of a device: it may refuse them, but never panic, and a request after them is answered.
#![no_main]

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use libfuzzer_sys::fuzz_target;
use sprag_shared::device::reset::Cause;
use sprag_shared::device::{Answer, Device, Surroundings};
use sprag_shared::link::{Deframer, MAX_FRAME, Reply, Request, encode};
use sprag_shared::settings::Settings;
use sprag_shared::settings::assemble::AnyController;
use sprag_shared::settings::store::Store;

const SECTOR: usize = 1024;

const AROUND: Surroundings = Surroundings {
    version: [0; 3],
    build: [0; 8],
    board: [0; 12],
    counter_hz: 1_000_000,
    rehearsal: true,
    cause: Cause::PowerOn,
    bad_frames: 0,
    lost_reports: 0,
    stack: 0,
};

/// Flash in memory.
struct Flash([u8; 2 * SECTOR]);

impl ErrorType for Flash {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 4;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        bytes.copy_from_slice(&self.0[offset as usize..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        self.0[from as usize..to as usize].fill(0xff);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        for (place, byte) in self.0[offset as usize..].iter_mut().zip(bytes) {
            *place &= byte;
        }
        Ok(())
    }
}

/// What a device does with `request`, and a tick with whatever sample has come.
fn obey(device: &mut Device, store: &mut Store<Flash>, tag: u8, request: &Request) -> Answer {
    let answer = device.answer_storing(request, store, &AROUND);
    if let Answer::Reply(reply) | Answer::Restarted(reply) = &answer {
        encode(tag, reply, &mut [0; MAX_FRAME]).expect("every reply fits");
    }
    device.tick(|_| {}, 0.0);
    if let Some(report) = device.report(1, 0) {
        encode(0, &Reply::Tick(report), &mut [0; MAX_FRAME]).expect("every report fits");
    }
    answer
}

fuzz_target!(|input: &[u8]| {
    let settings = Settings::default();
    let controller = AnyController::of(&settings).expect("the defaults are a controller");
    let mut device = Device::new(&controller, &settings, None);
    let mut store = Store::open(Flash([0xff; 2 * SECTOR])).0;
    let mut deframer = Deframer::new();
    // As bytes on the line, and then with the checksum that no fuzzer would ever guess.
    for byte in input {
        if let Some(Ok(received)) = deframer.feed::<Request>(*byte) {
            obey(&mut device, &mut store, received.tag, &received.message);
        }
    }
    let mut rest = input;
    while let Ok((request, more)) = postcard::take_from_bytes::<Request>(rest) {
        obey(&mut device, &mut store, 1, &request);
        rest = more;
    }
    assert!(AnyController::of(device.settings()).is_ok(), "settings in force that are no controller");
    let answer = obey(&mut device, &mut store, 2, &Request::Identify);
    assert!(matches!(answer, Answer::Reply(Reply::Identity(_))), "{answer:?}");
});
