"""Stresses in the extreme fibres of the strips, and how they change with states and design."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from spline_model.compile import System
from spline_model.design import StripDesign
from spline_model.effects import MixedStretching, Stretching
from spline_model.sensitivity.lines import Line, Turning
from spline_model.sensitivity.parameters import Rates

Array = NDArray[np.float64]


def fibre_stress(
    system: System, strip: StripDesign, rates: Rates, states: Array, changes: Array, stations: Array
) -> tuple[Array, Array]:
    """Stress [Pa] at both extreme fibres, (S, G, Q, 2), and its derivatives, (S, G, Q, 2, P).

    N / A -+ M h / (2 I) with h = sqrt(12 I / A) of the rectangular section, left fibre first:
    signed, so that both are smooth in state and design. changes (P, S, N); plane sections, without
    the clamps' notches.
    """
    strips = system.scene.strips
    first, second = (Line.at_stations(strips, system.layout, stations, order) for order in (1, 2))
    moment, by_moment = _moment(system, strip, rates, (first, second), states, changes)
    force, by_force = _force(system, strip, rates, first, stations, states, changes)
    area, inertia = strip.area, strip.second_moment_of_area
    lever = math.sqrt(3.0 / (area * inertia))  # h / (2 I)
    by_lever = -0.5 * lever * (rates.area / area + rates.second_moment / inertia)
    axial, bending = force / area, moment * lever
    by_axial = by_force / area - axial[..., None] * rates.area / area
    by_bending = by_moment * lever + moment[..., None] * by_lever
    shape = (len(states), len(strips), len(stations), 2)
    value = np.stack((axial - bending, axial + bending), axis=-1).reshape(shape)
    rate = np.stack((by_axial - by_bending, by_axial + by_bending), axis=2)
    return value, rate.reshape(*shape, len(rates.names))


def _moment(
    system: System, strip: StripDesign, rates: Rates, lines: tuple[Line, Line], states: Array, changes: Array
) -> tuple[Array, Array]:
    """M = EI (phi / L - kappa_0) [N m], (S, Q), and its derivatives, (S, Q, P)."""
    turning = Turning.of(*(line.at(states) for line in lines))
    given = system.scene.bending_of(system.scene.strips[0].name)
    natural = 0.0 if given is None or given.natural_curvature is None else given.natural_curvature
    length, rigidity = strip.length, strip.flexural_rigidity
    by_rigidity = rates.modulus * strip.second_moment_of_area + strip.youngs_modulus * rates.second_moment
    curvature = turning.value / length
    turned = turning.along(*(line.at(changes) for line in lines)).imag.transpose(1, 2, 0)
    by_curvature = (turned - curvature[..., None] * rates.length) / length
    strain = curvature - natural
    return rigidity * strain, strain[..., None] * by_rigidity + rigidity * by_curvature


def _force(
    system: System,
    strip: StripDesign,
    rates: Rates,
    line: Line,
    stations: Array,
    states: Array,
    changes: Array,
) -> tuple[Array, Array]:
    """N [N], (S, Q), and its derivatives, (S, Q, P): of the axial modes, or of the strain."""
    scene, layout = system.scene, system.layout
    names = [each.name for each in scene.strips]
    modes = np.zeros((len(names) * len(stations), layout.size))
    for i, effect in enumerate(scene.of(MixedStretching)):
        rows = names.index(effect.strip) * len(stations) + np.arange(len(stations))
        first, values = effect.modes.evaluate(stations)
        modes[rows[:, None], layout.modes[i][0] + first[:, None] + np.arange(values.shape[1])] = values
    force, by_force = states @ modes.T, (changes @ modes.T).transpose(1, 2, 0)
    for consistent in scene.of(Stretching)[:1]:  # the same law for all strips
        tangent = line.at(states)
        v = np.abs(tangent)
        along = ((line.at(changes) * tangent.conj()).real / v).transpose(1, 2, 0)
        stretch, rigidity = v / strip.length, strip.axial_rigidity
        by_rigidity = rates.modulus * strip.area + strip.youngs_modulus * rates.area
        strain = stretch - 1.0 - consistent.natural_strain
        by_strain = (along - stretch[..., None] * rates.length) / strip.length
        force = rigidity * strain
        by_force = strain[..., None] * by_rigidity + rigidity * by_strain
    return force, by_force
