//! A block without a device whose base may slide: a free body under forces at its two corners, of which none may pull and none leaves the
//! cone of friction. Which corners touch, stick and slide is found by trying every combination.

mod body;
mod impact;
mod mode;
mod run;

pub use run::{SlidingRun, run};
