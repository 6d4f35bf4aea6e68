"""Fields along the strips at any states of a path or a motion: shape, strains and section forces."""

from dataclasses import dataclass

import numpy as np

from .arrays import Array
from .effects import PreStrain
from .errors import InvalidParameter
from .law import FORCES
from .model import Model, require_model
from .places import FREE
from .structure import Structure, structure_of


@dataclass(frozen=True, kw_only=True, eq=False)
class StripFields:
    """Nodal values of G strips with P nodes from root to tip, for S states.

    Attributes:
        arc_length (G, P): at rest [m]. rest_shape (G, P, 2): positions at rest [m].
        shape (S, G, P, 2): positions [m].
        rotation (S, G, P): turn of the section from rest, as the nodes have it, without wrapping [rad]; at an
            end whose root gives way that of the strip's section, not the body's.
        curvature (S, G, P): d theta / d s0, that at rest and M / EI + natural curvature [1/m]; of sections
            that do not curl freely the means of the adjacent elements' turns over their lengths.
        stretch (S, G, P): 1 + N / EA + natural strain [1].
        axial_force, shear_force (S, G, P): N = n.t, V = n.normal [N] at the nodes: n is the force of the part
            beyond on the part before, t the normal of the cross-section, normal = t turned by +90 deg.
        bending_moment (S, G, P): M at the nodes [N m], positive for counter-clockwise curvature from root.
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

    def tips(self, model: Model) -> dict[str, Array]:
        """Return the places x, y [m] of free ends and the turns of their sections [rad] (S, 3), by strips."""
        free = {k: -end for k, ends in enumerate(model.ends) for end in (0, 1) if ends[end] == FREE}
        return {
            model.strip_names[k]: np.hstack([self.shape[:, k, at], self.rotation[:, k, at, None]])
            for k, at in free.items()
        }

    def outer_stress(self, model: Model) -> Array:
        """Return the largest magnitude of stress at the nodes (S, G, P) [Pa], sections taken as rectangles.

        |N| / A + |M| d / (2 I) with the depth d = sqrt(12 I / A). Of a strip that does not curl freely this
        is the mean across the width, to which the stress is equal where the section is held flat or wholly
        free.
        """
        area, inertia = _sections(model)
        stress: Array = np.abs(self.axial_force) / area
        stress += np.abs(self.bending_moment) * np.sqrt(3.0 / (area * inertia))
        return stress


def strip_fields(model: Model, states: Array, ends: Array | None = None) -> StripFields:
    """Return the fields of states along the strips, natural strains in full.

    Section forces are those that hold the elements: they obey the balance of the mesh, with weight and
    inertia lumped at the nodes, to the residual of the state. Those at a node are the means of the end values
    of the adjacent elements, which agree to the residual. Exact at the nodes without distributed load; with
    it, and for strains, of second order in the element length. Reactions are the section forces at the ends.

    Parameters
    ----------
    model : Model
        With the structure that the states belong to.
    states : (S, size) m and rad
        Reduced coordinates.
    ends : (S, E, 5), default None
        Of the E elements, if known.

    Returns
    -------
    StripFields
        Arrays (S, G, P) of G strips with P nodes: axial force, shear force, moment and more.

    Raises
    ------
    InvalidParameter
        States of another structure, such as another number of elements.

    References
    ----------
    Reissner (1972), as in ``fe_reference.law``.

    Examples
    --------
    With ``pivot`` of the example of ``fe_reference.model.cross_axis_pivot``:

    >>> path = solve_statics(pivot, rotation=0.1, increments=1)
    >>> strip_fields(pivot, path.states).bending_moment.shape
    (2, 2, 9)
    """
    require_model(model)
    structure, y = structure_of(model), np.asarray(states)
    if y.ndim != 2 or y.shape[1] != structure.size:
        expected = f"(S, {structure.size}), of this model with its number of elements"
        raise InvalidParameter("states", y.shape, f"shape {expected} [m, rad]")
    if ends is None:
        ends = np.array([structure.evaluate(each, asked=FORCES).ends for each in y])
    grid, rows, many = (structure.strips, structure.stations), (structure.strips, -1), len(y)
    force_x, force_y, first, last = np.moveaxis(ends[..., :4], -1, 0).reshape(4, many, *rows)
    nodal = np.array([structure.displacement(each)[: structure.nodes] for each in y]).reshape(many, *grid, 3)
    force_x, force_y, moment = _midpoints(force_x), _midpoints(force_y), _at_nodes(-first, last)
    angle = _nodal_angles(structure)
    c, s = np.cos(angle + nodal[..., 2]), np.sin(angle + nodal[..., 2])
    axial, beyond = force_x * c + force_y * s, np.stack([force_x, force_y, moment], axis=-1)
    natural, length = model.effects.find(PreStrain) or PreStrain(), structure.elements.length.reshape(rows)
    area, inertia = _sections(model)
    bent = moment / (_moduli(model) * inertia)
    if structure.elements.plate[:, 0].any():  # where it is no multiple of the moment
        bent = _midpoints(np.diff(nodal[..., 2]) / length)
    turning = np.diff(angle, axis=1) / length
    return StripFields(
        arc_length=structure.basis.mesh.p[0].reshape(grid),
        rest_shape=model.rest,
        shape=model.rest + nodal[..., :2],
        rotation=nodal[..., 2],
        curvature=_at_nodes(turning, turning) + bent + natural.curvature,
        stretch=1.0 + axial / (_moduli(model) * area) + natural.strain,
        axial_force=axial,
        shear_force=force_y * c - force_x * s,
        bending_moment=moment,
        reactions=np.stack([-beyond[:, :, 0], beyond[:, :, -1]], axis=2),
        rest_bodies=model.centres,
        bodies=structure.body_places(y),
    )


def _moduli(model: Model) -> Array:
    """Return Young's moduli of the strips (G, 1) [Pa]."""
    return np.array([[strip.youngs_modulus] for strip in model.strips])


