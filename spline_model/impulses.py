"""The two steps of the sequential impulses: as printed, and one that is stable at any length.

As printed (Eqs 21 to 30, misprints corrected), explicit forces and impulses at velocity level:

    M (v~ - v0) / h = f - dV/dq(q0) - D v0              (21, 22)
    v1 = v~ + M^-1 psi_q(q0)^T P,    psi_q v1 = 0   (24 to 30)
    q1 = q0 + h v1                                      (23)

Symplectic Euler: first order, stable while omega h < 2 for every frequency of the constrained
system. Nothing corrects positions, so that the constraints drift.

Stable: implicit elastic forces, axial compliance in the constraint, positions stabilised.
With the rule's start values q~, v~ and spans s (of positions) and r (of velocities),

    M (v1 - v~) / r + dV/dq(q1) + D v1 - psi_q(q1)^T lambda + eps_q(q1)^T a - f = 0,
    q1 = q~ + s v1,    psi(q1) = 0,    eps(q1) + beta d(eps)/dt = C a.

Newton's iteration solves for the motion and the impulses that close the gaps of the constraints where it
leads, positions and all, from the forces lambda and a of the step before. The axial forces are multipliers
of soft constraints, so that no stiffness EA stands in the update.
"""

from __future__ import annotations

from typing import Annotated, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from spline_model.effects import MixedStretching
from spline_model.effects.elastic import ANTICLASTIC
from spline_model.errors import InvalidParameter
from spline_model.motion.start import Motion
from spline_model.motion.step import HALVED, STEPS
from spline_model.paper import (
    CURL,
    RELAXATION,
    RIGIDITY,
    SPEED,
    STRETCHING,
    WORK,
    Clamps,
    Strips,
    assemble,
    clamps_of,
    derivatives,
    strips_of,
    turning,
)
from spline_model.strip.compiled import called, copy, kernel, once
from spline_model.strip.laws import SPATIAL

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SOLVES, SWEEPS, LIMITED = range(HALVED + 1, HALVED + 4)
"""Places of the counters behind those of steps and of halved ones: linear systems, sweeps over the
constraints, and steps whose velocity was reduced so that no energy is gained."""
COUNTS, ENERGY, LOST = range(3)
"""Places of ``Moving.status``."""
MOST_ENERGY = 100.0
"""A run whose kinetic energy exceeds this times the energy at its start is unstable; below the limit
symplectic Euler lets the energy swing by a factor 1 / (1 - omega h / 2)."""
FROM_REST = 1e-6
"""Energy in EI/L that a run may reach from rest."""
ITERATIONS = 12
"""Most Newton iterations of a stable step before it is halved."""
EULER, START, BACKWARD = range(3)
"""Rules of a step: implicit Euler (q1 = q0 + h v1); the start (q1 = q0 + h (v0 + v1) / 2), which
loses less; backward differences of second order from the two states before."""
MOST_TURN = 0.5
"""Largest rotation of a body in one iteration [rad]."""
MOST_REACH = 0.3
"""Largest rotation that the first guess of a step takes from the velocity [rad]."""
SLACK = 1e-14
"""Gain of energy in EI/L that is round-off."""
SLOWEST = 0.1
"""Least |C'| over its value at rest: with less the curve is folded."""
TINY = 1e-300
"""In place of a pivot of zero: what follows is not finite, and the step is refused."""


