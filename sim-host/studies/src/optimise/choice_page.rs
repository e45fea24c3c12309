//! `choice.md` and `choice.svg`: the choice as a designer hands it on: what, why, how sure, at what cost, and what was not looked at.

use sprag_report::heading::of_blocks;
use sprag_report::plot::{Chart, ChartPanel, FigureTitle, Interval, Line, PlotError, chart_figure, interval_figure};
use sprag_report::text_table::TextTable;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::scene::drivetrain::EngagementName;
use sprag_sim::scene::schema::{DeviceTable, Kind};

use super::delay::{Late, is_commanded};
use super::findings::{Findings, Row};
use super::limit::Quantity;
use super::notes::{by_objective, device, share, short};
use super::page::{heading, limits};
use super::problem::{Choices, Problem};
use super::ranking::Ranking;
use super::verdict::{points, rival_name, rotation_ratio};
use crate::cloud::pages::percent;
use crate::statistics::{Band, Paired};

/// `choice.md`; none where no device respects the limits.
pub fn choice_page(problem: &Problem<'_>, findings: &Findings) -> Option<String> {
    let (choices, best, ranking) = (&problem.choices, findings.best.as_ref()?, findings.ranking.as_ref()?);
    let mut page = format!("# {}: the choice\n\n", heading(choices));
    page += &format!("**{}** for the structure \"{}\".\n", device(best), choices.structure.name);
    page += &why(choices, findings, best);
    page += &how_sure(findings, ranking);
    page += &costs(choices, best);
    page += &delays(findings);
    page += &what_limits(findings, best);
    page += "\n## What was not looked at\n\n";
    not_looked_at(choices, best).iter().for_each(|line| page += &format!("- {line}\n"));
    page += "\nAll designs: `designs.csv`; their neighbours and fronts: `optimise.md`; every motion: `motions.csv`.\n";
    Some(page)
}

/// `choice.svg`: the paired differences; none where there is no choice, and where they have no band.
///
/// # Errors
/// The errors of [`interval_figure`].
pub fn choice_picture(problem: &Problem<'_>, findings: &Findings) -> Result<Option<String>, PlotError> {
    let (Some(best), Some(ranking)) = (&findings.best, &findings.ranking) else { return Ok(None) };
    let intervals: Vec<Interval> = ranking
        .rivals
        .iter()
        .filter_map(|rival| {
            Some(Interval {
                name: rival_name(&rival.row),
                value: 100.0 * rival.overturning.difference,
                band: rival.overturning.band?.times(100.0),
                verdict: rival.short_verdict().to_owned(),
                sure: rival.sure,
            })
        })
        .collect();
    if intervals.is_empty() {
        return Ok(None);
    }
    let mut conditions = of_blocks(&[&problem.choices.structure.scene]);
    conditions.push(sprag_report::plot::literal(&format!(
        "{} beside its rivals: {} bands over {} independent groups of motions",
        device(best),
        percent(findings.level.value()),
        ranking.groups
    )));
    let title = FigureTitle { text: format!("{}: how sure", heading(&problem.choices)), conditions };
    interval_figure(&title, "motions that overturn the rival, less those that overturn the choice (% of all)", &intervals)
        .map(Some)
}

fn why(choices: &Choices<'_>, findings: &Findings, best: &Row) -> String {
    let reference = &findings.reference;
    let mut text = format!(
        "\n## Why\n\nIt overturns under {}, the bare block under {}: it saves {} and overturns under {} that the bare block survives.\n\
         Of {} devices tried, and within the limits ({}), none overturns under fewer{}",
        share(best),
        reference.overturned,
        best.saved,
        best.newly_overturned,
        findings.designs,
        limits(choices),
        by_objective(choices)
    );
    if let (Some(robust), count) = (choices.table.robust, findings.specimens.len()) {
        let of = robust.quantile.map_or_else(|| "mean".to_owned(), |share| format!("{} quantile", percent(share)));
        let scatter = format!(
            "\nEvery motion shakes {count} specimens, the same for every design, and counts once for each: the restitution is {} of the scene's\n\
             but at most 1, uniformly. What is made small is the {of} over the specimens.\n",
            plus_minus(robust.restitution)
        );
        text = text.replacen("## Why\n", &format!("## Why\n{scatter}"), 1);
    }
    text += match best.median_peak_rotation {
        Some(_) if reference.overturned == 0 => ", and none of as few has a smaller median rotation.\n",
        _ => ".\n",
    };
    if let (Some(best), bare) = (best.median_peak_rotation, reference.median_peak_rotation) {
        let bare = bare.map_or_else(|| "overturning".to_owned(), |bare| format!("{bare:.3}"));
        text += &format!("Median of max |θ|/α over the motions that rock the bare block: {best:.3}; bare block: {bare}.\n");
    }
    text
}

