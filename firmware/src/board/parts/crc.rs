//! The unit for CRC-32 that both chips have at the same address, with the same registers (RM0090, section 4; RM0440, CRC, as it is after a
//! reset): polynomial 0x04C1_1DB7, from the most significant bit of each word on, beginning with all ones.

/// Data, and control.
const DR: *mut u32 = 0x4002_3000 as *mut u32;
const CR: *mut u32 = 0x4002_3008 as *mut u32;

/// As [`crate::board::Board::crc`], by the unit, whose clock is on.
pub fn crc(before: u32, words: &[u32]) -> u32 {
    let Some((first, others)) = words.split_first() else { return before };
    // SAFETY: the unit is there, and only one task asks it at a time.
    unsafe {
        CR.write_volatile(1);
        // It begins with all ones, and what it has is added to what comes.
        DR.write_volatile(first ^ !before);
        for word in others {
            DR.write_volatile(*word);
        }
        DR.read_volatile()
    }
}
