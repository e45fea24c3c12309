//! A program for the board with each way in which a function can lead to a panic, for the test of the panic check.

#![no_std]
#![no_main]

const REGISTER: *mut u32 = 0x4001_0000 as *mut u32;

static FACTORS: [f32; 4] = [1.5, 2.5, 4.0, 0.5];

static LAWS: [fn(u32) -> u32; 3] = [calm, scaled, indexed];

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {
        // SAFETY: nobody runs this.
        unsafe { REGISTER.write_volatile(1) };
    }
}

trait Law {
    fn run(&self, x: u32) -> u32;
}

struct Safe(u32);

impl Law for Safe {
    fn run(&self, x: u32) -> u32 {
        x.rotate_left(self.0)
    }
}

struct Unsafe(u32);

impl Law for Unsafe {
    fn run(&self, x: u32) -> u32 {
        [5u32, 2, 3][(x ^ (self.0 >> 3)) as usize]
    }
}

#[inline(never)]
fn scaled(x: u32) -> u32 {
    // The lengths come from a table without a name.
    let name = match x & 7 {
        0 => "zero",
        1 => "one",
        2 => "two and more",
        _ => "many",
    };
    (x as f32 * FACTORS[(x & 3) as usize]) as u32 + name.len() as u32
}

#[inline(never)]
fn calm(x: u32) -> u32 {
    scaled(x).wrapping_mul(3) ^ x
}

#[inline(never)]
fn indexed(x: u32) -> u32 {
    FACTORS[x as usize] as u32
}

#[inline(never)]
fn two_hops(x: u32) -> u32 {
    indexed(x) ^ x
}

#[inline(never)]
fn sliced(x: u32) -> u32 {
    FACTORS[x as usize..].len() as u32 ^ x
}

#[inline(never)]
fn dispatched(law: &dyn Law, x: u32) -> u32 {
    law.run(x) ^ 1
}

#[inline(never)]
fn by_virtual_call(x: u32) -> u32 {
    let (safe, other) = (Safe(x), Unsafe(x));
    let law: &dyn Law = if x & 1 == 0 { &safe } else { &other };
    dispatched(law, x)
}

#[inline(never)]
fn by_table(x: u32) -> u32 {
    LAWS[(x % 3) as usize](x)
}

#[unsafe(no_mangle)]
extern "C" fn start() -> ! {
    loop {
        // SAFETY: nobody runs this.
        let x = unsafe { REGISTER.read_volatile() };
        for law in [calm, two_hops, sliced, by_virtual_call, by_table] {
            let y = law(x);
            // SAFETY: nobody runs this.
            unsafe { REGISTER.write_volatile(y) };
        }
    }
}
