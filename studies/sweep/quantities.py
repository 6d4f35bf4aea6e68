"""What a sweep can store of each design: names with units, what they mean, how they follow from an answer.

Answers come for D designs side by side; arrays over the path have shape (D, S).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from studies.answers import validity
from studies.answers.motion import Motion, Spectrum
from studies.answers.validity import Strip
from studies.kinds import Array


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A column of the table: what it means, and its value for each design from their answer, (D,).

    `usual`: stored where the file does not say what is.
    """

    meaning: str
    of: Callable[[Any], Any]
    usual: bool = True
    whole: bool = False


@dataclass(frozen=True, kw_only=True)
class Paths:
    """Static paths of D designs over S states in the order of the rotation; `rest` is the unloaded one.

    torque [N m]; stiffness [N m/rad]; shift (D, S, 2) of the crossing point [m]; stress the largest of the
    strips [Pa]; energy of strain [J]; defect of the moments [1]; unstable (D,) states, -1 where the model
    cannot tell; iterations (D,) of Newton; places (D, S, 3) of the bodies by name [m, m, rad];
    strips with the most that happens to them, arrays (D,); effects that were assembled.
    """

    rest: int
    rotation: Array
    torque: Array
    stiffness: Array
    stress: Array
    energy: Array
    defect: Array
    unstable: NDArray[np.int64]
    iterations: NDArray[np.int64]
    shift: Array
    places: Mapping[str, Array]
    strips: tuple[Strip, ...]
    effects: tuple[str, ...]


def _shift(paths: Paths) -> Array:
    return np.hypot(paths.shift[..., 0], paths.shift[..., 1])


def _most(ratio: Callable[[Strip], Any]) -> Callable[[Paths], Array]:
    """Return what takes the largest of a ratio over the strips."""
    return lambda paths: np.max([np.asarray(ratio(strip), dtype=float) for strip in paths.strips], axis=0)


#: What an answer is worth; the curvature is taken as high as the strain allows.
VALIDITY = {
    "width_ratio": Quantity(meaning="b/L, largest of the strips", of=_most(lambda s: s.width_ratio)),
    "curvature_ratio": Quantity(
        meaning="b^2/(R t), largest of strips and states, at most", of=_most(lambda s: s.curvature_ratio)
    ),
    "thickness_ratio": Quantity(meaning="t/L, largest of the strips", of=_most(lambda s: s.thickness_ratio)),
    "strain_max": Quantity(meaning="largest strain of strips and states", of=_most(lambda s: s.strain)),
    "outside": Quantity(
        meaning="limits of the model that the answer lies beyond",
        of=lambda p: validity.passed(p.strips, p.effects),
        whole=True,
    ),
}
PATH = {
    "rotation_rad": Quantity(meaning="rotation at the end", of=lambda p: p.rotation[:, -1]),
    "torque_Nm": Quantity(meaning="driving torque at the end", of=lambda p: p.torque[:, -1]),
    "stiffness_rest_Nm_per_rad": Quantity(
        meaning="rotational stiffness at rest", of=lambda p: p.stiffness[:, p.rest]
    ),
    "stiffness_end_Nm_per_rad": Quantity(
        meaning="rotational stiffness at the end", of=lambda p: p.stiffness[:, -1]
    ),
    "stiffness_variation": Quantity(
        meaning="largest less smallest stiffness of the path, over that at rest",
        of=lambda p: np.ptp(p.stiffness, axis=1) / np.abs(p.stiffness[:, p.rest]),
    ),
    "stress_max_Pa": Quantity(
        meaning="largest |N|/A + |M| d/(2 I) of all strips and states", of=lambda p: p.stress.max(axis=1)
    ),
    "energy_J": Quantity(meaning="strain energy at the end", of=lambda p: p.energy[:, -1]),
    "moment_defect": Quantity(
        meaning="largest relative imbalance of the strips' moments, of a spline",
        of=lambda p: p.defect.max(axis=1),
    ),
    "iterations": Quantity(meaning="Newton iterations", of=lambda p: p.iterations, whole=True),
    "unstable_states": Quantity(
        meaning="states of the path that are not stable, -1 where the model does not say",
        of=lambda p: p.unstable,
        usual=False,
        whole=True,
    ),
    "torque_max_Nm": Quantity(
        meaning="largest magnitude of the driving torque",
        of=lambda p: np.abs(p.torque).max(axis=1),
        usual=False,
    ),
    "stress_end_Pa": Quantity(
        meaning="largest stress of the strips at the end", of=lambda p: p.stress[:, -1], usual=False
    ),
    **VALIDITY,
}
SHIFT = {
    "centre_shift_end_m": Quantity(
        meaning="displacement of the body's point at the strips' crossing, at the end",
        of=lambda p: _shift(p)[:, -1],
    ),
    "centre_shift_max_m": Quantity(
        meaning="largest displacement of that point", of=lambda p: _shift(p).max(axis=1)
    ),
    "centre_shift_end_x_m": Quantity(
        meaning="x of the displacement at the end", of=lambda p: p.shift[:, -1, 0], usual=False
    ),
    "centre_shift_end_y_m": Quantity(
        meaning="y of the displacement at the end", of=lambda p: p.shift[:, -1, 1], usual=False
    ),
}


def _place(body: str, axis: int) -> Callable[[Paths], Array]:
    def of(paths: Paths) -> Array:
        return np.asarray(paths.places[body][:, -1, axis])

    return of


def _of_bodies(names: list[str]) -> dict[str, Quantity]:
    """Return the places of bodies at the end of a path."""
    return {
        f"{body}_{part}": Quantity(meaning=f"{part} of {body} at the end", of=_place(body, axis))
        for body in names
        for axis, part in enumerate(("x_m", "y_m", "rotation_rad"))
    }


def _of_modes(count: int) -> dict[str, Quantity]:
    """Return the frequencies of the lowest modes; negative where the state is unstable."""

    def frequency(mode: int) -> Callable[[Spectrum], float]:
        return lambda found: found.frequency[mode] if mode < len(found.frequency) else np.nan

    return {
        f"frequency_{mode + 1}_Hz": Quantity(meaning=f"frequency of mode {mode + 1}", of=frequency(mode))
        for mode in range(count)
    }


RELEASE = {
    "frequency_Hz": Quantity(meaning="frequency of the swing", of=lambda m: m.frequency),
    "rotation_min_rad": Quantity(meaning="smallest rotation", of=lambda m: m.rotation.min()),
    "rotation_max_rad": Quantity(meaning="largest rotation", of=lambda m: m.rotation.max()),
    "kinetic_max_J": Quantity(meaning="largest kinetic energy", of=lambda m: m.kinetic_energy.max()),
    "energy_error": Quantity(meaning="largest relative error of the energy", of=lambda m: m.energy_error),
    "records": Quantity(meaning="records of the motion", of=lambda m: len(m.time), usual=False, whole=True),
}
"""Of a release: functions of a `Motion`."""

Answer = Paths | Spectrum | Motion


def known(kind: str, *, bodies: list[str] | None, count: int) -> dict[str, Quantity]:
    """Return the quantities of an analysis; `bodies` of a mechanism, None for a pivot; `count` of modes."""
    if kind == "modes":
        return _of_modes(count)
    if kind == "release":
        return RELEASE
    return PATH | (SHIFT if bodies is None else _of_bodies(bodies))


def values(found: Mapping[str, Quantity], names: tuple[str, ...], answer: Answer) -> dict[str, Array]:
    """Return the named quantities of an answer, (D,) each."""
    return {name: np.atleast_1d(np.asarray(found[name].of(answer))) for name in names}
