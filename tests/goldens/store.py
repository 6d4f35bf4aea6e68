"""The files of the goldens, one for each case: reading, and writing with what has changed."""

import json
import tempfile
from pathlib import Path
from typing import Any

from tests.goldens.answers import answer, scales
from tests.goldens.asked import Request, requests
from tests.goldens.compare import Difference, differences, rounded

FOLDER = Path(__file__).with_name("data")


def stored(case: str) -> dict[str, Any]:
    """Return the stored answers of a case by the words of their commands; none where there is no file."""
    path = FOLDER / f"{case}.json"
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
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f"{case}.json").write_text(_text(answers, depth=3) + "\n", encoding="utf-8")


def _text(value: Any, depth: int) -> str:
    """Return a value as JSON, with a line for each key down to a depth."""
    if not isinstance(value, dict) or not value or not depth:
        return json.dumps(value)
    lines = [f"{json.dumps(name)}: {_text(each, depth - 1)}" for name, each in value.items()]
    return "{\n" + ",\n".join(lines) + "\n}"
