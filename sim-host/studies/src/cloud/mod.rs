//! Cloud and multi-stripe analyses: many records by structures by devices (Thiers-Moggia and Málaga-Chuquitaype 2019, Section 6).
//!
//! - [`study_file`], [`study`], [`structures`]: what a study asks for; [`records`]: its ground motions; [`record_name`]: what
//!   they are called; [`measure`]: how intense they are.
//! - [`runs`]: what the blocks do; [`run_rows`]: kept row by row.
//! - [`demand`], [`comparison`], [`overturning`], [`ranking`], [`findings`]: what the runs say.
//! - [`typed_tables`], [`pages`], [`figures`]: tables and pictures of it.

pub mod comparison;
pub mod demand;
pub mod figures;
pub mod findings;
pub mod folder;
pub mod measure;
pub mod overturning;
pub mod pages;
pub mod ranking;
pub mod record_name;
pub mod records;
pub mod run_rows;
pub mod runs;
pub mod structures;
pub mod study;
pub mod study_file;
pub mod typed_tables;

#[cfg(test)]
mod tests;
