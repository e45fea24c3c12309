//! Shading of engaged intervals, impact marks, and the notes where blocks overturn.

use super::device_trace::DeviceTrace;
use super::layer::{Text, units, write_rect};
use super::legend::{LegendEntry, Swatch};
use super::palette::{Colour, FLYWHEEL_TINTS, INK, hex};
use super::panel::Panel;
use super::text_width::text_width_px;

/// Impact marks a device may show before they are thinned out.
const MOST_MARKS: usize = 60;

/// Intervals a device may show before narrow ones are left out, and the least width from then on (px).
const MOST_INTERVALS: usize = 500;
const LEAST_WIDTH_PX: f64 = 1.0;

/// Width of the coloured bar that names the owner of a lane (px).
const LANE_BAR_PX: f64 = 3.0;

const NOTE: &str = "overturns";
const NOTE_FONT_PX: f64 = 10.5;

/// Half the width, and the height, of the mark where a block overturns (px).
const OVERTURN_PX: (f64, f64) = (3.5, 6.0);

/// Legend entries of the devices, and of the marks that the figure actually shows.
pub(super) fn device_keys(traces: &[DeviceTrace]) -> [Vec<LegendEntry>; 2] {
    let mut marks = Vec::new();
    for (index, name) in ["first flywheel engaged", "second flywheel engaged"].into_iter().enumerate() {
        let shown = |trace: &DeviceTrace| trace.engagements.iter().any(|(.., engaged)| (usize::from(*engaged) >> index) & 1 == 1);
        if traces.iter().any(shown) {
            marks.push((Swatch::Tint(FLYWHEEL_TINTS[index]), name.to_owned()));
        }
    }
    if traces.iter().filter(|trace| !trace.engagements.is_empty()).count() > 1 {
        let bar = |svg: &mut String, (x, y): (f64, f64)| {
            write_rect(svg, (units(x), units(y - 5.0)), (units(LANE_BAR_PX), units(10.0)), INK);
        };
        marks.push((Swatch::Drawn(bar), "device of a shaded lane".to_owned()));
    }
    if traces.iter().any(|trace| !trace.impacts.is_empty()) {
        let triangle = |svg: &mut String, (x, y): (f64, f64)| {
            svg.push_str(&format!("<path d=\"{}\" fill=\"{}\"/>\n", impact(units(x), units(y - 2.5), 1), hex(INK)));
        };
        marks.push((Swatch::Drawn(triangle), "impact".to_owned()));
    }
    [traces.iter().map(|trace| (Swatch::Line(trace.look.stroke()), trace.label.clone())).collect(), marks]
}

/// Path of the triangle of an impact with its tip at `x` and `y` (drawing units): the upper corner for a `side` of 1, the lower for −1.
fn impact(x: i32, y: i32, side: i32) -> String {
    format!("M{x} {y}l{} {}h{}z", -units(2.2), side * units(5.0), units(4.4))
}

/// Appends tints over the intervals in which a flywheel is engaged; while both are, the first has the upper half and the second the lower.
///
/// One clutched device shades the whole height. Several share it in lanes, top to bottom, each with a bar in the
/// device's colour right of the frame.
pub(super) fn write_shading(svg: &mut String, panel: &Panel<'_>, traces: &[DeviceTrace]) {
    let clutched: Vec<&DeviceTrace> = traces.iter().filter(|trace| !trace.engagements.is_empty()).collect();
    let lane_px = panel.height_px / clutched.len().max(1) as f64;
    for (lane, trace) in clutched.iter().enumerate() {
        let top = units(panel.top_px + lane as f64 * lane_px);
        let height = units(panel.top_px + (lane + 1) as f64 * lane_px) - top;
        let least = if trace.engagements.len() > MOST_INTERVALS { LEAST_WIDTH_PX } else { 0.0 };
        let mut bars = [const { Vec::new() }; 4];
        for &(from, to, engaged) in &trace.engagements {
            let left = units(panel.position_px((from, 0.0)).0);
            let width = units(panel.position_px((to, 0.0)).0) - left;
            if width > 0 && width >= units(least) {
                bars[usize::from(engaged & 3)].push((left, width));
            }
        }
        let ([_, one, other, both], [first, second], half) = (&bars, FLYWHEEL_TINTS, height / 2);
        write_bars(svg, one, (top, height), first);
        write_bars(svg, other, (top, height), second);
        write_bars(svg, both, (top, half), first);
        write_bars(svg, both, (top + half, height - half), second);
        if clutched.len() > 1 {
            let bar = (units(LANE_BAR_PX), height - units(2.0));
            write_rect(svg, (units(panel.right_px() + 3.0), top + units(1.0)), bar, trace.look.colour);
        }
    }
}

/// Appends filled bars, each a left edge and a width, between one upper edge and one height; all in drawing units.
///
/// One path is a third of the text that rectangles would be.
pub(super) fn write_bars(svg: &mut String, bars: &[(i32, i32)], (top, height): (i32, i32), fill: Colour) {
    let path: String = bars.iter().map(|(left, width)| format!("M{left} {top}h{width}v{height}h{}z", -width)).collect();
    if !path.is_empty() {
        svg.push_str(&format!("<path d=\"{path}\" fill=\"{}\"/>\n", hex(fill)));
    }
}

/// Appends a triangle for each impact; its tip touches the line θ = 0.
///
/// Devices take turns above and below the line. Beyond 60 impacts only marks that keep a minimum distance stay.
pub(super) fn write_impacts(svg: &mut String, panel: &Panel<'_>, traces: &[DeviceTrace]) {
    let zero = units(panel.position_px((panel.x.start, 0.0)).1);
    for (index, trace) in traces.iter().enumerate() {
        let side = if index % 2 == 0 { 1 } else { -1 };
        let mut path = String::new();
        for x_px in thinned(panel, &trace.impacts) {
            path.push_str(&impact(units(x_px), zero, side));
        }
        if !path.is_empty() {
            svg.push_str(&format!(
                "<path d=\"{path}\" fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"4\"/>\n",
                hex(trace.look.colour),
            ));
        }
    }
}

