"""The one list of settings that are compared: of every model, for the static path and for the swing.

Implicit schemes of all models take the same steps; explicit ones take their own, near the largest stable one.
Surrogates are of statics alone. In motion strips have no shear and no rotary inertia of their sections, but
for Exudyn's exact beams, which have both: two theories are 3e-2 rad apart after 0.05 s, so that each is held
against the limit of its own. Of Exudyn's motions a relative tolerance of 1e-5 was tried as well: it is the
cheapest setting at no error.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from studies.cost.exudyn import exudyn_ancf, exudyn_exact
from studies.cost.model import Model, elements, spline
from studies.cost.openseespy import openseespy_frame
from studies.cost.surrogates import SURROGATES
from studies.engine import lacking
from studies.record.style import BLACK, BLUE, ORANGE, PURPLE, SKY, Look

#: Other codes.
PEERS: dict[str, Model] = {each.name: each for each in (exudyn_ancf, exudyn_exact, openseespy_frame)}

#: What models are compared under, the spline first.
SPLINE, ITSELF, ELEMENTS, SHEAR = "spline", "spline, by itself", "finite elements", "elements with shear"
EXUDYN, OPENSEES, SURROGATE = "Exudyn", "OpenSees", "surrogates"
GROUPS = (ITSELF, ELEMENTS, SHEAR, EXUDYN, OPENSEES, SURROGATE)
#: Looks of those that are drawn: a colour a code.
LOOKS = {
    SPLINE: Look(label="spline", colour=BLUE, marker="x"),
    ITSELF: Look(label="spline, by itself", colour=SKY, line="--", marker="D"),
    ELEMENTS: Look(label="finite elements", colour=BLACK, marker="s"),
    EXUDYN: Look(label="Exudyn", colour=PURPLE, marker="^"),
    OPENSEES: Look(label="OpenSees", colour=ORANGE, line="--", marker="<"),
}

#: How settings are told; others by their name.
WORDS: dict[str, Callable[[Any], str]] = {
    "control_points": "n = {}".format,
    "elements": "{} elements".format,
    "accuracy": "accuracy {:g}".format,
    "integrator": str,
    "element": str,
    "step": lambda step: f"{1e6 * step:.3g} µs",
    "tolerance": "tolerance {:g}".format,
    "relative_tolerance": "relative tolerance {:g}".format,
    "spectral_radius": "spectral radius {:g}".format,
}
#: What makes a setting finer: more of it, or less.
FINER = {"step": -1.0, "accuracy": -1.0, "control_points": 1.0, "elements": 1.0}


def missing() -> str:
    """Return what this machine lacks of a study that holds the suite against all other codes; or nothing."""
    gone = [name.split()[0] for name, peer in PEERS.items() if not peer.installed()]
    return lacking("peers", list(dict.fromkeys(gone)))


@dataclass(frozen=True, eq=False, kw_only=True)
class Setting:
    """One setting of one model.

    Attributes:
        model: that is asked. group: what it is compared under. settings: keywords of the model.
    """

    model: Model
    group: str
    settings: Mapping[str, Any]

    @property
    def theory(self) -> str:
        """What the strips' energies are measured in, which decides on the limit: "material" or "shear"."""
        return "shear" if self.model.sheared or self.settings.get("element") == "reissner" else "material"

    @property
    def finer(self) -> str:
        """Name of what makes it finer: the step, if it has one; empty if nothing does."""
        return next((name for name in FINER if name in self.settings), "")

    @property
    def columns(self) -> dict[str, Any]:
        """What it is in tables.

        A `family` are settings that differ in their `fineness` alone; of paths, in control points or elements
        and accuracy.
        """
        told = {name: WORDS[name](value) for name, value in self.settings.items()}
        finer = {self.finer} if self.finer == "step" else {*FINER}
        same = [words for name, words in told.items() if name not in finer]
        return {
            "model": self.model.name,
            "group": self.group,
            "setting": ", ".join(told.values()) or "closed form",
            "theory": self.theory,
            "family": ", ".join((self.model.name, *same)),
            "fineness": FINER[self.finer] * float(self.settings[self.finer]) if self.finer else 1.0,
        }


def grid(model: Model, group: str, **axes: Sequence[Any]) -> list[Setting]:
    """Return the settings of a model on a grid, the last axis changing fastest."""
    return [
        Setting(model=model, group=group, settings=dict(zip(axes, values, strict=True)))
        for values in product(*axes.values())
    ]


#: Elements a strip of the suite's own elements on a path.
MESHES = (4, 5, 10, 20, 40, 80, 160, 320)


def paths() -> list[Setting]:
    """Return the settings of the static path."""
    tolerances = (1e-5, 1e-6, 1e-8)
    exact = (1, 2, 3, 4, 6, 8, 12, 16, 20, 24)
    return [
        *grid(spline, SPLINE, control_points=range(4, 13)),
        *grid(spline, ITSELF, accuracy=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)),
        *grid(elements, ELEMENTS, elements=MESHES),
        *grid(elements, SHEAR, elements=MESHES, element=("reissner",)),
        *(each for model in SURROGATES.values() for each in grid(model, SURROGATE)),
        *grid(exudyn_ancf, EXUDYN, elements=(2, 4, 6, 8, 12, 16, 24, 40), relative_tolerance=tolerances),
        *grid(exudyn_exact, EXUDYN, elements=exact, relative_tolerance=tolerances),
        *grid(openseespy_frame, OPENSEES, elements=(5, 10, 20, 40, 80, 160), tolerance=(1e-8, 1e-10)),
    ]


#: Steps of all implicit schemes [s].
STEPS = (5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5)


def swings() -> list[Setting]:
    """Return the settings of the motion after the release of the paper's pivot."""
    exudyn: dict[str, Any] = {"step": STEPS, "spectral_radius": (0.9, 0.6), "relative_tolerance": (1e-3,)}
    explicit, implicit = ("central-difference",), ("generalised-alpha",)
    return [
        *grid(spline, SPLINE, control_points=range(4, 11), integrator=("leapfrog",)),
        *grid(spline, SPLINE, control_points=(4, 5, 6, 7, 8), integrator=("energy",), step=STEPS),
        *grid(elements, ELEMENTS, elements=(10, 16, 24, 36), integrator=explicit),
        *grid(elements, ELEMENTS, elements=(10, 16, 24), integrator=implicit, step=STEPS),
        *grid(exudyn_ancf, EXUDYN, elements=(3, 4, 6, 8, 12), **exudyn),
        *grid(exudyn_exact, EXUDYN, elements=(2, 3, 4, 6), **exudyn),
        *grid(openseespy_frame, OPENSEES, elements=(10, 20, 40), step=STEPS),
    ]
