//! The shipped scenes that a page can follow.

use crate::scene::File;

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

/// The record that some of them name.
pub fn near_fault() -> File {
    File { name: "near_fault.csv".to_owned(), bytes: include_bytes!("../../../scenes/near_fault.csv").to_vec() }
}
