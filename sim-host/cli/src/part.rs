//! Parts of the command itself that it may be built without.

use sprag_report::part::Part;

/// Boards on serial ports.
pub const SERIAL: Part = Part::new("serial", cfg!(feature = "serial"));
/// Logs of the firmware.
pub const DEFMT: Part = Part::new("defmt", cfg!(feature = "defmt"));
