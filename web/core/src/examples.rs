//! The shipped scenes that a page can follow.

use sprag_sim::synthesis::NearFaultMotion;

use crate::scene::{File, PageError};

/// A shipped scene.
pub struct Example {
    /// Name of its file, without the ending.
    pub name: &'static str,
    /// TOML.
    pub text: &'static str,
}

macro_rules! examples {
    ($($name:literal),* $(,)?) => {
        /// All of them, in the order in which a page shows them.
        pub const EXAMPLES: &[Example] = &[
            $(Example { name: $name, text: include_str!(concat!("../../../scenes/", $name, ".toml")) },)*
        ];
    };
}

examples!(
    "near_fault",
    "figure10",
    "figure05",
    "figure06",
    "figure07",
    "figure09",
    "free_rocking",
    "statue",
    "figure08",
    "figure11",
    "figure12",
    "figure13",
    "controller",
);

/// The record that some of them name: the bytes of `scenes/near_fault.csv`, made anew because they are many.
///
/// # Errors
/// None in practice.
pub fn near_fault() -> Result<File, PageError> {
    let text = NearFaultMotion::DEFAULT.csv().map_err(PageError::failed)?;
    Ok(File { name: "near_fault.csv".to_owned(), bytes: text.into_bytes() })
}
