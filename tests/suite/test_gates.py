"""Gates are honest: complete, tight, used, with teeth; and mutants fit the code and are noticed."""

import ast
import datetime
import math
import random
import re
import tomllib
from fnmatch import fnmatchcase
from functools import cache

import pytest

from studies.record.source import ROOT
from tests import gates, mutate

#: A limit is at most this many times what was last measured.
SLACK = 20.0
#: Rows of the verification and validation matrix.
CLAIMS = tomllib.loads((ROOT / "tests" / "claims.toml").read_text(encoding="utf-8"))["claim"]


def _faults(name: str, gate: dict) -> list[str]:
    """Return what is wrong with the declaration of a gate."""
    faults = [f"{name}: no {field}" for field in gates.REQUIRED if field not in gate]
    fields = gates.REQUIRED | gates.OPTIONAL
    faults += [f"{name}: unknown field {field}" for field in gate if field not in fields]
    faults += [f"{name}: {field} is a {type(value).__name__}" for field, value in gate.items()
               if field in fields and not isinstance(value, fields[field])]  # fmt: skip
    if faults:
        return faults
    if not 0.0 < gate["measured"] <= gate["limit"] <= SLACK * gate["measured"]:
        faults.append(
            f"{name}: limit {gate['limit']} is not within 1 to {SLACK} x measured {gate['measured']}"
        )
    if not gate["teeth"]:
        faults.append(f"{name}: no teeth")
    if ("parts" in gate) != ("factor" in gate):
        faults.append(f"{name}: parts and factor belong together")
    elif "parts" in gate and gate["limit"] > gate["factor"] * sum(gate["parts"].values()):
        faults.append(f"{name}: limit is above factor x the sum of its parts")
    if not gate["why"].strip() or not gate["against"].strip():
        faults.append(f"{name}: why or against is empty")
    datetime.date.fromisoformat(gate["set"][:10])
    return faults


def test_every_gate_is_complete_and_tight():
    """Each gate has all its fields, teeth, and a limit of at most 20 x what was measured."""
    faults = [fault for name, gate in gates.table().items() for fault in _faults(name, gate)]
    assert faults == []


SOUND = {
    "limit": 1e-6,
    "unit": "1",
    "measured": 2e-7,
    "set": "2026-01-31, first version",
    "against": "a closed form",
    "why": "five times what was seen",
    "teeth": {"elements": 5},
}


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"limit": 1e-5}, "within 1 to"),
        ({"limit": 1e-7}, "within 1 to"),
        ({"teeth": {}}, "no teeth"),
        ({"unit": 1}, "unit is a int"),
        ({"tolerance": 1.0}, "unknown field tolerance"),
        ({"parts": {"model": 1e-7}}, "belong together"),
        ({"parts": {"model": 1e-7}, "factor": 2.0}, "above factor"),
        ({"why": " "}, "is empty"),
    ],
)
def test_unsound_gate_is_seen(change, fault):
    """The check of declarations has teeth."""
    assert _faults("sound", SOUND) == []
    assert any(fault in line for line in _faults("unsound", SOUND | change))


def _named(text: str) -> set[str]:
    """Return the gates that a source names, whole or by a formatted text."""
    # what a formatted text such as f"fe_order_{element}" can become: words where it has values
    formatted = set(re.findall(r'f"((?:\w*\{[^{}"]+\})+\w*)"', text))
    parts = [re.split(r"\{[^{}]+\}", each) for each in formatted]
    patterns = re.compile("|".join(r"\w+".join(each) for each in parts if max(map(len, each)) > 3) or "-")
    return {name for name in gates.table() if f'"{name}"' in text or patterns.fullmatch(name)}


def test_every_gate_is_used():
    """Each gate is named by a test, so that no limit stands for nothing."""
    text = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("*.py"))
    assert set(gates.table()) - _named(text) == set()


def test_every_gate_belongs_to_one_claim():
    """The matrix of the report counts each gate once, and every pattern of a claim finds a gate."""
    patterns = [each for claim in CLAIMS for each in claim["gates"]]
    belongs = {name: [each for each in patterns if fnmatchcase(name, each)] for name in gates.table()}
    assert {name: found for name, found in belongs.items() if len(found) != 1} == {}
    assert set(patterns) - {each for found in belongs.values() for each in found} == set()


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim["text"])
def test_claim_names_the_test_of_its_first_gate(claim):
    """The first gate of a claim is one gate, and the file that the claim names checks it."""
    assert claim["gates"][0] in _named((ROOT / "tests" / claim["test"]).read_text(encoding="utf-8"))


@pytest.fixture
def sound_gate(monkeypatch):
    """A table with one sound gate."""
    monkeypatch.setattr(gates, "table", lambda: {"sound": SOUND})


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (2e-6, "error 2e-06 [1] is 2 x the gate (limit 1e-06, against a closed form, last measured 2e-07)"),
        (0.0, "is not positive (compared with itself?)"),
        (-1e-9, "is not positive"),
        (math.nan, "is not a finite number"),
        (math.inf, "is not a finite number"),
    ],
)
def test_check_refuses(sound_gate, error, text):
    """An error above the limit, of zero, negative or not finite is refused in one telling line."""
    with pytest.raises(AssertionError) as refusal:
        gates.check("sound", error)
    assert text in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_check_passes_and_names_unknown_gates(sound_gate):
    """An error up to the limit passes; an unknown gate lists those there are."""
    gates.check("sound", 1e-6)
    assert gates.limit("sound") == 1e-6
    assert gates.teeth("sound") == {"elements": 5}
    with pytest.raises(KeyError, match="there are: sound"):
        gates.check("unsound", 1e-6)


#: Folders whose tests hold accuracies to gates alone, and the power of ten from which a literal limit is one:
#: what is smaller is an identity to round-off, or to what a solver's tolerance leaves.
HELD = {"agreement": 7, "fe": 7, "cost": 5, "design": 5, "interactive": 5}
#: Solutions of one model that stand for the same state, to the tolerance of its paths and motions.
SAME = {"test_loads.py": 1}
#: What theory leaves: the next order of a closed form, a difference for a derivative, the digits of a table.
THEORY = {"test_shell.py": 1, "test_solid.py": 1}
#: What the page promises of what it shows, coarser than it is.
PROMISED = {
    "test_browser_design.py": 1,
    "test_browser_hand.py": 1,
    "test_session.py": 4,
    "test_commands.py": 1,
    "test_server.py": 1,
}


def test_accuracies_of_answers_are_gates():
    """No test in these folders has an accuracy limit beside `gates.toml`; what looks like one is counted."""
    found = {}
    for folder, power in HELD.items():
        literal = re.compile(rf"(?:<=?|rel=|abs=|tol=) *-?\d*\.?\d*e-0?[1-{power}]\b")
        for path in sorted((ROOT / "tests" / folder).glob("test_*.py")):
            count = len(literal.findall(path.read_text(encoding="utf-8")))
            found[path.name] = found.get(path.name, 0) + count
    assert {name: count for name, count in found.items() if count} == SAME | THEORY | PROMISED


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
