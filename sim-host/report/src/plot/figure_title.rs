//! The title of a figure, and below it what holds in all of the figure.

/// What stands above a figure.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FigureTitle {
    /// Title, in plain text.
    pub text: String,
    /// What holds in all of the figure, such as `α = 20°`, in the markup of axis titles.
    pub conditions: Vec<String>,
}

impl<T: Into<String>> From<T> for FigureTitle {
    fn from(text: T) -> FigureTitle {
        FigureTitle { text: text.into(), conditions: Vec::new() }
    }
}
