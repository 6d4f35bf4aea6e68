"""A case of one strip with a free tip: 100 mm of steel, 10 mm x 0.5 mm, in a scene of its own."""

SECOND_MOMENT, YOUNGS_MODULUS = 1.0416667e-13, 206e9
CASE = f"""
[[strips]]
name = "strip"
start_m = [0, 0]
end_m = [0.1, 0]
rise_m = 0.0
tip = "free"

[section]
area_m2 = 5e-6
second_moment_m4 = {SECOND_MOMENT}

[material]
youngs_modulus_Pa = {YOUNGS_MODULUS}
poisson_ratio = 0.29
density_kg_m3 = 7800

[drive]
increments = 4

[scene]
"""


def one_strip(scene: str, *, rise: float = 0.0) -> str:
    """Return the text of the case: `scene` has its effects and their tables, `rise` [m] makes it an arc."""
    return CASE.replace("rise_m = 0.0", f"rise_m = {rise}") + scene
