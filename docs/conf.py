"""Settings of the site of documents, for Sphinx: `cargo xtask site` builds it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import sprag
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

sys.path.insert(0, str(Path(__file__).parent))

project = "Sprag"
version = sprag.__version__
extensions = [
    "matplotlib.sphinxext.plot_directive",
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "native_types",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = [
    # A page without its tables.
    "accuracy/page.md",
    "gallery",
    # A table within another page.
    "made/glossary.md",
]

html_theme = "pydata_sphinx_theme"
html_title = "Sprag"
html_theme_options = {"header_links_before_dropdown": 6}
html_show_copyright = False
html_show_sourcelink = False

# As on code hosts, so that links to headings work in both places.
myst_heading_anchors = 3
myst_enable_extensions = ["deflist"]

autodoc_member_order = "bysource"
# Only to run on a cluster.
autodoc_mock_imports = ["distributed"]
maximum_signature_line_length = 100
autodoc_typehints_format = "short"
# What is documented is listed by autodoc.
numpydoc_show_class_members = False
# Of packages whose own documents are elsewhere.
nitpick_ignore_regex = [("py:.*", r"(collections|distributed|enum|matplotlib|np|npt|numpy|os|pandas|pathlib|xarray)\..*")]

plot_formats = ["svg"]
plot_html_show_formats = False
plot_html_show_source_link = False

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "made/gallery",
    "filename_pattern": "/",
    "subsection_order": [f"gallery/{part}" for part in ("pulses", "records", "devices", "trust")],
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "show_signature": False,
    "write_computation_times": False,
}


def help_of(*words: str) -> str:
    """What `sprag WORDS --help` prints, 100 columns wide."""
    program = Path(sys.executable).with_name("sprag")
    return subprocess.run([program, *words, "--help"], capture_output=True, check=True, text=True, encoding="utf-8").stdout


def commands_in(text: str) -> list[str]:
    """The commands that a help lists before its options."""
    return re.findall(r"^  ([a-z][a-z-]*)  ", text.split("\nOptions:")[0].split("Usage:")[1], re.MULTILINE)


def write_commands(folder: Path) -> None:
    """Writes a page a command: its help, and those of its own commands."""
    folder.mkdir(parents=True, exist_ok=True)
    for command in commands_in(help_of()):
        text = help_of(command)
        parts = [f"# sprag {command}", f"```text\n{text}```"]
        for inner in commands_in(text):
            parts += [f"## sprag {command} {inner}", f"```text\n{help_of(command, inner)}```"]
        (folder / f"{command}.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def every_name(page: Path) -> None:
    """Fails where the reference of the package lacks a name that it has, but for types that are other names of those."""
    there = set(re.findall(r"auto\w+:: sprag\.(\w+)", page.read_text(encoding="utf-8")))
    lacking = set(sprag.__all__) - there - {"Device", "Ground", "Law", "Motion", "__version__", "errors"}
    if lacking:
        raise ExtensionError(f"{page.name} lacks {', '.join(sorted(lacking))}")


def write_glossary(file: Path) -> None:
    """Writes the glossary that the core's first page has, without its links into the code."""
    page = (Path(__file__).parent.parent / "shared/src/lib.rs").read_text(encoding="utf-8")
    table = [line.removeprefix("//! ") for line in page.split("# Glossary")[1].splitlines() if line.startswith("//! |")]
    file.write_text(re.sub(r"\[(`[^`]+`)\]", r"\1", "\n".join(table)) + "\n", encoding="utf-8")


def keep_bars(app: Sphinx, what: str, name: str, of: object, options: object, lines: list[str]) -> None:
    """Leaves the bars of |θ| in a docstring, which would be a substitution."""
    lines[:] = [line.replace("|", r"\|") for line in lines]


def setup(app: Sphinx) -> None:
    """Makes the pages that are not committed."""
    every_name(Path(__file__).with_name("reference") / "python.md")
    made = Path(__file__).with_name("made")
    write_commands(made / "commands")
    write_glossary(made / "glossary.md")
    app.connect("autodoc-process-docstring", keep_bars)
