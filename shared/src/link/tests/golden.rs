//! The bytes of a frame of every kind. A change of any of them is a change of the protocol: raise [`VERSION`] with it.

use super::framed;
use super::message_maker::{ACTIVITIES, CAUSES, REPLIES, REQUESTS, Source, WISHES, reply, request};
use crate::control::monitor::fault::Fault;
use crate::control::supervisor::Phase;
use crate::link::reset_cause::Cause;
use crate::link::*;
use crate::math::sign::Sign;
use serde::Serialize;
use std::format;
use std::string::String;
use std::vec::Vec;

/// Words of which no two are alike, and which choose each variant of the smaller choices somewhere.
const WORDS: [u32; 5] = [1, 0x4049_0FDB, 300, 0xBF80_0000, 70_000];

/// By the number of the request and then by the number of the reply, as [`super::message_maker`] has them.
const GOLDEN: [&str; REQUESTS + REPLIES] = [
    "02030103cc9500",
    "06030101dcb600",
    "07030202013f0700",
    "3a03030301dbac02808080fc0bf0a20401db9fa48204ac02808080fc0bf0a20401db9fa48204ac02808080fc0bf0a20401db9fa48204ac02761a00",
    "080304040101ffca00",
    "060305059c3a00",
    "07030606013b1700",
    "06030707bc7c00",
    "060308086d9d00",
    "0703090901342b00",
    "07030a0a01372700",
    "06030b0b5df800",
    "0b030c0c01db0f4940ac02010780bff0a20401010108db9fa482042c010109808080fc0b7011010901c9c0b7fb07ac020102010101040109bf00",
    "07030d0d01303b00",
    "06030e0e0d5700",
    "07030f0f01323300",
    "060310108e8400",
    "060311119ea700",
    "02030103010101057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c077001db2cf8eb00",
    "0e03010101db9fa4820401012c010101010380bf0470110101010680bf701101020101010801db0f49402c010101010680bf70110102020107f0a204013b3500",
    "0703020201db2c057001db2c057001db2c057001db2c127001db2c808080fc0bf02201db9fa482040104700101010103d73300",
    "0f030303010134808080fc0b7011010201010107db0f49402c010101011a80bf9fbaf7ff0f01db9fa48204ac02808080fc0bf0a2040106032b9800",
    "3a03040401dbac02808080fc0bf0a20401db9fa48204ac02808080fc0bf0a20401db9fa48204ac02808080fc0bf0a20401db9fa48204ac02b76000",
    "1003050501dbac02808080fc0b701101020101010bdb2c808080fc0b701101020101010bdb2c808080fc0b7011010201010105db2c06c900",
    "07030606013b1700",
    "0703070707fc7300",
    "0703080801db1f0107f0a204010c4f00",
    "0703090901db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c057001db2c077001db2ceebc00",
];

fn hexadecimal(frame: &[u8]) -> String {
    frame.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn frames_are_what_they_were() {
    let requests = (0..REQUESTS).map(|variant| framed(variant as u8, &request(variant, &mut Source::new(&WORDS))));
    let replies = (0..REPLIES).map(|variant| framed(variant as u8, &reply(variant, &mut Source::new(&WORDS))));
    let frames: Vec<String> = requests.chain(replies).map(|frame| hexadecimal(&frame)).collect();
    assert_eq!(frames[..], GOLDEN, "{frames:#?}");
}

#[test]
fn choices_within_messages_are_what_they_were() {
    let refused = [
        (Refusal::Busy(Phase::Rocking), "070004"),
        (Refusal::NoSuchSetting(300), "0701ac02"),
        (Refusal::OutOfRange(1), "070201"),
        (Refusal::Contradiction(2, 3), "07030203"),
        (Refusal::Check(128), "07048001"),
        (Refusal::FlashFull, "0705"),
        (Refusal::FlashFailed, "0706"),
        (Refusal::NotHere, "0707"),
        (Refusal::TooFast { period: 1.0, least: -2.0 }, "07080000803f000000c0"),
        (Refusal::NoJumper, "0709"),
        (Refusal::NotSealed, "070a"),
    ];
    for (refusal, body) in refused {
        assert_eq!(contents(&Reply::Refused(refusal)), body);
    }
    let mishaps = [
        (Mishap::Dawdle(127), "0d007f"),
        (Mishap::Reset, "0d01"),
        (Mishap::Panic, "0d02"),
        (Mishap::HardFault, "0d03"),
        (Mishap::PowerCut(128), "0d048001"),
    ];
    for (mishap, body) in mishaps {
        assert_eq!(contents(&Request::Rehearse(mishap)), body);
    }
    assert_eq!([Done::AsAsked, Done::Stored].map(|done| contents(&Reply::Done(done))), ["0600", "0601"]);
    assert_eq!([Pace::Timer, Pace::Sample].map(|pace| contents(&Request::Attach { pace })), ["0a00", "0a01"]);
    let numbers = |place: usize| format!("{place:02x}");
    assert_eq!(Phase::ALL.map(|phase| contents(&phase)), core::array::from_fn(numbers));
    assert_eq!(CAUSES.map(|cause| contents(&cause)), core::array::from_fn(numbers));
    assert_eq!(contents(&Cause::ClockFailure), "07");
    assert_eq!(ACTIVITIES.map(|activity| contents(&activity)), core::array::from_fn(numbers));
    assert_eq!(WISHES.map(|wish| contents(&wish)), core::array::from_fn(numbers));
    assert_eq!([Sign::Positive, Sign::Negative].map(|sign| contents(&sign)), ["00", "01"]);
    for fault in Fault::ALL {
        assert_eq!(contents(&fault), numbers(fault.code().into()));
    }
}

/// What stands in a frame between tag and check.
fn contents<T: Serialize>(message: &T) -> String {
    let mut frame = framed(1, message);
    let length = cobs::decode_in_place(&mut frame).unwrap();
    hexadecimal(&frame[2..length - 2])
}
