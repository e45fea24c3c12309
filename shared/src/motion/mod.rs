//! Event-driven integration of a rocking block.
//!
//! [`ideal`]: of devices whose clutch has no memory; [`hybrid`]: of devices with a memory, as a hybrid automaton; [`sliding`]: of a block
//! without a device whose base may slide; [`compliant`]: of a block on a compliant foundation; [`rest`]: how free rocking ends;
//! [`step_end`]: time stepping without event location, as the yardstick of accuracy and cost. [`state`], [`observer`], [`ground_pair`],
//! [`device_snapshot`]: what all share. The room imports `math`, `equation`, `ground`, `drivetrain` and `method`; `ideal`, `hybrid`,
//! `sliding` and `compliant` also `structure`.

pub mod compliant;
pub mod device_snapshot;
pub mod ground_pair;
pub mod hybrid;
pub mod ideal;
pub mod observer;
pub mod rest;
pub mod sliding;
pub mod state;
pub mod step_end;
mod stepped;
