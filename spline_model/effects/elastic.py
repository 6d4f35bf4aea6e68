"""Strain energies of a strip: bending and stretching."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spline_model.basis import AxialModes
from spline_model.effects.base import Potential
from spline_model.effects.plate import curl_terms, rigidity_of
from spline_model.errors import InvalidParameter
from spline_model.strip.laws import TERMS, curl_factors

Array = NDArray[np.float64]

MEASURES = ("material", "spatial", "published")
"""Measure names; the position is the code that the kernels read."""
CLAMPED_WIDTH = "clamped_width"
ANTICLASTIC = "anticlastic"
CURLING = (CLAMPED_WIDTH, ANTICLASTIC)
"""Names of the effects that bending takes up."""
WIDTHS = (0.005, 4.0)
"""Width over length for which the plate's factors and the profile that has them were seen to be exact."""


class Taper(NamedTuple):
    """A rectangular section whose sides change linearly from the start of a strip to its end.

    width, thickness: those at the end over those at the start [1].
    """

    width: float
    thickness: float

    def side(self, name: str, u: Array) -> Array:
        """Return width or thickness over that at the start [1], at u (P,)."""
        return np.asarray(1.0 + (getattr(self, name) - 1.0) * u)

    def area(self, u: Array) -> Array:
        """Return the area over that at the start [1], at u (P,)."""
        return self.side("width", u) * self.side("thickness", u)

    @property
    def powers(self) -> tuple[float, float, float]:
        """Return the parts of the area over that at the start [1] with 1, u and u^2."""
        b, t = self.width - 1.0, self.thickness - 1.0
        return 1.0, b + t, b * t

    def second_moment(self, u: Array) -> Array:
        """Return the second moment of area over that at the start [1], at u (P,)."""
        return self.area(u) * self.side("thickness", u) ** 2


@dataclass(frozen=True, kw_only=True, slots=True)
class Curl:
    """Bending of a strip whose section curls less than a narrow beam's, which makes it stiffer.

        V = 1/2 int EI kappa^2 (1 - nu^2 f(x) g(s, f b/L)) / (1 - nu^2) ds0          [J]

    with g(s, b/L) the share of the curl that clamps over the whole width leave
    (``spline_model.effects.plate``) and f the one that the curvature of a wide strip leaves,
    x^2 = (3 (1 - nu^2))^(1/2) b^2 kappa / t
    (``spline_model.strip.laws.curl_law``). Each is 1 where its effect is not named. The curl that is left is
    that of two margins, which fill the part f of the width. Clamps hold it like that of a strip of width f b.
    Deviation from a shell between clamps: at most 0.1 % up to b/L = 1; of g alone up to -4.5 %.

    Parameters: poisson_ratio nu; clamped: b/L, or 0; flattening: x^2 / kappa, or 0 [m]; reach: shares of the
    strip's length between which a piece of it lies.
    """

    poisson_ratio: float
    clamped: float
    flattening: float
    reach: tuple[float, float] = (0.0, 1.0)

    def drop(self, degree: int, u: Array) -> Array:
        """Return the part of the plate's rigidity [1] that the curl takes at u (P,) of the piece.

        A curve of that degree can follow it: coefficients (P, TERMS) of f, f^2, ...; zeros where f is 1.
        """
        if not self.flattening:
            return np.zeros((len(u), TERMS))
        return curl_terms(self.clamped, self.poisson_ratio, degree, u.tobytes(), self.reach)


@dataclass(frozen=True, kw_only=True, slots=True)
class StrainEnergy(Potential):
    """An energy of one strip's strain, summed over its Gauss points.

    Parameters: strip, measure (one of MEASURES), gauss_points.
    """

    strip: str
    measure: str = "material"
    gauss_points: int


