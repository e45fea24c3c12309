//! Bytes of any kind on the line of a device: it may refuse them, but never panic, and a request after them is answered.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sprag_shared::control::controller::Controller;
use sprag_shared::device::beginning::Beginning;
use sprag_shared::device::{Answer, Device, Surroundings};
use sprag_shared::link::{Deframer, MAX_FRAME, Reply, Request, encode};
use sprag_shared::settings::Settings;
use sprag_shared::settings::store::Store;

#[path = "../../../shared/src/device/tests/flash.rs"]
mod flash;

use flash::Flash;

/// What a device does with `request`, and a tick with whatever sample has come.
fn obey(device: &mut Device, store: &mut Store<Flash>, tag: u8, request: &Request) -> Answer {
    let around = Surroundings { rehearsal: true, ..Surroundings::default() };
    let answer = device.answer_storing(request, store, &around);
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
    let beginning = Beginning::of(Some(&settings), None, 0.0).expect("the defaults are a controller");
    let mut device = Device::new(&beginning, None);
    let mut store = Store::open(Flash::default()).0;
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
    assert!(Controller::of(device.settings()).is_ok(), "settings in force that are no controller");
    let answer = obey(&mut device, &mut store, 2, &Request::Identify);
    assert!(matches!(answer, Answer::Reply(Reply::Identity(_))), "{answer:?}");
});
