//! For the tests of the figures: what an SVG draws, laid out as for PNG.

use resvg::tiny_skia::Rect;
use resvg::usvg::{Group, Node};

/// How far the inks of two texts may run into each other (px): edges of letters.
const TOUCHING_PX: f32 = 0.3;

/// The figure is SVG with a title, all that it draws lies on its canvas, and no two texts overlap in the font of PNG pictures.
pub fn assert_drawn(svg: &str) {
    let tree = super::png::tree(svg).expect("a figure is SVG");
    assert!(["NaN", "inf\"", "inf "].iter().all(|bad| !svg.contains(bad)), "a coordinate is no number");
    let mut drawn = Vec::new();
    collect(tree.root(), &mut drawn);
    let (width, height) = (tree.size().width(), tree.size().height());
    for (name, ink) in &drawn {
        let inside = ink.left() >= 0.0 && ink.top() >= 0.0 && ink.right() <= width && ink.bottom() <= height;
        assert!(inside, "{name:?} leaves the canvas of {width} x {height}: {ink:?}");
    }
    let texts: Vec<_> = drawn.iter().filter_map(|(name, ink)| Some((name.as_ref()?, ink))).collect();
    assert!(!texts.is_empty());
    for (index, (text, ink)) in texts.iter().enumerate() {
        for (other, other_ink) in &texts[..index] {
            let across = ink.right().min(other_ink.right()) - ink.left().max(other_ink.left());
            let up = ink.bottom().min(other_ink.bottom()) - ink.top().max(other_ink.top());
            assert!(across.min(up) < TOUCHING_PX, "{text:?} at {ink:?} runs into {other:?} at {other_ink:?}");
        }
    }
}

/// Adds the texts of `group`, and its lines and areas, which have no text, with the rectangles that they cover.
fn collect(group: &Group, drawn: &mut Vec<(Option<String>, Rect)>) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect(group, drawn),
            Node::Text(text) => {
                let words = text.chunks().iter().map(|chunk| chunk.text()).collect();
                drawn.push((Some(words), text.flattened().abs_bounding_box()));
            }
            Node::Path(path) => drawn.push((None, path.abs_bounding_box())),
            Node::Image(_) => {}
        }
    }
}
