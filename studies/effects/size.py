"""How large a scene is: unknowns, degrees of freedom, highest frequency and explicit step."""

import math
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
from studies.cases.mechanism import Mechanism as MechanismData


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
