//! Section 4, Figure 8: regions of overturning.

use sprag_shared::observers::outcome::Outcome;

use super::say;
use super::spectra::{Cell, DEVICES, INERTER, KINDS, NONE, PAIR, REGION_1, REGION_2, SPECTRA, Spectra};

/// Columns of a map, from the lowest amplitude up.
fn columns(map: &Spectra, device: usize) -> Vec<Vec<Outcome>> {
    let column = |first: usize| map.cells[first..].iter().step_by(map.columns).map(|cell| cell.outcome(device)).collect();
    (0..map.columns).map(column).collect()
}

/// Region 1 lies above a curve and Region 2 below it. Region 2 is enclosed, but with the pair it continues upwards beside Region 1.
#[test]
fn regions_lie_as_in_the_figure() {
    for map in SPECTRA.iter() {
        for (device, name) in DEVICES {
            let columns = columns(map, device);
            for column in &columns {
                let from = column.iter().position(|outcome| *outcome == REGION_1).unwrap_or(column.len());
                assert!(
                    column[from..].iter().all(|outcome| *outcome == REGION_1),
                    "{} {name}: Region 1 is not above a curve",
                    map.name
                );
            }
            let open = columns.iter().filter(|column| column.last() == Some(&REGION_2)).count();
            let (one, two) = (map.region(device, REGION_1), map.region(device, REGION_2));
            let safe = map.share(|cell| cell.stands(device));
            say(
                "4.3",
                &map.name,
                &format!("{name:7} Region 1 {one:.1} %, Region 2 {two:.1} % (in {open} columns to the top), safe {safe:.1} %"),
            );
            assert_eq!(open > 0, device == PAIR, "{} {name}", map.name);
        }
        let at_rest = DEVICES.map(|(device, _)| map.count(|cell| cell.outcome(device) == Outcome::NoRocking));
        say(
            "2.1",
            &map.name,
            &format!("cells that do not rock, device by device: {at_rest:?} (a row of the map has {})", map.columns),
        );
        // Whatever the device, the threshold itself does not lift the block, and any amplitude above it does.
        assert!(
            map.cells
                .iter()
                .all(|cell| cell.results.iter().all(|result| (result.outcome == Outcome::NoRocking) == (cell.amplitude <= 1.0)))
        );
        assert_eq!(at_rest, [map.columns; 3]);
    }
}

/// Cells that end otherwise in `full` than in `slender`, in per cent of all.
fn unlike(full: &Spectra, slender: &Spectra) -> [f64; 3] {
    [NONE, INERTER, PAIR].map(|device| {
        let cells = full.cells.iter().zip(&slender.cells);
        let other = cells.filter(|(full, slender)| full.outcome(device) != slender.outcome(device));
        100.0 * other.count() as f64 / full.cells.len() as f64
    })
}

/// Blocks below 10° end as the slender equation says, but for cells beside the boundaries.
#[test]
fn blocks_below_10_degrees_are_slender() {
    for (slender, at_20) in SPECTRA[..2].iter().zip(&SPECTRA[2..]) {
        let pulse = slender.name.trim_start_matches("slender ");
        let full = |degrees: &str| Spectra::of(("full", pulse), &[&format!("block.slenderness_deg={degrees}")]);
        let [five, ten, twenty] = [&full("5"), &full("10"), at_20].map(|full| unlike(full, slender));
        say(
            "4.4",
            &slender.name,
            &format!("other outcomes (none, inerter, pair): at 5° {five:.2?} %, at 10° {ten:.2?} %, at 20° {twenty:.2?} %"),
        );
        assert!(five.iter().all(|share| *share < 0.5) && ten.iter().all(|share| *share < 2.0), "{five:?} {ten:?}");
        assert!(twenty.iter().zip(ten).all(|(twenty, ten)| *twenty > ten));
    }
}

