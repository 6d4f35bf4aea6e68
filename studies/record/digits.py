"""The digits of a stored number that another computation of it must reproduce."""

import io
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from pandas.api.types import is_bool_dtype, is_integer_dtype, is_numeric_dtype

#: Significant digits that are written: two more than are claimed, so that rounding does not count.
WRITTEN = 8


@dataclass(frozen=True, kw_only=True)
class Digits:
    """Tolerance of a column: what round-off of another processor may change.

    A number is reproduced if it differs by at most the sum of a part of itself, a part of the largest
    magnitude in its column, and a floor in the unit of the column.

    Attributes:
        relative: part of the number [1].
        scale: part of the largest magnitude in the column [1].
        floor: in the unit of the column.
        rows: which rows are compared, as of `DataFrame.query`; all without it.
    """

    relative: float = 1e-6
    scale: float = 1e-9
    floor: float = 1e-12
    rows: str = ""

    def allow(self, stored: pd.Series, found: pd.Series) -> bool:
        """Return whether every number of `found` is reproduced; an absent number must be absent in both."""
        one, other = stored.to_numpy(float), found.to_numpy(float)
        largest = np.abs(one[np.isfinite(one)]).max(initial=0.0)
        return np.allclose(
            other, one, rtol=self.relative, atol=self.scale * largest + self.floor, equal_nan=True
        )


#: Columns of numbers that a study does not give a tolerance.
NUMBERS = Digits()
#: Columns that are not compared: the work of a search depends on round-off where it hardly converges, and
#: texts repeat numbers of their row. A study may add tolerances by "table.column" or "column".
BY_NAME: dict[str, Digits | None] = dict.fromkeys(
    (
        *("iterations", "newton_iterations", "halvings", "evaluations", "factorisations"),
        *("sentence", "reason", "message", "says"),
    )
)


def differing(
    table: str, stored: pd.DataFrame, found: pd.DataFrame, digits: Mapping[str, Digits | None]
) -> list[str]:
    """Return the columns of a table that are not reproduced, or what else is different.

    Words, truth values and whole numbers must be equal, other numbers within `NUMBERS`, unless `digits` or
    `BY_NAME` has an entry for the column.
    """
    known = {**BY_NAME, **digits}
    one, other = read_csv(as_csv(stored)), read_csv(as_csv(found))
    if list(one) != list(other):
        return sorted(map(str, set(one) ^ set(other))) or ["order of columns"]
    if len(one) != len(other):
        return [f"{len(other)} rows, stored {len(one)}"]
    names = map(str, one)
    tolerances = {name: known.get(f"{table}.{name}", known.get(name, NUMBERS)) for name in names}
    return [name for name, own in tolerances.items() if own and not _reproduced(one, other, name, own)]


def _reproduced(stored: pd.DataFrame, found: pd.DataFrame, name: str, digits: Digits) -> bool:
    if digits.rows:
        compared = stored.query(digits.rows).index
        stored, found = stored.loc[compared], found.loc[compared]
    both = (stored[name], found[name])
    numbers = all(is_numeric_dtype(each) and not is_bool_dtype(each) for each in both)
    if not numbers or (digits is NUMBERS and all(map(is_integer_dtype, both))):
        return both[0].equals(both[1])
    return digits.allow(*both)


def as_csv(table: pd.DataFrame) -> bytes:
    """Return `table` as CSV: 8 significant digits, rows sorted by the columns as written, from the left."""
    written = read_csv(_text(table)).sort_values(list(table.columns), kind="stable")
    return _text(table.iloc[written.index])


def _text(table: pd.DataFrame) -> bytes:
    return table.to_csv(index=False, float_format=f"%.{WRITTEN}g", lineterminator="\n").encode()


def read_csv(content: bytes) -> pd.DataFrame:
    """Return a table that `as_csv` wrote: an empty cell is an absent value, all other words are words."""
    return pd.read_csv(io.BytesIO(content), keep_default_na=False, na_values=[""])
