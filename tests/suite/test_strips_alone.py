"""Strips without a body: every command answers or refuses them in one line."""

import pytest

from tests.one_strip import one_strip

SCENE = """
effects = ["bending", "stretching", "strip_inertia", "tip_force"]

[effects.tip_force]
strip = "strip"
force_N = [0, -0.5]
"""


@pytest.fixture
def strip(tmp_path):
    """Path of a case of one strip with a force at its free tip."""
    path = tmp_path / "strip.toml"
    path.write_text(one_strip(SCENE), encoding="utf-8")
    return path


@pytest.mark.parametrize("model", ["fe", "fe-shear"])
def test_modes_of_strips_alone(model, strip, command):
    """The table has the frequencies of a strip; no body moves in its modes."""
    ended = command("modes", strip, "--model", model, "--elements", 4, "--count", 2)
    assert ended.code == 0
    first = next(line.split() for line in ended.out.splitlines() if line.split()[0] == "1")
    assert [float(value) for value in first[2:]] == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("model", ["fe", "fe-shear", "spline"])
def test_release_of_strips_alone_is_refused(model, strip, refused):
    """A release reports the swing of a body: without one it is refused in one line that says what can be."""
    text = "studies: bodies: got none, expected a body whose motion is computed; `export"
    assert refused("release", strip, "--model", model, says=text).startswith(text)


@pytest.mark.parametrize("model", ["fe", "fe-shear"])
def test_motion_of_strips_alone_is_exported(model, strip, command, tmp_path):
    """The motion of strips alone is written with its drawing, whose states are named by their time."""
    words = ("--model", model, "--elements", 4, "--analysis", "release", "--duration", 1e-5, "--records", 2)
    ended = command("export", strip, *words, "--formats", "svg", "--out", tmp_path / "out")
    assert ended.code == 0
    assert list((tmp_path / "out").glob("*.svg"))
