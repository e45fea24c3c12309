//! Bars over time, in lanes: what a law wants, commands, clutches, states.

use super::engagement::write_bars;
use super::layer::{Anchor, Text, units};
use super::legend::{LegendEntry, Swatch};
use super::palette::{Colour, FLYWHEEL_BARS, FLYWHEEL_TINTS};
use super::panel::Panel;

/// Height of a lane, and of the bars in it (px).
pub(super) const LANE_PX: f64 = 26.0;
const BAR_PX: f64 = 16.0;
const LANE_FONT_PX: f64 = 10.5;
/// Bars closer than this are one, and none is narrower (drawing units).
const LEAST_GAP: i32 = 3;

/// Left edges and widths (drawing units) of the times in which `active` holds, each value until the next sample. Times that would
/// be too narrow to see are widened, and gaps too narrow to see are closed.
fn bars(panel: &Panel<'_>, time: &[f64], active: impl Fn(usize) -> bool) -> Vec<(i32, i32)> {
    let x = |time: f64| units(panel.position_px((time, panel.y.start)).0);
    let mut bars: Vec<(i32, i32)> = Vec::new();
    for (index, pair) in time.windows(2).enumerate() {
        if !active(index) {
            continue;
        }
        let (left, right) = (x(pair[0]), x(pair[1]));
        match bars.last_mut() {
            Some(bar) if left - bar.1 <= LEAST_GAP => bar.1 = right,
            _ => bars.push((left, right)),
        }
    }
    bars.into_iter().map(|(left, right)| (left, (right - left).max(LEAST_GAP))).collect()
}

/// Appends bars where a flywheel is engaged in `states`; while both are, the first has the upper half and the second the lower.
pub(super) fn write_flywheels(
    svg: &mut String,
    panel: &Panel<'_>,
    (top_px, height_px): (f64, f64),
    (time, states): (&[f64], &[u8]),
    colours: [Colour; 2],
) {
    let mut draw = |from_px: f64, to_px: f64, shown: [fn(u8) -> bool; 2]| {
        let extent = (units(from_px), units(to_px) - units(from_px));
        for (shown, colour) in shown.into_iter().zip(colours) {
            let active = |index: usize| states.get(index).is_some_and(|state| shown(state & 3));
            write_bars(svg, &bars(panel, time, active), extent, colour);
        }
    };
    let (middle_px, bottom_px) = (top_px + 0.5 * height_px, top_px + height_px);
    if states.iter().any(|state| state & 3 == 3) {
        draw(top_px, middle_px, [|state| state & 1 != 0, |state| state == 2]);
        draw(middle_px, bottom_px, [|state| state == 1, |state| state & 2 != 0]);
    } else {
        draw(top_px, bottom_px, [|state| state == 1, |state| state == 2]);
    }
}

/// Appends lane number `lane`: its name, a line for each of its words, and the bars that `draw` appends between an upper edge and a height.
pub(super) fn write_lane(
    svg: &mut String,
    panel: &Panel<'_>,
    (lane, words): (usize, &[&str]),
    draw: impl FnOnce(&mut String, (f64, f64)),
) {
    let top_px = panel.top_px + lane as f64 * LANE_PX;
    draw(svg, (top_px + 0.5 * (LANE_PX - BAR_PX), BAR_PX));
    for (line, word) in words.iter().enumerate() {
        let down = (line as f64 - 0.5 * (words.len() as f64 - 1.0)) * LANE_FONT_PX;
        let at = (panel.left_px - 6.0, top_px + 0.5 * LANE_PX + down + 0.36 * LANE_FONT_PX);
        Text { anchor: Anchor::End, ..Text::new(word, at, LANE_FONT_PX) }.write(svg, false);
    }
}

/// Appends bars where `active` holds.
pub(super) fn write_state(
    svg: &mut String,
    panel: &Panel<'_>,
    (top_px, height_px): (f64, f64),
    (time, colour): (&[f64], Colour),
    active: impl Fn(usize) -> bool,
) {
    write_bars(svg, &bars(panel, time, active), (units(top_px), units(height_px)), colour);
}

/// Legend entries of the flywheels that occur in `states`.
pub(super) fn flywheel_keys<'a>(states: impl Iterator<Item = &'a u8>) -> Vec<LegendEntry> {
    let shown = states.fold(0, |shown, state| shown | state);
    let key = |(bit, name): (usize, &str)| {
        (shown & (1 << bit) != 0).then(|| (Swatch::Tints(FLYWHEEL_TINTS[bit], FLYWHEEL_BARS[bit]), name.to_owned()))
    };
    ["first flywheel", "second flywheel"].into_iter().enumerate().filter_map(key).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_hold_until_the_next_sample_and_close_narrow_gaps() {
        let panel = Panel::new((0.0, 0.0), (100.0, 10.0), 0.0..10.0, 0.0..1.0);
        let time: Vec<f64> = (0..=10).map(f64::from).collect();
        assert_eq!(bars(&panel, &time, |index| (2..5).contains(&index) || index == 7), vec![(200, 300), (700, 100)]);
        // The last value has no next sample.
        assert!(bars(&panel, &time, |index| index == 10).is_empty());
        let fine: Vec<f64> = (0..=100_000).map(|index| f64::from(index) * 1e-4).collect();
        assert_eq!(bars(&panel, &fine, |index| index % 2 == 0).len(), 1);
        assert_eq!(bars(&panel, &fine, |index| index == 50_000), vec![(500, LEAST_GAP)]);
    }
}
