"""The integrators by name, what each can be asked, and the run of the one that was chosen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.kernels.motion import Motion
from spline_model.motion import energy_consistent, explicit, generalised_alpha, quasi_static
from spline_model.motion.start import Records

Array = NDArray[np.float64]

INTEGRATORS: dict[str, Callable[..., Records]] = {
    "energy": energy_consistent.integrate,
    "generalised-alpha": generalised_alpha.integrate,
    **{name: partial(explicit.integrate, integrator=name) for name in explicit.SCHEMES},
}
QUASI_STATIC = "quasi-static strips"
"""What the energy integrator is called where only the bodies are dynamic."""
OPTIONS = {"generalised-alpha": ("spectral_radius",)}
"""Options of the integrators that have any."""


def require_options(integrator: str, options: Mapping[str, float]) -> None:
    """Refuse an option that the integrator does not read."""
    known = OPTIONS.get(integrator, ())
    for name, value in options.items():
        if name not in known:
            reads = f"reads only {', '.join(known)}" if known else "reads no option"
            raise InvalidParameter(name, value, f"none: the integrator {integrator} {reads}")


def massless(system: System, motion: Motion) -> bool:
    """Whether no strip has inertia, so that only the bodies' coordinates are dynamic."""
    bodies = min(system.layout.bodies.values(), default=len(motion.mass))
    return not motion.mass[:bodies].any()


def integrate(
    integrator: str,
    system: System,
    motion: Motion,
    start: tuple[Array, Array, Array],
    *,
    step: float,
    steps: int,
    every: int,
    options: Mapping[str, float],
) -> tuple[str, Records]:
    """Run from ``start``, unknowns z, velocities v and accelerations; returns what ran and its records."""
    z, v, acceleration = start
    if integrator == "energy" and massless(system, motion):
        run = quasi_static.integrate(system, motion, z, v, step=step, steps=steps, every=every)
        return QUASI_STATIC, run
    run = INTEGRATORS[integrator](
        system, motion, z, v, acceleration, step=step, steps=steps, every=every, **options
    )
    return integrator, run
