//! One specimen of a design, ready to be shaken: a scene, and the controller that drives its clutches where there is one.

use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::side_by_side::{self, Followed, followed};
use sprag_sim::simulation::simulate_for_study;

use super::motion::Motion;
use super::response::Response;
use super::specimen::Specimen;

/// A specimen of a design.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The block with the device alone.
    block: side_by_side::Subject,
    #[cfg(feature = "effects")]
    controlled: Option<Controlled>,
}

/// What closes the loop.
#[cfg(feature = "effects")]
#[derive(Clone, Debug)]
struct Controlled {
    controller: sprag_sim::scene::controller::ControllerTable,
    suite: sprag_sim::sensor::Suite,
    seed: u64,
}

impl Subject {
    /// `specimen` of the design whose scene is `scene`; its controller is that of the scene where the device is one that it drives.
    ///
    /// # Errors
    /// In words why there is none.
    pub fn new(scene: Scene, driven: bool, specimen: &Specimen) -> Result<Subject, String> {
        let scene = specimen.of(scene).map_err(|error| error.to_string())?;
        #[cfg(not(feature = "effects"))]
        if driven {
            return Err("this program was built without effects".to_owned());
        }
        #[cfg(feature = "effects")]
        let controlled = match scene.file.controller.clone().filter(|_| driven) {
            Some(mut controller) => {
                controller.belief = specimen.belief(controller.belief);
                let suite = scene.loop_sensors(&controller, &[0]).map_err(|error| error.to_string())?;
                Some(Controlled { controller, suite, seed: specimen.sensors })
            }
            None => None,
        };
        Ok(Subject {
            block: side_by_side::Subject::watched(scene),
            #[cfg(feature = "effects")]
            controlled,
        })
    }

    /// What it does under each of `motions` where lanes can know.
    pub fn in_lanes(&self, motions: &[Motion<'_>]) -> Vec<Option<Response>> {
        #[cfg(feature = "effects")]
        if self.controlled.is_some() {
            return vec![None; motions.len()];
        }
        let runs: Vec<_> = motions.iter().map(|motion| (&self.block, motion.in_lanes())).collect();
        let response = |found: Option<Followed>| Response::of_followed(&found?, &self.block.scene.block);
        followed(&runs).into_iter().map(response).collect()
    }

    /// What it does under `ground`, by the core.
    ///
    /// # Errors
    /// In words why nobody knows.
    pub fn respond(&self, ground: &GroundMotions, interrupt: &Interrupt) -> Result<Response, String> {
        #[cfg(feature = "effects")]
        if let Some(Controlled { controller, suite, seed }) = &self.controlled {
            let task = sprag_sim::closed_loop::LoopTask::of(&self.block.scene, ground, (controller, suite, *seed), interrupt);
            return task.measured().map(|run| Response::of(&run)).map_err(|error| error.to_string());
        }
        let runs = simulate_for_study(&self.block.scene, ground, interrupt).map_err(|error| error.to_string())?;
        runs.first().map(Response::of).ok_or_else(|| "no device".to_owned())
    }
}
