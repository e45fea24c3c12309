//! Beyond Eq. 10: what each law overturns, in the ideal model and with the clutch and sensors as they are.

use super::bench::{Conditions, LoopResult, Motion, StudyError, Variant, each, grid, run_loop};
use super::report::{Report, Table};
use crate::plot::{Cell, CellMap, CellMaps, Class, Scale, cell_map_figure};
use crate::progress::Progress;
use crate::scene::controller::LawName;

/// Cells along each axis.
const CELLS: usize = 32;
/// ω/p.
const FREQUENCIES: (f64, f64) = (0.2, 8.0);
/// a/(g tan α).
const AMPLITUDES: (f64, f64) = (1.0, 10.0);

/// What a law works with.
const SETTINGS: [(&str, &[&str]); 3] = [
    ("ideal model", &["controller.rate_hz=1000.0", "controller.shock_s=0.0", "controller.hysteresis=0.0"]),
    (
        "real clutch, wheels coast",
        &[
            "device.0.engagement=\"rigid\"",
            "device.0.flywheel.viscous_rate_1_s=0.05",
            "device.0.actuation.engagement_delay_s=0.002",
            "device.0.actuation.release_delay_s=0.002",
            "controller.rate_hz=1000.0",
            "controller.latency_s=0.001",
            "controller.sensors.suite=\"adis16470\"",
        ],
    ),
    (
        "real clutch, released wheels braked at 2 m/s²",
        &[
            "device.0.engagement=\"rigid\"",
            "device.0.flywheel.viscous_rate_1_s=0.05",
            "device.0.flywheel.brake_deceleration_m_s2=2.0",
            "device.0.actuation.engagement_delay_s=0.002",
            "device.0.actuation.release_delay_s=0.002",
            "controller.rate_hz=1000.0",
            "controller.latency_s=0.001",
            "controller.sensors.suite=\"adis16470\"",
        ],
    ),
];

fn overturned(results: &[LoopResult]) -> usize {
    results.iter().filter(|result| result.outcome.overturned()).count()
}

/// Records at scales at which a block of α = 20° overturns under some of them.
fn scaled(records: &[Motion]) -> Vec<Motion> {
    let scale = |factor: f64| {
        records.iter().filter_map(move |motion| match motion {
            Motion::Record { file, reading, .. } => {
                Some(Motion::Record { file: file.clone(), reading: reading.clone(), scale: factor })
            }
            Motion::Pulse { .. } => None,
        })
    };
    scale(2.0).chain(scale(3.0)).collect()
}

/// Runs the study over the grid and `records`.
///
/// # Errors
/// [`StudyError`].
pub fn laws(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let mut report = Report::new("laws", "Beyond Eq. 10: clutch laws");
    report.paragraph(&format!(
        "Overturned cells of a {CELLS} x {CELLS} grid (α = 20°, R = 2 m, σ = 0.5, η = 0.85, ω/p {} to {}, a/(g tan α) {} to {}), and of \
         {} recorded motions at twice and three times their size. The ideal model has ideal sensors, no delay and a clutch that engages a \
         stopped flywheel without a jolt; the real ones the consistent kinematics, flywheels that go on spinning, 3 ms from sample to \
         clutch and the sensors of an ADIS16470.",
        FREQUENCIES.0,
        FREQUENCIES.1,
        AMPLITUDES.0,
        AMPLITUDES.1,
        records.len()
    ));
    let recorded = scaled(records);
    let (sine, cosine) = (grid("sine", CELLS, FREQUENCIES, AMPLITUDES), grid("cosine", CELLS, FREQUENCIES, AMPLITUDES));
    let motions: Vec<Motion> = [sine, cosine, recorded].concat();
    let cells = CELLS * CELLS;
    for (number, (name, settings)) in SETTINGS.iter().enumerate() {
        let base = Variant::new(name, settings).with("block.slenderness_deg=20.0");
        let variants: Vec<Variant> = LawName::ALL
            .iter()
            .map(|law| Variant { name: law.name().to_owned(), ..base.with(&format!("controller.law=\"{}\"", law.name())) })
            .collect();
        let results = each(&motions, &variants, progress, |motion, variant| run_loop(motion, variant, conditions))?;
        let mut table = Table::new(&["law", "sine", "cosine", "records", "records: median peak |θ|/α", "engagements a run"]);
        let mut maps = Vec::new();
        let mut cosine_maps = Vec::new();
        for (variant, results) in variants.iter().zip(&results) {
            let (sine, cosine, recorded) = (&results[..cells], &results[cells..2 * cells], &results[2 * cells..]);
            let peaks: Vec<f64> =
                recorded.iter().filter(|result| !result.outcome.overturned()).map(|result| result.peak).collect();
            let switches: f64 = results.iter().map(|result| f64::from(result.ending.decisions.switches)).sum();
            table.row(vec![
                variant.name.clone(),
                overturned(sine).to_string(),
                overturned(cosine).to_string(),
                format!("{} of {}", overturned(recorded), recorded.len()),
                super::statistics::cell(crate::statistics::quantile(&peaks, 0.5), 3),
                format!("{:.1}", 0.5 * switches / results.len() as f64),
            ]);
            for (shape, results, maps) in [("sine", sine, &mut maps), ("cosine", cosine, &mut cosine_maps)] {
                maps.push(CellMap {
                    title: format!("{}, {shape}", variant.name),
                    note: format!("{} of {cells}", overturned(results)),
                    columns: CELLS,
                    rows: CELLS,
                    to_the_edges: false,
                    cells: results.iter().map(|result| Cell::from(result.outcome).class()).collect(),
                    curves: Vec::new(),
                });
            }
        }
        maps.extend(cosine_maps);
        report.section(name);
        report.table(&format!("laws-{}", number + 1), table);
        let maps = CellMaps {
            title: format!("Overturning by clutch law, {name}").into(),
            classes: Class::outcomes(),
            scales: (Scale::Linear, Scale::Linear),
            x_title: "ω_g/*p*".to_owned(),
            x: FREQUENCIES,
            y_title: "*a*_g/(*g* tan α)".to_owned(),
            y: AMPLITUDES,
            maps,
            curves: Vec::new(),
            columns: LawName::ALL.len(),
        };
        report.figure(&format!("laws-{}", number + 1), &format!("maps of overturned cells, {name}"), cell_map_figure(&maps)?);
    }
    Ok(report)
}
