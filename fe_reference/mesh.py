"""The scikit-fem mesh of the strips, the reference geometry of their elements and the roots that give way.

One `MeshLine` carries all strips: the mesh coordinate is the arc length along a strip, from 0 at its ground
end, and strips are separate chains of it. Three P1 fields live on it: the displacement u_x, u_y [m] and the
turn phi [rad] of the cross-section, both from the unloaded reference. An end whose root gives way has a turn
phi of its own, and a spring between it and what it is on (`links`); that of a hinge has no stiffness.
"""

from dataclasses import dataclass

import numpy as np
from skfem import Basis, ElementLineP1, ElementVector, MeshLine

from .arrays import Array
from .bending import TERMS
from .effects import CURL, PreStrain, RootCompliance
from .model import Model
from .places import FREE
from .plate import left_in_elements

#: One-point rule: what the shear-deformable element is free of locking by.
MIDPOINT = (np.array([[0.5]]), np.array([1.0]))


@dataclass(frozen=True, kw_only=True, eq=False)
class Elements:
    """Reference geometry and rigidities of the E elements, arrays over the elements.

    Attributes:
        chord: reference chord x2 - x1, (2, E) [m].
        length: reference length (E,) [m].
        axial_rigidity, flexural_rigidity, shear_rigidity: EA [N], EI [N m^2], kGA [N], (E,). Of tapered
        strips their compliances are the means over the element: end force and end moment lengthen and turn
        it exactly; all else errs by the second order of its length.
        linear_density, rotary_density: rho A [kg/m], rho I [kg m], (E,), means over the element.
        plate (E, 2 + 2 TERMS): nu^2 of sections that do not curl freely, else 0; the reach [m] of anticlastic
        bending; the coefficients of what clamps leave of the curl at two points, as in `bending`.
    """

    chord: Array
    length: Array
    axial_rigidity: Array
    flexural_rigidity: Array
    shear_rigidity: Array
    linear_density: Array
    rotary_density: Array
    plate: Array

    @classmethod
    def of(cls, model: Model) -> "Elements":
        """Return those of all elements of a model, strip by strip."""
        chord = np.diff(model.rest, axis=1).reshape(-1, 2).T
        rigid = ("axial_rigidity", "flexural_rigidity", "shear_rigidity", "linear_density", "rotary_density")
        own = {name: np.repeat([getattr(s, name) for s in model.strips], model.elements) for name in rigid}
        if any(strip.tapered for strip in model.strips):
            for name, growth in zip(rigid, _tapers(model), strict=True):
                own[name] = own[name] * growth
        return cls(
            chord=chord,
            length=np.hypot(*chord),
            plate=np.vstack([_plate(model, k) for k in range(len(model.strips))]),
            **own,
        )

    def table(self, natural: PreStrain) -> Array:
        """Return the rows of `law` (E, 10 + 2 TERMS), in SI units."""
        own = [np.full_like(self.length, part) for part in (natural.strain, natural.curvature)]
        rigidities = [self.axial_rigidity, self.flexural_rigidity, self.shear_rigidity]
        known = np.transpose([*self.chord, self.length, *rigidities, *own])
        flat = self.flexural_rigidity[:, None] / (1.0 - self.plate[:, :1])
        return np.hstack([known, flat, self.plate[:, 1:]])


def _tapers(model: Model) -> tuple[Array, ...]:
    """Return EA, EI, kGA, rho A and rho I of the elements over those at the start of their strips (E,)."""
    x, weight = np.polynomial.legendre.leggauss(5)
    places = (np.arange(model.elements)[:, None] + 0.5 * (x + 1.0)) / model.elements
    area, moment = np.hstack([strip.growth(places) for strip in model.strips])
    soft, flexible = (2.0 / (1.0 / each @ weight) for each in (area, moment))
    return soft, flexible, soft, 0.5 * area @ weight, 0.5 * moment @ weight


def strip_basis(model: Model) -> Basis:
    """Return the scikit-fem basis of (u_x, u_y, phi) on all strips; nodes are numbered strip by strip."""
    nodes = np.arange(model.arcs.size).reshape(model.arcs.shape)
    mesh = MeshLine(model.arcs.reshape(1, -1), np.array([nodes[:, :-1].ravel(), nodes[:, 1:].ravel()]))
    return Basis(mesh, ElementVector(ElementLineP1(), 3), quadrature=MIDPOINT)


def _plate(model: Model, k: int) -> Array:
    """Return what the sections of a strip curl in its elements (E, 2 + 2 TERMS)."""
    strip, rows = model.strips[k], np.zeros((model.elements, 2 + 2 * TERMS))
    if strip.width is None or strip.thickness is None or not set(CURL) & set(model.effects.names):
        return rows
    nu = strip.poisson_ratio
    rows[:, [0, 2, 2 + TERMS]] = nu**2
    if "clamped_width" in model.effects:
        ends, flattens = model.arcs[k] / model.lengths[k], "anticlastic" in model.effects
        ratio, points = float(strip.width / model.lengths[k]), 1 if model.element == "reissner" else 2
        left = left_in_elements(ratio, nu, ends, flattens, points)
        rows[:, 2:] = np.broadcast_to(left, (model.elements, 2, TERMS)).reshape(model.elements, -1)
    if "anticlastic" in model.effects:
        rows[:, 1] = np.sqrt(3.0 * (1.0 - nu**2)) * strip.width**2 / strip.thickness
    return rows


def root_stiffness(model: Model) -> Array:
    """Return the stiffness of the roots of the strips (G, 2) [N m]: of hinges 0, inf where none gives way."""
    rows, effect = np.full((len(model.strips), 2), np.inf), model.effects.find(RootCompliance)
    for strip, ends, row in zip(model.strips, model.ends, rows, strict=True):
        if effect is not None and effect.root and strip.thickness is not None:
            row[ends != FREE] = strip.flexural_rigidity / (effect.root * strip.thickness)
        row[[*strip.hinges]] = 0.0
    return rows
