//! The figure of a study of sensitivity: how much each variant changes the peak rotation of each device.

use super::layer::{Anchor, Text, document, escape, path_through, units, write_disc, write_path, write_rect};
use super::legend::{BOLD_WIDTH, DrawMark, LegendEntry, Swatch, write_heading};
use super::palette::{Colour, GROUND, INK, Stroke, device_look, hex};
use super::panel::{BOTTOM_LABELS_PX, MARGIN_PX, Panel};
use super::text_width::text_width_px;
use super::{FigureTitle, PlotError};

const WIDTH_PX: f64 = 900.0;
/// Left of the axis, for effects and variants, at least.
const LABELS_PX: f64 = 280.0;
/// Where variants start, right of their effects, at least.
const VARIANT_PX: f64 = 96.0;
/// Right of labels, where a triangle may stick out of the axis (px).
const LABEL_GAP_PX: f64 = 12.0;
/// Right of the axis, for one column of counts.
const COUNT_PX: f64 = 62.0;
/// Above the axis, for the titles of these columns.
const HEAD_PX: f64 = 34.0;
const LANE_PX: f64 = 13.0;
const ROW_GAP_PX: f64 = 7.0;
const FONT_PX: f64 = 11.5;
const SMALL_FONT_PX: f64 = 10.5;
const DOT_PX: f64 = 2.4;
const MEDIAN_PX: f64 = 4.6;
const DIAMOND_PX: f64 = 5.4;
/// Half-widths that the axis may have; nothing can shrink by more than all of it.
const LIMITS: [f64; 6] = [0.02, 0.05, 0.1, 0.2, 0.5, 1.0];
/// Part of the changes that the axis should hold.
const HELD: f64 = 0.93;
/// Bands behind every other effect.
const BAND: Colour = Colour(245, 245, 245);

/// One variant.
#[derive(Clone, Debug)]
pub struct SensitivityRow {
    /// Effect, the same in neighbouring rows of one effect.
    pub effect: String,
    /// What it is set to.
    pub variant: String,
    /// The devices that it is for.
    pub lanes: Vec<SensitivityLane>,
}

/// One device of a row. Changes are relative to the device without the variant.
#[derive(Clone, Debug)]
pub struct SensitivityLane {
    /// Number of the device.
    pub device: usize,
    /// Under each record.
    pub changes: Vec<f64>,
    /// 16th percentile, median and 84th percentile of these.
    pub quantiles: Option<[f64; 3]>,
    /// Under the scene's own motion.
    pub own: Option<OwnMark>,
    /// Records that overturn the block only with the variant.
    pub overturns: usize,
    /// Records that overturn it only without.
    pub stands: usize,
}

/// What the scene's own motion shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OwnMark {
    /// A relative change.
    Change(f64),
    /// The block overturns instead.
    Overturns,
    /// The block stands instead.
    Stands,
}

