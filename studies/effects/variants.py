"""The scenes that an audit compares, the full one and those that leave effects out, and their sizes."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from spline_model.compile import compile_scene
from spline_model.dynamics import highest_frequency
from spline_model.mechanism import Mechanism
from spline_model.modes import linear_modes, static_state
from spline_model.motion.explicit import stability_limit
from spline_model.motion.start import set_in_motion
from studies.answers.adapters import spline_mechanism
from studies.answers.models import model_of, refusals
from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.cases.effects import Effects
from studies.cases.mechanism import Mechanism as MechanismData

#: Effects that a scene may do without but that could matter, with what they need beside them.
BESIDE = {"section_rotary_inertia": "strip_inertia", "gravity": "bending"}
#: Effects that cannot be left out for nothing, with their simpler form.
SIMPLER = {"stretching": "inextensible"}
#: What goes with an effect when it goes.
TOGETHER = {"strip_inertia": ("section_rotary_inertia",)}
#: What a scene without an effect is called.
CALLED = {"stretching": "inextensible strips", "strip_inertia": "massless strips"}


@dataclass(frozen=True, kw_only=True)
class Variant:
    """A scene in place of the full one.

    Attributes:
        dropped: effects of the full scene that were left out or simplified.
        added: those that were put in though the full scene could not have them.
        effects: of the scene.
    """

    dropped: tuple[str, ...]
    effects: Effects
    added: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """What was changed, in words."""
        words = [f"with {name.replace('_', ' ')}" for name in self.added]
        words += [CALLED.get(name, f"no {name.replace('_', ' ')}") for name in self.dropped]
        return ", ".join(words) or "full scene"


def full_scene(effects: Effects, omitted: Iterable[str] = ()) -> Variant:
    """Return the scene with what could matter beside its own effects, but for what is omitted."""
    names = [*effects.names, *(name for name in beside(effects) if name not in omitted)]
    return Variant(dropped=(), effects=effects.renamed(names))


def beside(effects: Effects) -> list[str]:
    """Return the effects that a scene does not have but that could matter."""
    return [name for name, base in BESIDE.items() if name not in effects.names and base in effects.names]


def without(full: Variant, dropped: Iterable[str]) -> Variant:
    """Return the full scene without these effects, or with their simpler forms."""
    chosen = tuple(dropped)
    gone = {*chosen, *(other for name in chosen for other in TOGETHER.get(name, ()))}
    names = [SIMPLER.get(name, "") if name in gone else name for name in full.effects.names]
    return Variant(dropped=chosen, effects=full.effects.renamed([name for name in names if name]))


@dataclass(frozen=True, kw_only=True)
class Size:
    """Size of a scene in motion.

    Attributes:
        unknowns: coordinates, axial forces and multipliers of a step's equations [1].
        degrees_of_freedom: independent coordinates that have inertia [1].
        highest_frequency: largest natural frequency at rest and at the start of the motion [Hz].
        explicit_step: largest stable step of the explicit integrator there, 2.83 over that [s].
    """

    unknowns: int
    degrees_of_freedom: int
    highest_frequency: float
    explicit_step: float


def size_of(design: Design, settings: SplineSettings) -> Size:
    """Return the size of the design's scene in motion, let go from the end of its path.

    Raises:
        BadInput: what the model refuses; one line. spline_model.errors.ConvergenceError: statics does not
        reach the start.
    """
    mechanism: Mechanism = spline_mechanism(design, settings)
    body = design.body if isinstance(design, MechanismData) else None
    with refusals(model_of(settings), settings):
        system = compile_scene(mechanism.released())
        motion = set_in_motion(system)
        start = static_state(mechanism.at_start(), design.rotation, body=body)[: system.layout.size]
        highest = highest_frequency(system, motion, start)
        modes = linear_modes(system, system.rest, motion.mass)[0]
    return Size(
        unknowns=system.layout.size,
        degrees_of_freedom=len(modes),
        highest_frequency=highest / (2.0 * math.pi),
        explicit_step=stability_limit("explicit", motion) / highest,
    )