class Problem(NamedTuple):
    """What does not change in a run: N unknowns, Q coordinates, M axial forces, R rows of constraints.

    strips, clamps: of the scene. held_at, held_row (D,): place of each coordinate that a support holds and of
    its multiplier, held_to (D,) where. mass, inverse, drag (Q, Q); force (Q,): weight and loads; rigidity (M,
    M) inverse compliance and relaxation [s] of the axial forces; unit (N,) makes residuals
    dimensionless, energy is EI/L [J]; turns: the rotations' places. rows (R,): places in z of the multipliers
    of the constraints, in the order of a sweep; first (B + 1,): where each begins in them, one of all where
    there are no sweeps. grounded: 1 if the ground holds anything. sweeps: of a linear system, at most;
    tolerance [1].
    """

    strips: Strips
    clamps: Clamps
    held_at: Indices
    held_row: Indices
    held_to: Array
    mass: Array
    inverse: Array
    drag: Array
    force: Array
    rigidity: Array
    relaxation: float
    unit: Array
    energy: float
    turns: Indices
    rows: Indices
    first: Indices
    grounded: int
    sweeps: int
    tolerance: float

    @classmethod
    def of(cls, motion: Motion, *, sweeps: int | None, tolerance: float) -> Self:
        """The problem of a system; sweeps: over single constraints, at most; None solves all as one."""
        system, drives, clamps = motion.system, motion.drives, clamps_of(motion.system)
        _require_known(motion)
        blocks = _constraints(motion)
        rows = np.array([row for block in blocks for row in block], dtype=np.int64)
        ends = [len(rows)] if sweeps is None else np.cumsum([len(block) for block in blocks])
        return cls(
            strips=strips_of(system),
            clamps=clamps,
            held_at=drives.coordinate,
            held_row=drives.row,
            held_to=drives.origin + drives.factors[drives.first] * drives.target,
            mass=system.mass,
            inverse=np.asarray(np.linalg.inv(system.mass), dtype=np.float64),
            drag=system.drag if system.drag.size else np.zeros_like(system.mass),
            force=loads_of(motion) + (system.weight if system.weight.size else 0.0),
            rigidity=motion.rigidity,
            relaxation=system.relaxation_time,
            unit=system.scales.unit / system.scales.energy,
            energy=system.scales.energy,
            turns=np.array([start + 2 for start in system.layout.bodies.values()], dtype=np.int64),
            rows=rows,
            first=np.array([0, *ends], dtype=np.int64),
            grounded=int(clamps.grounded or drives.row.size > 0),
            sweeps=sweeps or 1,
            tolerance=float(tolerance),
        )

    @property
    def sizes(self) -> dict[str, int]:
        """The number that each letter in the shapes of ``Space`` stands for."""
        sizes = {"N": len(self.unit), "Q": len(self.mass), "R": len(self.rows), "W": WORK}
        return sizes | {"M": len(self.rigidity), "2n": 2 * self.strips.curve.shape[2]}


class Space(NamedTuple):
    """Arrays that a step fills.

    z, x, gradient, matrix of the unknowns; v, base, drift of the coordinates, drag all damping of them; of
    the rows the impulses' answers move (R, Q), what couples them in small, impulses mu and change; strains of
    the axial forces, and rates; energy of strain.
    """

    z: Annotated[Array, "N"]
    x: Annotated[Array, "N"]
    gradient: Annotated[Array, "N"]
    matrix: Annotated[Array, "N N"]
    v: Annotated[Array, "Q"]
    base: Annotated[Array, "Q"]
    drift: Annotated[Array, "Q"]
    drag: Annotated[Array, "Q Q"]
    move: Annotated[Array, "R Q"]
    small: Annotated[Array, "R R"]
    mu: Annotated[Array, "R"]
    change: Annotated[Array, "R"]
    strains: Annotated[Array, "M"]
    rates: Annotated[Array, "M"]
    energy: Annotated[Array, "1"]
    work: Annotated[Array, "W 2n"]


class Moving(NamedTuple):
    """A motion on its way, advanced in place.

    z (N,) unknowns, v (Q,) velocities; earlier (2, Q) coordinates and velocities of the step before; begun
    (Q,) coordinates at the start; status (3,): 1 if ``earlier`` counts, the energy with the potential of
    weight and loads since the start [J], and the energy dissipated [J]; counters (6,).
    """

    z: Array
    v: Array
    earlier: Array
    begun: Array
    status: Array
    counters: Indices


def loads_of(motion: Motion) -> Array:
    """Return the loads as a generalised force (Q,) [N, N m]."""
    loads, force = motion.loads, np.zeros(motion.system.layout.coordinate_count)
    np.add.at(force, loads.coordinate, loads.value * loads.factors[loads.first])
    return force


