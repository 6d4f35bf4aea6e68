"""How every strip of a design is discretised."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self, TypedDict

from spline_model.basis import Bezier, LegendreModes, singular
from spline_model.effects.elastic import MEASURES
from spline_model.errors import (
    InvalidParameter,
    present,
    require_choice,
    require_count,
    require_not_negative,
)

STRETCH_FORMS = ("mixed", "consistent", "inextensible")
FIRST_POINTS = 6
"""Control points of a design that leaves them open, where no accuracy chooses them."""
PENALTY_STIFFNESS = 10.0
"""Default stiffness of the strains that the axial modes do not see in statics, in EI/L^2.

With control_points - 2 modes the control points of a straight strip slide along it without
resistance and the tangent at rest is singular. Any value from 1e-6 to 10 mends that and moves
the static error by some factors only: 10 is best for n = 5 and 8 and several times the least
for n = 6 and 10 (results of convergence/slide_stiffness); from 100 on the strip begins to lock.
"""


def motion_penalty_stiffness(control_points: int) -> float:
    """Return the default penalty stiffness of a motion: 100 ((n - 2) / 6)^3.

    Parameters
    ----------
    control_points : int
        Number n of one segment.

    Returns
    -------
    float, EI/L^2

    Notes
    -----
    In a motion the sliding has inertia and must be fast against the bending of the strips, or it takes
    part in the vibration. A stiffness that is too large locks; the limit grows with n.

    References
    ----------
    Fitted to the best values for n = 4, 6 and 8; study convergence/slide_stiffness of version 0.1.0.

    Examples
    --------
    >>> motion_penalty_stiffness(8)
    100.0
    """
    return 100.0 * ((control_points - 2) / 6.0) ** 3


class Described(TypedDict, total=False):
    """Keywords of ``Discretisation``, with their types and units."""

    control_points: int | None
    segments: int
    axial_modes: int | None
    measure: str
    stretch: str
    gauss_points: int | None
    penalty_stiffness: float | None


@dataclass(frozen=True, kw_only=True)
class Discretisation:
    """Discretisation of every strip.

    Parameters
    ----------
    control_points : int, default None
        Number n >= 4 of a Bezier curve of degree n - 1. None: as many as the accuracy of an answer needs
        (``spline_model.accuracy``), and FIRST_POINTS if no error is estimated.
    segments : int, default 1
        Number of curves per strip, of equal lengths, that are clamped to frames between them.
    axial_modes : int, default n - 2
        Number m of each curve, from 1 to n - 1.
    measure : str, default "material"
        "material"; with consistent stretch also "spatial" (Eqs 10, 13) or "published" (forces of Eqs 12, 15).
    stretch : str, default "mixed"
        "mixed", "consistent" (Eq 13 by quadrature) or "inextensible".
    gauss_points : int, default degree + 3
        Of each curve. The default follows the primary branch to a half turn; n - 1 points lose it.
    penalty_stiffness : float, EI/L^2, default None
        Of the strains that the axial modes do not see, 0 for none. Default: PENALTY_STIFFNESS in statics and
        ``motion_penalty_stiffness`` in motions and modes (``Mechanism.in_motion``).

    Raises
    ------
    InvalidParameter
        A value outside its range, or one for which the tangent of a straight strip is singular
        (``spline_model.basis.singular``).
    """

    control_points: int | None = None
    segments: int = 1
    axial_modes: int | None = None
    measure: str = "material"
    stretch: str = "mixed"
    gauss_points: int | None = None
    penalty_stiffness: float | None = None

    @classmethod
    def described(cls, **keywords: Any) -> Self:
        """Return the discretisation of keywords, whose former names are accepted with a FutureWarning."""
        values = {present(name): value for name, value in keywords.items()}
        if "measure" in values:
            values["measure"] = present(values["measure"])
        return cls(**values)

    def __post_init__(self) -> None:
        for name, lowest in (("control_points", 4), ("segments", 1), ("gauss_points", 1)):
            if getattr(self, name) is not None:
                require_count(name, getattr(self, name), lowest)
        for name in ("axial_modes", "gauss_points"):
            given = getattr(self, name)
            if self.control_points is None and given is not None:
                raise InvalidParameter(name, given, "control_points beside it, which it goes with")
        require_choice("measure", self.measure, MEASURES)
        require_choice("stretch", self.stretch, STRETCH_FORMS)
        if self.penalty_stiffness is not None:
            require_not_negative("penalty_stiffness", self.penalty_stiffness, "EI/L^2")
        if self.measure != "material" and self.stretch != "consistent":
            only = f"consistent, the only form with measure = {self.measure}"
            raise InvalidParameter("stretch", self.stretch, only)
        if self.axial_modes is not None:
            if self.stretch == "consistent":
                raise InvalidParameter("axial_modes", self.axial_modes, "none with stretch = consistent")
            require_count("axial_modes", self.axial_modes, 1, self.points - 1)
        axial = None if self.stretch == "consistent" else self.modes
        reason = singular(self.spline, self.quadrature, axial, self.slide > 0)
        if reason:
            raise InvalidParameter("discretisation", reason, "a strip whose tangent at rest is regular")

    @property
    def points(self) -> int:
        """Control points that were given, or those of a design that leaves them open."""
        return FIRST_POINTS if self.control_points is None else self.control_points

    @cached_property
    def spline(self) -> Bezier:
        """The basis of the control points."""
        return Bezier(control_points=self.points)

    @cached_property
    def modes(self) -> LegendreModes:
        """The axial-force modes."""
        return LegendreModes(count=self.points - 2 if self.axial_modes is None else self.axial_modes)

    @property
    def slide(self) -> float:
        """The penalty stiffness that was given, or that of statics [EI/L^2]."""
        return PENALTY_STIFFNESS if self.penalty_stiffness is None else self.penalty_stiffness

    @property
    def quadrature(self) -> int:
        """Number of Gauss points of each segment."""
        return self.spline.degree + 3 if self.gauss_points is None else self.gauss_points
