//! Registers, and what is written to them, each as address and value.

/// In an address: to be read.
pub const READ: u8 = 0x80;

/// WHO_AM_I of bank 0.
pub const IDENTITY: u8 = 0x75;
/// What it says.
pub const IDENTITY_OF_PART: u8 = 0x47;

/// ACCEL_DATA_X1, the first of the registers that hold a reading, up to INT_STATUS.
pub const FIRST_DATA: u8 = 0x1F;
/// Of INT_STATUS: DATA_RDY_INT, cleared by reading it.
pub const STATUS_DATA_READY: u8 = 1 << 3;
/// Of INT_STATUS.
pub const STATUS_RESERVED: u8 = 1 << 7;

/// REG_BANK_SEL, in every bank.
const BANK: u8 = 0x76;

/// Selects bank 0 and sets SOFT_RESET_CONFIG of DEVICE_CONFIG.
pub const RESET: [[u8; 2]; 2] = [[BANK, 0], [0x11, 0x01]];

/// DELT, DELTSQR and BITSHIFT of the anti-alias filters for 536 Hz.
const FILTER: (u8, u16, u8) = (12, 144, 8);

/// What is written after a reset, a tick each.
pub const SETUP: [[u8; 2]; 20] = [
    // INTF_CONFIG0: big-endian, I²C off.
    [0x4C, 0x33],
    // INTF_CONFIG1: clock from the PLL; the undocumented change of full scale at run time off.
    [0x4D, 0x51],
    // INT_CONFIG: INT1 push-pull, active high, pulsed. The pin may stay open.
    [0x14, 0x03],
    // INT_CONFIG1: INT_TPULSE_DURATION and INT_TDEASSERT_DISABLE, as is asked for from 4 kHz on; INT_ASYNC_RESET off.
    [0x64, 0x60],
    // INT_CONFIG0: data-ready is cleared by reading the status.
    [0x63, 0x00],
    // INT_SOURCE0: data-ready.
    [0x65, 0x08],
    // GYRO_CONFIG0: ±500 °/s, 8 kHz.
    [0x4F, 2 << 5 | 3],
    // ACCEL_CONFIG0: ±8 g, 8 kHz.
    [0x50, 1 << 5 | 3],
    // GYRO_ACCEL_CONFIG0: user-interface filters at half the data rate.
    [0x52, 0x00],
    [BANK, 1],
    // GYRO_CONFIG_STATIC2: notch and anti-alias filter on.
    [0x0B, 0xA0],
    // GYRO_CONFIG_STATIC3 to 5: the anti-alias filter.
    [0x0C, FILTER.0],
    [0x0D, FILTER.1 as u8],
    [0x0E, FILTER.2 << 4 | (FILTER.1 >> 8) as u8],
    [BANK, 2],
    // ACCEL_CONFIG_STATIC2 to 4: the anti-alias filter on, and which.
    [0x03, FILTER.0 << 1],
    [0x04, FILTER.1 as u8],
    [0x05, FILTER.2 << 4 | (FILTER.1 >> 8) as u8],
    [BANK, 0],
    // PWR_MGMT0: both sensors in low-noise mode. Last, for no register may be written for 200 µs afterwards.
    [0x4E, 0x0F],
];
