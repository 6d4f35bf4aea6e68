"""Designs to start from, and the parameters that a user may change while they run."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeGuard

from spline_model.modes import natural_frequencies
from studies.cases.design import as_toml, document_of
from studies.cases.effects import Effects
from studies.cases.keys import MATERIALS
from studies.cases.problem import Problem, named_case
from studies.cases.section import of_sides
from studies.errors import BadInput
from studies.interactive.design import GIVEN, POISSON_RATIO, build, scene

#: Simulated time of one step over the time scale [s]: four of them make a frame of 25 Hz (section 4.1).
STEP = 0.01
STEPS_A_FRAME = 4


def finite(value: object) -> TypeGuard[float]:
    """Return whether a value is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


@dataclass(frozen=True)
class _Parameter:
    """One number of a design that the user sets, between low and high in SI units.

    Attributes:
        unit: what the user types it in, and how many of it make one SI unit.
        logarithmic: whether a slider should run over its decades.
        least: above nought, from where on it should to either side.
    """

    name: str
    label: str
    unit: str
    per_si: float
    low: float
    high: float
    logarithmic: bool = False
    least: float = 0.0

    def checked(self, value: object) -> float:
        """Return `value` as a float in SI units.

        Raises:
            BadInput: not a finite number between low and high; one line.
        """
        if finite(value) and self.low <= value <= self.high:
            return float(value)
        low, high = self.low * self.per_si, self.high * self.per_si
        got = f"{value * self.per_si:g}" if finite(value) else repr(value)
        raise BadInput(f"{self.name}: got {got}, expected {low:g} to {high:g} {self.unit}")


_DEGREE = math.radians(1.0)
#: In the order of the fields; whether the slider is logarithmic, and its least, where that is needed.
PARAMETERS: dict[str, _Parameter] = {
    row[0]: _Parameter(*row)
    for row in (
        ("length", "strip length", "mm", 1e3, 0.04, 0.12),
        ("thickness", "strip thickness", "mm", 1e3, 1e-4, 8e-3, True),
        ("width", "strip width", "mm", 1e3, 2e-3, 0.05),
        ("inclination", "inclination", "°", 1.0 / _DEGREE, 25.0 * _DEGREE, 65.0 * _DEGREE),
        ("crossing_ratio", "crossing", "of L", 1.0, 0.2, 0.8),
        ("youngs_modulus", "Young's modulus", "GPa", 1e-9, 1e7, 5e11, True),
        ("yield_strength", "yield strength", "MPa", 1e-6, 1e6, 5e9, True),
        ("density", "density", "kg/m³", 1.0, 100.0, 2e4, True),
        ("body_mass", "body mass", "g", 1e3, 1e-3, 2.0, True),
        ("body_moment_of_inertia", "body inertia", "g·cm²", 1e7, 1e-7, 0.1, True),
        ("relaxation_time", "strip damping", "ms", 1e3, 0.0, 0.05),
        ("load", "load, downward", "N", 1.0, -5e4, 5e4, False, 1e-3),
        ("time_scale", "time scale", "s/s", 1.0, 1e-4, 1.0, True),
    )
}


@dataclass(frozen=True, kw_only=True)
class _Preset:
    """A design by the name of its case or its file, what the case leaves open, and how fast its time runs.

    Attributes:
        yield_strength: of the material [Pa], a choice; relaxation_time: of the strips' damping [s], a choice.
        load: on the body's centre, downward [N].
        time_scale: simulated seconds in one second; note: why, in a sentence.
    """

    case: str
    title: str
    yield_strength: float
    relaxation_time: float
    time_scale: float
    note: str
    load: float = 0.0

    def values(self) -> dict[str, float]:
        """Return all parameters of the design by name, in SI units."""
        problem = named_case(self.case)
        given = problem.rectangle() | asdict(self)
        return {name: given[name] if name in given else float(getattr(problem, name)) for name in PARAMETERS}


