//! Registers, and what is written to them.

/// In an address: to be read.
pub const READ: u8 = 0x80;

/// WHO_AM_I of bank 0.
pub const IDENTITY: u8 = 0x75;
/// What it says.
pub const IDENTITY_OF_PART: u8 = 0x47;

/// TEMP_DATA1 and 0: 132.48 counts a kelvin from 25 °C on.
pub const TEMPERATURE: u8 = 0x1D;

/// ACCEL_DATA_X1, the first of the registers that hold a reading, up to INT_STATUS.
pub const FIRST_DATA: u8 = 0x1F;
/// Of INT_STATUS: DATA_RDY_INT, cleared by reading it.
pub const STATUS_DATA_READY: u8 = 1 << 3;
/// Of INT_STATUS.
pub const STATUS_RESERVED: u8 = 1 << 7;

/// REG_BANK_SEL, in every bank.
pub const BANK: u8 = 0x76;

/// DEVICE_CONFIG of bank 0, with SOFT_RESET_CONFIG set.
pub const RESET: (u8, u8) = (0x11, 0x01);

/// SELF_TEST_CONFIG of bank 0.
pub const SELF_TEST: u8 = 0x70;
/// Of it: the three axes of the gyroscope.
pub const TEST_GYROSCOPE: u8 = 0x07;
/// Of it: those of the accelerometer, and the supply of their test.
pub const TEST_ACCELEROMETER: u8 = 0x78;
/// Bank and first address of what the factory has found of the accelerometer's three axes (XA_ST_DATA), …
pub const ACCELEROMETER_CODES: (u8, u8) = (2, 0x3B);
/// … and of the gyroscope's (XG_ST_DATA).
pub const GYROSCOPE_CODES: (u8, u8) = (1, 0x5F);

/// FS_SEL of the gyroscope: ±500 °/s.
pub const GYROSCOPE_RANGE: u8 = 2;
/// FS_SEL of the accelerometer: ±8 g.
pub const ACCELEROMETER_RANGE: u8 = 1;

/// DELT, DELTSQR and BITSHIFT of the anti-alias filters for 536 Hz.
const FILTER: (u8, u16, u8) = (12, 144, 8);

/// What one register shall hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its bank.
    pub bank: u8,
    /// Its address there.
    pub address: u8,
    /// What is written.
    pub value: u8,
    /// The bits that are documented to read as they were written; none where reserved ones are set on the advice of others.
    pub kept: u8,
}

const fn entry(bank: u8, address: u8, value: u8, kept: u8) -> Entry {
    Entry { bank, address, value, kept }
}

/// The configuration, in the order in which it is written after a reset, a tick each.
pub const CONFIGURATION: [Entry; 18] = [
    // SELF_TEST_CONFIG: off. A processor that was reset in the middle of a test finds it on.
    entry(0, SELF_TEST, 0x00, 0x7F),
    // INTF_CONFIG0: big-endian, I²C off.
    entry(0, 0x4C, 0x33, 0),
    // INTF_CONFIG1: clock from the PLL; the undocumented change of full scale at run time off.
    entry(0, 0x4D, 0x51, 0),
    // INT_CONFIG: INT1 push-pull, active high, pulsed. The pin may stay open.
    entry(0, 0x14, 0x03, 0x3F),
    // INT_CONFIG1: INT_TPULSE_DURATION and INT_TDEASSERT_DISABLE, as is asked for from 4 kHz on; INT_ASYNC_RESET off.
    entry(0, 0x64, 0x60, 0x70),
    // INT_CONFIG0: data-ready is cleared by reading the status.
    entry(0, 0x63, 0x00, 0x3F),
    // INT_SOURCE0: data-ready.
    entry(0, 0x65, 0x08, 0x7F),
    // GYRO_CONFIG0: ±500 °/s, 8 kHz.
    entry(0, 0x4F, GYROSCOPE_RANGE << 5 | 3, 0xEF),
    // ACCEL_CONFIG0: ±8 g, 8 kHz.
    entry(0, 0x50, ACCELEROMETER_RANGE << 5 | 3, 0xEF),
    // GYRO_ACCEL_CONFIG0: user-interface filters at half the data rate.
    entry(0, 0x52, 0x00, 0xFF),
    // GYRO_CONFIG_STATIC2: notch and anti-alias filter on.
    entry(1, 0x0B, 0xA0, 0x03),
    // GYRO_CONFIG_STATIC3 to 5: the anti-alias filter.
    entry(1, 0x0C, FILTER.0, 0x3F),
    entry(1, 0x0D, FILTER.1 as u8, 0xFF),
    entry(1, 0x0E, FILTER.2 << 4 | (FILTER.1 >> 8) as u8, 0xFF),
    // ACCEL_CONFIG_STATIC2 to 4: the anti-alias filter on, and which.
    entry(2, 0x03, FILTER.0 << 1, 0x7F),
    entry(2, 0x04, FILTER.1 as u8, 0xFF),
    entry(2, 0x05, FILTER.2 << 4 | (FILTER.1 >> 8) as u8, 0xFF),
    // PWR_MGMT0: both sensors in low-noise mode. Last, for no register may be written for 200 µs afterwards.
    entry(0, 0x4E, 0x0F, 0x3F),
];
