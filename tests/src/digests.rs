//! The bits that shipped scenes come to on every machine, as `scenes/digests.csv` has them.

use std::path::Path;

/// Digests of a scene: of the controller's decisions and of the devices' responses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Digests {
    /// Name of the scene's file, without its ending.
    pub scene: String,
    /// f32, by the firmware too.
    pub decisions: u64,
    /// f64.
    pub responses: u64,
}

/// All of them.
pub fn digests() -> Vec<Digests> {
    let text =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/digests.csv")).expect("a file that ships");
    let number = |digits: &str| u64::from_str_radix(digits, 16).expect("16 hexadecimal digits");
    let row = |line: &str| {
        let [scene, decisions, responses] = line.split(',').collect::<Vec<_>>()[..] else { panic!("three fields: {line}") };
        Digests { scene: scene.to_owned(), decisions: number(decisions), responses: number(responses) }
    };
    text.lines().skip(1).map(row).collect()
}

/// Those of one scene.
pub fn of_scene(name: &str) -> Digests {
    digests().into_iter().find(|digests| digests.scene == name).expect("a scene with digests")
}