PRESETS: dict[str, _Preset] = {
    "polymer": _Preset(
        case="polymer_pivot",
        title="soft polymer pivot",
        yield_strength=30e6,
        relaxation_time=2e-3,
        time_scale=1.0,
        note="swings about once a second, in real time",
    ),
    "table-1": _Preset(
        case="cross_axis_pivot",
        title="Table 1 of the paper",
        yield_strength=1.2e9,
        relaxation_time=0.0,
        time_scale=1.0 / 200.0,
        note="swings 76 times a second: shown 200 times slower, with steps shorter in proportion",
    ),
}


#: Name of the design of one's own, which a command may bring.
OWN = "own"


def own(case: str) -> _Preset:
    """Return the design of a case file as a preset; its time runs so that it swings once a second.

    Of its scene the damping of the strips acts here and the upright part of a force on the body, nothing else
    beside what always does.

    Raises:
        BadInput: the file cannot be used, or a number of the design is beyond what a slider may set.
    """
    problem = named_case(case)
    given = problem.effects.parameters()
    strength = problem.yield_strength
    made = _Preset(
        case=case,
        title=Path(case).stem.replace("_", " "),
        yield_strength=PARAMETERS["yield_strength"].high if strength is None else strength,
        relaxation_time=given.get("strip_damping", {}).get("relaxation_time", 0.0),
        load=-given.get("applied_force", {}).get("force", (0.0, 0.0))[1],
        time_scale=1.0,
        note="of one's own" if strength is not None else "of one's own; its yield strength is not known",
    )
    try:
        values = checked(made.values())
    except BadInput as error:
        raise BadInput(f"{case}: {error}") from None
    frequency = float(natural_frequencies(build(values), rotation=0.0, count=1).frequency[0])
    slow = PARAMETERS["time_scale"]
    return replace(made, time_scale=min(max(1.0 / frequency, slow.low), slow.high))


def values_of(text: str) -> dict[str, float]:
    """Return the parameters of a design that is given as the text of a case file; BadInput as of `own`."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "design.toml"
        path.write_text(text, encoding="utf-8")
        try:
            return own(str(path)).values()
        except BadInput as error:
            raise BadInput(str(error).replace(f"{path}", path.name)) from None


def as_case(values: Mapping[str, float]) -> str:
    """Return the text of the case file of a design, which the other commands read."""
    names, tables = scene(values)
    given: dict[str, Any] = {name: values[name] for name in (*GIVEN, "yield_strength")}
    problem = Problem(
        **given,
        **of_sides(values["width"], values["thickness"]),
        poisson_ratio=POISSON_RATIO,
        rotation=math.radians(45),
        increments=45,
        effects=Effects(names=names, tables=tables),
    )
    return as_toml(document_of(problem), ["a design of the interactive environment"])


def checked(values: Mapping[str, object]) -> dict[str, float]:
    """Return all parameters in SI units, each checked; BadInput names an unknown, missing or bad one."""
    for name in values:
        if name not in PARAMETERS:
            raise BadInput(f"parameter: got {name!r}, expected one of {', '.join(PARAMETERS)}")
    for name in PARAMETERS:
        if name not in values:
            raise BadInput(f"parameter: got no {name}, expected all of {', '.join(PARAMETERS)}")
    return {name: PARAMETERS[name].checked(values[name]) for name in PARAMETERS}


def preset(name: object) -> _Preset:
    """Return the preset of that name; BadInput lists the names."""
    if name == OWN and OWN not in PRESETS:
        raise BadInput(f"preset: got {OWN!r}, expected its case file beside the command")
    if not isinstance(name, str) or name not in PRESETS:
        raise BadInput(f"preset: got {name!r}, expected one of {', '.join(PRESETS)}")
    return PRESETS[name]


def catalogue() -> dict[str, Any]:
    """Return parameters, presets and what each material that yields sets, for whoever shows them."""
    designs = {name: {"title": p.title, "note": p.note, "values": p.values()} for name, p in PRESETS.items()}
    known = {each["title"].partition(",")[0]: each for each in MATERIALS.values() if "yield_strength" in each}
    return {
        "parameters": [asdict(parameter) for parameter in PARAMETERS.values()],
        "presets": designs,
        "materials": {
            title: {n: v for n, v in given.items() if n in PARAMETERS} for title, given in known.items()
        },
    }
