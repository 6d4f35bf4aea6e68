"""The accuracy gates of the tests, as the report lists them."""

import tomllib
from functools import cache
from typing import Any

from studies.record.source import ROOT


@cache
def gates() -> dict[str, dict[str, Any]]:
    """Return every gate by name: limit, unit, measured, against."""
    return tomllib.loads((ROOT / "tests" / "gates.toml").read_text(encoding="utf-8"))
