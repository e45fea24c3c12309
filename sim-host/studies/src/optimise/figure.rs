//! `trade_off.svg`: how much less overturns for more force, and for more stroke.

use sprag_report::heading::of_blocks;
use sprag_report::plot::{
    FigureTitle, PlotError, TradeOffFigure, TradeOffMark, TradeOffPanel, TradeOffPoint, literal, trade_off_figure,
};

use super::curve::Curve;
use super::findings::{Findings, Row};
use super::limit::Quantity;
use super::page::heading;
use super::problem::Problem;
use crate::cloud::pages::percent;

/// The picture: overturning against force, and against stroke where that is limited.
///
/// # Errors
/// The errors of [`trade_off_figure`].
pub fn trade_off_picture(problem: &Problem<'_>, findings: &Findings) -> Result<String, PlotError> {
    let choices = &problem.choices;
    let quantities =
        Quantity::TRADED.into_iter().filter(|quantity| *quantity == Quantity::Force || choices.limits.stroke.is_some());
    let mut conditions = of_blocks(&[&choices.structure.scene]);
    let quantile = choices.table.robust.and_then(|robust| robust.quantile);
    conditions.extend(quantile.map(|share| literal(&format!("shares: {} quantile over the specimens", percent(share)))));
    trade_off_figure(&TradeOffFigure {
        title: FigureTitle { text: heading(choices).to_owned(), conditions },
        series: choices.curves.iter().map(Curve::name).collect(),
        band: format!("{} band", percent(findings.level.value())),
        panels: quantities.map(|quantity| panel(problem, findings, quantity)).collect(),
    })
}

fn panel(problem: &Problem<'_>, findings: &Findings, quantity: Quantity) -> TradeOffPanel {
    let choices = &problem.choices;
    let asks = |row: &Row| if row.candidate.is_none() { 0.0 } else { row.score.asks(quantity) };
    let mark = |row: &Row| TradeOffMark { at: (asks(row), row.probability), band: row.probability_band };
    let grid = choices.table.mass_ratio.grid();
    let of_curve = |curve: usize| {
        let rows = findings.rows.iter().filter(move |row| row.motions > 0 && row.candidate.is_some_and(|at| at.curve == curve));
        let point = |row: &Row| TradeOffPoint {
            at: (asks(row), row.probability),
            marked: row.mass_ratio.is_some_and(|mass_ratio| grid.contains(&mass_ratio)),
            counts: row.failed == 0 && choices.limits.others_respected(quantity, &row.score),
        };
        rows.map(point).collect()
    };
    let front = if quantity == Quantity::Force { &findings.fronts.force } else { &findings.fronts.stroke };
    TradeOffPanel {
        x_title: quantity.axis_title(choices.limits.quantile),
        limit: choices.limits.of(quantity),
        series: (0..choices.curves.len()).map(of_curve).collect(),
        front: front.iter().map(|row| (asks(row), row.probability)).collect(),
        chosen: findings.best.as_ref().map(mark),
        reference: mark(&findings.reference),
    }
}
