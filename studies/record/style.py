"""How every figure looks: a fixed colour for each formulation, files equal byte by byte."""

import io
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure
from matplotlib.text import Text

#: Colours that remain apart for colour-blind readers (Okabe and Ito, Color Universal Design, 2008).
BLACK, GREY, ORANGE, SKY = "#000000", "#808080", "#e69f00", "#56b4e9"
GREEN, BLUE, RED, PURPLE = "#009e73", "#0072b2", "#d55e00", "#cc79a7"

#: Width of a page's text [inch].
PAGE_WIDTH = 160.0 / 25.4

SETTINGS: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "axes.titlelocation": "left",
    "figure.titlesize": 8.0,
    "figure.labelsize": 8.0,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 3.0,
    "legend.fontsize": 7.5,
    "legend.handlelength": 1.6,
    "legend.columnspacing": 1.2,
    "legend.frameon": False,
    "svg.hashsalt": "cross-axis flexural pivot",
    "svg.fonttype": "path",
    # a line may omit points that move it by less than this [1/72 inch]
    "path.simplify_threshold": 0.8,
    "savefig.dpi": 120,
}


#: What each format says of a file that differs from one day or machine to the next.
UNSAID = {"svg": "Date", "png": "Software", "pdf": "CreationDate"}


@dataclass(frozen=True, kw_only=True)
class Look:
    """Label, colour, line and marker of one formulation, the same in every figure; a marker may be hollow."""

    label: str
    colour: str
    line: str = "-"
    marker: str = ""
    hollow: bool = False

    def keywords(self) -> dict[str, Any]:
        """Return the keyword arguments of `Axes.plot`."""
        words = {"label": self.label, "color": self.colour, "linestyle": self.line, "marker": self.marker}
        return words | ({"markerfacecolor": "none"} if self.hollow else {})


#: The two finite elements.
ELEMENTS: dict[str, Look] = {
    "corotational": Look(label="corotational Euler-Bernoulli", colour=BLACK, marker="s"),
    "reissner": Look(label="Reissner, with shear", colour=GREEN, marker="o"),
}

#: How words of a figure are written, whatever it calls them: a sign for degrees, no unit for a pure number,
#: and a name for the pivot of the paper's Table 1, since reports have tables of their own.
WRITTEN = {" [1]": "", "[deg]": "[°]", "[1e-4]": "[10⁻⁴]", "Table 1": "benchmark pivot"}


#: Stretch forms by colour, measures by line: (stretch, measure) -> look.
STRETCH: dict[tuple[str, str], Look] = {
    ("inextensible", "material"): Look(label="inextensible, material", colour=GREY, marker="s"),
    ("consistent", "spatial"): Look(label="consistent, spatial (paper)", colour=RED, line="--", marker="o"),
    ("consistent", "material"): Look(label="consistent, material", colour=RED, marker="s"),
    ("mixed", "material"): Look(label="mixed, material", colour=BLUE, marker="s"),
}


#: What differs at the width of a page, beside letters of 8 points: 200 pixels an inch.
PRINTED: Any = {
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "figure.titlesize": 9.0,
    "legend.fontsize": 8.0,
    "savefig.dpi": 200,
    "path.simplify_threshold": 0.1,
}


def applied(**more: Any) -> AbstractContextManager[None]:
    """Return the context that draws in the suite's style, with `more` settings of matplotlib."""
    return mpl.rc_context(SETTINGS | more)


def page(width: float, height: float) -> Figure:
    """Return an empty figure of that size [inch], or of the width of a page and lower in proportion.

    So what is printed is as large as it is drawn, letters included.
    """
    share = min(1.0, PAGE_WIDTH / width)
    return Figure(figsize=(share * width, (0.1 + 0.9 * share) * height), layout="constrained")


def rendered(figure: Figure, kind: str, **settings: Any) -> bytes:
    """Return `figure` as "svg", "png" or "pdf", without what differs from one day or machine to the next."""
    stream = io.BytesIO()
    for said in figure.findobj(Text):
        for given, written in WRITTEN.items():
            said.set_text(said.get_text().replace(given, written))
    with applied(**settings):
        figure.savefig(stream, format=kind, metadata={UNSAID[kind]: None})
    return stream.getvalue()


def printed(figure: Figure, kind: str) -> bytes:
    """Return a picture at the width of a page as one of `PICTURES`: the same bytes for the same figure."""
    return rendered(figure, kind, **PRINTED)
