//! Settings that follow from others: the block's frequency, uplift and coupling from its size, slenderness, inertia ratio and mass ratio.
//!
//! A controller is given p, p², the threshold of uplift and k = σ/λ as words of their own. A person knows R, α, λ and σ: those are given, and
//! the words follow, p² = g/(λR), g tan α (slender: g α), k = σ/λ. λ and σ are no words; they are what the words amount to.

use sprag_shared::math;
use sprag_shared::settings::kind::Description;
use sprag_shared::settings::{Item, Settings};
use sprag_shared::structure::block::{Block, GRAVITY, Geometry};
use sprag_shared::structure::error::Number;

/// λ = I_O/(mR²), which is no word.
pub const INERTIA_RATIO: &str = "model.inertia_ratio";

/// σ of one flywheel, which is no word.
pub const MASS_RATIO: &str = "model.mass_ratio";

/// By which a word may differ from what it should be, relative to that: people write few digits.
const FEW_DIGITS: f64 = 1e-4;

/// Inertia ratios of blocks; below 1 the mass would be nearer to the toe than its own centre.
const INERTIA_RATIOS: core::ops::RangeInclusive<f64> = 1.0 - FEW_DIGITS..=4.0 + 4.0 * FEW_DIGITS;

/// What a source of settings gives beside words.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Given {
    /// Indices of the words that it names.
    pub words: Vec<u16>,
    /// λ.
    pub inertia_ratio: Option<f64>,
    /// σ.
    pub mass_ratio: Option<f64>,
}

impl Given {
    fn has(&self, item: Item) -> bool {
        self.words.contains(&item.index())
    }

    fn any(&self, items: &[Item]) -> bool {
        items.iter().any(|item| self.has(*item))
    }
}

/// The quantity called `name`, if it is one that is no word.
pub fn quantity(settings: &Settings, name: &str) -> Option<f64> {
    match name {
        INERTIA_RATIO => Some(inertia_ratio(settings)),
        MASS_RATIO => Some(real(settings, Item::Coupling) * inertia_ratio(settings)),
        _ => None,
    }
}

/// Range of such a quantity, in words.
pub fn range(name: &str) -> &'static str {
    if name == INERTIA_RATIO { "from 1 to 4" } else { "from 0 to 10000" }
}

/// The value of such a quantity that `text` is, if it can be one.
///
/// # Errors
/// One line with the range.
pub fn parse(name: &str, text: &str) -> Result<f64, String> {
    let values = if name == INERTIA_RATIO { 1.0..=4.0 } else { 0.0..=1e4 };
    text.parse()
        .ok()
        .filter(|value| values.contains(value))
        .ok_or_else(|| format!("{name} is {text}, but must be {}", range(name)))
}

/// Lets the words that nobody gave follow from those that were `given` in the place of words of `before`.
///
/// # Errors
/// One line for a given word that contradicts what was given beside it: both, their values, and what was to be expected.
pub fn follow(before: &Settings, given: &Given, after: &mut Settings) -> Result<(), String> {
    follow_size(before, given, after)?;
    follow_coupling(before, given, after)?;
    let differs = |items: &[Item]| items.iter().any(|item| before.get(item.index()) != after.get(item.index()));
    let moved = differs(&[Item::Size, Item::Slenderness]);
    let new_uplift = differs(&[Item::Slenderness, Item::Body]) && !given.has(Item::Uplift);
    let levers: &[Item] = if slender(after) { &[Item::Lever] } else { &[Item::LeverAlong, Item::LeverAcross] };
    let at_centre = levers.iter().all(|lever| real(after, *lever) == if *lever == Item::LeverAcross { 0.0 } else { 1.0 });
    if moved && !at_centre && !given.any(levers) {
        let named: Vec<String> = levers.iter().map(|lever| stated(after, *lever)).collect();
        let reason = "away from the centre of mass levers change with size and slenderness";
        return Err(format!("{}: {reason}; give them, too, or take all from a scene with --scene", named.join(", ")));
    }
    let longer = real(after, Item::Size) * mean_lever(after) / (real(before, Item::Size) * mean_lever(before));
    if longer != 1.0 && longer.is_finite() && !given.has(Item::CountsPerRadian) {
        put(after, Item::CountsPerRadian, real(before, Item::CountsPerRadian) * longer)?;
    }
    if new_uplift {
        put(after, Item::Uplift, uplift(after))?;
    }
    Ok(())
}

