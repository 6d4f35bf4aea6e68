"""Materials by their names, each value with its source; a case may take one and change it key by key."""

import tomllib
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, kw_only=True)
class Material:
    """A linear elastic material at room temperature.

    Attributes:
        youngs_modulus: E [Pa]. poisson_ratio: nu [1]. density: [kg/m^3].
        yield_strength: [Pa]; None of a material that breaks before it yields.
        title: what it is, in words. source: of the values.
        checked: which of them were found again, and where.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float | None = None
    title: str
    source: str
    checked: str

    def values(self) -> dict[str, float]:
        """Return what it fills of a strip, by attribute."""
        names = ("youngs_modulus", "poisson_ratio", "density", "yield_strength")
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


_FILE = Path(__file__).parent / "tables" / "materials.toml"
MATERIALS = {
    name: Material(**given) for name, given in tomllib.loads(_FILE.read_text(encoding="utf-8")).items()
}
