"""Delivering an answer: as JSON, CSV and a picture where they are asked for, or as a table; its exit code."""

import argparse
import json
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

from studies.answers.answer import Answer
from studies.answers.named import named
from studies.answers.response import PLACES, STRESSES, Response
from studies.answers.settings import Settings
from studies.commands.arguments import chosen_settings
from studies.commands.parser import STREAM
from studies.errors import BadInput
from studies.kinds import Array
from studies.record.files import write_all, write_whole
from studies.record.progress import Bar

NOT_CONVERGED = 3
#: Analyses whose errors are estimated, or told not to be.
ESTIMATED = ("static", "modes")
#: What a static answer prints: the names by which models estimate its error, and whether it is there.
PRINTED: dict[str, tuple[tuple[str, ...], Callable[[Response], Any]]] = {
    "places": (PLACES, attrgetter("bodies")),
    "centre shift": (("centre_shift",), lambda a: a.crossing is not None and np.any(a.centre_shift)),
    "torque": (("torque",), lambda a: np.isfinite(a.torque).any()),
    "stiffness": (("stiffness",), lambda a: np.isfinite(a.stiffness).any()),
    "stiffness of the body": (("body_stiffness",), lambda a: a.body and np.isfinite(a.body_stiffness).any()),
    "energy": (("energy", "strain_energy"), lambda a: True),
    "stress": (STRESSES, lambda a: np.isfinite(a.max_stress).any()),
}


def deliver(
    arguments: argparse.Namespace, document: Mapping[str, Any], table: Iterable[str], *, failure: str | None
) -> int:
    """Print `table`, and write `document` where `--json` says and its arrays where `--csv` does; return the
    exit code. What goes to the output stream stands alone.

    Args:
        arguments: of the command.
        document: the answer as a JSON object; its arrays and tuples are lists there, and null is what is no
            finite number.
        table: the answer in lines to read.
        failure: why the answer is not complete; None, or nothing, when it is.
    """
    csv, stream = getattr(arguments, "csv", None), getattr(arguments, "json", None)
    if STREAM not in (stream, csv) and (lines := list(table)):
        print("\n".join(lines))
    if stream is not None:
        _put(stream, json.dumps(_plain(document), allow_nan=False, indent=1) + "\n", "JSON")
    if csv is not None:
        import pandas as pd  # only who asks for a table waits for it

        states = pd.DataFrame({"model": document["model"], **_arrays(document)})
        _put(csv, states.to_csv(index=False, float_format="%.12g", lineterminator="\n"), "CSV")
    return not_converged(failure) if failure else 0


def asked(
    arguments: argparse.Namespace,
    ask: Callable[[Settings, Bar], Any],
    document: Callable[[Any], dict[str, Any]],
    table: Callable[[Any], Iterable[str]],
    *,
    stopped: Callable[[Any], str] = attrgetter("message"),
) -> int:
    """Ask the chosen model, draw the answer where `--plot` says, and deliver it; return the exit code.

    Args:
        arguments: of the command.
        ask: makes an answer of settings, and tells how far it is.
        document: of an answer its JSON object. table: of an answer the lines to read.
        stopped: why an answer is not complete.
    """
    (settings,) = chosen_settings(arguments)
    with Bar(f"{Path(arguments.case).stem}: {settings.model}") as bar:
        answer = ask(settings, bar)
    if getattr(arguments, "plot", None) is not None:
        draw(arguments, [(arguments.case, answer)] if answer.solution is not None else [])
    if getattr(arguments, "export", None) is not None and answer.solution is not None:
        _export(arguments, answer)
    failure = None if answer.converged else stopped(answer)
    return deliver(arguments, document(answer), table(answer), failure=failure)


def _arrays(document: Mapping[str, Any], above: str = "") -> dict[str, Array]:
    """Return the arrays (S,) of a JSON object by key, those of a body behind its name."""
    found: dict[str, Array] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            found |= _arrays(value, f"{key}_" if key != "bodies" else "")
        elif isinstance(value, np.ndarray):
            found[f"{above}{key}"] = value
    return found


def _put(target: Path, text: str, form: str) -> None:
    """Write the answer to a file and print its name, or write it to the output stream."""
    if target == STREAM:
        sys.stdout.write(text)
    else:
        write_whole(target, text.encode())
        print(f"{target}: the answer as {form}")


def not_converged(why: object) -> int:
    """Say why there is no answer, or not all of it; return the exit code."""
    print(f"studies: not converged: {why}", file=sys.stderr)
    return NOT_CONVERGED


def headed(answer: Any) -> dict[str, Any]:
    """Return how an answer ended and what it is of, as its JSON begins; modes pass nothing on their way."""
    loads = ["resolution"] if answer.analysis == "critical load" else []
    names = ("status", "message", "resolution", "model", "settings", "effects")
    found = keyed(answer, *(name for name in names if name not in loads))
    if answer.analysis in ESTIMATED:
        found["not_estimated"] = not_estimated(answer)
    return found


