"""Work of a static path or a motion that does not depend on machine or language: counted operations.

One sum, difference, product, quotient, root or angle of two numbers is one operation. The counts per point
and per element are those of the code as it stands (`evaluate_points` and `condense` of the spline, `forces`
and `tangents` of the elements): a test runs that code on numbers that count and holds it to the formulas
here. What grows more slowly with the size is left out: moving a strip's tangent to its own coordinates, the
checks of a state, energies.

Factorisations are those of symmetric elimination in the order of the unknowns that suits each model:

- spline, condensed: m axial forces, then W = 2 n - 6 own coordinates of a strip leave three of its tip;
  states behind a good prediction are confirmed with its factors;
- spline, bordered: a dense LU of all N unknowns, 2/3 N^3 (Golub and Van Loan, Matrix Computations, 3.2);
- B-spline, bordered, from 150 unknowns on: its sparse LU, a constant number for each unknown, which a test
  counts from the factors;
- elements: node by node along a strip, three pivots that each reach to the next node's end, as the banded
  factors of the reference have them.

In motion:

- spline, leapfrog: every evaluation takes the forces of the strips in control points (`add_forces`) and
  multiplies those of the inner ones with the constant inverse of their mass; what is done for the tips and
  the body does not grow with the size and is left out;
- spline, implicit: every Newton iteration assembles residual and tangent of the bordered system and takes a
  dense LU of it;
- elements, explicit: every evaluation takes the forces of all elements, and moves three coordinates a node
  by four operations each. Nothing is factorised.

The operations of a pivot with r rows below are 1 + r for the multipliers and r (r + 1) for the symmetric
update; those of the substitution 4 r + 1.
"""

import math
from collections.abc import Mapping

from studies.answers.settings import FeSettings, Settings, SplineSettings

STRIPS = 2
#: Operations of one element (see above): its forces and energy, and its tangent beside them.
ELEMENT_FORCES, ELEMENT_TANGENT = 75, 43
#: Operations of one Gauss point that depend neither on the control points nor on the axial forces.
POINT = 153
#: The sparse LU of a long B-spline: from so many unknowns on, and operations and entries of it for each.
SPARSE_FROM, SPARSE_FLOPS, SPARSE_ENTRIES = 150, 308, 27


#: Sizes and operations of a static path, and of a motion, as columns of tables.
WORK = ("unknowns", "points", "iterations", "factorisation_flops", "assembly_flops", "flops")
MOVED_WORK = ("unknowns", "points", "steps", "evaluations", "factorisations", "flops")


def work_of(settings: Settings, counters: Mapping[str, int]) -> dict[str, float]:
    """Return the work of a path of the pivot with its default effects, from its settings and counters.

    Keys, those of `WORK`: unknowns (of the system that one iteration solves), points (quadrature points of
    all strips; elements count one each), iterations (of Newton over the path), factorisation_flops (of one
    factorisation), assembly_flops (of one residual with its tangent), flops (of the whole path, substitutions
    included; like assembly_flops NaN of the shear-deformable elements, which a library assembles: what that
    does is not counted).
    """
    if isinstance(settings, FeSettings):
        return _of_elements(settings, counters)
    condensed = (settings.basis, settings.measure, settings.stretch) == ("bezier", "material", "mixed")
    return _condensed(settings, counters) if condensed else _bordered(settings, counters)


def _pivot_flops(rows: int) -> int:
    """Return the operations that eliminate one unknown which `rows` others still depend on."""
    return 1 + rows + rows * (rows + 1)


