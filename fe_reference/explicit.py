"""Explicit integration: central differences with lumped masses, bodies and attached nodes as rigid bodies.

    v_{n+1/2} = v_{n-1/2} + h M^-1 f(u_n, v_{n-1/2}, t_n),    u_{n+1} = u_n + h v_{n+1/2}

Written about the common centres of mass of bodies and attached lumped masses, the mass matrix is diagonal and
constant: translation and rotation of a body do not couple and there are no centrifugal terms. Linear and
angular momentum are conserved exactly. Second order without dampers; they act at the velocities half a step
before, which leaves an error of first order in (damping rate) h. Stable for h^2 w^2 + 2 h c < 4 with the
frequencies w and the ratios c of damping to mass. Velocities are sampled in step with the positions,
v_n = v_{n-1/2} + h a_n / 2.

Source: T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and Structures (2000),
ch. 6.
"""

import numpy as np
from numpy.typing import NDArray

from .actions import Actions, Resistance, advance
from .errors import InvalidParameter
from .law import TANGENT
from .mass import RigidBodies, lumped_diagonal, lumped_elements
from .motion import FLOOR, Energy, Progress, Samples
from .structure import Structure

Array = NDArray[np.float64]


def critical_step(structure: Structure, bodies: RigidBodies, y: Array) -> float:
    """Return a step [s] below which the scheme is stable for small motion about the state y.

    No frequency of the assembled mesh is above the highest one of its elements taken alone with their own
    lumped masses, K_e x = lambda M_e x in the state y (element eigenvalue inequality). Attaching nodes to a
    body restricts the motion and adds mass, and so does not raise it; the curvature of the master-slave map,
    if it is stiffening, can add as much as itself over the body's inertia. Hence
    w^2 = max lambda + max over the bodies of max(0, -sum (R b).f) / J.

    Dampers reduce the step: with c the sum of the highest ratios of damping to mass of strips and bodies,
    h = 4 / (c + sqrt(c^2 + 4 w^2)); without them it is 2 / w.
    """
    lumped = lumped_elements(structure)
    root = np.sqrt(lumped).T
    tangents = structure.element_matrices(y, TANGENT) / (root[:, :, None] * root[:, None, :])
    highest = float(np.linalg.eigvalsh(tangents)[:, -1].max())
    curvature = structure.evaluate(y).curvature
    square = highest + float(np.max(curvature / bodies.moment_of_inertia, initial=0.0))
    actions = Actions(structure)
    decay = actions.fastest_decay(y, lumped, bodies.mass, bodies.moment_of_inertia) if actions.damped else 0.0
    return float(4.0 / (decay + np.sqrt(decay**2 + 4.0 * square)))


class Explicit:
    """The scheme for one structure, reduced about the centres of mass of its `bodies`.

    Raises:
        InvalidParameter: a coordinate without inertia, which no explicit step can follow.
    """

    def __init__(self, structure: Structure, bodies: RigidBodies) -> None:
        self.structure = structure
        self.actions = Actions(structure)
        self.mass = lumped_diagonal(structure, bodies)
        if not np.all(self.mass > 0.0):
            raise InvalidParameter(
                "integrator",
                "central-difference",
                "generalised-alpha where strips or bodies have no inertia: their stable step is zero [name]",
            )
        self.compliance = np.zeros((structure.strips * structure.stations, 3))
        self.compliance[structure.free_nodes] = 1.0 / self.mass[: structure.first_body].reshape(-1, 3)
        self.body_compliance = 1.0 / self.mass[structure.first_body :].reshape(-1, 3)
        self.totals = np.zeros(2)

    def run(self, y: Array, v: Array, step: float, chunks: list[int], progress: Progress | None) -> Samples:
        """Integrate from coordinates y and velocities v over chunks of steps; keep a sample after each."""
        s, actions, done = self.structure, self.actions, 0
        samples = Samples(floor=FLOOR * s.moment_unit)
        first = self.actions.resist(y, v, 0.0)
        self.totals[:] = 0.0
        samples.keep(0.0, y, v, self._energy(y, v, step, first, first))
        late = v + 0.5 * step * first.force / self.mass  # half a step before the start
        nodal_v, bodies = np.zeros((s.strips * s.stations, 3)), y[s.first_body :].reshape(-1, 3).copy()
        nodal_v[s.free_nodes] = late[: s.first_body].reshape(-1, 3)
        state = (s.displacement(y), nodal_v, bodies, late[s.first_body :].reshape(-1, 3).copy())
        for number, steps in enumerate(chunks, start=1):
            tables = (actions.given, actions.dissipative, actions.histories, actions.arrays)
            masses = (self.compliance, self.body_compliance)
            advance(*tables, *masses, *state, self.totals, done * step, step, steps)
            done += steps
            now, late = (
                np.concatenate([nodes[s.free_nodes].ravel(), carried.ravel()])
                for nodes, carried in (state[::2], state[1::2])
            )
            acting = actions.resist(now, late, done * step)
            now_v = late - 0.5 * step * acting.force / self.mass
            energy = self._energy(now, now_v, step, first, acting)
            if not samples.keep(done * step, now, now_v, energy):
                break
            if progress is not None:
                progress(number, len(chunks))
        samples.counters.update(steps=done, force_evaluations=done + len(samples.time))
        return samples

    def _energy(self, y: Array, v: Array, step: float, first: Resistance, now: Resistance) -> Energy:
        """Return the energies of a sample; what the loop gathered is brought from mid-step to the sample."""
        return Energy(
            kinetic=0.5 * float(self.mass @ v**2),
            strain=now.strain,
            gravity=now.gravity,
            work=float(self.totals[0]) + 0.5 * step * (now.load_power - first.load_power),
            dissipated=float(self.totals[1]) + step * (now.loss_power - first.loss_power),
        )