fn how_sure(findings: &Findings, ranking: &Ranking) -> String {
    let level = findings.level;
    let mut text = "\n## How sure that is\n\n".to_owned();
    for rival in &ranking.rivals {
        text += &format!("- {}\n", capital(&rival.verdict(level)));
    }
    let mut table =
        TextTable::new(1, ["rival", "overturned", "fewer by", "from", "to", "better in", "worse in", "chance", "θ ratio"]);
    for rival in &ranking.rivals {
        let paired = &rival.overturning;
        let [low, high] = ends(paired);
        table.row(vec![
            rival_name(&rival.row),
            rival.row.overturned.to_string(),
            points(paired.difference),
            low,
            high,
            paired.groups_above.to_string(),
            paired.groups_below.to_string(),
            if paired.chance < 0.001 { "< 0.001".to_owned() } else { format!("{:.3}", paired.chance) },
            rotation_ratio(rival),
        ]);
    }
    let mut known = match ranking.records_without_event {
        0 => String::new(),
        count => format!(", of which {count} are records whose earthquake is not known"),
    };
    if ranking.pulses > 0 {
        known += &format!(", and {} pulses, which are no sample of anything", ranking.pulses);
    }
    let resamples = ranking.bootstrap.resamples;
    let resampled = match ranking.groups {
        0 | 1 => "which one\nindependent group of motions does not give".to_owned(),
        groups => format!("by {resamples} resamples of the\n{groups} independent groups of motions (earthquakes{known})"),
    };
    text += &format!(
        "\n{}\nFewer by, from, to: share of the motions that overturn the rival less that of the choice, and its {} band, {resampled}. \
         Better in, worse in: groups; chance: probability of such counts between equals\n\
         (sign test). \"Better\" and \"worse\" need both: a band without 0, and a chance of at most {}. θ ratio: geometric mean of max |θ| with the\n\
         choice over that with the rival, under motions that rock both and overturn neither.\n",
        table.markdown(),
        percent(level.value()),
        percent(1.0 - level.value())
    );
    let again: Vec<String> = ranking
        .chosen_again
        .iter()
        .map(|again| format!("{}, {} in {}", again.law, again.mount, percent_of(again.share)))
        .collect();
    if !again.is_empty() {
        text += &format!("\nChosen again, when the groups are drawn anew: {}.\n", again.join("; "));
    }
    if let (Some(left_out), Some(best)) = (ranking.probability_left_out, &findings.best) {
        text += &format!(
            "The choice is the best of many under these motions, and so looks better than it is: motions that had no say in a choice overturn what\n\
             is chosen in {} of the cases, beside {} above.\n",
            points(left_out),
            points(best.score.share())
        );
    }
    text
}

/// The ends of a band; dashes without one.
fn ends(paired: &Paired) -> [String; 2] {
    paired.band.map_or_else(|| ["-", "-"].map(str::to_owned), |band| [band.low, band.high].map(points))
}

/// "100 % ± 5 %".
fn plus_minus(width: f64) -> String {
    format!("100 % ± {}", percent(width))
}

/// A share that is neither none nor all is not shown as either.
fn percent_of(share: f64) -> String {
    match share {
        share if share > 0.0 && share < 0.005 => "less than 1 %".to_owned(),
        share if share < 1.0 && share > 0.995 => "more than 99 %".to_owned(),
        share => format!("{:.0} %", 100.0 * share),
    }
}

fn capital(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}

