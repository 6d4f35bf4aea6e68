"""The engine of studies: tables, findings, points beside each other; progress and timing out of their way."""

import gc
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from studies.commands.results import whole
from studies.engine import Claim, Part, Study, finding
from studies.record import progress
from studies.record.progress import Bar, measure, silent

ASKED: list[int] = []


def squared(number):
    """A row and its neighbour in a table of its own."""
    ASKED.append(number)
    return {"squares": {"number": number, "square": number**2}, "next": [{"number": number + 1}]}


def study(numbers=(1, 2), **given):
    """Squares, with what follows from them."""
    return Study(cases=(), parts=(Part(at=lambda: numbers, ask=squared),), figures={}, **given)


def answered(declared, progress=silent):
    """The tables of a study, its points asked one after the other."""
    ((_, tables, _),) = whole({"": declared}, progress)
    return tables


STUDY = study(numbers=(1, 2, 4))
TWO_PARTS = Study(
    cases=(),
    parts=(Part(at=lambda: (1,), ask=squared, alone=True), Part(at=lambda: (2,), ask=squared)),
    figures={},
)


def test_tables_follow_from_rows_and_from_tables():
    """Rows of all points stand below each other, and what follows sees the tables before it."""
    tables = answered(study(made={"sum": lambda tables: [{"sum": tables["squares"]["square"].sum()}]}))
    assert list(tables) == ["squares", "next", "sum"]
    assert tables["squares"].to_dict("list") == {"number": [1, 2], "square": [1, 4]}
    assert tables["sum"]["sum"].item() == 5


def test_claims_are_held_against_rows():
    """A claim is a finding a row, with columns in its words; what the parts found stands beside them."""
    own = finding(claim="c", formulation="f", quantity="q", value=1.0, holds=True)
    claim = Claim(
        claim="At most two",
        formulation="number {number}",
        quantity="{number:.1f} squared",
        rows=lambda tables: tables["squares"],
        value="square",
        most=2.0,
    )
    declared = Study(
        cases=(),
        parts=(*study().parts, Part(ask=lambda: {"findings": [own]})),
        claims=(claim,),
        figures={},
    )
    found = answered(declared)["findings"]
    assert found["formulation"].tolist() == ["f", "number 1", "number 2"]
    assert found["holds"].tolist() == ["yes", "yes", "no"]
    assert found["quantity"].iloc[2] == "2.0 squared"
    assert "findings" not in answered(study())


def test_what_must_be_alone_comes_after_all_others():
    """A study is whole as soon as its points are answered; those that must be alone are asked last."""
    place = f"{__name__}:TWO_PARTS"
    ASKED.clear()
    with ThreadPoolExecutor(1) as pool:
        found = [*whole({place: TWO_PARTS, __name__: STUDY}, silent, pool)]
    assert [name for name, _, _ in found] == [__name__, place]
    assert ASKED == [2, 1, 2, 4, 1]
    assert all(seconds > 0.0 for _, _, seconds in found)


def test_timing_warms_up_and_counts_repeats():
    """The work runs warm_up + repeat times; collection is off while timed and then restored."""
    seen = []
    timing = measure(lambda: seen.append(gc.isenabled()) or len(seen), repeat=3, warm_up=2)
    assert seen == [True, True, False, False, False]
    assert gc.isenabled()
    assert timing.result == 5
    assert len(timing.seconds) == 3
    assert min(timing.seconds) <= timing.median <= max(timing.seconds)
    with pytest.raises(ValueError, match="got 0, expected at least 1"):
        measure(lambda: None, repeat=0)


def test_bar_shows_long_work_on_a_terminal_only(capsys, monkeypatch):
    """Work that lasts is shown on the error stream where this is a terminal, short work is not."""
    for terminal, delay, shown in ((True, 60.0, False), (False, 0.0, False), (True, 0.0, True)):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        monkeypatch.setattr(progress, "DELAY", delay)
        with Bar("work") as bar:
            bar(1, 2)
            bar(2, 2)
        captured = capsys.readouterr()
        assert captured.out == ""
        assert ("work" in captured.err) is shown