def _assembly_flops(points: int, functions: int, modes: int) -> int:
    """Return the operations of `evaluate_points` for one strip.

    Pairs of control points are filled up to eights, as the vectors of a processor are.

    Args:
        points: Gauss points; functions: basis functions at a point; modes: axial forces at a point.
    """
    pairs = -(-functions * (functions + 1) // 16) * 8
    point = POINT + 16 * functions + 26 * pairs + modes * (4 + 5 * functions)
    return points * point + 6 * (modes + functions) + 7


def _condensation_flops(own: int, modes: int) -> int:
    """Return the operations of `condense` for one strip: own coordinates W, axial forces K."""
    size = own + 3
    axial = modes * (1 + 3 * size + size * (size + 1))
    # two more a row carry the residual along
    return axial + sum(_pivot_flops(rows) + 2 * rows for rows in range(3, size))


def _confirmation_flops(points: int, functions: int, modes: int) -> int:
    """Return the operations that confirm a state of one strip without a tangent: `evaluate_residual`, and its
    Hessian times the rate."""
    at_point = 16 * functions + 4 * modes
    return points * (183 + 2 * at_point) + 8 * modes + 4 * functions - 2


def _forward_flops(own: int, modes: int) -> int:
    """Return the operations that bring a right-hand side of one strip to its tip, by the factors at hand."""
    return modes * (2 * own + 7) + own * (own + 6)


def _recovery_flops(own: int, modes: int) -> int:
    """Return the operations of `recover` for one strip: the substitution."""
    return own * (own + 7) + modes * (2 * own + 8)


def _modes(settings: SplineSettings) -> int:
    """Return axial forces and slide modes of a strip; none where stretching is by quadrature."""
    return 0 if settings.stretch == "consistent" else settings.points - 1


def _points(settings: SplineSettings) -> int:
    """Return the Gauss points of a strip."""
    degree = settings.points - 1 if settings.basis == "bezier" else 3
    return (settings.gauss_points or degree + 3) * (settings.points - degree)


def _condensed(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, float]:
    n, modes, points = settings.points, _modes(settings), _points(settings)
    own = 2 * n - 6
    assembly = STRIPS * _assembly_flops(points, n - 1, modes)
    factorisation = STRIPS * _condensation_flops(own, modes)
    solves = counters["newton_iterations"] + counters["increments"] + 1
    confirmed = counters["residual_evaluations"] - counters["factorisations"]
    confirmation = (
        _confirmation_flops(points, n, modes) + _forward_flops(own, modes) + _recovery_flops(own, modes)
    )
    return {
        "unknowns": 2 + STRIPS * (own + modes),
        "points": STRIPS * points,
        "iterations": counters["newton_iterations"],
        "factorisation_flops": factorisation,
        "assembly_flops": assembly,
        "flops": counters["factorisations"] * (assembly + factorisation)
        + STRIPS * (confirmed * confirmation + solves * _recovery_flops(own, modes)),
    }


def _bordered(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, float]:
    n, modes, points = settings.points, _modes(settings), _points(settings)
    bezier = settings.basis == "bezier"
    # a hat basis has two modes at a point, and the slide mode reaches everywhere
    at_point = modes if bezier or not modes else min(modes, 3)
    size = STRIPS * (2 * n + modes + 6) + 3 + 1
    assembly = STRIPS * _assembly_flops(points, n if bezier else 4, at_point)
    sparse = settings.basis == "bspline" and size >= SPARSE_FROM
    factorisation = SPARSE_FLOPS * size if sparse else 2 * size**3 // 3
    substitution = 2 * size * (SPARSE_ENTRIES if sparse else size)
    confirmation = STRIPS * _confirmation_flops(points, n if bezier else 4, at_point)
    return {
        "unknowns": size,
        "points": STRIPS * points,
        "iterations": counters["newton_iterations"],
        "factorisation_flops": factorisation,
        "assembly_flops": assembly,
        "flops": counters["tangent_evaluations"] * assembly
        + (counters["residual_evaluations"] - counters["tangent_evaluations"]) * (confirmation + substitution)
        + counters["factorisations"] * (factorisation + substitution),
    }


def _of_elements(settings: FeSettings, counters: Mapping[str, int]) -> dict[str, float]:
    inner = max(settings.elements - 1, 0)
    counted = settings.element == "corotational"
    rows = STRIPS * ([5, 4, 3] * max(inner - 1, 0) + [4, 3, 2] * min(inner, 1)) + [1, 0]
    factorisation = sum(_pivot_flops(row) for row in rows)
    count = STRIPS * settings.elements
    tangents = counters["tangent_evaluations"] * count * (ELEMENT_FORCES + ELEMENT_TANGENT)
    residuals = counters["residual_evaluations"] * count * ELEMENT_FORCES
    solves = counters["factorisations"] * (factorisation + sum(4 * row + 1 for row in rows))
    return {
        "unknowns": STRIPS * 3 * inner + 2,
        "points": count,
        "iterations": counters["newton_iterations"],
        "factorisation_flops": factorisation,
        "assembly_flops": count * (2 * ELEMENT_FORCES + ELEMENT_TANGENT) if counted else math.nan,
        "flops": tangents + residuals + solves if counted else math.nan,
    }


#: Operations that move the three coordinates of a node by one step.
MOVED_NODE = 12


def work_of_motion(settings: Settings, counters: Mapping[str, int]) -> dict[str, float]:
    """Return unknowns, points, steps, evaluations, factorisations and flops of a motion of the pivot."""
    if isinstance(settings, FeSettings):
        return _of_moving_elements(settings, counters)
    return _explicit(settings, counters) if "evaluations" in counters else _implicit(settings, counters)


def _strip_force_flops(control_points: int) -> int:
    """Return the operations of `add_forces` for a Bezier strip, n + 2 Gauss points, n - 1 axial forces."""
    points, modes = control_points + 2, control_points - 1
    return points * (16 * control_points + 4 * modes + 40) + modes


def _moved(*counts: float) -> dict[str, float]:
    return dict(zip(MOVED_WORK, counts, strict=True))


def _of_moving_elements(settings: FeSettings, counters: Mapping[str, int]) -> dict[str, float]:
    count, evaluations = STRIPS * settings.elements, counters["force_evaluations"]
    nodes = count - STRIPS
    flops = evaluations * (count * ELEMENT_FORCES + nodes * MOVED_NODE)
    return _moved(3 * nodes + 3, count, counters["steps"], evaluations, 0, flops)


def _explicit(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, float]:
    n, evaluations = settings.points, counters["evaluations"]
    inner = 4 * (n - 3) * (n - 1)
    flops = evaluations * STRIPS * (_strip_force_flops(n) + inner)
    return _moved(STRIPS * (2 * n - 6) + 3, STRIPS * (n + 2), counters["steps"], evaluations, 0, flops)


def _implicit(settings: SplineSettings, counters: Mapping[str, int]) -> dict[str, float]:
    n, factorisations = settings.points, counters["factorisations"]
    modes, points = n - 1, n + 2
    size = STRIPS * (2 * n + modes + 6) + 3
    evaluations = factorisations + counters["steps"]
    flops = evaluations * STRIPS * _assembly_flops(points, n, modes)
    flops += factorisations * (2 * size**3 // 3 + 2 * size**2)
    return _moved(size, STRIPS * points, counters["steps"], evaluations, factorisations, flops)
