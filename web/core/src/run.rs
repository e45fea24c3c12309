//! Responses of a scene's devices.

use sprag_report::heading::title;
use sprag_report::plot::history_figure;
use sprag_sim::digest::of_responses;
use sprag_sim::history::{History, Sample, write_csv};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::simulation::{DeviceRun, simulate};

use crate::columns::{Column, Columns};
use crate::scene::PageError;

/// Runs every device of a scene: a table of each, the history as CSV and as the figure of `sprag simulate`, and the digest of all samples.
///
/// # Errors
/// [`PageError`] for a motion that cannot be followed.
pub fn run(scene: &Scene) -> Result<Columns, PageError> {
    let runs = responses(scene)?;
    let digest = format!("{:016x}", of_responses(&runs));
    let each = runs.iter().map(response).collect::<Result<_, _>>()?;
    let histories: Vec<History> = runs.into_iter().map(|run| run.history).collect();
    let mut csv = Vec::new();
    write_csv(&histories, &mut csv).map_err(PageError::failed)?;
    let svg = history_figure(title(scene), &histories, scene.file.output.time_axis.into()).map_err(PageError::failed)?;
    Ok(vec![
        ("responses", Column::Each(each)),
        ("csv", Column::Text(String::from_utf8(csv).map_err(PageError::failed)?)),
        ("svg", Column::Text(svg)),
        ("digest", Column::Text(digest)),
    ])
}

/// The runs of every device.
pub fn responses(scene: &Scene) -> Result<Vec<DeviceRun>, PageError> {
    let ground = scene.ground_motions().map_err(PageError::failed)?;
    simulate(scene, &ground, &Interrupt::default()).map_err(PageError::failed)
}

/// A response as a table; its summary is JSON.
pub fn response(run: &DeviceRun) -> Result<Columns, PageError> {
    let samples = &run.history.samples;
    let numbers = |pick: fn(&Sample) -> f64| Column::Numbers(samples.iter().map(pick).collect());
    Ok(vec![
        ("device", Column::Text(run.device.clone())),
        ("summary", Column::Text(serde_json::to_string(run).map_err(PageError::failed)?)),
        ("timeS", numbers(|sample| sample.time_s)),
        ("groundMS2", numbers(|sample| sample.ground_m_s2)),
        ("rotationRad", numbers(|sample| sample.rotation_rad)),
        ("velocityRadS", numbers(|sample| sample.velocity_rad_s)),
        ("accelerationRadS2", numbers(|sample| sample.acceleration_rad_s2)),
        ("firstForceRatio", numbers(|sample| sample.force_ratio[0])),
        ("secondForceRatio", numbers(|sample| sample.force_ratio[1])),
        ("engaged", Column::Codes(samples.iter().map(|sample| sample.engaged).collect())),
        ("impactsS", Column::Numbers(run.history.impacts_s.clone())),
    ])
}
