//! The energy of every device over time: where the work of the ground is, and where it went.

use std::ops::Range;

use sprag_sim::simulation::DeviceRun;
use sprag_sim::simulation::energy::Shares;

use super::curve::write_curve;
use super::decimate::decimate;
use super::layer::{Anchor, Text, escape, write_area};
use super::legend::{BOLD_WIDTH, LegendEntry, Swatch, shortened};
use super::palette::{Colour, FLYWHEEL_TINTS, GROUND, GUIDE, INK, Stroke, device_look};
use super::panel::Panel;
use super::stack::{PANELS_PX, Stack};
use super::text_width::text_width_px;
use super::ticks::drawable;
use super::time_axis::check_order;
use super::{FigureTitle, PlotError, TimeAxis};

const PANEL_PX: f64 = 150.0;
/// Room above a panel for the name of its device, together with the gap.
const NAME_PX: f64 = 14.0;
const FONT_PX: f64 = 11.0;
/// Shares that round to nothing in a picture.
const NEGLIGIBLE: f64 = 5e-4;
/// A device below this part of the highest one gets a scale of its own.
const OWN_SCALE_BELOW: f64 = 0.2;

/// An area of the stack.
struct Layer {
    name: &'static str,
    colour: Colour,
    thickness: fn(&Shares) -> f64,
}

/// From the bottom: what is gone, then what is there.
fn layers() -> [Layer; 9] {
    let colour = |index: usize| device_look(index).colour;
    let layer = |name, colour, thickness| Layer { name, colour, thickness };
    [
        layer("gone in impacts", GUIDE, |shares| shares.impact),
        layer("in clutches", colour(1), |shares| shares.clutch),
        layer("in brakes", colour(6), |shares| shares.brake),
        layer("in bearings", colour(4), |shares| shares.bearing),
        layer("in the rack", GROUND, |shares| shares.rack),
        layer("taken by the paper's kinematics", FLYWHEEL_TINTS[1], |shares| shares.kinematics.max(0.0)),
        layer("stored in the device", colour(3), |shares| shares.stored),
        layer("potential", colour(5), |shares| shares.potential.max(0.0)),
        // Beyond 2α the potential energy is negative, and what is left of the kinetic energy closes the stack.
        layer("kinetic", colour(2), |shares| shares.kinetic + shares.potential.min(0.0)),
    ]
}

/// What was put in, to which the areas add up.
fn supply(shares: &Shares) -> f64 {
    shares.initial + shares.input + shares.created + (-shares.kinematics).max(0.0)
}

/// Draws the energy ledgers of `runs` as an SVG document: one panel a device over a shared time axis, in shares of the barrier
/// to overturning. `frequency_parameter_1_s` is p of their block (1/s). The axis ends with the longest run or ledger; until then, ledgers
/// of blocks that stand keep their last values.
///
/// Areas from the bottom are what is gone, by where it went, and what is there: stored in the device, potential and kinetic. The
/// line is what was put in, so that a ledger that closes has the line on top of its areas. Energy that the paper's kinematics
/// take is an area, energy that they give is put in. Panels share one scale except where a device would be too low to see. Areas
/// of an overturned block end where it has passed 2α for good.
///
/// The text is the same for the same input, and long ledgers are thinned to the width of the panels.
///
/// # Errors
/// [`PlotError`] when no run has a ledger, without a time span, for numbers that are not finite or out of time order, and over p t for a
/// block without positive frequency parameter.
pub fn energy_figure(
    title: impl Into<FigureTitle>,
    runs: &[DeviceRun],
    axes: TimeAxis,
    frequency_parameter_1_s: f64,
) -> Result<String, PlotError> {
    let title = title.into();
    let Some(first) = runs.iter().find(|run| run.energy.is_some()) else { return Err(PlotError::NoHistories) };
    let scale = axes.scale_of(&first.device, frequency_parameter_1_s)?;
    for run in runs {
        check(run)?;
    }
    let mut ledgers: Vec<Vec<(f64, Shares)>> = runs.iter().map(|run| ledger(run, scale)).collect();
    // Flywheels may turn on where the block rests.
    let lasts = ledgers.iter().filter_map(|ledger| ledger.last()).map(|sample| sample.0);
    let end = runs.iter().map(|run| scale * run.end_time_s).chain(lasts).fold(0.0, f64::max);
    if end <= 0.0 {
        return Err(PlotError::EmptyTimeSpan);
    }
    for (_, ledger) in runs.iter().zip(&mut ledgers).filter(|(run, _)| !run.outcome.overturned()) {
        ledger.extend(ledger.last().map(|&(_, last)| (end, last)));
    }
    let layers = layers();

    let mut stack = Stack::new(&title, &keys(&ledgers, &layers), 0.0..end);
    for (index, ((run, ledger), scale)) in runs.iter().zip(&ledgers).zip(scales(&ledgers)).enumerate() {
        stack.top_px += NAME_PX;
        let mut panel = stack.panel(PANEL_PX, 0.0..scale, Some("share of the barrier"));
        panel.guides = &[1.0];
        let svg = &mut stack.svg;
        let at = (panel.left_px, panel.top_px - 6.0);
        Text { attributes: " font-weight=\"bold\"", ..Text::new(&name(run), at, FONT_PX) }.write(svg, false);
        write_areas(svg, &panel, ledger, &layers);
        panel.write_axes(svg, (index + 1 == runs.len()).then_some(axes.title()));
        let line: Vec<(f64, f64)> = ledger.iter().map(|(time, shares)| (*time, supply(shares))).collect();
        write_curve(svg, &panel, &line, Stroke::solid(INK));
        if run.outcome.overturned()
            && let Some((x, y)) = line.last().map(|point| panel.position_px(*point))
        {
            let note = Text { colour: GROUND, ..Text::new("overturns", (x + 6.0, y.max(panel.top_px + 12.0)), FONT_PX) };
            note.write(svg, false);
        }
        if ledger.is_empty() {
            let note = if run.energy.is_some() { "never rocks" } else { "no energy ledger" };
            let middle = (panel.left_px + 0.5 * panel.width_px, panel.top_px + 0.5 * PANEL_PX);
            Text { anchor: Anchor::Middle, colour: GROUND, ..Text::new(note, middle, 13.0) }.write(svg, false);
        }
    }
    Ok(stack.document(&title))
}

