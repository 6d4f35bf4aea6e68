"""Everything the sections may quote, gathered from the results as one plain dictionary for typst."""

import hashlib
import json
from importlib import import_module
from typing import Any

from report.errors import ReportError
from report.facts import Derived, Fact, Holds, Listing, held, listed, written
from report.results import Results
from studies.record.source import ROOT
from studies.registry import STUDIES

#: Modules of `report.content`, in the order of the sections.
CONTENT = (
    "claims",
    "problem",
    "paper",
    "convergence",
    "cost",
    "peers",
    "hard_cases",
    "effects",
    "impulses",
    "design_space",
    "sizing",
    "limits",
    "appendix",
)

#: What typst compiles: the text, beside the numbers, that a fingerprint must cover.
SOURCES = ("report.typ", "lib.typ", "references.yml", "sections/*.typ")


def entries(kind: str) -> dict[str, Any]:
    """Return the entries `kind` ("FACTS", "HOLDS", "LISTINGS") of all modules by name.

    Raises:
        ReportError: two modules give the same name.
    """
    found: dict[str, Any] = {}
    for module in CONTENT:
        some = getattr(import_module(f"report.content.{module}"), kind, {})
        twice = sorted(set(found) & set(some))
        if twice:
            raise ReportError(f"report.content.{module}: got {twice[0]} twice, expected one of a name")
        found |= some
    return found


def gathered(results: Results) -> dict[str, Any]:
    """Return facts, conditions, tables and figures by name, with the fingerprint of it all.

    Raises:
        ReportError: a result is stale or missing, or does not have what is quoted.
    """
    facts: dict[str, Fact | Derived] = entries("FACTS")
    holds: dict[str, Holds] = entries("HOLDS")
    listings: dict[str, Listing] = entries("LISTINGS")
    content: dict[str, Any] = {
        "figures": _figures(results),
        "facts": {name: written(name, given, results) for name, given in facts.items()},
        "holds": {name: held(name, given, results) for name, given in holds.items()},
        "listings": {name: listed(name, given, results) for name, given in listings.items()},
    }
    content["date"] = max(results.record(study)["date"] for study in STUDIES)
    content["stale"] = sorted(results.stale)
    content["fingerprint"] = fingerprint(content)
    return content


def fingerprint(content: dict[str, Any]) -> str:
    """Return the SHA-256 of all that typst is given: numbers, figures, text."""
    digest = hashlib.sha256(json.dumps(content, sort_keys=True).encode())
    for pattern in SOURCES:
        for path in sorted((ROOT / "report").glob(pattern)):
            digest.update(path.read_bytes())
    return digest.hexdigest()


def _figures(results: Results) -> dict[str, str]:
    """Return the hash of every vector figure by its name; none is stale, or the build ends here."""
    return {
        file.removesuffix(".svg"): digest
        for study in STUDIES
        for file, digest in results.record(study)["figures"].items()
        if file.endswith(".svg")
    }
