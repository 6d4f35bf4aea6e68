"""Designs to work on: a case file and the parameters that a user may change while the design runs."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from spline_model.modes import natural_frequencies
from studies.answers.critical import critical_load
from studies.answers.models import put
from studies.answers.settings import SplineSettings
from studies.cases.design import SHIPPED, Design, as_toml, design_of, document_of
from studies.cases.document import parsed
from studies.cases.effects import DEFAULT
from studies.cases.keys import GROUND, HINGE, MATERIALS
from studies.cases.mechanism import Body
from studies.cases.problem import FOLDER
from studies.cases.section import refuse_tapers
from studies.errors import BadInput

#: Simulated time of one step over the time scale [s]: four of them make a frame of 25 Hz (section 4.1).
STEP = 0.01
STEPS_A_FRAME = 4
#: Of parameters by their names, in SI units; None where there is none.
Values = Mapping[str, float | None]
#: In EI/L^2: strips that a hand compresses fold their control points at the smaller default.
PENALTY_STIFFNESS = 1000.0
#: Logarithmic sliders reach from a fifth to five times the value of the design.
SPAN = 5.0
#: What a change of units rounds, in parts of a value.
ROUNDED = 1e-12


@dataclass(frozen=True)
class _Parameter:
    """One number of a design that the user sets, between low and high in SI units.

    Attributes:
        unit: in which the user types it; per_si: how many of it make one SI unit.
        scale: of the slider: "log" about the value of the design, "linear" from low to high, or "load".
    """

    name: str
    label: str
    unit: str
    per_si: float
    low: float
    high: float
    scale: str = "log"

    def checked(self, value: object) -> float | None:
        """Return `value` as a float in SI units, None for a strength that is not known; else BadInput."""
        if value is None and self.name == "yield_strength":
            return None
        number = isinstance(value, int | float) and not isinstance(value, bool)
        low, high = self.low * (1.0 - ROUNDED), self.high * (1.0 + ROUNDED)
        if number and low <= value <= high:  # type: ignore[operator]
            return float(value)  # type: ignore[arg-type]
        got = f"{value * self.per_si:g}" if number and math.isfinite(value) else repr(value)  # type: ignore
        low, high = self.low * self.per_si, self.high * self.per_si
        raise BadInput(f"{self.name}: got {got}, expected {low:g} to {high:g} {self.unit}")


_DEGREE = math.radians(1.0)
#: In the order of the fields.
PARAMETERS: dict[str, _Parameter] = {
    row[0]: _Parameter(*row)
    for row in (
        ("length", "strip length", "mm", 1e3, 1e-5, 10.0),
        ("thickness", "strip thickness", "mm", 1e3, 1e-7, 1.0),
        ("width", "strip width", "mm", 1e3, 1e-7, 10.0),
        ("inclination", "inclination", "°", 1.0 / _DEGREE, 5.0 * _DEGREE, 85.0 * _DEGREE, "linear"),
        ("crossing_ratio", "crossing", "of L", 1.0, 0.02, 0.98, "linear"),
        ("youngs_modulus", "Young's modulus", "GPa", 1e-9, 1e4, 1e13),
        ("yield_strength", "yield strength", "MPa", 1e-6, 1e3, 1e12),
        ("density", "density", "kg/m³", 1.0, 0.1, 1e5),
        ("body_mass", "body mass", "g", 1e3, 1e-12, 1e5),
        ("body_moment_of_inertia", "body inertia", "g·cm²", 1e7, 1e-20, 1e5),
        ("relaxation_time", "strip damping", "ms", 1e3, 0.0, 0.05, "linear"),
        ("load", "load, downward", "N", 1.0, -1e9, 1e9, "load"),
        ("time_scale", "time scale", "s/s", 1.0, 1e-7, 1.0),
    )
}
_OF_BODY = {"body_mass": "mass", "body_moment_of_inertia": "moment_of_inertia"}
_OF_PIVOTS = ("length", "inclination", "crossing_ratio")
_OF_SCENE = ("relaxation_time", "load", "time_scale")


@dataclass(frozen=True, kw_only=True, eq=False)
class Piece:
    """One design: a case file, and the values of the parameters that the user sees.

    Attributes:
        name: of the preset that it began from.
        document: the case file, as it is parsed; base: its design.
        values: of the parameters that it has, in SI units.
    """

    name: str
    document: Mapping[str, Any]
    base: Design
    values: Values

    def changed(self, values: Mapping[str, object]) -> "Piece":
        """Return the design with these values, each checked; BadInput for an unknown or a bad one."""
        for name in values:
            if name not in self.values:
                raise BadInput(f"parameter: got {name!r}, expected one of {', '.join(self.values)}")
        every = dict(self.values) | {name: PARAMETERS[name].checked(value) for name, value in values.items()}
        made = replace(self, values=every)
        assert made.design  # or BadInput
        return made

    def like(self, other: "Piece", *but: str) -> bool:
        """Whether a design differs from another in its time scale, and these parameters, alone."""
        same = (self.values[name] == other.values[name] for name in self.values.keys() - {"time_scale", *but})
        return self.document == other.document and all(same)

    @cached_property
    def design(self) -> Design:
        """The design with its load, for any command and either model."""
        base, values = self.base, self.values
        own = {name: value for name, value in values.items() if name not in _OF_SCENE}
        tables: dict[str, dict[str, Any]] = {}
        if values["relaxation_time"]:
            tables["strip_damping"] = {"relaxation_time": values["relaxation_time"]}
        if load := values["load"]:
            tables["applied_force"] = {"force": (0.0, -load), "body": base.body}
        effects = replace(base.effects, names=(*DEFAULT, *tables), tables=tables)
        body = {attribute: own.pop(name) for name, attribute in _OF_BODY.items()}
        made = base.changed(lambda strip: own, **body)
        return replace(made, effects=effects).checked("design")

    @property
    def body(self) -> Body:
        """The body that is held."""
        return _held(self.base)

    def grasped(self, body: str) -> "Piece":
        """Return the same mechanism with another body held, which its case does not turn."""
        names = [each.name for each in self.base.bodies]
        if body not in names:
            raise BadInput(f"body: got {body[:40]!r}, expected one of {', '.join(names)}")
        if body == self.body.name:
            return self
        document = {**self.document, "drive": {"body": body, "increments": self.base.increments}}
        base = _read(document)
        values = dict(self.values) | {name: getattr(_held(base), own) for name, own in _OF_BODY.items()}
        return replace(self, name=OWN, document=document, base=base).changed(values)

    def modelled(self, control_points: int | None = None, *, loaded: bool = True) -> Any:
        """Return the design as the spline model has it; without a number its control points are left open."""
        settings = SplineSettings(control_points=control_points, penalty_stiffness=PENALTY_STIFFNESS)
        piece = self if loaded else self.changed({"load": 0.0})
        return put(piece.design, settings).modelled

    def critical_load(self) -> float | None:
        """Return the load in its own direction at which the design loses its stability [N], None where none
        is found."""
        down = math.copysign(1.0, self.values["load"] or 1.0)
        try:
            return critical_load(self.design, SplineSettings(), direction=-down * math.pi / 2.0).force
        except BadInput:
            return None

    def as_case(self) -> str:
        """Return the text of the case file of the design, which the other commands read."""
        return as_toml(document_of(self.design), ["a design of the interactive environment"])


def _read(document: Mapping[str, Any], where: str = "design.toml") -> Design:
    """Return the design of a case file; BadInput unless bodies on strips, some from the ground, are in it."""
    design = design_of(where, document)
    refuse_tapers(where, design.strips, "the interactive environment")
    if left := [name for name in ("support", "spring") if name in design.effects.names]:
        raise BadInput(f"scene: got a {left[0]}, expected strips and bodies alone")
    hinged = [strip.name for strip in design.strips if HINGE in (strip.root_joint, strip.tip_joint)]
    if hinged:
        raise BadInput(f"strips: got {hinged[0]} with a hinge, expected clamped ends")
    names = {GROUND, *(body.name for body in design.bodies)}
    if odd := [strip.name for strip in design.strips if not {strip.root, strip.tip} <= names]:
        raise BadInput(f"strips: got {odd[0]} with a free end, expected both ends on a body or the ground")
    if not design.bodies or not any(GROUND in (strip.root, strip.tip) for strip in design.strips):
        raise BadInput("bodies: got none on the ground, expected strips from the ground to a body")
    return design


def _held(design: Design) -> Body:
    """Return the body that the case drives."""
    return next((body for body in design.bodies if body.name == design.body), design.bodies[0])


def _of_strips(design: Design) -> dict[str, float | None]:
    """Return the parameters of which all strips have one value."""
    every = [asdict(strip) | ({} if strip.outer_fibre else strip.rectangle()) for strip in design.strips]
    found = {n: every[0][n] for n in PARAMETERS if n in every[0] and len({each[n] for each in every}) == 1}
    section = found.get("width") and found.get("thickness")
    return found if section else {n: v for n, v in found.items() if n not in ("width", "thickness")}


def opened(name: str, document: Mapping[str, Any], known: Values, where: str = "design.toml") -> Piece:
    """Return the design of a parsed case file; its time runs so that it swings once a second.

    Of its scene the damping of the strips acts here, and the upright part of a force on the body.

    Args:
        known: values of parameters that the case leaves open. where: name of the file in errors.

    Raises:
        BadInput: the file cannot be used; one line.
    """
    design = _read(document, where)
    given = design.effects.parameters()
    values: dict[str, float | None] = {
        "relaxation_time": given.get("strip_damping", {}).get("relaxation_time", 0.0),
        "load": -given.get("applied_force", {}).get("force", (0.0, 0.0))[1],
        "time_scale": 1.0,
    }
    values |= {own: getattr(_held(design), attribute) for own, attribute in _OF_BODY.items()}
    values |= _of_strips(design)
    values |= {n: getattr(design, n) for n in _OF_PIVOTS if hasattr(design, n)}
    ordered = {n: values[n] for n in PARAMETERS if n in values} | dict(known)
    piece = Piece(name=name, document=document, base=design, values=ordered)
    if "time_scale" in known:
        return piece.changed({})
    modes = natural_frequencies(piece.modelled(loaded=False), count=1, body=piece.body.name)
    frequency = float(modes.frequency[0])
    return piece.changed({"time_scale": min(1.0, 1.0 / frequency) if frequency > 0.0 else 1.0})


#: Name of the design of one's own, which a command or the page may bring.
OWN = "own"
#: The first presets: title, what is said of it as long as it is not changed, case, and values that the case
#: does not have.
FIRST: dict[str, tuple[str, str, str, Values]] = {
    "polymer": (
        "soft polymer pivot",
        "swings about once a second, in real time",
        "polymer_pivot",
        {"yield_strength": 30e6, "relaxation_time": 2e-3, "time_scale": 1.0},
    ),
    "table-1": (
        "Table 1 of the paper",
        "swings 76 times a second: shown 200 times slower, with steps shorter in proportion",
        "cross_axis_pivot",
        {"yield_strength": 1.2e9, "time_scale": 1.0 / 200.0},
    ),
}
#: Presets that were opened, the first of them the one to begin with; the other cases of the suite by name.
PRESETS = {
    name: opened(name, parsed(FOLDER / f"{case}.toml"), known) for name, (*_, case, known) in FIRST.items()
}


def own(case: Path) -> Piece:
    """Return the design of a case file; BadInput as of `opened`."""
    return opened(OWN, parsed(case), {}, str(case))


def preset(name: str) -> Piece:
    """Return the preset of that name; BadInput lists the names."""
    if name in SHIPPED and name not in PRESETS:
        PRESETS[name] = opened(name, parsed(FOLDER / f"{name}.toml"), {})
    if name not in PRESETS:
        raise BadInput(f"preset: got {name!r}, expected one of {', '.join((*PRESETS, *SHIPPED))}")
    return PRESETS[name]


def chosen(name: str, now: Piece, case: Mapping[str, Any] | None, values: Mapping[str, Any]) -> Piece:
    """Return the preset of that name, or a design of one's own of a `case` file, with other values; without
    a case it is the design `now`, if that has the name."""
    if name == OWN and case is not None:
        known = {"time_scale": values["time_scale"]} if "time_scale" in values else {}
        return opened(name, case, known).changed(values)
    return (now if values and name == now.name else preset(name)).changed(values)


def catalogue() -> dict[str, Any]:
    """Return parameters, presets and what each material that yields sets, for whoever shows them."""
    every: dict[str, dict[str, Any]] = {
        name: {"title": title, "note": note, "values": PRESETS[name].values}
        for name, (title, note, *_) in FIRST.items()
    }
    every |= {name: {"title": name.replace("_", " ")} for name in SHIPPED}
    known = {each["title"].partition(",")[0]: each for each in MATERIALS.values() if "yield_strength" in each}
    return {
        "parameters": [asdict(parameter) for parameter in PARAMETERS.values()],
        "span": SPAN,
        "presets": every,
        "materials": {
            title: {n: v for n, v in given.items() if n in PARAMETERS} for title, given in known.items()
        },
    }
