//! What survives the line and what is refused.

use super::*;
use message_maker::{REPLIES, REQUESTS, Source, reply, request};
use proptest::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::format;
use std::vec::Vec;

mod golden;
mod message_maker;

fn framed<T: Serialize>(tag: u8, message: &T) -> Vec<u8> {
    let mut frame = [0; MAX_FRAME];
    let length = encode(tag, message, &mut frame).unwrap();
    frame[..length].to_vec()
}

/// Everything that a receiver makes of `bytes`.
fn heard<T: DeserializeOwned>(bytes: &[u8]) -> Vec<Result<Received<T>, FrameError>> {
    let mut deframer = Deframer::new();
    bytes.iter().filter_map(|&byte| deframer.feed(byte)).collect()
}

/// The messages among it.
fn good<T: DeserializeOwned>(bytes: &[u8]) -> Vec<Received<T>> {
    heard(bytes).into_iter().filter_map(Result::ok).collect()
}

/// It arrives as it was sent. The bytes show every bit of a float, also of those that are not numbers, and the text shows every field.
fn arrives<T: Serialize + DeserializeOwned + core::fmt::Debug>(tag: u8, message: &T) {
    let frame = framed(tag, message);
    assert_eq!(frame.iter().position(|byte| *byte == 0), Some(frame.len() - 1), "one zero, at the end");
    let heard = heard::<T>(&frame);
    let [Ok(received)] = &heard[..] else { panic!("{message:?}: {heard:?}") };
    assert_eq!(received.tag, tag);
    assert_eq!(format!("{:?}", received.message), format!("{message:?}"));
    assert_eq!(framed(tag, &received.message), frame);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_message_arrives_as_it_was_sent(words in prop::collection::vec(any::<u32>(), 48), tag: u8) {
        for variant in 0..REQUESTS {
            arrives(tag, &request(variant, &mut Source::new(&words)));
        }
        for variant in 0..REPLIES {
            arrives(tag, &reply(variant, &mut Source::new(&words)));
        }
    }

    #[test]
    fn after_the_next_zero_all_is_well(
        noise in prop::collection::vec(any::<u8>(), 0..400),
        words in prop::collection::vec(any::<u32>(), 48),
        variants in prop::collection::vec(0..REQUESTS, 1..5),
    ) {
        let messages: Vec<Request> = variants.iter().map(|&variant| request(variant, &mut Source::new(&words))).collect();
        let frames: Vec<Vec<u8>> = (1..).zip(&messages).map(|(tag, message)| framed(tag, message)).collect();
        let mut bytes = noise;
        bytes.push(0);
        bytes.extend(frames.concat());
        // What the noise itself came to is the checksum's business.
        let heard = good::<Request>(&bytes);
        let heard = &heard[heard.len().saturating_sub(frames.len())..];
        let again: Vec<Vec<u8>> = heard.iter().map(|received| framed(received.tag, &received.message)).collect();
        prop_assert_eq!(again, frames);
    }
}

#[test]
fn a_float_keeps_every_bit() {
    for bits in [0x7FC0_0001, 0xFFA5_5AA5, 0x7F80_0001, 0x8000_0000, 0x0000_0001, 0x7F80_0000, 0xFF80_0000] {
        let mut sample = TickSample { number: 1, sample: Default::default(), lateness: f32::from_bits(bits), clear: false };
        sample.sample.gyroscope.value = f32::from_bits(bits);
        let heard = good::<Request>(&framed(9, &Request::Sample(sample)));
        let Request::Sample(back) = heard[0].message else { panic!("{heard:?}") };
        assert_eq!((back.lateness.to_bits(), back.sample.gyroscope.value.to_bits()), (bits, bits));
    }
}

#[test]
fn the_longest_message_of_each_kind_fits() {
    // Numbers take the most bytes where all their bits are set.
    let longest = |lengths: Vec<usize>| lengths.into_iter().max().unwrap();
    let words = [u32::MAX; 64];
    let requests = longest((0..REQUESTS).map(|variant| framed(255, &request(variant, &mut Source::new(&words))).len()).collect());
    let replies = longest((0..REPLIES).map(|variant| framed(255, &reply(variant, &mut Source::new(&words))).len()).collect());
    // Of both, the settings: two bytes of version and tag, one of kind, three of index and one of count, five for each word, and four
    // of check, COBS and zero.
    assert_eq!(requests, 2 + 1 + 3 + 1 + 5 * WORD_BLOCK + 4);
    assert!(replies <= MAX_FRAME && replies >= requests, "{replies} of {MAX_FRAME}");
}

#[test]
fn what_is_too_long_is_refused_on_both_sides() {
    let mut frame = [0; MAX_FRAME];
    assert_eq!(encode(1, &[[7_u8; 32]; 4], &mut frame), Err(FrameError::TooLong));
    let mut bytes = std::vec![1; MAX_FRAME + 1];
    bytes.push(0);
    assert_eq!(heard::<Request>(&bytes), [Err(FrameError::TooLong)]);
    // And forgotten.
    bytes.extend(framed(1, &Request::Identify));
    assert_eq!(good::<Request>(&bytes), [Received { tag: 1, message: Request::Identify }]);
}

