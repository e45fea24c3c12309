//! The hard cases of the target, in the emulator: the emulated Cortex-M4F ends each as the host does, with the same bits on the way.
//!
//! Needs `qemu-system-arm` and the firmware for the board, named by `SPRAG_EMULATED_CORE_ELF` (`cargo xtask test` does both).

use sprag_stability::target_cases::target_cases;

use super::emulator::compare;

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn the_hard_cases_are_the_same_on_the_board() {
    for target in target_cases() {
        assert_eq!(compare(target.name, &target.case), target.outcome, "{}", target.name);
    }
}
