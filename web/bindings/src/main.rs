//! Writes the JavaScript, the types and the final WebAssembly of the page's core: `sprag-page-bindings MODULE.wasm FOLDER`.

use anyhow::Context as _;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> anyhow::Result<()> {
    let mut words = std::env::args().skip(1);
    let (module, folder) = words.next().zip(words.next()).context("usage: sprag-page-bindings MODULE.wasm FOLDER")?;
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).web(true)?.typescript(true).remove_name_section(true).remove_producers_section(true);
    bindgen.generate(folder)
}
