//! How accurate a result is asked to be, and how accurate it is.
//!
//! - [`level`]: the user's words for it.
//! - [`estimate`]: the error of a result, from the same motion followed more closely; [`mod@answer`]: a result with its error, made as accurate as
//!   asked; [`second_method`]: the same error, looked at by another method; [`budget`]: as accurate as a time affords.

pub mod answer;
pub mod budget;
pub mod estimate;
pub mod level;
pub mod second_method;
pub mod worst;

pub use answer::{Answer, Closeness, answer};
pub use estimate::{Compared, ErrorEstimate};
pub use level::Accuracy;
pub use worst::Worst;