def _require_known(motion: Motion) -> None:
    """Refuse what the paper's impulses do not have; ``solve_motion`` has all of it."""
    system, drives, layout = motion.system, motion.drives, motion.system.layout
    system.require_dead("effects")
    segments = max((len(pieces) for pieces in system.scene.whole.values()), default=1)
    if segments > 1:
        raise InvalidParameter("segments", segments, "1 for sequential impulses")
    timed = drives.begin.any() or np.isfinite(drives.until).any()
    timed = timed or (drives.pairs > 1).any() or (motion.loads.pairs > 1).any()
    for name, has in (
        (ANTICLASTIC, strips_of(system).own[:, CURL].any()),
        ("spring", system.springs.size > 0),
        ("a drive or a load that changes in time", timed),
    ):
        if has:
            raise InvalidParameter("effects", name, "a motion by solve_motion, for impulses know none")
    places = {name: layout.strip(name) for name in layout.strips}
    for name, at in (places | {name: layout.body(name) for name in layout.bodies}).items():
        if np.linalg.eigvalsh(system.mass[at, at])[0] <= 0:  # an impulse would change its velocity unbound
            raise InvalidParameter("effects", f"no inertia of {name}", "inertia of every strip and body")


def _constraints(motion: Motion) -> list[range]:
    """Rows of each constraint: of strips that cannot stretch, then of clamps and supports."""
    layout, stretching = motion.system.layout, motion.system.scene.of(MixedStretching)
    axial = zip(layout.modes, stretching, strict=True)
    places = [place for place, effect in axial if effect.axial_compliance == 0]
    return [range(at, at + count) for at, count in (*places, *layout.multipliers)]


@called()
def _fill(z, problem, space):
    """Fill the gradient (N,) and the matrix (N, N) of V - lambda psi - f q at z (N,).

    In the rows of the multipliers the gradient is - psi, and the Hessian - psi_q. Returns the strain energy
    without that of the axial forces, and the least v / J0.
    """
    gradient, matrix = space.gradient, space.matrix
    bent, axial, slowest = assemble(z, problem.strips, problem.clamps, gradient, matrix, space.work)
    for i in range(problem.force.size):
        gradient[i] -= problem.force[i]
    for d in range(problem.held_at.size):
        i, row = problem.held_at[d], problem.held_row[d]
        gradient[row] = problem.held_to[d] - z[i]
        gradient[i] -= z[row]
        matrix[row, i] = matrix[i, row] = -1.0
    return bent + axial, slowest


@kernel()
def strain_energy(z, problem, space):
    """The same without any axial force or multiplier; returns the strain energy [J].

    ``space.strains`` are those that the axial forces see: these count by the forces that strains give.
    """
    strains, count = space.strains, problem.force.size
    for i in range(z.size):
        space.z[i] = z[i] if i < count else 0.0
    energy, _ = _fill(space.z, problem, space)
    for k in range(strains.size):
        strains[k] = space.gradient[count + k]
    return energy + 0.5 * _product(problem.rigidity, strains, strains)


@called()
def _product(matrix, a, b):
    """Return a . matrix b."""
    total = 0.0
    for i in range(a.size):
        for j in range(b.size):
            total += a[i] * matrix[i, j] * b[j]
    return total


@called()
def _row_times(matrix, row, v):
    """Return what a row of the matrix makes of a velocity (Q,)."""
    total = 0.0
    for i in range(v.size):
        total += matrix[row, i] * v[i]
    return total


@called()
def _fallen(z, begun, problem):
    """Return the work [J] of weight and loads from the coordinates ``begun`` (Q,) to z (N,)."""
    work = 0.0
    for i in range(begun.size):
        work += problem.force[i] * (z[i] - begun[i])
    return work


