//! `delay.svg`: what a delay of the clutches costs.

use sprag_report::heading::of_blocks;
use sprag_report::plot::{Chart, ChartPanel, FigureTitle, Line, PlotError, chart_figure};

use super::late::Late;
use super::study::{Findings, PartsList, Problem};

/// The picture; none where no clutch takes commands.
///
/// # Errors
/// The errors of [`chart_figure`].
pub fn delay_picture(problem: &Problem<'_>, findings: &Findings) -> Result<Option<String>, PlotError> {
    let known = |list: &&PartsList| list.delay.is_some();
    let line = |list: &PartsList, of: &dyn Fn(&Late) -> Option<f64>| {
        let tried = list.delay.iter().flat_map(|delay| &delay.tried);
        let points = tried.filter_map(|late| Some((1e3 * late.delay_s, of(late)?))).collect();
        Line { name: list.device.clone(), points, marks: true, ..Line::default() }
    };
    let panel = |y_title: &str, of: &dyn Fn(&Late) -> Option<f64>| ChartPanel {
        y_title: y_title.to_owned(),
        lines: findings.lists.iter().filter(known).map(|list| line(list, of)).filter(|line| !line.points.is_empty()).collect(),
        ..ChartPanel::default()
    };
    if !findings.lists.iter().any(|list| list.delay.is_some()) {
        return Ok(None);
    }
    let title = &problem.scene.file.title;
    let panels = [
        panel("largest rotation of those that stand, max |*θ*|/*α*", &|late| late.largest_rotation),
        panel("motions that overturn", &|late| Some(late.overturned as f64)),
    ];
    let chart = Chart {
        title: FigureTitle {
            text: if title.is_empty() { "Delay of the clutches".to_owned() } else { format!("{title}: delay of the clutches") },
            conditions: of_blocks(&[problem.scene]),
        },
        x_title: "clutches later by (ms)".to_owned(),
        panels: panels.into_iter().filter(|panel| !panel.lines.is_empty()).collect(),
        columns: 1,
        ..Chart::default()
    };
    chart_figure(&chart).map(Some)
}
