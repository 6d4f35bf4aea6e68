"""The state at load factor 0 of a scene with weight or pre-strain: these grow from nothing first."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.follower import Follower
from spline_model.continuation.point import stand
from spline_model.continuation.remark import Place
from spline_model.continuation.watch import Watch
from spline_model.errors import InvalidParameter
from spline_model.kernels.assemble import Tables
from spline_model.newton import Newton, Workspace, solve

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Growing(Workspace):
    """A workspace whose load factor is the share of weight and pre-strain that acts; no load does."""

    def evaluate(self, z: Array, load_factor: float) -> tuple[float, float]:
        """Fill gradient and hessian at z under a share of the preload."""
        return self._under(load_factor).evaluate(z, 0.0)

    def push(self, z: Array) -> Array:
        """Minus the derivative of the gradient in the share: exact, the gradient is linear in it."""
        return self._apart(z, 0.0)[0] - self._apart(z, 1.0)[0]

    def potential(self, z: Array, load_factor: float, energies: tuple[float, float]) -> float:
        """Energy of strips, of the share of the weight, and of potentials in Python [J]."""
        return self._under(load_factor).potential(z, 0.0, energies)

    def conjugate(self, z: Array, load_factor: float) -> tuple[float, float]:
        """Derivatives of the potential in the share: exact, it is a square of it."""
        none, half, full = (self._apart(z, share)[1] for share in (0.0, 0.5, 1.0))
        square = 2.0 * (full + none - 2.0 * half)
        return full - none + (2.0 * load_factor - 1.0) * square, 2.0 * square

    def preload(self, load_factor: float) -> float:
        """The share itself."""
        return load_factor

    def _under(self, share: float) -> Workspace:
        """A workspace at load factors, with these arrays and a share of the preload."""
        own = {name: getattr(self, name) for name in ("gradient", "hessian", "pattern", "counters")}
        return Workspace(system=replace(self.system, tables=_partial(self.system, share)), **own)

    def _apart(self, z: Array, share: float) -> tuple[Array, float]:
        """Gradient (N,) and potential [J] at z under a share, in arrays of their own."""
        other = Workspace.of(self._under(share).system)
        energies = other.evaluate(z, 0.0)
        return other.gradient, other.potential(z, 0.0, energies)


def settle(watch: Watch) -> Newton:
    """Equilibrium at load factor 0: weight and pre-strain grow from nothing, watched like any path.

    Raises InvalidParameter where they cannot grow to their full size.
    """
    work = watch.work
    z = _grown(watch) if _is_preloaded(work.system) else work.system.rest
    newton = solve(work, z, 0.0)
    if newton.reason:
        raise InvalidParameter("scene", newton.reason, "an equilibrium at load factor 0, near rest")
    return newton


def _grown(watch: Watch) -> Array:
    """The unknowns (N,) under full weight and pre-strain; what was met on the way is told to ``watch``."""
    growing = Growing(**vars(watch.work))
    own = Watch(growing, leaves=watch.leaves, by_load=True, place=Place(system=None))
    newton = solve(growing, watch.work.system.rest, 0.0)
    try:
        begin = stand(growing, newton.z, 0.0, newton.energies)
    except np.linalg.LinAlgError as error:
        raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error
    follower = Follower(own, begin, newton.norms)
    message = follower.advance(1.0)
    if message:
        raise InvalidParameter("scene", message, "an equilibrium under all of its weight and pre-strain")
    watch.leaves, watch.before = own.leaves, own.remark()
    return follower.here.z


def _is_preloaded(system: System) -> bool:
    """Whether weight or pre-strain act."""
    tables = system.tables
    strains = (tables.stretching.strain, tables.axial_force.strain, tables.weight)
    curved = bool((tables.bending.curvature != system.rest_curvature).any())
    return curved or any(bool(values.any()) for values in strains)


def _partial(system: System, share: float) -> Tables:
    """The tables with a share of weight and pre-strain."""
    tables = system.tables
    curvature = system.rest_curvature + share * (tables.bending.curvature - system.rest_curvature)
    return tables._replace(
        bending=tables.bending._replace(curvature=curvature),
        stretching=tables.stretching._replace(strain=share * tables.stretching.strain),
        axial_force=tables.axial_force._replace(strain=share * tables.axial_force.strain),
        weight=share * tables.weight,
    )
