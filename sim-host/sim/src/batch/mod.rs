//! Many independent cases, one a row.

pub mod case;
pub mod lanes;
pub mod table;