/// The single inerter takes from both regions and brings them to lower frequencies; a few blocks that stood without it overturn.
#[test]
fn an_inerter_reduces_and_shifts_both_regions() {
    for map in SPECTRA.iter() {
        let [none, inerter, pair] = [NONE, INERTER, PAIR].map(|device| map.overturned(device));
        let regions = [NONE, INERTER, PAIR].map(|device| [REGION_1, REGION_2].map(|region| map.region(device, region)));
        say(
            "4.5",
            &map.name,
            &format!("overturn: none {none:.1} %, inerter {inerter:.1} %, pair {pair:.1} %; Regions 1 and 2 {regions:.1?}"),
        );
        assert!((0.80..0.90).contains(&(inerter / none)), "{}", map.name);
        assert!([0, 1].iter().all(|region| regions[INERTER][*region] < 0.9 * regions[NONE][*region]), "{}", map.name);
        assert!(pair < none, "{}", map.name);
        for region in [REGION_1, REGION_2] {
            let reach = [NONE, INERTER, PAIR].map(|device| map.reach(device, region));
            say("4.6", &map.name, &format!("{}: mean and highest ω_g/p, device by device {reach:.2?}", region.name()));
            assert!(reach[INERTER].0 < 0.9 * reach[NONE].0 && reach[INERTER].1 < 0.9 * reach[NONE].1, "{}", map.name);
        }
        let fallen = map.count(|cell| cell.stands(NONE) && cell.overturns(INERTER));
        let after_impact = map.count(|cell| cell.stands(NONE) && cell.outcome(INERTER) == REGION_2);
        let saved = map.count(|cell| cell.overturns(NONE) && cell.stands(INERTER));
        let safe = map.count(|cell| cell.stands(NONE));
        say(
            "4.7",
            &map.name,
            &format!(
                "{fallen} of {safe} cells safe without it overturn with the inerter, {after_impact} after an impact; {saved} are saved"
            ),
        );
        assert!(fallen > 0 && fallen == after_impact && 4 * fallen < saved, "{}", map.name);
    }
}

/// What a device changes in the overturning cells of `such`, in per cent of those that overturn without it.
fn change(map: &Spectra, device: usize, such: impl Fn(&Cell) -> bool) -> f64 {
    let overturned = |device: usize| map.count(|cell| such(cell) && cell.overturns(device)) as f64;
    100.0 * (overturned(device) / overturned(NONE) - 1.0)
}

/// Below ω_g/p = 2 devices change little; heavier ones more.
#[test]
fn small_blocks_need_a_higher_mass_ratio() {
    for map in SPECTRA.iter() {
        let [small, others] = [(0.0, 2.0), (2.0, 9.0)].map(|(from, to)| {
            [INERTER, PAIR].map(|device| change(map, device, |cell| cell.frequency >= from && cell.frequency < to))
        });
        say(
            "4.9",
            &map.name,
            &format!("change of overturning, inerter and pair: below ω_g/p = 2 {small:.1?} %, above {others:.1?} %"),
        );
        assert!(small[0] < 0.0 && small[0] > -6.0 && others[0] < -20.0, "{}", map.name);
    }
    for (kind, at_5) in KINDS.into_iter().zip([7.0, 40.0, 7.0, 40.0]) {
        let mut safe = Vec::new();
        for mass_ratio in [0.5, 1.0, 2.0, 5.0, 10.0] {
            let masses = [1, 2].map(|device| format!("device.{device}.mass_ratio={mass_ratio:?}"));
            let low = ["map.x.to=1.975", "map.x.cells=72", &masses[0], &masses[1]];
            let map = Spectra::of(kind, &low);
            let share = |device: usize| map.share(|cell| cell.stands(device));
            say(
                "4.10",
                &map.name,
                &format!(
                    "σ = {mass_ratio}, ω_g/p < 2: safe without {:.1} %, inerter {:.1} %, pair {:.1} %",
                    share(NONE),
                    share(INERTER),
                    share(PAIR)
                ),
            );
            safe.push(share(INERTER));
        }
        assert!(safe.is_sorted() && safe[0] < 8.0 && safe[3] > at_5 - 1.5, "{kind:?}: {safe:?}");
    }
}

