"""The kinds of effect a scene is made of.

    M a + dV/dq + f_d(q, v) - f(q, t) - G(q, t)^T lambda = 0,      psi(q, t) = 0

An effect is a frozen value that says what it acts on and with which constants; it holds no
state and no flag. ``spline_model.compile`` sorts the effects once into one flat table a
class; a class that no effect names has a table of length zero.
"""

from __future__ import annotations

from typing import ClassVar


class Potential:
    """Adds an energy V(q), its gradient and its Hessian."""


class Inertia:
    """Adds to the mass matrix M and to the kinetic energy."""


class Dissipation:
    """Adds a force against the velocity; it takes energy out and never puts any in."""


class Load:
    """Adds a generalised force f."""


class Constraint:
    """Adds rows psi(q, t) = 0, their Jacobian G and second derivatives.

    Rows are written in metres and radians, so that multipliers are N and N m.
    """

    rows: ClassVar[int]
