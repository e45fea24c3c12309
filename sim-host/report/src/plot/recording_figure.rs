//! The figure of an earthquake as a device recorded it: ground, rotation and velocity over time, commands, clutches and phases.

use std::ops::Range;

use super::curve::write_curve;
use super::fault_mark::{FAULT_ROW_PX, fault_places, fault_stroke, write_faults};
use super::lane::{LANE_PX, bars, write_flywheels, write_lane_name};
use super::layer::{document, units};
use super::legend::{Key, Swatch, write_heading};
use super::palette::{FAULT, FLYWHEEL_BARS, FLYWHEEL_TINTS, GROUND, Stroke, device_look};
use super::panel::{BOTTOM_LABELS_PX, LEFT_LABELS_PX, Panel, scale_around_zero};
use super::time_axis::span_of;
use super::{FigureTitle, PlotError};
use crate::plot::engagement::write_bars;

const WIDTH_PX: f64 = 760.0;
const MARGIN_PX: f64 = 10.0;
/// Wider on the right, where half of the last tick label sticks out.
const RIGHT_MARGIN_PX: f64 = 20.0;
const GAP_PX: f64 = 11.0;
const GROUND_PANEL_PX: f64 = 84.0;
const ROTATION_PANEL_PX: f64 = 184.0;
const VELOCITY_PANEL_PX: f64 = 118.0;
/// Height of a bar in its lane (px).
const BAR_PX: f64 = 16.0;
const LANES: [&str; 3] = ["command", "clutches", "state"];

/// A recording over time; all but `faults` have the length of `time`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordingTrace {
    /// Time (s), in order.
    pub time: Vec<f64>,
    /// Ground acceleration (g).
    pub ground_g: Vec<f64>,
    /// Rotation θ (rad).
    pub rotation: Vec<f64>,
    /// Angular velocity θ' (rad/s).
    pub velocity: Vec<f64>,
    /// Clutches that are commanded: 0 none, 1 the first, 2 the second, 3 both.
    pub commanded: Vec<u8>,
    /// Clutches that are engaged, as in `commanded`.
    pub engaged: Vec<u8>,
    /// 0 at rest, 1 rocking, 2 in Fault.
    pub state: Vec<u8>,
    /// Times (s) and texts of faults.
    pub faults: Vec<(f64, String)>,
}

/// Draws a recording as an SVG document.
///
/// Panels from top to bottom: ground acceleration (g), rotation (rad) with tints where a flywheel is engaged, angular velocity (rad/s); then
/// lanes of commands, clutches, and of where the controller was rocking or in Fault. Faults are vertical lines with their texts on top.
///
/// # Errors
/// [`PlotError`] for vectors of different lengths, without a time span, for numbers that are not finite and times out of order.
pub fn recording_figure(title: impl Into<FigureTitle>, trace: &RecordingTrace) -> Result<String, PlotError> {
    let title = title.into();
    check(trace)?;
    let Range { start, end } = span_of(trace.time.iter().copied())?;
    let (left_px, width_px) = (MARGIN_PX + LEFT_LABELS_PX, WIDTH_PX - MARGIN_PX - LEFT_LABELS_PX - RIGHT_MARGIN_PX);
    let position_px = |time: f64| left_px + (time - start) / (end - start) * width_px;
    let marks: Vec<(f64, &str)> = trace.faults.iter().map(|fault| (position_px(fault.0), fault.1.as_str())).collect();
    let mut body = String::new();
    let heading_px = write_heading(&mut body, &title, &keys(trace), (left_px, width_px), MARGIN_PX);
    let places = fault_places(&marks, left_px + width_px);
    let fault_rows = places.iter().flatten().map(|place| place.1 + 1).max().unwrap_or(0);
    let first_px = heading_px + fault_rows as f64 * FAULT_ROW_PX;
    let mut top_px = first_px;
    let mut panel = |height_px: f64, y, title| {
        let panel = Panel { title, ..Panel::new((left_px, top_px), (width_px, height_px), start..end, y) };
        top_px += height_px + GAP_PX;
        panel
    };
    let scale = |values: &[f64], floor: f64| scale_around_zero(values.iter().copied(), floor);
    let ground = panel(GROUND_PANEL_PX, scale(&trace.ground_g, 0.1), Some("*a*_g (g)"));
    let rotation = panel(ROTATION_PANEL_PX, scale(&trace.rotation, 1e-3), Some("θ (rad)"));
    let velocity = panel(VELOCITY_PANEL_PX, scale(&trace.velocity, 1e-2), Some("θ' (rad/s)"));
    let lanes = Panel { y_ticks: false, ..panel(LANES.len() as f64 * LANE_PX, 0.0..1.0, None) };
    let height_px = lanes.bottom_px() + BOTTOM_LABELS_PX + 4.0;
    write_flywheels(&mut body, &rotation, (rotation.top_px, rotation.height_px), (&trace.time, &trace.engaged), FLYWHEEL_TINTS);
    for panel in [&ground, &rotation, &velocity] {
        panel.write_axes(&mut body, None);
    }
    for (lane, name) in LANES.into_iter().enumerate() {
        let extent = (lanes.top_px + lane as f64 * LANE_PX + 0.5 * (LANE_PX - BAR_PX), BAR_PX);
        match lane {
            0 => write_flywheels(&mut body, &lanes, extent, (&trace.time, &trace.commanded), FLYWHEEL_BARS),
            1 => write_flywheels(&mut body, &lanes, extent, (&trace.time, &trace.engaged), FLYWHEEL_BARS),
            _ => {
                for (state, colour) in [(1, GROUND), (2, FAULT)] {
                    let shown = bars(&lanes, &trace.time, |index| trace.state.get(index) == Some(&state));
                    write_bars(&mut body, &shown, (units(extent.0), units(extent.1)), colour);
                }
            }
        }
        write_lane_name(&mut body, &lanes, lane, &[name]);
    }
    lanes.write_frame(&mut body, Some("time (s)"));
    write_faults(&mut body, &marks, (first_px, lanes.bottom_px()), &places);
    let curves = [
        (&ground, &trace.ground_g, Stroke::solid(GROUND)),
        (&rotation, &trace.rotation, device_look(0).stroke()),
        (&velocity, &trace.velocity, device_look(0).stroke()),
    ];
    for (panel, values, stroke) in curves {
        let points: Vec<(f64, f64)> = trace.time.iter().copied().zip(values.iter().copied()).collect();
        write_curve(&mut body, panel, &points, stroke);
    }
    Ok(document(&title.text, (WIDTH_PX, height_px), &body))
}