@called()
def _fill_drag(z, problem, space):
    """Fill the drag (Q, Q): the coordinates' own, and the strips' Kelvin-Voigt damping at z.

    int beta EI (db/dq)^T (db/dq) W du of bending, and so with the strain and EA of stretching by quadrature.
    """
    drag, strips = space.drag, problem.strips
    for i in range(drag.shape[0]):
        for j in range(drag.shape[0]):
            drag[i, j] = problem.drag[i, j]
    for s in range(strips.first.size):
        own, first = strips.own[s], strips.first[s]
        for p in range(strips.weight.size if own[RELAXATION] > 0.0 else 0):
            curve, along, work = strips.curve[p], strips.along[s, p], space.work
            x1, y1, x2, y2 = derivatives(curve, z, first)
            phi, v, phi_i, v_i = turning(x1, y1, x2, y2)
            spatial = strips.measure == SPATIAL
            length = v if spatial else along[SPEED]
            weight = strips.weight[p] * own[RELAXATION] * length
            for a in range(curve.shape[1]):
                for i in range(2):
                    less = phi * v_i[i] / v if spatial else 0.0
                    bent = curve[0, a] * (phi_i[i] - less) + curve[1, a] * phi_i[2 + i]
                    work[0, 2 * a + i] = bent / length
                    work[1, 2 * a + i] = curve[0, a] * v_i[i] / along[SPEED]
            for a in range(work.shape[1]):
                bend, pull = weight * along[RIGIDITY] * work[0, a], weight * own[STRETCHING] * work[1, a]
                for b in range(work.shape[1]):
                    drag[first + a, first + b] += bend * work[0, b] + pull * work[1, b]


@called()
def _damped(v, h, problem, space):
    """Return the energy [J] that damping takes in a step of length h with the velocity v, by ``space.drag``
    and the rates (M,) of the axial forces' strains."""
    lost = problem.relaxation * _product(problem.rigidity, space.rates, space.rates)
    return h * (_product(space.drag, v, v) + lost)


@called()
def _solve(a, x, count):
    """Solve a symmetric system (count, count), whose upper triangle is overwritten, for x in place.

    Pivots are taken in order: what they lose in digits, Newton's iteration gains again, and a step that does
    not converge is refused. What is zero is skipped: strips and bodies are coupled by impulses alone.
    """
    for k in range(count):
        if a[k, k] == 0.0:
            a[k, k] = TINY
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, count):
            factor = a[k, i] * inverse
            if factor != 0.0:
                x[i] -= factor * x[k]
                for j in range(i, count):
                    a[i, j] -= factor * a[k, j]
    for k in range(count - 1, -1, -1):
        value = x[k]
        for j in range(k + 1, count):
            value -= a[k, j] * x[j]
        x[k] = value / a[k, k]


@once()
def _printed_step(moving, h, problem, space):
    """Take one step; False, with the state as it was, if it is unstable.

    ``moving.z`` is left with the axial forces of q0 and the constraint forces P / h.
    """
    z, v, ahead, force, count = moving.z, moving.v, space.v, space.z, moving.v.size
    gradient, matrix, axial = space.gradient, space.matrix, space.rates.size
    most = moving.status[ENERGY] + abs(_fallen(z, moving.begun, problem)) + FROM_REST * problem.energy
    strain_energy(z, problem, space)
    _fill_drag(z, problem, space)
    for k in range(axial):
        space.rates[k] = _row_times(matrix, count + k, v)
    for k in range(axial):  # a = C^-1 (eps + beta d(eps)/dt)
        for j in range(axial):
            strain = space.strains[j] + problem.relaxation * space.rates[j]
            force[count + k] += problem.rigidity[k, j] * strain
    for i in range(count):
        for k in range(count, count + axial):
            gradient[i] += matrix[k, i] * force[k]
        gradient[i] += _row_times(space.drag, i, v)
    for i in range(count):
        ahead[i] = v[i] - h * _row_times(problem.inverse, i, gradient[:count])  # Eq 21
    moving.counters[SWEEPS] += _apply_impulses(ahead, problem.tolerance / h, problem, space)
    if not 0.5 * _product(problem.mass, ahead, ahead) <= MOST_ENERGY * most:
        return False
    moving.status[LOST] += _damped(v, h, problem, space)
    copy(ahead, v)
    for i in range(z.size):
        z[i] = z[i] + h * v[i] if i < count else force[i]  # Eq 23
    for r in range(space.mu.size):
        z[problem.rows[r]] = space.mu[r] / h
    moving.counters[SOLVES] += 1
    return True


