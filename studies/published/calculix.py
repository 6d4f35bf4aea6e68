"""The benchmark pivot as solids by CalculiX, another code, on the same meshes.

CalculiX (`ccx`) gets the displacements of the rigid end faces and gives the forces of their nodes. Its
element C3D20R has 20 nodes and 2 x 2 x 2 points, as the mesh. Its law *ELASTIC with NLGEOM is that of
St. Venant and Kirchhoff.
"""

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from skfem.io.meshio import HEX_MAPPING

from fe_reference import SolidPath, SolidStrip
from studies.cases.problem import Problem
from studies.engine import Answer, Part, Study
from studies.errors import Unanswered
from studies.kinds import Array
from studies.published.solid_pivot import DESIGNS
from studies.published.solids import PIVOT, states_of
from studies.record.store import Digits

PROGRAM = "ccx"
#: Largest residual and correction of a state, relative; the program's own are 5e-3 and 1e-2.
PRECISION = 1e-6
#: Meshes by their fineness.
MESHES = (2, 3)


def missing() -> str:
    """Return what this machine lacks."""
    return "" if shutil.which(PROGRAM) else "it needs CalculiX: apt-get install calculix-ccx"


def driven(pivot: Problem, strip: SolidStrip, path: SolidPath) -> tuple[Array, Array]:
    """Return the driving torque (S,) [N m] and the force on the body (S,) [N], zero in equilibrium.

    CalculiX moves the end faces to the states of the path. The torque is the moment of the forces of their
    nodes about the reference point of the body. Places and forces are complex numbers x + i y.
    """
    turn, centre = np.exp(1j * path.rotation[:, None]), path.centre @ [[1.0], [1.0j]]
    at_rest = complex(*pivot.bodies[0].centre)
    torque, force = np.zeros(len(turn)), np.zeros(len(turn), dtype=complex)
    for each in pivot.strips:
        along = (complex(*each.end) - complex(*each.start)) / pivot.length
        arms = complex(*each.start) + along * (strip.nodes[strip.tip, :2] @ [1.0, 1.0j]) - at_rest
        forces = along * end_forces(strip, (centre + turn * arms - at_rest - arms) / along)
        force += forces.sum(axis=1)
        torque += ((turn * arms).conj() * forces).imag.sum(axis=1)
    return torque, np.abs(force)


def end_forces(strip: SolidStrip, moves: Array) -> Array:
    """Return the forces of the nodes of the tip face, of the whole width (S, T) [N], as complex numbers.

    Args:
        strip: whose mesh and material are used.
        moves: displacements of the nodes of the tip face for each state (S, T) [m], as complex numbers.

    Raises:
        Unanswered: CalculiX did not reach the last state.
    """
    with TemporaryDirectory() as folder:
        (Path(folder) / "strip.inp").write_text("\n".join(_deck(strip, moves)), encoding="ascii")
        done = subprocess.run([PROGRAM, "strip"], cwd=folder, capture_output=True, text=True, check=False)
        found = [each.read_text(encoding="ascii") for each in Path(folder).glob("strip.dat")]
    lines = "".join(found).splitlines()
    rows = np.array([line.split() for line in lines if line[:10].strip().isdigit()], dtype=float)
    if done.returncode or len(rows) != len(moves) * len(strip.tip):
        reached = len(rows) // len(strip.tip)
        raise Unanswered(f"CalculiX: got {reached} states, expected {len(moves)}: {done.stdout[-200:]!r}")
    return np.asarray(2.0 * rows[:, 1:3] @ [1.0, 1.0j]).reshape(moves.shape)


def _deck(strip: SolidStrip, moves: Array) -> Iterator[str]:
    """Yield the lines of the input: half of the width, between rigid end faces."""
    yield "*NODE, NSET=ALL"
    yield from (f"{k}, {x:.12e}, {y:.12e}, {z:.12e}" for k, (x, y, z) in enumerate(strip.nodes, 1))
    yield "*ELEMENT, TYPE=C3D20R, ELSET=STRIP"
    for k, nodes in enumerate(strip.elements[:, ::3][:, HEX_MAPPING[:20]] // 3 + 1, 1):
        yield f"{k}, " + ", ".join(map(str, nodes[:10])) + ",\n" + ", ".join(map(str, nodes[10:]))
    yield "*NSET, NSET=TIP"
    yield from (f"{node}," for node in strip.tip + 1)
    yield "*MATERIAL, NAME=METAL\n*ELASTIC"
    yield f"{strip.youngs_modulus:.12e}, {strip.poisson_ratio:.12e}"
    yield "*SOLID SECTION, ELSET=STRIP, MATERIAL=METAL"
    yield "*BOUNDARY"
    held = np.setdiff1d(np.arange(strip.nodes.size), strip.free)
    yield from (f"{coordinate // 3 + 1}, {coordinate % 3 + 1}" for coordinate in held)
    for state in moves:
        yield "*STEP, NLGEOM, INC=1000\n*CONTROLS, PARAMETERS=FIELD"
        yield f"{PRECISION}, {PRECISION}\n*STATIC\n1., 1., 1e-3\n*BOUNDARY"
        for node, move in zip(strip.tip + 1, state, strict=True):
            yield f"{node}, 1, 1, {move.real:.12e}\n{node}, 2, 2, {move.imag:.12e}"
        yield "*NODE PRINT, NSET=TIP, FREQUENCY=1000\nRF\n*END STEP"


def _states(fineness: int) -> Answer:
    """Return the states of one mesh."""
    design = DESIGNS[PIVOT]
    strip = design.strip(fineness)
    path = design.solids(strip)
    torque, force = driven(design.pivot, strip, path)
    rows = states_of(path, model="calculix", fineness=fineness).assign(
        torque_Nm=torque,
        error_torque=torque / path.torque - 1.0,
        error_force=force * strip.length / path.torque,
    )
    return {"states": rows}


STUDY = Study(
    parts=(Part(at=lambda: MESHES, ask=_states),),
    digits={
        "torque_Nm": Digits(relative=10.0 * PRECISION),
        **dict.fromkeys(("error_torque", "error_force"), Digits(floor=10.0 * PRECISION)),
    },
    missing=missing,
)
