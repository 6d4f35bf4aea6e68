"""Settings of the two models: how a problem is discretised, as frozen values that name themselves."""

from dataclasses import asdict, dataclass
from typing import Any, ClassVar


@dataclass(frozen=True, kw_only=True)
class SplineSettings:
    """Discretisation by dynamic splines; `spline_model` checks the values.

    Args:
        control_points: n per segment [1]; None for as many as an accuracy needs, which the answer names.
        axial_modes: m axial-force modes per segment [1]; None for the model's default, n - 2.
        segments: Bezier curves per strip, each with these control points and modes [1].
        measure: "material", "spatial" (the paper's energy) or "published" (the paper's generalised forces).
            The last two need stretch "consistent".
        stretch: "mixed", "consistent" (the paper's quadrature) or "inextensible".
        gauss_points: quadrature points [1]; None for the model's default.
        penalty_stiffness: of the strains that the axial modes do not see [EI/L^2]; None for the model's
            default, which differs between statics and motion.
    """

    control_points: int | None = None
    axial_modes: int | None = None
    segments: int = 1
    measure: str = "material"
    stretch: str = "mixed"
    gauss_points: int | None = None
    penalty_stiffness: float | None = None

    model: ClassVar[str] = "spline"

    @property
    def points(self) -> int:
        """Number of control points [1]; ValueError if the settings have none."""
        if self.control_points is None:
            raise ValueError("control_points: got none, expected the number that work is counted with")
        return self.control_points

    def keywords(self) -> dict[str, Any]:
        """Return the discretisation keywords of `spline_model.pivot.cross_axis_pivot`.

        Control points and penalty stiffness are included only if they are set.
        """
        said = ("control_points", "penalty_stiffness")
        return {name: v for name, v in asdict(self).items() if v is not None or name not in said}


@dataclass(frozen=True, kw_only=True)
class FeSettings:
    """Discretisation by finite elements; `fe_reference` checks the values.

    Args:
        elements: per strip [1].
        element: "corotational" (Euler-Bernoulli) or "reissner" (shear-deformable).
    """

    elements: int = 20
    element: str = "corotational"

    @property
    def model(self) -> str:
        """Name of the model on the command line."""
        return "fe-shear" if self.element == "reissner" else "fe"

    def keywords(self) -> dict[str, Any]:
        """Return the discretisation keywords of `fe_reference.model.cross_axis_pivot`."""
        return asdict(self)


Settings = SplineSettings | FeSettings

#: Models as commands name them.
MODELS = ("spline", "fe", "fe-shear")


def settings_of_model(model: str, **given: Any) -> Settings:
    """Return the settings of a model by its name; values that are not given have their defaults."""
    if model == "spline":
        return SplineSettings(**given)
    return FeSettings(element="reissner" if model == "fe-shear" else "corotational", **given)
