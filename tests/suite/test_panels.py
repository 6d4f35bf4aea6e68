"""Panels of figures draw what their axes say of a table, and sheets name each thing once."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from studies.record.panels import Axis, Curves, HeatMap, Level, Panel, sheet
from studies.record.style import BLUE, RED, Look

ROWS = pd.DataFrame(
    {
        "model": ["one", "one", "one", "other", "other"],
        "count": [3, 1, 2, 1, 2],
        "error": [1e-3, -1e-1, 0.0, 1e-2, np.nan],
    }
)
LOOKS = {
    "one": Look(label="one", colour=BLUE),
    "other": Look(label="other", colour=RED, marker="o", hollow=True),
    "absent": Look(label="absent", colour=RED),
}
COUNT, ERROR = Axis("count", "count", each=True), Axis("error", "error [1]", log=True)
CURVES = Curves(ROWS, LOOKS, by="model")


def test_curves_are_sizes_in_order_over_a_logarithmic_axis():
    """Points are joined in the order of x, errors lose their sign, and one that is nought is not drawn."""
    panel = sheet(3.0, 2.0, [[Panel(COUNT, ERROR, (CURVES,))]]).axes[0]
    one, other = panel.lines  # of what has no row, nothing is drawn
    np.testing.assert_array_equal(one.get_xdata(), [1, 2, 3])
    np.testing.assert_array_equal(one.get_ydata(), [1e-1, np.nan, 1e-3])
    assert (one.get_color(), other.get_markerfacecolor()) == (BLUE, "none")
    assert (panel.get_yscale(), list(panel.get_xticks())) == ("log", [1, 2, 3])


@pytest.mark.parametrize(("axis", "drawn"), [
    (replace(ERROR, factor=10.0), [1.0, np.nan, 1e-2]),
    (Axis("error", "", factor=100.0), [-10.0, 0.0, 0.1]),
])  # fmt: skip
def test_axis_scales_and_floors(axis, drawn):
    """An axis has its own unit, and a floor where it is logarithmic."""
    rows = ROWS[ROWS["model"] == "one"].sort_values("count")
    np.testing.assert_allclose(axis.of(rows), drawn)


def test_names_run_from_the_top():
    """What has names in place of numbers stands beside them, the first on top."""
    names = Axis("model", "", names=("other", "one"))
    panel = sheet(3.0, 2.0, [[Panel(ERROR, names, (Curves(ROWS, LOOKS["one"]),))]]).axes[0]
    assert [each.get_text() for each in panel.get_yticklabels()] == ["other", "one"]
    assert set(panel.lines[0].get_ydata()) == {0, 1}
    bottom, top = panel.get_ylim()
    assert bottom > top


def test_sheet_shares_equal_axes_and_names_everything_once():
    """Panels with the same axis share it; its name and every curve's stand once on the page."""
    panel, other = Panel(COUNT, ERROR, (CURVES, Level(1e-2))), replace(ERROR, label="other")
    rows = [[replace(panel), replace(panel)], [replace(panel, y=other) for _ in range(2)]]
    page = sheet(4.0, 4.0, rows, columns=("a", "b"), legend=2)
    assert [each.get_xlabel() for each in page.axes] == ["", "", "count", "count"]
    assert [each.get_ylabel() for each in page.axes] == ["error [1]", "", "other", ""]
    assert [each.get_title(loc="left") or each.get_title() for each in page.axes] == ["a", "b", "", ""]
    assert [each.get_text() for each in page.legends[0].get_texts()] == ["one", "other"]
    assert page.axes[0].get_shared_y_axes().joined(*page.axes[:2])
    assert not page.axes[0].get_shared_y_axes().joined(page.axes[0], page.axes[2])


def test_heat_map_has_exponents_and_crosses():
    """A square has the decimal exponent of its value, or a cross; a panel in two places fills both."""
    rows = pd.DataFrame({"x": [1, 2, 2], "y": [1, 1, 2], "error": [1e-3, np.nan, 1e-7]})
    heat = Panel(Axis("x", "x"), Axis("y", "y"), (HeatMap(rows=rows, column="error", limits=(1e-9, 1.0)),))
    curves = Panel(COUNT, ERROR, (CURVES,))
    page = sheet(4.0, 3.0, [[heat, heat], [curves, replace(curves)]], heights=(1, 2), colours="error")
    assert [each.get_text() for each in page.axes[0].texts] == ["-3", "x", "-7"]
    assert [each.get_ylabel() for each in page.axes] == ["y", "error [1]", "error [1]", "error"]
