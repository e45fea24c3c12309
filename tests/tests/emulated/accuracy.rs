//! What accuracy costs on the target: how the instructions of a step must relate to each other, whatever they are.
//!
//! Needs `qemu-system-arm` and the image named by `SPRAG_EMULATED_CORE_ELF` (`cargo xtask test` does both).

use std::collections::BTreeMap;

use sprag_tests::emulation::{emulate, firmware, kernels};

const METHODS: [&str; 2] = ["euler", "rk4"];
const DEVICES: [&str; 2] = ["none", "clutched-pair"];

/// The instructions of a step, by the parts of its name.
struct Steps<'a>(BTreeMap<&'a str, u32>);

impl Steps<'_> {
    fn named(&self, name: &str) -> u32 {
        *self.0.get(name).unwrap_or_else(|| panic!("no kernel {name}"))
    }

    fn step_end(&self, method: &str, precision: &str, tier: &str, geometry: &str, device: &str) -> u32 {
        self.named(&format!("step-{method}-step-end-{precision}-{tier}-{geometry}-{device}"))
    }

    fn located(&self, method: &str, geometry: &str, device: &str) -> u32 {
        self.named(&format!("step-{method}-located-f32-own-polynomial-{geometry}-{device}"))
    }
}

fn with_steps(judge: impl FnOnce(&Steps<'_>)) {
    let elf = firmware();
    let folder = tempfile::tempdir().unwrap();
    let lines = emulate(&elf, folder.path(), None);
    lines.lines().filter(|line| line.starts_with("kernel step-")).for_each(|line| println!("{line}"));
    judge(&Steps(kernels(&lines)));
}

/// The polynomial has no floor to take and gives sine and cosine at once, so it costs no more than micromath's parabola, and
/// libm works in double precision, which this core does in software.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn tiers_of_the_sine() {
    with_steps(|steps| {
        for method in METHODS {
            for device in DEVICES {
                let [own, micromath, libm] =
                    ["own-polynomial", "micromath", "libm"].map(|tier| steps.step_end(method, "f32", tier, "full", device));
                assert!(own <= micromath && 10 * micromath < libm, "{method} {device}: {own} {micromath} {libm}");
                let [own, libm] = ["own-polynomial", "libm"].map(|tier| steps.step_end(method, "f64", tier, "full", device));
                assert!(own < libm, "{method} {device} in f64: {own} {libm}");
            }
        }
        let slender =
            ["own-polynomial", "micromath", "libm"].map(|tier| steps.step_end("rk4", "f32", tier, "slender", "clutched-pair"));
        assert!(slender.iter().all(|cost| cost.abs_diff(slender[0]) <= 8), "no sine in the slender model: {slender:?}");
    });
}

/// A number of the core's own tier is the plain number, and costs what that costs.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_tier_as_a_type_is_free() {
    with_steps(|steps| {
        for (plain, method) in [("rk4-full-clutched-pair", "rk4"), ("euler-full-clutched-pair", "euler")] {
            let tiered = steps.step_end(method, "f32", "own-polynomial", "full", "clutched-pair");
            assert!(tiered.abs_diff(steps.named(plain)) <= 4, "{plain}: {tiered}");
        }
    });
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn double_precision_is_in_software() {
    with_steps(|steps| {
        for device in DEVICES {
            for method in METHODS {
                for (tier, times) in [("own-polynomial", 20), ("libm", 1)] {
                    let [single, double] =
                        ["f32", "f64"].map(|precision| steps.step_end(method, precision, tier, "full", device));
                    assert!(double > times * single, "{method} {tier} {device}: {single} {double}");
                }
            }
        }
    });
}

/// Looking at step ends is cheaper than locating, a device costs something, a line less than a sine, and a method of higher order more.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn events_devices_geometries_and_methods() {
    with_steps(|steps| {
        for method in METHODS {
            for geometry in ["full", "slender"] {
                for device in DEVICES {
                    let looked_at = steps.step_end(method, "f32", "own-polynomial", geometry, device);
                    let located = steps.located(method, geometry, device);
                    assert!(looked_at <= located, "{method} {geometry} {device}: {looked_at} {located}");
                }
            }
            let [none, pair] = DEVICES.map(|device| steps.step_end(method, "f32", "own-polynomial", "full", device));
            assert!(none < pair, "{method}: {none} {pair}");
        }
        for device in ["none", "inerter", "clutched-pair"] {
            for geometry in ["full", "slender"] {
                let costs = ["euler", "rk4", "taylor12"].map(|method| steps.located(method, geometry, device));
                assert!(costs.is_sorted(), "{geometry} {device}: {costs:?}");
            }
            for method in ["euler", "rk4", "taylor12"] {
                let [slender, full] = ["slender", "full"].map(|geometry| steps.located(method, geometry, device));
                assert!(slender < full, "{method} {device}: {slender} {full}");
            }
        }
    });
}

/// The exact motion costs less than two approximate steps, and less than its own series.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn the_closed_form_is_cheap() {
    with_steps(|steps| {
        for device in DEVICES {
            let [closed, rk4, series] = ["closed-form", "rk4", "taylor12"].map(|method| steps.located(method, "slender", device));
            assert!(closed < 2 * rk4 && closed < series, "{device}: {closed} {rk4} {series}");
        }
    });
}