@called()
def _apply_impulses(v, tolerance, problem, space):
    """Sweep over the constraints until no gap of velocities v (Q,) exceeds the tolerance; returns the number
    of sweeps.

    v and impulses ``space.mu`` (R,) are updated in place (Eqs 24 to 26, and 30 where all are one, which needs
    one sweep). A gap is seen just before it is closed, dimensionless. The matrix holds - psi_q in the
    constraints' rows.
    """
    rows, first, matrix, move, mu, change = (
        problem.rows, problem.first, space.matrix, space.move, space.mu, space.change,
    )  # fmt: skip
    for r in range(rows.size):
        mu[r] = 0.0
        for i in range(v.size):
            move[r, i] = 0.0
        for k in range(v.size):
            value = matrix[rows[r], k]
            for i in range(v.size if value != 0.0 else 0):
                move[r, i] += value * problem.inverse[k, i]
    for sweep in range(problem.sweeps):
        largest = 0.0
        for b in range(first.size - 1):
            begin, count = first[b], first[b + 1] - first[b]
            for r in range(count):
                change[r] = _row_times(matrix, rows[begin + r], v)
                largest = max(largest, abs(change[r]) * problem.unit[rows[begin + r]])
                for s in range(count):
                    space.small[r, s] = _row_times(matrix, rows[begin + r], move[begin + s])
            _solve(space.small, change, count)
            for r in range(count):
                mu[begin + r] += change[r]
                for i in range(v.size):
                    v[i] -= move[begin + r, i] * change[r]
        if first.size == 2 or largest <= tolerance:
            return sweep + 1
    return problem.sweeps


@once()
def _stable_step(moving, h, rule, problem, space):
    """Take one step by a rule; False, with the state as it was, if it is not solved or gains energy."""
    z, v, status = moving.z, moving.v, moving.status
    span, lag = _predict(moving, h, rule, problem.turns, space)
    _fill_drag(z, problem, space)
    residual, slowest = _solve_step(span, lag, problem, space, moving.counters)
    if not residual <= 1e3 * problem.tolerance or not slowest > SLOWEST:
        return False
    moves, stored = 0.5 * _product(problem.mass, space.v, space.v), space.energy[0]
    stored -= _fallen(space.z, moving.begun, problem)
    gains = moves + stored > status[ENERGY] + SLACK * problem.energy
    if problem.grounded == 1 and gains:
        # velocities scaled by one factor fulfil constraints at rest as they did before
        if stored > status[ENERGY]:
            return False
        share = ((status[ENERGY] - stored) / moves) ** 0.5
        for i in range(v.size):
            space.v[i] *= share
        for k in range(space.rates.size):
            space.rates[k] *= share
        moving.counters[LIMITED] += 1
        moves = status[ENERGY] - stored
    status[ENERGY] = moves + stored
    status[LOST] += _damped(space.v, h, problem, space)
    copy(z[: v.size], moving.earlier[0])
    copy(v, moving.earlier[1])
    copy(space.v, v)
    copy(space.z, z)
    return True


@once()
def _predict(moving, h, rule, turns, space):
    """Fill the rule's start values and the first guess in ``space``; returns the spans s and r [s]."""
    z, v, reach = moving.z, moving.v, h
    back, half = (1.0 / 3.0 if rule == BACKWARD else 0.0), (0.5 * h if rule == START else 0.0)
    lag = (1.0 - back) * h
    span = lag - half
    for k in range(turns.size):
        reach = min(reach, MOST_REACH / max(abs(v[turns[k]]), TINY))
    copy(z, space.z)
    for i in range(v.size):
        space.base[i] = z[i] + back * (z[i] - moving.earlier[0, i]) + half * v[i]
        space.drift[i] = v[i] + back * (v[i] - moving.earlier[1, i])
        space.v[i] = (z[i] + reach * v[i] - space.base[i]) / span
    return span, lag


