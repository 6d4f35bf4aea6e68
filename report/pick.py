"""Picking a value out of a table: which rows, which column, and which of them."""

from collections.abc import Callable
from typing import Any

import pandas as pd

#: What a number is taken from a table by.
Pick = Callable[[pd.DataFrame], Any]


def where(table: pd.DataFrame, **equal: Any) -> pd.DataFrame:
    """Return the rows of `table` whose columns have the values `equal`.

    Raises:
        LookupError: no such column, or no such row.
    """
    for column, value in equal.items():
        if column not in table:
            raise LookupError(f"no column {column}, there are {', '.join(table.columns)}")
        table = table[table[column] == value]
        if table.empty:
            raise LookupError(f"no row with {column} = {value}")
    return table


def at(column: str, **equal: Any) -> Pick:
    """Return a pick of `column` in the one row with the values `equal`."""

    def pick(table: pd.DataFrame) -> Any:
        rows = where(table, **equal)
        if len(rows) != 1:
            raise LookupError(f"{len(rows)} rows with {equal}, expected one")
        return _column(rows, column).iloc[0]

    return pick


def largest(column: str, **equal: Any) -> Pick:
    """Return a pick of the largest magnitude of `column` among the rows with the values `equal`."""
    return lambda table: _column(where(table, **equal), column).abs().max()


def least(column: str, **equal: Any) -> Pick:
    """Return a pick of the smallest magnitude of `column` among the rows with the values `equal`."""
    return lambda table: _column(where(table, **equal), column).abs().min()


def distinct(column: str, **equal: Any) -> Pick:
    """Return a pick of how many different values `column` has among the rows with the values `equal`."""
    return lambda table: _column(where(table, **equal), column).nunique()


def _column(table: pd.DataFrame, name: str) -> "pd.Series[Any]":
    if name not in table:
        raise LookupError(f"no column {name}, there are {', '.join(table.columns)}")
    found: pd.Series[Any] = table[name]
    return found


def absent(value: Any) -> bool:
    """Return whether a cell of a table is empty."""
    return bool(pd.isna(value))