/// Refuses numbers that cannot be drawn.
fn check(run: &DeviceRun) -> Result<(), PlotError> {
    let history = || run.energy.iter().flat_map(|energy| &energy.history);
    for (time_s, shares) in history() {
        if !shares.row().into_iter().chain([*time_s]).all(drawable) {
            return Err(PlotError::NotFinite { device: run.device.clone(), time_s: *time_s });
        }
    }
    check_order(&run.device, history().map(|sample| sample.0))
}

/// What is drawn of a run's ledger, with times that `scale` multiplies: all, or up to where the block has passed 2α for good.
fn ledger(run: &DeviceRun, scale: f64) -> Vec<(f64, Shares)> {
    let history = run.energy.iter().flat_map(|energy| &energy.history);
    let mut samples: Vec<(f64, Shares)> = history.map(|&(time_s, shares)| (scale * time_s, shares)).collect();
    if run.outcome.overturned() {
        let shown = samples.iter().rposition(|(_, shares)| shares.potential >= 0.0).map_or(0, |last| last + 1);
        samples.truncate(shown);
    }
    samples
}

/// Name and outcome, and what the paper's kinematics did if that is not negligible; escaped, and a name that leaves no room for the rest cut.
fn name(run: &DeviceRun) -> String {
    let kinematics = run.energy.as_ref().map_or(0.0, |energy| energy.entries.kinematics);
    let verb = if kinematics > 0.0 { "took" } else { "gave" };
    let note = if kinematics.abs() < NEGLIGIBLE || run.outcome.overturned() {
        String::new()
    } else {
        format!("; by the end the paper's kinematics {verb} {:.3}", kinematics.abs())
    };
    let rest = format!(" ({}){note}", run.outcome);
    let room_px = BOLD_WIDTH * PANELS_PX - text_width_px(&rest, FONT_PX);
    format!("{}{}", shortened(&run.device, room_px), escape(&rest))
}

/// Upper ends of the panels' scales.
fn scales(ledgers: &[Vec<(f64, Shares)>]) -> Vec<f64> {
    let peak = |ledger: &Vec<(f64, Shares)>| ledger.iter().map(|(_, shares)| supply(shares)).fold(0.0, f64::max);
    let peaks: Vec<f64> = ledgers.iter().map(peak).collect();
    let highest = peaks.iter().copied().fold(0.0, f64::max);
    let scale = |peak: f64| match peak {
        _ if highest < NEGLIGIBLE => 1.0,
        peak if peak < NEGLIGIBLE => highest,
        peak if peak < OWN_SCALE_BELOW * highest => peak,
        _ => highest,
    };
    peaks.into_iter().map(|peak| 1.08 * scale(peak)).collect()
}

