//! Columns as objects of JavaScript.

use js_sys::{Float64Array, Object, Reflect, Uint8Array, Uint16Array};
use wasm_bindgen::JsValue;

use crate::columns::{Column, Columns};

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
