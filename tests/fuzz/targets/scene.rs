//! Text of any kind as a scene: parsing may fail with one line, but never panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sprag_sim::scene::Scene;

fuzz_target!(|text: &str| {
    if let Err(error) = Scene::parse(text, "scene.toml") {
        assert!(!error.to_string().contains('\n'), "an error of several lines: {error}");
    }
});
