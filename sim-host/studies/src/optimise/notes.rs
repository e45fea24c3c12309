//! What to know of a choice before it is believed.

use super::delay::refusal;
use super::findings::{Findings, Row};
use super::problem::Choices;
use super::search::BEST_FACTOR;
use crate::cloud::pages::percent;

/// Notes on `findings`, in a line each.
pub(super) fn notes(choices: &Choices<'_>, findings: &Findings) -> Vec<String> {
    let mut notes = Vec::new();
    let reference = &findings.reference;
    if !choices.limits.any() {
        notes.push("No limit is set: optimise.largest_force_ratio and optimise.largest_stroke_m set one.".to_owned());
    }
    let Some(best) = &findings.best else {
        notes.push(match &findings.nearest {
            Some(nearest) => format!(
                "No device respects the limits. The nearest, {}, asks for {} times what is allowed.",
                device(&nearest.design),
                above_one(nearest.demand_over_limit)
            ),
            None => "No device has a response to every motion.".to_owned(),
        });
        return notes;
    };
    if reference.score.median_rotation == 0.0 {
        notes.push("No motion rocks the bare block: nothing to choose by.".to_owned());
    } else if reference.overturned == 0 && best.overturned == 0 {
        notes.push("No motion overturns the bare block: the choice is by peak rotation only.".to_owned());
    } else if best.score.objective >= reference.score.objective {
        notes.push(format!(
            "No device that respects the limits overturns under fewer motions{} than the bare block ({}).",
            by_objective(choices),
            share(reference)
        ));
    }
    let alike = || findings.rows.iter().filter(|row| row.feasible && row.score.objective == best.score.objective);
    if reference.overturned > 0 && alike().count() > 1 {
        let by_rotation = alike().any(|row| row.score.median_rotation != best.score.median_rotation);
        notes.push(format!(
            "{} of the {} devices tried respect the limits and overturn under {}{}: the choice among them is by {}.",
            alike().count(),
            findings.designs,
            if by_objective(choices).is_empty() { share(best) } else { "as many motions".to_owned() },
            by_objective(choices),
            if by_rotation { "peak rotation" } else { "force" }
        ));
    }
    let feasible = || findings.rows.iter().filter(|row| row.feasible);
    let within = feasible().filter(|row| row.probability <= best.probability_band.high).count();
    if within > 1 {
        notes.push(format!(
            "{within} of the {} devices that respect the limits have a share within the band of the best.",
            feasible().count()
        ));
    }
    if best.newly_overturned > 0 {
        notes.push(format!(
            "Of the motions that the bare block survives, {} it with the chosen device.",
            if best.newly_overturned == 1 { "1 overturns".to_owned() } else { format!("{} overturn", best.newly_overturned) }
        ));
    }
    if let Some(reason) = best.candidate.and_then(|at| refusal(choices, at)) {
        notes.push(format!("No delay budget, for the clutches of the chosen device cannot be late: {reason}."));
    }
    let range = choices.table.mass_ratio;
    let mass_ratio = best.mass_ratio.unwrap_or(range.to);
    for (end, name) in [(range.from, "from"), (range.to, "to")] {
        if mass_ratio <= BEST_FACTOR * end && end <= BEST_FACTOR * mass_ratio {
            notes.push(format!(
                "The best mass ratio lies at the end of the range: optimise.mass_ratio.{name} = {end} may leave a better one out."
            ));
        }
    }
    notes
}

/// What makes motions many or few, where that is not their number.
pub(super) fn by_objective(choices: &Choices<'_>) -> String {
    let quantile = choices.table.robust.and_then(|robust| robust.quantile);
    quantile.map_or_else(String::new, |share| format!(" by the {} quantile over the specimens", percent(share)))
}

pub(super) fn device(row: &Row) -> String {
    match (&row.mount, row.mass_ratio) {
        (Some(mount), Some(mass_ratio)) => format!("{}, {mount}, σ = {}", row.law, short(mass_ratio)),
        _ => "bare block".to_owned(),
    }
}

/// "3 of 87".
pub(super) fn share(row: &Row) -> String {
    format!("{} of {} motions", row.overturned, row.motions)
}

/// A mass ratio in four digits.
pub(super) fn short(value: f64) -> String {
    let decimals = (3 - sprag_shared::math::log10(value.max(1e-9)).floor() as i32).clamp(0, 9) as usize;
    format!("{value:.decimals$}")
}

/// A number above one, so that it does not read as one.
fn above_one(value: f64) -> String {
    if value < 1.005 { format!("{value:.6}") } else { format!("{value:.2}") }
}
