"""Compile report/validation.pdf from the stored results.

    python -m report.build [--allow-stale] [-o FILE]

No number is typed in the text: all come from results/, tests/gates.toml, tests/claims.toml, the case files
and the versions.
The file is the same byte by byte as long as these are. Exit code 0: done; 2: a result is missing or stale, or
no longer supports a sentence, which one line names; the PDF that was there before then stays.
"""

import argparse
import datetime
import hashlib
import json
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typst

from report.content import accuracy, basis, design  # noqa: F401 (they enter what they give)
from report.facts import FACTS, HOLDS, LISTINGS, Fact, ReportError, Results
from studies.errors import BadInput
from studies.record.files import require_writable_file, write_whole
from studies.record.source import ROOT
from studies.record.store import Store
from studies.registry import STUDIES

MAIN = ROOT / "report" / "report.typ"
OUTPUT = ROOT / "report" / "validation.pdf"
FAILED = 2


def typeset(content: Mapping[str, Any]) -> bytes:
    """Return the report as PDF.

    Args:
        content: what may be quoted, from `gathered`.

    Raises:
        ReportError: the text asks for what there is not, or a sentence is no longer supported; one line.
    """
    made = datetime.datetime.fromisoformat(f"{content['date']}T00:00:00+00:00")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", typst.TypstWarning)
            pdf = typst.compile(
                str(MAIN),
                root=str(ROOT),
                sys_inputs={"content": json.dumps(content)},
                ignore_system_fonts=True,
                timestamp=int(made.timestamp()),
                format="pdf",
            )
    except (typst.TypstError, typst.TypstWarning) as error:
        # without typst's drawing of the source
        raise ReportError(f"text: {' '.join(error.message.split())}") from None
    if not isinstance(pdf, bytes):
        raise ReportError("text: got no pages from typst, expected one document")
    return pdf


def main(words: Sequence[str] | None = None) -> int:
    """Compile the report; return the exit code, 2 for a missing or stale result."""
    parser = argparse.ArgumentParser(
        prog="python -m report.build", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("-o", "--output", type=Path, default=OUTPUT, metavar="FILE")
    parser.add_argument(
        "--allow-stale",
        action="store_true",
        help="use stale results too, with a warning on the first page",
    )
    arguments = parser.parse_args(words)
    try:
        require_writable_file(arguments.output)
        pdf = typeset(gathered(Results(Store(), allow_stale=arguments.allow_stale)))
        write_whole(arguments.output, pdf)
    except BadInput as error:
        print(f"report: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("report: interrupted, the former PDF stays", file=sys.stderr)
        return 130
    print(f"{arguments.output}: {len(pdf) / 1e3:.0f} kB")
    return 0


#: What typst compiles: the text, beside the numbers, that a fingerprint must cover.
SOURCES = ("report.typ", "lib.typ", "drawing.typ", "references.yml", "sections/*.typ")


def quotable() -> dict[str, Mapping[str, Fact]]:
    """Return what the modules of `report.content` give, by kind and name."""
    return {"facts": FACTS, "holds": HOLDS, "listings": LISTINGS}


def gathered(results: Results) -> dict[str, Any]:
    """Return facts, conditions, tables and figures by name, with the fingerprint of it all.

    Raises:
        ReportError: a result is stale or missing, or does not have what is quoted.
    """
    content: dict[str, Any] = {
        kind: {name: entry.given(f"{kind} {name}", results) for name, entry in entries.items()}
        for kind, entries in quotable().items()
    }
    content["figures"] = results.figures()
    content["date"] = max(results.record(study)["date"] for study in STUDIES)
    content["stale"] = sorted(results.stale)
    content["fingerprint"] = _fingerprint(content)
    return content


def _fingerprint(content: dict[str, Any]) -> str:
    """Return the SHA-256 of all that typst is given: numbers, figures, text."""
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode())
    for pattern in SOURCES:
        for path in sorted((ROOT / "report").glob(pattern)):
            digest.update(path.read_bytes())
    return digest.hexdigest()


if __name__ == "__main__":
    sys.exit(main())
