"""Ask a request of the goldens, and bring its answer to the compact form that is stored and compared."""

import contextlib
import io
import json
import math
import os
import re
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import pandas as pd

from studies.__main__ import main
from studies.cases.design import as_toml, design_of
from studies.cases.problem import FOLDER
from studies.published.case import FOLDER as PUBLISHED
from tests.goldens.asked import SHIPPED, SWEEP, SWEEPS, Request, requests
from tests.goldens.compare import Difference, differences, rounded

#: Values that follow from measured times, or from round-off against a threshold: the golden says only that
#: they are there.
PRESENT_ALONE = re.compile(
    r"(full_)?wall_s|time_ratio|cheapest|active|outside|order_\w+|kkt_residual|violation"
)
PRESENT = "present"
#: Longest list of numbers that is stored in full, and the number of entries that stand for a longer one.
LONGEST, SAMPLED = 8, 6


def document_of(case: str) -> dict[str, Any]:
    """Return the design of a case as a document, a published problem without what is published of it."""
    folder = FOLDER if case in SHIPPED else PUBLISHED
    content = tomllib.loads((folder / f"{case}.toml").read_text(encoding="utf-8"))
    return {name: table for name, table in content.items() if name not in ("problem", "values")}


def scales(case: str) -> dict[str, float]:
    """Return the scales of a case, by the unit at the end of a key."""
    strips = design_of(case, document_of(case)).strips
    length, modulus = max(each.length for each in strips), max(each.youngs_modulus for each in strips)
    moment = max(each.youngs_modulus * each.second_moment_of_area / each.length for each in strips)
    return {
        "_Nm_per_rad": moment,
        "_N_per_m": moment / length**2,
        "_Nm": moment,
        "_J": moment,
        "_N": moment / length,
        "_Pa": modulus,
        "_m": length,
    }


def answer(request: Request, folder: Path) -> dict[str, Any]:
    """Return the answer to a request, asked in an empty folder: exit code, error lines, document."""
    words = request.words.split()
    out, err = io.StringIO(), io.StringIO()
    with contextlib.chdir(folder):
        if request.case not in SHIPPED:
            Path(f"{request.case}.toml").write_text(as_toml(document_of(request.case)), encoding="utf-8")
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(_with_output(words))
        document = _document(words[0], out.getvalue()) if code in (0, 3) else None
    said = [
        line for line in err.getvalue().replace(f"{FOLDER}{os.sep}", "").splitlines() if "studies: " in line
    ]
    return {"code": code, "says": said, "answer": compact(document)}


def _with_output(words: list[str]) -> list[str]:
    """Return the words with where the answer goes; those of a sweep name its file, which is written."""
    if words[0] == "converge":
        return [*words, "--out", "made"]
    if words[0] == "sweep":
        text = SWEEP.format(case=words[1], kind=words[2], **SWEEPS[words[2]])
        Path("designs.toml").write_text(text, encoding="utf-8")
        return ["sweep", "designs.toml", "--out", "made", "--workers", "1"]
    return [*words, "--json", "-"]


def _document(command: str, out: str) -> Any:
    """Return what a command answered, from its JSON or its tables."""
    if command == "converge":
        return {path.stem: _columns(pd.read_csv(path)) for path in sorted(Path("made").glob("*.csv"))}
    if command == "sweep":
        return _columns(pd.read_parquet("made/designs.parquet"))
    return json.loads(out) if out else None


def _columns(table: pd.DataFrame) -> dict[str, list[Any]]:
    """Return the columns of a table, with None for what is no number."""
    return {name: [None if pd.isna(each) else each for each in column] for name, column in table.items()}


def compact(value: Any) -> Any:
    """Return a value with long lists of numbers as count, norm and samples, without what is the machine's."""
    if isinstance(value, dict):
        return {
            name: PRESENT if PRESENT_ALONE.fullmatch(name) else compact(each) for name, each in value.items()
        }
    if not isinstance(value, list):
        return value
    numbers = [each for each in value if isinstance(each, int | float)]
    if len(value) <= LONGEST or len(numbers) < len(value):
        return [compact(each) for each in value]
    last = len(value) - 1
    return {
        "count": len(value),
        "norm": math.hypot(*numbers),
        "samples": [value[round(last * part / (SAMPLED - 1))] for part in range(SAMPLED)],
    }


STORED = Path(__file__).with_name("data")


def stored(case: str) -> dict[str, Any]:
    """Return the stored answers of a case by the words of their commands; none where there is no file."""
    path = STORED / f"{case}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def asked(request: Request) -> Any:
    """Run a request, in a folder of its own, and return the answer in the form that is stored."""
    with tempfile.TemporaryDirectory() as folder:
        found = answer(request, Path(folder))
    return rounded(found, request.words.partition(" ")[0], scales(request.case))


def compared(request: Request, old: Any, new: Any) -> list[Difference]:
    """Return where a new answer to a request differs from the old one."""
    return list(differences(old, new, request.words.partition(" ")[0], scales(request.case)))


def renewed(case: str) -> tuple[dict[str, Any], list[str]]:
    """Run all requests of a case; return the answers to store, and their changes in lines.

    An answer that is within the tolerances of the stored one stays as it is.
    """
    before, after, told = stored(case), {}, []
    for request in requests(case):
        words = request.words
        new = asked(request)
        if words not in before:
            told.append(f"{words}: new")
        found = compared(request, before[words], new) if words in before else []
        told += [f"{words}: {each}" for each in found]
        after[words] = before[words] if words in before and not found else new
    told += [f"{words}: no longer asked" for words in before if words not in after]
    return after, told


def written(case: str, answers: dict[str, Any]) -> None:
    """Write the answers of a case, a line for each key of an answer."""
    STORED.mkdir(exist_ok=True)
    (STORED / f"{case}.json").write_text(_text(answers, depth=3) + "\n", encoding="utf-8")


def _text(value: Any, depth: int) -> str:
    """Return a value as JSON, with a line for each key down to a depth."""
    if not isinstance(value, dict) or not value or not depth:
        return json.dumps(value)
    lines = [f"{json.dumps(name)}: {_text(each, depth - 1)}" for name, each in value.items()]
    return "{\n" + ",\n".join(lines) + "\n}"
