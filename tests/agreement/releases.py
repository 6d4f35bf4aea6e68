"""Random releases of both models, each from a seed: designs that turn and designs that hardly do."""

from pathlib import Path

import numpy as np

from studies.answers.settings import SplineSettings
from studies.cases.design import Design
from studies.commands.arguments import read_design
from studies.commands.release import _usual

KINDS = ("pivot", "arch", "guide", "four bar", "series", "whisker")
ACTING = ("nothing", "nothing", "gravity", "body_damping", "strip_damping", "applied_force")


def random_release(seed: int, folder: Path) -> tuple[Design, float, float]:
    """Return a design, the duration of two of its swings, and the default step of the splines [s]."""
    rng = np.random.default_rng([36, seed])
    kind, acting = KINDS[seed % len(KINDS)], ACTING[rng.integers(len(ACTING))]
    path = folder / f"release_{seed}.toml"
    path.write_text(_text(kind, acting, rng), encoding="utf-8")
    design = read_design(str(path))
    duration, step = _usual(design, SplineSettings())
    assert step is not None
    return design, 0.5 * duration, step


def _text(kind: str, acting: str, rng: np.random.Generator) -> str:
    length = rng.uniform(0.03, 0.12)
    thickness = length / float(np.exp(rng.uniform(np.log(40), np.log(300))))
    mass = rng.uniform(0.02, 0.3)
    strips, bodies, turned, moved = _parts(kind, length, mass, rng)
    name = bodies[0][0]
    lines = [
        f'[[strips]]\nname = "{n}"\nstart_m = {list(a)}\nend_m = {list(b)}\nroot = "{r}"\n'
        + f'tip = "{t}"\n'
        + (f"rise_m = {rise}\n" if rise else "")
        for n, a, b, r, t, rise in strips
    ]
    lines += [
        f'[[bodies]]\nname = "{n}"\ncentre_m = {list(at)}\nmass_kg = {m}\nmoment_of_inertia_kg_m2 = {j}\n'
        for n, at, m, j in bodies
    ]
    lines.append(f"[section]\nwidth_m = 0.01\nthickness_m = {thickness}\n")
    lines.append(f'[material]\nname = "{rng.choice(["spring_steel", "titanium_6al_4v"])}"\n')
    turn = f"rotation_deg = {turned}\n" if turned else ""
    lines.append(f'[drive]\nbody = "{name}"\nincrements = 10\n{turn}')
    effects, tables = ['"+driven_displacement"'] if moved else [], ""
    if moved:
        tables += f'[effects.driven_displacement]\nbody = "{name}"\ndisplacement_m = {moved}\n'
    if acting != "nothing":
        effects.append(f'"+{acting}"')
        tables += _table(acting, name, length, thickness, rng)
    scene = f"[scene]\neffects = [{', '.join(effects)}]\n" if effects else ""
    return "\n".join(lines) + scene + tables


def _table(acting: str, body: str, length: float, thickness: float, rng: np.random.Generator) -> str:
    """Return the parameters of what acts, at a size that matters and leaves the design standing."""
    force = 1.1e11 * 0.01 * thickness**3 / 12.0 / length**2
    if acting == "gravity":
        return "[effects.gravity]\nacceleration_m_per_s2 = [0, -0.5]\n"
    if acting == "body_damping":
        return f"[effects.body_damping]\nrotation_Nms = {1e-3 * force * length}\n"
    if acting == "strip_damping":
        return "[effects.strip_damping]\nrelaxation_time_s = 1e-5\n"
    size = rng.uniform(-0.3, 0.3) * force
    return f'[effects.applied_force]\nbody = "{body}"\nforce_N = [{0.5 * size}, {size}]\n'


def _parts(kind: str, length: float, mass: float, rng: np.random.Generator) -> tuple:
    """Return strips, bodies, the rotation [deg] and the displacement [m] that a body is let go from."""
    j, turn = mass * (0.2 * length) ** 2, float(rng.uniform(4, 50) * rng.choice([-1, 1]))
    if kind == "pivot":
        strips = [
            ("a", (0, 0), (length, length), "ground", "A", 0),
            ("b", (length, 0), (0, length), "ground", "A", 0),
        ]
        return strips, [("A", (0.5 * length, 1.1 * length), mass, j)], turn, None
    if kind == "arch":
        rise = 0.12 * length
        strips = [
            ("a", (-length, 0), (0, rise), "ground", "A", 0.02 * length),
            ("b", (0, rise), (length, 0), "A", "ground", 0.02 * length),
        ]
        return strips, [("A", (0, rise), mass, j)], None, ["free", -0.02 * length]
    if kind == "guide":
        strips = [
            ("a", (0, 0), (0, length), "ground", "A", 0),
            ("b", (0.5 * length, 0), (0.5 * length, length), "ground", "A", 0),
        ]
        return strips, [("A", (0.25 * length, length), mass, j)], None, [0.1 * length, "free"]
    if kind == "four bar":
        strips = [
            ("a", (0, 0), (0, length), "ground", "A", 0),
            ("b", (0.1 * length, 1.2 * length), (1.1 * length, 1.2 * length), "A", "B", 0),
            ("c", (1.2 * length, 0), (1.2 * length, length), "ground", "B", 0),
        ]
        bodies = [("A", (0, 1.1 * length), mass, j), ("B", (1.2 * length, 1.1 * length), 0.6 * mass, j)]
        return strips, bodies, 0.3 * turn, None
    if kind == "series":
        strips = [
            ("a", (0, 0), (length, 0), "ground", "A", 0),
            ("b", (length, 0), (1.5 * length, 0.5 * length), "A", "B", 0),
        ]
        bodies = [("A", (length, 0), mass, j), ("B", (1.6 * length, 0.5 * length), 0.2 * mass, 0.3 * j)]
        return strips, bodies, 0.5 * turn, None
    strips = [
        ("a", (0, 0), (length, 0), "ground", "A", 0),
        ("w", (length, 0), (2 * length, 0), "A", "free", 0),
    ]
    return strips, [("A", (length, 0), mass, j)], 0.5 * turn, None
