//! Training of the law with a linear costate: its weights by the cross-entropy method (Rubinstein 1999), with full-state feedback.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sprag_report::long_run::in_order::all_in_order;
use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_shared::control::law::any_law::ClutchLaw;
use sprag_shared::control::law::costate::Costate;
use sprag_shared::control::law::look_ahead::LookAhead;
use sprag_shared::control::law::{GatedTable, SignTable};
use sprag_shared::math::square_root;
use sprag_sim::clairvoyant::{Followed, FullState, Shaking};

use super::bench::{Conditions, StudyError, with_loop};
use super::law_settings::Setting;
use super::laws::{AMPLITUDES, FREQUENCIES};
use super::motion::{Family, Motion, Records, and_records, between};
use super::report::Report;
use crate::statistics::normal::quantile;

/// Random pulses of each family, of which every other one validates.
const PULSES: usize = 240;
/// Peaks of records over g tan α.
const THRESHOLDS: [f64; 6] = [1.6, 2.0, 2.5, 3.0, 3.7, 4.5];
/// Delays in ms, and whether released flywheels are braked.
const CLUTCHES: [(f64, bool); 3] = [(10.0, true), (30.0, true), (10.0, false)];
/// Ticks a second: as many as the delays allow.
const RATE: &str = "controller.rate_hz=200.0";
/// Searches, each from the beginning, …
const SEARCHES: u64 = 3;
/// … of so many generations …
const GENERATIONS: usize = 24;
/// … of so many laws each, …
const POPULATION: usize = 24;
/// … of which the best make the next.
const ELITE: usize = 6;
/// Standard deviation of the first generation about Eq. 10, …
const SPREAD: f64 = 0.4;
/// … and how much of a generation's the next one keeps beside that of the best.
const KEPT: f64 = 0.4;
/// How much more than the best plain choice a law may overturn of a kind of motions before it counts three times.
const WORSE: f64 = 1.02;
/// How much recorded motions count beside one family of pulses.
const RECORDED: f64 = 4.0;
/// How much peaks count beside overturned blocks.
const PEAKS: f64 = 0.2;
/// An overturned block's share in a sum of peaks |θ|/α.
const CAP: f64 = 1.3;
/// Peak over the uplift threshold beyond which no law is asked to keep a block standing that none keeps standing now.
const HOPELESS: f64 = 5.0;

/// What needs no knowledge of the motion, and Eq. 10.
const PLAIN: [ClutchLaw; 3] = [ClutchLaw::Passive, ClutchLaw::AlwaysEngaged, ClutchLaw::ResistingPredicted];

/// Weights of a law, in the order of [`NAMES`].
type Weights = [f64; NAMES.len()];

const NAMES: [&str; 7] = ["rotation", "curvature", "ground", "drift", "jolt", "take", "keep"];

/// For comparison: weights with which a flywheel is taken on that is not kept.
const RESTLESS: Costate =
    Costate { rotation: 0.3, curvature: 0.04, ground: -0.29, drift: 0.57, jolt: -0.12, take: -1.0, keep: 0.03 };

/// Weights with which a flywheel is taken on only where it is kept: otherwise it goes on and off as fast as its clutch can.
fn in_full(&[rotation, curvature, ground, drift, jolt, take, keep]: &Weights) -> Weights {
    [rotation, curvature, ground, drift, jolt, take.max(keep), keep]
}

fn law(weights: &Weights) -> ClutchLaw {
    let [rotation, curvature, ground, drift, jolt, take, keep] = in_full(weights).map(|weight| weight as f32);
    ClutchLaw::Costate(Costate { rotation, curvature, ground, drift, jolt, take, keep })
}

fn weights_of(law: &Costate) -> Weights {
    let Costate { rotation, curvature, ground, drift, jolt, take, keep } = *law;
    [rotation, curvature, ground, drift, jolt, take, keep].map(f64::from)
}

/// What a law makes of the motions of one kind with one clutch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Tally {
    /// Overturned.
    overturned: f64,
    /// Sum of the peaks |θ|/α.
    peaks: f64,
    /// Engagements.
    engagements: f64,
}