@once()
def _solve_step(span, lag, problem, space, counters):
    """Solve the step in space.z (N,) and space.v (Q,) from the guess there: residual and least v / J0.

    span s and lag r [s]; space.base and space.drift hold q~ and v~, space.drag D. The residual
    is in EI/L^2, EI/L, L and rad; far above the tolerance if the iterations were not enough.
    """
    z, v, x, matrix, gradient = space.z, space.v, space.x, space.matrix, space.gradient
    tolerance, turns, before, norm, slowest = problem.tolerance, problem.turns, 1e300, 1e300, 0.0
    for iteration in range(ITERATIONS + 1):
        for i in range(v.size):
            z[i] = space.base[i] + span * v[i]
        space.energy[0], slowest = _fill(z, problem, space)
        _relax(z, v, span, problem, space)
        _add_inertia(v, span, lag, problem.mass, space)
        norm = 0.0
        for i in range(gradient.size):
            value = abs(gradient[i]) * problem.unit[i]
            norm = max(norm, value) if value < 1e300 else 1e300
        near = norm <= tolerance or (norm <= 1e3 * tolerance and norm > 0.5 * before)
        if near or not norm < 1e12 or iteration == ITERATIONS:
            break
        before = norm
        for i in range(x.size):
            x[i] = -gradient[i]
        _solve(matrix, x, x.size)
        counters[SOLVES] += 1
        counters[SWEEPS] += 1
        share = 1.0
        for k in range(turns.size):
            share = min(share, MOST_TURN / max(abs(x[turns[k]]), TINY))
        for i in range(v.size):
            v[i] += share * x[i] / span
        for i in range(v.size, x.size):
            z[i] += share * x[i]
    return norm, slowest


@once()
def _relax(z, v, span, problem, space):
    """Turn the compatibility of damped axial forces into eps + beta d(eps)/dt - C a, over 1 + beta / s.

    Divided so, it keeps its Jacobian (to the first order in the velocity), and the compliance is
    less: a soft constraint with a damper. Strains and rates are kept, and the former's energy.
    """
    gradient, matrix, strains, rates, count = space.gradient, space.matrix, space.strains, space.rates, v.size
    for k in range(strains.size):
        strains[k], row = gradient[count + k], count + k
        rates[k] = _row_times(matrix, row, v)
        for j in range(strains.size):
            strains[k] -= matrix[row, count + j] * z[count + j]
        space.energy[0] -= z[row] * (gradient[row] + strains[k]) / 2.0
    space.energy[0] += 0.5 * _product(problem.rigidity, strains, strains)
    less = 1.0 / (1.0 + problem.relaxation / span)
    for k in range(count, count + strains.size):
        gradient[k] = less * (gradient[k] + problem.relaxation * rates[k - count])
        for j in range(count, count + strains.size):
            matrix[k, j] *= less


@once()
def _add_inertia(v, span, lag, mass, space):
    """Add M (v - v~) / r + D v to the gradient and its derivative in q to the matrix."""
    count, over = v.size, 1.0 / (span * lag)
    for i in range(count):
        push = 0.0
        for j in range(count):
            push += mass[i, j] * (v[j] - space.drift[j]) / lag + space.drag[i, j] * v[j]
            space.matrix[i, j] += mass[i, j] * over + space.drag[i, j] / span
        space.gradient[i] += push


@kernel()
def store(moving, problem, space, record):
    """Fill a record (W,) of the present state."""
    size, count = moving.z.size, moving.v.size
    copy(moving.z, record[:size])
    copy(moving.v, record[size : size + count])
    record[size + count] = strain_energy(moving.z, problem, space)
    record[size + count + 1] = moving.status[LOST]


@kernel()
def advance(moving, h, begin, end, every, stable, whole, problem, space, records):
    """Take the steps ``begin`` ... ``end`` - 1 of length h [s], ``whole`` ones or parts.

    Returns the number of the first step that was not taken; ``moving`` stands at its begin. records: filled
    at the ends of steps whose number ``every`` divides.
    """
    for k in range(begin, end):
        if stable:
            rule = EULER
            if whole:
                rule = BACKWARD if moving.status[COUNTS] == 1.0 else START
            done = _stable_step(moving, h, rule, problem, space)
        else:
            done = _printed_step(moving, h, problem, space)
        moving.status[COUNTS] = 1.0 if done and whole else 0.0
        if not done:
            return k
        moving.counters[STEPS] += 1
        if (k + 1) % every == 0:
            store(moving, problem, space, records[(k + 1) // every - begin // every - 1])
    return end
