"""Materials by their names, each value with its source; a case may take one and change it key by key."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Material:
    """A linear elastic material at room temperature.

    Attributes:
        youngs_modulus: E [Pa]. poisson_ratio: nu [1]. density: [kg/m^3].
        yield_strength: [Pa]; None of a material that breaks before it yields.
        title: what it is, in words. source: of the values.
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    yield_strength: float | None
    title: str
    source: str

    def values(self) -> dict[str, float]:
        """Return what it fills of a strip, by attribute."""
        names = ("youngs_modulus", "poisson_ratio", "density", "yield_strength")
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


MATERIALS: dict[str, Material] = {
    "spring_steel": Material(
        youngs_modulus=205e9,
        poisson_ratio=0.29,
        density=7850.0,
        yield_strength=1020e6,
        title="carbon spring steel AISI 1090, austempered at 400 °C",
        source="yield strength: ASM Metals Handbook, Heat Treating, austempered 1090; "
        "the rest: MatWeb, AISI 1000 series",
    ),
    "titanium_6al_4v": Material(
        youngs_modulus=113.8e9,
        poisson_ratio=0.342,
        density=4430.0,
        yield_strength=880e6,
        title="Ti-6Al-4V (Grade 5), annealed",
        source="ASM Aerospace Specification Metals, data sheet MTP641",
    ),
    "aluminium_7075_t6": Material(
        youngs_modulus=71.7e9,
        poisson_ratio=0.33,
        density=2810.0,
        yield_strength=503e6,
        title="aluminium 7075-T6",
        source="ASM Aerospace Specification Metals, data sheet MA7075T6",
    ),
    "peek": Material(
        youngs_modulus=4.0e9,
        poisson_ratio=0.4,
        density=1300.0,
        yield_strength=98e6,
        title="PEEK, unfilled, injection-moulded",
        source="Victrex PEEK 450G, data sheet (ISO 527 at 23 °C), and properties guide for Poisson's ratio",
    ),
    "pla": Material(
        youngs_modulus=3.5e9,
        poisson_ratio=0.36,
        density=1252.0,
        yield_strength=70e6,
        title="PLA, solid, injection-moulded; printed it is softer and weaker across its layers",
        source="Farah, Anderson and Langer, Advanced Drug Delivery Reviews 107 (2016) 367-392",
    ),
    "silicon_110": Material(
        youngs_modulus=169e9,
        poisson_ratio=0.36,
        density=2330.0,
        yield_strength=None,
        title="single-crystal silicon, a strip along <110> whose width is along <001>, the normal of the "
        "wafer; it breaks before it yields",
        source="Hopcroft, Nix and Kenny, J. Microelectromech. Syst. 19 (2010) 229-238",
    ),
}
