//! Round tick values and their text.

use std::ops::Range;

use sprag_shared::math;

use super::text_width::text_width_px;

/// How an axis is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal steps of the value.
    #[default]
    Linear,
    /// Equal steps of a count: ticks are whole numbers.
    Whole,
    /// Equal steps of its decimal logarithm, for positive values.
    Logarithmic,
}

impl Scale {
    /// Where `value` is on an axis: its decimal logarithm on a logarithmic one, where only positive values are.
    pub(super) fn place(self, value: f64) -> Option<f64> {
        match self {
            Scale::Linear | Scale::Whole => Some(value),
            Scale::Logarithmic => (value > 0.0).then(|| math::log10(value)),
        }
    }
}

/// Whether `value` can be drawn: the square root keeps sums and differences of such values finite too.
pub(super) fn drawable(value: f64) -> bool {
    value.abs() < f64::MAX.sqrt()
}

/// Air beyond the outermost points, relative to the range.
const AIR: f64 = 0.05;
/// A linear vertical axis starts at zero when the values reach down to this part of the highest.
const ZERO_WITHIN: f64 = 0.35;

/// Distances between labelled powers of ten, the last for all that doubles hold.
const POWER_STRIDES: [f64; 8] = [1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0];

/// Narrowest logarithmic axis: a factor of ten, which holds three of the labels 1, 2 and 5.
const LEAST_CLOSE: f64 = 1.0;

/// Narrowest decade that has ticks inside, and narrowest one that has a tick at all (px).
const LEAST_DECADE_PX: (f64, f64) = (20.0, 3.0);

/// The range of an axis that shows `values`, which are powers of ten on a logarithmic one; `None` without values.
pub(super) fn axis_range(values: impl Iterator<Item = f64>, scale: Scale) -> Option<Range<f64>> {
    let (mut low, mut high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return None;
    }
    if scale != Scale::Logarithmic {
        if low > 0.0 && low < ZERO_WITHIN * high {
            low = 0.0;
        } else if high < 0.0 && high > ZERO_WITHIN * low {
            high = 0.0;
        }
    }
    let size = low.abs().max(high.abs());
    // Ticks need steps that change the values they are added to.
    if high - low < 1e-9 * size || high - low < 1e-200 {
        let half = if size < 1e-200 { 0.5 } else { 0.1 * size };
        (low, high) = (low - half, high + half);
    }
    let air = AIR * (high - low);
    let (from, to) = (low - air, high + air);
    // A logarithmic axis needs two powers of ten to be read.
    if scale == Scale::Logarithmic && to.floor() - from.ceil() < 1.0 {
        let (from, to) = ((low + 1e-9).floor(), (high - 1e-9).ceil());
        return Some(from - 0.01..to.max(from + 1.0) + 0.01);
    }
    Some(from..to)
}

/// The range of a logarithmic axis that shows `powers` closely, where the powers of ten inside may be fewer than two; `None` without
/// any.
pub(super) fn close_range(powers: impl Iterator<Item = f64>) -> Option<Range<f64>> {
    let (low, high) = powers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), power| (low.min(power), high.max(power)));
    if low > high {
        return None;
    }
    let air = (AIR * (high - low)).max(0.5 * (LEAST_CLOSE - (high - low)));
    Some(low - air..high + air)
}

