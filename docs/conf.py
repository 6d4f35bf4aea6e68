"""How `make docs` builds the API reference and these pages, with Sphinx and without a network."""

import os
import sys
import tomllib
from pathlib import Path

# Before any import: compiled functions hide their signatures and docstrings.
os.environ["NUMBA_DISABLE_JIT"] = "1"
os.environ.setdefault("MPLBACKEND", "Agg")
HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import prose  # noqa: E402
from whole import import_whole  # noqa: E402

PROJECT = tomllib.loads((HERE.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
project = "Cross-axis pivot validation"
copyright = "the authors; MIT licence"
release = version = PROJECT["version"]

extensions = ["myst_parser", "sphinx.ext.autodoc"]
exclude_patterns = ["_build", "README.md"]
myst_heading_anchors = 3

autodoc_default_options = {"members": True, "ignore-module-all": True, "member-order": "bysource"}
autodoc_typehints_format = "short"
add_module_names = False
toc_object_entries = False
autodoc_preserve_defaults = True
python_maximum_signature_line_length = 90

nitpicky = True
# Types of other packages: their inventories would have to be fetched, and a build needs no network.
_OTHERS = (
    "argparse|ast|collections|concurrent|contextlib|enum|functools|matplotlib|meshio|numpy|np|pandas|pathlib|pyarrow|"
    "scipy|skfem|subprocess|types"
)
# Numbers are the bounds of parameters, which stand in their annotations; what is a module's own has no page.
nitpick_ignore_regex = [
    ("py:(class|obj)", rf"({_OTHERS})\..*"),
    ("py:class", r"[\d.]+"),
    ("py:class", r"(\w+\.)*_\w+"),
]
nitpick_ignore = [
    ("py:class", name)
    for name in (
        # aliases of numpy.typing.NDArray where annotations are postponed: names for a reader
        *("NDArray", "Array", "Indices"),
        # imported for annotations alone
        "Study",
        # scipy's class, which says that it belongs to no module
        "SuperLU",
        # type variables
        *("spline_model.accuracy.Found", "spline_model.motion.arrays.Kind", "spline_model.scene.Kind"),
        *("fe_reference.model.T", "fe_reference.refined.Answer"),
        *("fe_reference.arrays.F", "spline_model.solution.T"),
        *("studies.record.progress.Item", "studies.record.progress.Result"),
    )
]

highlight_language = "text"
html_theme = "furo"
html_title = project
html_show_sourcelink = False


def setup(app):
    """Import what the pages show; hand docstrings and signatures to `prose` before Sphinx reads them."""
    for package in (*prose.PACKAGES[:2], "studies.answers"):
        import_whole(package)
    app.connect("include-read", prose.process_included)
    app.connect("autodoc-process-docstring", prose.process_docstring)
    app.connect("autodoc-process-signature", prose.process_signature)