/// The clutch under cosines: a little less overturning over the map of the figure, and no longer so over a wider one.
#[test]
fn a_clutch_helps_a_little_under_cosines() {
    for (map, kind) in SPECTRA.iter().zip(KINDS).filter(|(_, kind)| kind.1 == "cosine") {
        let wide = Spectra::of(kind, &["map.x.to=12", "map.x.cells=119", "map.y.to=16", "map.y.cells=76"]);
        let change = |map: &Spectra, region: fn(&Spectra, usize) -> f64| 100.0 * (region(map, PAIR) / region(map, INERTER) - 1.0);
        let of = |map: &Spectra| {
            [
                change(map, |map, device| map.overturned(device)),
                change(map, |map, device| map.region(device, REGION_1)),
                change(map, |map, device| map.region(device, REGION_2)),
            ]
        };
        let (here, there) = (of(map), of(&wide));
        say(
            "4.14",
            &map.name,
            &format!(
                "pair over inerter, both regions, Region 1, Region 2: {here:+.1?} %; to ω_g/p = 12 and amplitude 16 {there:+.1?} %"
            ),
        );
        assert!(here[0] < 0.0 && here[0] > -4.0 && there[0] > 0.0 && there[0] < 5.0, "{}", map.name);
        assert!(here[1] < -5.0 && here[2] > 5.0);
        for region in [REGION_1, REGION_2] {
            let [inerter, pair] = [INERTER, PAIR].map(|device| map.reach(device, region));
            say("4.15", &map.name, &format!("{}: mean and highest ω_g/p inerter {inerter:.2?}, pair {pair:.2?}", region.name()));
            assert!((0.85..1.0).contains(&(pair.0 / inerter.0)) && pair.1 < inerter.1, "{}", map.name);
        }
    }
}

/// The clutch under sines: Region 1 shrinks and shifts on, Region 2 more than doubles and reaches to higher frequencies.
#[test]
fn a_clutch_extends_overturning_after_an_impact_under_sines() {
    for map in SPECTRA.iter().filter(|map| map.name.ends_with(" sine")) {
        let reach = [REGION_1, REGION_2].map(|region| [NONE, INERTER, PAIR].map(|device| map.reach(device, region)));
        say("4.16", &map.name, &format!("Region 1, mean and highest ω_g/p {:.2?}; Region 2 {:.2?}", reach[0], reach[1]));
        assert!(reach[0][PAIR].0 < 0.9 * reach[0][INERTER].0 && reach[0][PAIR].1 < 0.9 * reach[0][INERTER].1);
        assert!(reach[1][PAIR].0 > reach[1][NONE].0 && reach[1][PAIR].1 > reach[1][NONE].1);
        let [none, inerter, pair] = [NONE, INERTER, PAIR].map(|device| map.region(device, REGION_2));
        say("4.17", &map.name, &format!("Region 2: none {none:.1} %, inerter {inerter:.1} %, pair {pair:.1} %"));
        assert!(pair > 2.2 * inerter && inerter < none, "{}", map.name);
        let (worse, better) = (
            map.count(|cell| cell.stands(INERTER) && cell.overturns(PAIR)),
            map.count(|cell| cell.overturns(INERTER) && cell.stands(PAIR)),
        );
        let after_impact = map.count(|cell| cell.stands(INERTER) && cell.outcome(PAIR) == REGION_2);
        say(
            "4.18",
            &map.name,
            &format!("with the clutch {worse} blocks more overturn ({after_impact} after an impact), {better} fewer"),
        );
        assert!(worse > 2 * better && worse == after_impact, "{}", map.name);
    }
}