/// Draws `rows` as an SVG document: a lane for each device, the change of its peak rotation along a shared axis in percent.
///
/// Dots are records, a disc their median on the line from the 16th to the 84th percentile, a diamond the scene's own motion.
/// What lies beyond the axis is a triangle at its edge. Columns on the right count the records that change the outcome; a diamond
/// there is the scene's own motion doing so. The text is the same for the same input.
///
/// # Errors
/// [`PlotError`] without rows, and for changes that are not finite.
pub fn sensitivity_figure(
    title: impl Into<FigureTitle>,
    devices: &[String],
    rows: &[SensitivityRow],
) -> Result<String, PlotError> {
    let title = title.into();
    if rows.is_empty() {
        return Err(PlotError::NoHistories);
    }
    let lanes = || rows.iter().flat_map(|row| &row.lanes);
    for lane in lanes() {
        if !lane.values().all(f64::is_finite) {
            return Err(PlotError::NotFinite { device: devices.get(lane.device).cloned().unwrap_or_default(), time_s: 0.0 });
        }
    }
    let mut body = String::new();
    // Long labels make the figure wider, not its axis narrower.
    let widest = |texts: &dyn Fn(&SensitivityRow) -> f64| rows.iter().map(texts).fold(0.0, f64::max);
    let variant_px = (widest(&|row| text_width_px(&row.effect, FONT_PX)) / BOLD_WIDTH + LABEL_GAP_PX).max(VARIANT_PX);
    let labels_px = (variant_px + widest(&|row| text_width_px(&row.variant, FONT_PX)) + LABEL_GAP_PX).max(LABELS_PX);
    let figure_px = WIDTH_PX + labels_px - LABELS_PX;
    let (left_px, width_px) = (MARGIN_PX, figure_px - 2.0 * MARGIN_PX);
    let legend_px = write_heading(&mut body, &title, &keys(devices, rows), (left_px, width_px));

    let row_px = |row: &SensitivityRow| row.lanes.len().max(1) as f64 * LANE_PX + ROW_GAP_PX;
    let limit = limit(lanes().flat_map(SensitivityLane::values));
    let panel = Panel::new(
        (left_px + labels_px, legend_px + HEAD_PX),
        (width_px - labels_px - 2.0 * COUNT_PX, rows.iter().map(row_px).sum()),
        -100.0 * limit..100.0 * limit,
        0.0..1.0,
    );
    let axis = Axis { panel: Panel { y_ticks: false, ..panel }, limit };
    let mut marks = String::new();
    let (mut top_px, mut band) = (axis.panel.top_px, false);
    for (index, row) in rows.iter().enumerate() {
        let starts = index == 0 || rows[index - 1].effect != row.effect;
        band ^= starts;
        if band {
            let size = (units(width_px), units(row_px(row)));
            write_rect(&mut body, (units(left_px), units(top_px)), size, BAND);
        }
        let baseline = top_px + 0.5 * row_px(row) + 0.36 * FONT_PX;
        if starts {
            let text = escape(&row.effect);
            let text = Text::new(&text, (left_px + 4.0, baseline), FONT_PX);
            Text { attributes: " font-weight=\"bold\"", ..text }.write(&mut marks, false);
        }
        Text::new(&escape(&row.variant), (left_px + variant_px, baseline), FONT_PX).write(&mut marks, false);
        for (number, lane) in row.lanes.iter().enumerate() {
            let middle = top_px + 0.5 * ROW_GAP_PX + (number as f64 + 0.5) * LANE_PX;
            write_lane(&mut marks, &axis, lane, middle);
        }
        top_px += row_px(row);
    }
    axis.write(&mut body);
    body.push_str(&marks);

    let height_px = axis.panel.bottom_px() + BOTTOM_LABELS_PX + 4.0;
    Ok(document(&title.text, (figure_px, height_px), &body))
}

impl SensitivityLane {
    fn values(&self) -> impl Iterator<Item = f64> {
        let own = match self.own {
            Some(OwnMark::Change(change)) => Some(change),
            _ => None,
        };
        self.changes.iter().copied().chain(self.quantiles.into_iter().flatten()).chain(own)
    }
}

/// The smallest of [`LIMITS`] that holds most of `changes`.
fn limit(changes: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = changes.map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    let held = sizes.get((HELD * sizes.len() as f64) as usize).or(sizes.last()).copied().unwrap_or(0.0);
    LIMITS.into_iter().find(|limit| held <= *limit).unwrap_or(LIMITS[LIMITS.len() - 1])
}

/// The panel of the changes, in percent, and the columns of counts on its right.
struct Axis {
    panel: Panel<'static>,
    /// Largest change that it shows, relative.
    limit: f64,
}

impl Axis {
    fn position_px(&self, change: f64) -> f64 {
        self.panel.position_px((100.0 * change, 0.0)).0
    }

    /// Middle of the column of counts number `index`.
    fn column_px(&self, index: usize) -> f64 {
        self.panel.right_px() + (index as f64 + 0.5) * COUNT_PX
    }

    fn write(&self, svg: &mut String) {
        self.panel.write_grid(svg);
        let zero = [self.panel.y.start, self.panel.y.end].map(|at| self.panel.position_px((0.0, at)));
        write_path(svg, &path_through(zero), Stroke { width_px: 1.0, ..Stroke::solid(INK) });
        self.panel.write_frame(svg, Some("change of the peak rotation (%)"));
        for (index, words) in [["overturns", "instead"], ["stands", "instead"]].into_iter().enumerate() {
            for (line, word) in words.into_iter().enumerate() {
                let at = (self.column_px(index), self.panel.top_px - 18.0 + 12.0 * line as f64);
                Text { anchor: Anchor::Middle, colour: GROUND, ..Text::new(word, at, SMALL_FONT_PX) }.write(svg, false);
            }
        }
    }
}

