"""Materials by their names, each value with its source; a case may take one and change it key by key."""

from dataclasses import dataclass


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
    yield_strength: float | None
    title: str
    source: str
    checked: str

    def values(self) -> dict[str, float]:
        """Return what it fills of a strip, by attribute."""
        names = ("youngs_modulus", "poisson_ratio", "density", "yield_strength")
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}


_SILICON = (
    "Hopcroft, Nix and Kenny, J. Microelectromech. Syst. 19 (2010) 229-238, doi 10.1109/JMEMS.2009.2039697, "
    "http://silicon.mhopeng.ml1.net/Silicon"
)
_CRYSTAL = (
    "modulus and Poisson's ratio: from the constants 166, 64 and 80 GPa of the cubic crystal, "
    "https://isicopy.memsnet.org/memstalk/324, by a test"
)

MATERIALS: dict[str, Material] = {
    "spring_steel": Material(
        youngs_modulus=205e9,
        poisson_ratio=0.29,
        density=7850.0,
        yield_strength=1020e6,
        title="carbon spring steel AISI 1090, austempered at 400 °C",
        source="yield strength: ASM Metals Handbook, Heat Treating, austempered 1090; "
        "the rest: MatWeb, AISI 1000 series",
        checked="yield strength in that table, http://www.steel-heattreatment.com/table1.htm; the rest in "
        "tables of other carbon steels only",
    ),
    "titanium_6al_4v": Material(
        youngs_modulus=113.8e9,
        poisson_ratio=0.342,
        density=4430.0,
        yield_strength=880e6,
        title="Ti-6Al-4V (Grade 5), annealed",
        source="ASM Aerospace Specification Metals, data sheet MTP641",
        checked="not in the sheet itself; all four in tables that cite it; annealed, it yields at 875 to "
        "995 MPa by https://nickel-systems.com/materials/titanium-gr5",
    ),
    "aluminium_7075_t6": Material(
        youngs_modulus=71.7e9,
        poisson_ratio=0.33,
        density=2810.0,
        yield_strength=503e6,
        title="aluminium 7075-T6",
        source="ASM Aerospace Specification Metals, data sheet MA7075T6",
        checked="density and strength: SubsTech, wrought aluminum-zinc-magnesium alloy 7075, "
        "http://www.substech.com; modulus and Poisson's ratio: Wikipedia, 7075 aluminium alloy",
    ),
    "peek": Material(
        youngs_modulus=4.0e9,
        poisson_ratio=0.4,
        density=1300.0,
        yield_strength=98e6,
        title="PEEK, unfilled, injection-moulded",
        source="Victrex PEEK 450G, data sheet (ISO 527 at 23 °C), and properties guide for Poisson's ratio",
        checked="not in the sheet itself; another table of unfilled PEEK has 3.6 GPa, 0.40, 1320 kg/m^3, "
        "100 MPa",
    ),
    "pla": Material(
        youngs_modulus=3.5e9,
        poisson_ratio=0.36,
        density=1252.0,
        yield_strength=70e6,
        title="PLA, solid, injection-moulded; printed it is softer and weaker, by its layers 26 to 45 MPa",
        source="Farah, Anderson and Langer, Advanced Drug Delivery Reviews 107 (2016) 367-392, "
        "http://hdl.handle.net/1721.1/112940",
        checked="modulus: https://www.makeitfrom.com, PLA; the strength is near the upper end of the 16 to "
        "72 MPa of all grades, https://plastics.ulprospector.com/generics/34, which has 1220 to 1300 kg/m^3; "
        "printed: https://pro3dcomposites.com/materials/pla; not Poisson's ratio",
    ),
    "silicon_110": Material(
        youngs_modulus=169e9,
        poisson_ratio=0.36,
        density=2330.0,
        yield_strength=None,
        title="single-crystal silicon, a strip along <110> whose width is along <001>, the normal of the "
        "wafer; it breaks before it yields",
        source=_SILICON,
        checked=_CRYSTAL,
    ),
    "silicon_100": Material(
        youngs_modulus=130e9,
        poisson_ratio=0.28,
        density=2330.0,
        yield_strength=None,
        title="the same, a strip along <100>",
        source=_SILICON,
        checked=_CRYSTAL,
    ),
}
