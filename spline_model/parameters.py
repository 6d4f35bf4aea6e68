"""Design parameters of a mechanism by name, and the numbers that tell many designs of it apart.

The numbers may be complex: a step of ``STEP`` along the imaginary axis gives a derivative without the
difference that loses digits (Squire and Trapp, SIAM Review 40 (1998) 110).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from spline_model.design import Design
from spline_model.effects import Clamp
from spline_model.errors import InvalidParameter
from spline_model.mechanism import Mechanism
from spline_model.pivot import ends_at_rest
from spline_model.reduced.numbers import Numbers
from spline_model.scene import Scene

Array = NDArray[Any]
"""Real, or complex with a step."""

SHAPE = ("length", "inclination", "crossing_ratio")
MATERIAL = ("area", "second_moment_of_area", "youngs_modulus")
KEYWORDS = (*SHAPE, *MATERIAL)
"""Keywords of ``cross_axis_pivot`` that the statics of both strips alike depends on. Of the others density
and the inertias do not enter, but by weight, nor Poisson's ratio, but by the section's curl;
``centre_offset`` and ``orientation`` move what is reported rigidly."""

SECTION = ("thickness", "width")
"""Sides of a rectangular section h x b, A = b h and I = b h^3 / 12, in place of A and I."""

POINTS = ("start_x", "start_y", "end_x", "end_y")
CENTRES = ("centre_x", "centre_y")
"""Numbers of one strip and of one body. Those of section and material are of all strips alike, in any
mechanism; a name before a dot picks one strip, "strip_1.thickness", and then also its ends' places at rest,
"strip_1.end_x", or a body's centre, "body.centre_y"."""