/// Labelled and minor ticks of a logarithmic axis over the powers of ten in `range`, `length_px` long: about `target` labels.
pub(super) fn decade_ticks(range: &Range<f64>, target: usize, length_px: f64) -> (Vec<f64>, Vec<f64>) {
    let width = range.end - range.start;
    let fits = |stride: &f64| width / stride <= target.max(1) as f64 + 1e-9;
    let stride = POWER_STRIDES.into_iter().find(fits).unwrap_or(POWER_STRIDES[POWER_STRIDES.len() - 1]);
    let multiples = |stride: f64| {
        let first = (range.start / stride - 1e-9).ceil() as i32;
        let last = (range.end / stride + 1e-9).floor() as i32;
        (first..=last).map(move |multiple| f64::from(multiple) * stride)
    };
    let mut labelled: Vec<f64> = multiples(stride).collect();
    if labelled.len() < 2 {
        let decades = (range.start.floor() as i32)..=(range.end.ceil() as i32);
        let round = [1.0, 2.0, 5.0].map(math::log10);
        labelled =
            decades.flat_map(|power| round.map(|digit| f64::from(power) + digit)).filter(|power| range.contains(power)).collect();
    }
    let decade_px = length_px / width;
    let minor = if stride > 1.0 && decade_px >= LEAST_DECADE_PX.1 {
        multiples(1.0).filter(|power| !labelled.contains(power)).collect()
    } else if stride == 1.0 && decade_px >= LEAST_DECADE_PX.0 {
        let decades = (range.start.floor() as i32)..=(range.end.ceil() as i32);
        let inside = decades.flat_map(|power| (2..10).map(move |digit| f64::from(power) + math::log10(f64::from(digit))));
        inside.filter(|power| range.contains(power) && !labelled.contains(power)).collect()
    } else {
        Vec::new()
    };
    (labelled, minor)
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TickText {
    base: String,
    /// Raised behind the base; may be empty.
    exponent: String,
}

impl TickText {
    /// `text`, without an exponent.
    pub(super) fn plain(text: String) -> Self {
        Self { base: text, exponent: String::new() }
    }

    /// Ten to the whole number `power`, with a true minus sign.
    fn power_of_ten(power: f64) -> Self {
        let sign = if power < 0.0 { "\u{2212}" } else { "" };
        Self { base: "10".to_owned(), exponent: format!("{sign}{:.0}", power.abs()) }
    }

    /// `number` with as many decimals as it has, and at least those of ticks that are `step` apart; times a power of ten if it is long.
    pub(super) fn number(number: f64, step: f64) -> Self {
        let shortest = format!("{number}").replace('-', "\u{2212}");
        let size = number.abs();
        if size != 0.0 && !(1e-3..1e5).contains(&size) {
            let power = (math::log10(size) + 1e-12).floor();
            let mantissa = format!("{number:e}").split('e').next().unwrap_or_default().replace('-', "\u{2212}");
            let raised = Self::power_of_ten(power);
            return if mantissa == "1" { raised } else { Self { base: format!("{mantissa}·10"), ..raised } };
        }
        let as_neighbours = tick_text(number, step);
        let decimals = |text: &str| text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        Self::plain(if decimals(&as_neighbours) >= decimals(&shortest) { as_neighbours } else { shortest })
    }

    /// As SVG content.
    pub(super) fn svg(&self) -> String {
        if self.exponent.is_empty() {
            return self.base.clone();
        }
        format!("{}<tspan dy=\"-0.45em\" font-size=\"0.75em\">{}</tspan>", self.base, self.exponent)
    }

    /// Width (px) at `font_px`.
    pub(super) fn width_px(&self, font_px: f64) -> f64 {
        text_width_px(&self.base, font_px) + text_width_px(&self.exponent, 0.75 * font_px)
    }
}

/// Texts of the labelled ticks of a logarithmic axis: powers of ten, or numbers where some of them are none.
pub(super) fn decade_texts(labelled: &[f64]) -> Vec<TickText> {
    if labelled.iter().all(|power| *power == power.round()) {
        return labelled.iter().map(|power| TickText::power_of_ten(*power)).collect();
    }
    let text = |power: &f64| tick_text(math::pow(10.0, *power), math::pow(10.0, (power + 1e-9).floor()));
    labelled.iter().map(|power| TickText::plain(text(power))).collect()
}

/// Multiples of 1, 2 or 5 times a power of ten inside `range`, about `target` of them; never more than twice that.
///
/// Ticks closer to an end than `margin` times the range are left out, so that labels of stacked panels stay apart. Where
/// that leaves fewer than three, a finer step is taken.
pub(super) fn round_ticks(range: &Range<f64>, target: usize, margin: f64) -> Vec<f64> {
    let target = target.max(1);
    let coarse = ticks_of(range, target, margin);
    if coarse.len() >= 3 {
        return coarse;
    }
    let fine = ticks_of(range, 2 * target, margin);
    if fine.len() <= 2 * target { fine } else { coarse }
}

fn ticks_of(range: &Range<f64>, target: usize, margin: f64) -> Vec<f64> {
    let width = range.end - range.start;
    let step = round_step(width / target as f64);
    let first = ((range.start + margin * width) / step - 1e-9).ceil();
    let last = ((range.end - margin * width) / step + 1e-9).floor();
    let mut ticks = Vec::new();
    let mut multiple = first;
    while multiple <= last {
        // Adding zero turns a negative zero into a plain one.
        ticks.push(multiple * step + 0.0);
        multiple += 1.0;
    }
    ticks
}

/// The smallest of 1, 2, 5 times a power of ten that is not far below `rough`, which is positive.
fn round_step(rough: f64) -> f64 {
    let least = 0.7 * rough;
    let mut power = 1.0;
    while power > least && power > f64::MIN_POSITIVE {
        power /= 10.0;
    }
    while power * 10.0 <= least {
        power *= 10.0;
    }
    [1.0, 2.0, 5.0].into_iter().map(|digit| digit * power).find(|&step| step >= least).unwrap_or(power * 10.0)
}

/// Text of the tick at `value` when neighbours lie `step` apart, with a true minus sign.
pub(super) fn tick_text(value: f64, step: f64) -> String {
    let size = value.abs();
    let text = if size < step * 1e-6 {
        "0".to_owned()
    } else if size >= 1e5 || (step < 1e-4 && size < 1e-3) {
        scientific(size, step)
    } else {
        let mut decimals = 0;
        let mut unit = 1.0;
        while unit > step * (1.0 + 1e-9) {
            decimals += 1;
            unit /= 10.0;
        }
        format!("{size:.decimals$}")
    };
    if value < 0.0 && text != "0" { format!("\u{2212}{text}") } else { text }
}

/// With the digits that distinguish ticks `step` apart.
fn scientific(size: f64, step: f64) -> String {
    let power = |value: f64| (math::log10(value) + 1e-9).floor();
    let decimals = (power(size) - power(step)).clamp(0.0, 15.0) as usize;
    let text = format!("{size:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{mantissa}e{}", exponent.replace('-', "\u{2212}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(round_ticks(&(-1.2..1.2), 5, 0.0), vec![-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(round_ticks(&(0.0..10.0), 5, 0.0), vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(round_ticks(&(0.0..10.0), 5, 0.05), vec![2.0, 4.0, 6.0, 8.0]);
        for width in [1e-6, 0.3, 17.0, 4.2e7] {
            let ticks = round_ticks(&(-width..width), 5, 0.0);
            assert!((3..=10).contains(&ticks.len()), "{width}: {ticks:?}");
        }
    }

    #[test]
    fn ranges_hold_their_values_and_are_never_empty() {
        for (low, high) in [(0.0, 0.0), (1e15, 1e15), (-3.0, -3.0), (5e-324, 1e-300), (-1e150, 1e150), (2.0, 3.0), (-0.1, 8.0)] {
            for scale in [Scale::Linear, Scale::Logarithmic] {
                let range = axis_range([low, high].into_iter(), scale).unwrap();
                assert!(range.start <= low && range.end >= high && range.end > range.start, "{low} {high}: {range:?}");
            }
        }
        assert_eq!(axis_range([0.2, 1.0].into_iter(), Scale::Linear).unwrap().start, -AIR);
        assert!(axis_range([0.8, 1.0].into_iter(), Scale::Linear).unwrap().start > 0.7);
        // Two powers of ten at least: from 3 to 8 becomes from 1 to 10.
        let short = axis_range([0.5, 0.9].into_iter(), Scale::Logarithmic).unwrap();
        assert!(short.start < 0.0 && short.start > -0.1 && short.end > 1.0 && short.end < 1.1);
        assert_eq!(axis_range(std::iter::empty(), Scale::Linear), None);
    }

    #[test]
    fn decades_are_labelled_and_divided_where_there_is_room() {
        let (labelled, minor) = decade_ticks(&(-3.2..-0.9), 5, 200.0);
        assert_eq!(labelled, vec![-3.0, -2.0, -1.0]);
        assert_eq!(minor.len(), 3 + 8 + 8);
        let (labelled, minor) = decade_ticks(&(-12.0..0.5), 5, 200.0);
        assert_eq!(labelled, vec![-12.0, -9.0, -6.0, -3.0, 0.0]);
        assert_eq!(minor.len(), 8);
        let (labelled, minor) = decade_ticks(&(-323.0..308.0), 5, 200.0);
        assert!(labelled.len() >= 3 && labelled.len() <= 8 && minor.is_empty());
        // From 0.7 to 7: 1, 2 and 5 are labelled.
        let close = close_range([-0.15, 0.85].into_iter()).unwrap();
        let (labelled, minor) = decade_ticks(&close, 5, 200.0);
        let texts = |labelled: &[f64]| decade_texts(labelled).iter().map(TickText::svg).collect::<Vec<_>>();
        assert_eq!(texts(&labelled), ["1", "2", "5"]);
        assert_eq!(minor.len(), 7, "{minor:?}");
        assert_eq!(texts(&[math::log10(0.2), math::log10(0.5), 0.0]), ["0.2", "0.5", "1"]);
        assert_eq!(close_range(std::iter::empty()), None);
        assert_eq!(TickText::power_of_ten(-3.0).svg(), "10<tspan dy=\"-0.45em\" font-size=\"0.75em\">\u{2212}3</tspan>");
    }

    #[test]
    fn text_has_the_decimals_of_the_step() {
        assert_eq!(tick_text(0.5, 0.5), "0.5");
        assert_eq!(tick_text(1.0, 0.5), "1.0");
        assert_eq!(tick_text(-0.25, 0.05), "\u{2212}0.25");
        assert_eq!(tick_text(20.0, 20.0), "20");
        assert_eq!(tick_text(1e-17, 0.5), "0");
        assert_eq!(tick_text(-2e-6, 1e-6), "\u{2212}2e\u{2212}6");
        assert_eq!(tick_text(2e6, 1e6), "2e6");
        assert_eq!(tick_text(123_450.0, 10.0), "1.2345e5");
        assert_eq!(tick_text(1.000_01, 5e-6), "1.000010");
    }
}