def keyed(answer: Any, *keys: str) -> dict[str, Any]:
    """Return what an answer knows by the keys of JSON: names of its attributes, most with their unit."""
    return {key: getattr(answer, key if hasattr(answer, key) else key.rpartition("_")[0]) for key in keys}


def moved(answer: Answer) -> dict[str, Any]:
    """Return the motion (S,) by names with units, x, y [m] and rotation [rad]: of a pivot that of its body,
    of a mechanism that of all bodies by their names."""
    if answer.crossing is not None:
        x, y = answer.centre.T
        return {"rotation_rad": answer.rotation, "com_x_m": x, "com_y_m": y}
    keys = ("x_m", "y_m", "rotation_rad")
    return {"bodies": {name: dict(zip(keys, place.T, strict=True)) for name, place in answer.bodies.items()}}


def described(answer: Answer) -> str:
    """Return the model with its settings, and the effects that it was assembled of, in two lines."""
    values = {k: f"{v:.6g}" if isinstance(v, float) else v for k, v in answer.settings.items()}
    given = (f"{name} {value}" for name, value in values.items() if value is not None)
    return f"{answer.model}: {', '.join(given)}\neffects: {', '.join(answer.effects)}"


def estimated(answer: Answer) -> Iterator[str]:
    """Yield what an answer says of its errors, and of which of what it prints they are not estimated."""
    errors = {name: error for name, error in answer.errors.items() if math.isfinite(error)}
    if errors:
        estimate = answer.estimate or {}
        listed = ", ".join(f"{name.replace('_', ' ')} {value:.1e}" for name, value in errors.items())
        what = "elements" if "meshes" in estimate else "control points"
        tried = ", ".join(map(str, estimate.get("meshes") or estimate["trials"]))
        yield f"estimated error: {listed}; {what} tried: {tried}"
    unknown = not_estimated(answer) if answer.analysis in ESTIMATED else []
    if not errors:
        yield "errors not estimated: --accuracy estimates them"
    elif unknown:
        yield f"error not estimated: {', '.join(unknown)}"


def not_estimated(answer: Any) -> list[str]:
    """Return what a path or modes print whose error is not among those that are estimated."""
    errors = {name for name, error in answer.errors.items() if math.isfinite(error)}
    if answer.analysis == "modes":
        return [] if errors else ["frequency"]
    known = [name for name, (of, there) in PRINTED.items() if there(answer) and not errors & set(of)]
    parts = {each.group or each.heading: bool(errors & set(each.estimated)) for each in named(answer.design)}
    return known + [name for name, sure in parts.items() if not sure]


def ending(answer: Answer) -> str:
    """Return how the solve ended, its work and its time in a line."""
    work = ", ".join(f"{name.replace('_', ' ')} {count}" for name, count in answer.counters.items())
    parts = (answer.status.replace("_", " "), work, f"solved in {answer.wall_s * 1e3:.3g} ms")
    return "; ".join(filter(None, parts))


def _plain(value: Any) -> Any:
    """Return a value as JSON has it: arrays and tuples as lists, null for what is not finite."""
    if isinstance(value, Mapping):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def draw(arguments: argparse.Namespace, answers: Iterable[tuple[str, Answer]]) -> None:
    """Draw answers with their cases over one another where `--plot` says, and say where they are."""
    from studies.pictures.page import picture  # only who asks for a picture waits for matplotlib
    from studies.pictures.shown import Shown
    from studies.record.style import printed

    target = arguments.plot
    shown = [Shown(name=called(case, answer), answer=answer) for case, answer in answers]
    try:
        write_whole(target, printed(picture(shown), target.suffix[1:].lower()))
    except BadInput as error:
        print(f"studies: {target}: nothing is drawn: {error}", file=sys.stderr)
    else:
        print(f"{target}: the picture", file=_aside(arguments))


def _export(arguments: argparse.Namespace, answer: Answer) -> None:
    """Write an answer for other programs where `--export` says, and say what is there."""
    from studies.exchange import files  # only who exports waits for it

    folder, contents = arguments.export, files(answer)
    write_all(folder, contents)
    said = f"{folder}: {len(answer.values)} states of {answer.analysis} in {len(contents)} files"
    print(said, file=_aside(arguments))


def _aside(arguments: argparse.Namespace) -> Any:
    """Return the stream for what is not the answer: not the output where the answer stands alone."""
    return sys.stderr if STREAM in (arguments.json, getattr(arguments, "csv", None)) else sys.stdout


def called(case: str, answer: Any) -> str:
    """Return what a picture calls an answer: its case, its model and how fine that was."""
    settings = answer.settings
    fine = (key for key in ("control_points", "elements") if key in settings)
    counts = (f", {settings[key]} {key.replace('_', ' ')}" for key in fine)
    return f"{Path(case).stem}: {answer.model}{''.join(counts)}"
