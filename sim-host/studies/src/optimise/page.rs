//! The choice as a page of tables, and the table for the terminal.

use sprag_report::columns::TableError;
use sprag_report::text_table::TextTable;

use super::findings::{Findings, Row};
use super::limit::Quantity;
use super::notes::{by_objective, device, share, short};
use super::problem::{Choices, Problem};
use super::typed_tables::named_table;
use crate::cloud::pages::percent;

/// The heading of an optimisation.
pub fn heading<'a>(choices: &'a Choices<'_>) -> &'a str {
    let title = &choices.study.file.title;
    if title.is_empty() { "Choice of a device" } else { title }
}

/// The bare block, the choice, and what would be chosen without limits if that is another.
pub fn choice_table(findings: &Findings) -> Result<TextTable, TableError> {
    let mut rows = vec![("bare block", &findings.reference)];
    rows.extend(findings.best.as_ref().map(|row| ("best", row)));
    rows.extend(findings.nearest.as_ref().map(|nearest| ("nearest to the limits", &nearest.design)));
    let chosen = findings.best.as_ref().and_then(|row| row.candidate);
    let unlimited = findings.best_without_limits.as_ref().filter(|row| row.candidate != chosen);
    rows.extend(unlimited.map(|row| ("best without limits", row)));
    TextTable::of(&named_table(rows))
}

/// What is limited, in words, and in which motions; "no limit" where nothing is.
pub fn limits(choices: &Choices<'_>) -> String {
    let limits = choices.limits;
    let held = |standing: bool| {
        let motions = match limits.quantile {
            1.0 => "in every motion".to_owned(),
            quantile => format!("as the {} quantile of the motions", percent(quantile)),
        };
        if standing { format!("{motions} in which the block stands") } else { motions }
    };
    let force = limits.force.map(|limit| format!("max |F|/(mg) ≤ {limit}"));
    let stress = limits.tooth_stress.map(|limit| format!("tooth stress ≤ {limit} MPa"));
    let energy = limits.coil_energy.map(|limit| format!("coil energy ≤ {limit} J"));
    let loads: Vec<String> = [force, stress, energy].into_iter().flatten().collect();
    let loads = (!loads.is_empty()).then(|| format!("{} {}", loads.join(" and "), held(!limits.force_of_overturned)));
    let stroke = limits.stroke.map(|limit| format!("stroke ≤ {limit} m {}", held(true)));
    let all: Vec<String> = [loads, stroke].into_iter().flatten().collect();
    if all.is_empty() { "no limit".to_owned() } else { all.join(" and ") }
}

/// `optimise.md`.
pub fn page(problem: &Problem<'_>, findings: &Findings) -> Result<String, TableError> {
    let choices = &problem.choices;
    let mut page = format!("# {}\n\n", heading(choices));
    page += &format!(
        "The device for the structure \"{}\" that overturns under the fewest of {} motions{}, under {}.\n\n",
        choices.structure.name,
        findings.motions,
        by_objective(choices),
        limits(choices)
    );
    page += &choice_table(findings)?.markdown();
    let of = match choices.limits.quantile {
        1.0 => String::new(),
        quantile => format!("the {} quantile ", percent(quantile)),
    };
    let force = if choices.limits.force_of_overturned {
        "over all motions, until the block lies down where they overturn it"
    } else {
        "over the motions in which the block stands"
    };
    page += &format!(
        "\nFrom, to: Wilson's band of {}, of the probability behind the share, as if motions were independent; those of one record at\n\
         several scales are not. Saved and newly: motions that overturn the bare block and not this one, and this one and not the bare block.\n\
         F/(mg): {of}{force}; stroke: {of}over the motions in which the\n\
         block stands. Median θ/α: over the motions that rock the bare block, where overturning counts as infinite (a dash).\n",
        percent(findings.level.value())
    );
    if let Some(share) = choices.table.robust.and_then(|robust| robust.quantile) {
        page += &format!(
            "Share, from, to: the {} quantile over the specimens. Overturned: over all specimens, whose mean it gives.\n",
            percent(share)
        );
    }
    for note in &findings.notes {
        page += &format!("\n{note}\n");
    }
    if findings.neighbours.len() > 1 {
        page +=
            "\n## Its neighbours\n\nThe next smaller and larger mass ratio of the first grid, with the same law and mount.\n\n";
        let best = findings.best.as_ref().and_then(|row| row.candidate);
        let what = |row: &Row| match (row.candidate == best, row.mass_ratio < best.map(|at| at.mass_ratio), row.feasible) {
            (true, ..) => "best",
            (false, true, true) => "smaller",
            (false, true, false) => "smaller, beyond the limit",
            (false, false, true) => "larger",
            (false, false, false) => "larger, beyond the limit",
        };
        let rows = findings.neighbours.iter().map(|row| (what(row), row)).collect();
        page += &TextTable::of(&named_table(rows))?.markdown();
    }
    if choices.curves.len() > 1 && !findings.best_of_each.is_empty() {
        page += "\n## The best of each law and mount\n\n";
        let rows = findings.best_of_each.iter().map(|row| ("", row)).collect();
        page += &TextTable::of(&named_table(rows))?.markdown();
    }
    page += &price(choices, findings)?;
    Ok(page)
}

/// What limits cost: where they are reached, and the fronts.
pub(super) fn price(choices: &Choices<'_>, findings: &Findings) -> Result<String, TableError> {
    let mut page = String::new();
    if let (Some(best), Some(without), true) = (&findings.best, &findings.best_without_limits, choices.limits.any()) {
        page += "\n## What the limit costs\n\n";
        let by = by_objective(choices);
        // A quantile over the specimens is no number of motions.
        let [under, instead] = if by.is_empty() {
            [share(without), best.overturned.to_string()]
        } else {
            [format!("{} of the motions{by}", percent(without.probability)), percent(best.probability)]
        };
        page += &if without.score.objective < best.score.objective {
            let with = |force: f64| match choices.limits.quantile {
                1.0 => format!(", with F/(mg) up to {force:.4}"),
                quantile => format!(", with an F/(mg) whose {} quantile is {force:.4}", percent(quantile)),
            };
            let force = without.peak_force_ratio.map_or_else(String::new, with);
            format!("Without a limit {} would overturn under {under} instead of {instead}{force}.\n", device(without))
        } else {
            format!("Nothing in overturning: without a limit the best device overturns under {under} too.\n")
        };
    }
    if !findings.limits_reached.is_empty() {
        let mut table = TextTable::new(2, ["limit", "law, mount", "within at σ", "beyond at σ"]);
        for found in &findings.limits_reached {
            let [within, beyond] = [found.mass_ratio_within, found.mass_ratio_beyond].map(short);
            table.row(vec![found.limit.name().to_owned(), format!("{}, {}", found.law, found.mount), within, beyond]);
        }
        page += &format!("\n{}", table.markdown());
    }
    let stroke = choices.limits.stroke.map(|_| ("stroke", &findings.fronts.stroke));
    for (name, front) in std::iter::once(("force", &findings.fronts.force)).chain(stroke) {
        page += &format!("\n## Overturning against {name}\n\nNo device tried overturns under fewer motions for the same {name}");
        page += match Quantity::ALL.into_iter().filter(|quantity| choices.limits.of(*quantity).is_some()).count() {
            0 | 1 => ".\n\n",
            2 => " within the other limit.\n\n",
            _ => " within the other limits.\n\n",
        };
        let rows = front.iter().map(|row| (if row.feasible { "" } else { "beyond the limit" }, row)).collect();
        page += &TextTable::of(&named_table(rows))?.markdown();
    }
    Ok(page)
}
