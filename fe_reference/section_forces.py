"""Fields along the strips at any states of a path or a motion: shape, strains and section forces."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .effects.named import PreStrain
from .model import Model
from .recovery import at_nodes, nodal_angles, recover
from .statics import body_motion

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class StripFields:
    """Nodal values of G strips with P nodes from root to tip, for S states.

    Attributes:
        arc_length (G, P): at rest [m]. rest_shape (G, P, 2): positions at rest [m].
        shape (S, G, P, 2): positions [m].
        rotation (S, G, P): turn of the section from rest, as the nodes have it, without wrapping [rad].
        curvature (S, G, P): d theta / d s0, that at rest and M / EI + natural curvature [1/m].
        stretch (S, G, P): 1 + N / EA + natural strain [1].
        axial_force, shear_force, bending_moment (S, G, P): as in `solution.StaticSolution` [N], [N m].
        reactions (S, G, 2, 3): force x, y [N] and moment [N m] on the strip at its root and its tip; at a
            free end the force that acts there.
        rest_bodies (B, 2): centres at rest [m]. bodies (S, B, 3): centre [m] and turn [rad].
    """

    arc_length: Array
    rest_shape: Array
    shape: Array
    rotation: Array
    curvature: Array
    stretch: Array
    axial_force: Array
    shear_force: Array
    bending_moment: Array
    reactions: Array
    rest_bodies: Array
    bodies: Array


#: What `recovery` gives of each state, by the names here.
RECOVERED = ("shape", "axial_force", "shear_force", "bending_moment")


def strip_fields(model: Model, states: Array) -> StripFields:
    """Return the fields of states (S, size) in the reduced coordinates, natural strains in full.

    Section forces are those that hold the elements: they obey the balance of the mesh, with weight and
    inertia lumped at the nodes, to the residual of the state. Exact at the nodes without distributed load;
    with it, and for strains, of second order in the element length.
    """
    structure, y = model.structure, np.asarray(states)
    grid = (structure.strips, structure.stations)
    recovered = [recover(structure, each) for each in y]
    found = {name: np.array([getattr(each, name) for each in recovered]) for name in RECOVERED}
    pre_strain = model.effects.find(PreStrain) or PreStrain()
    elements, rows = structure.elements, (structure.strips, -1)
    bending = elements.flexural_rigidity.reshape(rows)[:, :1]
    axial = elements.axial_rigidity.reshape(rows)[:, :1]
    turning = np.diff(nodal_angles(structure), axis=1) / elements.length.reshape(rows)
    moved = [body_motion(structure, y, k) for k in range(len(model.bodies))]
    return StripFields(
        arc_length=structure.basis.mesh.p[0].reshape(grid),
        rest_shape=np.array([strip.nodes for strip in model.strips]),
        rotation=np.array([structure.displacement(each)[:, 2].reshape(grid) for each in y]),
        curvature=at_nodes(turning, turning) + found["bending_moment"] / bending + pre_strain.curvature,
        stretch=1.0 + found["axial_force"] / axial + pre_strain.strain,
        reactions=np.array([each.clamp_reactions for each in recovered]),
        rest_bodies=np.array([body.centre for body in model.bodies]).reshape(-1, 2),
        bodies=np.array(moved).reshape(-1, len(y), 3).swapaxes(0, 1),
        **found,
    )
