//! Compares this program with a `sprag` binary on random scenes, or on given ones:
//!
//! - `compare SPRAG COUNT SEED KEEP` compares scenes 0 up to COUNT of SEED with both of Sprag's methods, and keeps those that
//!   differ in the folder KEEP; with `METHOD` in the environment (`taylor` or `runge-kutta-4`) with that alone.
//! - `compare SPRAG SCENE.toml…` reports each scene; with `EVENTS` or `HISTORY` in the environment it lists those of this
//!   program, `RESOLUTION` changes its steps.

mod many;
mod single;
mod sprag;

use std::path::Path;

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [sprag, rest @ ..] = arguments.as_slice() else { return Err("compare SPRAG COUNT SEED KEEP".to_owned()) };
    let sprag = Path::new(sprag);
    match rest {
        [count, seed, keep] if count.parse::<u64>().is_ok() => {
            let number = |text: &String| text.parse::<u64>().map_err(|error| format!("{text}: {error}"));
            many::compare(sprag, number(count)?, number(seed)?, Path::new(keep))
        }
        scenes => scenes.iter().try_for_each(|path| single::compare(sprag, Path::new(path))),
    }
}
