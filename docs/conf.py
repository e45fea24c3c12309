"""Settings of the site of documents, for Sphinx."""

from __future__ import annotations

project = "Sprag"
extensions = ["myst_parser"]
# A page without its tables.
exclude_patterns = ["accuracy/page.md"]

html_theme = "pydata_sphinx_theme"
html_title = "Sprag"
html_theme_options = {"show_toc_level": 2, "header_links_before_dropdown": 6}
html_show_copyright = False
html_show_sourcelink = False

# As on code hosts, so that links to headings work in both places.
myst_heading_anchors = 3
