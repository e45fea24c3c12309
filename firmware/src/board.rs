//! What a board must offer: the one seam between the application and the hardware.
//!
//! To port the firmware, write one module with a type that is a [`Board`] and select it below; what boards have in common is in `parts`.
//! `docs/porting.md` has the steps.

#[cfg(any(feature = "board-f405", feature = "board-g474"))]
pub mod parts;

#[cfg(feature = "board-f405")]
pub mod f405;
#[cfg(feature = "board-f405")]
pub use f405::F405 as Selected;

#[cfg(feature = "board-g474")]
pub mod g474;
#[cfg(feature = "board-g474")]
pub use g474::G474 as Selected;

#[cfg(feature = "board-qemu")]
pub mod qemu;
#[cfg(feature = "board-qemu")]
pub use qemu::Qemu as Selected;

#[cfg(not(any(feature = "board-f405", feature = "board-g474", feature = "board-qemu")))]
compile_error!("select a board: --features board-f405, --features board-g474 or --features board-qemu");
#[cfg(any(
    all(feature = "board-f405", feature = "board-g474"),
    all(feature = "board-f405", feature = "board-qemu"),
    all(feature = "board-g474", feature = "board-qemu")
))]
compile_error!("select one board only: --no-default-features --features board-qemu");

use embedded_storage::nor_flash::NorFlash;
use sprag_shared::control::monitor::coil::CoilReading;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::device::clock_check::ClockCheck;
use sprag_shared::device::light::Shown;
use sprag_shared::link::Protection;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::settings::Settings;

/// The register library of the selected board's chip.
#[cfg(feature = "board-f405")]
pub use f405::chip;
#[cfg(feature = "board-g474")]
pub use g474::chip;
#[cfg(feature = "board-qemu")]
pub use qemu::chip;

/// The flash of the selected board.
pub type Flash = <Selected as Board>::Flash;

/// The flash for recordings of the selected board.
pub type Recordings = <Selected as Board>::Recordings;

/// A board. Its parts go to the tasks that own them.
pub trait Board: Sized {
    /// Its name, as the link reports it.
    const NAME: &'static str;

    /// Rate of the counter that [`Board::now`] reads, 1/s.
    const COUNTER_HZ: u32;

    /// Rate of the processor's clock, by which its SysTick counts, 1/s.
    const CORE_HZ: u32;

    /// Shortest period of the controller that leaves time for the link beside its ticks, s. Settings with a shorter one are refused.
    const LEAST_PERIOD: f32;

    /// Whether erasing the flash stops the processor, for seconds. Recordings of earthquakes are kept until somebody asks for them to be
    /// erased then; otherwise the oldest page makes room for the newest.
    const ERASING_STALLS: bool;

    /// For how long programming a word of the recordings' flash may stop the processor, µs.
    const PROGRAMMING_STALL: u32;

    /// Every peripheral of the chip, as its register library hands them out.
    type Chip;
    /// Sensors.
    type Sensors: Sensors;
    /// Clutch coils.
    type Coils: Coils;
    /// Independent watchdog.
    type Watchdog: Watchdog;
    /// Serial link.
    type Line: Line;
    /// Three sectors: two for the settings, one for which firmware has run.
    type Flash: NorFlash;
    /// The sectors for recordings of earthquakes, which are whole pages of [`sprag_shared::device::recorder`].
    type Recordings: NorFlash;
    /// Status light.
    type Light: Light;

    /// Reads why the chip was reset, clears the chip's memory of it, and starts the clocks.
    fn wake(core: cortex_m::Peripherals, chip: Self::Chip) -> (Self, Cause);

    /// The flash that holds the settings. To be called once.
    fn flash(&mut self) -> Self::Flash;

    /// The flash that recordings of earthquakes go to. To be called once.
    fn recordings(&mut self) -> Self::Recordings;

    /// Starts sensors, coils (released) and link. The encoder continues from `counts`, as they were last read before a reset, and counts
    /// what the rack has moved since, if the board can; without them it starts at 0. The watchdog is running when this returns.
    fn begin(self, settings: &Settings, counts: Option<i32>) -> Parts<Self>;

    /// Does `work` for which the processor may stall for seconds, with the control task held off: the watchdog waits, the coils stay as
    /// they are. Only where [erasing stalls](Board::ERASING_STALLS).
    fn stall<T>(work: impl FnOnce() -> T) -> T {
        work()
    }

