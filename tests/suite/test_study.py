"""The engine of studies: tables, findings, and points beside each other."""

from concurrent.futures import ThreadPoolExecutor

import pandas as pd
import pytest

from studies.asking import answered, processes
from studies.engine import Claim, Part, Study, finding
from studies.record.progress import silent

ASKED: list[int] = []


def squared(number):
    """A row and its neighbour in a table of its own."""
    ASKED.append(number)
    return {"squares": {"number": number, "square": number**2}, "next": [{"number": number + 1}]}


def study(numbers=(1, 2), **given):
    """Squares, with what follows from them."""
    return Study(cases=(), parts=(Part(at=lambda: numbers, ask=squared),), figures={}, **given)


def tables_of(declared, progress=silent):
    """The tables of a study, its points asked one after the other."""
    ((_, tables, _),) = answered({"": declared}, progress)
    return tables


STUDY = study(numbers=(1, 2, 4))
TWO_PARTS = Study(
    cases=(),
    parts=(Part(at=lambda: (1,), ask=squared, alone=True), Part(at=lambda: (2,), ask=squared)),
    figures={},
)


def test_tables_follow_from_rows_and_from_tables():
    """Rows of all points stand below each other, and what follows sees the tables before it."""
    tables = tables_of(study(made={"sum": lambda tables: [{"sum": tables["squares"]["square"].sum()}]}))
    assert list(tables) == ["squares", "next", "sum"]
    assert tables["squares"].to_dict("list") == {"number": [1, 2], "square": [1, 4]}
    assert tables["sum"]["sum"].item() == 5


def test_tuples_are_taken_apart_and_tables_are_taken_whole():
    """A point of several values is asked by its values; a table may be given in place of rows."""
    part = Part(
        at=lambda: [(1, "a"), (2, "b")], ask=lambda n, name: {"t": pd.DataFrame({"n": n, "s": [name, name]})}
    )
    tables = tables_of(Study(cases=(), parts=(part,), figures={}))
    assert tables["t"]["s"].tolist() == ["a", "a", "b", "b"]


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
    found = tables_of(declared)["findings"]
    assert found["formulation"].tolist() == ["f", "number 1", "number 2"]
    assert found["holds"].tolist() == ["yes", "yes", "no"]
    assert found["quantity"].iloc[2] == "2.0 squared"
    assert "findings" not in tables_of(study())


def test_progress_is_told_of_every_point():
    """The number of points that are done grows to that of all."""
    told = []
    tables_of(study(), lambda *done: told.append(done))
    assert told == [(0, 2), (1, 2), (2, 2)]


def test_what_must_be_alone_comes_after_all_others():
    """A study is whole as soon as its points are answered; those that must be alone are asked last."""
    place = f"{__name__}:TWO_PARTS"
    ASKED.clear()
    with ThreadPoolExecutor(1) as pool:
        found = [*answered({place: TWO_PARTS, __name__: STUDY}, silent, pool)]
    assert [each[0] for each in found] == [__name__, place]
    assert ASKED == [2, 1, 2, 4, 1]
    assert all(seconds > 0.0 for _, _, seconds in found)


@pytest.mark.slow
def test_processes_give_the_same_tables():
    """Points answered beside each other stand where they do one after the other."""
    with processes(2) as pool:
        ((_, beside, _),) = answered({__name__: STUDY}, silent, pool)
    for name, table in tables_of(STUDY).items():
        pd.testing.assert_frame_equal(beside[name], table)