@dataclass(frozen=True, kw_only=True, slots=True)
class Bending(StrainEnergy):
    """Bending energy of one strip.

    C(u) is the centreline, ' = d/du, J0 = |C0'| the reference speed and
    phi = (x' y'' - y' x'') / |C'|^2 = d(theta)/du the turning of the tangent.

    material    V = 1/2 int EI (phi / J0 - kappa_0 - kappa_n)^2 J0 du              [J]
    spatial     V = 1/2 int EI (phi / |C'| - kappa_0 - kappa_n)^2 |C'| du  (Eq 10) [J]
    published   the spatial energy with the forces of Eq 12: d|C'|/dq
                is neglected. The forces are no gradient, so the work of the drive
                differs from the stored energy. For comparison only.

    Parameters
    ----------
    strip : name of the strip.
    flexural_rigidity : EI >= 0.                                               [N m^2]
    natural_curvature : kappa_n of the stress-free strip, counted from kappa_0 at rest,
        as the natural strain is counted from the length at rest.                  [1/m]
    taper : of the section, whose EI is that at the start; None for a constant one.
    curl : of the section; None for a narrow beam's, whose rigidity is that of the taper.
    roots : length of the root at start and end over the strip's, 0 where there is none: a strip that is cut
        from the same block as its bodies turns in its roots as if it were longer, by 0.416 t at a sharp
        corner (half-plane in plane stress). Their compliance is a peak at the clamp, which is projected
        along the strip (``spline_model.effects.plate``). Neglected: the compliance of a support along and
        across the strip. Source: O'Donnell, J Appl Mech 27 (1960) 461.
    gauss_points : Gauss points.

    Exact for: material: the geometrically exact (extensible, unshearable) elastica.
    spatial differs from it by the order of the axial strain.
    Neglected: shear, cross-section warping, coupling with stretching over the depth.
    Source: paper Eqs 10 to 12; Antman, Nonlinear Problems of Elasticity (2005), ch. 4.
    """

    flexural_rigidity: float
    natural_curvature: float = 0.0
    taper: Taper | None = None
    curl: Curl | None = None
    roots: tuple[float, float] = (0.0, 0.0)

    def rigidity_at(self, degree: int, u: Array) -> Array:
        """Return the rigidity at u (P,) of a strip of that degree [N m^2]."""
        stiffer: Array = np.ones(len(u))
        if self.curl is not None or any(self.roots):
            curl = self.curl or Curl(poisson_ratio=0.0, clamped=0.0, flattening=0.0)
            nu = curl.poisson_ratio
            stiffer = rigidity_of(curl.clamped, nu, degree, u.tobytes(), curl.reach, self.roots)
        if self.taper is not None:
            stiffer = stiffer * self.taper.second_moment(u)
        return self.flexural_rigidity * stiffer

    def with_sides(self, width: complex, thickness: complex) -> Bending:
        """Of sections with sides over the length in these parts of b/L and t/L, complex with a step."""
        ratio: Any = self.curl and self.curl.clamped * width
        low, high = WIDTHS
        if ratio and not low <= ratio.real <= high:
            name = f"width over length of {self.strip}"
            raise InvalidParameter(name, ratio.real, f"{low:g} to {high:g}")
        roots: Any = tuple(root * thickness for root in self.roots)
        return replace(self, curl=self.curl and replace(self.curl, clamped=ratio), roots=roots)

    def moment_at(self, strain: Array, degree: int, u: Array) -> Array:
        """Return bending moments (P, ...) [N m] at u (P,) of curvatures from the stress-free ones [1/m]."""
        moment = self.rigidity_at(degree, u)[:, None] * strain
        if self.curl is not None and self.curl.flattening > 0.0:
            moment *= curl_factors(strain, self.curl.drop(degree, u), self.curl.flattening)[1]
        return np.asarray(moment)


@dataclass(frozen=True, kw_only=True, slots=True)
class Stretching(StrainEnergy):
    """Stretching energy of one strip by quadrature of the strain: the paper's form, which locks.

    With the axial strain eps = |C'| / J0 - 1 (Eq 14)

    material    V = 1/2 int EA eps^2 J0 du                                         [J]
    spatial     V = 1/2 int EA eps^2 |C'| du                           (Eq 13)     [J]
    published   the spatial energy with the forces of Eq 15.

    Parameters: strip, axial_rigidity EA >= 0 [N], natural_strain eps_0 of the stress-free
    strip against the one at rest, gauss_points. eps is less by eps_0.

    Exact for: uniform stretch. A curve of few control points cannot bend far without
    stretching: with n = 4 it is several times too stiff at a quarter turn (membrane
    locking). ``MixedStretching`` is the cure.
    Source: paper Eqs 13 to 15.
    """

    axial_rigidity: float
    natural_strain: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class MixedStretching(StrainEnergy):
    """Stretching of one strip with an axial force of its own (Hellinger-Reissner).

    N(u) = sum of a_k P_k(u) is an unknown and

        V = int (N eps - 1/2 c N^2) W du,    c = 1 / EA                            [J]

    is made stationary in it (W = J0, the material measure). The axial strain
    is thereby projected on the modes P_k, which removes the locking; c = 0 is the
    inextensible strip, with N the reaction that keeps its length.

    Parameters
    ----------
    strip : name of the strip.
    axial_compliance : c = 1 / EA >= 0, that at the start of a tapered strip.    [1/N]
    taper : of the section; None for a constant one.
    modes : the modes P_k; control_points - 2 of them is the locking-free choice.
    natural_strain : eps_0 of the stress-free strip against the one at rest; eps is less by it.

    Exact for: uniform stretch, and N in the span of the modes.
    Source: Reissner, On a variational theorem in elasticity, J Math Phys 29 (1950) 90.
    """

    axial_compliance: float
    modes: AxialModes
    natural_strain: float = 0.0
    taper: Taper | None = None

    def compliance_at(self, u: Array) -> Any:
        """Return the axial compliance at u (P,) [1/N]."""
        return self.axial_compliance if self.taper is None else self.axial_compliance / self.taper.area(u)
