//! The firmware of Sprag: the shared controller on a board.
//!
//! Two tasks. Control runs at every period of the controller, above all else: sensors, tick, coils, watchdog. The link runs in what time is
//! left: frames, answers, logs. Everything numeric is in `sprag_shared`; every pin is behind [`board::Board`].
#![no_std]
#![no_main]

mod board;
mod control;
mod identity;
mod integrity;
mod last_words;
mod link;
mod log;
mod memory;
mod memory_test;
mod seal;
mod stack;
mod tick;

#[rtic::app(device = crate::board::chip)]
mod app {
    use crate::board::{Board as _, Selected};
    use crate::control::Control;
    use crate::identity;
    use crate::integrity::{self, Integrity, Next};
    use crate::link::{Link, Outbox, Stored};
    use crate::log::info;
    use crate::seal::{Program, Seen};
    use crate::{last_words, memory, stack, tick};
    use core::mem::MaybeUninit;
    use sprag_shared::control::monitor::fault::Fault;
    use sprag_shared::device::beginning::Beginning;
    use sprag_shared::device::conditions::Conditions;
    use sprag_shared::device::recorder::{Recorder, Ring};
    use sprag_shared::device::retained::Retained;
    use sprag_shared::device::{Answer, Device, Surroundings};
    use sprag_shared::link::{Done, Refusal, Reply, Request};
    use sprag_shared::settings::Settings;
    use sprag_shared::settings::store::{Store, StoreError};
    use sprag_shared::settings::wiring::Wiring;

    #[shared]
    struct Shared {
        device: &'static mut Device,
        ring: &'static mut Ring,
        outbox: Outbox,
    }

    #[local]
    struct Local {
        control: Control,
        link: Link,
        integrity: Integrity,
    }

