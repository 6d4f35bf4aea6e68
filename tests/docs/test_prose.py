"""Docstrings of prose and plain formulas become markup that renders as what they read."""

import importlib.util

import docutils.core
import pytest

from studies.record.source import ROOT


def prose():
    """The module that `docs/conf.py` uses, which is in no package."""
    specification = importlib.util.spec_from_file_location("prose", ROOT / "docs" / "prose.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


PROSE = prose()


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("with |C'| > 0, r* and q_ and *args", "with |C'| > 0, r* and q_ and *args"),
        ("a line\n    that goes on", "a line that goes on"),
        ("by ``x_`` and `y*`s", "by x_ and y*s"),
        (r"a \ b", r"a \ b"),
    ],
)
def test_marks_are_what_they_look_like(text, read):
    """Bars, stars and underscores are themselves; only backticks mark, and lines flow."""
    document = docutils.core.publish_doctree(PROSE.as_rst(text), settings_overrides={"report_level": 1})
    assert document.astext() == read
    assert not list(document.findall(docutils.nodes.system_message))


def test_blocks_and_sections():
    """An indented block stands as it is; a section is a list of its entries, whatever their lines."""
    text = "Solve.\n\n    K x = 0,\n      x|0\n\nArgs:\n    a: one,\n        two. b: three\n    c, d [N]: 4\n"
    document = docutils.core.publish_doctree(PROSE.as_rst(text))
    assert [node.astext() for node in document.findall(docutils.nodes.literal_block)] == ["K x = 0,\n  x|0"]
    entries = [node.astext() for node in document.findall(docutils.nodes.list_item)]
    assert entries == ["a: one, two. b: three", "c, d [N]: 4"]
    assert [node.astext() for node in document.findall(docutils.nodes.strong)] == ["Args"]


def test_arrays_in_signatures_are_short():
    """An array with its two parameters becomes NDArray, a default that is no code an ellipsis."""
    given = "(a: ~numpy.ndarray[tuple[~typing.Any, ...], ~numpy.dtype[~numpy.float64]] = <factory>)"
    made = PROSE.process_signature(None, "", "", None, None, given, None)
    assert made == ("(a: ~numpy.typing.NDArray[~numpy.float64] = ...)", None)


def test_sections_of_numpydoc():
    """Names without a type are entries too, with their text after a full stop; examples are literal."""
    text = "Parameters\n----------\na : float, m\n    One.\nrest\n    Others.\n\n"
    text += "Examples\n--------\n>>> 1 + 1\n2"
    document = docutils.core.publish_doctree(PROSE.as_rst(text))
    entries = [node.astext() for node in document.findall(docutils.nodes.list_item)]
    assert entries == ["a: float, m. One.", "rest. Others."]
    assert [node.astext() for node in document.findall(docutils.nodes.literal_block)] == [">>> 1 + 1\n2"]
