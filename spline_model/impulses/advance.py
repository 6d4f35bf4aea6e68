"""A run of steps of either form, in place.

What has one caller is inlined: else each level of calls is compiled again with all that is below it.
"""

from __future__ import annotations

from numba import njit

from spline_model.impulses.energies import energy_of, kinetic, potential
from spline_model.impulses.forces import fill_drag
from spline_model.impulses.printed import printed_step
from spline_model.impulses.stable import solve_step
from spline_model.impulses.totals import HALVED, LIMITED, STEPS, damped, external_work
from spline_model.kernels.record import forward, record

EULER, START, BACKWARD = range(3)
"""Rules of a stable step: implicit Euler (q1 = q0 + h v1); the start (q1 = q0 + h (v0 + v1) / 2), which
loses less; backward differences of second order from the two states before."""
COUNTS, RESIDUAL, ENERGY = range(3)
"""Places of ``Moving.status``."""
MOST_REACH = 0.3
"""Largest rotation that the first guess of a step takes from the velocity [rad]."""
SLACK = 1e-14
"""Gain of energy in EI/L that is round-off."""
MOST_ENERGY = 100.0
"""A printed run whose kinetic energy exceeds this times the energy at its start is unstable; below the limit
symplectic Euler lets the energy swing by a factor 1 / (1 - omega h / 2)."""
FROM_REST = 1e-6
"""Energy in EI/L that a printed run may reach from rest."""


@njit(cache=True, nogil=True)
def advance(moving, log, time, h, first, last, every, stable, active, motion, blocks, options, space):
    """Take the steps ``first`` ... ``last`` - 1 of length h, step 0 being at ``time`` [s].

    Returns the number of the first step that was not taken; ``moving`` stands at its begin. Every
    ``every``-th step's end is recorded.
    """
    for k in range(first, last):
        now = time + k * h
        if stable:
            done = stable_advance(moving, now, h, active, motion, blocks, options, space)
        else:
            done = printed_advance(moving, now, h, active, motion, blocks, options, space)
        if not done:
            return k
        if (k + 1) % every == 0:
            r = (k + 1) // every
            log.states[r] = moving.z
            log.rates[r] = moving.v
            record(moving.z, moving.v, motion, space.strains, moving.totals, log.rows[r])
    return last


@njit(cache=True, nogil=True, inline="always")
def printed_advance(moving, time, h, active, motion, blocks, options, space):
    """Advance by one printed step; False, with the state as it was, if it is unstable."""
    z, v, status = moving.z, moving.v, moving.status
    count, work = v.size, abs(moving.totals[0])
    moving.earlier_q[:] = z[:count]
    moving.earlier_v[:] = v
    gap = printed_step(moving, time, h, active, motion, blocks, options, space)
    if not kinetic(v, motion.mass) <= MOST_ENERGY * (status[ENERGY] + work + FROM_REST * motion.energy):
        z[:count] = moving.earlier_q
        z[count:] = 0.0
        v[:] = moving.earlier_v
        return False
    status[RESIDUAL] = max(status[RESIDUAL], gap)
    return True


@njit(cache=True, nogil=True, inline="always")
def stable_advance(moving, time, duration, active, motion, blocks, options, space):
    """Advance by one step, or by halves of implicit Euler where that fails; False if none is solved."""
    status = moving.status
    driven = held(active)
    done, step = 0.0, duration
    while duration - done > 1e-9 * duration:
        step = min(step, duration - done)
        rule = EULER
        if step == duration:
            rule = BACKWARD if status[COUNTS] == 1.0 else (EULER if driven else START)
        if try_step(moving, time + done, step, rule, active, motion, blocks, options, space):
            done += step
            step *= 2.0
            continue
        moving.counters[HALVED] += 1
        status[COUNTS] = 0.0
        step *= 0.5
        if step < options.least_part * duration:
            return False
    status[COUNTS] = 1.0 if step == 2.0 * duration else 0.0
    return True


@njit(cache=True, nogil=True)
def held(active):
    """Whether any drive holds."""
    return active.size > 0 and active.max() == 1


@njit(cache=True, nogil=True, inline="always")
def try_step(moving, time, h, rule, active, motion, blocks, options, space):
    """Take one step by a rule; False, with the state as it was, if it is not solved or gains energy."""
    z, v, status = moving.z, moving.v, moving.status
    span, lag = predict(moving, h, rule, motion.turns, space)
    fill_drag(z, motion, space.drag)
    residual = solve_step(span, lag, time + h, active, motion, blocks, options, space, moving.counters)
    if not residual <= 1e3 * options.tolerance or not forward(space.z, motion.tables):
        return False
    work = external_work(z, space.z, motion.tables, active, time + h)
    if blocks.grounded == 1 and not held(active):
        if not limit_energy(status, work, motion, space, moving.counters):
            return False
    else:
        status[ENERGY] = energy_of(space.z, space.v, motion, space.strains)
    moving.totals[0] += work
    moving.totals[1] += damped(space.z, space.v, h, motion, blocks.relaxation, space)
    for i in range(v.size):
        moving.earlier_q[i], moving.earlier_v[i] = z[i], v[i]
        v[i] = space.v[i]
    z[:] = space.z
    status[COUNTS] = 1.0
    status[RESIDUAL] = max(status[RESIDUAL], residual)
    moving.counters[STEPS] += 1
    return True


@njit(cache=True, nogil=True)
def predict(moving, h, rule, turns, space):
    """Fill the rule's start values and the first guess in ``space``; returns the spans s and r [s]."""
    z, v, count = moving.z, moving.v, moving.v.size
    span = lag = h
    for i in range(count):
        space.base[i], space.drift[i] = z[i], v[i]
        if rule == START:
            space.base[i] += 0.5 * h * v[i]
        elif rule == BACKWARD:
            space.base[i] = (4.0 * z[i] - moving.earlier_q[i]) / 3.0
            space.drift[i] = (4.0 * v[i] - moving.earlier_v[i]) / 3.0
    if rule == START:
        span = 0.5 * h
    elif rule == BACKWARD:
        span = lag = 2.0 * h / 3.0
    reach = h
    for turn in turns:
        if abs(v[turn]) * reach > MOST_REACH:
            reach = MOST_REACH / abs(v[turn])
    space.z[:] = z
    for i in range(count):
        space.v[i] = (z[i] + reach * v[i] - space.base[i]) / span
    return span, lag


@njit(cache=True, nogil=True)
def limit_energy(status, work, motion, space, counters):
    """Reduce the velocity where the step would gain energy; False if that is not enough.

    Velocities scaled by one factor fulfil constraints at rest as they did before. The energy in
    ``status`` becomes that after the step.
    """
    allowed = status[ENERGY] + work
    moving, stored = kinetic(space.v, motion.mass), potential(space.z, motion, space.strains)
    if moving + stored > allowed + SLACK * motion.energy:
        if stored > allowed:
            return False
        share = ((allowed - stored) / moving) ** 0.5
        for i in range(space.v.size):
            space.v[i] *= share
        counters[LIMITED] += 1
        moving = allowed - stored
    status[ENERGY] = moving + stored
    return True
