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
        for name, mesh in zip(names, meshes(answer), strict=True):
            path = Path(folder) / name
            meshio.write(path, mesh, file_format="vtu")
            contents[name] = path.read_bytes()
    return contents


def meshes(answer: Answer) -> Iterator[Any]:
    """Yield the states: strips as lines, bodies as centres with lines to the ends they carry, and clamps.

    Points are those of the strips, strip by strip from root to tip, then the bodies' centres, then once more
    the ends that bodies carry, as points of the bodies. What the state has as a whole is data of every cell.
    """
    import meshio

    body, foot, blocks = _blocks(answer)
    points, data = _point_data(answer, body, foot)
    whole = {answer.series: answer.values} | numbers_of(answer)
    for state in range(len(answer.values)):
        cells: dict[str, list[Any]] = {
            "part_kind": [np.full(len(parts), kind) for kind, _, parts, _ in blocks],
            "part_number": [parts for _, _, parts, _ in blocks],
        }
        for name, values in whole.items():
            cells[name] = [np.full(len(parts), float(values[state])) for _, _, parts, _ in blocks]
        yield meshio.Mesh(
            points=points[state],
            cells=[(shape, nodes) for _, shape, _, nodes in blocks],
            point_data={name: values[state] for name, values in data.items()},
            cell_data=cells,
        )


def _blocks(answer: Answer) -> tuple[Indices, Indices, list[tuple[int, str, Indices, Indices]]]:
    """Return the numbers (E,) of the bodies that carry ends of strips, and of the points that are these ends;
    and kind, VTK shape, numbers of the parts and points (cells, 1 or 2) of the blocks that there are."""
    design = answer.design
    number = np.arange(answer.along.rotation[0].size).reshape(len(design.strips), -1)
    names, ends = [body.name for body in design.bodies], number[:, [0, -1]]
    on = np.array([(part.root, part.tip) for part in design.strips], dtype=object)
    clamps = ends.T[on.T == GROUND]
    carried = np.array([[name in names for name in own] for own in on])
    body = np.array([names.index(name) for name in on[carried]], dtype=np.int64)
    centres = number.size + np.arange(len(names))
    arms = np.stack([centres[body], number.size + len(names) + np.arange(len(body))], axis=1)
    lines = np.stack([number[:, :-1], number[:, 1:]], axis=-1)
    blocks = [
        (STRIP, "line", np.repeat(np.arange(len(lines)), lines.shape[1]), lines.reshape(-1, 2)),
        (BODY_CENTRE, "vertex", np.arange(len(names)), centres[:, None]),
        (BODY_ARM, "line", body, arms),
        (CLAMP, "vertex", np.arange(len(clamps)), clamps[:, None]),
    ]
    return body, ends[carried], [block for block in blocks if len(block[2])]


def _point_data(answer: Answer, body: Indices, foot: Indices) -> tuple[Array, dict[str, Array]]:
    """Return the points of all states (S, K, 3) and their data (S, K, ...) by name.

    body, foot: numbers (E,) of the bodies that carry ends, and of the points of strips that are these ends.
    """
    along = answer.along

    def everywhere(strips: Array, bodies: Array) -> Array:
        """Return vectors at all points from those of strips (S, G, P, 2) and bodies' centres (S, B, 2)."""
        flat = strips.reshape(len(strips), -1, 2)
        plane = np.concatenate([flat, bodies, flat[:, foot]], axis=1)
        return np.pad(plane, ((0, 0), (0, 0), (0, 1)))

    def of_strips(values: Array, elsewhere: float) -> Array:
        """Return values at all points from those of strips (S, G, P)."""
        beyond = along.bodies.shape[1] + len(foot)
        return np.pad(values.reshape(len(values), -1), ((0, 0), (0, beyond)), constant_values=elsewhere)

    reactions = np.zeros((*along.rotation.shape, 3))
    reactions[:, :, [0, -1]] = along.reactions
    force = [of_strips(reactions[..., axis], 0.0) for axis in range(2)]
    turns, arc = along.bodies[..., 2], np.broadcast_to(along.arc_length, along.rotation.shape)
    rotation = along.rotation.reshape(len(turns), -1)
    points = everywhere(along.shape, along.bodies[..., :2])
    data = {
        "displacement_m": points - everywhere(along.rest_shape[None], along.rest_bodies[None]),
        "rotation_rad": np.concatenate([rotation, turns, turns[:, body]], axis=1),
        "arc_length_m": of_strips(arc, np.nan),
        **{name: of_strips(values, np.nan) for name, values in along_of(answer).items()},
        "reaction_force_N": np.stack([*force, np.zeros_like(force[0])], axis=-1),
        "reaction_moment_Nm": of_strips(reactions[..., 2], 0.0),
    }
    if isinstance(answer, Spectrum):
        mode = everywhere(answer.mode_shape, answer.mode_bodies[..., :2])
        data["mode_per_sqrt_kg"] = mode
        points = points + np.array([[[answer.scale_of(k)]] for k in range(len(mode))]) * mode
    return points, data


def _series(values: Array, names: list[str]) -> bytes:
    """Return the .pvd that names the files of the states and what runs over them as their times."""
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1">', "  <Collection>"]
    for value, name in zip(values, names, strict=True):
        lines.append(f'    <DataSet timestep="{value:.12g}" part="0" file={quoteattr(name)}/>')
    return "\n".join([*lines, "  </Collection>", "</VTKFile>", ""]).encode()