    #[init(local = [
        device: MaybeUninit<Device> = MaybeUninit::uninit(),
        stored: MaybeUninit<Stored> = MaybeUninit::uninit(),
        ring: Ring = Ring::new(),
    ])]
    fn init(context: init::Context) -> (Shared, Local) {
        let (mut board, cause) = Selected::wake(context.core, context.device);
        stack::paint();
        let words = last_words::take(cause);
        let mut program = Program::sealed();
        let damaged = program.as_mut().is_some_and(|program| program.look_through() == Seen::Damaged);
        let (mut store, settings) = Store::open(board.flash());
        let highest = store.note_firmware(identity::VERSION);
        let survived = words.cause.keeps_memory();
        let kept = if survived { memory::load() } else { None };
        // Only an image for fault injection continues with the host it had.
        let kept = kept.map(|kept| if cfg!(feature = "board-qemu") { kept } else { kept.alone() });
        let device = start(context.local.device, settings.as_ref(), kept.as_ref());
        if let Some(slots) = memory::load_log(survived) {
            device.remember(&slots, words.cause);
        }
        let commissioned = device.barred().is_none();
        if damaged {
            device.accuse(Fault::ImageDamaged);
        }
        for (warning, due) in [(Fault::NotSealed, program.is_none()), (Fault::OlderFirmware, highest != identity::VERSION)] {
            if due {
                device.warn(warning);
            }
        }
        let recorder = Recorder::new(board.recordings(), !Selected::ERASING_STALLS, device.resumes());
        let stored = context.local.stored.write(Stored { settings: store, recorder });
        memory::Keeper::new().save(&device.retained());
        integrity::put_in_force(device);
        crate::control::set_safe_state(device.safe_command());
        let counts = kept.filter(|_| device.resumes()).map(|kept| kept.counts);
        let conditions = Conditions::new(&Wiring::of(device.settings()));
        let parts = board.begin(device.settings(), counts);
        if !device.resumes() && device.barred().is_none() {
            crate::control::test_sensors();
        }
        tick::set_period(device.period_counts(Selected::CORE_HZ));
        info!("started: {}, resumes {}, commissioned {}", words.cause, device.resumes(), device.barred().is_none());
        let around = Surroundings { highest, sealed: program.is_some(), ..identity::surroundings(words.cause) };
        let end = program.as_ref().map_or(0, Program::end);
        let link = Link::new(parts.line, stored, &words.started(device, commissioned), around, end, device.attached());
        let integrity = Integrity::new(program, parts.clock);
        let control = Control::new(conditions, parts.sensors, parts.coils, parts.watchdog, parts.light);
        (Shared { device, ring: context.local.ring, outbox: Outbox::new() }, Local { control, link, integrity })
    }

    /// The device with the settings found in flash, or with the defaults.
    #[inline(never)]
    fn start(
        place: &'static mut MaybeUninit<Device>,
        settings: Option<&Settings>,
        kept: Option<&Retained>,
    ) -> &'static mut Device {
        // The tests make a controller of the defaults.
        let Some(beginning) = Beginning::of(settings, kept, Selected::LEAST_PERIOD) else { last_words::stop() };
        put(place, &beginning, kept)
    }

    /// Makes the device in its place. By itself, so that the compiler sees that nobody else looks there, and makes no copy on the stack.
    #[inline(never)]
    fn put<'a>(place: &'a mut MaybeUninit<Device>, beginning: &Beginning, kept: Option<&Retained>) -> &'a mut Device {
        place.write(Device::new(beginning, kept))
    }

    #[task(binds = SysTick, priority = 3, local = [control], shared = [device, ring, outbox])]
    fn control(context: control::Context<'_>) {
        let timer = tick::by_timer();
        let control = context.local.control;
        (context.shared.device, context.shared.ring, context.shared.outbox)
            .lock(|device, ring, outbox| crate::control::control_tick(control, device, ring, outbox, timer));
    }

    #[idle(local = [link, integrity], shared = [device, ring, outbox])]
    fn idle(mut context: idle::Context<'_>) -> ! {
        context.local.link.mend();
        let end = context.local.link.program_end();
        loop {
            let report = if context.local.link.has_room() { context.shared.outbox.lock(Outbox::take) } else { None };
            let deserted = context.shared.device.lock(|device| device.deserted());
            let mut ask = |request: &Request, stored: &mut Stored, around: &Surroundings| {
                let device = &mut context.shared.device;
                let answer = device.lock(|device| {
                    let answer = device.answer(request, around);
                    // Before the next tick.
                    if matches!(answer, Answer::SelfTest(_)) {
                        crate::control::test_sensors();
                    }
                    answer
                });
                let answer = match answer {
                    Answer::Recorder => Answer::Reply(stored.recorder.answer(request)),
                    answer => answer,
                };
                let store = &mut stored.settings;
                if let Answer::Protect = answer {
                    return device.lock(|device| (protect(end), device.attached()));
                }
                let change = if let Answer::Change(change) = answer {
                    // Checking and storing take longer than a control period, so the device is not held meanwhile.
                    let wanted = device.lock(|device| *device.wanted(change));
                    let prepared = change.prepare(&wanted, around.least_period, |settings| match store.store(settings) {
                        Err(StoreError::Full) if !Selected::ERASING_STALLS => store.store_erasing(settings),
                        // Nothing moves, and the controller begins anew with other settings: the time for what takes a second.
                        Err(StoreError::Full) => device.lock(|device| {
                            if !device.rests() {
                                return Err(StoreError::Full);
                            }
                            let stored = Selected::stall(|| store.store_erasing(settings));
                            crate::control::forget_time();
                            stored
                        }),
                        stored => stored,
                    });
                    Some((change, prepared))
                } else {
                    None
                };
                device.lock(|device| {
                    let answer = change.map_or(answer, |(change, prepared)| device.install(change, &prepared));
                    if matches!(answer, Answer::Restarted(_)) {
                        integrity::put_in_force(device);
                        crate::control::set_safe_state(device.safe_command());
                        tick::set_period(device.period_counts(Selected::CORE_HZ));
                        // The period begins now: nothing is late.
                        crate::control::forget_time();
                    }
                    (answer, device.attached())
                })
            };
            if deserted {
                context.local.link.desert(&mut ask);
            }
            let mut moved = context.local.link.pump(report, &mut ask);
            moved |= context.local.link.record(|| context.shared.ring.lock(|ring| ring.take()));
            if let Some(recorder) = context.local.link.erasing() {
                moved = true;
                // As with the settings: nothing moves, and between two sectors the control task ticks.
                let rests = context.shared.device.lock(|device| {
                    let rests = device.rests();
                    if rests && Selected::ERASING_STALLS {
                        Selected::stall(|| recorder.erase_sector());
                        crate::control::forget_time();
                    }
                    rests
                });
                match rests {
                    true if Selected::ERASING_STALLS => {}
                    true => recorder.erase_sector(),
                    false => recorder.stop_erasing(),
                }
            }
            // What has come is answered first: a turn takes as long as some frames.
            if moved {
                continue;
            }
            let next = context.local.integrity.turn(&mut |fault| context.shared.device.lock(|device| device.accuse(fault)));
            if next == Next::Audit {
                context.shared.device.lock(|device| {
                    if !integrity::is_in_force(device) {
                        device.accuse(Fault::SettingsDamaged);
                    }
                });
            }
            if next != Next::Turn && context.local.link.may_sleep() {
                cortex_m::asm::wfi();
            }
        }
    }

    /// Protects the flash, with the control task held off.
    fn protect(end: u32) -> Answer {
        let done = Selected::protect(end);
        crate::control::forget_time();
        Answer::Reply(if done { Reply::Done(Done::Stored) } else { Reply::Refused(Refusal::FlashFailed) })
    }
}
