"""The slips that a check must notice: they fit the code, name tests that exist, and are noticed."""

import ast
import random
from functools import cache

import pytest

from tests import mutate

SLIPS = mutate.slips()
#: Slips that every run of the slow tests tries, drawn again only if the list changes.
TRIED = random.Random(len(SLIPS)).sample([slip for slip in SLIPS if slip.caught_by], 4)


@cache
def functions(path):
    """Names of the test functions of a file."""
    return {each.name for each in ast.walk(ast.parse(path.read_text())) if isinstance(each, ast.FunctionDef)}


def fits(slip):
    """Whether the text of a slip stands once in its file and its test exists, or a reason to survive."""
    if (mutate.ROOT / slip.file).read_text().count(slip.old) != 1 or slip.old == slip.new:
        return False
    if not slip.caught_by:
        return bool(slip.survives)
    path, name = slip.caught_by.split("::")
    return not slip.survives and name.split("[")[0] in functions(mutate.ROOT / path)


def test_slips_fit_the_code():
    """What a slip changes stands once in its file, and the test that notices it exists."""
    assert [slip.name for slip in SLIPS if not fits(slip)] == []


def test_no_slip_is_left_to_the_freshness_of_results():
    """A slip must show in what is right or wrong, not in results that were computed before it."""
    assert [slip.name for slip in SLIPS if "test_results" in slip.caught_by] == []


def test_slips_are_many_and_everywhere():
    """There are forty and more, in both models and in the measures that they share."""
    count = {part: 0 for part in ("fe_reference", "spline_model", "studies")}
    for slip in SLIPS:
        count[next(part for part in count if slip.file.startswith(part))] += 1
    assert len(SLIPS) >= 40
    assert min(count.values()) >= 10, count


def test_page_has_the_slips():
    """The table of the page on independence is that of the list (`python -m tests.mutate --page`)."""
    text = mutate.PAGE.read_text()
    assert mutate.page_with(text) == text


@pytest.mark.slow
def test_some_slips_are_noticed(tmp_path):
    """Put into a copy of the code, a part of the slips fails the tests that are named, which pass without."""
    copy = mutate.copied(tmp_path)
    assert mutate.outcome(copy, [slip.caught_by for slip in TRIED]) == mutate.PASSED
    assert [slip.name for slip in TRIED if not mutate.slipped(copy, slip)] == []