#[test]
fn a_cut_frame_costs_one_and_a_lost_end_two() {
    let (first, second, third) = (framed(1, &Request::State), framed(2, &Request::Log { from: 77 }), framed(3, &Request::Clear));
    let tags = |bytes: &[u8]| -> Vec<u8> { good::<Request>(bytes).iter().map(|received| received.tag).collect() };
    for cut in 1..first.len() {
        // Its beginning is missing.
        assert_eq!(tags(&[&first[cut..], &second, &third].concat()), [2, 3], "{cut}");
    }
    for cut in 0..first.len() - 1 {
        // Its end is missing, with the zero: what follows is joined to what is there of it.
        let expected: &[u8] = if cut == 0 { &[2, 3] } else { &[3] };
        assert_eq!(tags(&[&first[..cut], &second, &third].concat()), expected, "{cut}");
    }
    // Zeros more cost nothing, and are no frames.
    let zeros = [&first[..], &[0, 0, 0], &second, &[0], &third].concat();
    assert_eq!(tags(&zeros), [1, 2, 3]);
    assert_eq!(heard::<Request>(&zeros).len(), 3);
    // Twice the same is heard twice.
    assert_eq!(tags(&[&first[..], &first].concat()), [1, 1]);
}

/// Frames of several lengths, with zeros in them and without.
fn specimens() -> Vec<Vec<u8>> {
    let sample =
        request(12, &mut Source::new(&core::array::from_fn::<u32, 48, _>(|place| 0x9E37_79B9_u32.wrapping_mul(place as u32))));
    Vec::from([
        framed(1, &Request::Identify),
        framed(7, &Request::Apply { check: 0x1234_5678, store: true }),
        framed(200, &Request::Write(Words { first: 3, count: 2, words: [0; WORD_BLOCK] })),
        framed(33, &sample),
    ])
}

/// Nothing is received of `frame` with these bits flipped, even if its end must be made up.
fn refused(frame: &[u8], flips: impl IntoIterator<Item = usize>) {
    let mut bytes: [u8; MAX_FRAME + 1] = [0; MAX_FRAME + 1];
    bytes[..frame.len()].copy_from_slice(frame);
    let mut places = [0; 16];
    let mut count = 0;
    for bit in flips {
        bytes[bit / 8] ^= 1 << (bit % 8);
        places[count] = bit;
        count += 1;
    }
    let mut deframer = Deframer::new();
    for &byte in &bytes[..=frame.len()] {
        let outcome = deframer.feed::<Request>(byte);
        assert!(!matches!(outcome, Some(Ok(_))), "bits {:?} of {frame:02x?}: {outcome:?}", &places[..count]);
    }
}

#[test]
fn errors_of_one_and_two_bits_are_refused() {
    for frame in specimens() {
        let bits = 8 * frame.len();
        for first in 0..bits {
            refused(&frame, [first]);
            for second in 0..first {
                refused(&frame, [first, second]);
            }
        }
    }
}

#[test]
fn bursts_of_up_to_sixteen_bits_are_refused() {
    for (number, frame) in specimens().iter().enumerate() {
        let bits = 8 * frame.len();
        // All of them in short frames; in long ones every so many.
        let step = if number < 2 { 2 } else { 1 << 8 | 2 };
        for first in 0..bits {
            for pattern in (1_u32..1 << 16).step_by(step) {
                refused(frame, (0..16.min(bits - first)).filter(|place| pattern >> place & 1 == 1).map(|place| first + place));
            }
        }
    }
}

#[test]
fn another_version_is_refused_as_such() {
    for version in (0..=u8::MAX).filter(|version| *version != VERSION) {
        // A good frame of that version, of a message that this one does not know.
        let content = [version, 5, 250, 1, 2, 3];
        let check = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740).checksum(&content).to_le_bytes();
        let mut frame = [0; 16];
        let end = cobs::encode(&[&content[..], &check].concat(), &mut frame);
        assert_eq!(heard::<Request>(&frame[..=end]), [Err(FrameError::Version(version))]);
        assert_eq!(heard::<Reply>(&frame[..=end]), [Err(FrameError::Version(version))]);
    }
}

#[test]
fn whole_frames_without_a_meaning_are_unknown() {
    // A kind that does not exist, a message with bytes after it, a truth value of 2, a fault without a name.
    assert_eq!(heard::<Request>(&framed(1, &250_u8)), [Err(FrameError::Unknown)]);
    assert_eq!(heard::<Request>(&framed(1, &(Request::Identify, 0_u8))), [Err(FrameError::Unknown)]);
    assert_eq!(heard::<Request>(&framed(1, &(4_u8, 0_u32, 2_u8))), [Err(FrameError::Unknown)]);
    assert_eq!(heard::<Reply>(&framed(1, &(3_u8, 5_u8, Some(99_u16)))), [Err(FrameError::Unknown)]);
}
