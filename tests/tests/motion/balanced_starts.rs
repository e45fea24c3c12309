//! Blocks let go exactly where nothing moves them: on the tip, under ground that is only about to move.

use sprag_sim_host::interrupt::Interrupt;
use sprag_sim_host::outcome::Outcome;
use sprag_sim_host::scene::Scene;
use sprag_sim_host::simulation::{DeviceRun, simulate};

const DEVICES: &str = r#"
[[device]]
kind = "none"
[[device]]
kind = "inerter"
mass_ratio = 0.5
[[device]]
kind = "clutched-pair"
mass_ratio = 0.5
[[device]]
kind = "clutched-pair"
name = "consistent pair"
mass_ratio = 0.5
kinematics = "consistent"
[[device]]
kind = "clutched-pair"
name = "rigid pair"
mass_ratio = 0.5
engagement = "rigid"
"#;

fn runs(geometry: &str, rotation: f64, motion: &str, scale: f64, accuracy: &str) -> Vec<DeviceRun> {
    let text = format!(
        "[block]\nfrequency_parameter_1_s = 1.0\nslenderness_deg = 30.0\ngeometry = \"{geometry}\"\n\
         initial_rotation_ratio = {rotation:?}\n{DEVICES}[[ground]]\nmotion = \"{motion}\"\namplitude_ratio = 0.5\n\
         frequency_ratio = 1.0\nscale = {scale:?}\n[accuracy]\n{accuracy}\n"
    );
    let scene = Scene::parse(&text, "scene.toml").unwrap();
    simulate(&scene, &scene.ground_motions().unwrap(), &Interrupt::default()).unwrap()
}

/// θ̈ has the sign of −ü_g there, so the first push decides: over, or back to the base. A sine's is 0 at the start, too.
#[test]
fn the_first_push_decides_for_a_block_on_its_tip() {
    for geometry in ["full", "slender"] {
        for motion in ["sine", "cosine", "half-sine"] {
            for accuracy in ["", "method = \"runge-kutta-4\"\nstep_ratio = 0.002"] {
                for (rotation, scale) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                    for run in runs(geometry, rotation, motion, scale, accuracy) {
                        let over = run.outcome == Outcome::OverturnedWithoutImpact;
                        let what = format!("{geometry} {}: {rotation} under {scale} {motion}, {accuracy:?}", run.device);
                        assert_eq!(over, rotation * scale < 0.0, "{what}: {}", run.outcome);
                        assert!(over || run.first_impact_time_s.is_some(), "{what}");
                    }
                }
            }
        }
    }
}