fn costs(choices: &Choices<'_>, best: &Row) -> String {
    let mut table = TextTable::new(1, ["", "asks for", "limit", "left"]);
    let score = &best.score;
    let known = |quantity: Quantity| match quantity {
        Quantity::Force => score.force_ratio.is_some(),
        Quantity::Stroke => score.stroke_m.is_some(),
        Quantity::ToothStress => score.tooth_stress_mpa.is_some(),
        Quantity::CoilEnergy => score.coil_energy_j.is_some(),
    };
    let has = |quantity: &Quantity| known(*quantity) || Quantity::TRADED.contains(quantity);
    for quantity in Quantity::ALL.into_iter().filter(has) {
        let asks = known(quantity).then(|| score.asks(quantity));
        let limit = choices.limits.of(quantity);
        let dash = || "-".to_owned();
        table.row(vec![
            quantity.title().to_owned(),
            asks.map_or_else(dash, |asks| format!("{asks:.4}")),
            limit.map_or_else(|| "none".to_owned(), |limit| limit.to_string()),
            asks.zip(limit).map_or_else(dash, |(asks, limit)| points(1.0 - asks / limit)),
        ]);
    }
    let quantile = match choices.limits.quantile {
        1.0 => "The largest over the motions".to_owned(),
        share => format!("The {} quantile over the motions", percent(share)),
    };
    let mut text = format!("\n## What it costs\n\n{}\n{quantile}", table.markdown());
    text += if choices.limits.force_of_overturned {
        "; forces until the block lies down where a motion overturns it, the stroke where the block stands.\n"
    } else {
        " in which the block stands.\n"
    };
    if let (Some(mass), Some(force_ratio)) = (choices.structure.scene.file.block.mass_kg, score.force_ratio) {
        text += &format!(
            "The block weighs {:.1} kN: a force of {:.1} kN.\n",
            1e-3 * mass * GRAVITY,
            1e-3 * mass * GRAVITY * force_ratio
        );
    }
    text
}

fn delays(findings: &Findings) -> String {
    let Some(budget) = &findings.delay_budget else { return String::new() };
    let mut table = TextTable::new(0, ["later by (s)", "overturned", "fewer by", "from", "to", "better", "within limits"]);
    let yes = |yes: bool| if yes { "yes" } else { "no" }.to_owned();
    for late in &budget.late {
        let shares = [late.probability, late.overturning.difference].map(points);
        let words = [yes(late.better), yes(late.feasible)];
        table.row([&[late.delay_s.to_string()][..], &shares, &ends(&late.overturning), &words].concat());
    }
    format!(
        "\n## How late its clutches may be\n\n{}.\n\n{}\nLater by: added to the time from command to engagement and to that from command to release. Fewer by: beside {}.\n",
        capital(&budget.words()),
        table.markdown(),
        rival_name(&budget.rival)
    )
}

/// `delay.svg`: overturning against the delay; none without a delay budget.
///
/// # Errors
/// The errors of [`chart_figure`].
pub fn delay_picture(problem: &Problem<'_>, findings: &Findings) -> Result<Option<String>, PlotError> {
    let (Some(budget), Some(best)) = (&findings.delay_budget, &findings.best) else { return Ok(None) };
    let late = |of: fn(&Late) -> f64| budget.late.iter().map(move |late| (late.delay_s, 100.0 * of(late))).collect();
    let last = budget.late.last().map_or(0.0, |late| late.delay_s);
    let level = |name: String, probability: f64| Line {
        name,
        points: vec![(0.0, 100.0 * probability), (last, 100.0 * probability)],
        guide: true,
        ..Line::default()
    };
    let choice = Line { name: device(best), points: late(|late| late.probability), marks: true, ..Line::default() };
    let rival = level(rival_name(&budget.rival), budget.rival.score.share());
    let fewer = Line {
        name: "fewer than the rival".to_owned(),
        points: late(|late| late.overturning.difference),
        marks: true,
        ..Line::default()
    };
    let mut fewer = vec![fewer];
    for end in [|band: Band| band.low, |band: Band| band.high] {
        let of = |late: &Late| Some((late.delay_s, 100.0 * end(late.overturning.band?)));
        let points: Vec<(f64, f64)> = budget.late.iter().filter_map(of).collect();
        let name = format!("ends of its {} band", percent(findings.level.value()));
        fewer.extend((!points.is_empty()).then(|| Line { name, points, guide: true, ..Line::default() }));
    }
    let panel = |y_title: &str, lines| ChartPanel { y_title: y_title.to_owned(), lines, ..ChartPanel::default() };
    chart_figure(&Chart {
        title: FigureTitle {
            text: format!("{}: delay budget", heading(&problem.choices)),
            conditions: of_blocks(&[&problem.choices.structure.scene]),
        },
        x_title: "clutches later by (s)".to_owned(),
        panels: vec![panel("motions that overturn (%)", vec![choice, rival]), panel("fewer by (% of the motions)", fewer)],
        columns: 1,
        ..Chart::default()
    })
    .map(Some)
}

