"""Answers for other programs: a VTK series that ParaView opens, and tidy tables as CSV.

VTK has one .vtu a state and a .pvd that makes them a series. Its points stand where strips and bodies are in
the state, so that the series shows the motion as it is; `displacement_m` leads back to rest (Warp By Vector,
scale -1). Points of bodies have no section forces: NaN. Modes stand out by a tenth of the longest strip;
`mode_per_sqrt_kg` is their shape at unit modal mass. A table has one observation a row, units in the names of
the columns.
"""

import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
import pandas as pd
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
#: Columns of points and bodies: where they are, and how a mode moves them.
PLACES = ("x_m", "y_m", "displacement_x_m", "displacement_y_m", "rotation_rad")
MODES = ("mode_x_per_sqrt_kg", "mode_y_per_sqrt_kg", "mode_rotation_per_m_sqrt_kg")


def tables(answer: Answer) -> dict[str, pd.DataFrame]:
    """Return `states`, `strips`, `bodies` and `reactions`; a design without bodies has no table of them."""
    found = {"states": _states(answer), "strips": _strips(answer), "reactions": _reactions(answer)}
    return found | ({"bodies": _bodies(answer)} if answer.design.bodies else {})


def _table(answer: Answer, shape: tuple[int, ...], columns: Mapping[str, Any]) -> pd.DataFrame:
    """Return columns of arrays that go over the rows of a shape, states first, behind what runs over the
    states and their numbers, which modes have as it is.

    The load factor alone does not tell states apart: it stays 1 while a loaded pivot is turned.
    """
    running = {answer.series: answer.values, "state": np.arange(len(answer.values))}
    if answer.series == "mode":
        running = {"mode": answer.values.astype(np.int64)}
    first = {name: values.reshape(-1, *(1 for _ in shape[1:])) for name, values in running.items()}
    given = (first | dict(columns)).items()
    return pd.DataFrame({name: np.broadcast_to(array, shape).ravel() for name, array in given})


def _parts(names: Iterable[str], arrays: np.ndarray) -> dict[str, np.ndarray]:
    """Return the last axis of arrays by names, as many as it has."""
    return dict(zip(names, np.moveaxis(arrays, -1, 0), strict=False))


def _states(answer: Answer) -> pd.DataFrame:
    """One row a state: what runs, and what the state has as a whole, by the names of `solve --csv`."""
    columns: dict[str, Any] = {}
    if answer.analysis != "modes" and len(answer.design.bodies) == 1:
        columns |= _parts(
            ("rotation_rad", "com_x_m", "com_y_m"), np.roll(answer.along.bodies[:, 0], 1, axis=1)
        )
    columns |= numbers_of(answer)
    return _table(answer, answer.values.shape, columns)


def _placed(place: np.ndarray, rest: np.ndarray, turn: np.ndarray) -> dict[str, np.ndarray]:
    """Return the places (..., 2) and turns of points or bodies."""
    return _parts(PLACES, np.concatenate((place, place - rest, turn[..., None]), axis=-1))


def _strips(answer: Answer) -> pd.DataFrame:
    """One row a state, strip and station."""
    along = answer.along
    columns = {
        "strip": np.array([strip.name for strip in answer.design.strips])[:, None],
        "arc_length_m": along.arc_length,
        **_placed(along.shape, along.rest_shape, along.rotation),
        **along_of(answer),
        **(_parts(MODES, answer.mode_shape) if isinstance(answer, Spectrum) else {}),
    }
    return _table(answer, along.rotation.shape, columns)


def _bodies(answer: Answer) -> pd.DataFrame:
    """One row a state and body."""
    bodies, along = answer.design.bodies, answer.along
    columns = {
        "body": np.array([body.name for body in bodies]),
        **_placed(along.bodies[..., :2], along.rest_bodies, along.bodies[..., 2]),
        **(_parts(MODES, answer.mode_bodies) if isinstance(answer, Spectrum) else {}),
    }
    return _table(answer, along.bodies.shape[:2], columns)


def _reactions(answer: Answer) -> pd.DataFrame:
    """One row a state, strip and end."""
    strips, reactions = answer.design.strips, answer.along.reactions
    columns = {
        "strip": np.array([strip.name for strip in strips])[:, None],
        "end": np.array(["root", "tip"]),
        "on": np.array([[strip.root or "free", strip.tip or "free"] for strip in strips]),
        **_parts(("force_x_N", "force_y_N", "moment_Nm"), reactions),
    }
    return _table(answer, reactions.shape[:3], columns)


def files(answer: Answer) -> dict[str, bytes]:
    """Return an answer as files by name: a VTK series and the tables as CSV."""
    made = {
        f"{answer.analysis}_{name}.csv": table.to_csv(index=False, lineterminator="\n").encode()
        for name, table in tables(answer).items()
    }
    return _vtk(answer) | made


def _vtk(answer: Answer) -> dict[str, bytes]:
    """Return the files of a series by name: `<analysis>.pvd` and one `<analysis>_<number>.vtu` a state."""
    import meshio  # imported by who exports, as pictures have the scale of modes from here

    names = [f"{answer.analysis}_{number:04d}.vtu" for number in range(len(answer.values))]
    contents = {f"{answer.analysis}.pvd": _series(answer.values, names)}
    with tempfile.TemporaryDirectory() as folder:
        for state, name in enumerate(names):
            path = Path(folder) / name
            meshio.write(path, mesh(answer, state), file_format="vtu")
            contents[name] = path.read_bytes()
    return contents


def mesh(answer: Answer, state: int) -> Any:
    """Return one state: strips as lines, bodies as centres with lines to the ends they carry, and clamps.

    Points are those of the strips, strip by strip from root to tip, then the bodies' centres, then once more
    the ends that bodies carry, as points of the bodies. What the state has as a whole is data of every cell.
    """
    import meshio

    cells = list(_cells(answer))
    whole = {answer.series: answer.values} | numbers_of(answer)
    of_cells: dict[str, list[Any]] = {
        "part_kind": [np.full(len(parts), kind) for kind, _, parts, _ in cells],
        "part_number": [parts for _, _, parts, _ in cells],
    }
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


def _points(answer: Any, state: int) -> Array:
    still = _everywhere(answer, answer.along.shape[state], answer.along.bodies[state, :, :2])
    mode: Any = _mode(answer, state)
    return _spatial(still if mode is None else still + answer.scale_of(state) * mode)


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
