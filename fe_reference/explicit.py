"""Explicit integration: central differences with lumped masses, body and attached nodes as one rigid body.

    v_{n+1/2} = v_{n-1/2} + h M^-1 f(u_n),    u_{n+1} = u_n + h v_{n+1/2}

Written about the common centre of mass of body and attached lumped masses, the mass matrix is diagonal and
constant: translation and rotation of the body do not couple and there are no centrifugal terms. Linear and
angular momentum are conserved exactly. Second order; stable for omega h < 2. Velocities are sampled in step
with the positions, v_n = v_{n-1/2} + h a_n / 2.

Source: T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and Structures (2000),
ch. 6.
"""

import numpy as np
from numpy.typing import NDArray

from .compiled import CompiledForces
from .kernels import advance
from .mass import RigidBody, lumped_diagonal, lumped_elements
from .motion import Progress, Samples
from .structure import Structure

Array = NDArray[np.float64]


def critical_step(structure: Structure, body: RigidBody, y: Array) -> float:
    """Return a step [s] below which the scheme is stable for small motion about the state y.

    No frequency of the assembled mesh is above the highest one of its elements taken alone with their own
    lumped masses, K_e x = lambda M_e x in the state y (element eigenvalue inequality). Attaching nodes to the
    body restricts the motion and adds mass, and so does not raise it; the curvature of the master-slave map,
    if it is stiffening, can add as much as itself over the body's inertia. Hence
    h = 2 / sqrt(max lambda + max(0, -sum (R b).f) / J).
    """
    u = structure.element_displacement(y)
    root = np.sqrt(lumped_elements(structure)).T
    tangents = structure.law.tangents(u).transpose(2, 0, 1) / (root[:, :, None] * root[:, None, :])
    highest = float(np.linalg.eigvalsh(tangents)[:, -1].max())
    pull = structure.law.forces(u)[3:5, structure.last_elements]
    curvature = max(0.0, -float(np.sum(structure.arms(y[-1]).T * pull)))
    return float(2.0 / np.sqrt(highest + curvature / body.moment_of_inertia))


class Explicit:
    """The scheme for one structure, reduced about the centre of mass of its `body`."""

    def __init__(self, structure: Structure, body: RigidBody) -> None:
        self.structure = structure
        self.compiled = CompiledForces(structure)
        self.mass = lumped_diagonal(structure, body)
        self.compliance = np.zeros((structure.strips * structure.stations, 3))
        self.compliance[structure.free_nodes] = 1.0 / self.mass[:-3].reshape(-1, 3)

    def run(self, y: Array, v: Array, step: float, chunks: list[int], progress: Progress | None) -> Samples:
        """Integrate from coordinates y and velocities v over chunks of steps; keep a sample after each."""
        s, samples = self.structure, Samples()
        force, energy = self.compiled.forces(y)
        samples.keep(0.0, y, v, 0.5 * float(self.mass @ v**2), energy)
        late = v + 0.5 * step * force / self.mass  # half a step before the start
        u, body = s.displacement(y), y[-3:].copy()
        nodal_v, body_v = np.zeros_like(u), late[-3:].copy()
        nodal_v[s.free_nodes] = late[:-3].reshape(-1, 3)
        masses, state = (self.compliance, 1.0 / self.mass[-3:]), (u, nodal_v, body, body_v)
        done = 0
        for number, steps in enumerate(chunks, start=1):
            advance(*self.compiled.given, *masses, *state, *self.compiled.work, step, steps)
            done += steps
            now = np.concatenate([u[s.free_nodes].ravel(), body])
            force, energy = self.compiled.forces(now)
            now_v = np.concatenate([nodal_v[s.free_nodes].ravel(), body_v]) - 0.5 * step * force / self.mass
            if not samples.keep(done * step, now, now_v, 0.5 * float(self.mass @ now_v**2), energy):
                break
            if progress is not None:
                progress(number, len(chunks))
        samples.counters.update(steps=done, force_evaluations=done + len(samples.time))
        return samples
