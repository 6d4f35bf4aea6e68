"""Answers as VTK: one .vtu a state and a .pvd that makes them a series, as ParaView opens it.

The points stand where strips and bodies are in the state, so that the series shows the motion as it is;
`displacement_m` leads back to rest (Warp By Vector, scale -1). Points of bodies have no section forces: NaN.
Modes stand out by a tenth of the longest strip; `mode_per_sqrt_kg` is their shape at unit modal mass.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import meshio
import numpy as np
from numpy.typing import NDArray

from studies.answers.answer import Answer
from studies.answers.motion import Spectrum
from studies.answers.named import numbers_of
from studies.answers.quantities import along_of
from studies.cases.keys import GROUND
from studies.kinds import Array

Indices = NDArray[np.int64]

#: Values of `part_kind`.
STRIP, BODY_ARM, BODY_CENTRE, CLAMP = range(4)
#: Largest displacement of a mode in the picture, in lengths of the longest strip [1].
AMPLITUDE = 0.1


def vtk(answer: Answer) -> dict[str, bytes]:
    """Return the files of a series by name: `<analysis>.pvd` and one `<analysis>_<number>.vtu` a state."""
    names = [f"{answer.analysis}_{number:04d}.vtu" for number in range(len(answer.values))]
    contents = {f"{answer.analysis}.pvd": _series(answer.values, names)}
    with tempfile.TemporaryDirectory() as folder:
        for state, name in enumerate(names):
            path = Path(folder) / name
            meshio.write(path, mesh(answer, state), file_format="vtu")
            contents[name] = path.read_bytes()
    return contents


def mesh(answer: Answer, state: int) -> meshio.Mesh:
    """Return one state: strips as lines, bodies as centres with lines to the ends they carry, and clamps.

    Points are those of the strips, strip by strip from root to tip, then the bodies' centres, then once more
    the ends that bodies carry, as points of the bodies. What the state has as a whole is data of every cell.
    """
    cells = list(_cells(answer))
    whole = {answer.series: answer.values} | numbers_of(answer)
    of_cells: dict[str, list[Any]] = {
        "part_kind": [np.full(len(parts), kind) for kind, _, parts, _ in cells],
        "part_number": [parts for _, _, parts, _ in cells],
    }
    for key, name in (("mass_kg", "mass"), ("moment_of_inertia_kg_m2", "moment_of_inertia")):
        of_cells[key] = [
            np.array([getattr(answer.design.bodies[n], name) if kind == BODY_CENTRE else 0.0 for n in parts])
            for kind, _, parts, _ in cells
        ]
    for name, values in whole.items():
        of_cells[name] = [np.full(len(parts), float(values[state])) for _, _, parts, _ in cells]
    return meshio.Mesh(
        points=_points(answer, state),
        cells=[(shape, nodes) for _, shape, _, nodes in cells],
        point_data=_point_data(answer, state),
        cell_data=of_cells,
    )


def _cells(answer: Answer) -> Iterator[tuple[int, str, Indices, Indices]]:
    """Yield kind, VTK shape, numbers of the parts and points (cells, 1 or 2) of the blocks that there are."""
    strips, stations = answer.along.rotation.shape[1:]
    first = stations * np.arange(strips)
    nodes = (first[:, None] + np.arange(stations - 1)).ravel()
    yield STRIP, "line", np.repeat(np.arange(strips), stations - 1), np.stack([nodes, nodes + 1], axis=1)
    centres = strips * stations + np.arange(len(answer.design.bodies))
    if len(centres):
        yield BODY_CENTRE, "vertex", np.arange(len(centres)), centres[:, None]
    ends = list(_carried(answer))
    if ends:
        bodies = np.array([body for body, _, _ in ends])
        feet = strips * stations + len(answer.design.bodies) + np.arange(len(ends))
        yield BODY_ARM, "line", bodies, np.stack([centres[bodies], feet], axis=1)
    clamps = [start for part, start in zip(answer.design.strips, first, strict=True) if part.root == GROUND]
    clamps += [
        start + stations - 1 for p, start in zip(answer.design.strips, first, strict=True) if p.tip == GROUND
    ]
    if clamps:
        yield CLAMP, "vertex", np.arange(len(clamps)), np.array(clamps)[:, None]


def _carried(answer: Answer) -> Iterator[tuple[int, int, int]]:
    """Yield body, strip and station of every end that a body carries."""
    names = [block.name for block in answer.design.bodies]
    for strip, part in enumerate(answer.design.strips):
        for on, station in ((part.root, 0), (part.tip, -1)):
            if on in names:
                yield names.index(on), strip, station


def _everywhere(answer: Answer, strips: Array, bodies: Array) -> Array:
    """Return vectors at all points (K, 2) from those of strips (G, P, 2) and bodies' centres (B, 2)."""
    feet = [strips[strip, station] for _, strip, station in _carried(answer)]
    return np.concatenate([strips.reshape(-1, 2), bodies, np.array(feet).reshape(-1, 2)])


