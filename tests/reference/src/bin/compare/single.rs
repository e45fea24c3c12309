//! Given scenes: what this program finds, how much its steps matter, and how far the other is away.

use std::path::{Path, PathBuf};

use sprag_reference::compare::{Other, compare as difference};
use sprag_reference::effort::Effort;
use sprag_reference::method::Method;
use sprag_reference::scene::Scene;
use sprag_reference::simulate::run_with;

use crate::sprag::simulate;

/// Reports every device of a scene; of its only one also beside `sprag`.
///
/// # Errors
/// What this program says when it cannot run the scene.
pub fn compare(sprag: &Path, path: &Path) -> Result<(), String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let parsed = Scene::parse(&text)?;
    let folder = path.parent().map(PathBuf::from).unwrap_or_default();
    let slenderness = parsed.block.slenderness_deg.to_radians();
    let mut effort = Effort::default();
    if let Some(resolution) = std::env::var("RESOLUTION").ok().and_then(|text| text.parse().ok()) {
        effort.resolution = resolution;
    }
    for index in 0..parsed.device.len() {
        let ours = run_with(&parsed, index, &folder, effort)?;
        let finer = run_with(&parsed, index, &folder, effort.finer())?;
        let (peak, residual) = (ours.peak / slenderness, ours.ledger.shares().residual);
        let name = path.display();
        println!("{name}: device {index}: {}, peak {peak:.9} α, {} impacts, residual {residual:.1e}", ours.outcome, ours.impacts);
        println!("  half the step: {:?}", difference(&ours, &Other::from(&finer), slenderness));
        println!("  {:?}", ours.ledger.shares());
        if std::env::var_os("EVENTS").is_some() {
            ours.events.iter().for_each(|(time, guard)| println!("  {time:.15} {guard:?}"));
        }
        if std::env::var_os("HISTORY").is_some() {
            ours.samples.iter().for_each(|[time, rotation, velocity]| println!("{time},{rotation},{velocity}"));
        }
        if parsed.device.len() == 1 && parsed.output.interval_s.is_some() {
            for method in Method::ALL {
                match simulate(sprag, path, &folder.join("out"), method, ours.step) {
                    Ok(theirs) => {
                        let apart = difference(&ours, &theirs, slenderness);
                        println!("  {}: {}, {apart:?}", method.name(), theirs.outcome);
                    }
                    Err(error) => println!("  {}: {error}", method.name()),
                }
            }
        }
    }
    Ok(())
}
