//! The device that overturns a structure least, under limits on its force and stroke.
//!
//! - [`table`], [`law`], [`setting`], [`mount`], [`curve`]: which devices there are to choose from; [`limit`]: what they may ask for.
//! - [`motion`], [`pulse`], [`specimen`], [`subject`], [`response`], [`problem`]: what each does under each motion, and what scatters;
//!   [`objective`]: what is made small.
//! - [`design`], [`search`]: devices and what they come to, on a grid of mass ratios and where it matters in between; [`tried`]: those of an
//!   interrupted search.
//! - [`choice`], [`findings`]: which is best, and at what price; [`ranking`]: how sure that is; [`delay`]: how late its clutches may be.
//! - [`typed_tables`], [`page`], [`choice_page`], [`figure`]: tables and pictures of it.

pub mod choice;
pub mod choice_page;
pub mod curve;
pub mod delay;
pub mod design;
pub mod figure;
pub mod findings;
pub mod law;
pub mod limit;
pub mod motion;
pub mod mount;
mod notes;
pub mod objective;
pub mod page;
pub mod problem;
pub mod pulse;
pub mod ranking;
pub mod response;
pub mod search;
pub mod setting;
pub mod specimen;
pub mod subject;
pub mod table;
pub mod tried;
pub mod typed_tables;
mod verdict;

#[cfg(test)]
mod tests;