def mode_scale(answer: Answer, state: int) -> float:
    """Return the factor of a mode at unit modal mass for its picture; zero of a mode that moves nothing."""
    if not isinstance(answer, Spectrum):
        return 0.0
    largest = float(np.hypot(*np.moveaxis(answer.mode_shape[state], -1, 0)).max())
    return AMPLITUDE * float(answer.along.arc_length.max()) / largest if largest > 0.0 else 0.0


def _points(answer: Answer, state: int) -> Array:
    still = _everywhere(answer, answer.along.shape[state], answer.along.bodies[state, :, :2])
    mode = _mode(answer, state)
    return _spatial(still if mode is None else still + mode_scale(answer, state) * mode)


def _mode(answer: Answer, state: int) -> Array | None:
    """Return the mode at unit modal mass at all points (K, 2); None of other analyses."""
    if not isinstance(answer, Spectrum):
        return None
    return _everywhere(answer, answer.mode_shape[state], answer.mode_bodies[state, :, :2])


def _point_data(answer: Answer, state: int) -> dict[str, Any]:
    along, carried = answer.along, [body for body, _, _ in _carried(answer)]
    bodies = along.bodies[state]
    beyond = len(bodies) + len(carried)
    nothing, still = np.full(beyond, np.nan), np.zeros(beyond)
    forces = np.zeros((*along.rotation.shape[1:], 2))
    moments = np.zeros(along.rotation.shape[1:])
    for end, station in enumerate((0, -1)):
        forces[:, station] = along.reactions[state, :, end, :2]
        moments[:, station] = along.reactions[state, :, end, 2]
    moved = _everywhere(answer, along.shape[state] - along.rest_shape, bodies[:, :2] - along.rest_bodies)
    found = {
        "displacement_m": _spatial(moved),
        "rotation_rad": np.concatenate([along.rotation[state].ravel(), bodies[:, 2], bodies[carried, 2]]),
        "arc_length_m": np.concatenate([along.arc_length.ravel(), nothing]),
        **{name: np.concatenate([each[state].ravel(), nothing]) for name, each in along_of(answer).items()},
        "reaction_force_N": _spatial(np.concatenate([forces.reshape(-1, 2), np.zeros((beyond, 2))])),
        "reaction_moment_Nm": np.concatenate([moments.ravel(), still]),
    }
    mode = _mode(answer, state)
    return found if mode is None else found | {"mode_per_sqrt_kg": _spatial(mode)}


def _spatial(plane: Array) -> Array:
    """Return vectors of the plane (K, 2) with z = 0, (K, 3)."""
    return np.pad(plane, ((0, 0), (0, 1)))


def _series(values: Array, names: list[str]) -> bytes:
    """Return the .pvd that names the files of the states and what runs over them as their times."""
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "  <Collection>"]
    for value, name in zip(values, names, strict=True):
        lines.append(f'    <DataSet timestep="{value:.12g}" part="0" file={quoteattr(name)}/>')
    return "\n".join([*lines, "  </Collection>", "</VTKFile>", ""]).encode()
