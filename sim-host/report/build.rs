//! Writes the widths of the font's characters as a table: the font itself is a hundred times as large.

use std::fmt::Write as _;
use std::path::Path;

use ttf_parser::Face;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Both are of this build alone, so that nothing but a broken package of the font ends it here.
    let font = Face::parse(dejavu::sans::regular(), 0).expect("the font can be read");
    let width = |character: u16| {
        // Glyph 0 is drawn for characters that the font lacks.
        let glyph = font.glyph_index(char::from_u32(character.into())?).filter(|glyph| glyph.0 > 0)?;
        Some((character, font.glyph_hor_advance(glyph)?))
    };
    let widths: Vec<(u16, u16)> = (0..=u16::MAX).filter_map(width).collect();
    let mut table = format!("/// Units of a font size of 1.\nconst UNITS: f32 = {}_f32;\n", font.units_per_em());
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
