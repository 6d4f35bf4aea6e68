"""The one list of settings that are compared: of every model, for the static path and for the swing.

Implicit schemes of all models take the same steps; explicit ones take their own, near the largest stable one.
Surrogates are of statics alone. In motion strips have no shear and no rotary inertia of their sections, but
for Exudyn's exact beams, which have both: two theories are 3e-2 rad apart after 0.05 s, so that each is held
against the limit of its own.
"""

from collections.abc import Mapping, Sequence
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
WORDS = {
    "control_points": "n = {}",
    "elements": "{} elements",
    "accuracy": "accuracy {:g}",
    "integrator": "{}",
    "element": "{}",
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
    def text(self) -> str:
        """What it is, in words."""
        return ", ".join(self._told(self.settings)) or "closed form"

    @property
    def family(self) -> str:
        """What settings have in common that differ from it in their fineness alone."""
        finer = ("step",) if "step" in self.settings else FINER
        same = {name: value for name, value in self.settings.items() if name not in finer}
        return ", ".join((self.model.name, *self._told(same)))

    @property
    def fineness(self) -> float:
        """A number that grows with it within a family."""
        for name, sign in FINER.items():
            if name in self.settings:
                return sign * float(self.settings[name])
        return 1.0

    @staticmethod
    def _told(settings: Mapping[str, Any]) -> list[str]:
        words = {name: WORDS.get(name, name.replace("_", " ") + " {:g}") for name in settings}
        return [
            f"{1e6 * value:.3g} µs" if name == "step" else words[name].format(value)
            for name, value in settings.items()
        ]


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
#: Exudyn's spectral radius, and the tolerance of its iterations.
DAMPED = ((0.9, 1e-3), (0.6, 1e-3), (0.9, 1e-5))


def swings() -> list[Setting]:
    """Return the settings of the motion after the release of the paper's pivot."""
    exudyn = {exudyn_ancf: (3, 4, 6, 8, 12), exudyn_exact: (2, 3, 4, 6)}
    explicit, implicit = ("central-difference",), ("generalised-alpha",)
    return [
        *grid(spline, SPLINE, control_points=range(4, 11), integrator=("leapfrog",)),
        *grid(spline, SPLINE, control_points=(4, 5, 6, 7, 8), integrator=("energy",), step=STEPS),
        *grid(elements, ELEMENTS, elements=(5, 10, 16, 24, 36), integrator=explicit),
        *grid(elements, ELEMENTS, elements=(5, 10, 16, 24), integrator=implicit, step=STEPS),
        *(each for way in product(exudyn.items(), DAMPED) for each in _of_exudyn(*way)),
        *grid(openseespy_frame, OPENSEES, elements=(5, 10, 20, 40), step=STEPS),
    ]


def _of_exudyn(code: tuple[Model, Sequence[int]], damped: tuple[float, float]) -> list[Setting]:
    """Return the settings of motions of a kind of strips with its meshes, at one damping."""
    (model, meshes), (radius, tolerance) = code, damped
    how = {"spectral_radius": (radius,), "relative_tolerance": (tolerance,)}
    return grid(model, EXUDYN, elements=meshes, step=STEPS, **how)
