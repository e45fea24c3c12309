//! `delay.svg`: what a delay of the clutches costs.

use sprag_report::heading::of_blocks;
use sprag_report::plot::{Chart, ChartPanel, FigureTitle, Line, PlotError, Scale, chart_figure};

use super::late::Late;
use super::study::{Findings, PartsList, Problem};
use super::table::figures;

/// The picture: the largest rotation over the motions under which the block stands without a delay, and how many overturn it; none where no
/// clutch takes commands.
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
    let share = figures(100.0 * problem.basis.tolerance);
    let most = |list: &PartsList| {
        let tried = &list.delay.as_ref()?.tried;
        let (first, last) = (tried.first()?, tried.last()?);
        let allowed = (1.0 + problem.basis.tolerance) * first.largest_rotation?;
        let points = vec![(0.0, allowed), (1e3 * last.delay_s, allowed)];
        Some(Line { name: format!("{share} % more than without a delay"), points, guide: true, ..Line::default() })
    };
    if !findings.lists.iter().any(|list| list.delay.is_some()) {
        return Ok(None);
    }
    let title = &problem.scene.file.title;
    let mut rotation = panel("largest rotation, max |*θ*|/*α*", &|late| late.largest_rotation);
    rotation.lines.extend(findings.lists.iter().filter_map(most));
    let overturned = ChartPanel { y: Scale::Whole, ..panel("motions that overturn", &|late| Some(late.overturned as f64)) };
    let panels = [rotation, overturned];
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