    /// A counter that never stops and wraps at 2³².
    fn now() -> u32;

    /// A control period has begun; for boards that want to know.
    #[inline(always)]
    fn ticked() {}

    /// The commissioning jumper is closed: somebody stands at the board. One without a jumper has it closed.
    fn jumper_is_closed() -> bool {
        true
    }

    /// CRC-32/MPEG-2 of words, each from its most significant bit on, continuing from `before`, which at first is all ones.
    fn crc(before: u32, words: &[u32]) -> u32;

    /// The last edge of an oscillator that has nothing to do with the crystal, since it was asked for one.
    fn slow_edge() -> Edge {
        Edge::None
    }

    /// Whether something beside the processor reads or writes this word of the memory.
    fn moves_by_itself(_place: u32) -> bool {
        false
    }

    /// What the flash is protected against, with a program that ends before `end`.
    fn protection(_end: u32) -> Protection {
        Protection::default()
    }

    /// Protects it, from the next power-on on. Called with the control task held off; whether it has been done.
    fn protect(_end: u32) -> bool {
        false
    }

    /// Puts the coils in the state `engaged` at once, whatever else holds them: called from panics and faults, with interrupts off.
    fn force_coils(engaged: [bool; 2]);
}

/// What a slow oscillator did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Nothing.
    None,
    /// An edge came, when the [counter](Board::now) was at this.
    At(u32),
    /// More than one came.
    Missed,
}

/// What [`Board::begin`] hands out.
pub struct Parts<B: Board> {
    /// To the control task.
    pub sensors: B::Sensors,
    /// To the control task.
    pub coils: B::Coils,
    /// To the control task.
    pub watchdog: B::Watchdog,
    /// To the link.
    pub line: B::Line,
    /// To the control task.
    pub light: B::Light,
    /// What the edges of the [slow oscillator](Board::slow_edge) are held against.
    pub clock: Option<ClockCheck>,
}

/// The sensors of a board.
pub trait Sensors {
    /// Reads what is new into `sample`, in SI units and the axes of [`Sample`], counting up the numbers of what was read: a sensor that
    /// does not answer keeps its number, and the supervisor notices. Takes a bounded time, a small part of a control period. Leaves
    /// `sample.engaged` alone.
    fn read(&mut self, sample: &mut Sample);

    /// Has the parts test themselves, with a tick every `period` s: they give no readings meanwhile, which must end within `patience` s.
    /// Only where nothing relies on readings.
    fn test(&mut self, _period: f32, _patience: f32) {}

    /// What the test of a part has come to, if it has failed, or could not be made. To be asked now and then: a part at a time.
    fn untrue(&mut self) -> Option<Fault> {
        None
    }

    /// Temperature at the block, °C, if it is known.
    fn temperature(&self) -> Option<f32> {
        None
    }
}

/// The coils of the two clutches.
pub trait Coils {
    /// What the coils' currents say.
    fn read(&mut self) -> [CoilReading; 2];

    /// Carries out a command, once a control period: pulls in with the full current, then holds with less; where it is `tested`, tries
    /// each switch alone first.
    fn drive(&mut self, command: [bool; 2], tested: bool);

    /// Ticks come every `period` s from now on.
    fn set_period(&mut self, _period: f32) {}

    /// The coils' supply, V, if it is measured.
    fn supply(&self) -> Option<f32> {
        None
    }
}

/// The watchdog: resets the chip unless fed in time.
pub trait Watchdog {
    /// Only a control task that met its deadline may call this.
    fn feed(&mut self);
}

/// The serial link. Bytes are moved by interrupt or DMA into buffers that both calls only copy from and to, so neither ever waits,
/// except in the emulator, where time stands while it does.
pub trait Line {
    /// Copies bytes that have come into `bytes` and says how many.
    fn read(&mut self, bytes: &mut [u8]) -> usize;

    /// Takes as many of `bytes` as there is room for and says how many.
    fn write(&mut self, bytes: &[u8]) -> usize;
}

/// The status light.
pub trait Light {
    /// Shows a state in a slot of the light's time ([`sprag_shared::device::light`]). To be called once a control period.
    fn show(&mut self, shown: Shown, slot: u32);
}
