//! Columns of results, which JavaScript takes as typed arrays.

/// Values of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Numbers.
    Numbers(Vec<f64>),
    /// Codes below 256.
    Codes(Vec<u8>),
    /// Codes below 65,536.
    LongCodes(Vec<u16>),
    /// A text, as it is or as JSON.
    Text(String),
    /// Texts.
    Texts(Vec<String>),
    /// Columns of their own.
    Columns(Columns),
    /// A table for each of many.
    Each(Vec<Columns>),
}

/// Columns by their names.
pub type Columns = Vec<(&'static str, Column)>;
