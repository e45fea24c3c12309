//! The bits that shipped scenes come to on every machine: this page, the command, the firmware.

use serde::Serialize;

use sprag_sim::digest::{of_decisions, of_responses};

use crate::closed_loop;
use crate::examples::{EXAMPLES, near_fault};
use crate::run;
use crate::scene::{PageError, PageScene};

/// What the firmware decides and the command computes, checked against both where they are built.
const EXPECTED: &str = include_str!("../../../scenes/digests.csv");

/// A digest as it is computed here, and as it is elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DigestCheck {
    /// Scene and what is looked at.
    pub scene: String,
    /// Here.
    pub computed: String,
    /// Elsewhere.
    pub expected: String,
}

/// Computes all of them.
///
/// # Errors
/// [`PageError`] for a scene that cannot be run.
pub fn digests() -> Result<Vec<DigestCheck>, PageError> {
    let (mut checks, files) = (Vec::new(), [near_fault()?]);
    for line in EXPECTED.lines().skip(1) {
        let [name, decisions, responses] = line.split(',').collect::<Vec<_>>()[..] else { continue };
        let text = EXAMPLES.iter().find(|example| example.name == name).map(|example| example.text);
        let text = text.ok_or_else(|| PageError::Failed(format!("no example {name}")))?;
        let scene = PageScene::new(text, &files)?.scene;
        let ticks = closed_loop::report(&scene, &[])?.ticks;
        let of = |what: &str, computed: u64, expected: &str| DigestCheck {
            scene: format!("{name}, {what}"),
            computed: format!("{computed:016x}"),
            expected: expected.to_owned(),
        };
        checks.push(of("decisions (f32)", of_decisions(&ticks), decisions));
        checks.push(of("responses (f64)", of_responses(&run::responses(&scene)?), responses));
    }
    Ok(checks)
}