/// Motions of one kind that the laws tell apart with one clutch, and the best that a plain choice makes of them, with the engagements of
/// Eq. 10.
struct Kind<'a> {
    motions: Vec<&'a Shaking>,
    plain: Tally,
    weight: f64,
}

/// A clutch with its motions, kind by kind.
struct Ground<'a> {
    full_state: &'a FullState,
    kinds: Vec<Kind<'a>>,
}

/// A motion and its peak over the uplift threshold.
type Sized = (Shaking, f64);

fn tally(followed: impl Iterator<Item = Followed>) -> Tally {
    followed.fold(Tally::default(), |sum, Followed { peak, engagements }| Tally {
        overturned: sum.overturned + f64::from(u8::from(peak.is_none())),
        peaks: sum.peaks + peak.map_or(CAP, |peak| peak.min(CAP)),
        engagements: sum.engagements + f64::from(engagements),
    })
}

impl<'a> Ground<'a> {
    fn new(full_state: &'a FullState, kinds: &'a [Vec<Sized>]) -> Ground<'a> {
        let laws = PLAIN.into_iter().chain([
            ClutchLaw::SignTable(SignTable::EITHER),
            ClutchLaw::GatedTable(GatedTable::DEFAULT),
            ClutchLaw::LookAhead(LookAhead::default()),
        ]);
        let laws: Vec<ClutchLaw> = laws.collect();
        let kind = |(index, motions): (usize, &'a Vec<Sized>)| {
            let by_law = |motion: &Sized| laws.iter().map(|&law| full_state.follow(law, &motion.0)).collect::<Vec<_>>();
            let known: Vec<(&Sized, Vec<Followed>)> = motions.iter().map(|motion| (motion, by_law(motion))).collect();
            let told_apart = |laws: &[Followed], size: f64| {
                let stands = |followed: &Followed| followed.peak.is_some();
                !laws.iter().all(stands) && (size < HOPELESS || laws.iter().any(stands))
            };
            let known: Vec<_> = known.into_iter().filter(|(motion, laws)| told_apart(laws, motion.1)).collect();
            let plain = (0..PLAIN.len()).map(|law| tally(known.iter().map(|(_, laws)| laws[law])));
            // The last one's engagements are those of Eq. 10.
            let least = |best: Tally, next: Tally| Tally {
                overturned: best.overturned.min(next.overturned),
                peaks: best.peaks.min(next.peaks),
                engagements: next.engagements,
            };
            let plain = plain.reduce(least).unwrap_or_default();
            let weight = if index < Family::ALL.len() { 1.0 } else { RECORDED };
            Kind { motions: known.into_iter().map(|(motion, _)| &motion.0).collect(), plain, weight }
        };
        Ground { full_state, kinds: kinds.iter().enumerate().map(kind).collect() }
    }

    fn tallies(&self, law: ClutchLaw) -> Vec<Tally> {
        let of = |kind: &Kind<'_>| tally(kind.motions.iter().map(|motion| self.full_state.follow(law, motion)));
        self.kinds.iter().map(of).collect()
    }

    /// What is held against a law with these tallies, and the weight of the kinds.
    fn held_against(&self, tallies: &[Tally]) -> (f64, f64) {
        self.kinds.iter().zip(tallies).filter(|(kind, _)| !kind.motions.is_empty()).fold(
            (0.0, 0.0),
            |(sum, weights), (kind, tally)| {
                let overturned = tally.overturned / kind.plain.overturned.max(1.0);
                let peaks = tally.peaks / kind.plain.peaks;
                let cost = overturned + 2.0 * (overturned - WORSE).max(0.0) + PEAKS * peaks;
                (sum + kind.weight * cost, weights + kind.weight)
            },
        )
    }
}

