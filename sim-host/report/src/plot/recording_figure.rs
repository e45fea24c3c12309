//! The figure of an earthquake as a device recorded it: ground, rotation and velocity over time, commands, clutches and phases.

use super::curve::write_curve;
use super::fault_mark::{Faults, fault_stroke};
use super::lane::{LANE_PX, flywheel_keys, write_flywheels, write_lane, write_state};
use super::legend::{LegendEntry, Swatch};
use super::palette::{FAULT, FLYWHEEL_BARS, FLYWHEEL_TINTS, GROUND, Stroke, device_look};
use super::panel::scale_around_zero;
use super::stack::{GROUND_PANEL_PX, PANEL_PX, ROTATION_PANEL_PX, Stack};
use super::time_axis::{check_trace, span_of};
use super::{FigureTitle, PlotError};

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
    let mut stack = Stack::new(&title, &keys(trace), span_of(trace.time.iter().copied())?);
    let faults = Faults::new(&mut stack, &trace.faults);
    let scale = |values: &[f64], floor: f64| scale_around_zero(values.iter().copied(), floor);
    let ground = stack.panel(GROUND_PANEL_PX, scale(&trace.ground_g, 0.1), Some("*a*_g (g)"));
    let rotation = stack.panel(ROTATION_PANEL_PX, scale(&trace.rotation, 1e-3), Some("θ (rad)"));
    let velocity = stack.panel(PANEL_PX, scale(&trace.velocity, 1e-2), Some("θ' (rad/s)"));
    let mut lanes = stack.panel(3.0 * LANE_PX, 0.0..1.0, None);
    lanes.y_ticks = false;
    let svg = &mut stack.svg;
    write_flywheels(svg, &rotation, (rotation.top_px, rotation.height_px), (&trace.time, &trace.engaged), FLYWHEEL_TINTS);
    for panel in [&ground, &rotation, &velocity] {
        panel.write_axes(svg, None);
    }
    for (lane, name, states) in [(0, "command", &trace.commanded), (1, "clutches", &trace.engaged)] {
        write_lane(svg, &lanes, (lane, &[name]), |svg, extent| {
            write_flywheels(svg, &lanes, extent, (&trace.time, states), FLYWHEEL_BARS);
        });
    }
    write_lane(svg, &lanes, (2, &["state"]), |svg, extent| {
        for (state, colour) in [(1, GROUND), (2, FAULT)] {
            write_state(svg, &lanes, extent, (&trace.time, colour), |index| trace.state[index] == state);
        }
    });
    lanes.write_frame(svg, Some("time (s)"));
    faults.write(svg, lanes.bottom_px());
    let curves = [
        (&ground, &trace.ground_g, Stroke::solid(GROUND)),
        (&rotation, &trace.rotation, device_look(0).stroke()),
        (&velocity, &trace.velocity, device_look(0).stroke()),
    ];
    for (panel, values, stroke) in curves {
        let points: Vec<(f64, f64)> = trace.time.iter().copied().zip(values.iter().copied()).collect();
        write_curve(svg, panel, &points, stroke);
    }
    Ok(stack.document(&title))
}

/// Legend entries of what the figure shows.
fn keys(trace: &RecordingTrace) -> [Vec<LegendEntry>; 2] {
    let key = |swatch, name: &str| (swatch, name.to_owned());
    let mut lines = vec![key(Swatch::Line(device_look(0).stroke()), "estimate of the device")];
    if !trace.faults.is_empty() {
        lines.push(key(Swatch::Line(fault_stroke()), "fault"));
    }
    let mut colours = flywheel_keys(trace.engaged.iter().chain(&trace.commanded));
    for (state, name, colour) in [(1, "rocking", GROUND), (2, "in Fault", FAULT)] {
        if trace.state.contains(&state) {
            colours.push(key(Swatch::Tint(colour), name));
        }
    }
    [lines, colours]
}

fn check(trace: &RecordingTrace) -> Result<(), PlotError> {
    let values: [(&str, &[f64]); 3] =
        [("ground_g", &trace.ground_g), ("rotation", &trace.rotation), ("velocity", &trace.velocity)];
    let states = [("commanded", trace.commanded.len()), ("engaged", trace.engaged.len()), ("state", trace.state.len())];
    check_trace("recording", &trace.time, &values, &states, &trace.faults)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;

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
