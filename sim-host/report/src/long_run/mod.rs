//! Work of many rows: in shards, interrupted and resumed, always to the same bytes.
//!
//! - [`shard`]: which rows are this process's; [`in_order`]: rows worked out on many threads, written one after another.
//! - [`origin`]: what makes rows what they are, so that only rows of one origin are put together.
//! - [`rows`]: the file that grows, and what is done of it; [`row_fields`]: what a row of it says; [`start`]: how it begins.
//! - [`division`]: a run that is planned in parts for many machines, and the files of the parts.

pub mod division;
pub mod error;
pub mod in_order;
pub mod origin;
pub mod row_fields;
pub mod rows;
pub mod shard;
pub mod start;

#[cfg(test)]
mod tests;
