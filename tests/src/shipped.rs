//! Scenes that ship, with changes: as maps, as runs and as responses.

use std::path::{Path, PathBuf};

use sprag_sim::map::grid::Grid;
use sprag_sim::scene::{Scene, document, overrides, text_of};
use sprag_sim::simulation::DeviceRun;
use sprag_studies::similarity::compare::Response;
use sprag_studies::similarity::groups::{Group, groups};

use crate::scene_text::run;

fn path(scene: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(scene)
}

fn changed(scene: &str, changes: &[&str]) -> Scene {
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    Scene::load(&path(scene), &changes).expect("a scene that ships")
}

/// The grid of a scene that has a map.
pub fn grid(scene: &str, changes: &[&str]) -> Grid {
    let path = path(scene);
    let origin = path.display().to_string();
    let text = text_of(&path).expect("a scene that ships");
    let mut table = document::table(&text, &origin).expect("TOML");
    for change in changes {
        overrides::apply(&mut table, change, &origin).expect("a key");
    }
    let mut scene = Scene::of_table(table.clone(), &origin).expect("a scene");
    scene.folder = path.parent().expect("a folder").to_owned();
    Grid::new(scene, table).expect("axes")
}

/// The runs of a scene, one a device.
pub fn runs(scene: &str, changes: &[&str]) -> Vec<DeviceRun> {
    run(&changed(scene, changes))
}

/// The dimensionless groups of a scene, and θ/α of every device at steps of `step` in p t.
pub fn responses(scene: &str, changes: &[&str], step: f64) -> (Vec<Group>, Vec<Response>) {
    let mut scene = changed(scene, changes);
    scene.file.output.interval_s = Some(step / scene.block.frequency_parameter());
    let responses = run(&scene).iter().map(|run| Response::of(&run.history, step)).collect();
    (groups(&scene).expect("groups"), responses)
}
