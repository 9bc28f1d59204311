"""The book. `scripts/docs` builds it."""

import re
import sys
from pathlib import Path

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util import logging

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "python"))

MANIFEST = (ROOT / "Cargo.toml").read_text(encoding="utf-8").split("[workspace.package]")[1]
REPOSITORY = re.search(r'repository = "(.*?)"', MANIFEST)[1]

project = "Strut"
release = version = re.search(r'version = "(.*?)"', MANIFEST)[1]
html_title = f"Strut {version}"
html_theme = "furo"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_math_renderer = "mathml"
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 4
exclude_patterns = ["_build", "requirements.txt"]
html_show_copyright = False
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["book.css"]
# The module's docstrings are read without the compiled part and without what it needs.
autodoc_mock_imports = ["strut._strut", "numpy", "pandas", "matplotlib"]
autodoc_typehints = "signature"
autodoc_member_order = "bysource"

LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((\.\./[^)#\s]+)(#[^)\s]*)?\)")


def outside(app, name, source):
    """Links to files outside of the book lead to the repository; a missing file is a warning, and warnings are errors."""

    def replaced(match):
        text, path, anchor = match.groups()
        target = (Path(app.srcdir) / name).parent.joinpath(path).resolve()
        if target.is_relative_to(Path(app.srcdir).resolve()):
            return match[0]
        if not target.exists():
            logging.getLogger(__name__).warning("%s: there is no %s", name, path)
        kind = "tree" if target.is_dir() else "blob"
        return f"[{text}]({REPOSITORY}/{kind}/main/{target.relative_to(ROOT).as_posix()}{anchor or ''})"

    source[0] = LINK.sub(replaced, source[0])


def equation(node, display="inline"):
    """An equation as MathML, which browsers set without a script and without network access."""
    result = convert(node.astext(), display=display)
    if "\\" in result:
        logging.getLogger(__name__).warning("a command of this equation is unknown: %s", node.astext(), location=node)
    return result


def inline(translator, node):
    translator.body.append(equation(node))
    raise nodes.SkipNode


def block(translator, node):
    translator.body.append(f'<div class="math" style="overflow-x: auto">{equation(node, "block")}</div>')
    raise nodes.SkipNode


def setup(app):
    app.connect("source-read", outside)
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
