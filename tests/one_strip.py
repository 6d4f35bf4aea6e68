"""A case of one strip with a free tip: 100 mm of steel, 10 mm x 0.5 mm, in a scene of its own."""

from pathlib import Path

SECOND_MOMENT = 1.0416667e-13
CASE = Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")


def one_strip(scene: str, *, rise: float = 0.0) -> str:
    """Return the text of the case: `scene` has its effects and their tables, `rise` [m] makes it an arc."""
    return CASE.replace("rise_m = 0.0", f"rise_m = {rise}") + scene
