"""Following an equilibrium path: predictor, Newton, a check of every state, halved increments on failure.

A request (what is driven, what is loaded) is followed from rest through the spans of its controls, after the
scene has settled under gravity and natural strains. Where a path ends for want of an equilibrium, the limit
point beyond its last state is looked for.

An increment at which the number of negative eigenvalues changes is halved like one that fails, until the
change goes away (it was another branch, or a sharp bend of this one) or until it is within so small a part of
the path that the two states beside it are one: a critical point.

The predictor is the polynomial through the last states and their rates (Hermite), extrapolated: of order six
from the third increment on, so that one or two iterations are left of an increment.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np
from numpy.polynomial.legendre import leggauss

from .arrays import Array
from .control import LAST, Control, State, equilibrate
from .matrix import GRAIN, Singular
from .read import InvalidParameter
from .response import CriticalPoint, critical_point, limit_point, respond, tipping

Progress = Callable[[int, int], None]
#: What is counted on a path.
COUNTERS = (
    "increments",
    "halvings",
    "newton_iterations",
    "residual_evaluations",
    "tangent_evaluations",
    "factorisations",
)

#: An increment is halved at least so often before it is given up, and until it is this part of the path.
HALVINGS, SMALLEST = 6, 2.0**-20
#: Largest distance of two states that are taken for one, in strip lengths and rad. Another branch is farther
#: away; closer, the round-off of residuals over a stiffness that vanishes at a critical point would be seen.
APART = 1e-4
#: Distance of a state from where the mean of the rates at both ends of the increment leads, over what the
#: increment moved, above which it has jumped. Increments of 45 deg of a pivot stay below 0.04, most jumps are
#: at 1.
OFF_THE_PATH = 0.1
#: Change of the rates over an increment, over its chord, above which it is too long to tell. Increments of
#: 45 deg of a pivot stay below 0.6; a parabola that begins without a slope has 2.
SHARPEST = 1.0
#: Relative mismatch between the total potential gained in an increment and the integral of its rate above
#: which the increment has jumped to another branch; on one branch the two-point Hermite rule below errs by
#: less than 1 % in any sane increment. Energies are told apart down to the round-off of EI/L and of the
#: energy of natural strains, which may cancel along the whole path.
WORK_MISMATCH = 0.01
ROUND_OFF = 1e-10
#: Largest turn of an element's end from its chord [rad]: beyond a quarter turn the element is folded, not
#: bent.
DISTORTION = 0.5 * np.pi
#: States that the predictor looks back at.
BACK = 3
#: Least mean distance of these states, in parts of the step.
CLOSEST = 0.5
#: Step below which a path is straight, in parts of it.
STRAIGHT = 2.0**-9


@dataclass(kw_only=True, eq=False)
class Path:
    """The states of one path, its critical points and the counted iterations.

    Attributes:
        control: held coordinates and load of the span that is followed.
        states: states of equilibrium at the ends of increments, at their load factors [1].
        trail: the last of them on the span that is followed, and at the ends of halved increments as well.
        counters: counted increments and iterations by name.
        failures: residual norms of the iterations of each increment that failed.
        critical: the critical points that were passed.
        message: why the path stopped ("" if it did not).
        seconds: that following it took [s].
    """

    control: Control
    states: list[State] = field(default_factory=list)
    trail: list[State] = field(default_factory=list)
    counters: Counter[str] = field(default_factory=Counter)
    failures: list[tuple[float, ...]] = field(default_factory=list)
    critical: list[CriticalPoint] = field(default_factory=list)
    message: str = ""
    seconds: float = 0.0

    def begin(self, control: Control, y: Array | None = None) -> None:
        """Store the state of equilibrium in which a span begins, in place of the last one.

        Args:
            control: held coordinates and load of the span.
            y: coordinates (size,) [m, rad]; None: those of the last state, or rest.

        Raises:
            InvalidParameter: the model can move freely.
        """
        last = self.states.pop() if self.states else None
        if y is None:
            y = np.zeros(control.structure.size) if last is None else last.y
        found = control.balance(y, control.span[0])
        try:
            there = respond(control, replace(found, factors=control.factors(found, GRAIN)))
        except Singular as error:
            expected = "clamps that hold it, or stiffnesses less far apart [1]"
            raise InvalidParameter("strips", "a model that can move freely", expected) from error
        self.control = control
        self.trail = [there if last is None else replace(there, work=last.work, norms=last.norms)]
        self.states.append(self.trail[0])

    def settle(self, increments: int) -> None:
        """Go from rest to the equilibrium under gravity and natural strains, where its span begins.

        If that cannot be reached, the path holds the shape at rest and says why.
        """
        control, y = self.control, None
        if control.structure.constant_words:
            still = replace(control, values=np.stack([control.values[0]] * 2), load=None)
            self.begin(replace(still, span=(0.0, 1.0), settling=True))
            if all(self.advance(k / increments) for k in range(1, increments + 1)):
                y = self.states[-1].y
            self.counters["settling_increments"] = self.counters.pop("increments", 0)
            self.states.clear()
        self.begin(control, y)

    def advance(self, target: float) -> bool:
        """Go from the last state to `target` [1] in one increment or in halved ones, and keep its end.

        If that is not reached, keep the limit point that is in the way.

        Returns:
            Whether it was reached.
        """
        ends, whole = [target], abs(target - self.states[-1].parameter)
        while ends:
            state = self.trail[-1]
            step = abs(ends[-1] - state.parameter)
            outcome = equilibrate(self.control, _ahead(self.trail, ends[-1]), ends[-1], self.counters)
            failure = outcome.failure
            if not failure:
                reached = self._worked(state, respond(self.control, outcome))
                failure = self._doubt(state, reached) or self._judged(state, reached)
            if not failure:
                self.critical += tipping(self.control, state, reached, self.counters)
                self.trail = [*self.trail[1 - BACK :], reached]
                ends.pop()
                continue
            self.failures.append(outcome.norms)
            if step <= min(SMALLEST, 0.5**HALVINGS * whole):
                ways = " and ".join(self.control.describe(at) for at in (state.parameter, ends[-1]))
                halvings = f"{round(np.log2(whole / step))} halvings of the increment"
                last = f"last residual {outcome.norms[-1]:.3g}"
                self.message = f"{failure} between {ways} after {halvings}; {last}"
                self.critical += limit_point(self.control, self.trail)
                return False
            self.counters["halvings"] += 1
            ends.append(0.5 * (state.parameter + ends[-1]))
        self.states.append(self.trail[-1])
        self.counters["increments"] += 1
        return True

    def remark(self) -> str:
        """Return what is to be said of the path: its critical points, why it ended early; else ""."""
        told = [point.text for point in self.critical if point.text]
        told += [self.message] if self.message else []
        if self.states[-1].inertia:
            told.append("the last state is unstable")
        return "; ".join(told)

    def _judged(self, before: State, after: State) -> str:
        """Return why a state is not on the branch of the one before, or ""; keep a critical point of them.

        States that are taken for one are on one branch, whatever the rates at the point between them are.
        """
        step, moved = after.parameter - before.parameter, after.y - before.y
        crossed = before.inertia != after.inertia
        if crossed and abs(step) > SMALLEST:
            return "the stability changes"
        first, last = step * before.rate, step * after.rate
        size_of = self.control.structure.extent
        size = size_of(moved)
        off = size_of(moved - 0.5 * (first + last)) > OFF_THE_PATH * size
        one = size <= (APART if abs(step) <= SMALLEST else 10.0 * LAST)  # or nothing moves but round-off
        if not one and (off or size_of(last - first) > SHARPEST * size):
            return "the state lies on another branch (it is not where the path leads)"
        if crossed:
            self.critical.append(critical_point(self.control, before, after))
        return ""

    def _worked(self, before: State, after: State) -> State:
        """Return a state with the work done until then."""
        # loads a F.q: their work is [a F.q] less the integral of F.q da, which is part of the conjugate
        done, former = (self.control.share(each.parameter) * each.at.work for each in (after, before))
        work = before.work + (done - former) + _integral(self.control, before, after)
        return replace(after, work=work)

    def _doubt(self, before: State, after: State) -> str:
        """Return why a converged state is not believed, or ""."""
        structure = self.control.structure
        if after.at.ends[:, 4].max() > DISTORTION:
            return "an element is folded"
        step, gained = after.parameter - before.parameter, after.potential - before.potential
        largest = abs(before.conjugate) + abs(after.conjugate)
        unit = structure.moment_unit + abs(self.control.rates(after.y, after.parameter)[-1])
        scale = max(abs(gained), 0.5 * abs(step) * largest)
        if abs(gained - _integral(self.control, before, after)) > WORK_MISMATCH * scale + ROUND_OFF * unit:
            return "the state lies on another branch (energy gained and work done differ)"
        return ""


def _ahead(trail: Sequence[State], parameter: float) -> Array:
    """Return the coordinates at a parameter by the polynomial through the last states and their rates.

    States that are too close for so long a step are not used: extrapolation would amplify their round-off.
    A step that was halved often is straight: next to a critical point the rest is round-off.
    """
    state, back = trail[-1], trail[::-1]
    step = abs(parameter - state.parameter)
    far = [k * CLOSEST * max(step, STRAIGHT) for k in range(len(back))]
    known = [at for at, least in zip(back, far, strict=True) if abs(state.parameter - at.parameter) >= least]
    nodes = [at.parameter for at in known for _ in range(2)]
    column = [at.y for at in known for _ in range(2)]
    guess, factor = state.y.copy(), 1.0
    for k in range(1, len(nodes)):
        column = [
            known[i // 2].rate
            if nodes[i + k] == nodes[i]
            else (column[i + 1] - column[i]) / (nodes[i + k] - nodes[i])
            for i in range(len(nodes) - k)
        ]
        factor *= parameter - nodes[k - 1]
        guess += factor * column[0]
    return guess


def _integral(control: Control, before: State, after: State) -> float:
    """Return the integral of the conjugate over a step [J] by Hermite's two-point rule, of fourth order.

    To it comes the work of loads that follow, by Gauss' rule on the cubic through both states.
    """
    step, load, structure = after.parameter - before.parameter, control.load, control.structure
    total = 0.5 * step * (before.conjugate + after.conjugate) + step**2 / 12.0 * (before.slope - after.slope)
    if load is not None and structure.loads.follows:
        from scipy.interpolate import CubicHermiteSpline  # whose import takes longer than a small solve

        ends = [(at.parameter, at.y, at.rate) for at in (before, after)]
        curve = CubicHermiteSpline(*zip(*ends, strict=True))
        for place, weight in zip(*leggauss(3), strict=True):
            p = before.parameter + 0.5 * step * (1.0 + place)
            own = np.subtract(*(structure.load_force(curve(p), load, dead)[0] for dead in (False, True)))
            total += 0.5 * step * weight * control.share(p) * float(own @ curve(p, 1))
    return total


def follow(controls: Sequence[Control], increments: int, progress: Progress | None = None) -> Path:
    """Return the path from the settled state under gravity and natural strains through all spans.

    Args:
        controls: the spans, in order. increments: equal increments of each span.
        progress: called as progress(done, total) after every increment.

    A path that cannot be followed to its end is returned with the reason.
    """
    path, total, began = Path(control=controls[0]), increments * len(controls), perf_counter()
    path.settle(increments)
    for done in range(0 if path.message else total):
        leg, k = divmod(done, increments)
        if leg and not k:
            path.begin(controls[leg])
        if not path.advance((done + 1) / total):
            break
        if progress is not None:
            progress(done + 1, total)
    path.seconds = perf_counter() - began
    return path
