//! How fast a batch is, its text tables included, against the map's lanes and the core.
//!
//! `cargo bench --bench batch` prints, for the cells of the overturning map of each device and pulse (both models, a free time of 60/p),
//! rows a second of one thread of `sprag batch` from file to file, of the same cells by the lanes of `sprag map` without text, and by the
//! core one by one; for the cells as they stand in their files and with rows of all kinds mixed; and what two threads are worth. Ratios are
//! what a shared machine leaves standing.

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::Path;

use sprag_cli::command::accuracy_arguments::AccuracyArguments;
use sprag_cli::command::batch::BatchArguments;
use sprag_cli::command::context::Context;
use sprag_cli::command::out_arguments::OverwriteArguments;
use sprag_cli::command::thread_arguments::ThreadArguments;
use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::PulsedBlock;
use sprag_loops::{Method, Precision};
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::{Case, PulseShape, TIGHT};
use sprag_sim::batch::lanes::results;
use sprag_sim::batch::table::CASE_COLUMNS;
use sprag_sim::interrupt::Interrupt;

mod figure08;

use figure08::{cells, fastest};

const PASSES: usize = 9;

/// The cells as a file.
fn write(cases: &[Case], path: &Path) {
    let mut text = format!("{CASE_COLUMNS}\n");
    for (id, case) in cases.iter().enumerate() {
        let geometry = if case.geometry == Geometry::Full { "full" } else { "slender" };
        let device = match case.device {
            DeviceKind::None => "none",
            DeviceKind::Inerter => "inerter",
            DeviceKind::ClutchedPair => "clutched-pair",
        };
        let pulse = if case.pulse == PulseShape::Sine { "sine" } else { "cosine" };
        let Case { mass_ratio, restitution, frequency_ratio, amplitude_ratio, free_time, .. } = *case;
        let degrees = case.slenderness.to_degrees();
        let _ = writeln!(
            text,
            "{id},{geometry},{degrees:?},{device},{mass_ratio:?},{restitution:?},{pulse},{frequency_ratio:?},{amplitude_ratio:?},{free_time:?}"
        );
    }
    std::fs::write(path, text).expect("a file of cases");
}

/// The least time of the command over `cases`, s.
fn batch(cases: &[Case], threads: u16) -> f64 {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, out) = (folder.path().join("cases.csv"), folder.path().join("results.csv"));
    write(cases, &path);
    let arguments = BatchArguments {
        cases: path,
        out,
        replace: OverwriteArguments { overwrite: true },
        threads: ThreadArguments { threads: Some(threads) },
        tolerance: TIGHT,
        accuracy: AccuracyArguments::default(),
    };
    fastest(PASSES, || {
        let (mut out, mut errors, interrupt) = (Vec::new(), Vec::new(), Interrupt::default());
        let code = Context { out: &mut out, err: &mut errors, interrupt: &interrupt, quiet: true }.run(&arguments);
        assert_eq!(code, 0, "{}", String::from_utf8_lossy(&errors));
    })
}

fn main() {
    println!("rows a second on one thread; in brackets times the core's own speed");
    println!("{:8} {:14} {:>20} {:>20} {:>20} {:>9}", "geometry", "device", "batch", "without text", "map's lanes", "core");
    let mut all = Vec::new();
    for geometry in [Geometry::Full, Geometry::Slender] {
        let mut of_geometry = Vec::new();
        for device in DeviceKind::ALL {
            let cases = cells(geometry, device);
            row(&format!("{geometry:?}"), &format!("{device:?}"), &cases);
            of_geometry.extend(cases);
        }
        row(&format!("{geometry:?}"), "all", &of_geometry);
        all.extend(of_geometry);
    }
    // Neighbours of all kinds: a step that has no divisor in common with their number.
    let mixed: Vec<Case> = (0..all.len()).map(|index| all[index * 7919 % all.len()]).collect();
    row("both", "mixed", &mixed);
    let many: Vec<Case> = (0..4).flat_map(|_| mixed.iter().copied()).collect();
    println!("\ntwo threads against one: {:.2} times as fast", batch(&many, 1) / batch(&many, 2));
}

fn row(geometry: &str, device: &str, cases: &[Case]) {
    // The lanes of a map take blocks of one kind.
    let mut sorted = cases.to_vec();
    sorted.sort_by_key(|case| (case.geometry == Geometry::Full, case.device as u8));
    let pulsed: Vec<PulsedBlock> = sorted.iter().map(PulsedBlock::from).collect();
    let method = f64::ideal(Method::Adaptive(TIGHT));
    let core = fastest(3, || cases.iter().for_each(|case| _ = black_box(case.run(&*method))));
    let seconds = [
        batch(cases, 1),
        fastest(PASSES, || drop(black_box(results(cases, TIGHT)))),
        fastest(PASSES, || drop(black_box(run(&pulsed, Registers::Widest)))),
    ];
    let [with_text, without, map] = seconds.map(|seconds| format!("{:.0} ({:.1})", cases.len() as f64 / seconds, core / seconds));
    let core = cases.len() as f64 / core;
    println!("{geometry:8} {device:14} {with_text:>20} {without:>20} {map:>20} {core:9.0}");
}