fn thinned(panel: &Panel<'_>, impacts: &[f64]) -> Vec<f64> {
    let distance = if impacts.len() > MOST_MARKS { panel.width_px / MOST_MARKS as f64 } else { 0.0 };
    let mut kept: Vec<f64> = Vec::new();
    for &time in impacts.iter().filter(|&&time| time >= panel.x.start && time <= panel.x.end) {
        let x = panel.position_px((time, 0.0)).0;
        if kept.last().is_none_or(|last| x - last >= distance) {
            kept.push(x);
        }
    }
    kept
}

/// Appends a mark and the word "overturns" where a block's curve leaves the panel for good.
///
/// Words move away from the edge, row by row, until they overlap no mark and no earlier word.
pub(super) fn write_overturns(svg: &mut String, panel: &Panel<'_>, traces: &[DeviceTrace]) {
    let width = text_width_px(NOTE, NOTE_FONT_PX);
    let first_baseline = |up: bool, y: f64| if up { y + NOTE_FONT_PX } else { y - 3.0 };
    let (half_px, height_px) = OVERTURN_PX;
    // Left and right ends, and baselines; a mark is in the first row.
    let mark = |point: (f64, f64)| {
        let (x, y) = panel.position_px(point);
        (x - half_px, x + half_px, first_baseline(point.1 >= 0.0, y))
    };
    let mut taken: Vec<(f64, f64, f64)> = traces.iter().filter_map(|trace| trace.overturn).map(mark).collect();
    for trace in traces {
        let Some(point) = trace.overturn else {
            continue;
        };
        let (x, y) = panel.position_px(point);
        let up = point.1 >= 0.0;
        let outward = if up { -1 } else { 1 };
        svg.push_str(&format!(
            "<path d=\"M{} {}h{}l{} {}z\" fill=\"{}\"/>\n",
            units(x - half_px),
            units(y) - outward * units(height_px),
            units(2.0 * half_px),
            -units(half_px),
            outward * units(height_px),
            hex(trace.look.colour),
        ));

        // The curve comes from the left, so the free space is on the right unless the frame is near.
        let left = if x + 6.0 + width <= panel.right_px() { x + 6.0 } else { x - 8.0 - width };
        let row_px = NOTE_FONT_PX + 2.0;
        let first = first_baseline(up, y);
        let rows = (panel.height_px / row_px) as usize;
        let baseline = (0..rows)
            .map(|row| first - f64::from(outward) * row as f64 * row_px)
            .find(|baseline| {
                taken.iter().all(|other| other.0 > left + width || other.1 < left || (other.2 - baseline).abs() > 0.95 * row_px)
            })
            .unwrap_or(first);
        taken.push((left, left + width, baseline));
        Text {
            colour: trace.look.colour,
            attributes: " paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"30\"",
            ..Text::new(NOTE, (left, baseline), NOTE_FONT_PX)
        }
        .write(svg, false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::TimeAxis;
    use crate::plot::synthetic::overturning;

    fn panel() -> Panel<'static> {
        Panel::new((0.0, 0.0), (600.0, 100.0), 0.0..10.0, -1.0..1.0)
    }

    #[test]
    fn no_word_covers_the_mark_of_another_device() {
        let history = overturning("none", 100);
        let trace = |(index, overturn)| DeviceTrace {
            overturn: Some(overturn),
            ..DeviceTrace::new(index, &history, TimeAxis::Seconds, 1.0)
        };
        // Words right of their marks at the upper edge, and left of them at the lower, where the frame is near.
        let at = [(5.0, 1.0), (5.4, 1.0), (5.4, 1.0), (9.9, -1.0), (9.5, -1.0)];
        let traces: Vec<DeviceTrace> = at.into_iter().enumerate().map(trace).collect();
        let mut svg = String::new();
        write_overturns(&mut svg, &panel(), &traces);
        let numbers = |line: &str| -> Vec<i32> {
            line.split(|letter: char| !letter.is_ascii_digit() && letter != '-')
                .filter_map(|number| number.parse().ok())
                .collect()
        };
        // x, y, width, half of it, height; and x, y.
        let marks: Vec<Vec<i32>> = svg.lines().filter(|line| line.starts_with("<path")).map(numbers).collect();
        let words: Vec<Vec<i32>> = svg.lines().filter(|line| line.starts_with("<text")).map(numbers).collect();
        assert_eq!((marks.len(), words.len()), (5, 5));
        for (word, mark) in words.iter().flat_map(|word| marks.iter().map(move |mark| (word, mark))) {
            let across = word[0] < mark[0] + mark[2] && mark[0] < word[0] + units(text_width_px(NOTE, NOTE_FONT_PX));
            let (low, high) = (mark[1].min(mark[1] + mark[4]), mark[1].max(mark[1] + mark[4]));
            let up = word[1] - units(0.7 * NOTE_FONT_PX) < high && low < word[1];
            assert!(!(across && up), "{word:?} covers {mark:?}");
        }
    }

    #[test]
    fn many_impacts_are_thinned_and_few_are_not() {
        let few: Vec<f64> = (0..60).map(|index| 5.0 + f64::from(index) * 1e-3).collect();
        assert_eq!(thinned(&panel(), &few).len(), 60);
        let many: Vec<f64> = (0..5000).map(|index| f64::from(index) * 2e-3).collect();
        assert!((50..=61).contains(&thinned(&panel(), &many).len()));
    }
}
