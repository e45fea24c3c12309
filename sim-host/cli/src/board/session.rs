//! Requests to a device and its replies.

use std::collections::VecDeque;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use sprag_shared::control::supervisor::Phase;
use sprag_shared::control::supervisor::event_log::Entry;
use sprag_shared::link::{
    Deframer, Done, Identity, MAX_FRAME, Mishap, Pace, Refusal, Reply, Request, Started, State, TickReport, TickSample, encode,
};

use super::line::{DeviceError, Line, RefusalText};

/// For how long one reply is waited for.
const PATIENCE: Duration = Duration::from_millis(300);

/// How often a request is made before the device is taken to be silent.
const ATTEMPTS: u32 = 6;

/// Control periods for which a reply is waited for on a line that the device's timer paces.
const PERIODS: u32 = 400;

/// What the first tag follows upon: by the clock, where an answer to an earlier program may still come. A line that the device's timer paces
/// begins with its device, and every run of it is the same.
fn first_tag(pace: Pace) -> u8 {
    match pace {
        Pace::Timer => 0,
        Pace::Sample => SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| (time.subsec_micros() % 256) as u8),
    }
}

/// A line to a device, and what has come over it.
pub struct Session<L> {
    line: L,
    deframer: Deframer,
    tag: u8,
    /// Reports that nobody has taken yet.
    ticks: VecDeque<TickReport>,
    started: Option<Started>,
    bad_frames: u64,
}

impl<L: Line> Session<L> {
    /// On a line.
    pub fn new(line: L) -> Session<L> {
        let tag = first_tag(line.pace());
        Session { line, deframer: Deframer::new(), tag, ticks: VecDeque::new(), started: None, bad_frames: 0 }
    }

    /// The line.
    pub fn line(&mut self) -> &mut L {
        &mut self.line
    }

    /// Frames from the device that were not whole.
    pub fn bad_frames(&self) -> u64 {
        self.bad_frames
    }

    /// That the device has started since the last time this was asked.
    pub fn take_started(&mut self) -> Option<Started> {
        self.started.take()
    }

    /// Sends a request and does not wait for a reply; returns its tag.
    ///
    /// # Errors
    /// The errors of the line.
    pub fn send(&mut self, request: &Request) -> Result<u8, DeviceError> {
        self.tag = self.tag.checked_add(1).unwrap_or(1);
        let mut frame = [0; MAX_FRAME];
        let length = encode(self.tag, request, &mut frame)?;
        self.line.send(&frame[..length])?;
        Ok(self.tag)
    }

    /// Takes in what comes within `patience`; the replies among it that were asked for, with their tags.
    ///
    /// # Errors
    /// The errors of the line.
    pub fn receive(&mut self, patience: Duration) -> Result<Vec<(u8, Reply)>, DeviceError> {
        let mut replies = Vec::new();
        for byte in self.line.receive(patience)? {
            match self.deframer.feed::<Reply>(byte) {
                None => {}
                Some(Err(sprag_shared::link::FrameError::Version(version))) => {
                    return Err(sprag_shared::link::FrameError::Version(version).into());
                }
                Some(Err(_)) => self.bad_frames += 1,
                Some(Ok(received)) => match received.message {
                    Reply::Tick(report) => self.ticks.push_back(report),
                    Reply::Started(started) => self.started = Some(started),
                    reply => replies.push((received.tag, reply)),
                },
            }
        }
        Ok(replies)
    }

    /// Makes a request until it is answered, however late: the answer to any attempt counts, if it is refused or of the kind that `wanted` takes.
    ///
    /// # Errors
    /// [`DeviceError::Silent`], [`DeviceError::Refused`], or as the line.
    pub fn ask<R>(&mut self, request: &Request, wanted: impl Fn(Reply) -> Option<R>) -> Result<R, DeviceError> {
        let mut tags = Vec::new();
        for _ in 0..ATTEMPTS {
            tags.push(self.send(request)?);
            let (asked, mut periods) = (Instant::now(), 0);
            while asked.elapsed() < PATIENCE && periods < PERIODS {
                let replies = self.receive(PATIENCE)?;
                periods += 1;
                // Others are to an earlier request, and late.
                for (_, reply) in replies.into_iter().filter(|(of, _)| tags.contains(of)) {
                    if let Reply::Refused(refusal) = reply {
                        return Err(DeviceError::Refused(RefusalText(refusal)));
                    }
                    if let Some(answer) = wanted(reply) {
                        return Ok(answer);
                    }
                }
            }
        }
        Err(DeviceError::Silent(", or speaks another link version".to_owned()))
    }

    /// Who it is.
    ///
    /// # Errors
    /// The errors of [`Session::ask`].
    pub fn identify(&mut self) -> Result<Identity, DeviceError> {
        self.ask(&Request::Identify, |reply| if let Reply::Identity(identity) = reply { Some(identity) } else { None })
    }

    /// How it is.
    ///
    /// # Errors
    /// The errors of [`Session::ask`].
    pub fn state(&mut self) -> Result<State, DeviceError> {
        self.ask(&Request::State, |reply| if let Reply::State(state) = reply { Some(state) } else { None })
    }

    /// Asks for something that only has to be done.
    ///
    /// # Errors
    /// The errors of [`Session::ask`].
    pub fn order(&mut self, request: &Request) -> Result<Done, DeviceError> {
        self.ask(request, |reply| if let Reply::Done(done) = reply { Some(done) } else { None })
    }

