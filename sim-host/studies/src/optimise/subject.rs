//! One specimen of a design, ready to be shaken: a scene, and the controller that drives its clutches where there is one.

use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::simulation::simulate_for_study;

use super::response::Response;
use super::specimen::Specimen;

/// A specimen of a design.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The block with the device alone.
    scene: Scene,
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
                let suite = controller.suite(&scene.origin).map_err(|error| error.to_string())?;
                Some(Controlled { controller, suite, seed: specimen.sensors })
            }
            None => None,
        };
        Ok(Subject {
            scene,
            #[cfg(feature = "effects")]
            controlled,
        })
    }

    /// What it does under `ground`.
    ///
    /// # Errors
    /// In words why nobody knows.
    pub fn respond(&self, ground: &GroundMotions, interrupt: &Interrupt) -> Result<Response, String> {
        #[cfg(feature = "effects")]
        if let Some(Controlled { controller, suite, seed }) = &self.controlled {
            let task = sprag_sim::closed_loop::LoopTask {
                scene: &self.scene,
                ground,
                index: 0,
                controller,
                suite,
                seed: *seed,
                closeness: self.scene.file.accuracy.level.map(sprag_sim::accuracy::Closeness::from),
                interrupt,
            };
            return task.measured().map(|run| Response::of(&run)).map_err(|error| error.to_string());
        }
        let runs = simulate_for_study(&self.scene, ground, interrupt).map_err(|error| error.to_string())?;
        runs.first().map(Response::of).ok_or_else(|| "no device".to_owned())
    }
}
