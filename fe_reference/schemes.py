"""Schemes that integrate a motion, with the same elements and the same lumped masses.

**Explicit**: central differences, bodies and attached nodes as rigid bodies.

    v_{n+1/2} = v_{n-1/2} + h M^-1 f(u_n, v_{n-1/2}, t_n),    u_{n+1} = u_n + h v_{n+1/2}

Written about the common centres of mass of bodies and attached lumped masses, the mass matrix is diagonal and
constant: translation and rotation of a body do not couple and there are no centrifugal terms. Linear and
angular momentum are conserved exactly. Second order without dampers; they act at the velocities half a step
before, which leaves an error of first order in (damping rate) h. Stable for h^2 w^2 + 2 h c < 4 with the
frequencies w and the ratios c of damping to mass. Velocities are sampled in step with the positions,
v_n = v_{n-1/2} + h a_n / 2.

Source: T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and Structures (2000),
ch. 6.

**Implicit**: generalised-alpha.

    M ((1 - am) a_{n+1} + am a_n) + (1 - af) f_{n+1} + af f_n = 0,    f_n = f(q_n, v_n, t_n)
    q_{n+1} = q_n + h v_n + h^2 ((1/2 - b) a_n + b a_{n+1}),    v_{n+1} = v_n + h ((1 - g) a_n + g a_{n+1})

with am = (2 r - 1)/(r + 1), af = r/(r + 1), g = 1/2 - am + af, b = (1 - am + af)^2 / 4 and spectral radius r
at infinite frequency: second order, and high frequencies that the step does not resolve are damped if r < 1.
Energy is not conserved exactly in large motion; it is recorded, the work of loads and dampers by the
trapezoidal rule over the steps; a step that gains energy is halved, and a motion that still does is stopped.
A remark lists the frequencies that the step does not resolve. About the common centres of mass M is diagonal
and constant.

Strips without inertia are legal: their rows hold no mass and become (1 - af) f_{n+1} + af f_n = 0, so that
the strips stay in equilibrium with the bodies if they start there, and else reach it as (-r)^n.

Source: J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371-375.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .actions import advance
from .arrays import Array, Flags
from .law import MATERIAL, TANGENT
from .loads import fastest
from .mass import lumped_elements
from .matrix import Factors, Singular
from .model import Model
from .motion import Instant, Scheme
from .read import InvalidParameter


class Explicit(Scheme):
    """The scheme for one structure, reduced about the centres of mass of its bodies.

    Raises:
        InvalidParameter: a coordinate without inertia, which no explicit step can follow.
    """

    def __init__(self, model: Model, led: Sequence[int] = ()) -> None:
        super().__init__(model, led)
        if not np.all(self.mass > 0.0):
            expected = (
                "generalised-alpha where strips or bodies have no inertia: their stable step is zero [name]"
            )
            raise InvalidParameter("integrator", "central-difference", expected)

    def critical_step(self, y: Array, held: Flags) -> float:
        """Return a step [s] below which the scheme is stable for small motion about y (size,) [m, rad].

        No frequency of the assembled mesh is above the highest one of its elements taken alone with their own
        lumped masses, K_e x = lambda M_e x in the state y (element eigenvalue inequality). Attaching nodes to
        a body restricts the motion and adds mass, and so does not raise it; the curvature of the master-slave
        map, if it is stiffening, can add as much as itself over the body's inertia. Hence
        w^2 = max lambda + max over the bodies of max(0, -sum (R b).f) / J. Springs between bodies and
        loads off the centres add their own.

        The least mass of bodies that are led one way, by what is `held` (size,), is the lumped one times
        1 - |(X, Y)| / sqrt(m J) with the first moment (X, Y).

        Dampers reduce the step: with c the sum of the highest ratios of damping to mass of strips and bodies,
        h = 4 / (c + sqrt(c^2 + 4 w^2)); without them it is 2 / w.
        """
        s, links = self.structure, self.structure.links
        light, turning, steep = np.zeros((3, len(s.numbers)))  # over masses and moments of inertia of rows
        s.of_bodies(light)[:] = 1.0 / self.bodies.mass
        s.of_bodies(turning)[:] = 1.0 / self.bodies.moment_of_inertia
        rows, carriers, offsets, *_ = s.carried
        arms, turning[rows] = np.hypot(*offsets.T), turning[carriers]
        light[rows], steep[rows] = light[carriers] + arms**2 * turning[rows], arms * turning[rows]
        square = self._highest(turning, y, TANGENT)
        square += float(np.max(s.evaluate(y).curvature * turning, initial=0.0))
        square += s.loads.steepest(steep) + fastest(links, links[2], light, turning)
        for _, _, own, inertia, *first, turn in self.couplings(held):
            square /= 1.0 if turn else 1.0 - np.hypot(*first) / np.sqrt(own * inertia)
        decay = s.drag + fastest(links, links[3], light, turning)
        if s.relaxation:
            decay += s.relaxation * self._highest(turning, y, MATERIAL)
        return float(4.0 / (decay + np.sqrt(decay**2 + 4.0 * square)))

    def _highest(self, turning: Array, y: Array, asked: int) -> float:
        """Return a squared frequency [1/s^2] above those of all elements, and of roots that give way.

        A root of stiffness k between a node of the inertia m and a body of the inertia J is shared out
        between them, with 2 a b <= r a^2 + b^2 / r and r^2 = m / J: k (1 + r) to the node, k (1 + 1 / r) to
        the body.
        """
        s = self.structure
        lumped, (roots, ends, stiffness, _), last = lumped_elements(s), s.links, s.stations - 1
        local = s.evaluate(y, asked=asked).matrices[: lumped.shape[1], :6, :6]
        (node, row), stiffness = ends[:roots].T, stiffness[:roots, 2]
        strip, place = np.divmod(node, last + 1)
        end = np.sign(place)
        element, turn = strip * last + end * (last - 1), 2 + 3 * end
        ratio = np.sqrt(lumped[turn, element] * turning[row])
        local[element, turn, turn] += stiffness * (1.0 + ratio)
        on_bodies = np.zeros(len(turning))
        np.add.at(on_bodies, row, stiffness * ratio * (1.0 + ratio) / lumped[turn, element])
        root = np.sqrt(lumped).T
        highest = np.linalg.eigvalsh(local / (root[:, :, None] * root[:, None, :]))[:, -1].max()
        return float(highest + on_bodies.max())

    def go(self, now: Instant, h: float, steps: int) -> Instant:
        """Return the instant after steps of h [s]."""
        s, totals = self.structure, np.zeros(2)
        late = now.v - 0.5 * h * now.a  # half a step before
        state = s.displacement(now.y), s.velocity(late)
        acting = s.tables, s.written, s.curvature, s.loads.histories
        drives = self.coupled, s.coordinates[self.held], s.spread(self.inverse)
        advance(*acting, *drives, state, totals, now.time, h, steps)
        y, late = (s.gathered(moved) for moved in state)
        after = self.resist(y, late, now.time + steps * h)
        a = -self.inverse * after.force
        v = late + 0.5 * h * a
        # what the loop gathered is brought from mid-step to the sample
        led = float((after.force - now.force)[self.held] @ v[self.held])
        given = after.load_power - now.load_power + led
        self.books += totals
        self.books += 0.5 * h * given, h * (after.loss_power - now.loss_power)
        self.counters.update(steps=steps, force_evaluations=steps + 1)
        return replace(after, v=v, a=a)

    def remarks(self, step: float) -> list[str]:
        """Return that the step [s], though stable, does not keep the energy."""
        drift = float(np.abs(self.gained()).max())
        if drift <= DRIFT:
            return []
        return [f"the energy drifts by {drift:.1%}: the step of {step:.3g} s is too long: take a shorter one"]


#: Spectral radius of the implicit scheme at infinite frequency, and the constants that follow from it.
RADIUS = 0.9
AM, AF = (2.0 * RADIUS - 1.0) / (RADIUS + 1.0), RADIUS / (RADIUS + 1.0)
GAMMA, BETA = 0.5 - AM + AF, 0.25 * (1.0 - AM + AF) ** 2
#: Error of the balance of energies of explicit steps, over the energy at stake, that is not remarked on.
DRIFT = 1e-3
#: Iterations of one step. The tangent of an earlier step serves until the residual falls less than tenfold.
ITERATIONS = 20
SLOW = 0.1
#: Dimensionless residual (forces over EI/L^2, moments over EI/L) of a step that is solved.
TOLERANCE = 1e-9
#: Correction [strip lengths, rad] of one that is, where round-off keeps the residual above that.
SMALL = 1e-10
#: A step that fails is halved at most so often.
HALVINGS = 6
#: Relative gain of energy that stops a motion, and loss to numerical damping that is remarked on.
GAIN = LOST = 0.01
#: Fewest steps in the mean period of a motion, by its kinetic energy, that are not remarked on.
COARSEST = 20.0


class Implicit(Scheme):
    """The scheme for a structure reduced about the centres of mass of its bodies."""

    blow_up = GAIN

    def __init__(self, model: Model, led: Sequence[int] = ()) -> None:
        super().__init__(model, led)
        rest = self.structure.evaluate(np.zeros(self.structure.size)).tangent
        self.least = TOLERANCE * self.structure.scale + self.structure.round_off(rest)
        self._factor: tuple[float, Factors] | None = None

    def start(self, time: float, y: Array, v: Array, held: Flags) -> Instant:
        """Return an instant as any scheme does, without the factors of what was held before.

        Round-off of forces does not accelerate: light nodes of a short strip would be strip lengths away.

        Args:
            time: instant [s].
            y, v: coordinates (size,) [m, rad] and velocities (size,) [m/s, rad/s].
            held: which coordinates are led at their velocities (size,).
        """
        self._factor = None
        now = super().start(time, y, v, held)
        return replace(now, a=np.where(self.unloaded(now), 0.0, now.a))

    def go(self, now: Instant, h: float, steps: int) -> Instant | None:
        """Return the instant after steps of h [s], or None where one has no solution."""
        begin = now.time
        for done in range(1, steps + 1):
            after = self.step(now, h)
            if after is None:
                self.message = f"no solution of the step of {h:.3g} s at {now.time:.6g} s"
                return None
            powers = np.array([self._powers(at) for at in (now, after)])
            self.books += 0.5 * h * powers.sum(axis=0)
            self.content += self.mass @ after.a**2, self.mass @ after.v**2
            self.counters["steps"] += 1
            now = replace(after, time=begin + done * h)
        return now

    def step(self, now: Instant, h: float, depth: int = 0) -> Instant | None:
        """Return the instant after h [s], in halved steps where needed; None if those fail too.

        A step that gains energy has found another solution of its equations, far from the motion.
        """
        after = self._single(now, h)
        if after is not None and (depth == HALVINGS or not self._gains(now, after, h)):
            return after
        self.counters["halvings"] += 1
        if depth == HALVINGS:
            return None
        middle = self.step(now, 0.5 * h, depth + 1)
        return None if middle is None else self.step(middle, 0.5 * h, depth + 1)

    def _gains(self, now: Instant, after: Instant, h: float) -> bool:
        """Return whether a step of h [s] has gained energy, by more than stops a motion."""
        before, since = (self.kinetic(at.y, at.v) - self.beside(at) + at.strain for at in (now, after))
        work, lost = 0.5 * h * np.sum([self._powers(at) for at in (now, after)], axis=0)
        gain = since - before + after.gravity - now.gravity - work + lost
        return not gain <= GAIN * max(self.stake, self.floor, before, abs(work))

    def _single(self, now: Instant, h: float) -> Instant | None:
        """Return the instant after one step of h [s], or None if the iteration does not converge."""
        mass, scale, time = self.mass, self.structure.scale, now.time + h
        coasting = now.y + h * now.v + h**2 * (0.5 - BETA) * now.a
        drifting = now.v + h * (1.0 - GAMMA) * now.a
        held = AM * mass * now.a + AF * now.force
        reach = BETA * h**2
        # the unknown is the acceleration: taken from differences of positions it would drown in round-off
        a, norms = now.a, [np.inf]
        for _ in range(ITERATIONS):
            y, v = coasting + reach * a, drifting + GAMMA * h * a
            after = replace(self.resist(y, v, time), a=a)
            residual = (1.0 - AM) * mass * a + (1.0 - AF) * after.force + held
            residual[self.held] = 0.0
            norms.append(float(np.abs(residual / scale).max()))
            self.counters["force_evaluations"] += 1
            if norms[-1] <= TOLERANCE:
                return after
            if not np.isfinite(norms[-1]):
                break
            self.counters["iterations"] += 1
            if self._factor is None or h != self._factor[0] or norms[-1] > SLOW * norms[-2]:
                try:
                    self._factor = h, self._factorise(y, time, h)
                except Singular:
                    break
            change = self._factor[1].solve(residual)
            if (np.abs(residual) <= self.least).all() and self.structure.extent(change) <= SMALL:
                return after
            a = a - change / reach
        self.history.append(tuple(norms[1:]))
        self._factor = None
        return None

    def _factorise(self, y: Array, time: float, h: float) -> Factors:
        """Return the factors of the tangent of a step of h [s] to y at an instant [s], kept for later steps.

        The derivative of damper forces with respect to position is neglected: the Newton iteration is a
        modified one.
        """
        tangent = self.structure.evaluate(y, load=self.structure.loads.factors(time)).tangent
        if self.structure.damped:
            tangent.data += GAMMA / (BETA * h) * self.structure.damping_matrix(y).data
        tangent.data *= 1.0 - AF
        tangent.left *= 1.0 - AF
        tangent.data[tangent.pattern.diagonal] += (1.0 - AM) / (BETA * h**2) * self.mass
        self.counters["factorisations"] += 1
        return tangent.factors(self.held)

    def _powers(self, at: Instant) -> tuple[float, float]:
        """Return the power of loads and drives, and of the dampers [W]."""
        led = float(at.force[self.held] @ at.v[self.held])
        return at.load_power + led, at.loss_power

    def remarks(self, step: float) -> list[str]:
        """Return what the step h [s] leaves unresolved.

        The ratio of a.M a and v.M v, summed over the steps, is the mean square of the circular frequencies by
        their kinetic energy.
        """
        remarks, content, lost = [], self.content, -float(self.gained()[-1])
        if content[0] * step**2 * COARSEST**2 > 4.0 * np.pi**2 * content[1]:
            each = 2.0 * np.pi * np.sqrt(content[1] / content[0]) / step
            remarks.append(f"only {each:.3g} steps in a mean period of what moves: take shorter steps")
        if lost > LOST:
            remarks.append(f"the scheme damped {lost:.1%} of the energy away: take shorter steps")
        return remarks
