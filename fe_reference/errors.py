"""Refusals: a parameter outside its domain, and a solve that stopped, with what it found until then."""

from typing import Any

#: Residual norms of iterations, one tuple an attempt.
Norms = tuple[tuple[float, ...], ...]


class InvalidParameter(ValueError):
    """A parameter outside its domain; the message is one line "name: got X, expected Y [unit]".

    Examples
    --------
    >>> try:
    ...     BodyDesign(name="tip", centre=(0.1, 0.0), mass=-1.0)
    ... except InvalidParameter as refusal:
    ...     print(refusal)
    mass: got -1.0, expected a number not below 0 [kg]
    """

    def __init__(self, name: str, got: object, expected: str) -> None:
        super().__init__(name, got, expected)  # of which another process makes it again
        self.name = name

    def __str__(self) -> str:
        name, got, expected = self.args
        return f"{name}: got {got!r}, expected {expected}"


class ConvergenceError(RuntimeError):
    """A solve that stopped before its end.

    Attributes:
        solution: the converged part (`StaticSolution` or `Trajectory`), last good state last.
        load_factor: fraction of the path (statics) or of the duration (dynamics) that was reached.
        history: dimensionless residual norms, one tuple an attempt, those that failed last.
    """

    def __init__(
        self, message: str, *, solution: Any = None, load_factor: float = 0.0, history: Norms = ()
    ) -> None:
        super().__init__(message)
        self.solution = solution
        self.load_factor = load_factor
        self.history = history