def _sections(model: Model) -> tuple[Array, Array]:
    """Return area [m^2] and second moment [m^4] at the nodes (G, P)."""
    growths = zip(model.strips, model.arcs / model.lengths[:, None], strict=True)
    own = [(strip, *strip.growth(places)) for strip, places in growths]
    area = np.array([strip.area * growth for strip, growth, _ in own])
    return area, np.array([strip.second_moment_of_area * growth for strip, _, growth in own])


def _nodal_angles(structure: Structure) -> Array:
    """Return the reference direction at the nodes (G, P) [rad] from those of the chords; see `_midpoints`."""
    chord = structure.elements.chord.reshape(2, structure.strips, -1)
    return _midpoints(np.unwrap(np.arctan2(chord[1], chord[0]), axis=1))


def _at_nodes(first: Array, last: Array) -> Array:
    """Merge the end values of elements (..., E) at the nodes (..., P): the means of the adjacent elements."""
    inner = 0.5 * (first[..., 1:] + last[..., :-1])
    return np.concatenate([first[..., :1], inner, last[..., -1:]], axis=-1)


def _midpoints(values: Array) -> Array:
    """Return values of the elements' middles (..., E) at the nodes (..., P).

    They are the means of the adjacent elements, and at the ends the line through the last two: a force there
    holds the weight or the inertia of the half element that stands at the end node, and a curved strip has
    the direction of its end.
    """
    if values.shape[-1] == 1:
        return np.repeat(values, 2, axis=-1)
    first = 1.5 * values[..., :1] - 0.5 * values[..., 1:2]
    last = 1.5 * values[..., -1:] - 0.5 * values[..., -2:-1]
    return np.concatenate([first, 0.5 * (values[..., 1:] + values[..., :-1]), last], axis=-1)
