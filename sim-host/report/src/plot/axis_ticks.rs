//! Where an axis has ticks, and which of them have labels: as many as do not collide.

use std::ops::Range;

use sprag_shared::math;

use super::ticks::{Scale, TickText, decade_texts, decade_ticks, round_ticks, tick_text};

/// Font size of labels (px).
pub(super) const TICK_FONT_PX: f64 = 11.0;

/// Least distance between labels side by side, and between the middles of labels one above the other (px).
const CLEARANCE_PX: f64 = 6.0;
const LINE_PX: f64 = 13.0;

/// Digits that the label of an end has, unless it needs more to lie within the axis.
const END_DIGITS: usize = 3;
const MOST_END_DIGITS: usize = 9;
/// Distance that nobody sees (px).
const UNSEEN_PX: f64 = 0.2;

/// Direction of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// From left to right: labels stand side by side.
    Across,
    /// From the bottom to the top: labels stand one above the other.
    Up,
}

/// An axis; values are powers of ten on a logarithmic one.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// What it shows.
    pub range: Range<f64>,
    /// How it is divided.
    pub scale: Scale,
    /// First and last value that has a meaning: both are labelled, and no tick lies beyond.
    pub ends: Option<(f64, f64)>,
    /// Direction of the axis.
    pub way: Way,
    /// Length (px).
    pub length_px: f64,
    /// Number of labels to aim for.
    pub target: usize,
    /// Part of the range at either end that stays without ticks.
    pub margin: f64,
}

/// The label of a tick.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    /// Value, as the axis has it.
    pub at: f64,
    /// Text.
    pub text: TickText,
}

#[derive(Clone, Debug, Default)]
pub(super) struct AxisTicks {
    /// Ticks with a label, no two of which collide, in rising order.
    pub labelled: Vec<Label>,
    /// Values of other ticks.
    pub minor: Vec<f64>,
}

impl Axis {
    pub(super) fn ticks(&self) -> AxisTicks {
        let mut ticks = AxisTicks::default();
        for target in (1..=self.target.max(1)).rev() {
            ticks = self.inner(target);
            if ticks.labelled.windows(2).all(|pair| self.apart(&pair[0], &pair[1])) {
                break;
            }
        }
        let mut kept: Vec<Label> = Vec::new();
        let inner = std::mem::take(&mut ticks.labelled);
        let ends = self.ends.map(|(first, last)| [first, last].map(|end| self.end(end, &inner)));
        for label in ends.into_iter().flatten().chain(inner) {
            if kept.iter().all(|other| self.apart(&label, other)) {
                kept.push(label);
            } else if kept.iter().all(|other| self.px(label.at - other.at).abs() > 1.0) {
                ticks.minor.push(label.at);
            }
        }
        kept.sort_by(|a, b| a.at.total_cmp(&b.at));
        ticks.labelled = kept;
        ticks
    }

    /// Length of a difference of values (px).
    fn px(&self, difference: f64) -> f64 {
        difference / (self.range.end - self.range.start) * self.length_px
    }

    fn apart(&self, one: &Label, other: &Label) -> bool {
        let needed = match self.way {
            Way::Across => 0.5 * (one.text.width_px(TICK_FONT_PX) + other.text.width_px(TICK_FONT_PX)) + CLEARANCE_PX,
            Way::Up => LINE_PX,
        };
        self.px(one.at - other.at).abs() >= needed
    }

    /// Round ticks between the ends, about `target` of them with labels, which may collide.
    fn inner(&self, target: usize) -> AxisTicks {
        let within = match self.ends {
            Some((first, last)) => first.max(self.range.start)..last.min(self.range.end),
            None => self.range.clone(),
        };
        let inside = |value: &f64| *value >= within.start - 1e-9 && *value <= within.end + 1e-9;
        match self.scale {
            Scale::Linear | Scale::Whole => {
                let mut values = round_ticks(&within, target, self.margin);
                // Of steps below one, those that are whole.
                values.retain(|value| self.scale == Scale::Linear || (value - value.round()).abs() < 1e-9);
                let step = step(&values);
                let label = |at| Label { at, text: TickText::plain(tick_text(at, step)) };
                AxisTicks { labelled: values.into_iter().map(label).collect(), minor: Vec::new() }
            }
            Scale::Logarithmic => {
                let (values, minor) = decade_ticks(&self.range, target, self.length_px);
                let texts = decade_texts(&values);
                let labels = values.into_iter().zip(texts).map(|(at, text)| Label { at, text });
                AxisTicks {
                    labelled: labels.filter(|label| self.ends.is_none() || inside(&label.at)).collect(),
                    minor: minor.into_iter().filter(|value| self.ends.is_none() || inside(value)).collect(),
                }
            }
        }
    }

    /// The label of the end at `value`, written as the labels of `inner` are: at a value of few digits close to it.
    fn end(&self, value: f64, inner: &[Label]) -> Label {
        let number = if self.scale == Scale::Logarithmic { math::pow(10.0, value) } else { value };
        let at = |number: f64| if self.scale == Scale::Logarithmic { math::log10(number) } else { number };
        let rounded = |digits: usize| format!("{number:.*e}", digits - 1).parse::<f64>().unwrap_or(number);
        // No farther away than the edge of the axis, or than can be seen.
        let seen = UNSEEN_PX / self.length_px * (self.range.end - self.range.start);
        let slack = (value - self.range.start).min(self.range.end - value).max(seen);
        let near = |number: &f64| (at(*number) - value).abs() <= slack;
        let number = (END_DIGITS..=MOST_END_DIGITS).map(rounded).find(near).unwrap_or(number);
        // As its neighbours, if it is one of them.
        let same = inner.iter().find(|label| self.px(label.at - at(number)).abs() < 1e-6);
        let text = same.map_or_else(
            || match self.scale {
                Scale::Linear | Scale::Whole => {
                    TickText::number(number, step(&inner.iter().map(|label| label.at).collect::<Vec<_>>()))
                }
                Scale::Logarithmic => TickText::number(number, 1.0),
            },
            |label| label.text.clone(),
        );
        Label { at: at(number), text }
    }
}

