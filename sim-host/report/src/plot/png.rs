//! Figures as PNG, drawn from their SVG with a font of our own, so that a machine without fonts makes the same picture.

use std::collections::BTreeSet;
use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{self, Group, Node, Options, Tree};

/// Dots for a pixel of the SVG: 288 dots an inch in the size that the SVG has on paper, and 350 when a figure of 760 px is as wide as the
/// text of a page (165 mm).
const SCALE: f32 = 3.0;

/// Dots a metre at 96 pixels of the SVG an inch.
const DOTS_PER_METRE: u32 = 11_339;

/// A picture of dots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Png {
    /// The file.
    pub bytes: Vec<u8>,
    /// Characters that the font does not have: empty boxes in the picture.
    pub missing: BTreeSet<char>,
}

/// Why a figure could not be drawn as PNG.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// The SVG cannot be read.
    #[error("the SVG cannot be read: {0}")]
    Svg(#[from] usvg::Error),
    /// No picture has this size.
    #[error("a picture of {width} x {height} dots cannot be drawn")]
    Size {
        /// Dots across.
        width: u32,
        /// Dots down.
        height: u32,
    },
    /// The dots cannot be written as a file.
    #[error("the dots cannot be written: {0}")]
    Encoding(#[from] png::EncodingError),
}

/// Draws the figure `svg` with three dots a pixel, on white. The same figure is the same bytes.
pub fn png(svg: &str) -> Result<Png, PngError> {
    let tree = tree(svg)?;
    let dots = |length: f32| (length * SCALE).round() as u32;
    let (width, height) = (dots(tree.size().width()), dots(tree.size().height()));
    let mut dots = Pixmap::new(width, height).ok_or(PngError::Size { width, height })?;
    dots.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut dots.as_mut());
    let mut missing = BTreeSet::new();
    collect_missing(tree.root(), &mut missing);
    Ok(Png { bytes: encoded(&dots)?, missing })
}

/// `svg` with its texts laid out.
pub(super) fn tree(svg: &str) -> Result<Tree, usvg::Error> {
    let options = Options { fontdb: fonts(), ..Options::default() };
    Tree::from_str(svg, &options)
}

/// DejaVu Sans, upright, bold and slanted: what the widths of legends and the places of dots over symbols were made for.
fn fonts() -> Arc<Database> {
    static FONTS: LazyLock<Arc<Database>> = LazyLock::new(|| {
        let mut fonts = Database::new();
        for face in [dejavu::sans::regular(), dejavu::sans::bold(), dejavu::sans::oblique()] {
            fonts.load_font_source(Source::Binary(Arc::new(face)));
        }
        fonts.set_sans_serif_family("DejaVu Sans");
        Arc::new(fonts)
    });
    Arc::clone(&FONTS)
}

/// Adds the characters of texts in `group` that have no glyph.
fn collect_missing(group: &Group, missing: &mut BTreeSet<char>) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect_missing(group, missing),
            Node::Text(text) => {
                let glyphs = text.layouted().iter().flat_map(|span| &span.positioned_glyphs);
                // Glyph 0 stands for all that a font lacks.
                missing.extend(glyphs.filter(|glyph| glyph.id.0 == 0).flat_map(|glyph| glyph.text.chars()));
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}

/// The dots, all of which are opaque, as a file that says how large it is on paper.
fn encoded(dots: &Pixmap) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, dots.width(), dots.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let unit = png::Unit::Meter;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: DOTS_PER_METRE, yppu: DOTS_PER_METRE, unit }));
    let mut writer = encoder.write_header()?;
    let mut opaque = Vec::with_capacity(3 * dots.pixels().len());
    // A loop is quick without optimisation too, in which tests draw.
    for dot in dots.data().chunks_exact(4) {
        opaque.extend_from_slice(&dot[..3]);
    }
    writer.write_image_data(&opaque)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(body: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"40\" viewBox=\"0 0 1000 400\" \
             font-family=\"sans-serif\">{body}</svg>"
        )
    }

    fn text(attributes: &str, content: &str) -> String {
        document(&format!("<text x=\"100\" y=\"300\" font-size=\"200\"{attributes}>{content}</text>"))
    }

    /// Red of the dots, row by row, of a file that is what it says of itself.
    fn reds(png: &Png) -> Vec<u8> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(&png.bytes)).read_info().unwrap();
        let mut dots = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut dots).unwrap();
        assert_eq!((info.width, info.height, info.color_type), (300, 120, png::ColorType::Rgb));
        assert_eq!(reader.info().pixel_dims.map(|pixels| pixels.xppu), Some(DOTS_PER_METRE));
        dots.chunks(3).map(|dot| dot[0]).collect()
    }

    fn dark(svg: &str) -> usize {
        reds(&png(svg).unwrap()).into_iter().filter(|red| *red < 100).count()
    }

    #[test]
    fn texts_leave_dark_dots() {
        assert_eq!(dark(&document("")), 0);
        let (upright, bold, slanted) =
            (dark(&text("", "θ")), dark(&text(" font-weight=\"bold\"", "θ")), text(" font-style=\"italic\"", "θ"));
        assert!(upright > 300, "{upright}");
        assert!(bold * 10 > upright * 13, "{bold} {upright}");
        assert!(dark(&slanted) > 300 && reds(&png(&slanted).unwrap()) != reds(&png(&text("", "θ")).unwrap()));
    }

    #[test]
    fn a_figure_is_the_same_bytes() {
        let svg = text("", "max |<tspan font-style=\"italic\">θ</tspan>|/α");
        assert_eq!(png(&svg).unwrap(), png(&svg).unwrap());
    }

    #[test]
    fn what_the_font_lacks_is_reported() {
        let found = png(&text("", "a\u{5730}b\u{9707}α")).unwrap();
        assert_eq!(found.missing.into_iter().collect::<String>(), "\u{5730}\u{9707}");
    }

    /// Texts of figures are written somewhere in the sources, or in a scene.
    #[test]
    fn the_font_has_all_that_sources_and_scenes_write() {
        let mut characters = BTreeSet::new();
        let mut folders =
            ["src", "../../scenes"].map(|folder| std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).to_vec();
        while let Some(folder) = folders.pop() {
            for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "toml") {
                    characters.extend(std::fs::read_to_string(path).unwrap().chars().filter(|character| !character.is_control()));
                }
            }
        }
        let characters: String = characters.into_iter().filter(|character| !"<>&\"".contains(*character)).collect();
        assert!(["θ", "…", "²", "−", "±"].iter().all(|known| characters.contains(known)), "{characters}");
        for attributes in ["", " font-weight=\"bold\"", " font-style=\"italic\""] {
            assert_eq!(png(&text(attributes, &characters)).unwrap().missing, BTreeSet::new(), "{attributes}");
        }
    }

    #[test]
    fn what_is_no_figure_is_refused() {
        assert!(matches!(png("<svg"), Err(PngError::Svg(_))));
        let huge = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1e9\" height=\"1e9\"/>";
        assert!(matches!(png(huge), Err(PngError::Size { .. })));
    }
}
