"""Baselines by name. Each module has `installed()`, `static_path(problem, rotations, *, repeat, **settings)`
and `release(problem, *, start, duration, step, repeat, **settings)`."""

from importlib import import_module
from typing import Any

from studies.errors import BadInput
from studies.record.extras import lacking

#: Name -> module.
MODELS: dict[str, str] = {
    "linear pivot": "studies.baselines.linear_pivot",
    "pin joint": "studies.baselines.pin_joint",
    "four-bar": "studies.baselines.four_bar",
    "exudyn ancf": "studies.baselines.peers.exudyn_ancf",
    "exudyn exact": "studies.baselines.peers.exudyn_exact",
    "openseespy frame": "studies.baselines.peers.openseespy_frame",
}

#: The models that are solved in closed form, and those that are other codes.
SURROGATES = ("linear pivot", "pin joint", "four-bar")
PEERS = ("exudyn ancf", "exudyn exact", "openseespy frame")

#: What to do about a peer that is not there.
HINT = "not installed: python -m pip install '.[peers]'"


def missing() -> str:
    """Return what this machine lacks of a study that holds the suite against all other codes; or nothing."""
    packages = {MODELS[name]: name.split()[0] for name in PEERS}
    gone = [package for path, package in packages.items() if not import_module(path).installed()]
    return lacking("peers", list(dict.fromkeys(gone)))


def module_of(name: str) -> Any:
    """Import and return the module of the baseline `name`.

    Raises:
        BadInput: no such baseline.
    """
    if name not in MODELS:
        raise BadInput(f"baseline: got {name!r}, expected one of {', '.join(MODELS)}")
    return import_module(MODELS[name])


def installed_module(name: str) -> Any:
    """Return the module of the baseline `name`, ready to be asked.

    Raises:
        BadInput: no such baseline, or a peer that is not installed.
    """
    module = module_of(name)
    if not module.installed():
        raise BadInput(f"{name}: {HINT}")
    return module