fn what_limits(findings: &Findings, best: &Row) -> String {
    let mut text = "\n## What limits it\n\n".to_owned();
    let reached: Vec<String> = findings
        .limits_reached
        .iter()
        .filter(|reached| reached.law == best.law && Some(&reached.mount) == best.mount.as_ref())
        .map(|reached| format!("the {} at σ = {}", reached.limit.name(), short(reached.mass_ratio_beyond)))
        .collect();
    if reached.is_empty() {
        text += "No limit is reached by this law and mount within the mass ratios tried.\n";
    } else {
        text += &format!("Along σ this law and mount reach the limit on {}.\n", reached.join(", "));
    }
    if let Some(without) = findings.best_without_limits.as_ref().filter(|row| row.candidate != best.candidate) {
        text += &format!("Without limits the choice would be {}, which overturns under {}.\n", device(without), share(without));
    }
    findings.notes.iter().for_each(|note| text += &format!("{note}\n"));
    text
}

/// What the study says nothing about, in a line each.
pub(super) fn not_looked_at(choices: &Choices<'_>, best: &Row) -> Vec<String> {
    let of_block = &choices.structure.scene.file.block;
    let mut lines = Vec::new();
    let unlimited: Vec<&str> =
        Quantity::ALL.into_iter().filter(|quantity| choices.limits.of(*quantity).is_none()).map(Quantity::name).collect();
    if !unlimited.is_empty() {
        lines.push(format!("No limit is set on: {}.", unlimited.join(", ")));
    }
    lines.push(match choices.table.robust {
        None => {
            let restitution =
                if of_block.restitution_scatter.is_some_and(|deviation| deviation > 0.0) { "" } else { "restitution, " };
            format!("Block and device are as the scene says: no scatter of {restitution}size or slenderness.")
        }
        Some(_) => "Size, slenderness and mass ratio are as the scene says: none of them scatters.".to_owned(),
    });
    if let Some(device) = best.candidate.map(|at| &choices.curves[at.curve].device) {
        lines.extend(left_out_of(device));
    }
    let commanded = best.candidate.is_some_and(|at| is_commanded(choices, at.curve));
    if commanded && choices.table.delays_s.is_empty() {
        lines.push("How late the clutches may be: optimise.delays_s asks for it.".to_owned());
    }
    lines.push("Records are horizontal: no vertical ground motion.".to_owned());
    let moves = if of_block.foundation.is_some() { "slide or twist" } else { "slide, twist, or move its foundation" };
    lines.push(format!("The block rocks in its plane: it does not {moves}."));
    lines
}

/// What a device leaves out of what there is.
fn left_out_of(device: &DeviceTable) -> Vec<String> {
    let mut lines = Vec::new();
    let pair = device.kind == Kind::ClutchedPair;
    let has_no_properties = device.clutch.is_none() && device.inertance_corner_hz.is_none();
    if pair && has_no_properties && device.engagement.unwrap_or_default() == EngagementName::Ideal {
        lines.push(
            "The clutch is the paper's: it engages at once, without a shock, and its flywheel stops when it is released."
                .to_owned(),
        );
    } else if pair && has_no_properties {
        lines.push("The clutch is rigid: it does not slip and has no play.".to_owned());
    }
    if pair && device.actuation.is_none() && device.engagement != Some(EngagementName::Overrunning) {
        lines.push("The clutch obeys at once, and never misses.".to_owned());
    }
    if device.rack.is_none() && device.flywheel.is_none() {
        lines.push("No friction in rack and bearings.".to_owned());
    }
    if device.support_key().is_some() {
        lines.push(
            "Strokes are travels of the block against the ground: what the support moves on its own is not in them.".to_owned(),
        );
    }
    if device.weight.is_none() {
        lines.push("The device's own weight rests on its support, not on the block.".to_owned());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_all_is_100_percent_and_only_none_is_0() {
        let shares = [0.0, 0.0005, 0.0051, 0.5, 0.9949, 0.9995, 1.0];
        assert_eq!(shares.map(percent_of), ["0 %", "less than 1 %", "1 %", "50 %", "99 %", "more than 99 %", "100 %"]);
    }
}
