"""The state at load factor 0 of a scene with weight or pre-strain: these grow from nothing first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.continuation.follower import Follower
from spline_model.continuation.point import stand
from spline_model.continuation.remark import Place
from spline_model.continuation.watch import Watch
from spline_model.effects import Bending, MixedStretching, Stretching
from spline_model.errors import InvalidParameter
from spline_model.newton import Newton, solve

Array = NDArray[np.float64]


def settle(watch: Watch) -> Newton:
    """Equilibrium at load factor 0: weight and pre-strain grow from nothing, watched like any path.

    Raises InvalidParameter where they cannot grow to their full size.
    """
    work = watch.work
    z = _grown(watch) if is_preloaded(work.system) else work.state(work.system.rest)
    newton = solve(work, z, 0.0)
    if newton.reason:
        raise InvalidParameter("scene", newton.reason, "an equilibrium at load factor 0, near rest")
    return newton


def _grown(watch: Watch) -> Array:
    """The unknowns (N,) under full weight and pre-strain; what was met on the way is told to ``watch``."""
    growing = watch.work.growing()
    own = Watch(growing, leaves=watch.leaves, by_load=True, place=Place(system=None))
    newton = solve(growing, growing.state(growing.system.rest), 0.0)
    try:
        begin = stand(growing, newton.z, 0.0, newton.energies)
    except np.linalg.LinAlgError as error:
        raise InvalidParameter("scene", str(error), "strips that can move, but not freely") from error
    follower = Follower(own, begin, newton.norms)
    own.first = (0.0, begin.z)
    message = follower.advance(1.0)
    if message:
        raise InvalidParameter("scene", message, "an equilibrium under all of its weight and pre-strain")
    watch.leaves, watch.before = own.leaves, own.remark()
    return follower.here.z


def is_preloaded(system: System) -> bool:
    """Whether weight or pre-strain act."""
    scene = system.scene
    strains = (
        *(e.natural_curvature for e in scene.of(Bending)),
        *(e.natural_strain for e in scene.of(Stretching)),
        *(e.natural_strain for e in scene.of(MixedStretching)),
    )
    return any(strains) or bool(system.weight.any())
