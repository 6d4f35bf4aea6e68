"""Other pivots as three-dimensional solids: spring steel, a wide strip, and supports cut from one block.

The beam models have the effects that stand for the width of the strips and for the supports.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from studies.cases.problem import TABLE_1, Problem, named_case
from studies.cases.section import of_sides
from studies.engine import Answer, Part, Study, Tables
from studies.published.solids import (
    COARSEST,
    FINE,
    ORDER,
    PLATES,
    SINGULAR,
    beam_states,
    deviation,
    limits_of,
    meshed,
    states_of,
    turned,
)
from studies.record.marks import Level
from studies.record.panels import ROTATION, Axis, Curves, Panel, sheet
from studies.record.style import BLACK, BLUE, GREEN, ORANGE, RED, Look

STEEL = "spring_steel_pivot"
#: First rotations, which Newton's method needs, and the distance of the others [deg].
FIRST, STEP = (1.0, 2.5, 5.0), 10.0
FINENESSES = (2, 3, 4)
SUPPORTS = "root_compliance"


@dataclass(frozen=True, kw_only=True)
class Design:
    """A pivot as solids.

    Attributes:
        case: name of the case. width: other than that of the case [m]; 0 for its own.
        blocks: sides of the blocks of the supports over the thickness; 0 for rigid end faces.
        states: rotations that are compared. orders: of the error of the mesh; as of `limits_of`. At the
            corners between strip and block the stress is more singular than at a rigid face.
    """

    case: str
    width: float = 0.0
    blocks: float = 0.0
    states: int = 6
    orders: tuple[float, float] = (ORDER, SINGULAR)

    @property
    def pivot(self) -> Problem:
        """The pivot with the compared rotations."""
        own = named_case(self.case)
        width, thickness = self.width or float(own.width or 0.0), float(own.thickness or 0.0)
        sides = {"width": width, **of_sides(width, thickness)} if self.width else {}
        return replace(own, rotation=np.radians(STEP * self.states), increments=self.states, **sides)


DESIGNS = {
    "spring steel": Design(case=STEEL),
    "spring steel, b/L = 1": Design(case=STEEL, width=0.08),
    "benchmark, one block": Design(case=TABLE_1, blocks=3.0, states=3, orders=(SINGULAR, 1.0)),
}
#: Beam models: the effects that are added, and the look.
MODELS: dict[str, tuple[tuple[str, ...], Look]] = {
    "beam": ((), Look(label="beam", colour=BLUE)),
    "lateral clamping": (PLATES[:1], Look(label="lateral clamping", colour=GREEN, line="--")),
    "anticlastic": (PLATES[1:], Look(label="anticlastic stiffening", colour=ORANGE, line="-.")),
    "both plate effects": (PLATES, Look(label="both plate effects", colour=RED, line=":")),
    "support compliance": ((SUPPORTS,), Look(label="support compliance", colour=BLACK, line="-.")),
    "supports and lateral clamping": (
        (SUPPORTS, *PLATES[:1]),
        Look(label="supports and lateral clamping", colour=BLACK, line="--"),
    ),
}


def _mesh(name: str, fineness: int) -> Answer:
    """Return the states of one mesh."""
    design, pivot = DESIGNS[name], DESIGNS[name].pivot
    mesh = (COARSEST["serendipity"] * fineness, fineness, fineness)
    strip = meshed(pivot, mesh, support=design.blocks * float(pivot.thickness or 0.0))
    path = turned(pivot, strip, (*FIRST, *(STEP * k for k in range(1, design.states + 1))))
    return {"meshes": states_of(path, design=name, fineness=fineness)}


def _beam(name: str, model: str) -> Answer:
    """Return the states of a beam model."""
    design, effects = DESIGNS[name], MODELS[model][0]
    return {"beams": beam_states(design.pivot, FINE, effects, design.states, design=name, model=model)}


def _models() -> Iterator[tuple[str, str]]:
    """Yield designs with the models that they are compared with: supports of blocks alone deform."""
    for name, design in DESIGNS.items():
        yield from ((name, model) for model in MODELS if design.blocks or SUPPORTS not in MODELS[model][0])


def _states(tables: Tables) -> Iterator[pd.DataFrame]:
    """Yield the states of solids and beams of each design, with the uncertainty of the solids and the
    deviations from them."""
    for name, design in DESIGNS.items():
        meshes, beams = (tables[each][tables[each]["design"] == name] for each in ("meshes", "beams"))
        solid = limits_of(meshes, design.orders, design=name, model="solid").iloc[len(FIRST) :]
        for rows in (solid, *(own for _, own in beams.groupby("model", sort=False))):
            own = rows[["design", "model", "torque_Nm", "com_x_m", "com_y_m"]].reset_index(drop=True)
            yield own.join(deviation(rows, solid))


def _figure(tables: Tables) -> Figure:
    """Draw the deviations of the torque of each design."""
    rows = tables["states"].assign(percent=lambda table: 100.0 * table["error_torque"])
    looks, exact = {name: look for name, (_, look) in MODELS.items()}, Level(0.0, colour=BLACK)
    axis = Axis("percent", "deviation of the torque [%]")
    panels = [
        Panel(ROTATION, axis, (Curves(rows[rows["design"] == name], looks, by="model"), exact), title=name)
        for name in DESIGNS
    ]
    return sheet(9.5, 3.4, [panels], legend=3)


STUDY = Study(
    cases=(TABLE_1, STEEL),
    parts=(
        Part(
            at=lambda: [(name, fineness) for fineness in reversed(FINENESSES) for name in DESIGNS], ask=_mesh
        ),
        Part(at=lambda: list(_models()), ask=_beam),
    ),
    made={"states": lambda tables: pd.concat(_states(tables))},
    figures={"solid_designs": _figure},
)