PLACED = (*SHAPE, "orientation")
"""Numbers that place the strips of a pivot together."""
BELOW = {"inclination": (np.pi / 2, "0 to pi/2"), "crossing_ratio": (1.0, "0 to 1")}
"""Limits of those that have one, and how a message calls their range."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Given:
    """D designs of S strips and B bodies: ends (D, S, 2, 2) at rest, root and tip, and centres (D, B, 2) [m];
    section (D, S, 3): area [m^2], second moment [m^4] and modulus [Pa].
    """

    ends: Array
    centres: Array
    section: Array

    @classmethod
    def of(cls, design: Design, count: int = 1, kind: type = float) -> Given:
        """One design, so many times, as numbers of a kind."""
        strips, bodies = design.strips, design.bodies
        for strip in strips:
            if strip.taper is not None:
                expected = "none, a constant section, for designs by their numbers"
                raise InvalidParameter(f"taper of {strip.name}", tuple(strip.taper), expected)
        section = [(s.area, s.second_moment_of_area, s.youngs_modulus) for s in strips]
        return cls(
            ends=np.array([[(s.start, s.end) for s in strips]] * count, dtype=kind),
            centres=np.array([[body.centre for body in bodies]] * count, dtype=kind).reshape(count, -1, 2),
            section=np.array([section] * count, dtype=kind),
        )

    @property
    def chord(self) -> Array:
        """From root to tip (D, S, 2) [m]."""
        return self.ends[:, :, 1] - self.ends[:, :, 0]

    @property
    def span(self) -> Array:
        """Length of the chord (D, S) [m]."""
        return np.asarray(np.sqrt(np.sum(self.chord**2, axis=-1)))

    @property
    def rigidity(self) -> Array:
        """EI (D, S) [N m^2]."""
        return np.asarray(self.section[..., 1] * self.section[..., 2])

    @property
    def sides(self) -> Array:
        """Thickness and width of the rectangle with that section (D, S, 2) [m]."""
        thickness = np.sqrt(12.0 * self.section[..., 1] / self.section[..., 0])
        return np.stack((thickness, self.section[..., 0] / thickness), axis=-1)

    @property
    def compliance(self) -> Array:
        """Axial compliance of each strip over the longest strip and the largest rigidity, (D, S) [1]."""
        stiffness = self.section[..., 0] * self.section[..., 2] * self.span.max(axis=1)[:, None] ** 2
        return np.asarray(self.rigidity.max(axis=1)[:, None] / stiffness)

    @property
    def crossing(self) -> Array:
        """Where the chords of the first two strips cross (D, 2) [m]."""
        (a, b), apart = np.moveaxis(self.chord[:, :2], 1, 0), self.ends[:, 1, 0] - self.ends[:, 0, 0]
        share = cross(apart, b) / cross(a, b)
        return np.asarray(self.ends[:, 0, 0] + share[:, None] * a)

    def rows(self, kept: NDArray[np.int64]) -> Given:
        """Return some of the D designs, those of the numbers ``kept`` (R,), in SI units."""
        return Given(ends=self.ends[kept], centres=self.centres[kept], section=self.section[kept])

    def numbers(self, base: Given, scene: Scene) -> Numbers:
        """Return what tells these designs from a scene whose own numbers are ``base``.

        Strips keep their form at rest: they are turned and lengthened with their chords, and hinges at their
        ends and free ends go along. What is at a point of the ground stays there.
        """
        own, square = Numbers.of(scene), np.sum(base.chord**2, axis=-1)
        c, s = np.sum(base.chord * self.chord, axis=-1) / square, cross(base.chord, self.chord) / square
        x, y = np.moveaxis(own.points - base.ends[:, :, None, 0], -1, 0)
        c, s = c[..., None], s[..., None]
        points = np.stack((c * x - s * y, s * x + c * y), axis=-1) + self.ends[:, :, None, 0]
        centres = np.repeat(own.centres, len(points), axis=0).astype(points.dtype)
        centres[:, : self.centres.shape[1]] = self.centres
        names, strips = [body.name for body in scene.bodies], [strip.name for strip in scene.strips]
        for clamp in scene.of(Clamp):
            if clamp.to in names[self.centres.shape[1] :]:
                end = self.ends[:, strips.index(clamp.strip), int(clamp.end == "end")]
                centres[:, names.index(clamp.to)] = end
        thickness, width = np.moveaxis(self.sides / base.sides, -1, 0)
        area, _, modulus = np.moveaxis(self.section / base.section, -1, 0)
        return Numbers(
            points=points,
            centres=centres,
            longer=self.span / base.span,
            width=width,
            thickness=thickness,
            area=area,
            bending=self.rigidity / base.rigidity,
            axial=area * modulus,
        )

    def put(self, asked: Mechanism, columns: Mapping[str, Array], own: float = 0.0) -> None:
        """Set the numbers of those names to ``own`` times themselves plus columns (D,) [SI units].

        Where both strips of a pivot change alike, its body goes along.
        """
        left = dict(columns)
        if asked.placing and not left.keys().isdisjoint(PLACED):
            shape: dict[str, Any] = dict(asked.placing)
            shape |= {name: left.pop(name) + own * shape[name] for name in PLACED if name in left}
            arm = self.centres - self.ends[:, None, :, 1].mean(axis=2)
            self.ends[...] = _ends(**shape)
            self.centres[...] = self.ends[:, None, :, 1].mean(axis=2) + arm
        for name, column in left.items():
            part, place = _place_of(asked.design, name)
            if part != "sides":
                numbers = getattr(self, part)
                numbers[place] = (own * numbers[place].T + column).T
                continue
            sides, strips = self.sides, place[1]
            sides[place] = (own * sides[place].T + column).T
            h, b = np.moveaxis(sides[:, strips], -1, 0)
            self.section[:, strips, 0], self.section[:, strips, 1] = b * h, b * h**3 / 12.0


def _place_of(design: Design, name: str) -> tuple[str, tuple[Any, ...]]:
    """Where the numbers of that name stand in ``Given``, or in its "sides"; () for no name of the design."""
    owner, _, field = name.rpartition(".")
    strips = [i for i, strip in enumerate(design.strips) if owner in ("", strip.name)]
    bodies = [i for i, body in enumerate(design.bodies) if owner == body.name]
    for part, names in (("section", MATERIAL), ("sides", SECTION)):
        if field in names and strips:
            return part, (slice(None), strips, names.index(field))
    if field in POINTS and owner and strips and design.strips[strips[0]].rise == 0.0:
        return "ends", (slice(None), strips[0], *divmod(POINTS.index(field), 2))
    if field in CENTRES and bodies:
        return "centres", (slice(None), bodies[0], CENTRES.index(field))
    return "", ()


def require_names(asked: Mechanism, names: Sequence[str], argument: str) -> None:
    """Check that the design has a number of each of these names.

    Raises InvalidParameter, which names the argument, for a name without one.
    """
    shape = PLACED if asked.placing else ()
    for name in names:
        if name not in shape and not _place_of(asked.design, name)[0]:
            one = f"STRIP.{', STRIP.'.join(POINTS)} of a straight strip or BODY.{', BODY.'.join(CENTRES)}"
            known = ", ".join((*shape, *MATERIAL, *SECTION))
            raise InvalidParameter(argument, name, f"one of {known}, {one}")


def varied(mechanism: Mechanism, values: Mapping[str, ArrayLike], count: int = 1) -> Given:
    """Return the designs of a mechanism whose numbers are replaced by ``values`` (D,) [SI], by parameter
    name.

    Raises
    ------
    InvalidParameter
        An unknown parameter, or a value outside its range.
    """
    require_names(mechanism, list(values), "values")
    columns = {name: np.atleast_1d(np.asarray(value, dtype=float)) for name, value in values.items()}
    count = max([count, *(len(column) for column in columns.values())])
    given = Given.of(mechanism.design, count)
    for name in values:
        columns[name] = column = one_each(name, columns[name], count)
        if name.rpartition(".")[2] in (*SHAPE, *MATERIAL, *SECTION):
            below, expected = BELOW.get(name, (np.inf, "a finite number > 0"))
            _refuse(name, column, (column > 0.0) & (column < below), expected)
    given.put(mechanism, columns)
    return given


def _ends(**shape: Any) -> Array:
    """``ends_at_rest`` of pivots (D,) as an array (D, 2, 2, 2), or of one as (1, 2, 2, 2)."""
    numbers = [n for strip in ends_at_rest(**shape) for point in strip for n in point]
    return np.stack(np.broadcast_arrays(*numbers), axis=-1).reshape(-1, 2, 2, 2)


def _refuse(name: str, column: Array, good: NDArray[np.bool_], expected: str) -> None:
    """Refuse the first design whose number is not good, or not finite."""
    bad = np.flatnonzero(~(good & np.isfinite(column)))
    if bad.size:
        raise InvalidParameter(f"design {bad[0]}: {name}", float(column[bad[0]]), expected)


def one_each(name: str, given: ArrayLike, count: int, above: float = -np.inf) -> Array:
    """Return a number (1,) for all designs, or one for each (D,), in its own unit.

    Raises
    ------
    InvalidParameter
        Another number of values, or one that is not above ``above``.
    """
    values = np.atleast_1d(np.asarray(given, dtype=float))
    if values.shape not in ((1,), (count,)):
        raise InvalidParameter(name, values.shape, f"a number or an array of {count}, one a design")
    bound = "" if above == -np.inf else f" > {above:g}"
    _refuse(name, values, values > above, f"a finite number{bound}")
    return values


def cross(a: Array, b: Array) -> Array:
    """Return the cross product a x b (...) of plane vectors (..., 2), in the product of their units."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])