fn follow_size(before: &Settings, given: &Given, after: &mut Settings) -> Result<(), String> {
    let [frequency, squared] = [Item::Frequency, Item::FrequencySquared];
    // Whoever gives all of them gives λ by them.
    if given.inertia_ratio.is_none() && given.has(Item::Size) && given.has(frequency) && given.has(squared) {
        return Ok(());
    }
    let ratio = given.inertia_ratio.unwrap_or_else(|| inertia_ratio(before));
    let size = real(after, Item::Size);
    let expected = GRAVITY / (ratio * size);
    let moved = size != real(before, Item::Size) || given.inertia_ratio.is_some();
    for (item, expected) in [(frequency, math::square_root(expected)), (squared, expected)] {
        if given.has(item) && !near(real(after, item), expected) {
            let size = stated(after, Item::Size);
            let reason = format!("for {size} and {INERTIA_RATIO} = {}", short(ratio));
            return Err(contradiction(after, item, expected, &reason));
        }
    }
    match (given.has(frequency), given.has(squared)) {
        (true, true) => {}
        (true, false) => put(after, squared, real(after, frequency) * real(after, frequency))?,
        (false, true) => put(after, frequency, math::square_root(real(after, squared)))?,
        (false, false) if moved => {
            put(after, frequency, math::square_root(expected))?;
            put(after, squared, expected)?;
        }
        (false, false) => {}
    }
    let scale = real(before, Item::Size) / size;
    if scale != 1.0 {
        for item in [Item::Drag, Item::TravelPerCount] {
            if !given.has(item) {
                put(after, item, real(before, item) * scale)?;
            }
        }
    }
    Ok(())
}

fn follow_coupling(before: &Settings, given: &Given, after: &mut Settings) -> Result<(), String> {
    if given.mass_ratio.is_none() && given.inertia_ratio.is_none() {
        return Ok(());
    }
    let sigma = given.mass_ratio.or_else(|| quantity(before, MASS_RATIO)).unwrap_or_default();
    let ratio = given.inertia_ratio.unwrap_or_else(|| inertia_ratio(after));
    let expected = sigma / ratio;
    if !given.has(Item::Coupling) {
        return put(after, Item::Coupling, expected);
    }
    if given.mass_ratio.is_some() && !near(real(after, Item::Coupling), expected) {
        let reason = format!("for {MASS_RATIO} = {} and {INERTIA_RATIO} = {}", short(sigma), short(ratio));
        return Err(contradiction(after, Item::Coupling, expected, &reason));
    }
    Ok(())
}

/// Whether size, frequency, slenderness and uplift go together.
///
/// # Errors
/// One line that names both words, their values, and what was to be expected.
pub fn check(settings: &Settings) -> Result<(), String> {
    let ratio = inertia_ratio(settings);
    if !INERTIA_RATIOS.contains(&ratio) {
        let reason = format!(
            "{} and {} make {INERTIA_RATIO} = {}, but that must be from 1 to 4",
            stated(settings, Item::Size),
            stated(settings, Item::Frequency),
            short(ratio)
        );
        return Err(reason);
    }
    let expected = uplift(settings);
    if !near(real(settings, Item::Uplift), expected) {
        let of = if slender(settings) { "for" } else { "the tangent, for" };
        let reason = format!("{of} {}", stated(settings, Item::Slenderness));
        return Err(contradiction(settings, Item::Uplift, expected, &reason));
    }
    Ok(())
}

fn contradiction(settings: &Settings, item: Item, expected: f64, reason: &str) -> String {
    let is = stated(settings, item).replacen(" = ", " is ", 1);
    format!("{is}, but must be {} {reason}", short(expected))
}

/// Name and value of a word.
fn stated(settings: &Settings, item: Item) -> String {
    let Some((description, word)) = Description::at(item.index()).zip(settings.get(item.index())) else { return String::new() };
    let unit = if description.unit.is_empty() { String::new() } else { format!(" {}", description.unit) };
    format!("{} = {}{unit}", description.name, description.show(word))
}

/// A derived number as the words have it, in single precision.
fn short(value: f64) -> String {
    let single: f64 = (value as f32).to_string().parse().unwrap_or(value);
    Number(single).to_string()
}

fn near(value: f64, expected: f64) -> bool {
    (value - expected).abs() <= FEW_DIGITS * expected.abs()
}

fn real(settings: &Settings, item: Item) -> f64 {
    settings.get(item.index()).map_or(0.0, |word| f64::from(f32::from_bits(word)))
}

fn put(settings: &mut Settings, item: Item, value: f64) -> Result<(), String> {
    settings.set(item.index(), (value as f32).to_bits()).map_err(|error| error.describe(settings).to_string())
}

fn inertia_ratio(settings: &Settings) -> f64 {
    GRAVITY / (real(settings, Item::FrequencySquared) * real(settings, Item::Size))
}

fn slender(settings: &Settings) -> bool {
    settings.get(Item::Body.index()) == Some(0)
}

/// Travel of the rack over R θ, halfway to the tip.
fn mean_lever(settings: &Settings) -> f64 {
    if slender(settings) {
        return real(settings, Item::Lever);
    }
    let (sin, cos) = math::sin_cos(0.5 * real(settings, Item::Slenderness));
    real(settings, Item::LeverAlong) * cos + real(settings, Item::LeverAcross) * sin
}

/// Threshold of uplift, g.
fn uplift(settings: &Settings) -> f64 {
    let geometry = if slender(settings) { Geometry::Slender } else { Geometry::Full };
    // Size and inertia say nothing of it.
    let block = Block::of_unit_frequency(real(settings, Item::Slenderness), 4.0 / 3.0);
    block.map_or(f64::INFINITY, |block| geometry.uplift_threshold(block.slenderness()))
}
