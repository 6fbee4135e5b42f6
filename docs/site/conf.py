"""Sphinx's configuration for the documentation. `ci/site` calls it on a folder of links to README, docs, cases and what was made for the gallery."""

import tomllib
from pathlib import Path

with (Path(__file__).parents[2] / "Cargo.toml").open("rb") as file:
    release = tomllib.load(file)["package"]["version"]
project, copyright, author = "hypercircle", "its authors", "its authors"
extensions = ["myst_parser", "sphinxcontrib.katex"]
root_doc = "docs/index"
include_patterns = ["README.md", "CHANGELOG.md", "cases/README.md", "docs/*.md", "docs/gallery/*.md"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
# A fence of a language that no lexer knows is shown as it is.
suppress_warnings = ["misc.highlighting_failure"]

html_theme = "furo"
html_title = f"hypercircle {release}"
html_copy_source = False
html_extra_path = ["index.html"]
html_static_path = ["site.css"]
# KaTeX comes with its extension. It writes MathML, which browsers draw themselves: there are no fonts to load.
katex_css_path = "site.css"
katex_options = 'output: "mathml", throwOnError: true'
