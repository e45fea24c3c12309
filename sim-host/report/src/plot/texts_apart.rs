//! For the tests of the figures: where the texts of an SVG are, laid out as for PNG.

use resvg::tiny_skia::Rect;
use resvg::usvg::{Group, Node};

/// How far the inks of two texts may run into each other (px): edges of letters.
const TOUCHING_PX: f32 = 0.3;

/// No two texts overlap, in the font of PNG pictures, and none leaves the canvas.
pub fn assert_texts_apart(svg: &str) {
    let tree = super::png::tree(svg).expect("a figure is SVG");
    let mut texts = Vec::new();
    collect_texts(tree.root(), &mut texts);
    assert!(!texts.is_empty());
    let (width, height) = (tree.size().width(), tree.size().height());
    for (index, (text, ink)) in texts.iter().enumerate() {
        let inside = ink.left() >= 0.0 && ink.top() >= 0.0 && ink.right() <= width && ink.bottom() <= height;
        assert!(inside, "{text:?} leaves the canvas of {width} x {height}: {ink:?}");
        for (other, other_ink) in &texts[..index] {
            let across = ink.right().min(other_ink.right()) - ink.left().max(other_ink.left());
            let up = ink.bottom().min(other_ink.bottom()) - ink.top().max(other_ink.top());
            assert!(across.min(up) < TOUCHING_PX, "{text:?} at {ink:?} runs into {other:?} at {other_ink:?}");
        }
    }
}

fn collect_texts(group: &Group, texts: &mut Vec<(String, Rect)>) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect_texts(group, texts),
            Node::Text(text) => {
                let words = text.chunks().iter().map(|chunk| chunk.text()).collect();
                texts.push((words, text.flattened().abs_bounding_box()));
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}
