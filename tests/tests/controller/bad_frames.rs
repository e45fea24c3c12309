//! Ten million frames of random bytes, and of good frames damaged at random, into the decoder and the device of the firmware.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sprag_shared::control::sensing::sample::{Count, Reading, Sample};
use sprag_shared::device::beginning::Beginning;
use sprag_shared::device::{Answer, Device, Surroundings};
use sprag_shared::link::{Deframer, FrameError, MAX_FRAME, Mishap, Pace, Reply, Request, TickSample, WORD_BLOCK, Words, encode};
use sprag_shared::settings::store::Store;
use sprag_shared::settings::{COUNT, Item, Settings};
use sprag_tests::flash::Flash;

/// Frames for each of the two devices.
const FRAMES: u64 = 5_000_000;
/// Frames after which the device is looked at.
const BATCH: u64 = 50_000;

/// What became of the frames.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    too_long: u64,
    damaged: u64,
    version: u64,
    unknown: u64,
    /// Good frames that damage beside them left as they were.
    intact: u64,
    /// Damaged and yet good: what a checksum of 16 bits lets through, or damage that undid itself.
    passed: u64,
}

impl Tally {
    fn frames(&self) -> u64 {
        self.too_long + self.damaged + self.version + self.unknown + self.intact + self.passed
    }
}

struct Dice(ChaCha8Rng);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        ((u64::from(self.0.next_u32()) * bound as u64) >> 32) as usize
    }

    fn word(&mut self) -> u32 {
        self.0.next_u32()
    }

    fn request(&mut self, kind: usize) -> Request {
        match kind {
            0 => Request::Identify,
            1 => Request::State,
            2 => Request::Read { first: self.below(2 * COUNT) as u16 },
            3 => self.write(),
            // The draft's own check among others: if it came unhurt after a change of the draft it would do something.
            4 => {
                let mut settings = Settings::default();
                settings.set(Item::Law.index(), self.below(7) as u32).unwrap();
                let check = if self.below(3) == 0 { self.word() } else { settings.check() };
                Request::Apply { check, store: self.below(2) == 0 }
            }
            5 => Request::Discard,
            6 => Request::Log { from: self.word() },
            7 => Request::Clear,
            8 => Request::SelfTest,
            9 => Request::Stream { every: self.word() as u16 },
            10 => Request::Attach { pace: if self.below(2) == 0 { Pace::Timer } else { Pace::Sample } },
            11 => Request::Detach,
            12 => Request::Sample(self.sample()),
            _ => Request::Rehearse(if self.below(2) == 0 { Mishap::Panic } else { Mishap::PowerCut(self.word()) }),
        }
    }

    /// Of the law alone, or of many words.
    fn write(&mut self) -> Request {
        let mut words = [0; WORD_BLOCK];
        if self.below(2) == 0 {
            words[0] = self.below(7) as u32;
            return Request::Write(Words { first: Item::Law.index(), count: 1, words });
        }
        let first = self.below(COUNT - WORD_BLOCK);
        words.copy_from_slice(&Settings::default().words()[first..first + WORD_BLOCK]);
        Request::Write(Words { first: first as u16, count: WORD_BLOCK as u8, words })
    }

    fn sample(&mut self) -> TickSample {
        let mut reading = || Reading { value: f32::from_bits(self.word()), number: self.word() };
        let sample = Sample {
            gyroscope: reading(),
            block_accelerometer: [reading(), reading()],
            ground_accelerometer: [reading(), reading()],
            encoder: Count { counts: self.word() as i32, number: self.word() },
            engaged: [false, true],
        };
        TickSample { number: self.word(), sample, lateness: 0.0, clear: self.below(2) == 0 }
    }

    fn frame(&mut self) -> Vec<u8> {
        let kind = self.below(14);
        let (tag, request) = (self.word() as u8, self.request(kind));
        let mut frame = [0; MAX_FRAME];
        let length = encode(tag, &request, &mut frame).unwrap();
        frame[..length].to_vec()
    }

    /// Bytes of which one in so many is a zero, so that frames of all lengths occur.
    fn noise(&mut self, bytes: &mut Vec<u8>) {
        let zeros = 2 + self.below(30);
        for _ in 0..self.below(64) {
            bytes.push(if self.below(zeros) == 0 { 0 } else { self.word() as u8 });
        }
        bytes.push(0);
    }

    /// One of `frames` with some of its bits or bytes changed, lost or added, or its beginning with another's end.
    fn damaged(&mut self, frames: &[Vec<u8>], bytes: &mut Vec<u8>) {
        let start = bytes.len();
        let frame = &frames[self.below(frames.len())];
        bytes.extend(frame);
        for _ in 0..=self.below(3) {
            let length = bytes.len() - start;
            let place = start + self.below(length.max(1));
            match self.below(6) {
                _ if length == 0 => bytes.push(self.word() as u8),
                0 | 1 => bytes[place] ^= 1 << self.below(8),
                2 => bytes[place] = self.word() as u8,
                3 => bytes.insert(place, self.word() as u8),
                4 => drop(bytes.remove(place)),
                _ if self.below(2) == 0 => bytes.truncate(place),
                _ => {
                    let other = &frames[self.below(frames.len())];
                    bytes.truncate(place);
                    bytes.extend(&other[self.below(other.len())..]);
                }
            }
        }
        // Often its end has gone too.
        if self.below(4) > 0 {
            bytes.push(0);
        }
    }
}

