//! Where Thumb instructions of a Cortex-M4 lead: just enough of the decoder to see every way out of a function.

/// The stack pointer.
const SP: u16 = 13;

/// The link register.
const LR: u16 = 14;

/// The program counter.
const PC: u16 = 15;

/// A way in which an instruction leaves the straight line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// A call of an address that the instruction holds.
    Call(u64),
    /// A jump to an address that the instruction holds.
    Jump(u64),
    /// A call or a jump to an address that only the running program knows; returns are not among them.
    Unknown(&'static str),
}

/// Every way out of a run of instructions that starts at an address, with the address of the instruction.
pub fn flows(code: &[u8], start: u64) -> Vec<(u64, Flow)> {
    let halves: Vec<u16> = code.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]])).collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < halves.len() {
        let address = start + 2 * at as u64;
        let wide = halves[at] >> 11 >= 0b11101;
        let flow = match halves.get(at + 1) {
            Some(second) if wide => wide_flow(halves[at], *second, address),
            None if wide => Some(Flow::Unknown("half an instruction")),
            _ => narrow_flow(halves[at], address),
        };
        found.extend(flow.map(|flow| (address, flow)));
        at += if wide { 2 } else { 1 };
    }
    found
}

/// What an instruction of 16 bits does. The comparing branches cannot leave a function and are left out.
fn narrow_flow(half: u16, address: u64) -> Option<Flow> {
    let source = half >> 3 & 15;
    let destination = half >> 4 & 8 | half & 7;
    match half {
        _ if half & 0xff87 == 0x4780 => Some(Flow::Unknown("blx")),
        _ if half & 0xff87 == 0x4700 && source != LR => Some(Flow::Unknown("bx")),
        _ if half & 0xff00 == 0x4600 && destination == PC && source != LR => Some(Flow::Unknown("mov pc")),
        _ if half & 0xff00 == 0x4400 && destination == PC => Some(Flow::Unknown("add pc")),
        // The last two conditions are an undefined instruction and a call of the supervisor.
        _ if half & 0xf000 == 0xd000 && half >> 8 & 15 < 14 => Some(Flow::Jump(target(address, u32::from(half & 0xff) << 1, 9))),
        _ if half & 0xf800 == 0xe000 => Some(Flow::Jump(target(address, u32::from(half & 0x7ff) << 1, 12))),
        _ => None,
    }
}

/// What an instruction of 32 bits does. Jumps by a table stay in their function and are left out.
fn wide_flow(first: u16, second: u16, address: u64) -> Option<Flow> {
    let base = first & 15;
    if first & 0xf800 == 0xf000 && second & 0x8000 != 0 {
        return branch(first, second, address);
    }
    // Back from a function: a single register taken off the stack.
    let pop = base == SP && second & 0x0f00 == 0x0b00;
    if first & 0xff70 == 0xf850 && second >> 12 == PC && !pop {
        return Some(Flow::Unknown("ldr pc"));
    }
    let load_many = matches!(first & 0xffd0, 0xe890 | 0xe910);
    if load_many && second & 0x8000 != 0 && base != SP {
        return Some(Flow::Unknown("ldm pc"));
    }
    None
}

fn branch(first: u16, second: u16, address: u64) -> Option<Flow> {
    let [sign, one, two] = [first >> 10 & 1, second >> 13 & 1, second >> 11 & 1].map(u32::from);
    let low = u32::from(second & 0x7ff) << 1;
    match second & 0x5000 {
        0x0000 if first >> 6 & 15 < 14 => {
            let high = sign << 20 | two << 19 | one << 18 | u32::from(first & 0x3f) << 12;
            Some(Flow::Jump(target(address, high | low, 21)))
        }
        0x0000 => None,
        0x4000 => Some(Flow::Unknown("blx to ARM code")),
        _ => {
            let [one, two] = [one, two].map(|bit| bit ^ sign ^ 1);
            let high = sign << 24 | one << 23 | two << 22 | u32::from(first & 0x3ff) << 12;
            let target = target(address, high | low, 25);
            Some(if second & 0x4000 == 0 { Flow::Jump(target) } else { Flow::Call(target) })
        }
    }
}

/// The target of a branch by so many bits, the highest of which is the sign.
fn target(address: u64, offset: u32, bits: u32) -> u64 {
    let offset = (offset << (32 - bits)).cast_signed() >> (32 - bits);
    (address + 4).wrapping_add_signed(i64::from(offset)) & 0xffff_ffff
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(halves: &[u16]) -> Vec<(u64, Flow)> {
        let code: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
        flows(&code, 0x0800_0400)
    }

    #[test]
    fn branches_lead_where_the_disassembler_says() {
        for (halves, flow) in [
            (&[0xf000, 0xf82au16][..], Flow::Call(0x0800_0458)), // bl forward
            (&[0xf7ff, 0xffdb], Flow::Call(0x0800_03ba)),        // bl backward
            (&[0xf000, 0xb82a], Flow::Jump(0x0800_0458)),        // b.w
            (&[0xf47f, 0xaffe], Flow::Jump(0x0800_0400)),        // bne.w to itself
            (&[0xe7fe], Flow::Jump(0x0800_0400)),                // b to itself
            (&[0xd0fe], Flow::Jump(0x0800_0400)),                // beq to itself
        ] {
            assert_eq!(one(halves), [(0x0800_0400, flow)], "{halves:x?}");
        }
    }

    #[test]
    fn what_only_the_running_program_knows_is_seen() {
        for (halves, name) in [
            (&[0x4798u16][..], "blx"),              // blx r3
            (&[0x4718], "bx"),                      // bx r3
            (&[0x469f], "mov pc"),                  // mov pc, r3
            (&[0x449f], "add pc"),                  // add pc, r3
            (&[0xf8df, 0xf004], "ldr pc"),          // ldr.w pc, [pc, #4]
            (&[0xf853, 0xf022], "ldr pc"),          // ldr.w pc, [r3, r2, lsl #2]
            (&[0xe893, 0x8001], "ldm pc"),          // ldm r3, {r0, pc}
            (&[0xf000, 0xe800], "blx to ARM code"), // blx 0x08000404
            (&[0xf8df], "half an instruction"),     // its second half is missing
        ] {
            assert_eq!(one(halves), [(0x0800_0400, Flow::Unknown(name))], "{halves:x?}");
        }
    }

    #[test]
    fn returns_and_straight_lines_lead_nowhere() {
        for halves in [
            &[0x4770u16][..],  // bx lr
            &[0xbd80],         // pop {r7, pc}
            &[0x46f7],         // mov pc, lr
            &[0xe8bd, 0x87f0], // pop.w {r4-r10, pc}
            &[0xf85d, 0xfb04], // ldr pc, [sp], #4
            &[0xe8df, 0xf000], // tbb [pc, r0]
            &[0xf3bf, 0x8f4f], // dsb
            &[0xf853, 0x2022], // ldr.w r2, [r3, r2, lsl #2]
            &[0xdefe],         // udf
            &[0xdf00],         // svc
        ] {
            assert_eq!(one(halves), [], "{halves:x?}");
        }
    }

    #[test]
    fn the_second_half_of_an_instruction_is_none_of_its_own() {
        // movw r7, #0x7980 holds the pattern of `blx` in its second half; a real one follows.
        assert_eq!(one(&[0xf247, 0x4798, 0x4798]), [(0x0800_0404, Flow::Unknown("blx"))]);
    }
}
