//! Columns of results, which JavaScript takes as typed arrays.

use js_sys::{Float64Array, Object, Reflect, Uint8Array, Uint16Array};
use wasm_bindgen::JsValue;

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

/// A JavaScript object whose properties are `columns`; numbers are copied once.
pub fn object(columns: &Columns) -> JsValue {
    let object = Object::new();
    for (name, column) in columns {
        // A new object takes any property.
        let _ = Reflect::set(&object, &JsValue::from_str(name), &value(column));
    }
    object.into()
}

fn value(column: &Column) -> JsValue {
    match column {
        Column::Numbers(values) => Float64Array::from(&values[..]).into(),
        Column::Codes(values) => Uint8Array::from(&values[..]).into(),
        Column::LongCodes(values) => Uint16Array::from(&values[..]).into(),
        Column::Text(text) => JsValue::from_str(text),
        Column::Texts(texts) => texts.iter().map(|text| JsValue::from_str(text)).collect::<js_sys::Array>().into(),
        Column::Columns(columns) => object(columns),
        Column::Each(tables) => tables.iter().map(object).collect::<js_sys::Array>().into(),
    }
}
