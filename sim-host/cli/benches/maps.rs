//! How fast overturning maps are: blocks in lanes against the same blocks one at a time.
//!
//! `cargo bench --bench maps` prints, for the 64 x 64 grid of each device and pulse (α = 20°, σ = 0.5, ω_g/p 0.2-8, a 1-10) and one core,
//! cells a second in the widest registers of the machine, in those that every machine has, and by the core, as minima of several
//! passes, with the ratios that a shared machine leaves standing; and what two threads are worth.

use std::hint::black_box;

use rayon::prelude::*;
use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::PulsedBlock;
use sprag_loops::{Method, Precision};
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::TIGHT;

mod figure08;

use figure08::{cells, fastest};

const PASSES: usize = 15;

fn main() {
    println!("cells a second on one core; times the core's own speed in brackets");
    println!("{:8} {:14} {:>22} {:>22} {:>12}", "geometry", "device", "widest registers", "baseline registers", "core");
    for geometry in [Geometry::Full, Geometry::Slender] {
        let (mut count, mut totals) = (0, [0.0; 3]);
        for device in DeviceKind::ALL {
            let cases = cells(geometry, device);
            let pulsed: Vec<PulsedBlock> = cases.iter().map(PulsedBlock::from).collect();
            let lanes = |registers| fastest(PASSES, || drop(black_box(run(&pulsed, registers))));
            let method = f64::ideal(Method::Adaptive(TIGHT));
            let alone = fastest(3, || cases.iter().for_each(|case| _ = black_box(case.run(&*method))));
            let seconds = [lanes(Registers::Widest), lanes(Registers::Baseline), alone];
            count += cases.len();
            for (total, seconds) in totals.iter_mut().zip(seconds) {
                *total += seconds;
            }
            row(&format!("{geometry:?}"), &format!("{device:?}"), cases.len(), seconds);
        }
        row(&format!("{geometry:?}"), "all", count, totals);
    }
    let cases: Vec<PulsedBlock> =
        DeviceKind::ALL.iter().flat_map(|&device| cells(Geometry::Full, device)).map(|c| PulsedBlock::from(&c)).collect();
    let cases: Vec<PulsedBlock> = (0..4).flat_map(|_| cases.iter().copied()).collect();
    let threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        pool.map_or(f64::NAN, |pool| {
            fastest(PASSES, || {
                pool.install(|| cases.par_chunks(1024).for_each(|part| drop(black_box(run(part, Registers::Widest)))))
            })
        })
    };
    println!("\ntwo threads against one: {:.2} times as fast", threads(1) / threads(2));
}

fn row(geometry: &str, device: &str, cells: usize, seconds: [f64; 3]) {
    let rate = |index: usize| cells as f64 / seconds[index];
    let times = |index: usize| format!("{:.0} ({:.1})", rate(index), seconds[2] / seconds[index]);
    println!("{geometry:8} {device:14} {:>22} {:>22} {:12.0}", times(0), times(1), rate(2));
}
