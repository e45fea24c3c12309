//! Studies under recorded motions.

mod cloud;
mod optimise;
