"""One energy-consistent step between two crooked states, as several tests look at it."""

import numpy as np

from spline_model.compile import compile_scene
from spline_model.motion.energy_consistent import store
from spline_model.motion.mechanism import Moving
from spline_model.motion.start import set_in_motion
from spline_model.motion.step import assemble, improve, prepare
from spline_model.motion.strip import set_points


class Step:
    """A step of a released scene from a state near rest, at rest or with some velocity; dimensionless."""

    def __init__(self, scene, seed=3, size=0.03):
        system = compile_scene(scene)
        motion = set_in_motion(system)
        self.model = Moving.of(motion)
        self.generator = np.random.default_rng(seed)
        nothing = np.zeros(len(motion.mass))
        self.state, self.work = self.model.arrays(system.rest, nothing, nothing)
        self.state.y[:] += self.generator.uniform(-size, size, self.state.y.size)
        set_points(self.state, self.model.strips, self.model.masses)
        self.dy = self.generator.uniform(-size, size, self.state.y.size)
        self.work.held[self.model.masses.drive_at] = 1

    @property
    def axial(self):
        """Places of the axial forces in y."""
        own, modes = self.model.strips.own, self.model.strips.compliance.shape[1]
        strips, poses = self.model.strips.mass.shape[0], len(self.model.masses.inertia)
        each = poses + np.arange(strips * (own + modes)).reshape(strips, -1)
        return each[:, own:].ravel()

    def residual(self, dy, h):
        """Residual of the step dy."""
        self.work.dy[:] = dy
        prepare(1e-3, h, self.state, self.model.strips, self.model.masses, self.work)
        assemble(h, self.state, self.model.strips, self.model.masses, self.work)
        return self.work.residual.copy()

    def tangent_error(self, h):
        """Largest error of the derivative along Newton's correction, which is minus the residual, over it."""
        for array in (self.state.velocity, self.state.rate):
            array[:] = self.generator.uniform(-1.0, 1.0, array.shape) * 0.03 / h
        residual = self.residual(self.dy, h)
        assert improve(self.model.strips, self.model.masses, self.work)
        change = self.work.dy - self.dy
        size = 2e-4 / np.abs(change).max()
        f = [self.residual(self.dy + k * size * change, h) for k in (-2, -1, 1, 2)]
        slope = (8 * (f[2] - f[1]) - f[3] + f[0]) / (12 * size)
        free = np.ones(len(slope), dtype=bool)
        free[self.model.masses.drive_at] = False
        return np.abs(slope + residual)[free].max() / np.abs(residual[free]).max()

    def strain_energy(self, y):
        """Strain energy in the state y, in EI/L."""
        before, record = self.state.y.copy(), np.zeros(self.model.width)
        for place in (y, before):
            self.state.y[:] = place
            set_points(self.state, self.model.strips, self.model.masses)
            if place is y:
                store(self.state, self.model.strips, self.model.masses, self.work, record)
        return record[-3]

    def after(self):
        """The state y behind the step."""
        turns = np.arange(2, len(self.model.masses.inertia), 3)
        y = self.state.y + self.dy
        y[turns] = self.state.y[turns] + 2.0 * np.arctan(0.5 * self.dy[turns])
        return y
