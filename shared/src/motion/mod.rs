//! Event-driven integration of a rocking block.
//!
//! [`ideal`]: of devices whose clutch has no memory; [`hybrid`]: of devices with a memory, as a hybrid automaton; [`sliding`]: of a block
//! without a device whose base may slide; [`rest`]: how free rocking ends; [`step_end`]: time stepping without event location, as the yardstick of accuracy and cost. [`state`], [`observer`],
//! [`device_snapshot`]: what all share.
//! The room imports `math`, `equation`, `ground`, `drivetrain` and `method`; `ideal`, `hybrid` and `sliding` also `structure`.

pub mod device_snapshot;
pub mod hybrid;
pub mod ideal;
pub mod observer;
pub mod rest;
pub mod sliding;
pub mod state;
pub mod step_end;