/// Legend entries of what the figure shows.
fn keys(trace: &RecordingTrace) -> [Vec<Key>; 2] {
    let key = |swatch, name: &str| (swatch, name.to_owned());
    let mut lines = vec![key(Swatch::Line(device_look(0).stroke()), "estimate of the device")];
    if !trace.faults.is_empty() {
        lines.push(key(Swatch::Line(fault_stroke()), "fault"));
    }
    let mut colours = Vec::new();
    for (bit, name) in ["first flywheel", "second flywheel"].into_iter().enumerate() {
        if trace.engaged.iter().chain(&trace.commanded).any(|state| state & (1 << bit) != 0) {
            colours.push(key(Swatch::Tints(FLYWHEEL_TINTS[bit], FLYWHEEL_BARS[bit]), name));
        }
    }
    for (state, name, colour) in [(1, "rocking", GROUND), (2, "in Fault", FAULT)] {
        if trace.state.contains(&state) {
            colours.push(key(Swatch::Tint(colour), name));
        }
    }
    [lines, colours]
}

fn check(trace: &RecordingTrace) -> Result<(), PlotError> {
    let expected = trace.time.len();
    let lengths = [
        ("ground_g", trace.ground_g.len()),
        ("rotation", trace.rotation.len()),
        ("velocity", trace.velocity.len()),
        ("commanded", trace.commanded.len()),
        ("engaged", trace.engaged.len()),
        ("state", trace.state.len()),
    ];
    if let Some(&(name, found)) = lengths.iter().find(|(_, found)| *found != expected) {
        return Err(PlotError::WrongLength { name: name.to_owned(), found, expected });
    }
    let device = || "recording".to_owned();
    for (index, &time_s) in trace.time.iter().enumerate() {
        let values = [time_s, trace.ground_g[index], trace.rotation[index], trace.velocity[index]];
        if values.iter().any(|value| !value.is_finite()) {
            return Err(PlotError::NotFinite { device: device(), time_s });
        }
    }
    match trace.time.windows(2).find(|pair| pair[1] < pair[0]) {
        Some(pair) => Err(PlotError::TimeGoesBack { device: device(), time_s: pair[1] }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::synthetic::assert_drawn;

    #[test]
    fn a_recording_is_well_formed_and_shows_what_it_has() {
        let time: Vec<f64> = (0..4000).map(|tick| f64::from(tick) * 5e-4).collect();
        let wave: Vec<f64> = time.iter().map(|time| (3.0 * time).fract() - 0.5).collect();
        let states = |most: u8| (0..4000).map(|tick| (tick / 1000) as u8 % (most + 1)).collect();
        let trace = RecordingTrace {
            ground_g: wave.clone(),
            rotation: wave.clone(),
            velocity: wave,
            commanded: states(3),
            engaged: states(2),
            state: states(2),
            faults: vec![(1.0, "61, <late> & more".to_owned())],
            time,
        };
        let svg = recording_figure("earthquake 1", &trace).unwrap();
        assert_drawn(&svg);
        for text in ["command", "clutches", "state", "rocking", "in Fault", "second flywheel", "&lt;late&gt;", "θ"] {
            assert!(svg.contains(text), "{text}");
        }
        let calm = RecordingTrace { state: vec![0; 4000], faults: Vec::new(), ..trace.clone() };
        assert!(!recording_figure("", &calm).unwrap().contains("in Fault"));
        let short = RecordingTrace { state: vec![0; 3999], ..trace.clone() };
        assert!(matches!(recording_figure("", &short), Err(PlotError::WrongLength { found: 3999, .. })));
        let mut back = trace;
        back.time.swap(1, 2);
        assert!(matches!(recording_figure("", &back), Err(PlotError::TimeGoesBack { .. })));
        assert_eq!(recording_figure("", &RecordingTrace::default()), Err(PlotError::EmptyTimeSpan));
    }
}
