//! Pictures of a command.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::{Formats, OutputError, Results};
use crate::plot::png;

impl Results {
    /// Writes the figure `svg` to `folder` as NAME.svg and NAME.png, as `formats` say; returns the one to look at first, if any.
    ///
    /// Characters that the font of PNG pictures does not have are reported by [`Results::commit_with_notes`].
    ///
    /// # Errors
    /// Those of [`Results::add`], and a figure that cannot be drawn.
    pub fn add_picture(
        &mut self,
        folder: &Path,
        name: &str,
        svg: &str,
        formats: Formats,
    ) -> Result<Option<PathBuf>, OutputError> {
        let [in_svg, in_png] = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
        if formats.svg {
            self.add(&in_svg, |file| file.write_all(svg.as_bytes()))?;
        }
        if formats.png {
            let png =
                png(svg).map_err(|error| OutputError { path: in_png.clone(), reason: format!("cannot be drawn: {error}") })?;
            self.add(&in_png, |file| file.write_all(&png.bytes))?;
            if !png.missing.is_empty() {
                let missing: Vec<String> = png.missing.iter().map(|character| format!("`{character}`")).collect();
                self.notes.push(format!("{}: the font has no {}", in_png.display(), missing.join(", ")));
            }
        }
        Ok(if formats.svg { Some(in_svg) } else { formats.png.then_some(in_png) })
    }
}

#[cfg(all(test, feature = "png"))]
mod tests {
    use super::*;

    const SVG: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\" font-family=\"sans-serif\">\
                       <text y=\"9\">α\u{5730}</text></svg>";

    #[test]
    fn a_picture_is_written_as_asked() {
        let folder = tempfile::tempdir().unwrap();
        let mut results = Results::default();
        let first = |name: &str, formats: Formats, results: &mut Results| results.add_picture(folder.path(), name, SVG, formats);
        assert_eq!(first("both", Formats::ALL, &mut results).unwrap(), Some(folder.path().join("both.svg")));
        let png = Formats { svg: false, ..Formats::ALL };
        assert_eq!(first("dots.of", png, &mut results).unwrap(), Some(folder.path().join("dots.of.png")));
        assert_eq!(first("none", Formats { png: false, ..png }, &mut results).unwrap(), None);
        let mut notes = Vec::new();
        results.commit_with_notes(&mut notes).unwrap();
        let notes = String::from_utf8(notes).unwrap();
        assert!(notes.lines().count() == 2 && notes.ends_with("dots.of.png: the font has no `\u{5730}`\n"), "{notes}");
        let mut names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["both.png", "both.svg", "dots.of.png"]);
        assert_eq!(std::fs::read_to_string(folder.path().join("both.svg")).unwrap(), SVG);
    }
}
