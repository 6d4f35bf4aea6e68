"""The state at load factor 0 of a scene with weight or pre-strain: these grow from nothing first."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.errors import InvalidParameter
from spline_model.kernels.assemble import Tables
from spline_model.newton import Newton, Workspace, solve

Array = NDArray[np.float64]

SMALLEST_SHARE = 2.0**-12
"""Least part of weight and pre-strain before the scene is refused."""


def settle(work: Workspace) -> Newton:
    """Equilibrium at load factor 0, reached from rest in as few parts of the preload as Newton allows."""
    system = work.system
    z, share, part = system.rest, 0.0, 1.0
    while True:
        target = min(1.0, share + part)
        newton = solve(_with_share(work, target), z, 0.0)
        if not newton.reason:
            z, share = newton.z, target
            if share == 1.0:
                return newton
            continue
        work.counters.halved_increments += 1
        part /= 2
        if part < SMALLEST_SHARE:
            raise InvalidParameter("scene", newton.reason, "an equilibrium at load factor 0, near rest")


def _with_share(work: Workspace, share: float) -> Workspace:
    """The same workspace with a share of weight and pre-strain."""
    if share == 1.0:
        return work
    system = work.system
    return replace(work, system=replace(system, tables=_partial(system, share)))


def _partial(system: System, share: float) -> Tables:
    tables = system.tables
    curvature = system.rest_curvature + share * (tables.bending.curvature - system.rest_curvature)
    return tables._replace(
        bending=tables.bending._replace(curvature=curvature),
        stretching=tables.stretching._replace(strain=share * tables.stretching.strain),
        axial_force=tables.axial_force._replace(strain=share * tables.axial_force.strain),
        weight=share * tables.weight,
    )
