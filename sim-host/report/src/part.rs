//! Parts that the program may be built without.

/// A part that only some commands need, and that takes long to build: a feature of the package.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    feature: &'static str,
    is_built: bool,
}

impl Part {
    /// Tables as Parquet.
    pub const PARQUET: Part = Part { feature: "parquet", is_built: cfg!(feature = "parquet") };
    /// Pictures as PNG.
    pub const PNG: Part = Part { feature: "png", is_built: cfg!(feature = "png") };

    /// The part that `feature` of the program's package stands for.
    pub const fn new(feature: &'static str, is_built: bool) -> Part {
        Part { feature, is_built }
    }

    /// Whether the program was built with it.
    pub const fn is_built(self) -> bool {
        self.is_built
    }

    /// `value`, which needs this part.
    ///
    /// # Errors
    /// [`Missing`] where the program was built without it.
    pub fn allow<T>(self, value: T) -> Result<T, Missing> {
        if self.is_built { Ok(value) } else { Err(Missing(self)) }
    }
}

/// A part that the program was built without.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this program was built without {name}: build it with `--features {name}`", name = .0.feature)]
pub struct Missing(pub Part);
