"""The figure of one design's convergence: errors of both models over their refinement."""

import pandas as pd
from matplotlib.figure import Figure

from studies.answers.reference import Reference
from studies.convergence.sweep import QUANTITIES
from studies.record.style import LOOKS, page, uncertain


def draw(splines: pd.DataFrame, elements: pd.DataFrame, limit: Reference) -> Figure:
    """Draw the largest errors over the number of control points (above) and of elements (below).

    Args:
        splines, elements: rows of `spline_sweep` and `element_sweep`.
        limit: the reference, for its uncertainty.
    """
    figure = page(9.5, 6.0)
    panels = figure.subplots(2, len(QUANTITIES), sharey="col")
    for column, quantity in enumerate(QUANTITIES):
        above, below = panels[:, column]
        above.semilogy(
            splines["control_points"], splines[f"error_{quantity}"], "x-", color=LOOKS["n = 6"].colour
        )
        above.set(xlabel="control points a strip", ylabel=f"error of the {quantity} [1]")
        below.loglog(elements["elements"], elements[f"error_{quantity}"], "s--", color="#000000")
        below.set(xlabel="elements a strip", ylabel=f"error of the {quantity} [1]")
        below.set_xticks(list(elements["elements"]), labels=[str(n) for n in elements["elements"]])
        below.minorticks_off()
        for panel in (above, below):
            uncertain(panel, limit.uncertainty[quantity])
    panels[0, 0].set_title("spline")
    panels[1, 0].set_title("finite elements")
    return figure
