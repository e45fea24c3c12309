//! Blocks let go exactly where nothing moves them: on the tip, under ground that is only about to move.

use sprag_shared::observers::outcome::Outcome;
use sprag_sim::simulation::DeviceRun;
use sprag_tests::scene_text::{self, IDEAL_DEVICES, RIGID_PAIR};

const CONSISTENT_PAIR: &str = r#"
[[device]]
kind = "clutched-pair"
name = "consistent pair"
mass_ratio = 0.5
kinematics = "consistent"
"#;

fn runs(geometry: &str, rotation: f64, motion: &str, scale: f64, accuracy: &str) -> Vec<DeviceRun> {
    scene_text::runs(&format!(
        "[block]\nfrequency_parameter_1_s = 1.0\nslenderness_deg = 30.0\ngeometry = \"{geometry}\"\n\
         initial_rotation_ratio = {rotation:?}\n{IDEAL_DEVICES}{CONSISTENT_PAIR}{RIGID_PAIR}[[ground]]\nmotion = \"{motion}\"\namplitude_ratio = 0.5\n\
         frequency_ratio = 1.0\nscale = {scale:?}\n[accuracy]\n{accuracy}\n"
    ))
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
