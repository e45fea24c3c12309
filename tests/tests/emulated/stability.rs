//! The hard cases of the target, in the emulator: the emulated Cortex-M4F ends each as the host does, with the same bits on the way.
//!
//! Needs `qemu-system-arm` and the firmware for the board, named by `SPRAG_EMULATED_CORE_ELF` (`cargo xtask test` does both).

use std::collections::BTreeMap;

use sprag_shared::observers::digest::Digest;
use sprag_stability::target_cases::target_cases;
use sprag_tests::emulation::{emulate, firmware};

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn the_hard_cases_are_the_same_on_the_board() {
    let elf = firmware();
    for target in target_cases() {
        let mut words = vec![0; 1024];
        let count = target.case.encode(&mut words).expect("few words");
        words.truncate(count);
        let mut digest = Digest::default();
        let end = sprag_case::run(&words, &mut digest).unwrap_or_else(|error| panic!("{}: {error}", target.name));
        let folder = tempfile::tempdir().expect("a folder");
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(folder.path().join("case.bin"), bytes).expect("a file");
        let lines = emulate(&elf, folder.path(), Some("case.bin"));
        let board: BTreeMap<&str, &str> = lines.lines().filter_map(|line| line.split_once(' ')).collect();
        for (key, value) in [
            ("outcome", end.outcome.name().to_owned()),
            ("impacts", end.state.impacts.to_string()),
            ("peak_rotation_rad", end.peaks.rotation.to_string()),
            ("stretches", digest.stretches.to_string()),
            ("events", digest.events.to_string()),
            ("steps", end.steps.to_string()),
            ("digest", format!("{:016x}", digest.hash())),
        ] {
            assert_eq!(board.get(key), Some(&value.as_str()), "{}: {key} on the board and on the host; {lines}", target.name);
        }
        assert_eq!(end.outcome, target.outcome, "{}", target.name);
        println!("{}: {} digest {:016x} instructions {}", target.name, end.outcome.name(), digest.hash(), board["instructions"]);
    }
}
