"""The formats that fields are written in, by name: each a function from fields to files by name."""

import io
import json
import math
from collections.abc import Callable
from typing import Any

from studies.answers.fields import Fields
from studies.exchange.tables import COLUMNS, tables

Contents = dict[str, bytes]


def contents(fields: Fields, formats: tuple[str, ...], drawn: list[int]) -> Contents:
    """Return the files of the formats by name.

    Args:
        fields: what is written.
        formats: names of `FORMATS`.
        drawn: numbers of the states that a drawing shows.
    """
    found: Contents = {}
    for name in formats:
        found |= FORMATS[name](fields, drawn)
    return found


def _vtk(fields: Fields, drawn: list[int]) -> Contents:
    from studies.exchange.vtk import vtk  # imported by who asks for it, as all libraries here

    return vtk(fields)


def _svg(fields: Fields, drawn: list[int]) -> Contents:
    from studies.exchange.svg import svg

    return svg(fields, drawn)


def _csv(fields: Fields, drawn: list[int]) -> Contents:
    return {
        f"{fields.analysis}_{name}.csv": table.to_csv(index=False, lineterminator="\n").encode()
        for name, table in tables(fields).items()
    }


def _parquet(fields: Fields, drawn: list[int]) -> Contents:
    found = {}
    for name, table in tables(fields).items():
        stream = io.BytesIO()
        table.to_parquet(stream, index=False)
        found[f"{fields.analysis}_{name}.parquet"] = stream.getvalue()
    return found


def _json(fields: Fields, drawn: list[int]) -> Contents:
    document = summary(fields) | {
        "columns": {},
        "tables": {
            name: {column: [_plain(value) for value in table[column].tolist()] for column in table.columns}
            for name, table in tables(fields).items()
        },
    }
    document["columns"] = {
        column: COLUMNS[column] for table in document["tables"].values() for column in table
    }
    return {f"{fields.analysis}.json": (json.dumps(document, allow_nan=False) + "\n").encode()}


def summary(fields: Fields) -> dict[str, Any]:
    """Return what was asked and how it ended, as JSON has it."""
    return {
        "analysis": fields.analysis,
        "model": fields.model,
        "settings": fields.settings,
        "effects": list(fields.effects),
        "status": fields.status,
        "message": fields.message,
    }


def _plain(value: Any) -> Any:
    """Return a value as JSON has it: null for NaN."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


#: Format -> what writes it.
FORMATS: dict[str, Callable[[Fields, list[int]], Contents]] = {
    "vtk": _vtk,
    "svg": _svg,
    "csv": _csv,
    "parquet": _parquet,
    "json": _json,
}
