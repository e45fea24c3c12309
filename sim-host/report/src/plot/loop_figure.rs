//! The figure of a closed loop over time: true and estimated motion, and what law, command and clutches do.

use std::ops::Range;

use super::curve::write_curve;
use super::device_trace::half_height;
use super::fault_mark::{Faults, fault_stroke};
use super::lane::{LANE_PX, flywheel_keys, write_flywheels, write_lane, write_state};
use super::legend::{LegendEntry, Swatch};
use super::palette::{Colour, FLYWHEEL_BARS, FLYWHEEL_TINTS, GROUND, Stroke, device_look};
use super::panel::{Panel, scale_around_zero};
use super::stack::{GROUND_PANEL_PX, PANEL_PX, ROTATION_PANEL_PX, Stack};
use super::ticks::drawable;
use super::time_axis::{check_order, check_trace, span_of};
use super::{FigureTitle, PlotError, TimeAxis};

/// What the law wants: no flywheel in particular.
const LAW: Colour = GROUND;
/// Estimates beyond this many times the largest true value are cut off.
const ESTIMATE_REACH: f64 = 1.5;
const LOOP: &str = "closed loop";
const IDEAL: &str = "ideal pair";
const HOST: &str = "host's own loop";

/// A closed loop over time. All vectors but `rotation_ideal`, `rotation_host` and `faults` have the length of `time`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoopTrace {
    /// Frequency parameter p of the block (1/s).
    pub frequency_parameter_1_s: f64,
    /// Time (s), in order.
    pub time: Vec<f64>,
    /// Ground acceleration (g).
    pub ground_g: Vec<f64>,
    /// True rotation θ/α.
    pub rotation: Vec<f64>,
    /// Time (s) and θ/α of a run with the ideal pair, on its own times in order; may be empty.
    pub rotation_ideal: Vec<(f64, f64)>,
    /// The same of the loop that the host closed, where a device closed this one; may be empty.
    pub rotation_host: Vec<(f64, f64)>,
    /// True angular velocity over pα.
    pub velocity: Vec<f64>,
    /// Estimated angular velocity over pα.
    pub velocity_estimated: Vec<f64>,
    /// True driving moment D over p²α; with consistent kinematics the quantity of its place that has the sign of the terminals' acceleration
    /// (Eq. 10).
    pub push: Vec<f64>,
    /// Estimate of the same.
    pub push_estimated: Vec<f64>,
    /// Flywheels that the clutches engage: 0 none, 1 the first, 2 the second, 3 both; higher bits are ignored.
    pub engaged: Vec<u8>,
    /// Flywheels that the controller asks for, as in `engaged`.
    pub commanded: Vec<u8>,
    /// Whether the law wants a flywheel engaged, judged by the true motion.
    pub ideal: Vec<bool>,
    /// Times (s) and texts of faults.
    pub faults: Vec<(f64, String)>,
}

