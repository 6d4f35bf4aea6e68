"""The place of each strip, body, axial force and multiplier among the unknowns of a scene."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Slices of the unknowns z = (q, a, lambda).

    q holds the control points of the strips (x0, y0, x1, y1, ...) and then x, y, theta
    of each body (the generalised coordinates of Eq 4); a the axial-force modes of the
    mixed strips; lambda the multipliers in the order of the scene's constraints.

    Attributes
    ----------
    strips : start of each strip's control points, and their number, by name.
    bodies : start of each body's three coordinates, by name.
    modes : start and number of axial-force modes of each MixedStretching effect, in scene order.
    multipliers : start and number of rows of each constraint, in scene order.
    """

    strips: dict[str, tuple[int, int]]
    bodies: dict[str, int]
    modes: tuple[tuple[int, int], ...]
    multipliers: tuple[tuple[int, int], ...]
    coordinate_count: int
    size: int

    @property
    def multiplier_start(self) -> int:
        """First multiplier, behind the coordinates and the axial forces."""
        return self.coordinate_count + sum(count for _, count in self.modes)

    def strip(self, name: str) -> slice:
        """Return the slice of a strip's control points, 2 n entries [m]."""
        start, count = self.strips[name]
        return slice(start, start + 2 * count)

    def body(self, name: str) -> slice:
        """Return the slice of a body's x, y, theta [m, m, rad]."""
        start = self.bodies[name]
        return slice(start, start + 3)

    def coordinate_of(self, place: int) -> tuple[str, int]:
        """The body that a place in q belongs to, and which of its coordinates."""
        return next((name, place - at) for name, at in self.bodies.items() if 0 <= place - at < 3)

    @property
    def poses(self) -> slice:
        """Slice of x, y, theta of all bodies."""
        return slice(self.coordinate_count - 3 * len(self.bodies), self.coordinate_count)

    def axial_modes(self, effect: int) -> slice:
        """Return the slice of the axial-force modes [N] of a MixedStretching effect."""
        start, count = self.modes[effect]
        return slice(start, start + count)

    def rows(self, constraint: int) -> slice:
        """Return the slice of a constraint's multipliers [N, N m]."""
        start, count = self.multipliers[constraint]
        return slice(start, start + count)
