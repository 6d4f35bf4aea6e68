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
import pandas as pd
from numpy.typing import NDArray

from fe_reference import SolidPath, SolidStrip
from studies.cases.problem import Problem, named_case
from studies.engine import Answer, Claim, Part, Study
from studies.errors import Unanswered
from studies.kinds import Array
from studies.published.solid_pivot import STATES
from studies.published.solids import COARSEST, meshed, turned
from studies.record.store import Digits

PROGRAM = "ccx"
#: Corners of the element in its axes, and the pairs of corners with a node between them.
CORNERS = ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
#: Largest residual and correction of a state, relative; the program's own are 5e-3 and 1e-2.
PRECISION = 1e-6
STEP = (
    f"*STEP, NLGEOM, INC=1000\n*CONTROLS, PARAMETERS=FIELD\n{PRECISION}, {PRECISION}\n*STATIC\n1., 1., 1e-3"
)
#: Meshes by their fineness, and the largest deviation that the two codes may have.
MESHES, SMALL = (2, 3), 5e-4


def _missing() -> str:
    """Return what this machine lacks."""
    return "" if shutil.which(PROGRAM) else "it needs CalculiX: apt-get install calculix-ccx"


def driven(pivot: Problem, strip: SolidStrip, path: SolidPath) -> tuple[Array, Array]:
    """Return the driving torque (S,) [N m] and the force on the body (S,) [N], zero in equilibrium.

    CalculiX moves the end faces to the states of the path. The torque is the work of the forces of their
    nodes as the rotation changes by one: an error of the body's place then has no effect of first order.
    """
    turn = np.exp(1j * path.rotation)[:, None]
    centre, at_rest = path.centre @ [1.0, 1.0j], complex(*pivot.bodies[0].centre)
    rate = np.gradient(centre, path.rotation)[:, None]
    torque, force = np.zeros(len(turn)), np.zeros(len(turn), dtype=complex)
    for each in pivot.strips:
        along = (complex(*each.end) - complex(*each.start)) / pivot.length
        arms = complex(*each.start) + along * (strip.nodes[strip.tip, :2] @ [1.0, 1.0j]) - at_rest
        moves = (centre[:, None] + turn * arms - at_rest - arms) / along
        forces = end_forces(strip, np.stack([moves.real, moves.imag], axis=2)) @ [1.0, 1.0j] * along
        force += forces.sum(axis=1)
        torque += (forces.conj() * (rate + 1.0j * turn * arms)).real.sum(axis=1)
    return torque, np.abs(force)


def end_forces(strip: SolidStrip, moves: Array) -> Array:
    """Return the forces of the nodes of the tip face, of the whole width (S, T, 2) [N].

    Args:
        strip: whose mesh and material are used.
        moves: displacements of the nodes of the tip face for each state (S, T, 2) [m].

    Raises:
        Unanswered: CalculiX did not reach the last state.
    """
    with TemporaryDirectory() as folder:
        (Path(folder) / "strip.inp").write_text("\n".join(_deck(strip, moves)), encoding="ascii")
        done = subprocess.run([PROGRAM, "strip"], cwd=folder, capture_output=True, text=True, check=False)
        found = Path(folder) / "strip.dat"
        lines = found.read_text(encoding="ascii").splitlines() if found.is_file() else []
    rows = np.array([line.split() for line in lines if line[:10].strip().isdigit()], dtype=float)
    if done.returncode or len(rows) != len(moves) * len(strip.tip):
        reached = len(rows) // len(strip.tip)
        raise Unanswered(f"CalculiX: got {reached} states, expected {len(moves)}: {done.stdout[-200:]!r}")
    return 2.0 * rows.reshape(len(moves), -1, 4)[:, :, 1:3]


def _deck(strip: SolidStrip, moves: Array) -> Iterator[str]:
    """Yield the lines of the input: half of the width, between rigid end faces."""
    yield "*NODE, NSET=ALL"
    yield from (f"{k}, {x:.12e}, {y:.12e}, {z:.12e}" for k, (x, y, z) in enumerate(strip.nodes, 1))
    yield "*ELEMENT, TYPE=C3D20R, ELSET=STRIP"
    for k, nodes in enumerate(_ordered(strip) + 1, 1):
        yield f"{k}, " + ", ".join(map(str, nodes[:10])) + ",\n" + ", ".join(map(str, nodes[10:]))
    x, _, z = strip.nodes.T
    faces = {"ROOT": np.isclose(x, 0.0), "TIP": np.isclose(x, strip.length), "MIDDLE": np.isclose(z, 0.0)}
    for name, chosen in faces.items():
        yield f"*NSET, NSET={name}"
        yield from (f"{node}," for node in np.flatnonzero(chosen) + 1)
    yield "*MATERIAL, NAME=METAL\n*ELASTIC"
    yield f"{strip.youngs_modulus:.12e}, {strip.poisson_ratio:.12e}"
    yield "*SOLID SECTION, ELSET=STRIP, MATERIAL=METAL"
    yield "*BOUNDARY\nROOT, 1, 3\nMIDDLE, 3\nTIP, 3"
    for state in moves:
        yield f"{STEP}\n*BOUNDARY"
        for node, move in zip(strip.tip + 1, state, strict=True):
            yield from (f"{node}, {axis}, {axis}, {value:.12e}" for axis, value in enumerate(move, 1))
        yield "*NODE PRINT, NSET=TIP, FREQUENCY=1000\nRF\n*END STEP"


def _ordered(strip: SolidStrip) -> NDArray[np.intp]:
    """Return the nodes of the elements in the order of C3D20R (E, 20), which their places tell."""
    nodes = strip.elements[:, ::3] // 3
    places = strip.nodes[nodes]
    arms = places - 0.5 * (places.min(axis=1) + places.max(axis=1))[:, None]
    corners, powers = np.array(CORNERS), np.array([1, 3, 9])
    wanted = np.vstack([corners, corners[np.array(EDGES)].sum(axis=1) // 2]) @ powers
    keys = np.rint(arms / np.abs(arms).max(axis=1, keepdims=True)) @ powers
    ordered = np.take_along_axis(nodes, np.argsort(keys, axis=1), axis=1)
    return np.asarray(ordered[:, np.argsort(np.argsort(wanted))], dtype=np.intp)


def _states(fineness: int) -> Answer:
    """Return the states of one mesh."""
    pivot, element = named_case(), "serendipity"
    strip = meshed(pivot, (COARSEST[element] * fineness, fineness, fineness), element=element)
    path = turned(pivot, strip, STATES)
    torque, force = driven(pivot, strip, path)
    rows = {
        "model": "calculix",
        "fineness": fineness,
        "rotation_rad": path.rotation,
        "torque_Nm": torque,
        "error_torque": torque / path.torque - 1.0,
        "error_force": force * pivot.length / path.torque,
    }
    return {"states": pd.DataFrame(rows)}


STUDY = Study(
    parts=(Part(at=lambda: MESHES, ask=_states),),
    claims=(
        Claim(
            claim="CalculiX agrees with solids on the same mesh within 0.05 % in torque",
            formulation="fineness {fineness} at {rotation_rad:.4f} rad",
            quantity="the deviation of the torque",
            rows=lambda tables: tables["states"],
            value="error_torque",
            least=-SMALL,
            most=SMALL,
        ),
    ),
    digits={
        "torque_Nm": Digits(relative=10.0 * PRECISION),
        **dict.fromkeys(("error_torque", "error_force", "value"), Digits(floor=10.0 * PRECISION)),
    },
    missing=_missing,
)