/// Draws a closed loop as an SVG document.
///
/// Panels from top to bottom: ground acceleration (g); rotation θ/α with dashed lines at ±1 and tints where a flywheel is engaged,
/// beside the run with the ideal pair; angular velocity and driving moment, true and estimated; and lanes with what the law wants of
/// the true motion, the command, and what the clutches do. Every value of a lane holds until the next sample. Faults are vertical
/// lines with their texts on top. Estimates that go far beyond the true values are cut off at the edge of their panel. Samples of
/// the ideal pair, and faults, outside the time span of the loop are left out.
///
/// The text is the same for the same input, and long traces are thinned to the width of the panels.
///
/// # Errors
/// [`PlotError`] for vectors of different lengths, without a time span, for numbers that are not finite, times out of order, and over p t
/// for a block without positive frequency parameter.
pub fn loop_figure(title: impl Into<FigureTitle>, trace: &LoopTrace, axes: TimeAxis) -> Result<String, PlotError> {
    let title = title.into();
    check(trace)?;
    let scale = axes.scale_of(LOOP, trace.frequency_parameter_1_s)?;
    let time: Vec<f64> = trace.time.iter().map(|time| scale * time).collect();
    let x = span_of(time.iter().copied())?;
    let inside = |time: f64| time >= x.start && time <= x.end;
    let shown = |points: &[(f64, f64)]| -> Vec<(f64, f64)> {
        points.iter().map(|point| (scale * point.0, point.1)).filter(|point| inside(point.0)).collect()
    };
    let (ideal, host) = (shown(&trace.rotation_ideal), shown(&trace.rotation_host));
    let faults: Vec<(f64, String)> = trace.faults.iter().map(|(time, text)| (scale * time, text.clone())).collect();
    let keys = keys(trace, !ideal.is_empty(), faults.iter().any(|fault| inside(fault.0)));
    let mut stack = Stack::new(&title, &keys, x);
    let faults = Faults::new(&mut stack, &faults);

    let peak = trace.rotation.iter().chain(ideal.iter().map(|point| &point.1)).fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let limit = half_height(peak);
    let ground_scale = scale_around_zero(trace.ground_g.iter().copied(), 0.1);
    let ground_panel = stack.panel(GROUND_PANEL_PX, ground_scale, Some("*a*_g (g)"));
    let mut rotation_panel = stack.panel(ROTATION_PANEL_PX, -limit..limit, Some("θ/α"));
    rotation_panel.guides = &[-1.0, 1.0];
    let velocity_scale = scale_with_estimate(&trace.velocity, &trace.velocity_estimated);
    let velocity_panel = stack.panel(PANEL_PX, velocity_scale, Some("θ'/(*p*α)"));
    let push_panel = stack.panel(PANEL_PX, scale_with_estimate(&trace.push, &trace.push_estimated), Some("*D*/(*p*²α)"));
    let mut lanes = stack.panel(3.0 * LANE_PX, 0.0..1.0, None);
    lanes.y_ticks = false;

    let svg = &mut stack.svg;
    let extent = (rotation_panel.top_px, rotation_panel.height_px);
    write_flywheels(svg, &rotation_panel, extent, (&time, &trace.engaged), FLYWHEEL_TINTS);
    for panel in [&ground_panel, &rotation_panel, &velocity_panel, &push_panel] {
        panel.write_axes(svg, None);
    }
    write_lane(svg, &lanes, (0, &["law on the", "true motion"]), |svg, extent| {
        write_state(svg, &lanes, extent, (&time, LAW), |index| trace.ideal[index]);
    });
    for (lane, name, states) in [(1, "command", &trace.commanded), (2, "clutches", &trace.engaged)] {
        write_lane(svg, &lanes, (lane, &[name]), |svg, extent| {
            write_flywheels(svg, &lanes, extent, (&time, states), FLYWHEEL_BARS);
        });
    }
    lanes.write_frame(svg, Some(axes.title()));
    faults.write(svg, lanes.bottom_px());

    let curves: [(&Panel<'_>, &[f64], Stroke); 6] = [
        (&ground_panel, &trace.ground_g, Stroke::solid(GROUND)),
        (&rotation_panel, &trace.rotation, true_stroke()),
        (&velocity_panel, &trace.velocity_estimated, estimated_stroke()),
        (&velocity_panel, &trace.velocity, true_stroke()),
        (&push_panel, &trace.push_estimated, estimated_stroke()),
        (&push_panel, &trace.push, true_stroke()),
    ];
    write_curve(svg, &rotation_panel, &host, host_stroke());
    for (panel, values, stroke) in curves {
        let points: Vec<(f64, f64)> = time.iter().copied().zip(values.iter().copied()).collect();
        write_curve(svg, panel, &points, stroke);
    }
    write_curve(svg, &rotation_panel, &ideal, ideal_stroke());
    Ok(stack.document(&title))
}

fn true_stroke() -> Stroke {
    device_look(0).stroke()
}

fn ideal_stroke() -> Stroke {
    Stroke { dashes: "60 30", ..Stroke::solid(device_look(2).colour) }
}

/// Wide, under the motion that it should agree with.
fn host_stroke() -> Stroke {
    Stroke { width_px: 4.0, ..Stroke::solid(device_look(3).colour) }
}

/// Wider than the true motion on top of it, so that both show where they agree.
fn estimated_stroke() -> Stroke {
    Stroke { width_px: 2.2, ..Stroke::solid(device_look(1).colour) }
}

/// Refuses vectors of different lengths, numbers that cannot be drawn and times out of order.
fn check(trace: &LoopTrace) -> Result<(), PlotError> {
    let values: [(&str, &[f64]); 6] = [
        ("ground_g", &trace.ground_g),
        ("rotation", &trace.rotation),
        ("velocity", &trace.velocity),
        ("velocity_estimated", &trace.velocity_estimated),
        ("push", &trace.push),
        ("push_estimated", &trace.push_estimated),
    ];
    let states = [("engaged", trace.engaged.len()), ("commanded", trace.commanded.len()), ("ideal", trace.ideal.len())];
    check_trace(LOOP, &trace.time, &values, &states, &trace.faults)?;
    for (name, curve) in [(IDEAL, &trace.rotation_ideal), (HOST, &trace.rotation_host)] {
        if let Some(&(time_s, _)) = curve.iter().find(|(time, rotation)| !(drawable(*time) && drawable(*rotation))) {
            return Err(PlotError::NotFinite { device: name.to_owned(), time_s });
        }
        check_order(name, curve.iter().map(|point| point.0))?;
    }
    Ok(())
}

/// Legend entries of what the figure shows.
fn keys(trace: &LoopTrace, has_ideal: bool, has_faults: bool) -> [Vec<LegendEntry>; 2] {
    let key = |swatch, name: &str| (swatch, name.to_owned());
    let mut lines = vec![key(Swatch::Line(true_stroke()), "closed loop, true motion")];
    lines.push(key(Swatch::Line(estimated_stroke()), "estimate"));
    if has_ideal {
        lines.push(key(Swatch::Line(ideal_stroke()), IDEAL));
    }
    if !trace.rotation_host.is_empty() {
        lines.push(key(Swatch::Line(host_stroke()), HOST));
    }
    let mut colours = flywheel_keys(trace.engaged.iter().chain(&trace.commanded));
    if trace.ideal.contains(&true) {
        colours.push(key(Swatch::Tint(LAW), "wanted by the law"));
    }
    if has_faults {
        colours.push(key(Swatch::Line(fault_stroke()), "fault"));
    }
    [lines, colours]
}

/// A scale around zero and the true values; of the estimate, what does not go far beyond them.
fn scale_with_estimate(values: &[f64], estimated: &[f64]) -> Range<f64> {
    let peak = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let reach = if peak > 1e-9 { ESTIMATE_REACH * peak } else { f64::INFINITY };
    let estimated = estimated.iter().map(|value| value.clamp(-reach, reach));
    scale_around_zero(values.iter().copied().chain(estimated), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::assert_drawn;
    use crate::plot::formula::formula;

    /// Two seconds at `count` samples; no dynamics behind them.
    fn trace(count: usize) -> LoopTrace {
        let time: Vec<f64> = (0..count).map(|index| 2.0 * index as f64 / (count.max(2) - 1) as f64).collect();
        let wave: Vec<f64> = time.iter().map(|time| (3.0 * time).fract() - 0.5).collect();
        LoopTrace {
            frequency_parameter_1_s: 2.0,
            ground_g: wave.clone(),
            rotation: wave.clone(),
            rotation_ideal: vec![(-1.0, 9.0), (0.0, 0.0), (0.7, 0.4), (5.0, 9.0)],
            rotation_host: Vec::new(),
            velocity: wave.clone(),
            velocity_estimated: wave.iter().enumerate().map(|(index, wave)| wave + 0.1 * (index % 3) as f64).collect(),
            push: wave.clone(),
            push_estimated: wave.iter().map(|wave| 40.0 * wave).collect(),
            engaged: (0..count).map(|index| (4 * index / count) as u8).collect(),
            commanded: (0..count).map(|index| (index % 2) as u8).collect(),
            ideal: wave.iter().map(|wave| *wave > 0.0).collect(),
            faults: vec![(0.5, "no <pulses> & more".to_owned()), (0.5, "second".to_owned()), (7.0, "later".to_owned())],
            time,
        }
    }

    #[test]
    fn a_loop_is_well_formed_and_repeats_to_the_byte() {
        let svg = loop_figure("A <title> & more", &trace(4000), TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        assert!(svg.contains("A &lt;title&gt; &amp; more") && svg.contains("no &lt;pulses&gt; &amp; more"));
        for name in ["true motion", "command", "clutches", "ideal pair", "second flywheel", "wanted by the law"] {
            assert!(svg.contains(name), "{name}");
        }
        assert!(!svg.contains("later"));
        // What Eq. 10 looks at is D: θ̈ has the inertia of what is engaged in it.
        assert!(svg.contains(&formula("*D*/(*p*²α)")) && !svg.contains(&formula("θ''")));
        assert_eq!(svg.matches("rotate(-90 ").count(), 4);
        assert_eq!(svg, loop_figure("A <title> & more", &trace(4000), TimeAxis::Seconds).unwrap());
    }

    #[test]
    fn over_p_t_everything_stays_at_its_place_across() {
        // A p of 2 1/s is exact, so that all but title, ticks and labels of the axis is the same.
        let drawn = |svg: &str| -> Vec<String> {
            svg.lines()
                .filter(|line| !line.starts_with("<text") && !line.contains("v40") && !line.contains("v-40"))
                .map(str::to_owned)
                .collect()
        };
        let [seconds, over_p_t] =
            [TimeAxis::Seconds, TimeAxis::TimesFrequencyParameter].map(|axes| loop_figure("", &trace(400), axes).unwrap());
        assert_drawn(&over_p_t);
        assert_eq!(drawn(&seconds), drawn(&over_p_t));
        assert!(seconds.contains("time (s)") && !over_p_t.contains("time (s)"));
        assert!(over_p_t.contains(&formula(TimeAxis::TimesFrequencyParameter.title())));
        // Two seconds are p t = 4.
        assert!(over_p_t.contains(">4.0<") && !seconds.contains(">4.0<"));
        let without = LoopTrace { frequency_parameter_1_s: 0.0, ..trace(400) };
        assert!(matches!(loop_figure("", &without, TimeAxis::TimesFrequencyParameter), Err(PlotError::InvalidBlock { .. })));
    }

    #[test]
    fn long_and_short_traces_draw() {
        let long = loop_figure("", &trace(200_000), TimeAxis::Seconds).unwrap();
        assert_drawn(&long);
        assert!(long.len() < 500_000, "{}", long.len());
        let bare = LoopTrace { rotation_ideal: Vec::new(), faults: Vec::new(), ..trace(2) };
        let svg = loop_figure("", &bare, TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        assert!(!svg.contains("ideal pair") && !svg.contains("fault"));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert_eq!(loop_figure("", &LoopTrace::default(), TimeAxis::Seconds), Err(PlotError::EmptyTimeSpan));
        assert_eq!(loop_figure("", &trace(1), TimeAxis::Seconds), Err(PlotError::EmptyTimeSpan));
        let mut broken = trace(100);
        broken.commanded.pop();
        let wrong = PlotError::WrongLength { name: "commanded".to_owned(), found: 99, expected: 100 };
        assert_eq!(loop_figure("", &broken, TimeAxis::Seconds), Err(wrong));
        let mut broken = trace(100);
        broken.push_estimated[5] = f64::NAN;
        assert!(matches!(loop_figure("", &broken, TimeAxis::Seconds), Err(PlotError::NotFinite { .. })));
        let mut broken = trace(100);
        broken.time.swap(3, 30);
        assert!(matches!(loop_figure("", &broken, TimeAxis::Seconds), Err(PlotError::TimeGoesBack { .. })));
        let mut broken = trace(100);
        broken.rotation_ideal.swap(0, 1);
        assert!(matches!(loop_figure("", &broken, TimeAxis::Seconds), Err(PlotError::TimeGoesBack { .. })));
        let mut broken = trace(100);
        broken.faults[0].0 = f64::INFINITY;
        assert!(matches!(loop_figure("", &broken, TimeAxis::Seconds), Err(PlotError::NotFinite { .. })));
    }
}