/// Distance between neighbouring `values`; 1 for fewer than two.
fn step(values: &[f64]) -> f64 {
    match values {
        [first, second, ..] => second - first,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(scale: Scale, ends: (f64, f64), half_cell: f64, way: Way, length_px: f64) -> Axis {
        let range = ends.0 - half_cell..ends.1 + half_cell;
        let target = if way == Way::Across { 8 } else { (length_px / 28.0) as usize };
        Axis { range, scale, ends: Some(ends), way, length_px, target, margin: 0.0 }
    }

    fn texts(axis: &Axis) -> Vec<String> {
        axis.ticks()
            .labelled
            .iter()
            .map(|label| label.text.svg().replace("<tspan dy=\"-0.45em\" font-size=\"0.75em\">", "^"))
            .collect()
    }

    #[test]
    fn both_ends_are_labelled() {
        let figure_8 = axis(Scale::Linear, (1.0, 10.0), 0.07, Way::Up, 286.0);
        assert_eq!(texts(&figure_8), ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10"]);
        let slenderness = axis(Scale::Linear, (5.0, 40.0), 0.1, Way::Up, 286.0);
        assert_eq!(texts(&slenderness), ["5", "10", "15", "20", "25", "30", "35", "40"]);
        let frequency = axis(Scale::Linear, (0.2, 8.0), 0.06, Way::Across, 286.0);
        assert_eq!(texts(&frequency), ["0.2", "1", "2", "3", "4", "5", "6", "7", "8"]);
        let decades = axis(Scale::Logarithmic, (-2.0, 1.0), 0.01, Way::Across, 286.0);
        assert_eq!(texts(&decades), ["10^\u{2212}2</tspan>", "10^\u{2212}1</tspan>", "10^0</tspan>", "10^1</tspan>"]);
        let short = axis(Scale::Logarithmic, (math::log10(0.5), math::log10(8.0)), 0.01, Way::Across, 286.0);
        assert_eq!(texts(&short), ["0.5", "1", "2", "5", "8"]);
        let wide = axis(Scale::Logarithmic, (math::log10(0.3), math::log10(4e7)), 0.01, Way::Across, 286.0);
        let wide = texts(&wide);
        assert_eq!((wide[0].as_str(), wide[wide.len() - 1].as_str()), ("0.3", "4·10^7</tspan>"));
    }

    /// A map of few cells shows half a cell more than it knows of.
    #[test]
    fn nothing_is_marked_beyond_the_ends() {
        let delay = axis(Scale::Linear, (0.0, 0.1), 0.0167, Way::Up, 286.0);
        let ticks = delay.ticks();
        let all = ticks.labelled.iter().map(|label| label.at).chain(ticks.minor.iter().copied());
        assert!(all.into_iter().all(|at| (-1e-12..=0.1 + 1e-12).contains(&at)));
        let decades = axis(Scale::Logarithmic, (-0.5, 1.5), 0.4, Way::Across, 286.0).ticks();
        assert!(decades.minor.iter().all(|at| (-0.51..1.51).contains(at)));
    }

    #[test]
    fn a_label_stands_at_its_own_value_on_the_axis() {
        for (first, last, half) in [(0.123_456, 9.876_54, 0.01), (1.0, 1.000_1, 1e-7), (-3.3e-7, 2.2e8, 1e3)] {
            let axis = axis(Scale::Linear, (first, last), half, Way::Across, 286.0);
            for label in axis.ticks().labelled {
                let text = label.text.svg().replace('\u{2212}', "-");
                let shown = text.parse::<f64>().unwrap_or(label.at);
                assert!((shown - label.at).abs() <= 1e-9 * (last - first), "{text} at {}", label.at);
                assert!(axis.range.contains(&label.at), "{text}");
            }
        }
    }

    #[test]
    fn no_two_labels_collide() {
        for length_px in [110.0, 286.0, 360.0] {
            for way in [Way::Across, Way::Up] {
                for scale in [Scale::Linear, Scale::Logarithmic] {
                    for (first, last) in [(0.0, 1.0), (-0.013, 0.97), (1.0, 1.000_01), (-7.0, 5.0), (-200.0, 300.0), (4.9, 5.1)] {
                        let axis = axis(scale, (first, last), 0.01 * (last - first), way, length_px);
                        let labels = axis.ticks().labelled;
                        assert!(labels.len() >= 2, "{axis:?}");
                        assert!(labels.windows(2).all(|pair| axis.apart(&pair[0], &pair[1])), "{axis:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn counts_have_whole_ticks() {
        for (first, last) in [(-0.05, 1.05), (-0.1, 2.1), (-0.5, 0.5), (2.9, 4.1), (-1.0, 21.0), (-15.0, 315.0)] {
            let axis = Axis { ends: None, ..axis(Scale::Whole, (first, last), 0.0, Way::Up, 300.0) };
            let ticks = axis.ticks();
            let texts: Vec<String> = ticks.labelled.iter().map(|label| label.text.svg()).collect();
            assert!(!texts.is_empty() && texts.iter().all(|text| !text.contains('.')), "{first} to {last}: {texts:?}");
        }
    }
}
