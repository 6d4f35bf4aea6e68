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

from .actions import Actions, advance
from .arrays import Array
from .drives import Piece
from .errors import InvalidParameter
from .law import TANGENT
from .mass import RigidBodies, lumped_elements
from .motion import Instant, Samples, Scheme
from .structure import Structure


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
    curvature = structure.evaluate(y).curvature[:, 0]
    square = highest + float(np.max(curvature / bodies.moment_of_inertia, initial=0.0))
    actions = Actions(structure)
    decay = actions.fastest_decay(y, lumped, bodies.mass, bodies.moment_of_inertia) if actions.damped else 0.0
    return float(4.0 / (decay + np.sqrt(decay**2 + 4.0 * square)))


class Explicit(Scheme):
    """The scheme for one structure, reduced about the centres of mass of its `bodies`.

    Raises:
        InvalidParameter: a coordinate without inertia, which no explicit step can follow.
    """

    def __init__(self, structure: Structure, bodies: RigidBodies) -> None:
        super().__init__(structure, bodies)
        if not np.all(self.mass > 0.0):
            raise InvalidParameter(
                "integrator",
                "central-difference",
                "generalised-alpha where strips or bodies have no inertia: their stable step is zero [name]",
            )
        self.compliance = np.zeros((structure.strips * structure.stations, 3))
        self.compliance[structure.free_nodes] = 1.0 / self.mass[: structure.first_body].reshape(-1, 3)

    def go(self, now: Instant, piece: Piece, samples: Samples) -> Instant:
        """Return the instant after a piece of steps."""
        s, actions, h, totals = self.structure, self.actions, piece.step, np.zeros(2)
        late = now.v - 0.5 * h * now.a  # half a step before
        nodal_v, bodies = np.zeros((s.strips * s.stations, 3)), now.y[s.first_body :].reshape(-1, 3).copy()
        nodal_v[s.free_nodes] = late[: s.first_body].reshape(-1, 3)
        state = (s.displacement(now.y), nodal_v, bodies, late[s.first_body :].reshape(-1, 3).copy())
        compliance = (self.compliance, self.inverse[s.first_body :].reshape(-1, 3))
        advance(actions.acting, compliance, state, totals, now.time, h, piece.steps)
        y, late = (
            np.concatenate([nodes[s.free_nodes].ravel(), carried.ravel()])
            for nodes, carried in (state[::2], state[1::2])
        )
        time, first = now.time + piece.steps * h, now.acting
        acting = actions.resist(y, late, time)
        a = -self.inverse * acting.force
        v = late + 0.5 * h * a
        # what the loop gathered is brought from mid-step to the sample
        led = float((acting.force - first.force)[self.held] @ v[self.held])
        given = acting.load_power - first.load_power + led
        samples.books += totals
        samples.books += 0.5 * h * given, h * (acting.loss_power - first.loss_power)
        samples.counters.update(steps=piece.steps, force_evaluations=piece.steps + 1)
        return Instant(time=time, y=y, v=v, a=a, acting=acting)
