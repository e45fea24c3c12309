//! One scene, every device: histories and what they amount to.

#[cfg_attr(not(feature = "effects"), path = "unasked.rs")]
mod asked;
#[cfg(feature = "effects")]
mod coils;
#[cfg(feature = "effects")]
mod compliant;
#[cfg_attr(not(feature = "effects"), allow(dead_code, reason = "only effects demand anything"))]
pub mod demand;
#[cfg(all(test, feature = "effects"))]
mod demand_tests;
pub mod device_run;
pub mod drive;
pub mod energy;
#[cfg(all(test, feature = "effects"))]
mod error_tests;
#[cfg(all(test, feature = "effects"))]
mod friction_tests;
mod ideal;
#[cfg_attr(not(feature = "effects"), path = "no_machine.rs")]
mod machine;
pub mod recorder;
pub mod run;
pub mod scatter;
#[cfg(feature = "effects")]
mod sliding;
pub mod sliding_report;
#[cfg(feature = "effects")]
pub(crate) mod stable_step;
pub mod step_end;
#[cfg(all(test, feature = "effects"))]
mod support_tests;
pub mod watchers;

pub use device_run::{DeviceRun, ErrorReport};
pub use run::{RunError, simulate, simulate_for_study};

/// The runs of the scene in `text`, one a device.
#[cfg(all(test, feature = "effects"))]
fn runs_of(text: &str) -> Vec<DeviceRun> {
    let scene = crate::scene::Scene::parse(text, "scene").unwrap();
    simulate(&scene, &scene.ground_motions().unwrap(), &crate::interrupt::Interrupt::default()).unwrap()
}
