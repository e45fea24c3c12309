//! `sprag board watch`: what a device reports while it works.

use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

use anyhow::anyhow;
use clap::Args;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::link::Request;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::keys::bounds::Bounds;

use super::board::{PAUSE, Talk, with_device};
use super::board_line::LineArguments;
use super::context::Interrupted;
use crate::board::line::DeviceError;
use crate::board::parameters;
use crate::board::strip_chart::StripChart;

#[derive(Args, Clone, Debug)]
pub struct WatchArguments {
    #[command(flatten)]
    line: LineArguments,
    /// End after this time of the device.
    #[arg(long, value_name = "N", value_parser = super::number(Bounds { low: Some((0.0, false)), high: None }))]
    seconds: Option<f64>,
}

/// Time between two reports that are drawn and two that are printed, s, and between two pictures.
const FINE: f32 = 0.01;
const REDRAW: Duration = Duration::from_millis(200);
/// A device that reports nothing for so long has gone.
const SILENCE: Duration = Duration::from_secs(5);

pub fn run(given: &WatchArguments, out: &mut impl Write, interrupt: &Interrupt) -> anyhow::Result<()> {
    with_device(&given.line, out, |session, out| watch(session, given.seconds, out, interrupt))
}

fn watch(session: &mut Talk, seconds: Option<f64>, out: &mut impl Write, interrupt: &Interrupt) -> anyhow::Result<()> {
    let period = parameters::read(session)?.period();
    let every = (FINE / period).round().clamp(1.0, f32::from(u16::MAX)) as u16;
    session.order(&Request::Stream { every })?;
    let terminal = std::io::stdout().is_terminal();
    if !terminal {
        writeln!(out, "time_s,rotation_rad,velocity_rad_s,engage_first,engage_second,state,fault_code")?;
    }
    let mut chart = StripChart::new(period);
    session.take_started();
    let (mut height, mut drawn, mut heard, mut time) = (0, None::<Instant>, Instant::now(), 0.0);
    while !interrupt.is_set() && seconds.is_none_or(|seconds| time < seconds) {
        session.receive(PAUSE)?;
        while let Some(report) = session.take_tick() {
            heard = Instant::now();
            time = chart.add(report);
            if !terminal {
                let decision = &report.decision;
                let (estimate, [first, second]) = (&decision.estimate, decision.command.map(u8::from));
                let fault = decision.fault.map_or(0, Fault::code);
                let (rotation, velocity, phase) = (estimate.rotation, estimate.velocity, decision.phase);
                writeln!(out, "{time},{rotation},{velocity},{first},{second},{phase:?},{fault}")?;
            }
        }
        if let Some(started) = session.take_started() {
            return Err(anyhow!("the device has started anew ({:?}), and reports no more", started.cause));
        }
        if heard.elapsed() > SILENCE {
            return Err(DeviceError::Silent(" any more".to_owned()).into());
        }
        if terminal && drawn.is_none_or(|drawn| drawn.elapsed() >= REDRAW) {
            drawn = Some(Instant::now());
            height = redraw(&chart.draw(), height, out)?;
        }
    }
    // Not answered, if it has gone meanwhile.
    let _ = session.send(&Request::Stream { every: 0 });
    let _ = session.receive(PAUSE);
    if interrupt.is_set() { Err(Interrupted.into()) } else { Ok(()) }
}

/// Draws over a picture of so many lines; gives the lines of the new one.
fn redraw(picture: &str, height: usize, out: &mut impl Write) -> std::io::Result<usize> {
    if height > 0 {
        write!(out, "\x1b[{height}A")?;
    }
    for line in picture.lines() {
        writeln!(out, "{line}\x1b[K")?;
    }
    out.flush()?;
    Ok(picture.lines().count())
}

#[cfg(test)]
mod tests {
    use sprag_shared::device::beginning::Beginning;
    use sprag_shared::device::{Answer, Device, Surroundings};
    use sprag_shared::link::reset_cause::Cause;
    use sprag_shared::link::{Deframer, MAX_FRAME, Pace, Reply, Started, encode};
    use sprag_shared::settings::Settings;

    use super::*;
    use crate::board::line::Line;
    use crate::board::session::Session;

    /// A device that starts anew as soon as it is to report.
    struct Restarting {
        device: Device,
        deframer: Deframer,
        said: Vec<u8>,
    }

    impl Restarting {
        fn say(&mut self, tag: u8, reply: &Reply) {
            let mut frame = [0; MAX_FRAME];
            let length = encode(tag, reply, &mut frame).unwrap();
            self.said.extend(&frame[..length]);
        }
    }

    impl Line for Restarting {
        fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
            for &byte in bytes {
                let Some(Ok(received)) = self.deframer.feed::<Request>(byte) else { continue };
                if let Answer::Reply(reply) = self.device.answer(&received.message, &Surroundings::default()) {
                    self.say(received.tag, &reply);
                }
                if matches!(received.message, Request::Stream { every: 1.. }) {
                    let (cause, file) = (Cause::Watchdog, [0; 32]);
                    let started = Started { cause, resumed: false, stored: true, restarts: 1, length: 0, place: 0, file };
                    self.say(0, &Reply::Started(started));
                }
            }
            Ok(())
        }

        fn receive(&mut self, _patience: Duration) -> Result<Vec<u8>, DeviceError> {
            // Byte by byte, as of a slow line.
            Ok(if self.said.is_empty() { Vec::new() } else { vec![self.said.remove(0)] })
        }

        fn pace(&self) -> Pace {
            Pace::Sample
        }
    }

    /// Nobody has asked it to report since.
    #[test]
    fn a_device_that_starts_anew_while_it_is_watched_does_answer() {
        let device = Device::new(&Beginning::of(Some(&Settings::default()), None, 0.0).unwrap(), None);
        let line: Box<dyn Line> = Box::new(Restarting { device, deframer: Deframer::new(), said: Vec::new() });
        let ended = watch(&mut Session::new(line), None, &mut Vec::new(), &Interrupt::default()).unwrap_err();
        assert_eq!(ended.to_string(), "the device has started anew (Watchdog), and reports no more");
    }
}
