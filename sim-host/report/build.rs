//! Writes the widths of the font's characters as a table: the font itself is a hundred times as large.

use std::fmt::Write as _;
use std::path::Path;

use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Both are of this build alone, so that nothing but a broken package of the font ends it here.
    let font = FontRef::new(dejavu::sans::regular()).expect("the font can be read");
    let metrics = font.glyph_metrics(Size::unscaled(), LocationRef::default());
    let width = |(character, glyph)| Some((u16::try_from(character).ok()?, metrics.advance_width(glyph)?));
    let mut widths: Vec<(u16, f32)> = font.charmap().mappings().filter_map(width).collect();
    widths.sort_by_key(|(character, _)| *character);
    let mut table = format!(
        "/// Units of a font size of 1.\nconst UNITS: f32 = {}_f32;\n",
        font.metrics(Size::unscaled(), LocationRef::default()).units_per_em
    );
    _ = writeln!(
        table,
        "/// Characters of the basic plane and their widths, in units.\nstatic WIDTHS: [(u16, u16); {}] = [",
        widths.len()
    );
    for (character, width) in widths {
        _ = write!(table, "({character},{width}),");
    }
    table.push_str("];\n");
    let folder = std::env::var_os("OUT_DIR").expect("cargo gives a folder");
    std::fs::write(Path::new(&folder).join("widths.rs"), table).expect("cargo's folder can be written to");
}