fn write_lane(svg: &mut String, axis: &Axis, lane: &SensitivityLane, middle_px: f64) {
    let colour = device_look(lane.device).colour;
    for &change in &lane.changes {
        if change.abs() <= axis.limit {
            write_disc(svg, (axis.position_px(change), middle_px), DOT_PX, colour, " fill-opacity=\"0.45\"");
        } else {
            write_beyond(svg, axis, change, middle_px, colour);
        }
    }
    if let Some(quantiles) = lane.quantiles {
        let [low, median, high] = quantiles;
        write_range(svg, [low, high].map(|change| axis.position_px(change.clamp(-axis.limit, axis.limit))), middle_px, colour);
        if median.abs() <= axis.limit {
            write_median(svg, (axis.position_px(median), middle_px), colour);
        } else {
            write_beyond(svg, axis, median, middle_px, colour);
        }
    }
    match lane.own {
        Some(OwnMark::Change(change)) if change.abs() <= axis.limit => {
            write_diamond(svg, (axis.position_px(change), middle_px), colour);
        }
        Some(OwnMark::Change(change)) => {
            let inwards = if change > 0.0 { -DIAMOND_PX } else { DIAMOND_PX };
            write_diamond(svg, (axis.position_px(axis.limit.copysign(change)) + inwards, middle_px), colour);
            write_beyond(svg, axis, change, middle_px, colour);
        }
        Some(OwnMark::Overturns) => write_diamond(svg, (axis.column_px(0) - 14.0, middle_px), colour),
        Some(OwnMark::Stands) => write_diamond(svg, (axis.column_px(1) - 14.0, middle_px), colour),
        None => {}
    }
    for (index, count) in [lane.overturns, lane.stands].into_iter().enumerate() {
        if count > 0 {
            let text = count.to_string();
            let at = (axis.column_px(index), middle_px + 0.36 * SMALL_FONT_PX);
            let text = Text::new(&text, at, SMALL_FONT_PX);
            Text { anchor: Anchor::Middle, colour, attributes: " font-weight=\"bold\"", ..text }.write(svg, false);
        }
    }
}

/// Appends the disc of a median.
fn write_median(svg: &mut String, at_px: (f64, f64), colour: Colour) {
    write_disc(svg, at_px, MEDIAN_PX, colour, " stroke=\"#ffffff\" stroke-width=\"12\"");
}

/// Appends the line between the outer quantiles.
fn write_range(svg: &mut String, [low_px, high_px]: [f64; 2], middle_px: f64, colour: Colour) {
    let (from, to, y) = (units(low_px), units(high_px), units(middle_px));
    svg.push_str(&format!("<path d=\"M{from} {y}H{to}\" stroke=\"{}\" stroke-width=\"16\"/>\n", hex(colour)));
}

fn write_diamond(svg: &mut String, (x_px, y_px): (f64, f64), colour: Colour) {
    let half = units(DIAMOND_PX);
    svg.push_str(&format!(
        "<path d=\"M{} {}l{half} {half}l-{half} {half}l-{half} -{half}z\" fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"16\"/>\n",
        units(x_px),
        units(y_px) - half,
        hex(colour),
    ));
}

/// A triangle that points over the edge of the axis.
fn write_beyond(svg: &mut String, axis: &Axis, change: f64, middle_px: f64, colour: Colour) {
    let side = change.signum();
    write_triangle(svg, (axis.position_px(side * axis.limit) + 6.0 * side, middle_px), -side as i32, colour);
}

fn write_triangle(svg: &mut String, (x_px, y_px): (f64, f64), base: i32, colour: Colour) {
    let (length, half) = (base * units(6.0), units(3.2));
    svg.push_str(&format!(
        "<path d=\"M{} {}l{length} -{half}v{}z\" fill=\"{}\" fill-opacity=\"0.6\"/>\n",
        units(x_px),
        units(y_px),
        2 * half,
        hex(colour),
    ));
}

fn write_quantiles_key(svg: &mut String, (x, y): (f64, f64)) {
    write_range(svg, [x - 9.0, x + 9.0], y, INK);
    write_median(svg, (x, y), INK);
}