/// Appends the areas: each from zero up to its upper edge, the highest first, so that thinning leaves no gaps between them.
fn write_areas(svg: &mut String, panel: &Panel<'_>, ledger: &[(f64, Shares)], layers: &[Layer]) {
    for (index, layer) in layers.iter().enumerate().rev() {
        if ledger.iter().all(|(_, shares)| (layer.thickness)(shares).abs() < NEGLIGIBLE) {
            continue;
        }
        let edge = |shares: &Shares| layers[..=index].iter().map(|layer| (layer.thickness)(shares)).sum::<f64>();
        let Range { start, end } = panel.y;
        let edge: Vec<(f64, f64)> = ledger.iter().map(|(time, shares)| (*time, edge(shares).clamp(start, end))).collect();
        let mut outline = decimate(&edge, &panel.x, panel.width_px as usize);
        let (Some(first), Some(last)) = (outline.first().copied(), outline.last().copied()) else {
            continue;
        };
        outline.extend([(last.0, start), (first.0, start)]);
        let corners: Vec<(f64, f64)> = outline.into_iter().map(|point| panel.position_px(point)).collect();
        write_area(svg, &corners, layer.colour, 1.0);
    }
}

/// Legend entries of the line and of every area that some device has.
fn keys(ledgers: &[Vec<(f64, Shares)>], layers: &[Layer]) -> [Vec<LegendEntry>; 2] {
    let any = |value: &dyn Fn(&Shares) -> f64| ledgers.iter().flatten().any(|(_, shares)| value(shares) > NEGLIGIBLE);
    let parts = [
        ("put in: ", true),
        ("at the start, ", any(&|shares| shares.initial)),
        ("by the ground", true),
        (", created by ideal clutches", any(&|shares| shares.created)),
        (", given by the paper's kinematics", any(&|shares| -shares.kinematics)),
    ];
    let line = parts.into_iter().filter_map(|(text, shown)| shown.then_some(text)).collect();
    let shown = layers.iter().filter(|layer| any(&|shares| (layer.thickness)(shares).abs()));
    let areas = shown.map(|layer| (Swatch::Tint(layer.colour), layer.name.to_owned())).collect();
    [vec![(Swatch::Line(Stroke::solid(INK)), line)], areas]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;
    use crate::plot::layer::units;
    use crate::plot::stack::LEFT_PX;
    use sprag_shared::observers::ledger::Entries;
    use sprag_shared::observers::outcome::Outcome;
    use sprag_sim::history::History;
    use sprag_sim::simulation::demand::Impulses;
    use sprag_sim::simulation::energy::EnergyReport;

    fn nothing() -> Shares {
        Entries::<f64>::default().into()
    }

    fn run(device: &str, outcome: Outcome, history: Vec<(f64, Shares)>) -> DeviceRun {
        let entries = history.last().map_or(nothing(), |(_, shares)| *shares);
        DeviceRun {
            device: device.to_owned(),
            outcome,
            peak_rotation: Some(0.5),
            peak_acceleration: Some(1.0),
            impacts: 3,
            first_impact_time_s: Some(1.0),
            end_time_s: 10.0,
            clutch_switches: 0,
            missed_engagements: 0,
            peak_force_ratio: None,
            impulses: Impulses::default(),
            checks: None,
            energy: Some(EnergyReport { entries, history }),
            sliding: None,
            error: None,
            history: History::default(),
        }
    }

    /// Kinetic and potential energy take turns and go to impacts, or grow until the potential energy drops.
    fn swinging(count: usize, grows: bool) -> Vec<(f64, Shares)> {
        let sample = |index: usize| {
            let part = index as f64 / count as f64;
            let (total, wave) = (if grows { 2.0 * part } else { 0.8 * (1.0 - part) }, (40.0 * part).fract());
            let potential = if grows && part > 0.9 { -50.0 * part } else { total * wave };
            let kinetic = total - potential;
            let impact = if grows { 0.0 } else { 0.8 * part };
            (9.0 * part, Shares { input: total + impact, kinetic, potential, impact, ..nothing() })
        };
        (0..count).map(sample).collect()
    }

    #[test]
    fn every_device_has_a_panel_and_only_what_some_device_has_is_in_the_legend() {
        let runs = [
            run("one & only", Outcome::Safe, swinging(500, false)),
            run("over", Outcome::OverturnedAfterImpact, swinging(500, true)),
            run("rest", Outcome::NoRocking, Vec::new()),
        ];
        let svg = energy_figure("A <title>", &runs, TimeAxis::Seconds, 2.0).unwrap();
        assert_drawn(&svg);
        assert_eq!(svg.matches("rotate(-90 ").count(), 3);
        assert_eq!(svg.matches(">overturns<").count(), 1);
        assert_eq!(svg.matches(">never rocks<").count(), 1);
        assert!(svg.contains("A &lt;title&gt;") && svg.contains("one &amp; only (safe)"));
        assert!(svg.contains("gone in impacts") && svg.contains(">potential<") && svg.contains(">kinetic<"));
        for absent in ["brakes", "clutches", "bearings", "the rack", "stored", "created", "kinematics"] {
            assert!(!svg.contains(absent), "{absent}");
        }
    }

    #[test]
    fn a_ledger_that_goes_on_while_its_block_rests_stays_in_its_frame() {
        let short = DeviceRun { end_time_s: 4.0, ..run("turns on", Outcome::Safe, swinging(500, false)) };
        let over = DeviceRun { end_time_s: 3.0, ..run("over", Outcome::OverturnedAfterImpact, swinging(500, true)) };
        let svg = energy_figure("", &[short, over], TimeAxis::Seconds, 2.0).unwrap();
        assert_drawn(&svg);
        let (left, right) = (units(LEFT_PX), units(LEFT_PX + PANELS_PX));
        let curves =
            svg.lines().filter_map(|line| line.strip_prefix("<path d=\"M")).filter(|line| line.matches('L').count() > 100);
        let curves: Vec<&str> = curves.filter_map(|line| line.split('"').next()).collect();
        assert_eq!(curves.len(), 2);
        for curve in curves {
            let across: Vec<i32> = curve.split(['M', 'L']).filter_map(|point| point.split(' ').next()?.parse().ok()).collect();
            assert!(across.is_sorted() && across.iter().all(|x| (left..=right).contains(x)), "{curve}");
        }
    }

    #[test]
    fn energy_that_the_papers_kinematics_give_is_put_in_and_what_they_take_is_an_area() {
        let of = |name: &str, kinematics: f64| {
            let add = |(time, shares): (f64, Shares)| (time, Shares { kinematics, ..shares });
            let history = swinging(100, false).into_iter().map(add).collect();
            energy_figure("", &[run(name, Outcome::Safe, history)], TimeAxis::Seconds, 2.0).unwrap()
        };
        let with = |kinematics: f64| of("one", kinematics);
        let (taken, given) = (with(0.25), with(-0.25));
        assert!(taken.contains("taken by the paper's kinematics") && taken.contains("kinematics took 0.250"));
        assert!(given.contains("given by the paper's kinematics") && given.contains("kinematics gave 0.250"));
        let long = of(&"long ".repeat(30), -0.25);
        assert!(long.contains("… (safe); by the end the paper's kinematics gave 0.250<"));
        let shares = Shares { input: 1.0, kinematics: -0.25, ..nothing() };
        assert_eq!(supply(&shares), 1.25);
    }

    #[test]
    fn over_p_t_all_curves_stay_at_their_places() {
        let runs =
            [run("one", Outcome::Safe, swinging(500, false)), run("over", Outcome::OverturnedAfterImpact, swinging(500, true))];
        let drawn = |axes| {
            let svg = energy_figure("", &runs, axes, 2.0).unwrap();
            assert_drawn(&svg);
            let shapes = svg.lines().filter(|line| !line.starts_with("<text") && !line.contains("v40") && !line.contains("v-40"));
            (shapes.map(str::to_owned).collect::<Vec<String>>(), svg.contains("time (s)"), svg.contains(">20<"))
        };
        // A p of 2 1/s is exact, so that ten seconds are 20.
        let (seconds, over_p_t) = (drawn(TimeAxis::Seconds), drawn(TimeAxis::TimesFrequencyParameter));
        assert_eq!(seconds.0, over_p_t.0);
        assert_eq!([(seconds.1, seconds.2), (over_p_t.1, over_p_t.2)], [(true, false), (false, true)]);
        let without = energy_figure("", &runs, TimeAxis::TimesFrequencyParameter, 0.0);
        assert_eq!(without, Err(PlotError::InvalidBlock { device: "one".to_owned() }));
    }

    #[test]
    fn long_ledgers_stay_small_and_the_bytes_repeat() {
        let runs = [run("long", Outcome::Safe, swinging(200_000, false))];
        let svg = energy_figure("", &runs, TimeAxis::Seconds, 2.0).unwrap();
        assert_drawn(&svg);
        assert!(svg.len() < 300_000, "{}", svg.len());
        assert_eq!(svg, energy_figure("", &runs, TimeAxis::Seconds, 2.0).unwrap());
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert_eq!(energy_figure("", &[], TimeAxis::Seconds, 2.0), Err(PlotError::NoHistories));
        let mut without = run("none", Outcome::Safe, Vec::new());
        without.energy = None;
        assert_eq!(energy_figure("", &[without], TimeAxis::Seconds, 2.0), Err(PlotError::NoHistories));
        let mut history = swinging(100, false);
        history[50].1.kinetic = f64::NAN;
        let broken = energy_figure("", &[run("one", Outcome::Safe, history.clone())], TimeAxis::Seconds, 2.0);
        assert!(matches!(broken, Err(PlotError::NotFinite { .. })));
        history[50].1.kinetic = 0.0;
        history.swap(3, 30);
        assert!(matches!(
            energy_figure("", &[run("one", Outcome::Safe, history)], TimeAxis::Seconds, 2.0),
            Err(PlotError::TimeGoesBack { .. })
        ));
    }
}
