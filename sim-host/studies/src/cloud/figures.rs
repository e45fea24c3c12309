//! The pictures of a study: demands against intensity (Figure 15) and fragilities (Figure 16).

use sprag_report::heading::of_blocks;
use sprag_report::plot::{BandPoint, CloudFigure, CloudPanel, CloudSeries, FigureTitle, PlotError, Rug, Scale, cloud_figure};
use sprag_shared::math;

use super::demand::{Demand, DemandModel};
use super::findings::Findings;
use super::overturning::DeviceFragility;
use super::pages::{heading, percent, short_reason};
use super::study::Study;

/// Intensities at which the band of a power law is drawn.
const BAND_POINTS: u32 = 60;

/// What no axis can show: few points at a high level have a band that ends beyond all numbers.
const LARGEST_DRAWN: f64 = 1e100;

/// The study's title, and below it what its blocks have in common.
fn title(study: &Study) -> FigureTitle {
    let scenes: Vec<_> = study.structures.iter().map(|structure| &structure.scene).collect();
    FigureTitle { text: heading(study).to_owned(), conditions: of_blocks(&scenes) }
}

/// `demand.svg`: rotations left, accelerations right, a row for each structure; `None` where nothing rocks and stands.
///
/// # Errors
/// The errors of [`cloud_figure`].
pub fn demand_picture(study: &Study, findings: &Findings) -> Result<Option<String>, PlotError> {
    let mut panels = Vec::new();
    for (number, structure) in study.structures.iter().enumerate() {
        for demand in Demand::ALL {
            let of_panel = |model: &&DemandModel| model.structure_index == number && model.demand == demand;
            let series: Vec<CloudSeries> =
                findings.demand.iter().filter(of_panel).map(|model| demand_series(study, model)).collect();
            if !series.is_empty() {
                let title = structure.name.clone();
                panels.push(CloudPanel { title, y_title: demand.axis_title().to_owned(), series, ..CloudPanel::default() });
            }
        }
    }
    if panels.iter().flat_map(|panel| &panel.series).all(|series| series.points.is_empty()) {
        return Ok(None);
    }
    cloud_figure(&CloudFigure {
        title: title(study),
        devices: study.devices.clone(),
        x_title: study.file.demand.measure.axis_title(study.slender()),
        scales: (Scale::Logarithmic, Scale::Logarithmic),
        columns: 2,
        band: format!("{} confidence band of the median", percent(study.bootstrap.level.value())),
        marks: "a motion".to_owned(),
        panels,
    })
    .map(Some)
}

fn demand_series(study: &Study, model: &DemandModel) -> CloudSeries {
    let mut series = CloudSeries {
        device: model.device_index,
        points: model.points.iter().map(|point| (point.intensity, point.demand)).collect(),
        ..CloudSeries::default()
    };
    let (Some(law), Some([low, high])) = (&model.law, model.intensity_range) else { return series };
    let [ln_low, ln_high] = [low, high].map(math::ln);
    for k in 0..=BAND_POINTS {
        let intensity = math::exp(ln_low + (ln_high - ln_low) * f64::from(k) / f64::from(BAND_POINTS));
        let (median, band) = (law.median(intensity), law.median_band(intensity, study.bootstrap.level));
        if median < LARGEST_DRAWN {
            series.line.push((intensity, median));
        }
        if band.high < LARGEST_DRAWN {
            series.band.push(BandPoint { at: intensity, low: band.low, high: band.high });
        }
    }
    series
}

/// `fragility.svg`: a panel for each structure; `None` where no run has a value of the measure.
///
/// # Errors
/// The errors of [`cloud_figure`].
pub fn fragility_picture(study: &Study, findings: &Findings) -> Result<Option<String>, PlotError> {
    let mut panels = Vec::new();
    for (number, structure) in study.structures.iter().enumerate() {
        let fragilities: Vec<&DeviceFragility> =
            findings.fragility.iter().filter(|found| found.structure_index == number).collect();
        if fragilities.is_empty() {
            continue;
        }
        let note = |found: &&DeviceFragility| Some(format!("{}: {}", found.device, short_reason(&found.fragility)?));
        panels.push(CloudPanel {
            title: structure.name.clone(),
            notes: fragilities.iter().filter_map(note).collect(),
            y_title: "probability of overturning".to_owned(),
            series: fragilities.iter().map(|found| fragility_series(found)).collect(),
            share: true,
        });
    }
    if panels.is_empty() {
        return Ok(None);
    }
    cloud_figure(&CloudFigure {
        title: title(study),
        devices: study.devices.clone(),
        x_title: study.file.fragility.measure.axis_title(study.slender()),
        scales: (Scale::Linear, Scale::Linear),
        columns: 2,
        band: format!("{} bootstrap band", percent(study.bootstrap.level.value())),
        marks: "share of a stripe that overturned".to_owned(),
        panels,
    })
    .map(Some)
}

fn fragility_series(found: &DeviceFragility) -> CloudSeries {
    let of = |overturned: bool| {
        let chosen = found.observations.iter().filter(move |observation| (observation.overturned > 0) == overturned);
        chosen.map(|observation| observation.intensity).collect::<Vec<f64>>()
    };
    let mut series = CloudSeries { device: found.device_index, ..CloudSeries::default() };
    // Ticks of a stripe would lie on each other.
    match found.shares() {
        Some(shares) => series.points = shares,
        None => series.rug = Some(Rug { stood: of(false), overturned: of(true) }),
    }
    if let (Some(curve), Some(bands)) = (found.fragility.curve(), &found.bands) {
        series.line.push((0.0, 0.0));
        for at in &bands.curve {
            series.line.push((at.intensity, curve.probability(at.intensity)));
            series.band.push(BandPoint { at: at.intensity, low: at.band.low, high: at.band.high });
        }
    }
    series
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::cloud::measure::Measure;
    use crate::statistics::{DemandPoint, PowerLaw};

    /// Three points have one degree of freedom, and at this level a band that overflows.
    #[test]
    fn a_band_beyond_all_numbers_is_left_out_of_the_picture() {
        let text = "records = ['a.csv']\n[bootstrap]\nlevel = 0.999";
        let study = Study::parse(text, "study.toml", Path::new(""), &[], &[]).unwrap();
        let points = [(1.0, 1.0), (1.1, 9.0), (3.0, 2.0)].map(|(intensity, demand)| DemandPoint { intensity, demand }).to_vec();
        let law = PowerLaw::fit(&points).unwrap();
        assert_eq!(law.median_band(3.0, study.bootstrap.level).high, f64::INFINITY);
        let model = DemandModel {
            structure_index: 0,
            structure: String::new(),
            device_index: 0,
            device: String::new(),
            demand: Demand::PeakRotation,
            measure: Measure::Pgv,
            runs: 3,
            left_out: crate::cloud::demand::LeftOut::default(),
            law: Some(law),
            reason: None,
            intensity_range: Some([1.0, 3.0]),
            points,
        };
        let series = demand_series(&study, &model);
        assert_eq!((series.points.len(), series.line.len()), (3, 61));
        assert!(series.band.iter().all(|point| point.high < LARGEST_DRAWN) && series.band.len() < 61);
        cloud_figure(&CloudFigure {
            title: title(&study),
            devices: study.devices.clone(),
            x_title: String::new(),
            scales: (Scale::Logarithmic, Scale::Logarithmic),
            columns: 1,
            band: String::new(),
            marks: String::new(),
            panels: vec![CloudPanel { series: vec![series], ..CloudPanel::default() }],
        })
        .unwrap();
    }
}
