//! Sections 4 and 5: what blocks do before they overturn, event by event.

use core::f64::consts::TAU;

use rayon::prelude::*;
use sprag_shared::motion::observer::Event;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::PulseShape;
use sprag_tests::pulse::Pulsed;

use super::say;
use super::spectra::{INERTER, NONE, PAIR, REGION_1, REGION_2};

/// What happens to a block.
#[derive(Clone, Copy, Debug)]
struct Course {
    outcome: Outcome,
    /// It turns back.
    turns: bool,
    /// Its clutch releases, or engages again.
    switches: bool,
    /// First impact over the length of the pulse.
    impact: Option<f64>,
}

/// The courses of every device over the window of the maps, coarser: the core follows every event.
fn courses(geometry: Geometry, shape: PulseShape) -> Vec<[Course; 3]> {
    let cells: Vec<(usize, usize)> = (0..79).flat_map(|column| (0..46).map(move |row| (column, row))).collect();
    let course = |&(column, row): &(usize, usize)| {
        let (frequency, amplitude) = (0.2 + 0.1 * column as f64, 1.0 + 0.2 * row as f64);
        let end = TAU / frequency;
        DeviceKind::ALL.map(|device| {
            let (state, log) = Pulsed { geometry, degrees: 20.0, device, shape, frequency, amplitude }.follow(end + 60.0);
            let happens = |event: Event| log.events.iter().any(|logged| logged.event == event);
            Course {
                outcome: Outcome::of(&state, &log.peaks),
                turns: happens(Event::Turn),
                switches: happens(Event::Switch),
                impact: log.peaks.first_impact.map(|time| time / end),
            }
        })
    };
    cells.par_iter().map(course).collect()
}

/// Of `courses`, those that are `such`, in per cent.
fn share(courses: &[[Course; 3]], such: impl Fn(&[Course; 3]) -> bool) -> f64 {
    100.0 * courses.iter().filter(|course| such(course)).count() as f64 / courses.len() as f64
}

fn of(courses: &[[Course; 3]], such: impl Fn(&[Course; 3]) -> bool) -> Vec<[Course; 3]> {
    courses.iter().filter(|course| such(course)).copied().collect()
}

#[test]
fn courses_to_overturning() {
    for (geometry, shape, name) in [
        (Geometry::Slender, PulseShape::Sine, "slender sine"),
        (Geometry::Slender, PulseShape::Cosine, "slender cosine"),
        (Geometry::Full, PulseShape::Sine, "full sine"),
        (Geometry::Full, PulseShape::Cosine, "full cosine"),
    ] {
        let all = courses(geometry, shape);
        let turned = [NONE, INERTER, PAIR]
            .map(|device| share(&of(&all, |course| course[device].outcome == REGION_1), |course| course[device].turns));
        say("4.11", name, &format!("of Region 1 turn back before they overturn: none, inerter, pair {turned:.1?} %"));
        // Reversals there are, with and without a clutch.
        assert!(turned.iter().all(|share| (5.0..25.0).contains(share)), "{name}: {turned:?}");

        let single = of(&all, |course| course[INERTER].outcome == REGION_1);
        let both = of(&single, |course| course[PAIR].outcome == REGION_1);
        let (switches, turns) = (share(&both, |course| course[PAIR].switches), share(&both, |course| course[PAIR].turns));
        say(
            "5.16",
            name,
            &format!(
                "the pair overturns without an impact in {:.1} % of the cells where the inerter does; in {switches:.1} % of those its clutch releases before, in {turns:.1} % it turns back",
                100.0 * both.len() as f64 / single.len() as f64
            ),
        );
        assert!(all.iter().all(|course| course[PAIR].outcome != REGION_1 || course[INERTER].outcome == REGION_1), "{name}");
        assert!((15.0..60.0).contains(&switches) && turns > 5.0, "{name}");

        if shape == PulseShape::Sine {
            let fallen = of(&all, |course| course[INERTER].outcome == Outcome::Safe && course[PAIR].outcome == REGION_2);
            let during = share(&fallen, |course| course[PAIR].impact.is_some_and(|impact| impact < 1.0));
            say(
                "4.22",
                name,
                &format!(
                    "of {} cells that only the pair overturns in, {during:.1} % have their first impact during the pulse",
                    fallen.len()
                ),
            );
            assert!(fallen.len() > 300 && during == 0.0, "{name}");
        }
    }
}