/// A device on the other end of a bad line.
struct Victim {
    device: Device,
    store: Store<Flash>,
    /// What is in the store before the first frame.
    flash: Flash,
    deframer: Deframer,
    attach: Option<Pace>,
}

impl Victim {
    fn new(attach: Option<Pace>) -> Victim {
        let settings = Settings::default();
        let mut store = Store::open(Flash::default()).0;
        store.store(&settings).unwrap();
        let flash = store.clone().release();
        let device = Device::new(&Beginning::of(Some(&settings), None, 0.0).unwrap(), None);
        let mut victim = Victim { device, store, flash, deframer: Deframer::new(), attach };
        victim.settle();
        victim
    }

    /// Attached as it shall be: good frames among the noise may have changed that.
    fn settle(&mut self) {
        if self.device.attached() != self.attach {
            let request = self.attach.map_or(Request::Detach, |pace| Request::Attach { pace });
            self.device.answer_storing(&request, &mut self.store, &Surroundings::default());
        }
    }

    fn hear(&mut self, bytes: &[u8], frames: &[Vec<u8>], tally: &mut Tally) {
        for &byte in bytes {
            match self.deframer.feed::<Request>(byte) {
                None => {}
                Some(Err(FrameError::TooLong)) => tally.too_long += 1,
                Some(Err(FrameError::Damaged)) => tally.damaged += 1,
                Some(Err(FrameError::Version(_))) => tally.version += 1,
                Some(Err(FrameError::Unknown)) => tally.unknown += 1,
                Some(Ok(received)) => {
                    let mut frame = [0; MAX_FRAME];
                    let length = encode(received.tag, &received.message, &mut frame).unwrap();
                    let intact = frames.iter().any(|one| *one == frame[..length]);
                    if intact {
                        tally.intact += 1
                    } else {
                        tally.passed += 1
                    }
                    if intact && matches!(received.message, Request::Apply { .. }) {
                        // That would be an order, and no damage.
                        continue;
                    }
                    if self.device.answer_storing(&received.message, &mut self.store, &Surroundings::default()) == Answer::Sample
                    {
                        self.device.tick(|_| {}, 0.0);
                    }
                }
            }
        }
    }

    fn is_unharmed(&mut self) {
        self.device.tick(|_| {}, 0.0);
        assert_eq!(*self.device.settings(), Settings::default());
        assert!(self.store.clone().release() == self.flash, "written to");
        let mut frame = [0; MAX_FRAME];
        let length = encode(77, &Request::Identify, &mut frame).unwrap();
        // A zero ends whatever came before.
        self.deframer.feed::<Request>(0);
        let heard = frame[..length].iter().filter_map(|&byte| self.deframer.feed::<Request>(byte)).last().unwrap().unwrap();
        assert_eq!((heard.tag, heard.message), (77, Request::Identify));
        let Answer::Reply(Reply::Identity(identity)) =
            self.device.answer_storing(&heard.message, &mut self.store, &Surroundings::default())
        else {
            panic!("no identity")
        };
        assert_eq!(identity.check, Settings::default().check());
        self.settle();
    }
}

fn torment(attach: Option<Pace>, seed: u64) -> Tally {
    let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
    let mut victim = Victim::new(attach);
    let (mut tally, mut bytes) = (Tally::default(), Vec::new());
    let mut look = BATCH;
    while tally.frames() < FRAMES {
        let frames: Vec<Vec<u8>> = (0..20).map(|_| dice.frame()).collect();
        for _ in 0..1000 {
            bytes.clear();
            if dice.below(2) == 0 {
                dice.noise(&mut bytes)
            } else {
                dice.damaged(&frames, &mut bytes)
            }
            victim.hear(&bytes, &frames, &mut tally);
        }
        if tally.frames() >= look {
            victim.is_unharmed();
            look += BATCH;
        }
    }
    victim.is_unharmed();
    assert_eq!(Store::open(victim.store.release()).1, Some(Settings::default()));
    tally
}

#[test]
fn ten_million_bad_frames_change_nothing() {
    let begun = std::time::Instant::now();
    let (fresh, attached) = std::thread::scope(|scope| {
        let fresh = scope.spawn(|| torment(None, 1));
        let attached = torment(Some(Pace::Sample), 2);
        (fresh.join().unwrap(), attached)
    });
    println!("fresh {fresh:?}\nattached {attached:?}\n{:.1} s", begun.elapsed().as_secs_f64());
    for tally in [fresh, attached] {
        assert!(tally.frames() >= FRAMES);
        // Of random content one in 2¹⁶ passes a checksum of 16 bits; most frames are no COBS to begin with.
        assert!(tally.passed < tally.frames() >> 14, "{tally:?}");
    }
}