/// Legend entries of the devices that are drawn, and of all marks.
fn keys(devices: &[String], rows: &[SensitivityRow]) -> [Vec<LegendEntry>; 2] {
    let used = |index: &usize| rows.iter().flat_map(|row| &row.lanes).any(|lane| lane.device == *index);
    let device = |index: usize| (Swatch::Tint(device_look(index).colour), devices[index].clone());
    let marks: [(DrawMark, &str); 4] = [
        (|svg, at| write_disc(svg, at, DOT_PX, INK, " fill-opacity=\"0.45\""), "a record"),
        (write_quantiles_key, "median, 16th to 84th percentile"),
        (|svg, at| write_diamond(svg, at, INK), "the scene's own motion"),
        (|svg, (x, y)| write_triangle(svg, (x + 3.0, y), -1, INK), "beyond the axis"),
    ];
    [
        (0..devices.len()).filter(used).map(device).collect(),
        marks.map(|(draw, name)| (Swatch::Drawn(draw), name.to_owned())).to_vec(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;

    fn rows() -> Vec<SensitivityRow> {
        let lane = |device: usize, change: f64| SensitivityLane {
            device,
            changes: vec![change, -change, 30.0 * change],
            quantiles: Some([-change, change, 2.0 * change]),
            own: Some(OwnMark::Change(change)),
            overturns: device,
            stands: 0,
        };
        let row = |effect: &str, variant: &str, lanes| SensitivityRow { effect: effect.into(), variant: variant.into(), lanes };
        let flipped = SensitivityLane { own: Some(OwnMark::Overturns), quantiles: None, changes: vec![], ..lane(1, 0.0) };
        vec![
            row("impact", "geometric & <more>", vec![lane(0, 0.1), lane(1, -0.05)]),
            row("impact", "momentum balance", vec![lane(0, 0.2)]),
            row("rack", "dry friction", vec![flipped]),
        ]
    }

    #[test]
    fn a_figure_is_finite_escaped_and_repeats_to_the_byte() {
        let devices = ["none", "pair"].map(str::to_owned);
        let svg = sensitivity_figure("A & B", &devices, &rows()).unwrap();
        assert!(svg.contains("A &amp; B") && svg.contains("geometric &amp; &lt;more&gt;"));
        for bad in ["NaN", "inf", "2147483647", "--"] {
            assert!(!svg.contains(bad), "{bad}");
        }
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        assert_eq!(svg.matches(">impact<").count(), 1);
        assert_eq!(svg, sensitivity_figure("A & B", &devices, &rows()).unwrap());
    }

    #[test]
    fn long_labels_have_room() {
        let devices = ["none", "pair"].map(str::to_owned);
        let width = |rows: &[SensitivityRow]| {
            let svg = sensitivity_figure("A study", &devices, rows).unwrap();
            assert_drawn(&svg);
            svg.split("<svg ")
                .nth(1)
                .unwrap()
                .split(" width=\"")
                .nth(1)
                .unwrap()
                .split('"')
                .next()
                .unwrap()
                .parse::<f64>()
                .unwrap()
        };
        let mut rows = rows();
        let plain = width(&rows);
        rows[1].variant = "capacity of a tenth of the block's weight, released flywheels stopped by an instant brake".to_owned();
        rows[2].effect = "friction of the rack".to_owned();
        let needed = text_width_px(&rows[1].variant, FONT_PX);
        assert!(width(&rows) - plain > needed - LABELS_PX + VARIANT_PX);
    }

    /// A median that lies further out than the axis is no disc at its edge.
    #[test]
    fn a_median_beyond_the_axis_is_a_triangle() {
        let drawn = |median: f64| {
            let lane =
                SensitivityLane { quantiles: Some([0.5, median, 3.0]), changes: vec![], own: None, ..rows()[0].lanes[0].clone() };
            let rows = [SensitivityRow { lanes: vec![lane], ..rows()[0].clone() }];
            let svg = sensitivity_figure("A study", &["none".to_owned()], &rows).unwrap();
            let (discs, triangles) = (svg.matches("stroke=\"#ffffff\"").count(), svg.matches("fill-opacity=\"0.6\"").count());
            (discs, triangles)
        };
        let ((discs, triangles), beyond) = (drawn(0.9), drawn(2.0));
        assert_eq!(beyond, (discs - 1, triangles + 1));
    }

    #[test]
    fn the_axis_holds_most_changes_and_a_figure_needs_finite_ones() {
        assert_eq!(limit([0.0; 5].into_iter()), LIMITS[0]);
        assert_eq!(limit((0..1000).map(|k| f64::from(k) * 1e-4)), 0.1);
        assert_eq!(limit([1e9].into_iter()), 1.0);
        assert_eq!(sensitivity_figure("", &[], &[]), Err(PlotError::NoHistories));
        let mut rows = rows();
        rows[0].lanes[0].changes[0] = f64::NAN;
        assert!(matches!(sensitivity_figure("", &["none".to_owned()], &rows), Err(PlotError::NotFinite { .. })));
    }
}
