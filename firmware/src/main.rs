//! The firmware of Sprag: the shared controller on a board.
//!
//! Two tasks. Control runs at every period of the controller, above all else: sensors, tick, coils, watchdog. The link runs in what time is
//! left: frames, answers, logs. Everything numeric is in `sprag_shared`; every pin is behind [`board::Board`].
#![no_std]
#![no_main]

mod board;
mod control;
mod identity;
mod last_words;
mod link;
mod log;
mod memory;
mod stack;
mod tick;

#[rtic::app(device = crate::board::chip)]
mod app {
    use crate::board::{Board as _, Flash, Selected};
    use crate::control::Control;
    use crate::link::{Link, Outbox};
    use crate::log::info;
    use crate::{last_words, memory, stack, tick};
    use core::mem::MaybeUninit;
    use sprag_shared::control::controller::Controller;
    use sprag_shared::device::retained::Retained;
    use sprag_shared::device::{Answer, Device};
    use sprag_shared::settings::Settings;
    use sprag_shared::settings::store::{Store, StoreError};

    #[shared]
    struct Shared {
        device: &'static mut Device,
        outbox: Outbox,
    }

    #[local]
    struct Local {
        control: Control,
        link: Link,
    }

    #[init(local = [device: MaybeUninit<Device> = MaybeUninit::uninit(), store: MaybeUninit<Store<Flash>> = MaybeUninit::uninit()])]
    fn init(context: init::Context) -> (Shared, Local) {
        let (mut board, cause) = Selected::wake(context.core, context.device);
        stack::paint();
        let words = last_words::take(cause);
        let (store, settings) = Store::open(board.flash());
        let store = context.local.store.write(store);
        let kept = if words.cause.keeps_memory() { memory::load() } else { None };
        let (device, stored) = start(context.local.device, settings.as_ref(), kept.as_ref());
        crate::control::set_safe_state(device.safe_command());
        let counts = kept.filter(|_| device.resumes()).map(|kept| kept.counts);
        let parts = board.begin(device.settings(), counts);
        tick::set_period(device.period_counts(Selected::CORE_HZ));
        info!("started: {}, resumes {}, settings stored {}", words.cause, device.resumes(), stored);
        let link = Link::new(parts.line, store, words, device, stored);
        let control = Control::new(parts.sensors, parts.coils, parts.watchdog, parts.light);
        (Shared { device, outbox: Outbox::new() }, Local { control, link })
    }

    /// The device with the settings found in flash, or with the defaults; whether they were found.
    #[inline(never)]
    fn start(
        place: &'static mut MaybeUninit<Device>,
        settings: Option<&Settings>,
        kept: Option<&Retained>,
    ) -> (&'static mut Device, bool) {
        let stored = settings.and_then(|settings| Some((*settings, Controller::of(settings).ok()?)));
        let found = stored.is_some();
        let (settings, controller) = stored.unwrap_or_else(|| {
            let settings = Settings::default();
            // The tests make a controller of the defaults.
            let Ok(controller) = Controller::of(&settings) else { last_words::stop() };
            (settings, controller)
        });
        (put(place, &controller, &settings, kept), found)
    }

    /// Makes the device in its place. By itself, so that the compiler sees that nobody else looks there, and makes no copy on the stack.
    #[inline(never)]
    fn put<'a>(
        place: &'a mut MaybeUninit<Device>,
        controller: &Controller,
        settings: &Settings,
        kept: Option<&Retained>,
    ) -> &'a mut Device {
        place.write(Device::new(controller, settings, kept))
    }

    #[task(binds = SysTick, priority = 3, local = [control], shared = [device, outbox])]
    fn control(context: control::Context<'_>) {
        let timer = tick::by_timer();
        let control = context.local.control;
        (context.shared.device, context.shared.outbox)
            .lock(|device, outbox| crate::control::control_tick(control, device, outbox, timer));
    }

    #[idle(local = [link], shared = [device, outbox])]
    fn idle(mut context: idle::Context<'_>) -> ! {
        context.local.link.mend();
        loop {
            let report = if context.local.link.has_room() { context.shared.outbox.lock(Outbox::take) } else { None };
            let moved = context.local.link.pump(report, |request, store, around| {
                // Programming the flash takes longer than a control period, so the device is not held meanwhile.
                let answer = context.shared.device.lock(|device| device.answer(request, around));
                let stored = (answer == Answer::Store).then(|| {
                    let draft = context.shared.device.lock(|device| *device.draft());
                    match store.store(&draft) {
                        // Nothing moves, and the controller begins anew with other settings: the time for what takes a second.
                        Err(StoreError::Full) => context.shared.device.lock(|_| {
                            let stored = Selected::stall(|| store.store_erasing(&draft));
                            crate::control::forget_time();
                            stored
                        }),
                        stored => stored,
                    }
                });
                context.shared.device.lock(|device| {
                    let answer = stored.map_or(answer, |result| device.stored(result));
                    if matches!(answer, Answer::Restarted(_)) {
                        crate::control::set_safe_state(device.safe_command());
                        tick::set_period(device.period_counts(Selected::CORE_HZ));
                    }
                    (answer, device.attached())
                })
            });
            if !moved && context.local.link.may_sleep() {
                cortex_m::asm::wfi();
            }
        }
    }
}
