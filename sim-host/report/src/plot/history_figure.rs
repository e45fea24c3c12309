//! The figure of responses over time: stacked panels that share the time axis.

use sprag_sim::history::History;

use super::curve::write_curve;
use super::device_trace::{DeviceTrace, check, rotation_limit};
use super::engagement::{device_keys, write_impacts, write_overturns, write_shading};
use super::ground::ground_curve;
use super::palette::{GROUND, Stroke};
use super::panel::scale_around_zero;
use super::stack::{GROUND_PANEL_PX, PANEL_PX, ROTATION_PANEL_PX, Stack};
use super::time_axis::time_span;
use super::{FigureTitle, PlotError, TimeAxis};

/// Draws responses of several devices to one ground motion as an SVG document.
///
/// Panels from top to bottom: ground acceleration (g), rotation θ/α with dashed lines at ±1, angular velocity over
/// pα, and, when any device has an inerter, transferred force over weight. Behind θ/α and force, tints show when a
/// flywheel of a clutched device is engaged. Triangles at θ = 0 are impacts. A block that ends at or beyond the
/// slenderness angle is marked where its curve leaves the panel, and its curves end there. Each response is scaled by
/// its own slenderness and frequency parameter.
///
/// The text is the same for the same input, and long responses are thinned to the width of the panels.
///
/// # Errors
///
/// [`PlotError`] without responses, without a time span, for numbers that are not finite, for samples out of time
/// order, and for a block without positive slenderness and frequency parameter.
pub fn history_figure(title: impl Into<FigureTitle>, histories: &[History], axes: TimeAxis) -> Result<String, PlotError> {
    let title = title.into();
    if histories.is_empty() {
        return Err(PlotError::NoHistories);
    }
    for history in histories {
        check(history)?;
    }
    let limit = rotation_limit(histories);
    let traces: Vec<DeviceTrace> =
        histories.iter().enumerate().map(|(index, history)| DeviceTrace::new(index, history, axes, limit)).collect();
    let ground = ground_curve(histories, axes);
    let mut stack = Stack::new(&title, &device_keys(&traces), time_span(histories, axes)?);

    let values = |pick: fn(&DeviceTrace) -> &[(f64, f64)]| {
        traces.iter().flat_map(move |trace| {
            // The point beyond the panel in which a block overturns may be far out.
            let shown = pick(trace).len() - usize::from(trace.overturn.is_some()).min(pick(trace).len());
            pick(trace)[..shown].iter().map(|point| point.1)
        })
    };
    let ground_scale = scale_around_zero(ground.iter().map(|point| point.1), 0.1);
    let velocity_scale = scale_around_zero(values(|trace| &trace.velocity), 1.0);
    let force_scale = scale_around_zero(values(|trace| &trace.force), 0.1);
    let ground_panel = stack.panel(GROUND_PANEL_PX, ground_scale, Some("*a*_g (g)"));
    let mut rotation_panel = stack.panel(ROTATION_PANEL_PX, -limit..limit, Some("θ/α"));
    rotation_panel.guides = &[-1.0, 1.0];
    let velocity_panel = stack.panel(PANEL_PX, velocity_scale, Some("θ'/(*p*α)"));
    let has_force = traces.iter().any(|trace| !trace.force.is_empty());
    let force_panel = has_force.then(|| stack.panel(PANEL_PX, force_scale, Some("*F*/(*mg*)")));

    let svg = &mut stack.svg;
    write_shading(svg, &rotation_panel, &traces);
    ground_panel.write_axes(svg, None);
    write_curve(svg, &ground_panel, &ground, Stroke::solid(GROUND));

    rotation_panel.write_axes(svg, None);
    for trace in &traces {
        write_curve(svg, &rotation_panel, &trace.rotation, trace.look.stroke());
    }
    write_impacts(svg, &rotation_panel, &traces);
    write_overturns(svg, &rotation_panel, &traces);

    velocity_panel.write_axes(svg, (!has_force).then(|| axes.title()));
    for trace in &traces {
        write_curve(svg, &velocity_panel, &trace.velocity, trace.look.stroke());
    }

    if let Some(panel) = &force_panel {
        write_shading(svg, panel, &traces);
        panel.write_axes(svg, Some(axes.title()));
        for trace in &traces {
            write_curve(svg, panel, &trace.force, trace.look.stroke());
        }
    }
    Ok(stack.document(&title))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{
        assert_drawn,
        synthetic::{at_rest, overturning, safe, with_clutched_pair, with_inerter},
    };

    fn three() -> Vec<History> {
        vec![
            overturning("none", 800),
            with_inerter(safe("single inerter", 0.9, 800)),
            with_clutched_pair(safe("clutched pair", 0.5, 800)),
        ]
    }

    fn panel_titles(svg: &str) -> usize {
        svg.matches("rotate(-90 ").count()
    }

    #[test]
    fn three_devices_fill_four_panels() {
        for axes in [TimeAxis::Seconds, TimeAxis::TimesFrequencyParameter] {
            let svg = history_figure("A <title> & more", &three(), axes).unwrap();
            assert_drawn(&svg);
            assert_eq!(panel_titles(&svg), 4);
            assert_eq!(svg.matches(">overturns<").count(), 1);
            assert!(svg.contains("none (overturned)") && svg.contains("A &lt;title&gt; &amp; more"));
            assert!(svg.contains("single inerter (safe, peak 0."));
            assert!(svg.contains("first flywheel engaged") && svg.contains("second flywheel engaged"));
        }
    }

    #[test]
    fn without_inerter_there_is_no_force_panel() {
        let svg = history_figure("", &[safe("none", 0.4, 300)], TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        assert_eq!(panel_titles(&svg), 3);
        assert!(!svg.contains("engaged"));
    }

    #[test]
    fn rest_two_samples_and_five_devices_draw() {
        let svg = history_figure("rest", &[at_rest("none", 100)], TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        let svg = history_figure("two", &[safe("none", 0.4, 2)], TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        let five: Vec<History> = (0..5).map(|index| with_clutched_pair(overturning(&format!("device {index}"), 900))).collect();
        let svg = history_figure("five", &five, TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        assert_eq!(svg.matches(">overturns<").count(), 5);
    }

    #[test]
    fn a_rotation_far_beyond_the_panel_stays_in_it() {
        let mut wild = safe("wild", 0.4, 400);
        wild.samples[200].rotation_rad = 1e100;
        wild.samples[201].rotation_rad = -1e100;
        assert_drawn(&history_figure("", &[wild], TimeAxis::Seconds).unwrap());
    }

    #[test]
    fn long_responses_stay_small_and_the_bytes_repeat() {
        let long: Vec<History> = (0..5)
            .map(|index| with_clutched_pair(safe("device", 0.9 - 0.1 * f64::from(index), 100_000)))
            .map(|mut history| {
                // Noise in every sample is the worst case for the size.
                for (index, sample) in history.samples.iter_mut().enumerate() {
                    let noise = (index * 7919 % 1000) as f64 * 1e-3 - 0.5;
                    sample.rotation_rad += 0.1 * noise;
                    sample.velocity_rad_s += noise;
                    sample.force_ratio[0] += noise;
                    sample.engaged = (index / 75 % 3) as u8;
                    sample.ground_m_s2 += noise;
                }
                history
            })
            .collect();
        let svg = history_figure("long", &long, TimeAxis::Seconds).unwrap();
        assert_drawn(&svg);
        assert!(svg.len() < 1_000_000, "{}", svg.len());
        assert_eq!(svg, history_figure("long", &long, TimeAxis::Seconds).unwrap());
    }

    #[test]
    fn figures_without_content_are_refused() {
        assert_eq!(history_figure("", &[], TimeAxis::Seconds), Err(PlotError::NoHistories));
        let one = [safe("none", 0.4, 1)];
        assert_eq!(history_figure("", &one, TimeAxis::Seconds), Err(PlotError::EmptyTimeSpan));
    }
}
