"""The scikit-fem mesh of the strips and the reference geometry of their elements.

One `MeshLine` carries all strips: the mesh coordinate is the arc length along a strip, from 0 at its ground
end, and strips are separate chains of it. Three P1 fields live on it: the displacement u_x, u_y [m] and the
turn phi [rad] of the cross-section, both from the unloaded reference.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementLineP1, ElementVector, MeshLine

if TYPE_CHECKING:
    from .model import Model

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

#: One-point rule: free of shear and membrane locking in the two-node shear-deformable element.
MIDPOINT = (np.array([[0.5]]), np.array([1.0]))


@dataclass(frozen=True, kw_only=True, eq=False)
class Elements:
    """Reference geometry and rigidities of the E elements, arrays over the elements.

    Attributes:
        chord: reference chord x2 - x1, (2, E) [m].
        length: reference length (E,) [m].
        axial_rigidity, flexural_rigidity, shear_rigidity: EA [N], EI [N m^2], kGA [N], (E,).
        linear_density, rotary_density: rho A [kg/m], rho I [kg m], (E,).
    """

    chord: Array
    length: Array
    axial_rigidity: Array
    flexural_rigidity: Array
    shear_rigidity: Array
    linear_density: Array
    rotary_density: Array


def strip_basis(model: "Model") -> Basis:
    """Return the scikit-fem basis of (u_x, u_y, phi) on all strips; nodes are numbered strip by strip."""
    arcs, connections, first = [], [], 0
    for strip in model.strips:
        lengths = np.linalg.norm(np.diff(strip.nodes, axis=0), axis=1)
        arcs.append(np.concatenate([[0.0], np.cumsum(lengths)]))
        node = first + np.arange(len(lengths))
        connections.append(np.array([node, node + 1]))
        first += len(strip.nodes)
    mesh = MeshLine(np.concatenate(arcs)[None, :], np.hstack(connections))
    return Basis(mesh, ElementVector(ElementLineP1(), 3), quadrature=MIDPOINT)


def reference_elements(model: "Model") -> Elements:
    """Return the reference geometry and rigidities of all elements, strip by strip."""
    chords = [np.diff(strip.nodes, axis=0).T for strip in model.strips]

    def constant(name: str) -> Array:
        values = [
            np.full(c.shape[1], getattr(s.section, name)) for s, c in zip(model.strips, chords, strict=True)
        ]
        return np.concatenate(values)

    chord = np.hstack(chords)
    names = ("axial_rigidity", "flexural_rigidity", "shear_rigidity", "linear_density", "rotary_density")
    return Elements(chord=chord, length=np.hypot(*chord), **{name: constant(name) for name in names})
