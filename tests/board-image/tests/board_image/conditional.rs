//! Instructions that are carried out under a condition, and exceptions in between.

use sprag_board_image::bench::{Bench, Stop};
use sprag_board_image::image::Image;
use sprag_board_image::model::Model;

/// Where the program begins, such that a page of the memory ends within its IT block: only there can an exception come in between.
const BEGIN: u32 = 0x0801_0FDE;
const PROGRAM: [u16; 20] = [
    // r2 = 0x2000_0000, r3 = 0xE000_E010, SysTick every 98 cycles, r1 = 1.
    0x2220, 0x0612, 0x23E0, 0x061B, 0x24E0, 0x0224, 0x3410, 0x191B, 0x2061, 0x6058, 0x6098, 0x2007, 0x6018, 0x2101,
    // For ever: compares r1 with itself; ITT NE: r1 = 2, r1 = 3; stores r1 at r2.
    0x4289, 0xBF1C, 0x2102, 0x2103, 0x6011, 0xE7F9,
];

/// SysTick's handler: adds 1 to the word at r2 + 4.
const HANDLER: u32 = 0x0801_1100;
const HANDLERS_PROGRAM: [u16; 4] = [0x6850, 0x1C40, 0x6050, 0x4770];

/// ARMv7-M, B1.5.6 and B1.5.8: a handler begins outside of any IT block, and its return continues within the one that it came in.
#[test]
fn an_exception_in_an_it_block_is_not_under_its_condition_and_leaves_it() {
    let mut vectors = [0_u32; 16];
    (vectors[0], vectors[1], vectors[15]) = (0x2002_0000, BEGIN | 1, HANDLER | 1);
    let bytes = |program: &[u16]| program.iter().flat_map(|half| half.to_le_bytes()).collect();
    let table = vectors.iter().flat_map(|word| word.to_le_bytes()).collect();
    let segments = vec![(0x0800_0000, table), (BEGIN, bytes(&PROGRAM)), (HANDLER, bytes(&HANDLERS_PROGRAM))];
    let mut bench = Bench::new(&Image { segments, model: Model::F405 });
    // Memory comes up with anything in it.
    bench.chip().ram.write(0x2000_0004, &[0; 4]);
    for ticks in 1..=500 {
        assert_eq!(bench.run(u64::MAX), Stop::Tick);
        let word = |address: u32| bench.chip().ram.word(address);
        assert_eq!(word(0x2000_0004), ticks);
        assert!(word(0x2000_0000) <= 1, "at tick {ticks}");
    }
}