/// Mean of what is held against a law; 1 + [`PEAKS`] for the best plain choice of every kind.
fn cost(grounds: &[Ground<'_>], law: ClutchLaw) -> f64 {
    let parts = grounds.iter().map(|ground| ground.held_against(&ground.tallies(law)));
    let (sum, weights) = parts.fold((0.0, 0.0), |(sum, weights), (part, weight)| (sum + part, weights + weight));
    sum / weights.max(1.0)
}

/// Engagements over those of Eq. 10.
fn engagements(grounds: &[Ground<'_>], law: ClutchLaw) -> f64 {
    let own = grounds.iter().flat_map(|ground| ground.tallies(law)).map(|tally| tally.engagements);
    let plain = grounds.iter().flat_map(|ground| &ground.kinds).map(|kind| kind.plain.engagements);
    own.sum::<f64>() / plain.sum::<f64>().max(1.0)
}

/// Random numbers.
struct Dice(ChaCha8Rng);

impl Dice {
    /// Between 0 and 1.
    fn share(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }
}

/// The best weights of a search of some generations from `seed`, with their cost; Eq. 10 is in the first.
fn search(
    grounds: &[Ground<'_>],
    generations: usize,
    seed: u64,
    progress: &Progress,
    conditions: &Conditions<'_>,
) -> Result<(f64, Weights), StudyError> {
    let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
    let (mut mean, mut spread) = (Weights::default(), [SPREAD; NAMES.len()]);
    let mut best: Option<(f64, Weights)> = None;
    for _ in 0..generations {
        let mut laws: Vec<Weights> = vec![mean];
        laws.resize_with(POPULATION, || std::array::from_fn(|index| mean[index] + spread[index] * quantile(dice.share())));
        let work = |weights: &Weights| {
            if conditions.interrupt.is_set() { Err(StudyError::Interrupted) } else { Ok((cost(grounds, law(weights)), *weights)) }
        };
        let mut found = all_in_order(&laws, progress, work)?;
        found.extend(best);
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        best = found.first().copied();
        let elite = &found[..ELITE];
        for index in 0..NAMES.len() {
            let weights = || elite.iter().map(|(_, weights)| weights[index]);
            mean[index] = weights().sum::<f64>() / ELITE as f64;
            let variance = weights().map(|weight| (weight - mean[index]) * (weight - mean[index])).sum::<f64>() / ELITE as f64;
            spread[index] = KEPT * spread[index] + (1.0 - KEPT) * square_root(variance);
        }
    }
    Ok(best.unwrap_or((f64::INFINITY, mean)))
}

/// Motions of each kind, half of them to train by and half to validate.
fn motions(recorded: &Records<'_>, alpha: f64) -> [Vec<Vec<(Motion, f64)>>; 2] {
    let mut dice = Dice(ChaCha8Rng::seed_from_u64(0));
    let mut pulses = |family: Family| {
        (0..PULSES)
            .map(|_| {
                let amplitude = between(AMPLITUDES, dice.share());
                (family.at(between(FREQUENCIES, dice.share()), amplitude), amplitude)
            })
            .collect::<Vec<_>>()
    };
    let mut kinds: Vec<Vec<(Motion, f64)>> = Family::ALL.iter().map(|&family| pulses(family)).collect();
    let at = |&threshold: &f64| recorded.at_each(&[threshold], alpha).into_iter().map(move |motion| (motion, threshold));
    kinds.push(THRESHOLDS.iter().flat_map(at).collect());
    let families = Family::ALL.len();
    [0, 1].map(|part| {
        let half = |(index, kind): (usize, &Vec<(Motion, f64)>)| {
            // The two components of a station stay together.
            let of = |place: usize| if index < families { place % 2 } else { place % recorded.count() / 2 % 2 };
            kind.iter().enumerate().filter(|(place, _)| of(*place) == part).map(|(_, motion)| motion.clone()).collect()
        };
        kinds.iter().enumerate().map(half).collect()
    })
}

/// Runs the training.
pub fn train(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let recorded = Records::new(records)?;
    let alpha = Setting::base().slenderness_deg.to_radians();
    let variants = CLUTCHES.map(|(delay, braked)| Setting::clutch(delay, braked).variant().with(RATE));
    let still = Family::ALL[0].at(1.0, 1.0);
    let full_state = |variant| with_loop(&still, variant, conditions, |task| Ok(FullState::of(task)?));
    let clutches = variants.iter().filter_map(|variant| full_state(variant).transpose()).collect::<Result<Vec<_>, _>>()?;
    let mut halves = Vec::new();
    for half in motions(&recorded, alpha) {
        let shake = |(motion, size): &(Motion, f64)| {
            with_loop(motion, &variants[0], conditions, |task| Ok((clutches[0].shaking(&task.ground.horizontal), *size)))
        };
        halves.push(half.iter().map(|kind| all_in_order(kind, progress, shake)).collect::<Result<Vec<Vec<Sized>>, _>>()?);
    }
    let mut grounds = Vec::new();
    for half in &halves {
        let ground = |clutch| Ok::<_, StudyError>(Ground::new(clutch, half));
        grounds.push(all_in_order(&clutches, progress, ground)?);
    }
    let mut searches = Vec::new();
    for seed in 1..=SEARCHES {
        let (_, weights) = search(&grounds[0], GENERATIONS, seed, progress, conditions)?;
        let weights = in_full(&weights.map(|weight| (100.0 * weight).round() / 100.0));
        searches.push((cost(&grounds[1], law(&weights)), weights));
    }
    let mut report = Report::new("train", "Training of the law costate");
    report.paragraph(&format!(
        "Cross-entropy method with full-state feedback: {SEARCHES} searches of {GENERATIONS} generations of {POPULATION} laws. R = 2 m, α = {}°, σ = 0.5, \
         η = 0.85; rigid clutches of {}. Motions: {PULSES} random pulses of each of {} families{}. Every other motion trains; the others choose \
         among the searches.",
        Setting::base().slenderness_deg,
        CLUTCHES.map(|(delay, braked)| format!("{delay} ms {}", if braked { "braked" } else { "coasting" })).join(", "),
        Family::ALL.len(),
        and_records(records.len(), &format!(" at {} scales", THRESHOLDS.len())),
    ));
    report.paragraph(&format!(
        "Cost: overturned blocks over those of the best of bare block, inerter and Eq. 10, three times what is beyond {WORSE} of them, and {PEAKS} \
         of the sum of peaks over the least of these three; mean over clutches and kinds, recorded motions {RECORDED} times. Only motions under which \
         one of the laws overturns the block count. Engagements are those under the motions that validate, over those of Eq. 10. The last row has weights with \
         which a flywheel is taken on that is not kept.",
    ));
    report.section("Weights");
    let headings = ["search", "trained", "validated", "engagements"].into_iter().chain(NAMES);
    let mut table = TextTable::new(1, headings.map(str::to_owned));
    let mut row = |name: &str, law: ClutchLaw, weights: &Weights| {
        let costs =
            [number(cost(&grounds[0], law), 4), number(cost(&grounds[1], law), 4), number(engagements(&grounds[1], law), 2)];
        let weights = weights.iter().map(|weight| number(*weight, 2));
        table.row(std::iter::once(name.to_owned()).chain(costs).chain(weights).collect());
    };
    for (index, (_, weights)) in searches.iter().enumerate() {
        row(&(index + 1).to_string(), law(weights), weights);
    }
    row("in use", ClutchLaw::Costate(Costate::TRAINED), &weights_of(&Costate::TRAINED));
    row("Eq. 10", ClutchLaw::ResistingPredicted, &Weights::default());
    row("restless", ClutchLaw::Costate(RESTLESS), &weights_of(&RESTLESS));
    report.table("train-weights", table);
    let best =
        searches.iter().min_by(|one, other| one.0.total_cmp(&other.0)).map_or_else(Weights::default, |(_, weights)| *weights);
    report.section("Validation");
    report.paragraph("Overturned blocks of the motions that validate, with the search that does best there.");
    for (variant, ground) in variants.iter().zip(&grounds[1]) {
        report.paragraph(&format!("**{}.**", variant.name));
        report.table(&format!("train-{}", report.tables.len()), validation(ground, law(&best)));
    }
    Ok(report)
}

fn validation(ground: &Ground<'_>, best: ClutchLaw) -> TextTable {
    let names = Family::ALL.iter().map(|family| family.name()).chain(["records".to_owned()]);
    let headings = names.zip(&ground.kinds).map(|(name, kind)| format!("{name} ({})", kind.motions.len()));
    let mut table = TextTable::new(1, std::iter::once("law".to_owned()).chain(headings));
    let laws = [
        ("passive", PLAIN[0]),
        ("always-engaged", PLAIN[1]),
        ("resisting-predicted", PLAIN[2]),
        ("costate in use", ClutchLaw::Costate(Costate::TRAINED)),
        ("costate found", best),
    ];
    for (name, law) in laws {
        let counts = ground.tallies(law).into_iter().map(|tally| number(tally.overturned, 0));
        table.row(std::iter::once(name.to_owned()).chain(counts).collect());
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loop_study::bench::{Variant, run_loop};
    use crate::loop_study::law_settings::IDEAL;
    use sprag_sim::interrupt::Interrupt;

    fn full_state(motion: &Motion, variant: &Variant, law: ClutchLaw) -> Followed {
        let interrupt = Interrupt::default();
        let followed = with_loop(motion, variant, &Conditions::new(None, &interrupt), |task| {
            let full_state = FullState::of(task)?.unwrap();
            Ok(full_state.follow(law, &full_state.shaking(&task.ground.horizontal)))
        });
        followed.unwrap()
    }

    /// The closed loop with ideal sensors is another program: its plant locates events, and its controller estimates and notices uplift. They
    /// differ by about a tick; a law that reads more than the motion differs more behind a clutch that is late.
    #[test]
    fn full_state_feedback_is_the_closed_loop_with_ideal_sensors() {
        let interrupt = Interrupt::default();
        for (delay, braked) in [(3.0, true), (20.0, true), (20.0, false)] {
            let setting = Setting::clutch(delay, braked);
            let mut variant = setting.variant();
            variant.overrides.extend(IDEAL.map(str::to_owned));
            variant.overrides.push("controller.sensors.suite=\"ideal\"".to_owned());
            for motion in [Family::ALL[1].at(4.0, 2.5), Family::ALL[3].at(3.0, 2.0), Family::ALL[4].at(5.0, 4.0)] {
                let costate = ClutchLaw::Costate(Costate::TRAINED);
                for (name, law, near) in [("resisting-predicted", PLAIN[2], 0.05), ("costate", costate, 0.1)] {
                    let named = variant.with(&format!("controller.law=\"{name}\""));
                    let closed = run_loop(&motion, &named, &Conditions::new(None, &interrupt)).unwrap();
                    let followed = full_state(&motion, &variant, law);
                    let peak = followed.peak.unwrap();
                    // A block that cannot fall any more is not followed to its rest.
                    let all = closed.ending.engagements;
                    assert!(
                        (1..=all).contains(&followed.engagements),
                        "{} {name}: {} of {all}",
                        setting.name,
                        followed.engagements
                    );
                    assert!(
                        (peak / closed.peak - 1.0).abs() < near,
                        "{} {name} {motion:?}: {peak} {}",
                        setting.name,
                        closed.peak
                    );
                }
            }
        }
    }

    #[test]
    fn a_search_does_better_than_it_began_and_the_same_again() {
        let interrupt = Interrupt::default();
        let (conditions, progress) = (Conditions::new(None, &interrupt), Progress::new("runs"));
        let variant = Setting::clutch(10.0, true).variant().with(RATE);
        let motions = Family::ALL[0].spread(24, (2.0, 8.0), (2.0, 8.0));
        let with = |motion: &Motion| {
            let made = with_loop(motion, &variant, &conditions, |task| {
                let full_state = FullState::of(task)?.unwrap();
                Ok((full_state.shaking(&task.ground.horizontal), full_state))
            });
            made.unwrap()
        };
        let sized: Vec<Sized> = motions.iter().map(|motion| (with(motion).0, 4.0)).collect();
        let clutch = with(&motions[0]).1;
        let kinds = [sized];
        let grounds = [Ground::new(&clutch, &kinds)];
        assert!(grounds[0].kinds[0].motions.len() > 4);
        let began = cost(&grounds, PLAIN[2]);
        let found = search(&grounds, 3, 1, &progress, &conditions).unwrap();
        assert!(found.0 < 0.9 * began, "{} {began}", found.0);
        assert_eq!(found, search(&grounds, 3, 1, &progress, &conditions).unwrap());
        assert_eq!(found.0.to_bits(), cost(&grounds, law(&found.1)).to_bits());
        interrupt.set();
        assert!(matches!(search(&grounds, 1, 1, &progress, &conditions), Err(StudyError::Interrupted)));
    }
}
