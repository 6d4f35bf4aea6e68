"""The neutral answer to a static path."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from studies.answers.answer import Answer, centre_shift, own, read_only
from studies.answers.models import Asked
from studies.answers.quantities import stress_of
from studies.kinds import Array

#: Names of the models for the errors of the bodies' places, of the forces exerted on bodies, and of stresses.
PLACES = ("trajectory", "path")
REACTIONS = ("reactions", "exerted")
STRESSES = ("stress", "largest_stress")
#: Turn below which a path is not one of a rotation [rad].
TURNED = 1e-9


@dataclass(frozen=True, kw_only=True)
class Response(Answer):
    """A static path of S converged states, that of load factor 0 first; G strips, P stations a strip.

    Attributes:
        load_factor: (S,) share of the loads that acts, of the rotation where there are none [1].
        torque: (S,) driving torque [N m]; stiffness: (S,) its derivative from the tangent [N m / rad]; NaN
            where nothing is driven.
        bending_energy, axial_energy, shear_energy: (S,) of all strips [J]; zero without shear.
        gravity_energy: (S,) against rest [J]; spring_energy: (S,) of the springs between bodies [J];
            work: (S,) of loads and drives since the first state [J].
        stations: (P,) reference arc length over L [1]; axial_force: (S, G, P) [N]; bending_moment: [N m].
    """

    parts = ("bending", "axial", "shear", "gravity", "spring")

    load_factor = own("load_factor")
    torque = own("torque")
    stiffness = own("stiffness")
    bending_energy = own("bending_energy")
    axial_energy = own("axial_energy")
    shear_energy = own("shear_energy")
    gravity_energy = own("gravity_energy")
    spring_energy = own("spring_energy")
    work = own("work")
    stations = own("stations")
    axial_force = own("axial_force")
    bending_moment = own("bending_moment")

    @property
    def critical_points(self) -> tuple[Any, ...]:
        """Critical points of the path in its order, each with `kind` ("limit point", "turning point" or
        "bifurcation"), `load_factor` [1] and `rotation` [rad], NaN if no body rotates."""
        return tuple(self.solution.critical_points)

    @property
    def driven(self) -> bool:
        """Whether a rotation is driven."""
        return not bool(np.isnan(self.torque).all())

    @property
    def turns(self) -> bool:
        """Whether a rotation is driven to an angle that is not zero."""
        return self.driven and self.body is not None and float(np.ptp(self.rotation)) > TURNED

    @property
    def places(self) -> Array:
        """Load factor [1] and rotation [rad] (S, 2); NaN if no body rotates."""
        turns = np.full(len(self.load_factor), np.nan) if self.body is None else self.rotation
        return np.stack((self.load_factor, turns), axis=1)

    @property
    def centres(self) -> dict[str, Array]:
        """(S, 2) centres of mass of the bodies by name [m]."""
        return {name: place[:, :2] for name, place in self.bodies.items()}

    @property
    def centre_shift(self) -> Array:
        """(S, 2) displacement of a pivot's point that lies at the strips' crossing at rest [m]."""
        return centre_shift(np.array(self.crossing), self.rotation, self.centre)

    def exerted(self, body: str, coordinate: str) -> Array:
        """Return the force [N] or moment [N m] (S,) on a body for its prescribed "x", "y" or "rotation"."""
        place = self.solution.prescribed.index((body, coordinate))
        return np.asarray(self.solution.reactions[:, place])

    @property
    def strain_energy(self) -> Array:
        """(S,) bending, axial and shear energy together [J]."""
        return self.bending_energy + self.axial_energy + self.shear_energy

    @cached_property
    def stress(self) -> Array:
        """Stress (S, G, P) of the section forces of this answer [Pa]."""
        return read_only(stress_of(self.design.strips, self.axial_force, self.bending_moment))

    @property
    def yield_share(self) -> Array | None:
        """(S,) largest stress over the yield strength of its strip [1]; None where a strip has none."""
        limits = [strip.yield_strength for strip in self.design.strips]
        if None in limits:
            return None
        worst = self.strip_stress / np.array(limits, dtype=float)
        return np.asarray(worst.max(axis=1))

    @cached_property
    def body_stiffness(self) -> Array:
        """Stiffness (S, 3, 3) of the driven or only body, about its centre, in x, y and rotation, at fixed
        loads.

        Units: [N/m, N, N m/rad]. It is computed at its first access, and nan with the published forces. What
        is none but round-off of the strips' own stiffness is zero, as of a body that nothing holds.
        """
        if self.settings.get("measure") == "published":
            return read_only(np.full((len(self.load_factor), 3, 3), np.nan))
        found = np.asarray(self.solution.body_stiffness(self.body))
        strips, lever = self.design.strips, max(strip.length for strip in self.design.strips)
        least = (
            4.0 * np.finfo(float).eps * max(each.youngs_modulus * each.area / each.length for each in strips)
        )
        arms = np.array([1.0, 1.0, lever])
        return read_only(np.where(np.abs(found) < least * np.outer(arms, arms), 0.0, found))

    @classmethod
    def of(cls, asked: Asked, result: Any, **given: Any) -> Self:
        """Return the neutral form of a model's path, with a remark if the centre shift is less accurate than
        asked."""
        found = super().of(asked, result, **given)
        error, accuracy = (float((found.estimate or {}).get(k, 0.0)) for k in ("centre_shift", "accuracy"))
        if not error > accuracy:
            return found
        above = f"estimated error of the centre shift {error:.1e}, above {accuracy:g}"
        return replace(found, resolution="; ".join(filter(None, (found.resolution, above))))

    def _errors_beside(self, estimate: dict[str, Any]) -> dict[str, float]:
        """Return the error of a pivot's centre shift [1], and none of stresses without an outer fibre.

        The centre shift has the same absolute error as the centre, but it is much smaller, so that its
        relative error is larger; NaN if nothing shifts.
        """
        known = next((estimate[name] for name in PLACES if name in estimate), None)
        found = {}
        if not any(strip.outer_fibre or strip.thickness for strip in self.design.strips):
            found = {name: math.nan for name in STRESSES if name in estimate}
        if known is None or self.crossing is None:
            return found
        arrays = (self.centre - self.centre[0], self.centre_shift)
        moved, shifted = (float(np.fmax.reduce(np.hypot(*array.T))) for array in arrays)
        return found | {"centre_shift": known * moved / shifted if shifted > 0.0 else math.nan}

    def _in_full(self, along: Any) -> Any:
        """Return the fields with the forces by balance, where a spline has chosen its points."""
        names = ("axial_force", "bending_moment")
        better = {name: getattr(self, name) for name in names}
        same = {name: each for name, each in better.items() if each.shape == getattr(along, name).shape}
        return replace(along, **same)