    /// Has it test itself, from how it was `before`. An Armed one that refuses because it tests itself has heard, and its answer was lost.
    ///
    /// # Errors
    /// The errors of [`Session::ask`].
    pub fn self_test(&mut self, before: Phase) -> Result<(), DeviceError> {
        match self.order(&Request::SelfTest) {
            Err(DeviceError::Refused(RefusalText(Refusal::Busy(Phase::Boot | Phase::SelfTest)))) if before == Phase::Armed => {
                Ok(())
            }
            done => done.map(|_| ()),
        }
    }

    /// The event log, oldest first, and how many entries there have ever been.
    ///
    /// # Errors
    /// The errors of [`Session::ask`].
    pub fn log(&mut self) -> Result<(Vec<Entry>, u32), DeviceError> {
        let (mut entries, mut from) = (Vec::new(), 0);
        loop {
            let block =
                self.ask(&Request::Log { from }, |reply| if let Reply::Log(block) = reply { Some(block) } else { None })?;
            let count = usize::from(block.count).min(block.entries.len());
            entries.extend(block.entries[..count].iter().filter_map(|entry| entry.entry()));
            from = block.from + count as u32;
            if count == 0 || from >= block.total {
                return Ok((entries, block.total));
            }
        }
    }

    /// Sends a sample.
    ///
    /// # Errors
    /// The errors of the line.
    pub fn sample(&mut self, sample: &TickSample) -> Result<(), DeviceError> {
        self.send(&Request::Sample(*sample)).map(|_| ())
    }

    /// The oldest report that nobody has taken yet.
    pub fn take_tick(&mut self) -> Option<TickReport> {
        self.ticks.pop_front()
    }

    /// Injects a fault; the device does not answer.
    ///
    /// # Errors
    /// The errors of the line.
    pub fn rehearse(&mut self, mishap: Mishap) -> Result<(), DeviceError> {
        self.send(&Request::Rehearse(mishap)).map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::link::{RecorderActivity, RecorderState};

    use super::*;

    /// What is said to the request of a number, from 1, with the tags of all requests so far.
    type Script = dyn Fn(usize, &[u8]) -> Vec<(u8, Reply)>;

    /// A device that says what is written.
    struct Scripted {
        script: Box<Script>,
        deframer: Deframer,
        tags: Vec<u8>,
        said: Vec<u8>,
    }

    impl Line for Scripted {
        fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
            for &byte in bytes {
                let Some(Ok(received)) = self.deframer.feed::<Request>(byte) else { continue };
                self.tags.push(received.tag);
                for (tag, reply) in (self.script)(self.tags.len(), &self.tags) {
                    let mut frame = [0; MAX_FRAME];
                    let length = encode(tag, &reply, &mut frame)?;
                    self.said.extend(&frame[..length]);
                }
            }
            Ok(())
        }

        fn receive(&mut self, _patience: Duration) -> Result<Vec<u8>, DeviceError> {
            Ok(std::mem::take(&mut self.said))
        }

        fn pace(&self) -> Pace {
            Pace::Timer
        }
    }

    fn session(script: impl Fn(usize, &[u8]) -> Vec<(u8, Reply)> + 'static) -> Session<Scripted> {
        Session::new(Scripted { script: Box::new(script), deframer: Deframer::new(), tags: Vec::new(), said: Vec::new() })
    }

    const DONE: Reply = Reply::Done(Done::AsAsked);

    /// A device that erases a sector hears nothing for seconds, and then answers what it was asked first.
    #[test]
    fn a_late_answer_to_an_earlier_attempt_counts() {
        let mut session = session(|number, tags| match number {
            3 => vec![(tags[0], DONE)],
            // Those to the others come when something else has been asked.
            4 => vec![(tags[1], DONE), (tags[2], DONE), (tags[3], Reply::Done(Done::Stored))],
            _ => Vec::new(),
        });
        assert_eq!(session.order(&Request::EraseRecordings).unwrap(), Done::AsAsked);
        assert_eq!(session.order(&Request::Protect).unwrap(), Done::Stored);
    }

    /// An earlier program may have begun at the same tag.
    #[test]
    fn a_late_answer_of_another_kind_is_none() {
        let activity = RecorderActivity::Ready;
        let state = Reply::Recorder(RecorderState { pages: 1, next: 0, goes_round: false, activity, lost: 0, refused: 0 });
        let mut session = session(move |_, tags| vec![(tags[0], DONE), (tags[0], state)]);
        let found = session.ask(&Request::Recorder, |reply| matches!(reply, Reply::Recorder(_)).then_some(reply));
        assert_eq!(found.unwrap(), state);
    }

    /// Firmware drops frames of another version without a word.
    #[test]
    fn silence_may_be_another_version() {
        let error = session(|_, _| Vec::new()).state().unwrap_err();
        assert_eq!(error.to_string(), "the device does not answer, or speaks another link version");
    }

    #[test]
    fn a_self_test_whose_answer_is_lost_has_begun() {
        let busy = |phase| Reply::Refused(Refusal::Busy(phase));
        for (before, phase, begun) in [
            (Phase::Armed, Phase::Boot, true),
            (Phase::Armed, Phase::SelfTest, true),
            (Phase::SelfTest, Phase::SelfTest, false),
            (Phase::Armed, Phase::Rocking, false),
        ] {
            let mut session =
                session(move |number, tags| if number == 1 { Vec::new() } else { vec![(tags[number - 1], busy(phase))] });
            assert_eq!(session.self_test(before).is_ok(), begun, "{before:?} {phase:?}");
        }
    }
}
