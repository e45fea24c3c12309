//! What JavaScript calls. Failures are exceptions of one line.

use std::fmt::Display;

use js_sys::{Float64Array, Function, Uint8Array};
use serde::Serialize;
use wasm_bindgen::prelude::*;

use crate::about::{self, About};
use crate::examples::{EXAMPLES, near_fault};
use crate::object::object;
use crate::scene::{File, PageScene};
use crate::{closed_loop, digests, map, run};

fn raise(error: impl Display) -> JsError {
    JsError::new(&error.to_string())
}

fn json(value: &impl Serialize) -> Result<String, JsError> {
    serde_json::to_string(value).map_err(raise)
}

/// Rows of results from the module of the lanes.
fn call(lanes: &Function, rows: &[f64]) -> Result<Vec<f64>, String> {
    let found = lanes.call1(&JsValue::NULL, &Float64Array::from(rows)).and_then(|found| found.dyn_into::<Float64Array>());
    found.map(|rows| rows.to_vec()).map_err(|error| format!("the lanes failed: {error:?}"))
}

/// Version of Sprag.
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// Names and texts of the shipped scenes, as JSON.
///
/// # Errors
/// None in practice.
#[wasm_bindgen]
pub fn examples() -> Result<String, JsError> {
    json(&EXAMPLES.iter().map(|example| (example.name, example.text)).collect::<Vec<_>>())
}

/// The record that shipped scenes name `near_fault.csv`.
///
/// # Errors
/// None in practice.
#[wasm_bindgen]
pub fn near_fault_csv() -> Result<Vec<u8>, JsError> {
    Ok(near_fault().map_err(raise)?.bytes)
}

/// What a record says of itself, as JSON.
///
/// # Errors
/// For a file that is no record.
#[wasm_bindgen]
pub fn record(name: String, bytes: Vec<u8>, units: Option<String>, time_step_s: Option<f64>) -> Result<String, JsError> {
    json(&about::record(&File { name, bytes }, units.as_deref(), time_step_s).map_err(raise)?)
}

/// The parts that can fail in a closed loop.
#[wasm_bindgen]
pub fn faults() -> Vec<String> {
    closed_loop::faults()
}

/// Digests of shipped scenes, computed and expected, as JSON.
///
/// # Errors
/// For a scene that cannot be run.
#[wasm_bindgen(js_name = digests)]
pub fn all_digests() -> Result<String, JsError> {
    json(&digests::digests().map_err(raise)?)
}

/// A scene with its records.
#[wasm_bindgen(js_name = Scene)]
pub struct JsScene(PageScene);

#[wasm_bindgen(js_class = Scene)]
impl JsScene {
    /// Of a TOML text; `names` and `contents` are its record files.
    ///
    /// # Errors
    /// For a scene or a record that cannot be read.
    #[wasm_bindgen(constructor)]
    pub fn new(text: &str, names: Vec<String>, contents: Vec<Uint8Array>) -> Result<JsScene, JsError> {
        let files: Vec<File> =
            names.into_iter().zip(contents).map(|(name, bytes)| File { name, bytes: bytes.to_vec() }).collect();
        PageScene::new(text, &files).map(JsScene).map_err(raise)
    }

    /// What it says of itself, as JSON.
    ///
    /// # Errors
    /// None in practice.
    pub fn about(&self) -> Result<String, JsError> {
        json(&About::of(&self.0.scene))
    }

    /// Its numeric keys, as JSON.
    ///
    /// # Errors
    /// None in practice.
    pub fn keys(&self) -> Result<String, JsError> {
        json(&about::keys(&self.0.scene))
    }

    /// Its text with changes `KEY=VALUE`.
    ///
    /// # Errors
    /// For a key or a value that does not exist.
    pub fn set(&self, settings: Vec<String>) -> Result<String, JsError> {
        self.0.set(&settings).map_err(raise)
    }

    /// The responses of its devices.
    ///
    /// # Errors
    /// For a motion that cannot be followed.
    pub fn simulate(&self) -> Result<JsValue, JsError> {
        Ok(object(&run::run(&self.0.scene).map_err(raise)?))
    }

    /// Axes and devices of its map.
    ///
    /// # Errors
    /// Without axes, or with values outside their ranges.
    pub fn map(&self) -> Result<JsValue, JsError> {
        Ok(object(&map::about(self.0.grid().map_err(raise)?)))
    }

    /// What becomes of a device in cells of its map; `lanes` is `pulses` of the module of the lanes.
    ///
    /// # Errors
    /// For a cell that cannot be followed.
    pub fn cells(&self, device: usize, cells: &[u32], lanes: &Function) -> Result<JsValue, JsError> {
        Ok(object(&map::cells(self.0.grid().map_err(raise)?, device, cells, &|rows| call(lanes, rows)).map_err(raise)?))
    }

    /// Boundaries between the outcomes of its map.
    ///
    /// # Errors
    /// For outcomes that are not those of the whole map.
    pub fn boundaries(&self, device: usize, outcome: &[u8], lanes: &Function) -> Result<JsValue, JsError> {
        Ok(object(&map::boundaries(self.0.grid().map_err(raise)?, device, outcome, &|rows| call(lanes, rows)).map_err(raise)?))
    }

    /// The text of a cell's scene.
    ///
    /// # Errors
    /// Without axes.
    pub fn cell(&self, column: usize, row: usize) -> Result<String, JsError> {
        self.0.cell(column, row).map_err(raise)
    }

    /// Its controller in closed loop; each of `faults` begins at its time of `at`, s.
    ///
    /// # Errors
    /// For a scene without a pair that takes commands.
    pub fn closed_loop(&self, faults: Vec<String>, at: Vec<f64>) -> Result<JsValue, JsError> {
        let faults: Vec<(String, f64)> = faults.into_iter().zip(at).collect();
        Ok(object(&closed_loop::closed_loop(&self.0.scene, &faults).map_err(raise)?))
    }
}
